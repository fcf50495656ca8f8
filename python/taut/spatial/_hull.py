"""Convex hulls."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from .._arrays import Rows, as_rows

Ids = NDArray[np.int32]
Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Polytope:
    """A convex hull: rows of extreme points, exactly these, and facets.

    Attributes
    ----------
    points : ndarray of shape (n, d)
        The points.
    hull_dimension : int or None
        Dimension k of their affine hull; None for no points.
    vertices : ndarray of int32, shape (v,)
        Rows of the extreme points: of a polygon counter-clockwise from the lowest, else ascending. Of equal points the first.
    facets : ndarray of int32, shape (f, k)
        Rows of the facets: the edges of a polygon in order, the triangles of a polyhedron counter-clockwise from outside.
    neighbors : ndarray of int32, shape (f, k)
        For each vertex of a facet the facet across what is opposite it; of a segment none.
    faces : ndarray of int32, shape (f,)
        The face of each facet: facets of one face are in one plane, exactly.
    """

    points: Rows
    hull_dimension: int | None
    vertices: Ids
    facets: Ids
    neighbors: Ids
    faces: Ids

    @property
    def dimension(self) -> int:
        """Dimension of the points."""
        return int(self.points.shape[1])

    @cached_property
    def _corners(self) -> Floats:
        """The corners of facets relative to the first vertex, so that far from the origin no digits are lost."""
        corners: Floats = np.asarray(self.points[self.facets], dtype=np.float64) - self.points[self.vertices[0]]
        return corners

    @cached_property
    def _normals(self) -> Floats:
        """Outward normals, of the length or twice the area of the facet."""
        self._need_full()
        corners = self._corners
        if self.dimension == 2:
            along = corners[:, 1] - corners[:, 0]
            return np.column_stack([along[:, 1], -along[:, 0]])
        return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])

    @cached_property
    def equations(self) -> Floats:
        """Unit outward normals and offsets, of shape (f, d + 1): n @ x + offset <= 0 within. Facets of one face have the same."""
        lengths = np.sqrt(np.square(self._normals).sum(axis=1))
        # The largest facet of a face has the best determined normal.
        order = np.lexsort((-lengths, self.faces))
        is_first = np.diff(self.faces[order], prepend=-1) != 0
        best = np.empty(self.faces.max(initial=-1) + 1, dtype=np.intp)
        best[self.faces[order][is_first]] = order[is_first]
        normals = (self._normals / lengths[:, None])[best]
        offsets = -(normals * np.asarray(self.points[self.facets[best, 0]], dtype=np.float64)).sum(axis=1)
        equations: Floats = np.column_stack([normals, offsets])[self.faces]
        return equations

    @cached_property
    def volume(self) -> float:
        """The volume; of a polygon in the plane its area."""
        return float((self._normals * self._corners[:, 0]).sum() / (2 if self.dimension == 2 else 6))

    @cached_property
    def area(self) -> float:
        """The area of the surface; of a polygon in the plane its perimeter."""
        lengths = np.sqrt(np.square(self._normals).sum(axis=1))
        return float(lengths.sum() if self.dimension == 2 else lengths.sum() / 2)

    def _need_full(self) -> None:
        if self.hull_dimension != self.dimension:
            raise ValueError(f"the points span {self.hull_dimension} of {self.dimension} dimensions: the hull has no interior")

    def __repr__(self) -> str:
        return f"Polytope(<{len(self.vertices)} vertices>, <{len(self.facets)} facets>, dimension={self.dimension})"


def hull(points: ArrayLike, *, threads: int | None = None) -> Polytope:
    """The convex hull of points of the plane or of space, exactly.

    Parameters
    ----------
    points : array_like of shape (n, 2) or (n, 3)
        Finite real numbers, taken as by `taut.delaunay`.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. The answer does not depend on it.

    Returns
    -------
    Polytope
        ``vertices``, ``facets``, ``neighbors``, ``faces``, ``equations``, ``volume`` and ``area``.

    Raises
    ------
    ValueError
        When points have neither 2 nor 3 coordinates, or a coordinate is NaN or infinite.
    KeyboardInterrupt
        Ctrl-C stops the work.

    Notes
    -----
    Points within an edge or a face are no vertices, and how thin the hull is does not matter: all signs are exact. Points that are
    all in a plane, on a line or equal are no error: ``hull_dimension`` tells.

    Examples
    --------
    >>> from taut.spatial import hull
    >>> square = hull([[0, 0], [1, 0], [2, 0], [2, 2], [0, 2], [1, 1]])
    >>> square.vertices, square.volume, square.area
    (array([0, 2, 3, 4], dtype=int32), 4.0, 8.0)
    """
    rows = as_rows(points)
    return Polytope(rows, *_native.hull(rows, threads))
