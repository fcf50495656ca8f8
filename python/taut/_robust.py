"""Center and scatter of most of the points, whatever the others are."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.robust import RobustEllipsoid
from ._arrays import as_rows
from ._solution import Solution

RobustMethod = Literal["mcd", "mve", "trim"]
RobustScale = Literal["share", "level"]


def robust_ellipsoid(
    points: ArrayLike,
    *,
    method: RobustMethod = "mcd",
    coverage: float | None = None,
    level: float = 0.975,
    scale: RobustScale = "share",
    epsilon: float = 1e-9,
    threads: int | None = None,
) -> Solution[RobustEllipsoid]:
    """Center and scatter of most of the points, the ellipsoid they mean, and the outliers.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, taken as by `ball`.
    method : {"mcd", "mve", "trim"}, default "mcd"
        What is minimized over the points kept: the determinant of their covariance, the volume of the ellipsoid around
        them, or the latter with that ellipsoid as the answer.
    coverage : float, optional
        About which part of the points is kept: in [0.5, 1], by default 0.5, where most outliers are borne; by "trim" in
        (0, 1], by default 0.9.
    level : float in [0.5, 1), default 0.975
        The part of normal points that the ellipsoid of "mcd" and "mve" is to hold.
    scale : {"share", "level"}, default "share"
        From which part of normal points the scatter of all is concluded where outliers were weighed out: the share of the points
        that is left, as in R's robustbase, or `level`, as in scikit-learn. Not looked at by "trim".
    epsilon : float in (0, 1), default 1e-9
        Gap in log-volume of the ellipsoids of "mve" and "trim".
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.

    Returns
    -------
    Solution
        ``answer`` is a `RobustEllipsoid` with ``center``, ``scatter``, ``matrix``, ``log_det`` and ``outliers``, the
        row numbers outside the ellipsoid; then ``certificate`` and ``trace``.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN or infinite, sizes are beyond what float64 can hold, or an option is
        out of range.
    KeyboardInterrupt
        Ctrl-C stops the work within a block of points.

    Notes
    -----
    ``check`` calculates everything again from the points kept and proves that no C-step leads on from them. That no other
    points kept would do better is not proved: as with all programs for this problem, the answer is the best of the local
    optima found. It is the same on every run. Where most points lie exactly in a line, a plane or another flat,
    ``answer.hull`` names it and all others are outliers.

    See Also
    --------
    ellipsoid : the ellipsoid of least volume around all points.

    Examples
    --------
    A grid of 5 by 5, and three rows where a hand slipped:

    >>> import numpy as np
    >>> import taut
    >>> grid = np.stack(np.meshgrid(range(5), range(5)), axis=-1).reshape(-1, 2)
    >>> points = np.vstack([grid, [[1000, 0], [1000, 1], [1000, 2]]])
    >>> found = taut.robust_ellipsoid(points)
    >>> found.answer.center.round(8), found.answer.outliers
    (array([2., 2.]), array([25, 26, 27]))
    >>> found.check(points).rank
    2
    """
    rows = as_rows(points)
    return Solution(_native.robust_ellipsoid(rows, method, coverage, level, scale, epsilon, threads), rows)
