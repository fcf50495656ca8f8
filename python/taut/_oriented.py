"""Largest rectangles of any direction in polygons."""

from __future__ import annotations

from numpy.typing import ArrayLike

from . import _native
from ._answers.oriented import InscribedOrientedRectangle
from ._arrays import as_rows
from ._solution import Solution


def inscribed_oriented_rectangle(
    polygon: ArrayLike, *, epsilon: float = 1e-3, max_cells: int = 1_000_000
) -> Solution[InscribedOrientedRectangle]:
    """Largest rectangle of any direction in a polygon, with a certificate.

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

    Returns
    -------
    Solution
        ``answer`` is an `InscribedOrientedRectangle` with ``center``, ``axis``, ``ratio``, ``area`` and ``corners``; then ``certificate`` and ``trace``.

    Raises
    ------
    ValueError
        When rings cross or touch, with two edges; when a ring has fewer than 3 distinct vertices or a wrong number; when a number
        is NaN or infinite, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    inscribed_rectangle : the largest rectangle with sides along the axes.
    inscribed_circle : the largest circle in a polygon.
    inscribed_polygon : a large convex polygon in a polygon.

    Examples
    --------
    The largest rectangle of a square that stands on a corner is the square:

    >>> import taut
    >>> square = [[1, 0], [2, 1], [1, 2], [0, 1]]
    >>> found = taut.inscribed_oriented_rectangle(square)
    >>> round(found.answer.area, 3), found.answer.corners.shape
    (2.0, (4, 2))
    >>> found.check(square).gap <= 1.001e-3
    True
    """
    rows = as_rows(polygon)
    return Solution(_native.inscribed_oriented_rectangle(rows, epsilon, max_cells), rows)
