"""What counts as points: the one place where arrays are put in order."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Rows = NDArray[np.float32] | NDArray[np.float64]


def as_rows(points: ArrayLike, radii: ArrayLike | None = None) -> Rows:
    """Rows of float32 or float64 in C order; a fitting array is returned as it is.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Points, or centres of balls.
    radii : array_like of shape (n,), optional
        Radii of balls: they become the last column, in a new array.

    Returns
    -------
    ndarray of shape (n, d) or (n, d + 1)
        float32 where `points` (and `radii`) are, else float64.
    """
    rows = _real("points" if radii is None else "centers", points, 2)
    if radii is None:
        return rows
    column = _real("radii", radii, 1)
    if len(column) != len(rows):
        raise ValueError(f"there are {len(rows)} centers, but {len(column)} radii")
    return _real("balls", np.column_stack([rows, column]), 2)


def _real(name: str, values: ArrayLike, ndim: int) -> Rows:
    if np.ma.isMaskedArray(values):
        raise TypeError(f"{name} are a masked array: fill the masked values or leave their rows out")
    array = np.asarray(values)
    if array.dtype.kind not in "fiubO":
        raise TypeError(f"{name} have dtype {array.dtype}: expected real numbers")
    if array.ndim != ndim:
        shape = "(n, d)" if ndim == 2 else "(n,)"
        raise ValueError(f"{name} have shape {array.shape}: expected {shape}")
    # A fitting array comes back from `require` itself.
    if array.dtype == np.float32:
        return np.require(array, dtype=np.float32, requirements=["C", "ALIGNED"])
    return np.require(array, dtype=np.float64, requirements=["C", "ALIGNED"])
