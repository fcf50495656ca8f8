"""The classes of `scipy.spatial`, calculated by taut.

They are derived from those of SciPy and have all their attributes, so that whatever takes those takes these. What taut does not
do (more than three dimensions, furthest-site diagrams, options of Qhull that ask for something else) is left to SciPy: the
attribute `is_native` tells. Options that only help Qhull with rounding, as "QJ" does, change nothing here; but by "QJ" equal
points are vertices each, which SciPy sees to.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import scipy.spatial
from numpy.typing import ArrayLike, NDArray

from ._hull import Polytope, hull
from ._triangulation import Triangulation

Ids = NDArray[np.int32]
Floats = NDArray[np.float64]


# Options by which Qhull gets along with rounding, or says less: exact arithmetic needs none of them.
ROUNDING_OPTIONS = {"QJ", "Pp", "Q12", "Qt", "Qx"}
# Likewise, but refused by SciPy for objects that points can be added to.
SCALING_OPTIONS = {"Qbb", "Qz"}


def _is_plain(options: str | None, incremental: bool, more: set[str]) -> bool:
    """Whether options of Qhull ask for nothing but what taut does."""
    known = ROUNDING_OPTIONS | more | (set() if incremental else SCALING_OPTIONS)
    return options is None or (isinstance(options, str) and known.issuperset(options.split()))


def _native_points(points: Any, is_plain: bool) -> Floats | None:
    """The points as SciPy keeps them, where taut can do what is asked; None where SciPy is to answer or to refuse."""
    if not is_plain or np.ma.isMaskedArray(points):
        return None
    rows = np.ascontiguousarray(points, dtype=np.float64)
    return rows if rows.ndim == 2 and rows.shape[1] in (2, 3) else None


def _is_repeating(rows: Floats) -> bool:
    return len(np.unique(rows, axis=0)) < len(rows)


class _Native:
    """What the three have in common: bounds of the points, and adding more by building again."""

    is_native: bool = False
    _is_open: bool = False
    _points: Any
    _qhull: Any

    def _solve(self, points: Floats) -> Ids:
        """Solves for these points, and returns rows that hold all corners of their hull."""
        raise NotImplementedError

    def _begin(self, points: Any, options: str | None, *, is_plain: bool, incremental: bool) -> bool:
        rows = _native_points(points, is_plain)
        if rows is not None and options is not None and "QJ" in options and _is_repeating(rows):
            rows = None
        self.is_native = rows is not None
        if rows is not None:
            self._qhull = None
            self._is_open = incremental
            self._bound(rows)
        return self.is_native

    def _bound(self, rows: Floats) -> None:
        self._points = rows
        self.npoints, self.ndim = rows.shape
        corners = rows[self._solve(rows)]
        self.min_bound, self.max_bound = corners.min(axis=0), corners.max(axis=0)

    def add_points(self, points: ArrayLike, restart: bool = False) -> None:
        """Adds points to an object that was made with ``incremental=True``; all is calculated again."""
        if not self.is_native:
            super().add_points(points, restart)  # type: ignore[misc]
            return
        if not self._is_open:
            raise RuntimeError("incremental mode not enabled or already closed")
        more = np.ascontiguousarray(points, dtype=np.float64)
        if more.ndim != 2 or more.shape[1] != self.ndim:
            raise ValueError(f"points have shape {more.shape}: expected (n, {self.ndim})")
        self._bound(np.concatenate([self._points, more]))

    def close(self) -> None:
        """Ends the incremental mode."""
        self._is_open = False
        super().close()  # type: ignore[misc]


def _triangulated(points: Floats) -> Triangulation:
    found = Triangulation(points)
    if found.hull_dimension != points.shape[1]:
        _refuse_flat(points, found.hull_dimension)
    return found


def _refuse_flat(points: Floats, dimension: int | None) -> None:
    n, d = points.shape
    spanned = "no" if dimension is None else str(dimension)
    raise scipy.spatial.QhullError(f"{n} points span {spanned} of {d} dimensions: there is no simplex to begin with")


class Delaunay(_Native, scipy.spatial.Delaunay):  # type: ignore[misc]
    """`scipy.spatial.Delaunay`, exact.

    Differences: the numbers of simplices, and where more than d + 1 points are on a sphere the choice among equally good simplices;
    `find_simplex` is exact, without a tolerance at the hull.

    Parameters
    ----------
    points : array_like of shape (n, d)
        The points.
    furthest_site : bool, default False
        Done by SciPy.
    incremental : bool, default False
        Allows `add_points`, which builds the triangulation again.
    qhull_options : str, optional
        Done by SciPy where it asks for more than to get along with rounding.

    Attributes
    ----------
    triangulation : Triangulation or None
        The triangulation with all its methods; None where SciPy did the work.
    is_native : bool
        Whether taut did the work.

    Examples
    --------
    >>> from taut.spatial import Delaunay
    >>> triangulation = Delaunay([[0, 0], [4, 0], [4, 3], [0, 1]])
    >>> triangulation.simplices
    array([[0, 1, 3],
           [3, 1, 2]], dtype=int32)
    >>> triangulation.find_simplex([[1, 0.5], [9, 9]])
    array([ 0, -1], dtype=int32)
    """

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
    ) -> None:
        self.triangulation: Triangulation | None = None
        self._equations: Floats | None = None
        self._coplanar: Ids | None = None
        is_plain = not furthest_site and _is_plain(qhull_options, incremental, {"Qc"})
        if self._begin(points, qhull_options, is_plain=is_plain, incremental=incremental):
            self.furthest_site = False
        else:
            super().__init__(points, furthest_site, incremental, qhull_options)

    def _solve(self, points: Floats) -> Ids:
        self.triangulation = _triangulated(points)
        self.simplices = self.vertices = self.triangulation.simplices
        self.neighbors = self.triangulation.neighbors
        self.nsimplex = len(self.simplices)
        self.good = np.ones(self.nsimplex, dtype=np.intc)
        self.paraboloid_scale, self.paraboloid_shift = 1.0, 0.0
        self._equations = self._coplanar = None
        self._transform = self._vertex_to_simplex = self._vertex_neighbor_vertices = None
        return self.triangulation.hull.ravel()

    @property
    def equations(self) -> Floats:
        """Unit normals and offsets of the facets of the paraboloid, of shape (m, d + 2); calculated when first asked for."""
        if self._equations is None and self.triangulation is not None:
            centers = self.triangulation.circumcenters()
            # A sphere through lifted points is a plane: z = 2 c x + k. The flattest simplices have no finite one.
            centers[~np.isfinite(centers).all(axis=1)] = 0
            first = self._points[self.simplices[:, 0]]
            offset = (first * (first - 2 * centers)).sum(axis=1)
            length = np.sqrt(4 * np.square(centers).sum(axis=1) + 1)
            planes = np.column_stack([2 * centers, np.full(len(centers), -1.0), offset])
            self._equations = planes / length[:, None]
        assert self._equations is not None
        return self._equations

    @equations.setter
    def equations(self, equations: Floats) -> None:
        self._equations = equations

    @property
    def coplanar(self) -> Ids:
        """Rows that are no vertices, as they equal earlier ones, each with a simplex and the row it equals."""
        if self._coplanar is None and self.triangulation is not None:
            pairs = self.triangulation.duplicates
            simplex_of = np.full(self.npoints, -1, dtype=np.int32)
            simplex_of[self.simplices] = np.arange(self.nsimplex, dtype=np.int32)[:, None]
            self._coplanar = np.column_stack([pairs[:, 0], simplex_of[pairs[:, 1]], pairs[:, 1]]).astype(np.intc)
        assert self._coplanar is not None
        return self._coplanar

    @coplanar.setter
    def coplanar(self, coplanar: Ids) -> None:
        self._coplanar = coplanar

    def find_simplex(self, xi: ArrayLike, bruteforce: bool = False, tol: float | None = None) -> Ids:
        """The simplex that holds each place of shape (..., d), exactly; -1 outside. With `tol` SciPy's own search is run."""
        if self.triangulation is None or tol is not None:
            found: Ids = super().find_simplex(xi, bruteforce=bruteforce, tol=tol)
            return found
        places = np.asanyarray(xi)
        if places.shape[-1] != self.ndim:
            raise ValueError("wrong dimensionality in xi")
        shape = places.shape[:-1]
        # Places that are not finite are in no simplex.
        return self.triangulation.locate(places.reshape(-1, self.ndim)).reshape(shape)


class Voronoi(_Native, scipy.spatial.Voronoi):  # type: ignore[misc]
    """`scipy.spatial.Voronoi`, exact.

    Vertices are merged where they are one exactly, not to a tolerance. Region 0 is empty, and that of row i of distinct points is
    i + 1 (without the empty one i, where options of Qhull are given without "Qz"); equal rows have one region.

    Parameters
    ----------
    points : array_like of shape (n, d)
        The points.
    furthest_site : bool, default False
        Done by SciPy.
    incremental : bool, default False
        Allows `add_points`, which builds the diagram again.
    qhull_options : str, optional
        Done by SciPy where it asks for more than to get along with rounding.

    Attributes
    ----------
    triangulation : Triangulation or None
        The triangulation with all its methods; None where SciPy did the work.
    is_native : bool
        Whether taut did the work.

    Examples
    --------
    >>> from taut.spatial import Voronoi
    >>> diagram = Voronoi([[0, 0], [2, 0], [2, 2], [0, 2]])
    >>> diagram.vertices, diagram.regions[1]
    (array([[1., 1.]]), [-1, 0])
    """

    def __init__(
        self,
        points: ArrayLike,
        furthest_site: bool = False,
        incremental: bool = False,
        qhull_options: str | None = None,
    ) -> None:
        self.triangulation: Triangulation | None = None
        is_plain = not furthest_site and _is_plain(qhull_options, incremental, {"Qc"})
        # The region of the point at infinity that "Qz", a default of SciPy, adds.
        self._offset = int(qhull_options is None or "Qz" in qhull_options)
        if self._begin(points, qhull_options, is_plain=is_plain, incremental=incremental):
            self.furthest_site = False
        else:
            super().__init__(points, furthest_site, incremental, qhull_options)

    def _solve(self, points: Floats) -> Ids:
        self.triangulation = _triangulated(points)
        lists = self.triangulation.voronoi_lists(self._offset)
        self.vertices, self.ridge_points, self.ridge_vertices, self.regions, point_region = lists
        self.point_region = point_region.astype(np.intp, copy=False)
        self._ridge_dict = None
        return self.triangulation.hull.ravel()


class ConvexHull(_Native, scipy.spatial.ConvexHull):  # type: ignore[misc]
    """`scipy.spatial.ConvexHull`, exact: vertices are the extreme points and no others.

    Parameters
    ----------
    points : array_like of shape (n, d)
        The points.
    incremental : bool, default False
        Allows `add_points`, which builds the hull again.
    qhull_options : str, optional
        Done by SciPy where it asks for more than to get along with rounding.

    Attributes
    ----------
    polytope : Polytope or None
        The hull with its faces; None where SciPy did the work.
    is_native : bool
        Whether taut did the work.

    Examples
    --------
    >>> from taut.spatial import ConvexHull
    >>> found = ConvexHull([[0, 0], [1, 0], [2, 0], [2, 2], [0, 2], [1, 1]])
    >>> found.vertices, found.volume, found.area
    (array([0, 2, 3, 4], dtype=int32), 4.0, 8.0)
    """

    def __init__(self, points: ArrayLike, incremental: bool = False, qhull_options: str | None = None) -> None:
        self.polytope: Polytope | None = None
        if not self._begin(points, qhull_options, is_plain=_is_plain(qhull_options, incremental, set()), incremental=incremental):
            super().__init__(points, incremental, qhull_options)

    def _solve(self, points: Floats) -> Ids:
        self.polytope = found = hull(points)
        if found.hull_dimension != points.shape[1]:
            _refuse_flat(points, found.hull_dimension)
        self.simplices, self.neighbors = found.facets, found.neighbors
        self.equations, self.volume, self.area = found.equations, found.volume, found.area
        self.nsimplex = len(self.simplices)
        self.coplanar = np.empty((0, 3), dtype=np.intc)
        self.good = None
        self._vertices = found.vertices
        return found.vertices
