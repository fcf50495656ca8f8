"""Largest triangles in polygons."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.triangle import InscribedTriangle
from ._arrays import as_rows
from ._solution import Solution

TriangleMethod = Literal["branch-and-bound", "thesis"]


def inscribed_triangle(
    polygon: ArrayLike,
    *,
    epsilon: float = 1e-3,
    max_cells: int = 1_000_000,
    method: TriangleMethod = "branch-and-bound",
    sample_count: int = 300,
    seed: int = 1,
) -> Solution[InscribedTriangle]:
    """Triangle of largest area in a polygon, with a certificate.

    Parameters
    ----------
    polygon : array_like of shape (n, 2) or (n, 3)
        The vertices of one ring in order, or of several rings, with holes and parts, as rows (x, y, number of the ring): numbers
        are 0, 1, and so on, and inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first.
        An array of float32 or float64 in C order is read where it lies; anything else is first converted by NumPy, as by `ball`.
    epsilon : float in (0, 1), default 1e-3
        Relative gap to prove, largest area <= (1 + epsilon) * area.
    max_cells : int >= 1, default 1_000_000
        Most cells of the certificate; where epsilon takes more, a larger gap is proved.
    method : str, default "branch-and-bound"
        The way to find it. "thesis" takes the largest triangle whose corners are random points in the polygon that see each other; its
        gap is that of the bound of the default method.
    sample_count : int from 3 to 4096, default 300
        Of "thesis": random points.
    seed : int >= 0, default 1
        Of "thesis": seed of the random points.

    Returns
    -------
    Solution
        ``answer`` is an `InscribedTriangle` with ``corners`` and ``area``; then ``certificate`` and ``trace``.

    Raises
    ------
    ValueError
        When rings cross or touch, with two edges; when a ring has fewer than 3 distinct vertices or a wrong number; when a number
        is NaN or infinite, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    inscribed_circle : the largest circle in a polygon.
    inscribed_ellipse : the ellipse of largest area in a polygon.

    Examples
    --------
    Half of a square is best, and a hole in the way leaves less:

    >>> import taut
    >>> outer = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]
    >>> round(taut.inscribed_triangle(outer).answer.area, 6)
    8.0
    >>> hole = [[1, 1, 1], [3, 1, 1], [3, 3, 1], [1, 3, 1]]
    >>> found = taut.inscribed_triangle(outer + hole)
    >>> found.answer.area < 4, found.check(outer + hole).gap <= 1.001e-3
    (True, True)
    """
    rows = as_rows(polygon)
    return Solution(_native.inscribed_triangle(rows, epsilon, max_cells, method, sample_count, seed), rows)
