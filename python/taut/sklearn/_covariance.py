"""The minimum covariance determinant with the attributes of scikit-learn."""

from __future__ import annotations

from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.stats import chi2
from sklearn.base import OutlierMixin
from sklearn.covariance import EmpiricalCovariance
from sklearn.metrics import accuracy_score

from .._robust import robust_ellipsoid
from ._rows import rows_to_fit, rows_to_judge

# The part of normal rows that scikit-learn keeps when it weighs the others out.
LEVEL = 0.975


def consistency_factor(level: float, features: int) -> float:
    """What the covariance of the part `level` of normal rows is multiplied by, so that it is that of all.

    Croux and Haesbroeck: level / F(q), where q is the quantile of chi-squared at `level` for `features` degrees of freedom,
    and F the distribution function for two more.
    """
    return float(level / chi2.cdf(chi2.ppf(level, features), features + 2))


class MinCovDet(EmpiricalCovariance):  # type: ignore[misc]
    """Robust location and covariance: the minimum covariance determinant, as `sklearn.covariance.MinCovDet`.

    Attributes mean what they mean there, and ``covariance_`` is scaled as there. The search is another one: the same on
    every run, and with a determinant that is no larger in all comparisons made (docs/python.md).

    Parameters
    ----------
    store_precision : bool, default True
        Whether ``precision_`` is kept.
    support_fraction : float in (0, 1], optional
        Share of the rows whose covariance is minimized; by default, and at least, about half of them.
    random_state : optional
        Not used: nothing is drawn at random. It is there so that code written for scikit-learn runs.
    threads : int, optional
        By default all cores; nothing depends on it.

    Attributes
    ----------
    raw_location_ : ndarray of shape (n_features,)
        Mean of the rows kept.
    raw_covariance_ : ndarray of shape (n_features, n_features)
        Their covariance, unscaled: the one of least determinant.
    raw_support_ : ndarray of bool, shape (n_samples,)
        Which rows are kept.
    location_ : ndarray of shape (n_features,)
        Mean of the rows not weighed out.
    covariance_ : ndarray of shape (n_features, n_features)
        Their covariance, scaled to be that of all rows if these are normal.
    precision_ : ndarray of shape (n_features, n_features)
        Its inverse.
    support_ : ndarray of bool, shape (n_samples,)
        Which rows are not weighed out.
    dist_ : ndarray of shape (n_samples,)
        Squared Mahalanobis distances of the rows; infinite off the flat in which most rows lie, where there is one.
    solution_ : taut.Solution
        The robust ellipsoid with the certificate from which all is calculated again.
    n_features_in_ : int
        Features of the rows.
    feature_names_in_ : ndarray of shape (n_features_in_,)
        Their names, where all are strings.

    Examples
    --------
    >>> import numpy as np
    >>> from taut.sklearn import MinCovDet
    >>> grid = np.stack(np.meshgrid(range(5), range(5)), axis=-1).reshape(-1, 2)
    >>> model = MinCovDet().fit(np.vstack([grid, [[1000, 0], [1000, 1], [1000, 2]]]))
    >>> model.location_.round(8), np.flatnonzero(~model.support_)
    (array([2., 2.]), array([25, 26, 27]))
    """

    _parameter_constraints: dict[str, Any] = {}

    def __init__(
        self,
        *,
        store_precision: bool = True,
        support_fraction: float | None = None,
        random_state: Any = None,
        threads: int | None = None,
    ) -> None:
        self.store_precision = store_precision
        self.support_fraction = support_fraction
        self.random_state = random_state
        self.threads = threads

    def fit(self, X: ArrayLike, y: Any = None) -> Self:
        """Finds the rows of least determinant among rows of shape (n_samples, n_features); `y` is not used."""
        rows = rows_to_fit(self, X, ensure_min_samples=2)
        n, features = rows.shape
        coverage = _coverage(self.support_fraction, n, features)
        self.solution_ = robust_ellipsoid(rows, coverage=coverage, level=LEVEL, threads=self.threads)
        answer, certificate = self.solution_.answer, self.solution_.certificate
        self.raw_support_ = np.ones(n, dtype=bool)
        self.raw_support_[certificate.left_out] = False
        kept = np.asarray(rows[self.raw_support_], dtype=np.float64)
        self.raw_location_ = kept.mean(axis=0)
        self.raw_covariance_ = np.cov(kept.T, bias=True).reshape(features, features)
        self.support_ = np.ones(n, dtype=bool)
        self.support_[certificate.weighed_out] = False
        self.location_ = np.array(answer.center + answer.ellipsoid.center_tail)
        within = int(self.support_.sum())
        # taut divides by one less than the number of rows, scikit-learn by their number.
        unscaled = answer.scatter / certificate.scale * ((within - 1) / within) if certificate.scale else answer.scatter
        self._set_covariance(unscaled * consistency_factor(LEVEL, features))
        self.dist_ = self._distances(rows)
        return self

    def mahalanobis(self, X: ArrayLike) -> NDArray[np.float64]:
        """Squared Mahalanobis distances of rows of shape (n, n_features)."""
        return self._distances(rows_to_judge(self, X))

    def _distances(self, rows: Any) -> NDArray[np.float64]:
        centered = np.asarray(rows, dtype=np.float64) - self.location_
        distances: NDArray[np.float64] = np.square(centered @ self._root()).sum(axis=1)
        hull = self.solution_.answer.hull
        if hull is not None:
            off = centered - centered @ hull.basis.T @ hull.basis
            limit = hull.distance + 1e-12 * (np.abs(self.location_).max() + np.abs(centered).max(initial=0))
            distances[np.sqrt(np.square(off).sum(axis=1)) > limit] = np.inf
        return distances

    def _root(self) -> NDArray[np.float64]:
        """A matrix W with W @ W.T the precision, so that no distance is negative."""
        values, vectors = np.linalg.eigh(self.get_precision())
        root: NDArray[np.float64] = vectors * np.sqrt(np.maximum(values, 0))
        return root


def _coverage(share: float | None, n: int, features: int) -> float:
    """The coverage of `taut.robust_ellipsoid` that keeps the share of n rows, or about half of them if that is more."""
    if share is None:
        return 0.5
    if not 0 < share <= 1:
        raise ValueError(f"support_fraction is {share!r}: expected a number in (0, 1], or None")
    half = (n + features + 1) // 2
    if half >= n:
        return 1.0
    # taut keeps 2 half - n + 2 (n - half) coverage rows, rounded down: half a row more than wanted is rounded away.
    wanted = int(share * n) + 0.5
    return float(np.clip((wanted - 2 * half + n) / (2 * (n - half)), 0.5, 1.0))


class EllipticEnvelope(OutlierMixin, MinCovDet):  # type: ignore[misc]
    """Outliers by their Mahalanobis distance in a robust covariance, as `sklearn.covariance.EllipticEnvelope`.

    Parameters
    ----------
    store_precision, support_fraction, random_state, threads
        Those of `MinCovDet`.
    contamination : float in (0, 0.5], default 0.1
        Share of the training rows that are outliers.

    Attributes
    ----------
    offset_ : float
        The score at which a row is an outlier.
    location_, covariance_, precision_, support_, dist_, raw_location_, raw_covariance_, raw_support_, solution_
        Those of `MinCovDet`.

    Examples
    --------
    >>> import taut
    >>> from taut.sklearn import EllipticEnvelope
    >>> model = EllipticEnvelope(contamination=0.05).fit(taut.generate("normal", 500, 2))
    >>> model.predict([[0, 0], [5, 5]])
    array([ 1, -1])
    """

    def __init__(
        self,
        *,
        store_precision: bool = True,
        support_fraction: float | None = None,
        contamination: float = 0.1,
        random_state: Any = None,
        threads: int | None = None,
    ) -> None:
        super().__init__(
            store_precision=store_precision,
            support_fraction=support_fraction,
            random_state=random_state,
            threads=threads,
        )
        self.contamination = contamination

    def fit(self, X: ArrayLike, y: Any = None) -> Self:
        """Finds the covariance of rows of shape (n_samples, n_features), and the score of outliers; `y` is not used."""
        if not 0 < self.contamination <= 0.5:
            raise ValueError(f"contamination is {self.contamination!r}: expected a number in (0, 0.5]")
        super().fit(X)
        # Rows off a flat are infinitely far: between them and the others nothing can be interpolated.
        method: Literal["linear", "higher"] = "linear" if np.isfinite(self.dist_).all() else "higher"
        self.offset_ = float(np.percentile(-self.dist_, 100 * self.contamination, method=method))
        return self

    def score_samples(self, X: ArrayLike) -> NDArray[np.float64]:
        """The negative squared Mahalanobis distances."""
        return -self.mahalanobis(X)

    def decision_function(self, X: ArrayLike) -> NDArray[np.float64]:
        """`score_samples` less `offset_`: below 0 for an outlier."""
        scores = self.score_samples(X)
        found: NDArray[np.float64] = scores - max(self.offset_, -np.finfo(np.float64).max)
        return found

    def predict(self, X: ArrayLike) -> NDArray[np.int64]:
        """1 for each row within, -1 for each outlier."""
        return np.where(self.decision_function(X) >= 0, 1, -1)

    def score(self, X: ArrayLike, y: ArrayLike, sample_weight: ArrayLike | None = None) -> float:
        """The share of rows whose label, 1 or -1, is found."""
        return float(accuracy_score(y, self.predict(X), sample_weight=sample_weight))
