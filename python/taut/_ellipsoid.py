"""Ellipsoids of least volume around, and of largest volume inside."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.inscribed import InscribedEllipsoid
from ._answers.ellipsoid import Ellipsoid
from ._arrays import as_rows, as_sets
from ._solution import Solution

EllipsoidMethod = Literal["newton", "thesis-initial", "thesis-khachiyan", "thesis-core-set", "away-steps"]


def ellipsoid(
    points: ArrayLike,
    *,
    radii: ArrayLike | None = None,
    shapes: ArrayLike | None = None,
    epsilon: float = 1e-9,
    method: EllipsoidMethod = "newton",
    max_passes: int = 1_000_000,
    threads: int | None = None,
    seed: int = 0,
) -> Solution[Ellipsoid]:
    """Ellipsoid of least volume enclosing points, balls or ellipsoids, with a certificate.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers. An array of float32 or float64 in C order is read where it lies; anything else is first
        converted by NumPy, as by `ball`. Other threads must not write to it meanwhile.
    radii : array_like of shape (n,), optional
        Given these, at least 0, `points` are the centers of balls. The one method is "newton" then, and ``check`` takes
        the radii as well.
    shapes : array_like of shape (n, d, d), optional
        Given these, `points` are the centers m of ellipsoids {m + v : v v.T <= S}, with S symmetric, to 1e-8 of its
        largest entry, and positive semidefinite; of the two halves the lower one counts. S has the units of a
        covariance: the half axes are the square roots of its eigenvalues. The one method is "newton" then, and
        ``check`` takes the shapes as well.
    epsilon : float in [0, 1), default 1e-9
        Gap to prove, log-volume <= least log-volume + epsilon; 0 asks for as little as rounding allows. The volume is
        then at most exp(epsilon) times the least.
    method : {"newton", "thesis-initial", "thesis-khachiyan", "thesis-core-set", "away-steps"}, default "newton"
        The way to find it; all end in the same certificate. The first is the fastest, the others are those of the
        literature, kept to compare. "thesis-initial" does not search, so its gap may be large; the last three need
        epsilon > 0.
    max_passes : int >= 2, default 1,000,000
        Reads of all points before the best ellipsoid so far is returned with its gap.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.
    seed : int >= 0, default 0
        Chooses the directions in which the methods of the literature look for their first points.

    Returns
    -------
    Solution
        ``answer`` is an `Ellipsoid` with ``center`` of shape (d,), ``matrix`` of shape (d, d), ``factor`` of shape
        (r, d), ``log_volume``, ``rank`` r and ``hull``; then ``certificate`` and ``trace``.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN, infinite or an integer that float64 cannot hold (the message
        names its row and column), a radius is negative, a shape is not symmetric or not positive semidefinite, the
        sizes are beyond what float64 can hold, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work within a block of points.

    Notes
    -----
    Points on a line, a plane or in another flat of dimension r < d are solved in that flat: ``answer.rank`` is r,
    ``answer.hull`` names the flat, and ``answer.log_volume`` is that of dimension r.

    See Also
    --------
    ellipsoids : the same for many point sets at once.
    ball : the smallest ball.
    robust_ellipsoid : an ellipsoid that outliers do not move.
    verify : checks an answer that was stored.

    Examples
    --------
    >>> import taut
    >>> points = [[0, 0], [4, 0], [4, 2], [0, 2], [1, 1]]
    >>> found = taut.ellipsoid(points)
    >>> found.answer.center.round(8), found.answer.matrix.round(8) + 0.0
    (array([2., 1.]), array([[0.125, 0.   ],
           [0.   , 0.5  ]]))
    >>> found.answer.norm(points).round(8)
    array([1.        , 1.        , 1.        , 1.        , 0.35355339])
    >>> found.check(points).gap <= 1e-9
    True

    Around two unit discs:

    >>> found = taut.ellipsoid([[0, 0], [2, 0]], radii=[1, 1])
    >>> found.answer.center.round(8)
    array([1., 0.])
    >>> found.check([[0, 0], [2, 0]], radii=[1, 1]).gap <= 1e-9
    True
    """
    if radii is not None and shapes is not None:
        raise TypeError("radii and shapes are given: expected one of them, for balls or for ellipsoids")
    items = "balls" if radii is not None else "points" if shapes is None else "ellipsoids"
    rows = as_rows(points, radii, shapes)
    return Solution(_native.ellipsoid(rows, items, epsilon, method, max_passes, threads, seed), rows)


def ellipsoids(
    sets: ArrayLike | Iterable[ArrayLike],
    *,
    epsilon: float = 1e-9,
    method: EllipsoidMethod = "newton",
    max_passes: int = 1_000_000,
    threads: int | None = None,
    seed: int = 0,
) -> list[Solution[Ellipsoid]]:
    """Ellipsoid of least volume of each of many point sets, with a certificate each.

    Each is the answer of `ellipsoid` for that set, byte by byte. Threads share the sets, so that many small ones are
    solved much faster than one call after the other.

    Parameters
    ----------
    sets : array_like of shape (m, n, d), or iterable of m array_like of shape (n_i, d_i)
        m point sets: one array of three dimensions where all are of one size, else a list, such as `numpy.split` makes
        of a table. float32 or float64 in C order is read where it lies; anything else is first converted by NumPy, as by
        `ellipsoid`.
    epsilon : float in [0, 1), default 1e-9
        Gap to prove for each, log-volume <= least log-volume + epsilon.
    method : {"newton", "thesis-initial", "thesis-khachiyan", "thesis-core-set", "away-steps"}, default "newton"
        The way to find them, as of `ellipsoid`.
    max_passes : int >= 2, default 1,000,000
        Reads of all points of a set before its best ellipsoid so far is returned with its gap.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. No answer depends on it.
    seed : int >= 0, default 0
        As of `ellipsoid`, for each of them.

    Returns
    -------
    list of m Solution
        In the order of the sets; ``found[i].check(sets[i])`` judges one.

    Raises
    ------
    ValueError
        What `ellipsoid` raises for a set, with the number of the first that it is about.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    ellipsoid : the same for one point set.

    Examples
    --------
    >>> import numpy as np
    >>> import taut
    >>> sets = np.random.default_rng(0).normal(size=(1000, 50, 3))
    >>> found = taut.ellipsoids(sets)
    >>> len(found), found[7].check(sets[7]).gap <= 1e-9
    (1000, True)

    Groups of a table, sorted by their label:

    >>> labels, table = np.array([1, 0, 1, 0, 0]), np.array([[0, 0], [9, 9], [2, 0], [9, 7], [7, 9]])
    >>> order = np.argsort(labels, kind="stable")
    >>> groups = np.split(table[order], np.flatnonzero(np.diff(labels[order])) + 1)
    >>> [found.answer.rank for found in taut.ellipsoids(groups)]
    [2, 1]
    """
    given = as_sets(sets)
    found = _native.ellipsoids(given, epsilon, method, max_passes, threads, seed)
    return list(map(Solution, found, given))


def inscribed_ellipsoid(
    normals: ArrayLike,
    offsets: ArrayLike,
    *,
    epsilon: float = 1e-9,
    max_steps: int = 1000,
) -> Solution[InscribedEllipsoid]:
    """Ellipsoid of largest volume in a polytope {x : A x <= b}, with a certificate.

    Parameters
    ----------
    normals : array_like of shape (n, d)
        A, finite real numbers, no row all zeros. Normals and offsets are copied to one array, float32 if both are, else
        float64.
    offsets : array_like of shape (n,)
        b, finite real numbers.
    epsilon : float in (0, 1), default 1e-9
        Gap to prove, largest log-volume <= log-volume + epsilon.
    max_steps : int >= 1, default 1000
        Steps of Newton's method before the ellipsoid so far is returned with its gap.

    Returns
    -------
    Solution
        ``answer`` is an `InscribedEllipsoid` with ``center`` c of shape (d,), ``axes`` G of shape (d, d), for
        {c + G z : |z| <= 1}, and ``log_volume``; then ``certificate`` and ``trace``. ``check`` takes A, and b as
        ``offsets``.

    Raises
    ------
    ValueError
        When the polytope is unbounded or has no interior point, with the reason; when a number is NaN or infinite, a
        normal is 0, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work between two steps.

    See Also
    --------
    ellipsoid : the ellipsoid of least volume around points.

    Examples
    --------
    The rectangle of sides 4 and 2:

    >>> import taut
    >>> A, b = [[1, 0], [-1, 0], [0, 1], [0, -1]], [4, 0, 2, 0]
    >>> found = taut.inscribed_ellipsoid(A, b)
    >>> found.answer.center.round(8)
    array([2., 1.])
    >>> found.check(A, offsets=b).gap <= 1e-9
    True
    """
    if offsets is None:
        raise TypeError("offsets are None: expected one for each normal")
    rows = as_rows(normals, offsets=offsets)
    return Solution(_native.inscribed_ellipsoid(rows, epsilon, max_steps), rows)
