"""Delaunay triangulations."""

from __future__ import annotations

from typing import Literal

from numpy.typing import ArrayLike

from . import _native
from ._answers.triangulation import Triangulation
from ._arrays import as_rows
from ._solution import Solution

InsertionOrder = Literal["strided", "random", "local-ric", "hilbert"]


def delaunay(
    points: ArrayLike,
    *,
    order: InsertionOrder = "strided",
    threads: int | None = None,
    seed: int = 0,
) -> Solution[Triangulation]:
    """Delaunay triangulation of points in the plane or in space, with a certificate.

    All signs are exact, and where more than d + 1 points lie on one sphere the choice depends on their coordinates
    alone: the triangulation is a function of the point set, whatever the order of the rows.

    Parameters
    ----------
    points : array_like of shape (n, 2) or (n, 3)
        Finite real numbers. An array of float32 or float64 in C order is read where it lies; anything else is first
        converted by NumPy, as by `ball`. Other threads must not write to it meanwhile.
    order : {"strided", "random", "local-ric", "hilbert"}, default "strided"
        In which order points are inserted. The answer does not depend on it.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.
    seed : int >= 0, default 0
        Chooses the random orders. The answer does not depend on it.

    Returns
    -------
    Solution
        ``answer`` is a `Triangulation` with ``simplices``, ``neighbors``, ``hull`` and ``duplicates``, which can be read
        of the solution itself as well; ``certificate.fingerprint`` is a hash of the simplices.

    Raises
    ------
    ValueError
        When points have neither 2 nor 3 coordinates, a coordinate is NaN or infinite (the message names its row and
        column), or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    Notes
    -----
    Of equal points the first stands for all; the others are in ``duplicates``. Points that are all on a line or, in
    space, on a plane are no error: ``hull_dimension`` tells, and the simplices are the edges or triangles there.

    See Also
    --------
    verify : checks an answer that was stored.

    Examples
    --------
    >>> import taut
    >>> points = [[0, 0], [4, 0], [4, 3], [0, 1], [0, 0]]
    >>> found = taut.delaunay(points)
    >>> found.simplices
    array([[0, 1, 3],
           [3, 1, 2]], dtype=int32)
    >>> found.neighbors
    array([[ 1, -1, -1],
           [-1, -1,  0]], dtype=int32)
    >>> found.duplicates
    array([[4, 0]], dtype=int32)
    >>> found.check(points)
    TriangulationVerdict(sites=4, simplices=2, hull=4, ties=0)
    """
    rows = as_rows(points)
    return Solution(_native.delaunay(rows, order, threads, seed), rows)
