"""Delaunay triangulations that are kept to be asked."""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from .._arrays import Rows, as_rows
from .._answers.triangulation import Triangulation as Answer
from .._solution import Solution

Ids = NDArray[np.int32]
Starts = NDArray[np.int64]
Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class VoronoiDiagram:
    """A Voronoi diagram as arrays. Vertices have numbers, -1 stands for infinity.

    A vertex is the center of all simplices with one circumsphere, decided exactly: the corners of a grid's cells are one each.

    Attributes
    ----------
    vertices : ndarray of shape (v, d)
        The vertices.
    of_simplices : ndarray of int32, shape (m,)
        The vertex of each simplex of the triangulation.
    ridge_points : ndarray of int32, shape (r, 2)
        The two rows whose regions meet in each ridge, the lower one first.
    ridge_starts : ndarray of int64, shape (r + 1,)
        Ridge i has the entries ``ridge_starts[i]:ridge_starts[i + 1]`` of `ridge_vertices`.
    ridge_vertices : ndarray of int32
        Vertices, in order around each ridge, -1 or the lowest first.
    region_rows : ndarray of int32, shape (s,)
        The row of each region, ascending. Rows that equal an earlier one have none.
    region_starts : ndarray of int64, shape (s + 1,)
        Region i has the entries ``region_starts[i]:region_starts[i + 1]`` of `region_vertices`.
    region_vertices : ndarray of int32
        Vertices; in the plane counter-clockwise, -1 or the lowest first, in space ascending.
    """

    vertices: Floats
    of_simplices: Ids
    ridge_points: Ids
    ridge_starts: Starts
    ridge_vertices: Ids
    region_rows: Ids
    region_starts: Starts
    region_vertices: Ids


@dataclass(frozen=True, eq=False)
class AlphaComplex:
    """What of a triangulation an eraser of a radius leaves that spares the points.

    Attributes
    ----------
    simplices : ndarray of int32, shape (m,)
        Numbers of the simplices whose circumradius is at most alpha, ascending.
    boundary : ndarray of int32, shape (b, d)
        Rows of the facets that have such a simplex on one side, turned outward.
    singular : ndarray of int32, shape (s, d)
        Rows of the facets that have none, but an empty ball of at most that radius through their vertices.
    """

    simplices: Ids
    boundary: Ids
    singular: Ids


@dataclass(frozen=True, eq=False)
class ConstrainedTriangulation:
    """A triangulation of the plane with given segments as edges, Delaunay as far as they let it be.

    Attributes
    ----------
    simplices : ndarray of int32, shape (m, 3)
        Rows of the triangles, counter-clockwise.
    is_constrained : ndarray of bool, shape (m, 3)
        For each vertex of a triangle whether the edge opposite it is part of a segment.
    is_inside : ndarray of bool, shape (m,)
        For each triangle whether it lies inside the rings that the segments form; none does unless they are rings.
    splits : ndarray of int32, shape (k, 2)
        Segments, by their place in the input, with a row that they go through: their edges meet there.
    """

    simplices: Ids
    is_constrained: Bools
    is_inside: Bools
    splits: Ids


@contextmanager
def _collector_at_rest() -> Iterator[None]:
    """Lists of numbers have no cycles, but a million of them would set the collector of cycles off again and again.

    At the end they would all be young, and be visited at the next allocation. Frozen and thawed, they are of the oldest generation
    without a visit; what somebody else has frozen is left as it is.
    """
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            if gc.get_freeze_count() == 0:
                gc.freeze()
                gc.unfreeze()
            gc.enable()


def _lists(starts: Starts, values: Ids) -> list[list[int]]:
    """Runs of numbers as lists; made so they take half the time that calls from compiled code take by the stable interface."""
    flat, ends = values.tolist(), starts.tolist()
    return [flat[begin:end] for begin, end in zip(ends, ends[1:])]


class Triangulation:
    """The Delaunay triangulation of points of the plane or of space, kept to be asked.

    It is exact, and a function of the point set alone, as that of `taut.delaunay`.

    Parameters
    ----------
    points : array_like of shape (n, 2) or (n, 3)
        Finite real numbers, taken as by `taut.delaunay`.
    threads : int in [1, 1024], optional
        Threads to build it, by default all cores; nothing depends on it.

    Attributes
    ----------
    points : ndarray of shape (n, d)
        The points.
    hull_dimension : int or None
        Dimension of the affine hull of the points: less than d where all are on a plane, on a line or equal. None for no
        points.
    simplices : ndarray of int32, shape (m, k + 1)
        Rows of the simplices, positively oriented; k is `hull_dimension`.
    neighbors : ndarray of int32, shape (m, k + 1)
        For each vertex the simplex across the facet opposite it; -1 on the hull.
    hull : ndarray of int32, shape (h, k)
        The facets of the convex hull, turned outward.
    duplicates : ndarray of int32, shape (c, 2)
        Rows that equal an earlier row, each with the first row it equals.

    Examples
    --------
    >>> from taut.spatial import Triangulation
    >>> triangulation = Triangulation([[0, 0], [2, 0], [2, 2], [0, 2], [0, 0]])
    >>> triangulation.nearest([[1.5, 0.2]]), triangulation.duplicates
    (array([1], dtype=int32), array([[4, 0]], dtype=int32))
    """

    def __init__(self, points: ArrayLike, *, threads: int | None = None) -> None:
        self.points: Rows = as_rows(points)
        self._kept = _native.KeptTriangulation(self.points, threads)
        self.hull_dimension: int | None = self._kept.hull_dimension()

    @cached_property
    def simplices(self) -> Ids:
        """Rows of the simplices, positively oriented, of shape (m, k + 1)."""
        return self._kept.simplices()

    @cached_property
    def neighbors(self) -> Ids:
        """For each vertex of a simplex the one across the facet opposite it, of shape (m, k + 1); -1 on the hull."""
        return self._kept.neighbors()

    @cached_property
    def hull(self) -> Ids:
        """The facets of the convex hull, turned outward, of shape (h, k)."""
        return self._kept.hull()

    @cached_property
    def duplicates(self) -> Ids:
        """Rows that equal an earlier row, each with the first row it equals, of shape (c, 2)."""
        return self._kept.duplicates()

    def __repr__(self) -> str:
        n, d = self.points.shape
        return f"Triangulation(<{n} rows in {d} dimensions>, <{len(self.simplices)} simplices>)"

    def __reduce__(self) -> tuple[Any, ...]:
        return Triangulation, (self.points,)

    @property
    def solution(self) -> Solution[Answer]:
        """The triangulation with its certificate, as `taut.delaunay` returns it; a ValueError if the points were changed since."""
        return Solution(self._kept.found(self.points), self.points)

    def _places(self, places: ArrayLike) -> Floats:
        return np.require(as_rows(places), dtype=np.float64, requirements=["C", "ALIGNED"])

    def locate(self, places: ArrayLike) -> Ids:
        """The simplex in which each place lies, exactly.

        Parameters
        ----------
        places : array_like of shape (m, d)
            Any points.

        Returns
        -------
        ndarray of int32, shape (m,)
            Numbers of simplices, of several that hold a place on their boundary the lowest; -1 outside the hull, and everywhere
            if the points do not span all dimensions.
        """
        return self._kept.locate(self._places(places))

    def nearest(self, places: ArrayLike) -> Ids:
        """The row nearest to each place, of shape (m,); -1 if there is none. Of equal rows the first."""
        return self._kept.nearest(self._places(places))

    def natural_coordinates(self, places: ArrayLike) -> tuple[Starts, Ids, Floats]:
        """Sibson's coordinates: by which share a place would take from the Voronoi region of each row.

        Parameters
        ----------
        places : array_like of shape (m, d)
            Any points.

        Returns
        -------
        starts : ndarray of int64, shape (m + 1,)
            Place i has the entries ``starts[i]:starts[i + 1]`` of the other two; none outside the hull.
        rows : ndarray of int32
            The natural neighbors.
        weights : ndarray of float64
            Their coordinates; those of a place sum to 1, and the mean of the rows with these weights is the place.

        Examples
        --------
        >>> from taut.spatial import Triangulation
        >>> starts, rows, weights = Triangulation([[0, 0], [2, 0], [2, 2], [0, 2]]).natural_coordinates([[1, 0.5]])
        >>> [float(round(weights[rows == row].sum(), 6)) for row in range(4)]
        [0.375, 0.375, 0.125, 0.125]
        """
        return self._kept.natural_coordinates(self._places(places))

    def interpolate(
        self, values: ArrayLike, places: ArrayLike, *, method: Literal["natural", "linear"] = "natural"
    ) -> Floats:
        """Values between the points.

        Parameters
        ----------
        values : array_like of shape (n,)
            One for each row of the points. Of equal rows the value of the first counts.
        places : array_like of shape (m, d)
            Any points.
        method : {"natural", "linear"}, default "natural"
            By natural neighbors, smooth between the points; or linear in each simplex.

        Returns
        -------
        ndarray of shape (m,)
            NaN outside the hull.

        Examples
        --------
        >>> from taut.spatial import Triangulation
        >>> triangulation = Triangulation([[0, 0], [2, 0], [2, 2], [0, 2]])
        >>> triangulation.interpolate([0, 2, 4, 2], [[1, 0.5], [9, 9]]).round(8)
        array([1.5, nan])
        """
        heights = np.require(np.asarray(values), dtype=np.float64, requirements=["C", "ALIGNED"])
        if heights.shape != (len(self.points),):
            raise ValueError(f"values have shape {heights.shape}: expected {(len(self.points),)}, one for each row")
        at = self._places(places)
        if method == "natural":
            return self._kept.interpolate(heights, at)
        if method != "linear":
            raise ValueError(f"method is {method!r}: expected 'natural' or 'linear'")
        found = self._kept.locate(at)
        result = np.full(len(at), np.nan)
        inside = np.flatnonzero(found >= 0)
        corners = self.simplices[found[inside]]
        places_of = np.asarray(self.points, dtype=np.float64)[corners]
        edges = places_of[:, 1:] - places_of[:, :1]
        offsets = (at[inside] - places_of[:, 0])[:, :, None]
        weights = np.linalg.solve(edges.transpose(0, 2, 1), offsets)[:, :, 0]
        base = heights[corners[:, 0]]
        result[inside] = base + (weights * (heights[corners[:, 1:]] - base[:, None])).sum(axis=1)
        return result

    def circumcenters(self) -> Floats:
        """The center of the sphere through the vertices of each simplex, of shape (m, d); not finite for the flattest."""
        return self._kept.circumcenters()

    def cospherical_groups(self) -> Ids:
        """For each simplex the lowest number of those with its circumsphere, exactly; of shape (m,).

        Examples
        --------
        >>> from taut.spatial import Triangulation
        >>> Triangulation([[0, 0], [2, 0], [2, 2], [0, 2]]).cospherical_groups()
        array([0, 0], dtype=int32)
        """
        return self._kept.cospherical_groups()

    def voronoi(self) -> VoronoiDiagram:
        """The Voronoi diagram; empty if the points do not span all dimensions.

        Examples
        --------
        >>> from taut.spatial import Triangulation
        >>> diagram = Triangulation([[0, 0], [2, 0], [2, 2], [0, 2]]).voronoi()
        >>> diagram.vertices, diagram.ridge_points.tolist()
        (array([[1., 1.]]), [[0, 1], [0, 3], [1, 2], [2, 3]])
        """
        return VoronoiDiagram(*self._kept.voronoi())

    def voronoi_lists(self, offset: int = 0) -> tuple[Floats, Ids, list[list[int]], list[list[int]], NDArray[np.int64]]:
        """The Voronoi diagram as `scipy.spatial.Voronoi` keeps it, which takes longer than `voronoi`.

        Parameters
        ----------
        offset : int, default 0
            Empty regions before the first.

        Returns
        -------
        vertices : ndarray of shape (v, d)
            The vertices.
        ridge_points : ndarray of int32, shape (r, 2)
            The two rows of each ridge.
        ridge_vertices, regions : list of list of int
            Vertices of the ridges and of the regions, -1 for infinity.
        point_region : ndarray of int64, shape (n,)
            The region of each row.

        Examples
        --------
        >>> from taut.spatial import Triangulation
        >>> Triangulation([[0, 0], [2, 0], [2, 2], [0, 2]]).voronoi_lists()[3]
        [[-1, 0], [-1, 0], [-1, 0], [-1, 0]]
        """
        diagram = self.voronoi()
        with _collector_at_rest():
            if self.points.shape[1] == 2:
                ridges = diagram.ridge_vertices.reshape(-1, 2).tolist()
            else:
                ridges = _lists(diagram.ridge_starts, diagram.ridge_vertices)
            empty: list[list[int]] = [[] for _ in range(offset)]
            regions = empty + _lists(diagram.region_starts, diagram.region_vertices)
        point_region = np.zeros(len(self.points), dtype=np.int64)
        point_region[diagram.region_rows] = np.arange(offset, len(regions))
        rows, firsts = self.duplicates.T
        point_region[rows] = point_region[firsts]
        return diagram.vertices, diagram.ridge_points, ridges, regions, point_region

    def alpha_complex(self, alpha: float) -> AlphaComplex:
        """What an eraser of radius `alpha` leaves that spares the points; empty if these do not span all dimensions."""
        return AlphaComplex(*self._kept.alpha_complex(alpha))

    def constrained(self, segments: ArrayLike, *, ring: bool = False) -> ConstrainedTriangulation:
        """The triangulation of the plane with these segments as edges.

        Parameters
        ----------
        segments : array_like of int, shape (k, 2)
            Rows that are to be joined. A segment through a row is split there.
        ring : bool, default False
            Whether the segments form closed rings; then ``is_inside`` says which triangles they enclose.

        Returns
        -------
        ConstrainedTriangulation

        Raises
        ------
        ValueError
            When segments cross where no point is, name rows that are not there, or rings do not close; for points of space, or of
            a line.

        Examples
        --------
        >>> from taut.spatial import Triangulation
        >>> triangulation = Triangulation([[0, 0], [4, 0], [4, 4], [2, 1], [0, 4]])
        >>> outline = [[0, 1], [1, 2], [2, 3], [3, 4], [4, 0]]
        >>> found = triangulation.constrained(outline, ring=True)
        >>> found.simplices[found.is_inside].shape
        (3, 3)
        """
        pairs = np.asarray(segments)
        if pairs.ndim != 2 or pairs.shape[1] != 2 or pairs.dtype.kind not in "iu":
            raise ValueError(f"segments have shape {pairs.shape} and dtype {pairs.dtype}: expected integers of shape (k, 2)")
        if pairs.size and (pairs.min() < 0 or pairs.max() >= len(self.points)):
            raise ValueError(f"segments name rows from {pairs.min()} to {pairs.max()}: there are {len(self.points)} rows")
        return ConstrainedTriangulation(*self._kept.constrained([(int(a), int(b)) for a, b in pairs], ring))
