"""Triangulations that are kept to be asked, convex hulls, and drop-ins for `scipy.spatial`.

| name | what it is |
|---|---|
| `Triangulation` | the Delaunay triangulation: where places lie, nearest rows, interpolation, Voronoi diagram, alpha complex, constraints |
| `hull` | the convex hull alone, exactly |
| `Delaunay`, `Voronoi`, `ConvexHull` | the classes of `scipy.spatial` of these names, calculated by taut; they need SciPy |

Queries come many at a time, are sorted inside unless they come in order, and are answered on all cores with the interpreter
released.

>>> import taut
>>> from taut.spatial import Triangulation
>>> triangulation = Triangulation([[0, 0], [4, 0], [4, 3], [0, 3]])
>>> triangulation.simplices
array([[0, 1, 3],
       [3, 1, 2]], dtype=int32)
>>> triangulation.locate([[1, 1], [3, 2], [9, 9]])
array([ 0,  1, -1], dtype=int32)
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from ._hull import Polytope, hull
from ._triangulation import AlphaComplex, ConstrainedTriangulation, Triangulation, VoronoiDiagram

if TYPE_CHECKING:
    from ._drop_ins import ConvexHull, Delaunay, Voronoi

__all__ = [
    "AlphaComplex",
    "ConstrainedTriangulation",
    "ConvexHull",
    "Delaunay",
    "Polytope",
    "Triangulation",
    "Voronoi",
    "VoronoiDiagram",
    "hull",
]


def __getattr__(name: str) -> Any:
    """The drop-ins, which are loaded with their first use: they are derived from the classes of SciPy."""
    if name in ("ConvexHull", "Delaunay", "Voronoi"):
        from . import _drop_ins

        return getattr(_drop_ins, name)
    raise AttributeError(f"module 'taut.spatial' has no attribute {name!r}")
