"""Largest circles in polygons."""

from __future__ import annotations

from numpy.typing import ArrayLike

from . import _native
from ._answers.circle import InscribedCircle
from ._arrays import as_rows
from ._solution import Solution


def inscribed_circle(ring: ArrayLike, *, epsilon: float = 1e-9, max_cells: int = 1_000_000) -> Solution[InscribedCircle]:
    """Largest circle in a polygon, with a certificate.

    Parameters
    ----------
    ring : array_like of shape (n, 2) or (n, 3)
        The vertices of one ring in order, or of several rings, with holes and parts, as rows (x, y, number of the ring): numbers
        are 0, 1, and so on, and inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first.
        An array of float32 or float64 in C order is read where it lies; anything else is first converted by NumPy, as by `ball`.
    epsilon : float in (0, 1), default 1e-9
        Relative gap to prove, largest radius <= (1 + epsilon) * radius.
    max_cells : int >= 1, default 1_000_000
        Most cells of the certificate; where epsilon takes more, a larger gap is proved.

    Returns
    -------
    Solution
        ``answer`` is an `InscribedCircle` with ``center`` of shape (2,) and ``radius``; then ``certificate`` and ``trace``.

    Raises
    ------
    ValueError
        When rings cross or touch, with two edges; when a ring has fewer than 3 distinct vertices or a wrong number; when a number
        is NaN or infinite, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    inscribed_ellipse : the ellipse of largest area in a polygon.
    inscribed_triangle : the triangle of largest area in a polygon.
    inscribed_ellipsoid : the ellipsoid of largest volume in a convex polytope.

    Examples
    --------
    The incircle of a right triangle:

    >>> import taut
    >>> ring = [[0, 0], [4, 0], [4, 3]]
    >>> found = taut.inscribed_circle(ring)
    >>> round(found.answer.radius, 8)
    1.0
    >>> found.check(ring).gap <= 1e-9
    True
    """
    rows = as_rows(ring)
    return Solution(_native.inscribed_circle(rows, epsilon, max_cells), rows)
