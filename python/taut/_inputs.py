"""Containers of points that NumPy does not read as arrays of numbers, read by one rule.

| in the order in which it is tried | read by |
|---|---|
| arrays of NumPy, numbers and sequences | NumPy |
| sparse matrices, lazy frames and arrays | not: the message says what to call |
| geometries of shapely and GeoPandas | `get_coordinates` |
| frames and series of pandas and polars | their own `to_numpy`, nulls refused |
| Arrow, `__arrow_c_stream__` and `__arrow_c_array__` | pyarrow, nulls refused |
| tensors, `__dlpack__` | `numpy.from_dlpack`, on the CPU |
| meshes and clouds | their `points`, else their `vertices` |

Nothing is copied where the layout is that of rows in C order, and no library is imported that the caller has not imported.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from numpy.typing import NDArray

# Kinds of devices of the DLPack protocol whose memory the CPU reads: its own, and that pinned for CUDA and ROCm.
CPU_DEVICES = (1, 3, 11)


def readable(name: str, values: Any) -> Any:
    """What NumPy reads as an array of numbers: `values` themselves where it does so already."""
    if isinstance(values, np.ndarray):
        return _of_geometries(name, values) if values.dtype == object else values
    if values is None or isinstance(values, (bool, int, float, complex, str, bytes, list, tuple, range, memoryview)):
        return values
    kind = type(values)
    library = kind.__module__.partition(".")[0]
    if callable(getattr(values, "toarray", None)) and hasattr(values, "nnz"):
        raise TypeError(f"{name} are a sparse {kind.__name__}: pass {name}.toarray()")
    _refuse_lazy(name, values)
    if callable(getattr(values, "get_coordinates", None)) and hasattr(values, "has_z"):
        return _of_frame_of_geometries(name, values)
    if library == "shapely":
        return _coordinates(name, [values])
    if library == "pandas" and hasattr(values, "to_numpy"):
        return _of_pandas(name, values)
    if library == "polars" and hasattr(values, "null_count"):
        return _of_polars(name, values)
    if hasattr(values, "__arrow_c_stream__") or hasattr(values, "__arrow_c_array__"):
        return _of_arrow(name, values)
    if hasattr(values, "__dlpack__") and hasattr(values, "__dlpack_device__"):
        return _of_tensor(name, values)
    is_array_like = hasattr(values, "__array__") or hasattr(values, "__len__")
    return values if is_array_like and not _is_mesh(values) else _of_mesh(name, values)


def _refuse_lazy(name: str, values: Any) -> None:
    kind = type(values).__name__
    graph = getattr(values, "__dask_graph__", None)
    if callable(graph) and graph() is not None:
        raise TypeError(f"{name} are a lazy {kind}: call compute() first")
    if callable(getattr(values, "collect", None)) and not hasattr(values, "__array__") and not hasattr(values, "to_numpy"):
        raise TypeError(f"{name} are a lazy {kind}: call collect() first")


def _of_geometries(name: str, values: NDArray[np.object_]) -> Any:
    """The coordinates of an array of geometries; other arrays of objects as they are."""
    first = next(iter(values.flat), None)
    if type(first).__module__.partition(".")[0] != "shapely":
        return values
    return _coordinates(name, values)


def _coordinates(name: str, geometries: Any) -> Any:
    shapely: Any = sys.modules["shapely"]
    array = np.asarray(geometries, dtype=object).ravel()
    missing = np.flatnonzero(shapely.is_missing(array) | shapely.is_empty(array))
    if missing.size:
        raise ValueError(f"geometry {missing[0]} of the {name} is missing or empty: leave such rows out")
    return shapely.get_coordinates(array, include_z=bool(shapely.has_z(array).all()))


def _of_frame_of_geometries(name: str, values: Any) -> Any:
    missing = np.flatnonzero(np.asarray(values.geometry.isna() | values.geometry.is_empty))
    if missing.size:
        raise ValueError(f"geometry {missing[0]} of the {name} is missing or empty: leave such rows out")
    return values.get_coordinates(include_z=bool(values.has_z.all())).to_numpy()


def _of_tensor(name: str, values: Any) -> Any:
    if values.__dlpack_device__()[0] not in CPU_DEVICES:
        raise TypeError(f"{name} are a {type(values).__name__} on another device: move them to the CPU")
    return np.from_dlpack(values)


def _null(name: str, row: Any, column: Any) -> ValueError:
    place = f"row {row}" if column is None else f"row {row}, column {column}"
    return ValueError(f"{name} have a null in {place}: fill it or leave the row out")


def _of_pandas(name: str, values: Any) -> Any:
    if not hasattr(values, "columns"):
        values = values.to_frame()
        return _of_pandas(name, values)[:, 0]
    if all(isinstance(dtype, np.dtype) and dtype != object for dtype in values.dtypes):
        return values.to_numpy()
    nulls = np.argwhere(values.isna().to_numpy())
    columns = [values.iloc[:, i] for i in range(values.shape[1])]
    for row, i in nulls:
        # In a column of floats of NumPy, NaN is a number that is not finite, which the library names.
        if not isinstance(columns[i].dtype, np.dtype) or columns[i].dtype == object:
            raise _null(name, row, repr(values.columns[i]))
    # The types of nullable and Arrow columns know those of NumPy.
    dtypes = [getattr(column.dtype, "numpy_dtype", None) for column in columns]
    return np.column_stack([column.to_numpy(dtype=dtype) for column, dtype in zip(columns, dtypes)])


def _of_polars(name: str, values: Any) -> Any:
    columns = list(values.get_columns()) if hasattr(values, "get_columns") else [values]
    for column in columns:
        if column.null_count():
            raise _null(name, column.is_null().arg_max(), repr(column.name) if len(columns) > 1 else None)
    return values.to_numpy()


def _of_arrow(name: str, values: Any) -> Any:
    try:
        # The caller has it, unless the data come from another library of Arrow's.
        import pyarrow
    except ImportError:
        raise TypeError(f"{name} are Arrow data: install pyarrow, or pass an array") from None
    if isinstance(values, (pyarrow.Array, pyarrow.ChunkedArray)):
        return _of_arrow_column(name, values, None)
    if not isinstance(values, (pyarrow.Table, pyarrow.RecordBatch)):
        try:
            values = pyarrow.table(values)
        except (TypeError, ValueError, pyarrow.ArrowException):
            has_stream = hasattr(values, "__arrow_c_stream__")
            return _of_arrow_column(name, (pyarrow.chunked_array if has_stream else pyarrow.array)(values), None)
    if values.num_columns == 1:
        return _of_arrow_column(name, values.column(0), values.schema.names[0], as_table=True)
    columns = [_of_arrow_column(name, values.column(i), field) for i, field in enumerate(values.schema.names)]
    return np.column_stack(columns) if columns else np.empty((values.num_rows, 0))


def _of_arrow_column(name: str, column: Any, field: str | None, *, as_table: bool = False) -> Any:
    """Numbers of one axis; rows, where they are lists of one length or the whole of a table."""
    if column.null_count:
        row = int(np.flatnonzero(column.is_null().to_numpy(zero_copy_only=False))[0])
        raise _null(name, row, None if field is None else repr(field))
    if hasattr(column, "combine_chunks") and hasattr(column, "num_chunks"):
        column = column.chunk(0) if column.num_chunks == 1 else column.combine_chunks()
    width = getattr(column.type, "list_size", None)
    if width is not None:
        flat = column.flatten()
        if flat.null_count:
            place = int(np.flatnonzero(flat.is_null().to_numpy(zero_copy_only=False))[0])
            raise _null(name, place // width, place % width)
        return flat.to_numpy(zero_copy_only=False).reshape(-1, width)
    if hasattr(column.type, "num_fields") and column.type.num_fields > 0 and hasattr(column, "field"):
        fields = [column.type.field(i).name for i in range(column.type.num_fields)]
        return np.column_stack([_of_arrow_column(name, part, at) for part, at in zip(column.flatten(), fields)])
    numbers = column.to_numpy(zero_copy_only=False)
    return numbers.reshape(-1, 1) if as_table else numbers


def _is_mesh(values: Any) -> bool:
    return not hasattr(values, "__array__") and (hasattr(values, "points") or hasattr(values, "vertices"))


def _of_mesh(name: str, values: Any) -> Any:
    for attribute in ("points", "vertices"):
        part = getattr(values, attribute, None)
        if part is not None and not callable(part):
            return readable(name, part)
    if hasattr(values, "__buffer__") or hasattr(values, "__array_interface__"):
        return values
    raise TypeError(
        f"{name} are a {type(values).__name__}: expected an array, a frame, or an object with points, vertices or Arrow data"
    )
