"""The estimators pass the checks of scikit-learn, and agree with what they stand beside."""

import pickle

import numpy as np
import pytest

import taut

pytest.importorskip("sklearn", reason="scikit-learn is not installed")

from sklearn.base import clone
from sklearn.covariance import EllipticEnvelope as ScikitEnvelope
from sklearn.covariance import MinCovDet as ScikitMinCovDet
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.utils.estimator_checks import check_estimator

from taut.sklearn import BallClassifier, EllipticEnvelope, EnclosingBall, EnclosingEllipsoid, KCenter, MinCovDet

ESTIMATORS = [
    KCenter(n_clusters=3),
    EnclosingBall(),
    EnclosingEllipsoid(),
    MinCovDet(),
    EllipticEnvelope(),
    BallClassifier(),
    BallClassifier(cells="voronoi"),
]


@pytest.mark.filterwarnings("ignore::sklearn.exceptions.SkipTestWarning", "ignore::sklearn.exceptions.EstimatorCheckFailedWarning")
@pytest.mark.parametrize("estimator", ESTIMATORS, ids=str)
def test_all_checks_of_scikit_learn_pass(estimator):
    checks = check_estimator(estimator, on_fail=None, on_skip=None)
    failed = {check["check_name"]: check["exception"] for check in checks if check["status"] == "failed"}
    assert failed == {}
    assert sum(check["status"] == "passed" for check in checks) >= 35
    # Without pandas, or a library of other arrays.
    skipped = {check["check_name"] for check in checks if check["status"] == "skipped"}
    assert {name for name in skipped if not name.endswith(("_array_api_input", "_data_not_an_array"))} == set()


def spoiled(seed, n, d, share):
    """Normal rows, correlated, of which a share lies elsewhere."""
    rng = np.random.default_rng(seed)
    rows = rng.normal(size=(n, d)) @ rng.normal(size=(d, d))
    rows[: int(share * n)] += rng.normal(size=d) * 20
    return rng.permutation(rows)


# n + d + 1 is even, so that both keep as many rows.
SETS = [(61, 2), (120, 3), (201, 4), (300, 5), (401, 2), (501, 6), (700, 7), (901, 4), (1000, 3), (2001, 8)]


@pytest.mark.parametrize("number, size", list(enumerate(SETS)))
def test_determinants_are_never_larger(number, size):
    n, d = size
    n += (n + d + 1) % 2
    rows = spoiled(number, n, d, [0.0, 0.1, 0.3, 0.4][number % 4])
    ours, theirs = MinCovDet().fit(rows), ScikitMinCovDet(random_state=0).fit(rows)
    # Of more than 500 rows scikit-learn may keep one more, of which the determinant is no smaller.
    assert 0 <= theirs.raw_support_.sum() - ours.raw_support_.sum() <= 1
    log_det = [np.linalg.slogdet(model.raw_covariance_)[1] for model in (ours, theirs)]
    assert log_det[0] <= log_det[1] + 1e-9


def test_attributes_are_those_of_scikit_learn():
    # As many good rows as are kept.
    rows = spoiled(5, 400, 3, 0.2)
    ours = EllipticEnvelope(contamination=0.2, support_fraction=0.8).fit(rows)
    theirs = ScikitEnvelope(contamination=0.2, support_fraction=0.8, random_state=0).fit(rows)
    public = {name for name in vars(theirs) if name.endswith("_")}
    assert public <= set(vars(ours))
    # On a set whose best rows are plain, both find the same ones, and all else follows.
    np.testing.assert_array_equal(ours.raw_support_, theirs.raw_support_)
    np.testing.assert_allclose(ours.raw_location_, theirs.raw_location_, rtol=1e-12)
    np.testing.assert_allclose(ours.raw_covariance_, theirs.raw_covariance_, rtol=1e-10)
    if np.array_equal(ours.support_, theirs.support_):
        np.testing.assert_allclose(ours.covariance_, theirs.covariance_, rtol=1e-9)
        np.testing.assert_allclose(ours.dist_, theirs.dist_, rtol=1e-7)
        np.testing.assert_allclose(ours.offset_, theirs.offset_, rtol=1e-7)
        np.testing.assert_array_equal(ours.predict(rows), theirs.predict(rows))
    assert (ours.support_ != theirs.support_).mean() < 0.02
    np.testing.assert_allclose(ours.mahalanobis(rows), ours.dist_)
    assert ours.solution_.check(rows).rank == 3


def test_support_fraction_is_the_share_kept():
    rows = spoiled(2, 400, 3, 0.1)
    for share in (0.55, 0.75, 0.9, 1.0):
        model = MinCovDet(support_fraction=share).fit(rows)
        assert model.raw_support_.sum() == int(share * 400)
    # Fewer than half are not kept.
    assert MinCovDet(support_fraction=0.1).fit(rows).raw_support_.sum() == 202
    with pytest.raises(ValueError, match="support_fraction"):
        MinCovDet(support_fraction=1.5).fit(rows)


def test_rows_off_a_flat_are_infinitely_far():
    rng = np.random.default_rng(3)
    flat = np.column_stack([rng.normal(size=(90, 2)), np.zeros(90)])
    rows = np.vstack([flat, rng.normal(size=(10, 3)) + [0, 0, 5]])
    model = EllipticEnvelope(contamination=0.1).fit(rows)
    assert np.isinf(model.dist_[90:]).all() and np.isfinite(model.dist_[:90]).all()
    np.testing.assert_array_equal(model.predict(rows)[90:], -1)
    assert (model.predict(rows)[:90] == 1).sum() >= 89


def test_k_center_proves_its_radius():
    rows = np.random.default_rng(1).random((500, 2))
    model = KCenter(n_clusters=4, epsilon=0.05).fit(rows)
    distances = model.transform(rows)
    np.testing.assert_array_equal(distances.argmin(axis=1), model.labels_)
    assert distances.min(axis=1).max() == pytest.approx(model.radius_, rel=1e-12)
    assert model.lower_bound_ <= model.radius_ <= 1.05 * model.lower_bound_ * (1 + 1e-9)
    assert model.solution_.check(rows).lower == pytest.approx(model.lower_bound_)
    assert (KCenter(n_clusters=4, outliers=7).fit(rows).labels_ == -1).sum() <= 7
    names = make_pipeline(StandardScaler(), KCenter(n_clusters=4)).fit(rows).get_feature_names_out()
    assert names.tolist() == ["kcenter0", "kcenter1", "kcenter2", "kcenter3"]


@pytest.mark.parametrize("kind", [EnclosingBall, EnclosingEllipsoid])
def test_without_contamination_the_shape_itself_is_the_border(kind):
    rows = np.random.default_rng(1).normal(size=(500, 3))
    detector = kind(contamination="auto").fit(rows)
    assert (detector.predict(rows) == 1).all()
    assert (detector.predict(rows * 10 + 50) == -1).all()
    counted = kind(contamination=0.05).fit(rows)
    assert (counted.predict(rows) == -1).sum() == 25
    with pytest.raises(ValueError, match="contamination"):
        kind(contamination=0.7).fit(rows)


@pytest.mark.parametrize("estimator", ESTIMATORS, ids=str)
def test_solutions_are_kept_and_pickled(estimator):
    rows = np.random.default_rng(1).normal(size=(60, 3)).astype(np.float32)
    labels = np.repeat([0, 1, 2], 20)
    model = clone(estimator).fit(rows, labels)
    again = pickle.loads(pickle.dumps(model))
    assert again.solution_ == model.solution_
    if isinstance(estimator, BallClassifier):
        for label, solution in zip(model.classes_, model.solution_):
            assert solution.check(np.ascontiguousarray(rows[labels == label])).gap <= 1e-9
    else:
        assert model.solution_.check(rows) is not None


def test_float32_is_not_copied():
    rows = np.random.default_rng(1).normal(size=(60, 3)).astype(np.float32)
    assert EnclosingBall().fit(rows).solution_ == taut.ball(rows)
