"""Outlier detectors by the smallest shape around all rows."""

from __future__ import annotations

from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, OutlierMixin

from .._ball import ball
from .._ellipsoid import ellipsoid
from ._rows import rows_to_fit, rows_to_judge


class _Enclosing(OutlierMixin, BaseEstimator):  # type: ignore[misc]
    """What both detectors share: scores that fall outward, and the score at which a row is an outlier."""

    def _solve(self, rows: Any) -> Any:
        raise NotImplementedError

    def _size(self, rows: Any) -> NDArray[np.float64]:
        """How far out each row is."""
        raise NotImplementedError

    def _border(self) -> float:
        """The size of a row on the border of the shape."""
        raise NotImplementedError

    def fit(self, X: ArrayLike, y: Any = None) -> Self:
        """Finds the smallest shape around rows of shape (n_samples, n_features); `y` is not used."""
        share = self.contamination
        if share != "auto" and not 0 < share <= 0.5:
            raise ValueError(f"contamination is {share!r}: expected a number in (0, 0.5], or 'auto'")
        rows = rows_to_fit(self, X)
        self.solution_ = self._solve(rows)
        if share == "auto":
            # By the last digits a row on the border may be beyond it.
            self.offset_ = -max(self._border(), float(self._size(rows).max()))
        else:
            self.offset_ = float(np.percentile(-self._size(rows), 100 * share))
        return self

    def score_samples(self, X: ArrayLike) -> NDArray[np.float64]:
        """How far in each row is: lower is farther out."""
        rows = rows_to_judge(self, X)
        return -self._size(rows)

    def decision_function(self, X: ArrayLike) -> NDArray[np.float64]:
        """`score_samples` less `offset_`: below 0 for an outlier."""
        scores: NDArray[np.float64] = self.score_samples(X) - self.offset_
        return scores

    def predict(self, X: ArrayLike) -> NDArray[np.int64]:
        """1 for each row within, -1 for each outlier."""
        return np.where(self.decision_function(X) >= 0, 1, -1)


class EnclosingBall(_Enclosing):
    """Outliers by their distance from the center of the smallest ball around all rows.

    The ball is not robust: one row far away moves its center. It says which rows are extreme, and for rows to come,
    with ``contamination="auto"``, which are beyond everything seen so far.

    Parameters
    ----------
    contamination : float in (0, 0.5] or "auto", default 0.1
        Share of the training rows that are outliers: those farthest from the center. "auto" takes none, and for rows to come
        those outside the ball.
    epsilon : float in [0, 1), default 1e-9
        Relative gap to prove between the radius and the least one.
    threads : int, optional
        By default all cores; nothing depends on it.

    Attributes
    ----------
    solution_ : taut.Solution
        The ball around all training rows with its certificate.
    offset_ : float
        The score at which a row is an outlier.
    n_features_in_ : int
        Features of the rows.
    feature_names_in_ : ndarray of shape (n_features_in_,)
        Their names, where all are strings.

    Examples
    --------
    >>> from taut.sklearn import EnclosingBall
    >>> detector = EnclosingBall(contamination="auto").fit([[0, 0], [2, 0], [1, 1]])
    >>> detector.predict([[1, -1], [2, 1]])
    array([ 1, -1])
    """

    def __init__(
        self,
        *,
        contamination: float | Literal["auto"] = 0.1,
        epsilon: float = 1e-9,
        threads: int | None = None,
    ) -> None:
        self.contamination = contamination
        self.epsilon = epsilon
        self.threads = threads

    def _solve(self, rows: Any) -> Any:
        return ball(rows, epsilon=self.epsilon, threads=self.threads)

    def _size(self, rows: Any) -> NDArray[np.float64]:
        distances: NDArray[np.float64] = self.solution_.answer.distance(rows)
        return distances

    def _border(self) -> float:
        return float(self.solution_.answer.radius)


class EnclosingEllipsoid(_Enclosing):
    """Outliers by the norm that has the ellipsoid of least volume around all rows as its unit ball.

    Like the ball it is not robust, but it needs no scaling of the features. `EllipticEnvelope` is the robust one.

    Parameters
    ----------
    contamination : float in (0, 0.5] or "auto", default 0.1
        Share of the training rows that are outliers: those of the largest norm. "auto" takes none, and for rows to come
        those outside the ellipsoid.
    epsilon : float in (0, 1), default 1e-6
        Gap in log-volume to prove.
    threads : int, optional
        By default all cores; nothing depends on it.

    Attributes
    ----------
    solution_ : taut.Solution
        The ellipsoid around all training rows with its certificate.
    offset_ : float
        The score at which a row is an outlier.
    n_features_in_ : int
        Features of the rows.
    feature_names_in_ : ndarray of shape (n_features_in_,)
        Their names, where all are strings.

    Examples
    --------
    >>> from taut.sklearn import EnclosingEllipsoid
    >>> detector = EnclosingEllipsoid(contamination="auto").fit([[-9, 0], [9, 0], [0, 1], [0, -1]])
    >>> detector.predict([[5, 0], [0, 5]])
    array([ 1, -1])
    """

    def __init__(
        self,
        *,
        contamination: float | Literal["auto"] = 0.1,
        epsilon: float = 1e-6,
        threads: int | None = None,
    ) -> None:
        self.contamination = contamination
        self.epsilon = epsilon
        self.threads = threads

    def _solve(self, rows: Any) -> Any:
        return ellipsoid(rows, epsilon=self.epsilon, threads=self.threads)

    def _size(self, rows: Any) -> NDArray[np.float64]:
        norms: NDArray[np.float64] = self.solution_.answer.norm(rows)
        return norms

    def _border(self) -> float:
        return 1.0 + 1e-9
