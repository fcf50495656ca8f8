"""Ellipsoids of least volume."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._arrays import as_rows
from ._native import Solution

EllipsoidMethod = Literal["newton", "thesis-initial", "thesis-khachiyan", "thesis-core-set", "away-steps"]


def ellipsoid(
    points: ArrayLike,
    *,
    epsilon: float = 1e-9,
    method: EllipsoidMethod = "newton",
    max_passes: int = 1_000_000,
    threads: int | None = None,
    seed: int = 0,
) -> Solution:
    """Ellipsoid of least volume enclosing a point set, with a certificate.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers. An array of float32 or float64 in C order is read where it lies; anything else is first
        converted by NumPy, as by `ball`. Other threads must not write to it meanwhile.
    epsilon : float in [0, 1), default 1e-9
        Gap to prove, log-volume <= least log-volume + epsilon; 0 asks for as little as rounding allows. The volume is
        then at most exp(epsilon) times the least.
    method : {"newton", "thesis-initial", "thesis-khachiyan", "thesis-core-set", "away-steps"}, default "newton"
        The way to find it; all end in the same certificate. The first is the fastest, the others are those of the
        literature, kept to compare. "thesis-initial" does not search, so its gap may be large; the last three need
        epsilon > 0.
    max_passes : int >= 2, default 1,000,000
        Reads of all points before the best ellipsoid so far is returned with its gap.
    threads : int >= 1, optional
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
        names its row and column), the points reach too far for float64, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work within a block of points.

    Notes
    -----
    Points on a line, a plane or in another flat of dimension r < d are solved in that flat: ``answer.rank`` is r,
    ``answer.hull`` names the flat, and ``answer.log_volume`` is that of dimension r.

    See Also
    --------
    ball : the smallest ball.
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
    """
    return _native.ellipsoid(as_rows(points), epsilon, method, max_passes, threads, seed)
