"""Curves through points of the plane."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.curve import Curve
from ._arrays import as_rows
from ._solution import Solution

CurveMethod = Literal[
    "auto",
    "fit",
    "thesis",
    "thesis-crude",
    "crust",
    "one-step-crust",
    "nn-crust",
    "conservative-crust",
    "hnn-crust",
    "corners",
    "tour",
]


def curve(
    points: ArrayLike,
    *,
    method: CurveMethod = "auto",
    open: bool = False,  # noqa: A002, the public name
    rho: float = 4.0,
    omega: float = 0.1,
    feature: float | None = None,
    places: bool = False,
    threads: int | None = None,
) -> Solution[Curve]:
    """The curves that points of the plane were sampled from, noisy or not, with what is known about them.

    Parameters
    ----------
    points : array_like of shape (n, 2)
        Finite real numbers, taken as by `ball`.
    method : str, default "auto"
        The way to find them. "auto" takes "fit" where the points are noisy, else
        "nn-crust" where that is certified, else "hnn-crust" or "corners". For noisy points: "fit",
        which first decides which neighbors belong together and then fits along the order they have; "thesis" and
        "thesis-crude", the methods of the literature it is compared with. For points without noise, which then are the
        vertices: "crust", "one-step-crust", "nn-crust", "conservative-crust" (curves with ends), "hnn-crust" and "corners".
        "tour" is a short tour through all points, with a lower bound.
    open : bool, default False
        Whether a curve ends where its samples end, and nothing is joined across a gap. A tour becomes a path.
    rho : float >= 1, default 4.0
        Of "thesis" and "thesis-crude": how much longer than wide the coarse disk of a point must be.
    omega : float > 0, default 0.1
        Of "thesis" and "thesis-crude": the first disk of a point holds (ln n)^(1 + omega) points.
    feature : float > 0, optional
        Of "thesis" and "thesis-crude": the least distance of the curves from their medial axis. Estimated if not given.
    places : bool, default False
        Whether the answer is to tell the place of each row on the curves.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.

    Returns
    -------
    Solution
        ``answer.curves``, each with ``vertices`` of shape (m, 2), ``closed`` and ``rows``; ``answer.noise``,
        ``answer.outliers``, ``answer.places``; ``certificate.band`` and ``certificate.certified``; ``trace``.

    Raises
    ------
    ValueError
        When points do not have 2 coordinates, a coordinate is NaN or infinite (the message names its row and column), or an
        option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    Notes
    -----
    What `Solution.check` proves: no two edges meet, and every row but the outliers lies in the band. Where the samples are dense
    enough beside the features of the curves, ``certified`` says that they have the connectivity of smooth closed curves with
    these samples; else ``doubt`` says why that cannot be told.

    See Also
    --------
    delaunay : the triangulation that methods for points without noise stand on.

    Examples
    --------
    Two circles, one in the other:

    >>> import numpy as np
    >>> import taut
    >>> t = np.arange(60) * (2 * np.pi / 60)
    >>> ring = np.c_[np.cos(t), np.sin(t)]
    >>> points = np.r_[ring, 0.5 * ring]
    >>> found = taut.curve(points, method="hnn-crust")
    >>> [(len(curve.vertices), curve.closed) for curve in found.answer.curves]
    [(60, True), (60, True)]
    >>> found.check(points).simple
    True

    A tour, and how much longer it can be than the shortest:

    >>> tour = taut.curve([[0, 0], [3, 0], [3, 4], [0, 4]], method="tour")
    >>> tour.check([[0, 0], [3, 0], [3, 4], [0, 4]]).tour_gap < 0.01
    True
    """
    rows = as_rows(points)
    return Solution(_native.curve(rows, method, open, rho, omega, feature, places, threads), rows)
