"""Few centres for many points."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._arrays import as_rows
from ._native import FarthestFirst, Solution

CentersMethod = Literal["tree", "thesis", "farthest-first"]


def centers(
    points: ArrayLike,
    k: int,
    *,
    radii: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    epsilon: float = 0.01,
    method: CentersMethod = "tree",
    discrete: bool = False,
    outliers: int = 0,
    max_nodes: int = 10_000_000,
    assignment: bool = False,
    threads: int | None = None,
) -> Solution:
    """k centres such that the farthest point is as near to one of them as can be, with a certificate.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, taken as by `ball`.
    k : int >= 1
        Most centres.
    radii : array_like of shape (n,), optional
        Given these, `points` are the centres of balls, and each of these is to lie in one of the k. ``check`` takes the
        radii as well.
    weights : array_like of shape (n,), optional
        Numbers above 0: a point counts with its weight times its distance. ``check`` takes the weights as well.
    epsilon : float in [0, 1), default 0.01
        Relative gap to prove, radius <= (1 + epsilon) lower_bound; 0 asks for the least radius, to rounding. Has no
        influence on "farthest-first".
    method : {"tree", "thesis", "farthest-first"}, default "tree"
        The way to find them; all end in the same kind of certificate. "tree" proves any gap in time exponential in k;
        "thesis" is the method of the literature it grew from, for free centres without weights and outliers;
        "farthest-first" takes any k and proves a radius of at most twice the least,
        but for weights and outliers, with which it proves what it can.
    discrete : bool, default False
        Whether centres have to be points of the input.
    outliers : int >= 0, default 0
        Most points that may be left out.
    max_nodes : int, default 10,000,000
        Nodes of the search before the best centres so far are returned with their gap.
    assignment : bool, default False
        Whether the answer is to say which centre each point has.
    threads : int >= 1, optional
        Threads to use, by default all cores. The answer does not depend on it.

    Returns
    -------
    Solution
        ``answer.centers`` of shape (m, d) with m <= k, ``answer.radius``, ``answer.lower_bound``, ``answer.outliers``,
        ``answer.assignment``; ``certificate.core_set``, the rows that prove the lower bound; ``trace``.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN or infinite (the message names its row and column), a radius is
        negative, a weight is not positive, sizes are beyond what float64 can hold, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    farthest_first : an order whose first k points are good centres for every k.
    ball : the smallest ball, which is k = 1.

    Examples
    --------
    Two pairs, far from each other:

    >>> import taut
    >>> points = [[0, 0], [0, 2], [9, 0], [9, 1]]
    >>> found = taut.centers(points, 2, epsilon=1e-6, assignment=True)
    >>> found.answer.radius
    1.0
    >>> found.answer.assignment.tolist() in ([0, 0, 1, 1], [1, 1, 0, 0])
    True
    >>> found.check(points).gap <= 1e-6
    True

    With one point left out, a single centre is enough for three:

    >>> taut.centers([[0], [1], [2], [50]], 1, epsilon=1e-6, outliers=1).answer.outliers
    array([3])
    """
    if radii is not None and weights is not None:
        raise ValueError("only one of radii and weights can be given: points alone can have weights")
    rows = as_rows(points, radii, weights=weights)
    items = "points" if radii is None else "balls"
    return _native.centers(
        rows,
        k,
        items,
        weights is not None,
        epsilon,
        method,
        discrete,
        outliers,
        max_nodes,
        assignment,
        threads,
    )


def farthest_first(
    points: ArrayLike,
    count: int,
    *,
    start: int = 0,
    threads: int | None = None,
) -> FarthestFirst:
    """Points in an order in which each is the one farthest from all before it.

    The first k of them are centres with at most twice the least radius, for every k at once.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, taken as by `ball`.
    count : int >= 1
        How many points to put in order; n or more give all that are not copies.
    start : int, default 0
        The row of the first point.
    threads : int >= 1, optional
        Threads to use, by default all cores. The order does not depend on it.

    Returns
    -------
    FarthestFirst
        ``order``, row numbers, and ``radii``: ``radii[k - 1]`` is the largest distance of a point to the nearest of the
        first k, and no k balls of a radius below its half hold all points.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN or infinite, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work within a block of points.

    See Also
    --------
    centers : k centres to any proved gap.

    Examples
    --------
    >>> import taut
    >>> found = taut.farthest_first([[0, 0], [1, 0], [10, 0], [10, 2]], 3)
    >>> found.order
    array([0, 3, 2])
    >>> found.radii[1:]
    array([2., 1.])
    """
    return _native.farthest_first(as_rows(points), count, start, threads)
