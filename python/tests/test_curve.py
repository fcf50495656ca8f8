"""Curves: the answer and its parts, what the checker says, what is refused."""

import json
import pickle

import numpy as np
import pytest

import taut

METHODS = ["crust", "one-step-crust", "nn-crust", "conservative-crust", "hnn-crust", "corners"]


def ring(n, radius=1.0, center=(0.0, 0.0)):
    t = np.arange(n) * (2 * np.pi / n)
    return np.c_[np.cos(t), np.sin(t)] * radius + center


@pytest.fixture(scope="module")
def rings():
    return np.random.default_rng(6).permutation(np.r_[ring(90), ring(60, 0.5), ring(80, 1.0, (5.0, 0.0))])


@pytest.mark.parametrize("method", METHODS)
def test_rings_are_found(rings, method):
    found = taut.curve(rings, method=method)
    answer = found.answer
    assert isinstance(answer, taut.Curve) and isinstance(answer.curves, tuple)
    assert sorted(len(curve.vertices) for curve in answer.curves) == [60, 80, 90]
    for curve in answer.curves:
        assert isinstance(curve, taut.CurveComponent)
        assert curve.closed
        assert curve.vertices.dtype == np.float64 and curve.vertices.shape == (len(curve.rows), 2)
        assert (rings[curve.rows] == curve.vertices).all()
        steps = np.diff(np.r_[curve.vertices, curve.vertices[:1]], axis=0)
        assert np.hypot(*steps.T).max() < 0.1
    assert answer.noise == 0.0 and answer.outliers.shape == (0,) and answer.places is None
    verdict = found.check(rings)
    assert isinstance(verdict, taut.CurveVerdict)
    assert verdict.simple and verdict.band == 0.0 and verdict.tour_gap is None
    assert found.certificate.certified == verdict.certified
    assert (verdict.doubt is None) == verdict.certified


def test_places_are_told_on_request(rings):
    answer = taut.curve(rings, method="nn-crust", places=True).answer
    assert answer.places.shape == (len(rings), 2)
    for row, (curve, position) in enumerate(answer.places):
        component = answer.curves[int(curve)]
        k, t = divmod(position, 1)
        a = component.vertices[int(k) % len(component.vertices)]
        b = component.vertices[(int(k) + 1) % len(component.vertices)]
        assert np.allclose(a + t * (b - a), rings[row], atol=1e-12)


def test_ends_are_kept_and_doubted():
    half = ring(80)[:40]
    for options in ({}, {"open": True}):
        found = taut.curve(half, method="hnn-crust", **options)
        assert [curve.closed for curve in found.answer.curves] == [False]
        verdict = found.check(half)
        assert not verdict.certified and "has ends" in verdict.doubt


def test_tours_have_a_bound(rings):
    found = taut.curve(rings, method="tour")
    (tour,) = found.answer.curves
    assert tour.closed and sorted(tour.rows) == list(range(len(rings)))
    length = np.hypot(*np.diff(np.r_[tour.vertices, tour.vertices[:1]], axis=0).T).sum()
    verdict = found.check(rings)
    assert 0 <= verdict.tour_gap < 0.02
    assert found.certificate.tour_lower <= length * (1 + 1e-12)
    path = taut.curve(rings, method="tour", open=True)
    assert not path.answer.curves[0].closed


def test_noisy_rings_are_smoothed():
    rng = np.random.default_rng(1)
    points = ring(2000)
    points *= 1 + rng.uniform(-0.02, 0.02, 2000)[:, None]
    found = taut.curve(points)
    (curve,) = found.answer.curves
    assert curve.closed and curve.rows is None
    assert np.abs(np.hypot(*curve.vertices.T) - 1).max() < 0.01
    assert 0.005 < found.answer.noise < 0.04
    assert found.check(points).simple


def test_answers_do_not_depend_on_threads(rings):
    for method in ("auto", "hnn-crust", "tour"):
        found = taut.curve(rings, method=method, threads=1)
        assert taut.curve(rings, method=method, threads=3) == found


def test_answers_travel_and_lies_are_found(rings):
    found = taut.curve(rings, method="hnn-crust")
    assert pickle.loads(pickle.dumps(found)) == found
    assert found.kind == "curve"
    assert repr(found) == "Solution(kind='curve', curves=3)"
    assert repr(found.answer) == "Curve(curves=<3>, noise=0.0, outliers=[])"
    assert repr(found.answer.curves[0]).startswith("CurveComponent(closed=True, vertices=<")
    assert repr(found.certificate).startswith("CurveCertificate(certified=")
    assert taut.verify(found.to_json(), rings).simple
    document = json.loads(found.to_json())
    document["answer"]["curves"][0]["vertices"][0][0] += 0.01
    with pytest.raises(taut.Violation):
        taut.verify(json.dumps(document), rings)
    changed = rings.copy()
    changed[0, 0] += 1
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check(changed)
    with pytest.raises(ValueError, match="which have no radii"):
        found.check(rings, np.ones(len(rings)))
    with pytest.raises(AttributeError, match="a curve has no simplices"):
        _ = found.simplices
    with pytest.raises(ValueError, match="read-only"):
        found.answer.curves[0].vertices[0, 0] = 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "splines"}, "expected one of auto, fit, thesis"),
        ({"rho": 0.5, "method": "thesis"}, "`rho` is 0.5: expected a number of at least 1"),
        ({"omega": 0.0, "method": "thesis-crude"}, "`omega` is 0: expected a number above 0"),
        ({"omega": float("nan"), "method": "thesis"}, "`omega` is NaN"),
        ({"feature": 1.0}, "option `feature` is of method thesis and thesis-crude, not of auto"),
        ({"threads": 0}, "threads"),
    ],
)
def test_wrong_options_are_named(rings, options, message):
    with pytest.raises(ValueError, match=message):
        taut.curve(rings, **options)


def test_wrong_points_are_named():
    with pytest.raises(ValueError, match="coordinate 1 of point 0 is NaN"):
        taut.curve([[0, np.nan]])
    with pytest.raises(ValueError, match="points have 3 coordinates"):
        taut.curve(np.zeros((4, 3)))


@pytest.mark.parametrize("points", [np.zeros((0, 2)), [[1, 2]], [[1, 2], [1, 2]], [[0, 0], [1, 1]], [[0, 0], [1, 1], [2, 2]]])
def test_few_points_are_no_error(points):
    for method in ("auto", *METHODS, "tour"):
        found = taut.curve(points, method=method)
        assert not any(curve.closed for curve in found.answer.curves)
        assert not found.check(points).certified
