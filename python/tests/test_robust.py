"""Robust ellipsoids: what they bear, what is proved of them, and how they travel."""

import json
import pickle

import numpy as np
import pytest

import taut


@pytest.fixture(scope="module")
def points():
    """150 normal points, then 50 far away in a cloud of their own."""
    return np.vstack([taut.generate("normal", 150, 3, seed=2), 50 + 0.1 * taut.generate("normal", 50, 3, seed=3)])


@pytest.mark.parametrize(("method", "coverage"), [("mcd", None), ("mve", None), ("trim", 0.75)])
def test_a_quarter_of_outliers_is_found(points, method, coverage):
    found = taut.robust_ellipsoid(points, method=method, coverage=coverage)
    answer, certificate = found.answer, found.certificate
    assert set(range(150, 200)) <= set(answer.outliers.tolist())
    assert np.linalg.norm(answer.center) < 1
    assert (answer.outliers == np.flatnonzero(answer.ellipsoid.norm(points) > 1)).all()
    assert answer.log_det == pytest.approx(np.linalg.slogdet(answer.scatter)[1], abs=1e-10)
    assert answer.matrix == pytest.approx(answer.factor.T @ answer.factor, rel=1e-12, abs=1e-14)
    assert (answer.hull, answer.rank) == (None, 3)
    assert certificate.method == method
    assert certificate.kept <= 200 - len(certificate.left_out)
    verdict = found.check(points)
    assert verdict.rank == 3
    assert verdict.on_hull == 200
    assert verdict.kept >= verdict.wanted == found.certificate.kept
    assert verdict.flag_excess == 0.0 and 0 < verdict.slack < 1e-6
    assert verdict.objective == pytest.approx(certificate.objective, abs=1e-8)
    assert (verdict.enclosure is None) == (certificate.gap is None) == (method == "mcd")


def test_the_raw_objective_is_the_determinant_of_the_points_kept(points):
    certificate = taut.robust_ellipsoid(points).certificate
    kept = np.delete(points, certificate.left_out, axis=0)
    assert len(kept) == certificate.kept
    assert certificate.objective == pytest.approx(np.linalg.slogdet(np.cov(kept.T))[1], abs=1e-10)


def test_the_scatter_is_that_of_the_points_not_weighed_out(points):
    found = taut.robust_ellipsoid(points)
    rest = np.delete(points, found.certificate.weighed_out, axis=0)
    assert found.check(points).reweighted
    assert found.answer.center == pytest.approx(rest.mean(axis=0), abs=1e-12)
    assert found.answer.scatter == pytest.approx(found.certificate.scale * np.cov(rest.T), abs=1e-12)


@pytest.mark.parametrize("method", ["mcd", "mve"])
def test_the_scale_goes_by_the_share_or_the_level(points, method):
    share, level = (taut.robust_ellipsoid(points, method=method, scale=scale) for scale in ("share", "level"))
    assert (share.certificate.scaled_by, level.certificate.scaled_by) == ("share", "level")
    assert level.check(points).reweighted
    # 0.975 over the distribution function of chi-squared, five degrees of freedom, at the quantile of three.
    assert level.certificate.scale == pytest.approx(1.0784787184, abs=1e-9)
    ratio = level.certificate.scale / share.certificate.scale
    np.testing.assert_allclose(level.answer.scatter, ratio * share.answer.scatter, rtol=1e-12)
    assert taut.Solution.from_json(level.to_json()) == level
    document = json.loads(level.to_json())
    del document["certificate"]["scaled_by"]
    with pytest.raises(taut.Violation, match="factor of the scatter"):
        taut.verify(json.dumps(document), points)
    assert taut.robust_ellipsoid(points, method="trim", scale="level").certificate.scaled_by == "share"


def test_trimming_nothing_is_the_ellipsoid_around_all(points):
    trimmed = taut.robust_ellipsoid(points, method="trim", coverage=1).answer
    assert trimmed.log_volume == pytest.approx(taut.ellipsoid(points).answer.log_volume, abs=3e-9)
    assert trimmed.outliers.shape == (0,)


def test_exact_fits_are_reported():
    points = np.array([[i, i] for i in range(20)] + [[0, 7], [3, 100]])
    found = taut.robust_ellipsoid(points)
    assert found.answer.rank == 1
    assert found.answer.hull.basis.shape == (1, 2)
    assert found.answer.outliers.tolist() == [20, 21]
    assert found.check(points).on_hull == 20


def test_answers_travel_and_lies_are_found(points):
    found = taut.robust_ellipsoid(points)
    assert pickle.loads(pickle.dumps(found)) == found
    assert found.kind == "robust-ellipsoid"
    assert repr(found).startswith("Solution(kind='robust-ellipsoid', log_det=")
    document = json.loads(found.to_json())
    assert document["answer"]["outliers"] == found.answer.outliers.tolist()
    document["answer"]["outliers"].pop()
    with pytest.raises(taut.Violation, match="point 199"):
        taut.verify(json.dumps(document), points)
    changed = points.copy()
    changed[0, 0] += 1
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check(changed)
    with pytest.raises(ValueError, match="speaks of points, which have no radii"):
        found.check(points, np.ones(len(points)))
    with pytest.raises(AttributeError, match="a robust-ellipsoid has no simplices"):
        _ = found.simplices
    with pytest.raises(ValueError, match="read-only"):
        found.answer.scatter[0, 0] = 0


def test_threads_and_order_do_not_matter(points):
    found = taut.robust_ellipsoid(points)
    assert taut.robust_ellipsoid(points, threads=1) == found
    other = taut.robust_ellipsoid(points[::-1]).answer
    assert sorted(199 - other.outliers) == found.answer.outliers.tolist()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"method": "mad"}, "expected mcd, mve or trim"),
        ({"coverage": 0.4}, "coverage"),
        ({"level": 1}, "level"),
        ({"method": "mve", "epsilon": 0}, "epsilon"),
        ({"scale": "median"}, "expected share or level"),
        ({"threads": 0}, "threads"),
    ],
)
def test_wrong_options_are_named(points, options, message):
    with pytest.raises(ValueError, match=message):
        taut.robust_ellipsoid(points, **options)


def test_wrong_points_are_named():
    with pytest.raises(ValueError, match="coordinate 1 of point 0 is NaN"):
        taut.robust_ellipsoid([[0, np.nan]])
    with pytest.raises(ValueError, match="empty"):
        taut.robust_ellipsoid(np.zeros((0, 2)))
