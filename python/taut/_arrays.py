"""What counts as points: the one place where arrays are put in order."""

from __future__ import annotations

from typing import Any

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
    if radii is None:
        return _real("points", points, 2)
    rows = _real("centers", points, 2)
    if rows.shape[1] == 0:
        raise ValueError(f"centers have shape {rows.shape}: the dimension must be at least 1")
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
    if array.dtype.kind == "O":
        return _converted(name, array)
    if array.dtype.kind in "iu" and array.dtype.itemsize == 8:
        _refuse_inexact(name, array)
    # A fitting array comes back from `require` itself.
    if array.dtype == np.float32:
        return np.require(array, dtype=np.float32, requirements=["C", "ALIGNED"])
    return np.require(array, dtype=np.float64, requirements=["C", "ALIGNED"])


def _converted(name: str, array: NDArray[np.object_]) -> NDArray[np.float64]:
    """Numbers that NumPy knows as Python objects only, such as integers beyond 64 bits, one by one."""
    numbers = np.empty(array.shape)
    for index, value in np.ndenumerate(array):
        if isinstance(value, (str, bytes)):
            raise TypeError(f"{_place(name, index)} is {value!r}: expected a real number")
        try:
            number = float(value)
        except (TypeError, ValueError):
            kind = type(value).__name__
            raise TypeError(f"{_place(name, index)} is of type {kind}: expected a real number") from None
        except OverflowError:
            raise ValueError(f"{_place(name, index)} exceeds the largest number of float64") from None
        if isinstance(value, (int, np.integer)) and int(number) != value:
            raise _inexact(name, index, value)
        numbers[index] = number
    return numbers


def _refuse_inexact(name: str, array: NDArray[Any]) -> None:
    """Raises for the first integer of 64 bits that float64 would round."""
    far = np.argwhere((array > 2**53) | (array < -(2**53)))
    for index in map(tuple, far.tolist()):
        value = int(array[index])
        if int(float(value)) != value:
            raise _inexact(name, index, value)


def _inexact(name: str, index: tuple[int, ...], value: object) -> ValueError:
    return ValueError(f"{_place(name, index)} is {value}, which float64 cannot hold exactly: scale or shift it")


def _place(name: str, index: tuple[int, ...]) -> str:
    """The words of the errors for NaN, with numbers from 0."""
    if name == "radii":
        return f"the radius of ball {index[0]}"
    item = "point" if name == "points" else "the center of ball"
    return f"coordinate {index[1]} of {item} {index[0]}"
