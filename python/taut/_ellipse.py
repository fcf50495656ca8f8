"""Largest ellipses in polygons."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.ellipse import InscribedEllipse
from ._arrays import as_rows
from ._solution import Solution

EllipseMethod = Literal["branch-and-bound", "thesis", "five-point"]


def inscribed_ellipse(
    polygon: ArrayLike,
    *,
    epsilon: float = 1e-3,
    max_cells: int = 1_000_000,
    method: EllipseMethod = "branch-and-bound",
    sample_count: int = 200,
    fatness: float = 1.0,
    angle: float = 45.0,
    seed: int = 1,
) -> Solution[InscribedEllipse]:
    """Ellipse of largest area in a polygon, with a certificate.

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
        The way to find it. "thesis" is Algorithm 12 of the thesis, corrected: the largest ellipse through three samples of the rings and
        around none; "five-point" takes ellipses through five. The largest ellipse of the same center and shape in the polygon is
        the answer, and its gap is that of the bound of the default method.
    sample_count : int from 12 to 1000, default 200
        Of "thesis" and "five-point": samples along the rings. Time and memory grow with the square.
    fatness : float >= 0.5, default 1.0
        Of "thesis" and "five-point": the least semi-axis, in spacings of the samples.
    angle : float in (0, 90), default 45.0
        Of "thesis" and "five-point": largest angle between the normals of ellipse and ring where they touch, in degrees.
    seed : int >= 0, default 1
        Of "thesis" and "five-point": seed of the order and of the perturbation of the samples.

    Returns
    -------
    Solution
        ``answer`` is an `InscribedEllipse` with ``center``, ``axes`` and ``area``; then ``certificate`` and ``trace``.

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
    inscribed_triangle : the triangle of largest area in a polygon.
    inscribed_ellipsoid : the ellipsoid of largest volume in a convex polytope.

    Examples
    --------
    In a square with a hole in the middle, two by two, the ellipse lies in one of the corridors:

    >>> import taut
    >>> outer = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]]
    >>> hole = [[1, 1, 1], [3, 1, 1], [3, 3, 1], [1, 3, 1]]
    >>> found = taut.inscribed_ellipse(outer + hole)
    >>> round(found.answer.area, 2)
    3.14
    >>> found.check(outer + hole).gap <= 1.001e-3
    True
    """
    rows = as_rows(polygon)
    return Solution(_native.inscribed_ellipse(rows, epsilon, max_cells, method, sample_count, fatness, angle, seed), rows)
