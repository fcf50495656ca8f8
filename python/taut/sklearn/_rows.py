"""Rows as scikit-learn checks them and as the compiled part takes them."""

from __future__ import annotations

from typing import Any

import numpy as np
from sklearn.utils.validation import check_is_fitted, validate_data

from .._arrays import Rows

# float32 and float64 are taken as they are.
DTYPES = [np.float64, np.float32]


def rows_to_fit(estimator: Any, X: Any, **options: Any) -> Any:
    """The rows of X, with y where it is among the options; names and number of features are kept by the estimator."""
    return validate_data(estimator, X, dtype=DTYPES, order="C", **options)


def rows_to_judge(estimator: Any, X: Any) -> Rows:
    """The rows of X for an estimator that was fitted to rows of as many features."""
    check_is_fitted(estimator)
    rows: Rows = validate_data(estimator, X, dtype=DTYPES, order="C", reset=False)
    return rows
