"""k-center clustering."""

from __future__ import annotations

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, ClassNamePrefixFeaturesOutMixin, ClusterMixin, TransformerMixin

from .._centers import CentersMethod, centers
from ._rows import rows_to_fit, rows_to_judge


class KCenter(ClassNamePrefixFeaturesOutMixin, TransformerMixin, ClusterMixin, BaseEstimator):  # type: ignore[misc]
    """Clusters by k centers such that the farthest row is as near to one of them as can be.

    Parameters
    ----------
    n_clusters : int, default 8
        Most centers; fewer are found where fewer are as good.
    epsilon : float in [0, 1), default 0.05
        Relative gap to prove between the radius and the least one.
    method : {"tree", "farthest-first", "stream", "thesis"}, default "tree"
        As of `taut.centers`.
    outliers : int, default 0
        Most rows that may be left out; their label is -1.
    discrete : bool, default False
        Whether centers have to be rows of the input.
    max_nodes : int, default 100,000
        Nodes of the search before the best centers so far are taken, with the gap they have.
    threads : int, optional
        By default all cores; nothing depends on it.

    Attributes
    ----------
    cluster_centers_ : ndarray of shape (n_centers, n_features)
        The centers.
    labels_ : ndarray of int64, shape (n_samples,)
        The center next to each row; -1 for a row left out.
    radius_ : float
        The largest distance of a row that is not left out to its center.
    lower_bound_ : float
        Proved: no `n_clusters` centers have a smaller radius.
    solution_ : taut.Solution
        The centers with their certificate.
    n_features_in_ : int
        Features of the rows.
    feature_names_in_ : ndarray of shape (n_features_in_,)
        Their names, where all are strings.

    Examples
    --------
    >>> from taut.sklearn import KCenter
    >>> model = KCenter(n_clusters=2).fit([[0, 0], [0, 2], [9, 0], [9, 1]])
    >>> bool(model.labels_[0] == model.labels_[1] != model.labels_[2] == model.labels_[3])
    True
    >>> bool(model.lower_bound_ <= 1 <= model.radius_ <= 1.05)
    True
    """

    def __init__(
        self,
        n_clusters: int = 8,
        *,
        epsilon: float = 0.05,
        method: CentersMethod = "tree",
        outliers: int = 0,
        discrete: bool = False,
        max_nodes: int = 100_000,
        threads: int | None = None,
    ) -> None:
        self.n_clusters = n_clusters
        self.epsilon = epsilon
        self.method = method
        self.outliers = outliers
        self.discrete = discrete
        self.max_nodes = max_nodes
        self.threads = threads

    def fit(self, X: ArrayLike, y: Any = None) -> Self:
        """Finds centers of rows of shape (n_samples, n_features); `y` is not used."""
        rows = rows_to_fit(self, X)
        self.solution_ = centers(
            rows,
            self.n_clusters,
            epsilon=self.epsilon,
            method=self.method,
            outliers=self.outliers,
            discrete=self.discrete,
            max_nodes=self.max_nodes,
            threads=self.threads,
        )
        answer = self.solution_.answer
        self.cluster_centers_ = np.array(answer.centers, dtype=np.float64)
        self.radius_ = float(answer.radius)
        self.lower_bound_ = float(answer.lower_bound)
        self._n_features_out = len(self.cluster_centers_)
        self.labels_ = answer.assign(rows)
        self.labels_[answer.outliers] = -1
        return self

    def predict(self, X: ArrayLike) -> NDArray[np.int64]:
        """The center next to each row, of equally near ones the first."""
        rows = rows_to_judge(self, X)
        nearest: NDArray[np.int64] = self.solution_.answer.assign(rows)
        return nearest

    def transform(self, X: ArrayLike) -> NDArray[np.float64]:
        """The distance of each row to each center, of shape (n_samples, n_centers)."""
        rows = rows_to_judge(self, X)
        columns = [np.sqrt(np.square(rows - center).sum(axis=1)) for center in self.cluster_centers_]
        return np.column_stack(columns)
