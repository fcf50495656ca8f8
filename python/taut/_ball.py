"""Smallest enclosing balls."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.kernel_ball import KernelBall
from ._answers.ball import Ball
from ._arrays import as_rows
from ._solution import Solution

BallMethod = Literal["core-set", "thesis-pure", "thesis-fast", "badoiu-clarkson"]
KernelName = Literal["gaussian", "polynomial", "linear", "precomputed"]


def ball(
    points: ArrayLike,
    *,
    shapes: ArrayLike | None = None,
    epsilon: float = 1e-9,
    method: BallMethod = "core-set",
    batch: int | None = None,
    delta: float | None = None,
    max_passes: int = 1_000_000,
    threads: int | None = None,
    seed: int = 0,
) -> Solution[Ball]:
    """Smallest ball enclosing points or ellipsoids, with a certificate.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers. An array of float32 or float64 in C order is read where it lies, without a copy,
        also when it is read-only; anything else is first converted by NumPy (integers and other precisions to
        float64, in which integers must be exact). Other threads must not write to it meanwhile.
    shapes : array_like of shape (n, d, d), optional
        Given these, `points` are the centers m of ellipsoids {m + v : v v.T <= S}, with S symmetric, to 1e-8 of its
        largest entry, and positive semidefinite; of the two halves the lower one counts. S has the units of a
        covariance: the half axes are the square roots of its eigenvalues. The one method is "core-set" then, and
        ``check`` takes the shapes as well.
    epsilon : float in [0, 1), default 1e-9
        Relative gap to prove, R <= (1 + epsilon) R*; 0 asks for the exact ball, to rounding.
    method : {"core-set", "thesis-pure", "thesis-fast", "badoiu-clarkson"}, default "core-set"
        The way to find it; all end in the same certificate. The first is the fastest, the others are those of
        the literature it grew from, kept so that their tables can be rerun.
    batch : int >= 1, optional
        Far points taken to the core-set per pass, by "core-set"; by default chosen by dimension.
    delta : float in (0, 1), optional
        Relative accuracy to which the ball of a core-set is solved, by "thesis-pure" and "thesis-fast"; by default
        epsilon squared. Other methods take none.
    max_passes : int >= 3, default 1,000,000
        Reads of all points before the best ball so far is returned with its gap; at least 4 for the methods of the
        literature.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.
    seed : int >= 0, default 0
        Chooses the point from which the methods of the literature start.

    Returns
    -------
    Solution
        ``answer.center`` of shape (d,), ``answer.radius``, ``certificate``, ``trace``.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN, infinite or an integer that float64 cannot hold (the message
        names its row and column), a shape is not symmetric or not positive semidefinite, the radius exceeds float64,
        or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work within a block of points.

    See Also
    --------
    ball_of_balls : the smallest ball around balls.
    kernel_ball : the smallest ball in the feature space of a kernel.
    verify : checks an answer that was stored.

    Examples
    --------
    >>> import taut
    >>> found = taut.ball([[0, 1], [2, 1], [1, 2]])
    >>> found.answer.center, found.answer.radius
    (array([1., 1.]), 1.0)
    >>> found.certificate.support, found.certificate.multipliers
    (array([0, 1]), array([0.5, 0.5]))
    >>> found.check([[0, 1], [2, 1], [1, 2]]).gap <= 1e-9
    True

    Around the ellipse with half axes 3 and 1:

    >>> found = taut.ball([[0, 0]], shapes=[[[9, 0], [0, 1]]])
    >>> round(found.answer.radius, 8)
    3.0
    >>> found.check([[0, 0]], shapes=[[[9, 0], [0, 1]]]).gap <= 1e-9
    True
    """
    items = "points" if shapes is None else "ellipsoids"
    rows = as_rows(points, shapes=shapes)
    return Solution(_native.ball(rows, items, epsilon, method, batch, delta, max_passes, threads, seed), rows)


def kernel_ball(
    points: ArrayLike,
    *,
    kernel: KernelName = "gaussian",
    gamma: float = 1.0,
    offset: float = 1.0,
    degree: int = 2,
    nu: float | None = None,
    epsilon: float = 1e-6,
    thesis_steps: int | None = None,
    max_passes: int = 10_000,
    threads: int | None = None,
    seed: int = 0,
) -> Solution[KernelBall]:
    """Smallest ball around points in the feature space of a kernel, hard or soft, with a certificate.

    The soft ball is a support vector data description: it minimizes R**2 + sum(max(0, d**2 - R**2)) / (nu * n), where d are the
    distances of the n points from its center, and leaves at most a share `nu` of them outside.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, as for `ball`. With ``kernel="precomputed"`` the symmetric and positive semidefinite matrix of
        shape (n, n) of the products in the feature space.
    kernel : {"gaussian", "polynomial", "linear", "precomputed"}, default "gaussian"
        exp(-gamma |x - y|**2), (gamma x.y + offset)**degree, x.y, or the entries given.
    gamma, offset, degree : float > 0, float >= 0, int in [1, 16]
        Parameters of the kernel; those that it does not have are ignored.
    nu : float in (0, 1], optional
        Given this, the ball is soft.
    epsilon : float in (0, 1), default 1e-6
        Relative gap of the objective to prove; the objective is a squared radius.
    thesis_steps : int >= 2, optional
        Takes so many steps of Algorithm 11 of the thesis in place of the default method; only without `nu`.
    max_passes : int >= 1, default 10,000
        Reads of all points before the best ball so far is returned with its gap.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.
    seed : int >= 0, default 0
        Chooses the sample from which the search starts.

    Returns
    -------
    Solution
        ``answer`` is a `KernelBall` with ``support``, ``multipliers`` and ``squared_radius``; ``certificate`` and ``trace``.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN or infinite, distances exceed float64, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work within a block of points.

    See Also
    --------
    ball : the smallest ball around points themselves.

    Examples
    --------
    Three points at the same distance from each other:

    >>> import taut
    >>> points = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    >>> found = taut.kernel_ball(points, gamma=0.5)
    >>> round(found.answer.squared_radius, 5)
    0.42141
    >>> found.check(points).gap <= 1e-6
    True
    """
    rows = as_rows(points)
    limits = (max_passes, threads, seed)
    return Solution(_native.kernel_ball(rows, kernel, (gamma, offset, degree), nu, epsilon, thesis_steps, limits), rows)


def ball_of_balls(
    centers: ArrayLike,
    radii: ArrayLike,
    *,
    epsilon: float = 1e-9,
    method: BallMethod = "core-set",
    batch: int | None = None,
    delta: float | None = None,
    max_passes: int = 1_000_000,
    threads: int | None = None,
    seed: int = 0,
) -> Solution[Ball]:
    """Smallest ball enclosing balls, with a certificate.

    Parameters
    ----------
    centers : array_like of shape (n, d)
        Finite real numbers. Centers and radii are copied to one array, float32 if both are, else float64.
    radii : array_like of shape (n,)
        Finite real numbers, at least 0.
    epsilon, method, batch, delta, max_passes, threads, seed
        As in `ball`.

    Returns
    -------
    Solution
        As from `ball`; ``certificate.items`` is ``"balls"``, and ``check`` takes the radii as well.

    Raises
    ------
    ValueError
        As `ball`, and when a radius is negative or there are more or fewer radii than centers.

    Examples
    --------
    Two balls of radius 1 whose centers are 2 apart:

    >>> import taut
    >>> found = taut.ball_of_balls([[0, 1], [2, 1]], [1, 1])
    >>> found.answer.center, found.answer.radius
    (array([1., 1.]), 2.0)
    >>> found.check([[0, 1], [2, 1]], radii=[1, 1]).upper
    2.0
    """
    if radii is None:
        raise TypeError("radii are None: expected one for each center; points have `taut.ball`")
    rows = as_rows(centers, radii)
    return Solution(_native.ball(rows, "balls", epsilon, method, batch, delta, max_passes, threads, seed), rows)
