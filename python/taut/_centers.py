"""Few centers for many points."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.centers import Centers, FarthestFirst, SphereTree
from ._arrays import as_rows
from ._solution import Solution

CentersMethod = Literal["tree", "thesis", "farthest-first", "stream"]


def centers(
    points: ArrayLike,
    k: int,
    *,
    radii: ArrayLike | None = None,
    shapes: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    groups: ArrayLike | None = None,
    epsilon: float = 0.01,
    method: CentersMethod = "tree",
    discrete: bool = False,
    outliers: int = 0,
    max_nodes: int = 10_000_000,
    assignment: bool = False,
    threads: int | None = None,
) -> Solution[Centers]:
    """k centers such that the farthest point is as near to one of them as can be, with a certificate.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, taken as by `ball`.
    k : int >= 1
        Most centers.
    radii : array_like of shape (n,), optional
        Given these, `points` are the centers of balls, and each of these is to lie in one of the k. ``check`` takes the
        radii as well.
    shapes : array_like of shape (n, d, d), optional
        Given these, `points` are the centers m of ellipsoids {m + v : v v.T <= S}, as of `ball`, and each of these is to
        lie in one of the k. They have the method "tree", free centers, and neither weights nor groups. ``check`` takes the
        shapes as well.
    weights : array_like of shape (n,), optional
        Numbers above 0: a point counts with its weight times its distance. ``check`` takes the weights as well.
    groups : array_like of shape (n,), optional
        Finite numbers: rows of one number are a group, such as the vertices of a polytope, and one ball is to hold all of
        them. ``outliers`` then counts groups. ``check`` takes the groups as well.
    epsilon : float in [0, 1), default 0.01
        Relative gap to prove, radius <= (1 + epsilon) lower_bound; 0 asks for the least radius, to rounding. Has no
        influence on "farthest-first" and "stream".
    method : {"tree", "thesis", "farthest-first", "stream"}, default "tree"
        The way to find them; all end in the same kind of certificate. "tree" proves any gap in time exponential in k;
        "thesis" is the method of the literature it grew from, for free centers without weights, outliers and groups;
        "farthest-first" takes any k and proves a radius of at most twice the least,
        but for weights and outliers, with which it proves what it can; "stream" goes through the points twice, holds
        some 8 k of them, and proves a radius of at most 2.96 times the least, for points without weights, outliers
        and groups, and without ``assignment``.
    discrete : bool, default False
        Whether centers have to be points of the input.
    outliers : int >= 0, default 0
        Most points that may be left out, or groups of them.
    max_nodes : int, default 10,000,000
        Nodes of the search before the best centers so far are returned with their gap; large ones count as several. The proof
        has a budget of its own, some twenty times what the search took; ``stop`` is then "proof-budget".
    assignment : bool, default False
        Whether the answer is to say which center each point has.
    threads : int in [1, 1024], optional
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
        negative, a shape is not symmetric or not positive semidefinite, a weight is not positive, sizes are beyond what float64 can hold, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    farthest_first : an order whose first k points are good centers for every k.
    sphere_tree : balls within balls, from repeated splits in two.
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

    With one point left out, a single center is enough for three:

    >>> taut.centers([[0], [1], [2], [50]], 1, epsilon=1e-6, outliers=1).answer.outliers
    array([3])

    Two segments, each given by its ends and held whole by one ball:

    >>> ends = [[0, 0], [0, 6], [9, 0], [9, 2]]
    >>> found = taut.centers(ends, 2, groups=[0, 0, 1, 1], epsilon=1e-6)
    >>> found.answer.radius
    3.0
    >>> found.check(ends, groups=[0, 0, 1, 1]).upper
    3.0

    Three ellipses, each held whole by one of two balls:

    >>> places, shapes = [[0, 0], [1, 0], [9, 0]], [[[4, 0], [0, 1]], [[1, 0], [0, 1]], [[1, 0], [0, 9]]]
    >>> found = taut.centers(places, 2, shapes=shapes, epsilon=1e-6)
    >>> round(found.answer.radius, 5)
    3.0
    >>> found.check(places, shapes=shapes).gap <= 1e-6
    True
    """
    if shapes is not None and groups is not None:
        raise ValueError("only one of shapes and groups can be given: an ellipsoid is a group of its own")
    if radii is not None and weights is not None:
        raise ValueError("only one of radii and weights can be given: points alone can have weights")
    rows = as_rows(points, radii, shapes, weights=weights, groups=groups)
    items = "balls" if radii is not None else "points" if shapes is None else "ellipsoids"
    found = _native.centers(
        rows,
        k,
        items,
        weights is not None,
        groups is not None,
        epsilon,
        method,
        discrete,
        outliers,
        max_nodes,
        assignment,
        threads,
    )
    return Solution(found, rows)


def farthest_first(
    points: ArrayLike,
    count: int,
    *,
    start: int = 0,
    threads: int | None = None,
) -> FarthestFirst:
    """Points in an order in which each is the one farthest from all before it.

    The first k of them are centers with at most twice the least radius, for every k at once.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, taken as by `ball`.
    count : int >= 1
        How many points to put in order; n or more give all that are not copies.
    start : int, default 0
        The row of the first point.
    threads : int in [1, 1024], optional
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
    centers : k centers to any proved gap.

    Examples
    --------
    >>> import taut
    >>> found = taut.farthest_first([[0, 0], [1, 0], [10, 0], [10, 2]], 3)
    >>> found.order
    array([0, 3, 2])
    >>> found.radii[1:]
    array([2., 1.])
    """
    order, radii, after = _native.farthest_first(as_rows(points), count, start, threads)
    return FarthestFirst(order=order, radii=radii, next=after)


def sphere_tree(
    points: ArrayLike,
    *,
    leaf_size: int = 8,
    epsilon: float = 1e-9,
    threads: int | None = None,
) -> SphereTree:
    """A tree of balls around ever fewer points.

    The ball of each node is the smallest around its points. These are parted in two, so that the larger ball of both parts is
    small, down to leaves of a few points.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, taken as by `ball`.
    leaf_size : int >= 1, default 8
        Most points of a leaf, unless they are all equal.
    epsilon : float in [0, 1), default 1e-9
        Relative gap of the ball of each node.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The tree does not depend on it.

    Returns
    -------
    SphereTree
        Arrays with one entry for each node, the root first, each before its children: ``centers`` of shape (m, d), ``radii``,
        ``ranges`` of shape (m, 2) and ``children`` of shape (m, 2), -1 for a leaf. The points of node i are the rows
        ``order[ranges[i, 0]:ranges[i, 1]]``.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN or infinite, sizes are beyond what float64 can hold, or an option is
        out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    SphereSearch : nearest, within a radius, along rays, farthest, pairs.
    centers : k balls of one size, to any proved gap.

    Examples
    --------
    >>> import taut
    >>> tree = taut.sphere_tree([[0.0], [9.0], [1.0], [8.0]], leaf_size=2)
    >>> tree.radii
    array([4.5, 0.5, 0.5])
    >>> tree.children[0]
    array([1, 2])
    >>> start, end = tree.ranges[1]
    >>> tree.order[start:end]
    array([0, 2])
    """
    centers, radii, ranges, children, order = _native.sphere_tree(as_rows(points), leaf_size, epsilon, threads)
    return SphereTree(centers=centers, radii=radii, ranges=ranges, children=children, order=order)
