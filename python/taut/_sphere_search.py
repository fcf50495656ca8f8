"""Queries of points and balls by a tree of boxes and balls."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import as_rows
from ._record import Floats, RowNumbers


class SphereSearch:
    """Points or balls in a tree: nearest, within a radius, along rays, farthest, pairs, diameter.

    Answers are those of brute force over distances calculated in float64; of equal ones the lowest row comes first. Queries
    come many at a time and are answered on all threads; no answer depends on how many there are.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Finite real numbers, taken as by `ball`; n is at least 1. They are copied.
    radii : array_like of shape (n,), optional
        Given these, `points` are the centers of balls. The distance of a place from a ball is that to its near side, and
        negative inside.
    threads : int in [1, 1024], optional
        Threads to build the tree, by default all cores.

    Raises
    ------
    ValueError
        When there is no point, a coordinate is NaN or infinite, a radius is negative, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    See Also
    --------
    sphere_tree : a tree whose balls are the smallest around their points.

    Examples
    --------
    >>> import taut
    >>> search = taut.SphereSearch([[0, 0], [2, 0], [2, 0], [1, 5]])
    >>> rows, distances = search.nearest([[1.5, 0], [1, 9]])
    >>> rows.tolist(), distances.tolist()
    ([1, 3], [0.5, 4.0])
    >>> search.nearest([[1.5, 0]], k=3)[0].tolist()
    [[1, 2, 0]]
    """

    __slots__ = ("_tree",)

    def __init__(self, points: ArrayLike, *, radii: ArrayLike | None = None, threads: int | None = None) -> None:
        items = "points" if radii is None else "balls"
        self._tree = _native.SearchTree(as_rows(points, radii), items, threads)

    def __len__(self) -> int:
        return self._tree.shape()[0]

    def __repr__(self) -> str:
        n, d = self._tree.shape()
        return f"SphereSearch(<{n} rows in {d} dimensions>)"

    def nearest(
        self, places: ArrayLike, k: int | None = None, *, threads: int | None = None
    ) -> tuple[RowNumbers, Floats]:
        """The row nearest to each place, or the k nearest.

        Parameters
        ----------
        places : array_like of shape (m, d)
            Where to look from.
        k : int >= 1, optional
            How many rows for each place.
        threads : int in [1, 1024], optional
            Threads to use, by default all cores.

        Returns
        -------
        rows : ndarray of int64, shape (m,), or with `k` (m, min(k, n))
            Row numbers, nearest first, and lower ones first where they are equally near.
        distances : ndarray of float64, of the same shape
            Their distances.
        """
        rows = as_rows(places)
        _, found, distances = self._tree.nearest(rows, 1 if k is None else k, threads)
        if k is None:
            return found, distances
        shape = (len(rows), min(k, len(self)))
        return found.reshape(shape), distances.reshape(shape)

    def within(
        self, places: ArrayLike, radius: float, *, threads: int | None = None
    ) -> tuple[RowNumbers, RowNumbers, Floats]:
        """All rows within a radius of each place, the border included.

        Parameters
        ----------
        places : array_like of shape (m, d)
            Where to look from.
        radius : float
            The largest distance.
        threads : int in [1, 1024], optional
            Threads to use, by default all cores.

        Returns
        -------
        starts : ndarray of int64, shape (m + 1,)
            Place i has the entries ``starts[i]:starts[i + 1]`` of the other two.
        rows : ndarray of int64
            Row numbers, nearest first.
        distances : ndarray of float64
            Their distances.

        Examples
        --------
        >>> import taut
        >>> search = taut.SphereSearch([[0.0], [1.0], [5.0]])
        >>> starts, rows, distances = search.within([[0.25], [9.0], [4.5]], 0.75)
        >>> starts.tolist(), rows.tolist(), distances.tolist()
        ([0, 2, 2, 3], [0, 1, 2], [0.25, 0.75, 0.5])
        """
        return self._tree.within(as_rows(places), radius, threads)

    def farthest(
        self, places: ArrayLike, *, epsilon: float = 0.0, threads: int | None = None
    ) -> tuple[RowNumbers, Floats]:
        """The row farthest from each place.

        Parameters
        ----------
        places : array_like of shape (m, d)
            Where to look from.
        epsilon : float >= 0, default 0
            No row is farther than 1 + epsilon times the one that is returned; 0 asks for the farthest, which takes longer.
        threads : int in [1, 1024], optional
            Threads to use, by default all cores.

        Returns
        -------
        rows : ndarray of int64, shape (m,)
            Row numbers.
        distances : ndarray of float64, shape (m,)
            Their distances; of balls those of their far sides.

        Examples
        --------
        >>> import taut
        >>> rows, distances = taut.SphereSearch([[0.0], [1.0], [5.0]]).farthest([[1.0], [4.0]])
        >>> rows.tolist(), distances.tolist()
        ([2, 0], [4.0, 4.0])
        """
        _, rows, distances = self._tree.farthest(as_rows(places), epsilon, threads)
        return rows, distances

    def hits(
        self, origins: ArrayLike, directions: ArrayLike, *, hit_radius: float = 0.0, threads: int | None = None
    ) -> tuple[RowNumbers, RowNumbers, Floats]:
        """All rows that each ray meets, in the order in which it enters their balls.

        Parameters
        ----------
        origins : array_like of shape (m, d)
            Where rays begin.
        directions : array_like of shape (m, d)
            Where they go: any length but 0.
        hit_radius : float >= 0, default 0
            Radius of a point, or what is added to that of a ball.
        threads : int in [1, 1024], optional
            Threads to use, by default all cores.

        Returns
        -------
        starts : ndarray of int64, shape (m + 1,)
            Ray i has the entries ``starts[i]:starts[i + 1]`` of the other two.
        rows : ndarray of int64
            Row numbers.
        distances : ndarray of float64
            How far along the ray it enters the ball; 0 where it begins inside.

        Examples
        --------
        >>> import taut
        >>> balls = taut.SphereSearch([[0, 0], [3, 0], [9, 4]], radii=[1, 2, 1])
        >>> starts, rows, distances = balls.hits([[-5, 0]], [[1, 0]])
        >>> rows.tolist(), distances.tolist()
        ([0, 1], [4.0, 6.0])
        """
        return self._tree.hits(_rays(origins, directions), hit_radius, False, threads)

    def first_hits(
        self, origins: ArrayLike, directions: ArrayLike, *, hit_radius: float = 0.0, threads: int | None = None
    ) -> tuple[RowNumbers, Floats]:
        """The first row that each ray meets; see `hits` for the parameters.

        Returns
        -------
        rows : ndarray of int64, shape (m,)
            Row numbers, -1 where a ray meets nothing.
        distances : ndarray of float64, shape (m,)
            How far along the ray; infinite where it meets nothing.

        Examples
        --------
        >>> import taut
        >>> balls = taut.SphereSearch([[0, 0], [3, 0], [9, 4]], radii=[1, 2, 1])
        >>> rows, distances = balls.first_hits([[-5, 0], [-5, 0]], [[1, 0], [-1, 0]])
        >>> rows.tolist(), distances.tolist()
        ([0, -1], [4.0, inf])
        """
        starts, found, lengths = self._tree.hits(_rays(origins, directions), hit_radius, True, threads)
        has_hit = np.diff(starts) > 0
        rows = np.full(len(has_hit), -1, np.int64)
        distances = np.full(len(has_hit), np.inf)
        rows[has_hit], distances[has_hit] = found, lengths
        return rows, distances

    def pairs(
        self, distance: float = 0.0, *, other: SphereSearch | None = None, threads: int | None = None
    ) -> tuple[NDArray[np.int64], Floats]:
        """All pairs of rows within a distance of each other; of balls, 0 gives those that touch.

        Parameters
        ----------
        distance : float, default 0
            The largest distance, less the radii of balls.
        other : SphereSearch, optional
            Given this, pairs of a row of this tree and one of the other.
        threads : int in [1, 1024], optional
            Threads to use, by default all cores.

        Returns
        -------
        pairs : ndarray of int64, shape (m, 2)
            Row numbers, sorted; of one tree the lower one first.
        distances : ndarray of float64, shape (m,)
            Their distances, less the radii of balls: negative where these overlap.

        Examples
        --------
        >>> import taut
        >>> balls = taut.SphereSearch([[0, 0], [3, 0], [9, 0]], radii=[1, 2.5, 1])
        >>> pairs, distances = balls.pairs()
        >>> pairs.tolist(), distances.tolist()
        ([[0, 1]], [-0.5])
        """
        tree = None if other is None else other._tree
        first, second, distances = self._tree.pairs(tree, distance, threads)
        return np.column_stack([first, second]), distances

    def diameter(self, *, epsilon: float = 0.0) -> tuple[tuple[int, int], float, float]:
        """The two rows that are farthest apart.

        Parameters
        ----------
        epsilon : float >= 0, default 0
            No two rows are farther apart than 1 + epsilon times those that are returned; 0 asks for the farthest two, which
            can take long for points on a sphere.

        Returns
        -------
        rows : (int, int)
            Row numbers, the lower one first.
        distance : float
            Their distance; of balls that of their far sides.
        upper_bound : float
            No two rows are farther apart.

        Examples
        --------
        >>> import taut
        >>> taut.SphereSearch([[0, 0], [3, 4], [1, 1]]).diameter()
        ((0, 1), 5.0, 5.0)
        """
        rows, distance, upper_bound = self._tree.diameter(epsilon)
        return (rows[0], rows[1]), distance, upper_bound


def _rays(origins: ArrayLike, directions: ArrayLike) -> NDArray[np.float32] | NDArray[np.float64]:
    """Origins and directions side by side."""
    starts, ends = as_rows(origins), as_rows(directions)
    if starts.shape != ends.shape:
        raise ValueError(f"origins have shape {starts.shape}, but directions {ends.shape}")
    return as_rows(np.column_stack([starts, ends]))
