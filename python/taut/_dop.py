"""Bounding k-dops of points."""

from __future__ import annotations

from numpy.typing import ArrayLike

from . import _native
from ._answers.dop import BoundingDop
from ._arrays import as_rows
from ._solution import Solution


def bounding_dop(points: ArrayLike, *, directions: int = 18) -> Solution[BoundingDop]:
    """Smallest polytope with facets in fixed directions (k-dop) around points of space, with a certificate.

    Parameters
    ----------
    points : array_like of shape (n, 3)
        Finite real numbers, such as the vertices of a mesh. An array of float32 or float64 in C order is read where it lies;
        anything else is first converted by NumPy, as by `ball`.
    directions : {6, 14, 18, 26}, default 18
        Directions of the facets: 6 is the box along the axes.

    Returns
    -------
    Solution
        ``answer`` is a `BoundingDop` with ``normals``, ``offsets``, ``vertices`` and ``volume``; then ``certificate`` with a point
        that each facet touches, and ``trace``.

    Raises
    ------
    ValueError
        When the points are not in space, a coordinate is NaN, infinite or out of range, or the number of directions is another one.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    inscribed_dops : large k-dops inside a mesh.

    Examples
    --------
    A tetrahedron is a 14-dop:

    >>> import taut
    >>> points = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> found = taut.bounding_dop(points, directions=14)
    >>> len(found.answer.vertices), round(found.answer.volume, 6)
    (4, 0.166667)
    >>> found.check(points).facets
    14
    """
    rows = as_rows(points)
    return Solution(_native.bounding_dop(rows, directions), rows)
