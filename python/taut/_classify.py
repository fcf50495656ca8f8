"""Classifiers as estimators in the manner of scikit-learn.

Where scikit-learn is installed, they are estimators of it, with its checks of inputs; else they bring what these need.
"""

from __future__ import annotations

import importlib
import inspect
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import as_rows


def _optional(name: str) -> Any:
    try:
        return importlib.import_module(name)
    except ImportError:
        return None


_base = _optional("sklearn.base")
_validation = _optional("sklearn.utils.validation")
_multiclass = _optional("sklearn.utils.multiclass")


class _Parameters:
    """Parameters by name, as scikit-learn has them."""

    def get_params(self, deep: bool = True) -> dict[str, Any]:
        """The parameters of the constructor with their values."""
        return {name: getattr(self, name) for name in inspect.signature(type(self)).parameters}

    def set_params(self, **params: Any) -> Self:
        """Sets parameters of the constructor."""
        known = inspect.signature(type(self)).parameters
        for name, value in params.items():
            if name not in known:
                raise ValueError(f"parameter {name!r} is none of {type(self).__name__}: expected one of {list(known)}")
            setattr(self, name, value)
        return self


class _Alone:
    """The place of what scikit-learn mixes in."""


_Estimator: Any = _Parameters if _base is None else _base.BaseEstimator
_Classifier: Any = _Alone if _base is None else _base.ClassifierMixin
_Outliers: Any = _Alone if _base is None else _base.OutlierMixin


class _Trained(_Estimator):  # type: ignore[misc]
    """What both estimators share: the trained model, and its way through pickles."""

    def _checked(self, X: ArrayLike, reset: bool, y: Any = None) -> Any:
        if _validation is not None:
            rest = {} if y is None else {"y": y}
            return _validation.validate_data(self, X, reset=reset, dtype=[np.float64, np.float32], order="C", **rest)
        rows = as_rows(X)
        if reset:
            self.n_features_in_ = rows.shape[1]
        elif rows.shape[1] != self.n_features_in_:
            raise ValueError(
                f"X has {rows.shape[1]} features, but {type(self).__name__} is expecting "
                f"{self.n_features_in_} features as input"
            )
        return rows if y is None else (rows, np.asarray(y).ravel())

    def _scores(self, X: ArrayLike) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        if _validation is not None:
            _validation.check_is_fitted(self, "_model")
        elif not hasattr(self, "_model"):
            raise ValueError(f"this {type(self).__name__} is not fitted: call fit first")
        rows = self._checked(X, reset=False)
        classes, scores = self._model.predict(np.require(rows, requirements=["C", "ALIGNED"]))
        return np.asarray(classes, dtype=np.int64), np.asarray(scores).reshape(len(rows), -1)

    def to_json(self) -> str:
        """The trained model as JSON, as `taut classify` writes it."""
        if not hasattr(self, "_model"):
            raise ValueError(f"this {type(self).__name__} is not fitted: call fit first")
        return str(self._model.to_json())

    def __getstate__(self) -> dict[str, Any]:
        state = dict(self.__dict__)
        if "_model" in state:
            state["_model"] = state["_model"].to_json()
        return state

    def __setstate__(self, state: dict[str, Any]) -> None:
        state = dict(state)
        if "_model" in state:
            state["_model"] = _native.Classifier.from_json(state["_model"])
        self.__dict__.update(state)


class MebClassifier(_Classifier, _Trained):  # type: ignore[misc]
    """Classes by the smallest ball of a Gaussian kernel around the points of each.

    Parameters
    ----------
    width : str, default "auto"
        The width of the kernel under its convention: ``"theta=125"`` for exp(-d**2/theta), ``"theta-squared=125"`` for
        exp(-d**2/theta**2), ``"gamma=0.1"``, ``"sigma=2"`` for exp(-d**2/(2 sigma**2)), ``"scale=1"`` for gamma = 1 over
        the sum of the variances of the features; ``"auto"`` takes one over four times that sum within classes.
    cells : {"power", "voronoi"}, default "power"
        How the balls divide the space: by distances less radii, both squared, or by distances.
    nu : float in (0, 1], optional
        Share of the points of a class that may be outside its ball; by default none.
    scaling : {"z-score", "percent", "none"}, default "z-score"
        How features are scaled, by the training points.
    whitening : bool, default False
        Makes the covariance within classes the identity, after the scaling; for many classes of few points.
    thesis_steps : int >= 2, optional
        Takes so many steps of Algorithm 11 of the thesis in place of the optimum.
    seed : int, default 0
        Chooses the first points of the search.
    threads : int, optional
        By default one for each processor; nothing depends on it.

    Attributes
    ----------
    classes_ : ndarray of shape (n_classes,)
        The labels, in order.
    n_features_in_ : int
        Features of the training points.

    Examples
    --------
    >>> import taut
    >>> model = taut.MebClassifier().fit([[0, 0], [0, 1], [5, 5], [6, 5]], ["low", "low", "high", "high"])
    >>> print(model.predict([[1, 0], [5, 6]]))
    ['low' 'high']
    """

    def __init__(
        self,
        *,
        width: str = "auto",
        cells: str = "power",
        nu: float | None = None,
        scaling: str = "z-score",
        whitening: bool = False,
        thesis_steps: int | None = None,
        seed: int = 0,
        threads: int | None = None,
    ) -> None:
        self.width = width
        self.cells = cells
        self.nu = nu
        self.scaling = scaling
        self.whitening = whitening
        self.thesis_steps = thesis_steps
        self.seed = seed
        self.threads = threads

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Learns from points of shape (n, d) with labels of shape (n,)."""
        if y is None:
            raise ValueError("MebClassifier requires y to be passed, but the target y is None")
        rows, targets = self._checked(X, reset=True, y=y)
        if _multiclass is not None:
            _multiclass.check_classification_targets(targets)
        if len(targets) != len(rows):
            raise ValueError(f"there are {len(rows)} points, but {len(targets)} labels")
        self.classes_, labels = np.unique(targets, return_inverse=True)
        self._model = _native.train_classifier(
            np.require(rows, requirements=["C", "ALIGNED"]),
            labels.astype(np.uint32).ravel(),
            len(self.classes_),
            "whitened-ball" if self.whitening else "ball",
            (self.scaling, self.width, self.cells),
            (self.nu, self.thesis_steps),
            self.seed,
            self.threads,
        )
        return self

    def decision_function(self, X: ArrayLike) -> NDArray[np.float64]:
        """Scores of shape (n, n_classes); of two classes the score of the second less that of the first, of shape (n,)."""
        scores = self._scores(X)[1]
        return scores[:, 1] - scores[:, 0] if scores.shape[1] == 2 else scores

    def predict(self, X: ArrayLike) -> NDArray[Any]:
        """The label of each point."""
        classes = self._scores(X)[0]
        found: NDArray[Any] = self.classes_[classes]
        return found

    def score(self, X: ArrayLike, y: ArrayLike, sample_weight: ArrayLike | None = None) -> float:
        """The share of points whose label is found, by weight."""
        weights = None if sample_weight is None else np.asarray(sample_weight, dtype=np.float64)
        return float(np.average(self.predict(X) == np.asarray(y), weights=weights))


class Svdd(_Outliers, _Trained):  # type: ignore[misc]
    """Outliers of one class: what is outside a soft ball of a Gaussian kernel (support vector data description).

    Parameters
    ----------
    nu : float in (0, 1], default 0.05
        At most this share of the training points is outside.
    width : str, default "auto"
        The width of the kernel, as of `MebClassifier`.
    scaling : {"z-score", "percent", "none"}, default "z-score"
        How features are scaled, by the training points.
    seed : int, default 0
        Chooses the first points of the search.
    threads : int, optional
        By default one for each processor; nothing depends on it.

    Attributes
    ----------
    n_features_in_ : int
        Features of the training points.
    offset_ : float
        0: `decision_function` is `score_samples` less this.

    Examples
    --------
    >>> import taut
    >>> points = taut.generate("normal", 200, 2)
    >>> print(taut.Svdd(nu=0.1).fit(points).predict([[0, 0], [9, 9]]))
    [ 1 -1]
    """

    def __init__(
        self,
        *,
        nu: float = 0.05,
        width: str = "auto",
        scaling: str = "z-score",
        seed: int = 0,
        threads: int | None = None,
    ) -> None:
        self.nu = nu
        self.width = width
        self.scaling = scaling
        self.seed = seed
        self.threads = threads

    def fit(self, X: ArrayLike, y: Any = None) -> Self:
        """Learns from points of shape (n, d); `y` is not used."""
        rows = self._checked(X, reset=True)
        self.offset_ = 0.0
        self._model = _native.train_classifier(
            np.require(rows, requirements=["C", "ALIGNED"]),
            np.zeros(len(rows), dtype=np.uint32),
            1,
            "svdd",
            (self.scaling, self.width, None),
            (self.nu, None),
            self.seed,
            self.threads,
        )
        return self

    def score_samples(self, X: ArrayLike) -> NDArray[np.float64]:
        """R**2 less the squared distance of each point from the center, in the feature space."""
        return self._scores(X)[1][:, 0]

    def decision_function(self, X: ArrayLike) -> NDArray[np.float64]:
        """The same: at least 0 inside the ball, below 0 outside."""
        scores = self.score_samples(X)
        found: NDArray[np.float64] = scores - self.offset_
        return found

    def predict(self, X: ArrayLike) -> NDArray[np.int64]:
        """1 for each point inside the ball, -1 for each outside."""
        return np.where(self.decision_function(X) >= 0, 1, -1)

    def fit_predict(self, X: ArrayLike, y: Any = None) -> NDArray[np.int64]:
        """Learns from points, then tells them apart."""
        return self.fit(X).predict(X)
