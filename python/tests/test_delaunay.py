"""Triangulations of known shape, of hard inputs, and beside SciPy's where that is installed."""

import json
import pickle

import numpy as np
import pytest

import taut


def grid(k, d):
    """A grid of k**d points: as degenerate as can be."""
    return np.array(np.meshgrid(*[np.arange(k, dtype=float)] * d, indexing="ij")).reshape(d, -1).T


def sets(simplices):
    return {frozenset(row) for row in np.asarray(simplices).tolist()}


@pytest.mark.parametrize(
    ("points", "simplices", "hull"),
    [
        (grid(5, 2), 2 * 4 * 4, 16),
        (grid(4, 3), 6 * 3**3, 12 * 9),
        (taut.generate("polygon", 100, 2, vertices=100), 98, 100),
    ],
)
def test_golden_counts(points, simplices, hull):
    found = taut.delaunay(points)
    assert (len(found.simplices), len(found.hull)) == (simplices, hull)
    verdict = found.check(points)
    assert (verdict.sites, verdict.simplices, verdict.hull) == (len(points), simplices, hull)
    assert verdict.fingerprint == found.fingerprint == found.certificate.fingerprint


@pytest.mark.parametrize(("n", "d"), [(500, 2), (300, 3)])
def test_neighbors_share_a_facet_and_hull_facets_have_none(n, d):
    found = taut.delaunay(taut.generate("normal", n, d, seed=2))
    open_facets = set()
    for number, (simplex, across) in enumerate(zip(found.simplices.tolist(), found.neighbors.tolist())):
        for vertex, other in zip(simplex, across):
            facet = frozenset(simplex) - {vertex}
            if other == -1:
                open_facets.add(facet)
            else:
                assert facet < set(found.simplices[other].tolist())
                assert number in found.neighbors[other]
    assert open_facets == sets(found.hull)


@pytest.mark.parametrize("d", [2, 3])
def test_the_order_of_rows_options_and_precision_change_nothing(d):
    points = taut.generate("normal", 2000, d, dtype="float32", seed=5)
    found = taut.delaunay(points)
    shuffled = np.random.default_rng(1).permutation(len(points))
    assert taut.delaunay(points[shuffled]).fingerprint == found.fingerprint
    assert taut.delaunay(points.astype(np.float64)).fingerprint == found.fingerprint
    for options in ({"threads": 1}, {"threads": 3}, {"order": "random", "seed": 9}, {"order": "local-ric"}):
        again = taut.delaunay(points, **options)
        assert np.array_equal(again.simplices, found.simplices)
        assert np.array_equal(again.neighbors, found.neighbors)


@pytest.mark.parametrize(
    ("points", "hull_dimension", "simplices"),
    [
        (np.empty((0, 2)), None, []),
        ([[1, 2]], 0, [[0]]),
        ([[1, 2, 3]] * 4, 0, [[0]]),
        ([[0, 0], [2, 2], [1, 1]], 1, [[0, 2], [2, 1]]),
        ([[0, 0, 0], [1, 1, 1]], 1, [[0, 1]]),
        ([[0, 0, 7], [1, 0, 7], [0, 1, 7]], 2, [[0, 1, 2]]),
    ],
)
def test_flat_points_are_answered_as_such(points, hull_dimension, simplices):
    found = taut.delaunay(points)
    assert found.answer.hull_dimension == hull_dimension
    assert found.simplices.tolist() == simplices
    assert found.simplices.dtype == found.hull.dtype == np.int32
    assert found.neighbors.dtype == np.int32
    found.check(points)


def test_duplicates_are_mapped_to_their_first_row():
    found = taut.delaunay([[0, 0], [1, 0], [0, 1], [1, 0], [-0.0, 0.0]])
    assert found.duplicates.tolist() == [[3, 1], [4, 0]]
    assert found.certificate.sites == 3
    assert found.simplices.tolist() == [[0, 1, 2]]


@pytest.mark.parametrize("scale", [1e-150, 1e150, 5e-324])
def test_extreme_coordinates(scale):
    points = grid(4, 2) * scale
    assert len(taut.delaunay(points).simplices) == 18


@pytest.mark.parametrize(
    ("points", "options", "message"),
    [
        ([[0.0], [1.0]], {}, "points have 1 coordinates: expected 2, the plane, or 3, space"),
        (np.zeros((3, 4)), {}, "points have 4 coordinates"),
        ([[0.0, 0.0], [1.0, np.nan]], {}, "coordinate 1 of point 1 is NaN"),
        ([[0.0, 0.0], [np.inf, 0.0]], {}, "coordinate 0 of point 1 is inf"),
        ([[0.0, 0.0]], {"threads": 0}, "option `threads` is 0: expected 1 to 1024"),
        ([[0.0, 0.0]], {"threads": -1}, "option `threads` is -1"),
        ([[0.0, 0.0]], {"seed": -1}, "option `seed` is -1"),
        ([[0.0, 0.0]], {"order": "sorted"}, 'option `order` is "sorted": expected one of strided'),
    ],
)
def test_bad_input_is_named(points, options, message):
    with pytest.raises(ValueError, match=message.replace("(", r"\(")):
        taut.delaunay(points, **options)


def test_solutions_travel_and_cannot_be_altered():
    points = taut.generate("normal", 100, 2, seed=1)
    found = taut.delaunay(points)
    text = found.to_json()
    document = json.loads(text)
    assert document["kind"] == found.kind == "delaunay"
    assert document["answer"]["simplices"] == found.simplices.tolist()
    assert document["certificate"]["neighbors"] == found.neighbors.tolist()
    assert taut.Solution.from_json(text) == found
    assert pickle.loads(pickle.dumps(found)) == found
    assert found != taut.ball(points)
    assert taut.verify(text, points).simplices == len(found.simplices)
    for array in (found.simplices, found.neighbors, found.hull, found.duplicates):
        assert not array.flags.writeable
    assert repr(found).startswith("Solution(kind='delaunay', sites=100, simplices=")
    assert repr(found.answer).startswith("Triangulation(dimension=2, simplices=<")
    assert "fingerprint" in repr(found.certificate)
    for name in ("simplices", "neighbors", "hull", "duplicates", "fingerprint"):
        assert not hasattr(taut.ball(points), name)


@pytest.mark.parametrize("key", ["simplices", "hull"])
def test_damaged_answers_are_rejected(key):
    points = taut.generate("normal", 60, 2, seed=4)
    document = json.loads(taut.delaunay(points).to_json())
    document["answer"][key] = document["answer"][key][1:]
    with pytest.raises(taut.Violation):
        taut.verify(json.dumps(document), points)
    with pytest.raises(taut.Violation, match="the data changed"):
        taut.delaunay(points).check(points[::-1])
    with pytest.raises(ValueError, match="have no radii"):
        taut.delaunay(points).check(points, np.ones(60))


@pytest.mark.parametrize(("n", "d"), [(2000, 2), (500, 3)])
def test_the_simplices_are_those_of_scipy(n, d):
    spatial = pytest.importorskip("scipy.spatial")
    points = taut.generate("uniform", n, d, seed=6)
    found, other = taut.delaunay(points), spatial.Delaunay(points)
    assert sets(found.simplices) == sets(other.simplices)
    assert sets(found.hull) == sets(other.convex_hull)
