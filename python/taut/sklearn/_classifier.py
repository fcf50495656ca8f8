"""Classes by the smallest ball around the rows of each."""

from __future__ import annotations

from typing import Any, Literal, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from sklearn.base import BaseEstimator, ClassifierMixin
from sklearn.utils.multiclass import check_classification_targets

from .._ball import ball
from ._rows import rows_to_fit, rows_to_judge


class BallClassifier(ClassifierMixin, BaseEstimator):  # type: ignore[misc]
    """Classes by the smallest ball around the rows of each: a row is of the class whose ball it is in most deeply.

    `taut.MebClassifier` does the same in the feature space of a kernel, soft and scaled if asked to.

    Parameters
    ----------
    cells : {"power", "voronoi"}, default "power"
        What is compared: the squared distance from the center less the squared radius, whose cells are polyhedra, or the
        distance from the center.
    epsilon : float in [0, 1), default 1e-9
        Relative gap to prove between each radius and the least one.
    threads : int, optional
        By default all cores; nothing depends on it.

    Attributes
    ----------
    classes_ : ndarray of shape (n_classes,)
        The labels, in order.
    solution_ : tuple of taut.Solution
        For each class its ball with the certificate, over the training rows of the class in their order.
    n_features_in_ : int
        Features of the rows.
    feature_names_in_ : ndarray of shape (n_features_in_,)
        Their names, where all are strings.

    Examples
    --------
    >>> from taut.sklearn import BallClassifier
    >>> model = BallClassifier().fit([[0, 0], [0, 1], [5, 5], [6, 5]], ["low", "low", "high", "high"])
    >>> print(model.predict([[1, 0], [5, 6]]))
    ['low' 'high']
    """

    def __init__(
        self,
        *,
        cells: Literal["power", "voronoi"] = "power",
        epsilon: float = 1e-9,
        threads: int | None = None,
    ) -> None:
        self.cells = cells
        self.epsilon = epsilon
        self.threads = threads

    def fit(self, X: ArrayLike, y: ArrayLike) -> Self:
        """Finds the balls of rows of shape (n_samples, n_features) with labels of shape (n_samples,)."""
        if self.cells not in ("power", "voronoi"):
            raise ValueError(f"cells is {self.cells!r}: expected 'power' or 'voronoi'")
        rows, labels = rows_to_fit(self, X, y=y)
        check_classification_targets(labels)
        self.classes_, classes = np.unique(labels, return_inverse=True)
        of_class = [np.ascontiguousarray(rows[classes == number]) for number in range(len(self.classes_))]
        self.solution_ = tuple(ball(part, epsilon=self.epsilon, threads=self.threads) for part in of_class)
        return self

    def _scores(self, X: ArrayLike) -> NDArray[np.float64]:
        rows = rows_to_judge(self, X)
        balls = [solution.answer for solution in self.solution_]
        distances = np.column_stack([one.distance(rows) for one in balls])
        if self.cells == "voronoi":
            return -distances
        scores: NDArray[np.float64] = np.square([one.radius for one in balls]) - np.square(distances)
        return scores

    def decision_function(self, X: ArrayLike) -> NDArray[np.float64]:
        """Scores of shape (n, n_classes); of two classes the score of the second less that of the first, of shape (n,)."""
        scores = self._scores(X)
        return scores[:, 1] - scores[:, 0] if scores.shape[1] == 2 else scores

    def predict(self, X: ArrayLike) -> NDArray[Any]:
        """The label of each row."""
        best = self._scores(X).argmax(axis=1)
        found: NDArray[Any] = self.classes_[best]
        return found
