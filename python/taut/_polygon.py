"""Large convex polygons in polygons."""

from __future__ import annotations

from numpy.typing import ArrayLike

from . import _native
from ._answers.polygon import ConvexPolygon
from ._arrays import as_rows
from ._solution import Solution


def inscribed_polygon(
    polygon: ArrayLike, *, rounds: int = 200, starts: int = 32, seed: int = 1, epsilon: float = 1e-2
) -> Solution[ConvexPolygon]:
    """Large convex polygon in a polygon, with a bound of the largest.

    Parameters
    ----------
    polygon : array_like of shape (n, 2) or (n, 3)
        The vertices of one ring in order, or of several rings, with holes and parts, as rows (x, y, number of the ring), as by
        `inscribed_ellipse`.
    rounds : int >= 0, default 200
        Rounds in which sides are taken out and the room is carved again.
    starts : int >= 1, default 32
        Local ellipses to start from.
    seed : int >= 0, default 1
        Seed of the rounds.
    epsilon : float in (0, 1), default 1e-2
        Relative gap to prove of the largest ellipse, which is the bound.

    Returns
    -------
    Solution
        ``answer`` is a `ConvexPolygon` with ``vertices`` and ``area``; then ``certificate`` and ``trace``.

    Raises
    ------
    ValueError
        When rings cross or touch, with two edges; when a ring has fewer than 3 distinct vertices or a wrong number; when a number
        is NaN or infinite, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    inscribed_ellipse : the largest ellipse in a polygon.

    Examples
    --------
    >>> import taut
    >>> found = taut.inscribed_polygon([[0, 0], [3, 0], [3, 1], [1, 1], [1, 2], [0, 2]])
    >>> round(found.answer.area, 6)
    3.0
    """
    rows = as_rows(polygon)
    return Solution(_native.inscribed_polygon(rows, epsilon, rounds, starts, seed), rows)
