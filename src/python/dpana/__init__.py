"""Certified frictional contact of elastic bodies, with each other and with rigid obstacles.

    import dpana

    result = dpana.solve("examples/scenes/square.json")
    print(result.summary())
    result.contacts.pressure        # (contacts,)
    result.displacement("square")   # (nodes, 2)

A scene is a file, a dict of the same shape, or a `Scene`; a body's mesh may be a `Mesh` of arrays or
a meshio mesh. `Problem` is a bare condensed problem: G, u_free, gap, mu. Numbers are in one consistent
system of units of your choice. Bad input raises `Error`, a ValueError; a solve that is not certified is
no error: see `status`.
"""

from ._dpana import Contacts, Error, Mesh, Problem, ProblemResult, Result, __version__, schema
from ._mesh import from_meshio
from ._scene import Scene, solve

__all__ = [
    "Contacts",
    "Error",
    "Mesh",
    "Problem",
    "ProblemResult",
    "Result",
    "Scene",
    "__version__",
    "from_meshio",
    "schema",
    "solve",
]
