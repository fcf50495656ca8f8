"""Centers: their shapes and options, what is proved of them, and how they travel."""

import itertools
import json
import math
import pickle

import numpy as np
import pytest

import taut


@pytest.fixture(scope="module")
def points():
    return taut.generate("clusters", 300, 2, seed=4)


def reach(points, centers):
    """The distance of each point to the nearest center."""
    return np.sqrt(((points[:, None, :] - centers[None, :, :]) ** 2).sum(axis=2)).min(axis=1)


def least_radius(points, k):
    """By all partitions into at most k parts: the least largest radius of their balls."""
    n = len(points)
    ball = {
        part: taut.ball(points[list(part)], epsilon=0).answer.radius
        for size in range(1, n + 1)
        for part in itertools.combinations(range(n), size)
    }
    best = np.inf
    for colors in itertools.product(range(k), repeat=n):
        parts = [tuple(i for i in range(n) if colors[i] == c) for c in range(k)]
        best = min(best, max(ball[part] for part in parts if part))
    return best


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_every_point_is_near_a_center_and_the_bound_is_proved(points, dtype):
    points = points.astype(dtype)
    found = taut.centers(points, 4, epsilon=1e-6, assignment=True)
    answer, certificate = found.answer, found.certificate
    assert answer.centers.shape == (4, 2) and answer.centers.dtype == np.float64
    distances = reach(points.astype(np.float64), answer.centers)
    assert distances.max() <= answer.radius
    assert distances.max() == pytest.approx(answer.radius, rel=1e-12)
    assert 0 < answer.lower_bound <= answer.radius <= (1 + 1e-6) * answer.lower_bound
    assert answer.assignment.shape == (300,) and answer.assignment.dtype == np.uint32
    gaps = points[:, None, :].astype(np.float64) - answer.centers[None, :, :]
    assert (answer.assignment == (gaps**2).sum(axis=2).argmin(axis=1)).all()
    assert (answer.rows.shape, answer.outliers.shape) == ((0,), (0,))
    assert (certificate.k, certificate.items, certificate.discrete) == (4, "points", False)
    assert certificate.core_set.ndim == 1 and len(certificate.core_set) > 4
    assert certificate.proof in ("apart", "branches")
    verdict = found.check(points)
    assert (verdict.lower, verdict.upper) == (answer.lower_bound, answer.radius)
    assert verdict.gap <= 1e-6
    assert taut.centers(points, 4).answer.assignment is None


@pytest.mark.parametrize("k", [1, 2, 3])
def test_small_sets_have_the_least_radius_of_all_partitions(k):
    points = taut.generate("uniform", 8, 2, seed=k)
    found = taut.centers(points, k, epsilon=1e-9)
    assert found.answer.radius == pytest.approx(least_radius(points, k), rel=1e-8)


def test_one_center_is_the_smallest_ball(points):
    assert taut.centers(points, 1, epsilon=1e-9).answer.radius == pytest.approx(
        taut.ball(points).answer.radius, rel=2e-9
    )


@pytest.mark.parametrize(
    ("method", "gap"), [("tree", 0.01), ("thesis", 0.01), ("farthest-first", 1 + 1e-9), ("stream", 1.97)]
)
def test_methods_share_one_kind_of_proof(points, method, gap):
    found = taut.centers(points, 3, method=method)
    assert found.trace.method == method
    assert found.check(points).gap <= gap


@pytest.mark.parametrize(
    ("options", "message"),
    [({"outliers": 1}, "outliers"), ({"assignment": True}, "assignment"), ({"radii": np.ones(300)}, "balls")],
)
def test_a_stream_knows_plain_points_only(points, options, message):
    with pytest.raises(ValueError, match=message):
        taut.centers(points, 3, method="stream", **options)


def test_discrete_centers_are_rows_and_the_best_of_all(points):
    few = points[:30]
    found = taut.centers(few, 2, epsilon=0, discrete=True)
    assert (few[found.answer.rows] == found.answer.centers).all()
    pairs = itertools.combinations(range(30), 2)
    assert found.answer.radius == pytest.approx(min(reach(few, few[list(pair)]).max() for pair in pairs), rel=1e-14)
    assert found.certificate.discrete
    assert found.check(few).gap <= 1e-9


def test_outliers_are_left_out(points):
    far = np.vstack([points, [[50, 50], [-50, 3]]])
    found = taut.centers(far, 3, outliers=2)
    assert found.answer.outliers.tolist() == [300, 301]
    assert found.answer.outliers.dtype == np.int64
    assert found.answer.radius < 1
    assert found.check(far).gap <= 0.01


def test_weights_count():
    found = taut.centers([[0.0], [3.0]], 1, weights=[2, 1], epsilon=1e-9)
    assert found.answer.radius == pytest.approx(2.0, rel=1e-8)
    assert found.answer.centers[0, 0] == pytest.approx(1.0, rel=1e-8)
    assert found.certificate.weights
    assert found.check([[0.0], [3.0]], weights=[2, 1]).gap <= 1e-8
    with pytest.raises(ValueError, match="give their weights"):
        found.check([[0.0], [3.0]])
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check([[0.0], [3.0]], weights=[2, 1.5])


def test_balls_are_held_whole():
    places, radii = [[0, 0], [4, 0], [100, 0]], [1, 2, 3]
    found = taut.centers(places, 2, radii=radii, epsilon=1e-9)
    assert found.answer.radius == pytest.approx(3.5, rel=1e-8)
    assert found.certificate.items == "balls"
    assert found.check(places, radii).gap <= 1e-8
    with pytest.raises(ValueError, match="give their radii"):
        found.check(places)


def test_a_budget_of_nodes_is_told(points):
    found = taut.centers(points, 10, epsilon=1e-6, max_nodes=1)
    assert found.trace.stop == "node-budget"
    assert found.check(points).gap <= found.certificate.gap * (1 + 1e-9)


def test_threads_do_not_matter(points):
    for options in ({}, {"discrete": True}, {"outliers": 3}):
        found = taut.centers(points, 3, threads=1, **options)
        assert taut.centers(points, 3, threads=3, **options) == found
        assert taut.centers(points, 3, threads=3, **options).to_json() == found.to_json()


def test_answers_travel_and_lies_are_found(points):
    found = taut.centers(points, 3)
    assert pickle.loads(pickle.dumps(found)) == found
    assert found.kind == "centers"
    assert repr(found).startswith("Solution(kind='centers', k=3, radius=")
    assert taut.verify(found.to_json(), points).upper == found.answer.radius
    document = json.loads(found.to_json())
    document["answer"]["radius"] *= 0.999
    document["answer"]["lower_bound"] *= 0.999
    with pytest.raises(taut.Violation, match="outside the radius"):
        taut.verify(json.dumps(document), points)
    document = json.loads(found.to_json())
    document["answer"]["lower_bound"] = document["answer"]["radius"]
    document["answer"]["radius"] *= 1.05
    with pytest.raises(taut.Violation):
        taut.verify(json.dumps(document), points)
    changed = points.copy()
    changed[0, 0] += 1
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check(changed)
    with pytest.raises(ValueError, match="which have no radii"):
        found.check(points, np.ones(len(points)))
    with pytest.raises(AttributeError, match="centers have no simplices"):
        _ = found.simplices
    with pytest.raises(ValueError, match="read-only"):
        found.answer.centers[0, 0] = 0


@pytest.mark.parametrize(
    ("k", "options", "message"),
    [
        (0, {}, "`k` is 0"),
        (-1, {}, "`k` is -1: expected at least 1"),
        (2, {"epsilon": 1}, "epsilon"),
        (2, {"method": "lloyd"}, "expected tree, thesis, farthest-first or stream"),
        (2, {"outliers": 300}, "outliers"),
        (2, {"outliers": -1}, "outliers"),
        (2, {"threads": 0}, "threads"),
        (2, {"method": "thesis", "discrete": True}, "thesis"),
        (2, {"radii": np.ones(300), "weights": np.ones(300)}, "only one of radii and weights"),
        (2, {"weights": np.zeros(300)}, "the weight of point 0 is 0: all weights must be more than 0"),
        (2, {"weights": np.full(300, np.nan)}, "the weight of point 0 is NaN: all weights must be finite"),
        (2, {"weights": np.ones(2)}, "300 points, but 2 weights"),
        (2, {"radii": -np.ones(300)}, "the radius of ball 0 is -1"),
    ],
)
def test_wrong_options_are_named(points, k, options, message):
    with pytest.raises(ValueError, match=message):
        taut.centers(points, k, **options)


def test_wrong_points_are_named():
    with pytest.raises(ValueError, match="coordinate 1 of point 0 is NaN"):
        taut.centers([[0, np.nan]], 1)
    with pytest.raises(ValueError, match="empty"):
        taut.centers(np.zeros((0, 2)), 1)
    with pytest.raises(TypeError):
        taut.centers([[0, 1]], 1.5)


def test_copies_and_spare_centers_need_no_radius():
    found = taut.centers([[1, 2], [1, 2], [3, 4]], 5)
    assert (found.answer.radius, found.answer.lower_bound) == (0.0, 0.0)
    assert len(found.answer.centers) <= 5
    assert found.check([[1, 2], [1, 2], [3, 4]]).gap == 0.0


def test_farthest_first_is_what_its_definition_says(points):
    found = taut.farthest_first(points, 40, start=7)
    assert found.order[0] == 7
    assert found.order.dtype == np.int64 and found.radii.shape == (40,)
    for k in range(1, 40):
        distances = reach(points, points[found.order[:k]])
        assert distances.max() == pytest.approx(found.radii[k - 1], rel=1e-12)
        assert distances[found.order[k]] == pytest.approx(distances.max(), rel=1e-12)
    assert found.next is not None
    again = taut.farthest_first(points, 40, start=7, threads=1)
    assert (again.order == found.order).all() and (again.radii == found.radii).all()
    assert repr(found) == f"FarthestFirst(order=<40 numbers>, next={found.next})"


def test_farthest_first_ends_with_the_last_different_point():
    found = taut.farthest_first([[0, 0], [0, 0], [1, 0]], 10)
    assert found.order.tolist() == [0, 2]
    assert found.radii.tolist() == [1.0, 0.0]
    assert found.next is None


@pytest.mark.parametrize(
    ("count", "options", "message"),
    [(0, {}, "count"), (-3, {}, "count"), (2, {"start": 300}, "start"), (2, {"threads": 0}, "threads")],
)
def test_wrong_options_of_farthest_first_are_named(points, count, options, message):
    with pytest.raises(ValueError, match=message):
        taut.farthest_first(points, count, **options)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_a_tree_of_balls_holds_every_point_in_every_node(points, dtype):
    # Far from the origin centers have a tail, which the radii make up for.
    points = (points + [1e6, 0]).astype(dtype)
    tree = taut.sphere_tree(points, leaf_size=4)
    m = len(tree.radii)
    assert (tree.centers.shape, tree.ranges.shape, tree.children.shape) == ((m, 2), (m, 2), (m, 2))
    assert sorted(tree.order) == list(range(300)) and tree.ranges[0].tolist() == [0, 300]
    for i in range(m):
        start, end = tree.ranges[i]
        rows = points[tree.order[start:end]].astype(np.longdouble)
        assert (np.sqrt(((rows - tree.centers[i]) ** 2).sum(axis=1)) <= tree.radii[i] * (1 + 1e-15)).all()
        left, right = tree.children[i]
        if left < 0:
            assert right < 0 and (end - start <= 4 or (rows == rows[0]).all())
        else:
            assert i < left < right
            assert (tree.ranges[left, 0], tree.ranges[right, 1]) == (start, end)
            assert tree.ranges[left, 1] == tree.ranges[right, 0]
    again = taut.sphere_tree(points, leaf_size=4, threads=1)
    assert (again.order == tree.order).all() and (again.radii == tree.radii).all()
    assert repr(tree) == f"SphereTree(centers=<{m} rows>, order=<300 numbers>)"
    with pytest.raises(ValueError, match="read-only"):
        tree.radii[0] = 1


@pytest.mark.parametrize(
    ("rows", "options", "message"),
    [
        ([[0.0]], {"leaf_size": 0}, "leaf_size"),
        ([[0.0]], {"epsilon": 1.0}, "epsilon"),
        ([[0.0], [np.nan]], {}, "coordinate 0 of point 1"),
        (np.zeros((0, 2)), {}, "empty"),
    ],
)
def test_wrong_input_of_a_tree_is_named(rows, options, message):
    with pytest.raises(ValueError, match=message):
        taut.sphere_tree(rows, **options)


def test_groups_are_held_whole():
    ends = np.array([[0.0, 0.0], [0.0, 6.0], [9.0, 0.0], [9.0, 2.0], [1.0, 1.0], [1.0, 2.0]])
    groups = [7, 7, 8, 8, 9, 9]
    found = taut.centers(ends, 2, groups=groups, epsilon=1e-6, assignment=True)
    assert found.answer.radius == pytest.approx(3.0, rel=1e-6)
    assert found.certificate.group == 2
    assert found.answer.assignment[0] == found.answer.assignment[1] != found.answer.assignment[2]
    assert found.check(ends, groups=groups).upper == found.answer.radius
    assert taut.verify(found.to_json(), ends, groups=groups).upper == found.answer.radius
    with pytest.raises(taut.Violation):
        found.check(ends, groups=[7, 7, 8, 8, 9, 8])
    without = taut.centers(ends, 1, groups=groups, outliers=1)
    assert len(without.answer.outliers) == 2
    # Groups of one row each are the rows.
    single = taut.centers(ends, 2, groups=range(6), epsilon=1e-6)
    assert single.answer == taut.centers(ends, 2, epsilon=1e-6).answer
    # The column of groups can be any, as in rows that the command read.
    document = json.loads(found.to_json())
    document["certificate"]["group"] = 0
    other = taut.Solution.from_json(json.dumps(document))
    with pytest.raises(taut.Violation, match="hash"):
        other.check(ends, groups=groups)
    assert taut.centers(ends, 2).certificate.group is None


def test_ellipsoids_are_held_whole():
    places = np.array([[0.0, 0.0], [1.0, 0.0], [9.0, 0.0]])
    shapes = np.array([np.diag([4.0, 4.0]), np.eye(2), np.diag([1.0, 9.0])])
    found = taut.centers(places, 2, shapes=shapes, epsilon=1e-6, assignment=True)
    assert found.answer.radius == pytest.approx(3.0, rel=1e-6)
    assert found.certificate.items == "ellipsoids"
    assert found.certificate.directions.shape == (len(found.certificate.core_set), 2)
    assert found.answer.assignment[0] == found.answer.assignment[1] != found.answer.assignment[2]
    assert found.check(places, shapes=shapes).upper == found.answer.radius
    assert taut.verify(found.to_json(), places, shapes=shapes).gap <= 1e-6
    assert pickle.loads(pickle.dumps(found)) == found
    with pytest.raises(taut.Violation):
        found.check(places, shapes=shapes * 1.01)
    one = taut.centers(places, 1, shapes=shapes, epsilon=1e-9)
    assert one.answer.radius == pytest.approx(taut.ball(places, shapes=shapes).answer.radius, rel=3e-9)
    with pytest.raises(ValueError, match="shapes and groups"):
        taut.centers(places, 1, shapes=shapes, groups=[1, 1, 2])
    with pytest.raises(ValueError, match="only one of"):
        taut.centers(places, 1, shapes=shapes, weights=[1, 1, 2])
    with pytest.raises(ValueError, match="placement|discrete"):
        taut.centers(places, 1, shapes=shapes, discrete=True)
    with pytest.raises(ValueError, match="method"):
        taut.centers(places, 1, shapes=shapes, method="stream")


def test_wrong_groups_are_named():
    ends = [[0.0, 0.0], [0.0, 6.0]]
    with pytest.raises(ValueError, match="2 rows, but 3 groups"):
        taut.centers(ends, 1, groups=[1, 1, 2])
    with pytest.raises(ValueError, match="the group of point 1 is NaN"):
        taut.centers(ends, 1, groups=[1, math.nan])
    with pytest.raises(TypeError, match="groups have dtype"):
        taut.centers(ends, 1, groups=["red", "red"])
    with pytest.raises(ValueError, match="group"):
        taut.centers(ends, 1, groups=[1, 1], method="stream")
    found = taut.centers(ends, 1, groups=[1, 1])
    with pytest.raises(ValueError, match="rows in groups"):
        found.check(ends)
    with pytest.raises(ValueError, match="leave out groups"):
        taut.centers(ends, 1).check(ends, groups=[1, 1])
