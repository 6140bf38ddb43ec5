"""How much a pressed square resists being pushed, at fifty coefficients of friction."""
import matplotlib.pyplot as plt
import numpy as np
import dpana
mu = np.linspace(0, 1, 50)
table = dpana.Scene.read("examples/scenes/square.json").cases(friction=mu)
plt.plot(mu, table["friction_x"])
plt.xlabel("coefficient of friction")
plt.ylabel("friction force")
plt.savefig("target/friction.svg")
