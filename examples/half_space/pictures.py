"""The pictures of the rough surface: pressure, stick and slip, area and stiffness against load, spectrum.

    pip install numpy matplotlib
    cargo build --release && python examples/half_space/pictures.py [target/release/dpana]
"""

import csv
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap

HERE = Path(__file__).parent
PICTURES = HERE.parent / "pictures"
FRICTION, MODULUS, SLOPE = 0.3, 210e3 / 0.91, 0.1


def columns(path):
    """The numbers of a table, by column."""
    with open(path) as file:
        rows = list(csv.DictReader(file))
    number = lambda text: float(text) if text.replace("_", "").isalpha() is False and text else np.nan
    return {name: np.array([number(row[name]) for row in rows]) for name in rows[0]}


def main():
    program = sys.argv[1] if len(sys.argv) > 1 else "target/release/dpana"
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        run = lambda *words: subprocess.run([program, *map(str, words)], check=True)
        run("half-space", HERE / "sheared.json", "--npy", folder / "a.npy", "--spectrum", folder / "s.csv")
        loads = ",".join(f"{load:.6g}" for load in np.geomspace(23, 92e3, 25))
        run("cases", HERE / "pressed.json", "--vary", f"load={loads}", "--out", folder / "c.csv")
        field = {name: np.load(folder / f"a_{name}.npy") for name in ("pressure", "shear_x", "shear_y")}
        cases, spectrum = columns(folder / "c.csv"), columns(folder / "s.csv")
    maps(field)
    curves(cases, spectrum)


def maps(field):
    """Pressure, and which contacts stick and slip."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(9.6, 4.4), layout="constrained")
    pressure = np.ma.masked_less_equal(field["pressure"], 0)
    side = dict(extent=(-0.5, 0.5, -0.5, 0.5), origin="lower", interpolation="nearest")
    shown = left.imshow(pressure / 1e3, cmap="viridis", **side)
    figure.colorbar(shown, ax=left, label="pressure, GPa", shrink=0.85)
    left.set_title("pressure")
    carried = np.hypot(field["shear_x"], field["shear_y"])
    slips = carried >= FRICTION * field["pressure"] * (1 - 1e-6)
    state = np.where(field["pressure"] > 0, np.where(slips, 1, 2), 0)
    right.imshow(state, cmap=ListedColormap(["#f2f2f2", "#d95f0e", "#08519c"]), vmin=0, vmax=2, **side)
    share = [100 * (state == kind).mean() for kind in (1, 2)]
    right.set_title(f"slips (orange, {share[0]:.1f} %), sticks (blue, {share[1]:.1f} %)")
    for axes in (left, right):
        axes.set_xlabel("x, mm")
    figure.savefig(PICTURES / "rough_state.png", dpi=100)


def curves(cases, spectrum):
    """Area and stiffness against load, beside their laws; power spectrum."""
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.8), layout="constrained")
    mean, area = cases["load"] / (MODULUS * SLOPE), cases["area_fraction"]
    axes[0].loglog(mean, area, "o-", ms=3, label="dpana")
    axes[0].loglog(mean, np.minimum(1, (8 / np.pi) ** 0.5 * mean), "--", label="Persson: √(8/π) p/(E* h′)")
    axes[0].loglog(mean, np.minimum(1, (2 * np.pi) ** 0.5 * mean), ":", label="Bush, Gibson, Thomas: √(2π) p/(E* h′)")
    axes[0].set(xlabel="mean pressure / (E* rms slope)", ylabel="area in contact", ylim=(None, 2))
    part = np.isfinite(cases["stiffness"])
    axes[1].loglog(mean[part], cases["stiffness"][part], "o-", ms=3)
    axes[1].set(xlabel="mean pressure / (E* rms slope)", ylabel="stiffness dP/dδ, N/mm")
    some = spectrum["power"] > 1e-12 * spectrum["power"].max()
    q, power = spectrum["wave_number"][some], spectrum["power"][some]
    axes[2].loglog(q, power, ".-", label="surface")
    at = len(q) // 2
    axes[2].loglog(q, power[at] * (q / q[at]) ** -3.6, "--", label="q to the power of −2(1 + H)")
    axes[2].set(xlabel="wave number, 1/mm", ylabel="power spectrum, mm⁴", ylim=(power.min() / 2, 4 * power.max()))
    for plot in (axes[0], axes[2]):
        plot.legend(fontsize=8)
    figure.savefig(PICTURES / "rough_curves.png", dpi=100)


if __name__ == "__main__":
    main()
