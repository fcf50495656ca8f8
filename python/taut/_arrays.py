"""What counts as points: the one place where arrays are put in order."""

from __future__ import annotations

from collections.abc import Iterable
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._inputs import readable

Rows = NDArray[np.float32] | NDArray[np.float64]

# What entries of a shape matrix may differ by from those across the diagonal, in units of the largest: rounding.
SYMMETRY = 1e-8


def as_rows(
    points: ArrayLike,
    radii: ArrayLike | None = None,
    shapes: ArrayLike | None = None,
    offsets: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    groups: ArrayLike | None = None,
) -> Rows:
    """Rows of float32 or float64 in C order; a fitting array is returned as it is.

    Parameters
    ----------
    points : array_like of shape (n, d)
        Points, centers of balls or ellipsoids, or normals of half-spaces.
    radii : array_like of shape (n,), optional
        Radii of balls: they become the last column, in a new array.
    shapes : array_like of shape (n, d, d), optional
        Shape matrices of ellipsoids: their lower triangles become the last columns, row by row, in a new array.
    offsets : array_like of shape (n,), optional
        Offsets of half-spaces: they become the last column, in a new array.
    weights : array_like of shape (n,), optional
        Weights of points: they become the last column, in a new array.
    groups : array_like of shape (n,), optional
        The groups of points or balls: they become the last column, after any other, in a new array.

    Returns
    -------
    ndarray of shape (n, d), (n, d + 1) or (n, d (d + 3) / 2), with groups of one column more
        float32 where all that is given is, else float64.
    """
    given = [values is not None for values in (radii, shapes, offsets, weights)]
    if sum(given) > 1:
        raise ValueError("only one of radii, shapes, offsets and weights can be given")
    if groups is not None:
        return with_groups(as_rows(points, radii, shapes, offsets, weights), groups)
    if radii is not None:
        return _with_column("centers", points, "radii", radii)
    if offsets is not None:
        return _with_column("normals", points, "offsets", offsets)
    if weights is not None:
        return _with_column("points", points, "weights", weights)
    if shapes is not None:
        return _with_shapes(points, shapes)
    return _real("points", points, 2)


def with_groups(rows: Rows, groups: ArrayLike, column: int | None = None) -> Rows:
    """Rows with one more column, by default the last, that holds their groups."""
    numbers = _real("groups", groups, 1)
    if len(numbers) != len(rows):
        raise ValueError(f"there are {len(rows)} rows, but {len(numbers)} groups")
    at = rows.shape[1] if column is None else column
    if at > rows.shape[1]:
        raise ValueError(f"rows have {rows.shape[1]} columns, but their groups are said to be column {at}")
    return _real("rows", np.column_stack([rows[:, :at], numbers, rows[:, at:]]), 2)


def as_sets(sets: ArrayLike | Iterable[ArrayLike]) -> list[Rows]:
    """Many arrays of points, each as by `as_rows`.

    Parameters
    ----------
    sets : array_like of shape (m, n, d), or iterable of array_like of shape (n_i, d_i)
        Point sets of one size as one array, which is put in order as a whole, or of any sizes one by one.

    Returns
    -------
    list of m ndarray
    """
    if isinstance(sets, np.ndarray) and sets.ndim == 3:
        return list(_real("sets", sets, 3))
    if isinstance(sets, np.ndarray) and sets.dtype != object:
        raise ValueError(f"sets have shape {sets.shape}: expected (m, n, d), or a list of arrays of shape (n, d)")
    rows = []
    for number, points in enumerate(sets):  # type: ignore[arg-type]
        try:
            rows.append(as_rows(points))
        except (TypeError, ValueError) as error:
            raise type(error)(f"point set {number}: {error}") from None
    return rows


def _with_column(name: str, points: ArrayLike, other: str, values: ArrayLike) -> Rows:
    rows = _rows_of_some_dimension(name, points)
    column = _real(other, values, 1)
    if len(column) != len(rows):
        raise ValueError(f"there are {len(rows)} {name}, but {len(column)} {other}")
    return _real("rows", np.column_stack([rows, column]), 2)


def _with_shapes(points: ArrayLike, values: ArrayLike) -> Rows:
    rows = _rows_of_some_dimension("centers of ellipsoids", points)
    shapes = _real("shapes", values, 3)
    n, d = rows.shape
    if shapes.shape != (n, d, d):
        raise ValueError(f"shapes have shape {shapes.shape}: expected {(n, d, d)}, as the centers are {(n, d)}")
    # What is not finite is left to the library, which names its place: comparisons with NaN are false.
    with np.errstate(invalid="ignore"):
        off = np.abs(shapes - shapes.transpose(0, 2, 1)).max(axis=(1, 2), initial=0)
        size = np.abs(shapes).max(axis=(1, 2), initial=0)
        skew = np.flatnonzero(off > SYMMETRY * size)
    if skew.size:
        raise ValueError(f"shape {skew[0]} is not symmetric: entries differ by {off[skew[0]]:.3g}")
    lower = np.tril_indices(d)
    return _real("rows", np.concatenate([rows, shapes[:, lower[0], lower[1]]], axis=1), 2)


def _rows_of_some_dimension(name: str, points: ArrayLike) -> Rows:
    rows = _real(name, points, 2)
    if rows.shape[1] == 0:
        raise ValueError(f"{name} have shape {rows.shape}: the dimension must be at least 1")
    return rows


def _real(name: str, values: ArrayLike, ndim: int) -> Rows:
    if np.ma.isMaskedArray(values):
        raise TypeError(f"{name} are a masked array: fill the masked values or leave their rows out")
    try:
        array = np.asarray(readable(name, values))
        if array.dtype == object and not isinstance(values, np.ndarray):
            array = np.asarray(readable(name, array))
    except ValueError as error:
        raise ValueError(f"{name} form no array: {error}") from None
    if array.dtype.kind not in "fiubO":
        raise TypeError(f"{name} have dtype {array.dtype}: expected real numbers")
    if array.ndim != ndim:
        shape = {1: "(n,)", 2: "(n, d)", 3: "(n, d, d)"}[ndim]
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
    """Numbers that NumPy knows as Python objects only, such as integers beyond 64 bits."""
    try:
        # NumPy also takes texts for numbers, but no text equals a number, nor does an integer one that was rounded.
        numbers = array.astype(np.float64)
        if (numbers == array).all() or _is_exact(numbers, array):
            return numbers
    except (TypeError, ValueError, OverflowError):
        pass
    return _refuse_objects(name, array)


def _is_exact(numbers: NDArray[np.float64], array: NDArray[np.object_]) -> bool:
    """Whether all that differs are numbers with a fraction, such as decimals, which float64 may round, and NaN."""
    differs = array[numbers != array]
    return all(isinstance(value, (float, np.floating, Decimal, Fraction)) for value in differs)


def _refuse_objects(name: str, array: NDArray[np.object_]) -> NDArray[np.float64]:
    """Converts one by one, up to the first that cannot be, with its place."""
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
    match name:
        case "radii":
            return f"the radius of ball {index[0]}"
        case "weights":
            return f"the weight of point {index[0]}"
        case "groups":
            return f"the group of point {index[0]}"
        case "offsets":
            return f"offset {index[0]}"
        case "shapes":
            return f"entry {index[1:]} of shape {index[0]}"
        case "normals":
            return f"coordinate {index[1]} of normal {index[0]}"
        case "sets":
            return f"coordinate {index[2]} of point {index[1]} of point set {index[0]}"
        case "points":
            item = "point"
        case "centers of ellipsoids":
            item = "the center of ellipsoid"
        case _:
            item = "the center of ball"
    return f"coordinate {index[1]} of {item} {index[0]}"
