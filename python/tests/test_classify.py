"""The estimators: what they learn, their parameters, their way through pickles; with scikit-learn its own checks."""

import pickle

import numpy as np
import pytest

import taut


@pytest.fixture(scope="module")
def classes():
    points = taut.generate("normal", 120, 3, seed=5)
    labels = np.repeat(["elm", "oak", "yew"], 40)
    points[labels == "oak"] += 4
    points[labels == "yew", 0] -= 6
    return points, labels


def test_balls_learn_classes_and_travel(classes):
    points, labels = classes
    model = taut.MebClassifier().fit(points, labels)
    assert model.n_features_in_ == 3
    assert list(model.classes_) == ["elm", "oak", "yew"]
    assert model.score(points, labels) > 0.95
    scores = model.decision_function(points)
    assert scores.shape == (120, 3)
    assert (model.classes_[scores.argmax(axis=1)] == model.predict(points)).all()
    again = pickle.loads(pickle.dumps(model))
    assert (again.decision_function(points) == scores).all()
    assert '"format":"taut-classifier"' in model.to_json()


@pytest.mark.parametrize(
    "params",
    [
        {"width": "theta-squared=125", "scaling": "percent", "thesis_steps": 100},
        {"cells": "voronoi", "nu": 0.1},
        {"whitening": True, "cells": "voronoi"},
    ],
)
def test_parameters_are_those_of_the_library(classes, params):
    points, labels = classes
    model = taut.MebClassifier(**params)
    assert {name: model.get_params()[name] for name in params} == params
    assert taut.MebClassifier().set_params(**params).get_params() == model.get_params()
    assert model.fit(points.astype(np.float32), labels).score(points, labels) > 0.9
    binary = model.fit(points[:80], labels[:80])
    assert binary.decision_function(points).shape == (120,)
    assert ((binary.decision_function(points) > 0) == (binary.predict(points) == "oak")).all()


def test_svdd_leaves_at_most_its_share_outside():
    points = taut.generate("normal", 300, 2, seed=6)
    for nu in (0.02, 0.1, 0.4):
        model = taut.Svdd(nu=nu).fit(points)
        assert (model.decision_function(points) < -1e-5).mean() <= nu
        assert list(model.predict([[0, 0], [20, 20]])) == [1, -1]
        assert (pickle.loads(pickle.dumps(model)).predict(points) == model.predict(points)).all()


def test_wrong_inputs_are_refused(classes):
    points, labels = classes
    for params, words in [
        ({"width": "125"}, "theta-squared="),
        ({"cells": "round"}, "power"),
        ({"nu": 2.0}, "option `nu` is 2"),
        ({"thesis_steps": -1}, "thesis_steps"),
        ({"scaling": "log"}, "z-score"),
    ]:
        with pytest.raises(ValueError, match=words):
            taut.MebClassifier(**params).fit(points, labels)
    model = taut.MebClassifier().fit(points, labels)
    with pytest.raises(ValueError, match="X has 2 features, but MebClassifier is expecting 3 features"):
        model.predict(points[:, :2])
    with pytest.raises(ValueError):
        model.fit(points, labels[:-1])
    with pytest.raises(ValueError):
        model.fit(np.where(np.arange(3) == 1, np.nan, points), labels)
    with pytest.raises(ValueError, match="y"):
        model.fit(points, None)
    with pytest.raises(Exception, match="fit"):
        taut.Svdd().predict(points)
    with pytest.raises(ValueError):
        model.set_params(gamma=1)
    with pytest.raises(AttributeError):
        taut.Forest


@pytest.mark.parametrize("estimator", [taut.MebClassifier(), taut.Svdd()], ids=["MebClassifier", "Svdd"])
@pytest.mark.filterwarnings("ignore")
def test_the_checks_of_scikit_learn_pass(estimator):
    checks = pytest.importorskip("sklearn.utils.estimator_checks")
    checks.check_estimator(estimator)
