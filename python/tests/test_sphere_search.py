"""Queries of points and balls against NumPy, and what is refused."""

import numpy as np
import pytest

import taut

N, M = 400, 30


@pytest.fixture(scope="module", params=[1, 2, 3, 6])
def points(request):
    return taut.generate("clusters", N, request.param, seed=3)


@pytest.fixture(scope="module")
def places(points):
    return taut.generate("normal", M, points.shape[1], seed=4)


def squares_between(a, b):
    """As they are calculated in the tree: axis by axis."""
    total = np.zeros((len(a), len(b)))
    for axis in range(a.shape[1]):
        total += (a[:, None, axis] - b[None, :, axis]) ** 2
    return total


def test_nearest_within_and_farthest(points, places):
    search, squares = taut.SphereSearch(points), squares_between(places, points)
    order = np.lexsort((np.broadcast_to(np.arange(N), squares.shape), squares), axis=1)
    distances = np.sqrt(np.take_along_axis(squares, order, axis=1))
    rows, found = search.nearest(places)
    assert (rows == order[:, 0]).all() and (found == distances[:, 0]).all()
    rows, found = search.nearest(places, k=5)
    assert (rows == order[:, :5]).all() and (found == distances[:, :5]).all()
    assert rows.dtype == np.int64 and found.dtype == np.float64
    assert search.nearest(places, k=N + 7)[0].shape == (M, N)
    rows, found = search.farthest(places)
    assert (found == distances[:, -1]).all() and (rows == squares.argmax(axis=1)).all()
    rows, nearly = search.farthest(places, epsilon=0.3)
    assert (nearly * 1.3 >= found).all()
    radius = distances[0, 20]
    starts, rows, found = search.within(places, radius)
    assert (np.diff(starts) == (distances <= radius).sum(axis=1)).all() and starts[0] == 0
    for i in range(M):
        count = starts[i + 1] - starts[i]
        assert (rows[starts[i] : starts[i + 1]] == order[i, :count]).all()
        assert (found[starts[i] : starts[i + 1]] == distances[i, :count]).all()


def test_pairs_and_diameter(points, places):
    search, squares = taut.SphereSearch(points), squares_between(points, points)
    most = np.sqrt(np.sort(squares[0])[4])
    pairs, distances = search.pairs(most)
    wanted = np.argwhere(np.triu(np.sqrt(squares) <= most, 1))
    assert pairs.tolist() == wanted.tolist()
    assert (distances == np.sqrt(squares)[wanted[:, 0], wanted[:, 1]]).all()
    between = np.sqrt(squares_between(points, places))
    pairs, _ = search.pairs(1.0, other=taut.SphereSearch(places))
    assert pairs.tolist() == np.argwhere(between <= 1.0).tolist()
    assert search.pairs(-1.0)[0].shape == (0, 2)
    (i, j), distance, bound = search.diameter()
    assert distance == bound == np.sqrt(squares.max()) == np.sqrt(squares[i, j]) and i < j
    _, nearly, bound = search.diameter(epsilon=0.2)
    assert nearly <= distance <= bound <= nearly * 1.2 * (1 + 1e-15)


def test_balls_and_rays():
    balls = taut.SphereSearch([[0, 0], [3, 0], [9, 0], [0, 4]], radii=[1, 2, 1, 2.5])
    assert len(balls) == 4 and repr(balls) == "SphereSearch(<4 rows in 2 dimensions>)"
    assert balls.pairs()[0].tolist() == [[0, 1]]
    rows, distances = balls.nearest([[0, 0], [20, 0]])
    assert rows.tolist() == [0, 2] and distances.tolist() == [-1.0, 10.0]
    starts, rows, distances = balls.hits([[-5, 0], [0, 9]], [[3, 0], [1, 0]])
    assert (starts.tolist(), rows.tolist(), distances.tolist()) == ([0, 3, 3], [0, 1, 2], [4.0, 6.0, 13.0])
    rows, distances = balls.first_hits([[-5, 0], [0, 9], [0, 0]], [[3, 0], [1, 0], [0, -1]])
    assert rows.tolist() == [0, -1, 0] and distances.tolist() == [4.0, np.inf, 0.0]
    rows, _ = taut.SphereSearch([[1.0, 0.25]]).first_hits([[0, 0]], [[1, 0]], hit_radius=0.25)
    assert rows.tolist() == [0]


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_threads_and_precision_change_nothing(dtype):
    points = taut.generate("uniform", 20_000, 3, seed=1).astype(dtype)
    wanted = taut.SphereSearch(points).nearest(points[:5000], k=3)
    for threads in (1, 2):
        search = taut.SphereSearch(points, threads=threads)
        found = search.nearest(points[:5000], k=3, threads=threads)
        assert all((a == b).all() for a, b in zip(found, wanted))
    assert (wanted[0][:, 0] == np.arange(5000)).all()


def test_no_query_has_no_answer():
    search = taut.SphereSearch([[0.0, 1.0]])
    none = np.zeros((0, 2))
    assert search.nearest(none)[0].shape == (0,) and search.nearest(none, k=3)[0].shape == (0, 1)
    assert search.within(none, 1.0)[0].tolist() == [0]
    assert search.first_hits(none, none)[0].shape == (0,)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda s: taut.SphereSearch(np.zeros((0, 2))), "empty"),
        (lambda s: taut.SphereSearch([[0.0, np.nan]]), "coordinate 1 of point 0"),
        (lambda s: taut.SphereSearch([[0.0]], radii=[-1.0]), "radius of ball 0"),
        (lambda s: taut.SphereSearch([[0.0]], threads=0), "threads"),
        (lambda s: s.nearest([[0.0, 0.0], [np.nan, 0.0]]), "coordinate 0 of point 1"),
        (lambda s: s.nearest([[0.0]]), "1 coordinates"),
        (lambda s: s.nearest([[0.0, 0.0]], k=0), "option `k`"),
        (lambda s: s.nearest([[0.0, 0.0]], threads=0), "threads"),
        (lambda s: s.within([[0.0, 0.0]], np.nan), "radius"),
        (lambda s: s.farthest([[0.0, 0.0]], epsilon=-1.0), "epsilon"),
        (lambda s: s.diameter(epsilon=np.inf), "epsilon"),
        (lambda s: s.pairs(np.nan), "distance"),
        (lambda s: s.pairs(other=taut.SphereSearch([[0.0]])), "1 coordinates"),
        (lambda s: s.hits([[0.0, 0.0]], [[0.0, 0.0]]), "ray 0 has no direction"),
        (lambda s: s.hits([[0.0, 0.0]], [[1.0, 0.0]], hit_radius=-1.0), "hit_radius"),
        (lambda s: s.hits([[0.0, 0.0]], [[1.0]]), "origins have shape"),
    ],
)
def test_wrong_input_is_named(ask, message):
    with pytest.raises(ValueError, match=message):
        ask(taut.SphereSearch([[0.0, 0.0], [1.0, 0.0]]))
