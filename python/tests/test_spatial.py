"""Kept triangulations and hulls, judged by brute force and by SciPy."""

import copy
import pickle
from importlib.util import find_spec

import numpy as np
import pytest

import taut
from taut.spatial import Triangulation, hull

RNG = np.random.default_rng(7)
PLANE, SPACE = RNG.random((400, 2)), RNG.random((300, 3))
GRID = np.stack(np.meshgrid(range(5), range(5)), axis=-1).reshape(-1, 2).astype(float)
CUBES = np.stack(np.meshgrid(range(4), range(4), range(4)), axis=-1).reshape(-1, 3).astype(float)


def barycentric(triangulation, places, found):
    """Coordinates of places in the simplices that were found for them."""
    corners = triangulation.points[triangulation.simplices[found]]
    edges = (corners[:, 1:] - corners[:, :1]).transpose(0, 2, 1)
    weights = np.linalg.solve(edges, (places - corners[:, 0])[:, :, None])[:, :, 0]
    return np.column_stack([1 - weights.sum(axis=1), weights])


@pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
def test_places_are_in_the_simplices_found(points):
    triangulation = Triangulation(points)
    places = RNG.random((5000, points.shape[1])) * 1.2 - 0.1
    found = triangulation.locate(places)
    assert found.dtype == np.int32
    inside = found >= 0
    assert 0.4 < inside.mean() < 1
    assert barycentric(triangulation, places[inside], found[inside]).min() > -1e-9
    # Outside, some facet of the hull sees the place.
    equations = hull(points).equations
    beyond = (places @ equations[:, :-1].T + equations[:, -1]).max(axis=1)
    assert (beyond[~inside] > -1e-12).all() and (beyond[inside] < 1e-12).all()
    distances = np.sqrt(np.square(places[:, None] - points).sum(axis=2))
    np.testing.assert_array_equal(triangulation.nearest(places), distances.argmin(axis=1))


def test_answers_do_not_depend_on_what_else_is_asked():
    triangulation = Triangulation(CUBES)
    places = np.stack(np.meshgrid(*[np.arange(0, 3.5, 0.5)] * 3), axis=-1).reshape(-1, 3)
    found = triangulation.locate(places)
    assert (found >= 0).all()
    np.testing.assert_array_equal([triangulation.locate([place])[0] for place in places], found)
    assert triangulation.locate([[np.nan, 0, 0], [np.inf, 0, 0]]).tolist() == [-1, -1]
    assert triangulation.locate(np.empty((0, 3))).shape == (0,)
    with pytest.raises(ValueError, match="places have dimension 2, but the triangulation has dimension 3"):
        triangulation.locate([[0, 0]])


def test_order_of_places_does_not_matter():
    triangulation = Triangulation(SPACE)
    # Along a curve walks are short, and places are answered as they come; shuffled they are sorted.
    t = np.linspace(0, 20, 20011)
    places = np.column_stack([0.5 + 0.6 * np.sin(t), 0.5 + 0.4 * np.cos(1.7 * t), 0.05 * t])
    found = triangulation.locate(places)
    assert 0.2 < (found >= 0).mean() < 0.9
    order = RNG.permutation(len(places))
    np.testing.assert_array_equal(triangulation.locate(places[order]), found[order])
    inside = found >= 0
    assert barycentric(triangulation, places[inside], found[inside]).min() > -1e-9


def sets_of_all_kinds(dim):
    """Random, with duplicates, on a grid, on a circle or sphere, on both sides of a gap, far from the origin."""
    rng = np.random.default_rng(dim)
    points = rng.random((150, dim))
    ball = rng.normal(size=(60, dim))
    ball /= np.sqrt(np.square(ball).sum(axis=1))[:, None]
    return {
        "random": points,
        "duplicates": np.vstack([points, points[::3], points[:9]]),
        "grid": CUBES if dim == 3 else GRID,
        "sphere": ball,
        "gap": np.vstack([points, points + 1e3]),
        "far": points + 1e6,
    }


ALL_KINDS = [(name, dim) for dim in (2, 3) for name in sets_of_all_kinds(dim)]


@pytest.mark.parametrize(("name", "dim"), ALL_KINDS)
def test_places_at_boundaries_are_in_the_lowest_simplex(name, dim):
    points = sets_of_all_kinds(dim)[name]
    triangulation = Triangulation(points)
    corners = points[triangulation.simplices]
    at_corners = triangulation.locate(points)
    # A corner is in all simplices that have a row of its coordinates.
    _, place = np.unique(points, axis=0, return_inverse=True)
    first = np.full(place.max() + 1, len(corners))
    np.minimum.at(first, place.ravel()[triangulation.simplices], np.arange(len(corners))[:, None])
    np.testing.assert_array_equal(at_corners, first[place.ravel()])
    # Far outside, not finite, and the middle of each simplex.
    far = points.mean(axis=0) + 1e9 * np.vstack([np.eye(dim), -np.eye(dim)])
    assert (triangulation.locate(far) == -1).all()
    assert (triangulation.locate(np.full((3, dim), np.nan)) == -1).all()
    middles = corners.mean(axis=1)
    volumes = np.abs(np.linalg.det(corners[:, 1:] - corners[:, :1]))
    fat = volumes > 1e-6 * np.ptp(points, axis=0).prod()
    np.testing.assert_array_equal(triangulation.locate(middles)[fat], np.flatnonzero(fat))


@pytest.mark.parametrize(("name", "dim"), ALL_KINDS)
def test_lists_are_those_of_the_arrays(name, dim):
    triangulation = Triangulation(sets_of_all_kinds(dim)[name])
    diagram = triangulation.voronoi()
    vertices, ridge_points, ridges, regions, point_region = triangulation.voronoi_lists(2)
    np.testing.assert_array_equal(vertices, diagram.vertices)
    np.testing.assert_array_equal(ridge_points, diagram.ridge_points)
    assert sum(ridges, []) == diagram.ridge_vertices.tolist()
    assert [len(ridge) for ridge in ridges] == np.diff(diagram.ridge_starts).tolist()
    assert regions[:2] == [[], []] and sum(regions, []) == diagram.region_vertices.tolist()
    assert [len(region) for region in regions[2:]] == np.diff(diagram.region_starts).tolist()
    assert point_region[diagram.region_rows].tolist() == list(range(2, len(regions)))
    rows, firsts = triangulation.duplicates.T
    np.testing.assert_array_equal(point_region[rows], point_region[firsts])
    # The vertices of a region are the centers of the simplices around its row, and of no others.
    for row in diagram.region_rows.tolist():
        around = diagram.of_simplices[(triangulation.simplices == row).any(axis=1)]
        assert set(regions[point_region[row]]) - {-1} == set(around.tolist())


def test_points_that_were_changed_have_no_certificate():
    points = SPACE.copy()
    triangulation = Triangulation(points)
    triangulation.solution.check(points)
    points[0] += 1e-9
    with pytest.raises(ValueError, match="the points were changed"):
        triangulation.solution


def test_simplices_are_those_of_the_function():
    found = taut.delaunay(SPACE)
    triangulation = Triangulation(SPACE)
    np.testing.assert_array_equal(triangulation.simplices, found.simplices)
    np.testing.assert_array_equal(triangulation.neighbors, found.neighbors)
    np.testing.assert_array_equal(triangulation.hull, found.hull)
    assert triangulation.solution == found
    assert triangulation.solution.check(SPACE).ties == 0
    for again in (pickle.loads(pickle.dumps(triangulation)), copy.deepcopy(triangulation)):
        np.testing.assert_array_equal(again.simplices, triangulation.simplices)


@pytest.mark.parametrize("method", ["natural", "linear"])
@pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
def test_linear_functions_are_interpolated_exactly(points, method):
    slope = np.arange(1, points.shape[1] + 1)
    places = 0.2 + 0.6 * RNG.random((300, points.shape[1]))
    triangulation = Triangulation(points)
    found = triangulation.interpolate(points @ slope, places, method=method)
    np.testing.assert_allclose(found, places @ slope, rtol=1e-8)
    assert np.isnan(triangulation.interpolate(points @ slope, places + 9, method=method)).all()
    starts, rows, weights = triangulation.natural_coordinates(places)
    sums = np.add.reduceat(weights[:, None] * points[rows], starts[:-1])
    np.testing.assert_allclose(sums, places, rtol=1e-8)


def test_wrong_arguments_are_named():
    triangulation = Triangulation(PLANE)
    with pytest.raises(ValueError, match=r"values have shape \(3,\): expected \(400,\)"):
        triangulation.interpolate([1, 2, 3], [[0, 0]])
    with pytest.raises(ValueError, match="method is 'cubic'"):
        triangulation.interpolate(np.zeros(400), [[0, 0]], method="cubic")
    with pytest.raises(ValueError, match="segments have shape"):
        triangulation.constrained([1, 2])
    with pytest.raises(ValueError, match="there are 400 rows"):
        triangulation.constrained([[0, 400]])
    with pytest.raises(ValueError, match="in the plane"):
        Triangulation(SPACE).constrained([[0, 1]])
    with pytest.raises(ValueError, match="2, the plane"):
        Triangulation(np.zeros((5, 4)))
    with pytest.raises(ValueError, match="coordinate 1 of point 1"):
        hull([[0, 0], [1, np.nan]])


@pytest.mark.parametrize("points, cells", [(GRID, 16), (CUBES, 27)], ids=["squares", "cubes"])
def test_groups_and_diagrams_of_grids_are_their_cells(points, cells):
    triangulation = Triangulation(points)
    groups = triangulation.cospherical_groups()
    assert len(np.unique(groups)) == cells
    diagram = triangulation.voronoi()
    assert len(diagram.vertices) == cells
    np.testing.assert_allclose(diagram.vertices[diagram.of_simplices], triangulation.circumcenters(), atol=1e-12)
    steps = np.abs(points[diagram.ridge_points[:, 0]] - points[diagram.ridge_points[:, 1]]).sum(axis=1)
    np.testing.assert_array_equal(steps, 1)


def test_polygons_have_one_vertex_of_the_diagram():
    # Exactly on a circle, which the corners of a regular octagon are not in floating point.
    points = np.array([[3, 4], [4, 3], [5, 0], [4, -3], [3, -4], [0, -5], [-3, -4], [-5, 0], [-4, 3], [0, 5]])
    diagram = Triangulation(points).voronoi()
    np.testing.assert_allclose(diagram.vertices, [[0, 0]], atol=1e-12)
    assert len(diagram.ridge_points) == 10


def test_alpha_complex_is_bounded_by_its_radius():
    triangulation = Triangulation(PLANE)
    centers = triangulation.circumcenters()
    radii = np.sqrt(np.square(centers - PLANE[triangulation.simplices[:, 0]]).sum(axis=1))
    for alpha in (0.02, 0.05, 0.5):
        found = triangulation.alpha_complex(alpha)
        np.testing.assert_array_equal(found.simplices, np.flatnonzero(radii <= alpha))
        edges = triangulation.simplices[found.simplices][:, [[1, 2], [2, 0], [0, 1]]].reshape(-1, 2)
        counts = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)[1]
        assert (counts == 1).sum() == len(found.boundary)


def test_constrained_edges_are_edges():
    triangulation = Triangulation(PLANE)
    ring = hull(PLANE[50:90]).vertices + 50
    segments = np.column_stack([ring, np.roll(ring, -1)])
    found = triangulation.constrained(segments, ring=True)
    edges = {tuple(sorted(edge)) for t in found.simplices.tolist() for edge in zip(t, t[1:] + t[:1])}
    assert all(tuple(sorted(segment)) in edges for segment in segments.tolist())
    corners = PLANE[found.simplices]
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    areas = 0.5 * (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])
    assert areas.min() > 0
    assert areas[found.is_inside].sum() == pytest.approx(hull(PLANE[50:90]).volume)
    assert found.is_constrained.sum() == 2 * len(segments)


def test_hulls_of_flat_sets_are_no_errors():
    assert hull([[0, 0, 0], [1, 1, 1], [2, 2, 2]]).vertices.tolist() == [0, 2]
    square = hull([[0, 0, 1], [2, 0, 1], [2, 2, 1], [0, 2, 1], [1, 1, 1]])
    assert square.hull_dimension == 2 and square.vertices.tolist() == [0, 1, 2, 3]
    with pytest.raises(ValueError, match="span 2 of 3 dimensions"):
        square.volume
    assert hull(np.empty((0, 2))).hull_dimension is None
    assert Triangulation([[0, 0], [1, 1], [2, 2]]).locate([[1, 1]]).tolist() == [-1]


def test_hull_of_cubes_is_one_cube():
    found = hull(CUBES)
    assert len(found.vertices) == 8 and found.volume == 27 and found.area == 54
    assert sorted(map(tuple, np.unique(found.equations, axis=0).tolist())) == sorted(
        [(1, 0, 0, -3), (-1, 0, 0, 0), (0, 1, 0, -3), (0, -1, 0, 0), (0, 0, 1, -3), (0, 0, -1, 0)]
    )


@pytest.mark.skipif(find_spec("scipy") is None, reason="SciPy is not installed")
class TestDropIns:
    @pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
    def test_delaunay_has_what_scipy_has(self, points):
        from scipy.spatial import Delaunay as Theirs

        from taut.spatial import Delaunay

        ours, theirs = Delaunay(points), Theirs(points)
        assert ours.is_native and isinstance(ours, Theirs)
        assert {tuple(sorted(s)) for s in ours.simplices.tolist()} == {tuple(sorted(s)) for s in theirs.simplices.tolist()}
        for name in vars(theirs):
            assert hasattr(ours, name), name
        for name in ("simplices", "neighbors", "equations", "coplanar", "transform", "vertex_to_simplex", "convex_hull"):
            mine, other = getattr(ours, name), getattr(theirs, name)
            assert (mine.dtype, mine.shape) == (other.dtype, other.shape), name
        places = RNG.random((2000, points.shape[1]))
        found, expected = ours.find_simplex(places), theirs.find_simplex(places)
        assert found.dtype == expected.dtype
        np.testing.assert_array_equal(found >= 0, expected >= 0)
        inside = found >= 0
        np.testing.assert_array_equal(
            np.sort(ours.simplices[found[inside]], axis=1), np.sort(theirs.simplices[expected[inside]], axis=1)
        )
        # The search of SciPy over our arrays, with its own hyperplanes and transforms.
        np.testing.assert_array_equal(ours.find_simplex(places, tol=1e-12), found)
        assert ours.find_simplex(places.reshape(20, 100, -1)).shape == (20, 100)
        for again in (pickle.loads(pickle.dumps(ours)), copy.deepcopy(ours)):
            np.testing.assert_array_equal(again.find_simplex(places), found)

    def test_interpolators_of_scipy_run_on_it(self):
        from scipy.interpolate import CloughTocher2DInterpolator, LinearNDInterpolator
        from scipy.spatial import Delaunay as Theirs

        from taut.spatial import Delaunay

        values = np.sin(5 * PLANE[:, 0]) + PLANE[:, 1]
        places = RNG.random((1000, 2))
        for kind in (LinearNDInterpolator, CloughTocher2DInterpolator):
            np.testing.assert_allclose(kind(Delaunay(PLANE), values)(places), kind(Theirs(PLANE), values)(places), atol=1e-5)

    def test_plots_of_scipy_and_matplotlib_run_on_it(self):
        matplotlib = pytest.importorskip("matplotlib", reason="matplotlib is not installed")
        matplotlib.use("Agg")
        from matplotlib import pyplot
        from scipy.spatial import convex_hull_plot_2d, delaunay_plot_2d, voronoi_plot_2d

        from taut.spatial import ConvexHull, Delaunay, Voronoi

        figure, axes = pyplot.subplots()
        voronoi_plot_2d(Voronoi(PLANE), ax=axes)
        delaunay_plot_2d(Delaunay(PLANE), ax=axes)
        convex_hull_plot_2d(ConvexHull(PLANE), ax=axes)
        axes.tripcolor(PLANE[:, 0], PLANE[:, 1], Delaunay(PLANE).simplices, PLANE[:, 0])
        assert len(axes.collections) >= 3
        pyplot.close(figure)

    @pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
    def test_diagrams_are_those_of_scipy(self, points):
        from scipy.spatial import Voronoi as Theirs

        from taut.spatial import Voronoi

        ours, theirs = Voronoi(points), Theirs(points)
        assert ours.is_native and isinstance(ours, Theirs)
        assert ours.vertices.shape == theirs.vertices.shape
        nearest = np.sqrt(np.square(ours.vertices[:, None] - theirs.vertices).sum(axis=2)).argmin(axis=1)
        assert len(np.unique(nearest)) == len(nearest)
        number = np.append(nearest, -1)
        for row in range(len(points)):
            mine, other = ours.regions[ours.point_region[row]], theirs.regions[theirs.point_region[row]]
            assert sorted(number[mine]) == sorted(other)
        # Qhull leaves out the ridges with one vertex that is not at infinity.
        most = points.shape[1]
        mine = {tuple(sorted(pair)): sorted(number[v]) for pair, v in ours.ridge_dict.items() if len(v) >= most}
        other = {tuple(sorted(pair)): sorted(v) for pair, v in theirs.ridge_dict.items()}
        assert mine == other

    @pytest.mark.parametrize("points", [PLANE, SPACE], ids=["plane", "space"])
    def test_hulls_are_those_of_scipy(self, points):
        from scipy.spatial import ConvexHull as Theirs

        from taut.spatial import ConvexHull

        ours, theirs = ConvexHull(points), Theirs(points)
        assert ours.is_native and isinstance(ours, Theirs)
        assert sorted(ours.vertices) == sorted(theirs.vertices)
        assert {tuple(sorted(s)) for s in ours.simplices.tolist()} == {tuple(sorted(s)) for s in theirs.simplices.tolist()}
        assert ours.volume == pytest.approx(theirs.volume) and ours.area == pytest.approx(theirs.area)
        np.testing.assert_allclose(np.sort(ours.equations, axis=0), np.sort(theirs.equations, axis=0), atol=1e-12)
        for name in vars(theirs):
            assert hasattr(ours, name), name

    @pytest.mark.parametrize(("name", "dim"), ALL_KINDS)
    def test_all_kinds_of_sets_are_solved_as_by_scipy(self, name, dim):
        import scipy.spatial

        from taut.spatial import ConvexHull, Delaunay, Voronoi

        points = sets_of_all_kinds(dim)[name]
        ours, theirs = Delaunay(points), scipy.spatial.Delaunay(points)
        np.testing.assert_array_equal(ours.min_bound, theirs.min_bound)
        np.testing.assert_array_equal(ours.max_bound, theirs.max_bound)
        rng = np.random.default_rng(5)
        places = points.min(axis=0) + rng.random((3000, dim)) * np.ptp(points, axis=0) * 1.1
        if name == "gap":
            places = points[:150] + rng.random((20, 150, 1)) * (points[150:] - points[:150][::-1])
        found, expected = ours.find_simplex(places), theirs.find_simplex(places)
        assert ((found >= 0) == (expected >= 0)).mean() > 0.999
        if name in ("random", "gap"):
            both = (found >= 0) & (expected >= 0)
            mine, other = np.sort(ours.simplices[found[both]], axis=1), np.sort(theirs.simplices[expected[both]], axis=1)
            assert (mine == other).all(axis=1).mean() > 0.99
        hulls = ConvexHull(points), scipy.spatial.ConvexHull(points)
        assert hulls[0].volume == pytest.approx(hulls[1].volume) and hulls[0].area == pytest.approx(hulls[1].area)
        assert {tuple(p) for p in points[hulls[0].vertices]} <= {tuple(p) for p in points[hulls[1].vertices]}
        diagram = Voronoi(points)
        np.testing.assert_array_equal(diagram.min_bound, theirs.min_bound)
        assert all(type(number) is int for region in diagram.regions for number in region)
        if name in ("random", "grid"):
            assert len(diagram.vertices) == len(scipy.spatial.Voronoi(points).vertices)
        broken = points.copy()
        broken[7, 1] = np.nan
        for kind in (Delaunay, Voronoi, ConvexHull):
            with pytest.raises(ValueError, match="coordinate 1 of point 7"):
                kind(broken)

    @pytest.mark.parametrize("name", ["cube", "normal", "sphere", "skew", "twice"])
    def test_hulls_of_many_points_are_those_of_scipy(self, name):
        import scipy.spatial

        from taut.spatial import ConvexHull

        rng = np.random.default_rng(11)
        normal = rng.normal(size=(30000, 3))
        points = {
            "cube": rng.random((30000, 3)),
            "normal": normal,
            "sphere": normal[:3000] / np.sqrt(np.square(normal[:3000]).sum(axis=1))[:, None],
            "skew": normal @ [[1, 2, 0], [0, 1, 3], [0, 0, 0.01]] + 50,
            "twice": np.vstack([normal[:9000], normal[:9000]]),
        }[name]
        ours, theirs = ConvexHull(points), scipy.spatial.ConvexHull(points)
        np.testing.assert_array_equal(*(np.unique(points[found.vertices], axis=0) for found in (ours, theirs)))
        assert ours.volume == pytest.approx(theirs.volume, rel=1e-12)
        np.testing.assert_array_equal(ours.max_bound, points.max(axis=0))

    def test_more_points_are_added_by_building_again(self):
        from taut.spatial import ConvexHull, Delaunay, Voronoi

        for kind in (Delaunay, Voronoi, ConvexHull):
            found = kind(PLANE[:100], incremental=True)
            found.add_points(PLANE[100:])
            assert found.npoints == 400
            expected = kind(PLANE)
            if kind is not Voronoi:
                np.testing.assert_array_equal(found.simplices, expected.simplices)
            found.close()
            with pytest.raises(RuntimeError, match="incremental mode"):
                found.add_points(PLANE)

    def test_scipy_does_the_rest(self):
        from scipy.spatial import QhullError

        from taut.spatial import ConvexHull, Delaunay, Voronoi

        four = RNG.random((30, 4))
        for kind in (Delaunay, Voronoi, ConvexHull):
            assert not kind(four).is_native
            assert not kind(PLANE, qhull_options="QJ Qs").is_native
            # What only helps with rounding is nothing to ask for, unless equal points are to be vertices each.
            assert kind(PLANE, qhull_options="QJ Pp").is_native
            assert not kind(np.vstack([PLANE, PLANE]), qhull_options="QJ").is_native
            with pytest.raises(ValueError):
                kind(PLANE, qhull_options="Qz", incremental=True)
            with pytest.raises(QhullError, match="span 1 of 2 dimensions"):
                kind([[0, 0], [1, 1], [2, 2], [3, 3]])
            with pytest.raises(ValueError):
                kind(np.ma.masked_all((3, 2)))
        assert not Delaunay(PLANE, furthest_site=True).is_native
        repeated = Delaunay(np.vstack([PLANE[:30], PLANE[:30]]))
        assert sorted(repeated.coplanar[:, 2]) == list(range(30))
        diagram = Voronoi(np.vstack([PLANE[:30], PLANE[:30]]))
        np.testing.assert_array_equal(diagram.point_region[:30], diagram.point_region[30:])
