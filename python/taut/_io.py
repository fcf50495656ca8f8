"""Points out of files, and meshes into files, by the readers and writers of the command."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._arrays import Rows, as_rows
from ._inputs import readable

# Vertices of a simplex: points, edges, triangles, tetrahedra.
WIDTH_MAX = 4


def read_points(
    path: str | os.PathLike[str],
    *,
    format: str | None = None,
    columns: str | Sequence[str | int] | None = None,
    header: bool | None = None,
    select: str | int | None = None,
    classes: Sequence[int] | None = None,
    bounds: Sequence[float] | None = None,
    missing: Literal["refuse", "drop"] = "refuse",
    decimal: Literal[".", ","] = ".",
) -> Rows:
    """Read the points of a file, or of all files of a folder.

    Every point of the file is read, or the error names the file, its line or row, and the value. Files compressed by gzip, xz and
    zstd are read if the package is built with them; Parquet and Arrow are not: read those by pyarrow, polars or pandas, whose
    tables every function of taut takes.

    Parameters
    ----------
    path : str or path
        The file; a folder stands for its files in the order of their names.
    format : str, optional
        The name of the format (``"csv"``, ``"npy"``, ``"ply"``, ``"las"``, ``"geojson"``, …); by default that of the extension.
    columns : str, or sequence of str and int, optional
        The columns that are coordinates, by name or by number from 0, in this order; as a text with commas it may hold ranges
        (``"x,y"``, ``"0-2"``), and ``"numeric"`` stands for all columns of numbers. By default all.
    header : bool, optional
        Whether the first row of a text file holds names; by default its contents tell.
    select : str or int, optional
        The feature of a GeoJSON, WKT or SVG file: its name, or its number from 0.
    classes : sequence of int, optional
        The classes of a LAS or LAZ file to keep.
    bounds : sequence of float, optional
        The least coordinates and then the largest ones of a box: points outside are left out.
    missing : {"refuse", "drop"}, default "refuse"
        What becomes of rows that lack a value (nothing, ``NA``, ``null``, ``NaN`` and the like): an error, or they are left out.
    decimal : {".", ","}, default "."
        The mark before decimals in text. With a comma, columns are parted by ``;`` or tabs.

    Returns
    -------
    ndarray of shape (n, d)
        float32 where the file has single precision, else float64.

    Raises
    ------
    OSError
        When the system refuses the file.
    ValueError
        When the file is damaged, ragged or of another format, or holds what is no number.
    MemoryError
        When memory does not hold the points.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import taut
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "points.csv")
    ...     _ = path.write_text("name,x,y\\nA,0,0\\nB,2,1\\n")
    ...     taut.read_points(path, columns=["x", "y"])
    array([[0., 0.],
           [2., 1.]])
    """
    if missing not in ("refuse", "drop"):
        raise ValueError(f"missing is {missing!r}: it is 'refuse' or 'drop'")
    if decimal not in (".", ","):
        raise ValueError(f"decimal is {decimal!r}: it is '.' or ','")
    is_numeric = isinstance(columns, str) and columns == "numeric"
    if columns is None or is_numeric:
        wanted = None
    else:
        wanted = columns if isinstance(columns, str) else ",".join(map(_column, columns))
    box = None if bounds is None else ",".join(repr(float(value)) for value in bounds)
    kept = None if classes is None else [int(value) for value in classes]
    feature = None if select is None else str(select)
    return _native.read_points(
        os.fspath(path), format, wanted, header, feature, kept, box, (is_numeric, missing == "drop", decimal == ","),
    )


def _column(column: str | int) -> str:
    text = str(column)
    if "," in text:
        raise ValueError(f"column {text!r} has a comma in its name: give its number")
    return text


def write_mesh(
    path: str | os.PathLike[str],
    points: ArrayLike,
    simplices: ArrayLike,
    *,
    normals: ArrayLike | None = None,
    colors: ArrayLike | None = None,
    format: str | None = None,
    text: bool = False,
) -> None:
    """Write a mesh: triangles in space, or simplices on points of up to three dimensions.

    All points are written as vertices, in order. The file is there whole or not at all: an earlier one stays as it was until then.

    Parameters
    ----------
    path : str or path
        The file; its extension names the format: ``.ply``, ``.obj``, ``.off``, ``.stl``, ``.vtu``, ``.glb``, ``.gltf``, ``.dxf``,
        ``.wrl``, ``.pov``.
    points : array_like of shape (n, d)
        The vertices.
    simplices : array_like of int of shape (m, k)
        Rows of `points` for each simplex; k from 1 to 4.
    normals : array_like of shape (n, 3), optional
        Of a surface, for each vertex.
    colors : array_like of int of shape (n, 3), optional
        Of a surface, for each vertex: red, green and blue from 0 to 255.
    format : str, optional
        The name of the format; by default that of the extension.
    text : bool, default False
        Decimals instead of bytes in formats that know both.

    Raises
    ------
    OSError
        When the system refuses the file.
    ValueError
        When the mesh is none, or the format does not hold it.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> import taut
    >>> points = taut.generate("sphere", 500, 3)
    >>> found = taut.surface(points)
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "sphere.ply")
    ...     taut.write_mesh(path, points, found.answer.triangles)
    ...     (taut.read_points(path) == points).all()
    np.True_
    """
    rows = as_rows(points)
    ids = _ids(simplices, len(rows))
    is_surface = rows.shape[1] == 3 and ids.shape[1] == 3
    if not is_surface and (normals is not None or colors is not None):
        raise ValueError("only a surface, triangles in space, has normals and colors")
    if is_surface:
        rows = np.ascontiguousarray(rows, dtype=np.float64)
    tilts = None if normals is None else _of_vertices("normals", normals, len(rows)).astype(np.float64).tolist()
    shades = None if colors is None else _shades(_of_vertices("colors", colors, len(rows)))
    _native.write_mesh(os.fspath(path), rows, ids, tilts, shades, format, text)


def _ids(simplices: ArrayLike, count: int) -> Any:
    """Simplices as numbers of 32 bits, each that of a row."""
    ids = np.asarray(readable("simplices", simplices))
    if ids.ndim != 2 or not 1 <= ids.shape[1] <= WIDTH_MAX:
        raise ValueError(f"`simplices` have the shape {ids.shape}: expected (m, 1) to (m, {WIDTH_MAX})")
    if ids.size and ids.dtype.kind not in "iu":
        raise ValueError(f"`simplices` are {ids.dtype}: expected numbers of rows")
    wrong = np.argwhere((ids < 0) | (ids >= count))
    if len(wrong):
        place = tuple(int(i) for i in wrong[0])
        raise ValueError(f"simplex {place[0]} names row {ids[place]}, but there are {count}")
    return np.ascontiguousarray(ids, dtype=np.uint32)


def _of_vertices(name: str, values: ArrayLike, count: int) -> Any:
    array = np.asarray(readable(name, values))
    if array.shape != (count, 3):
        raise ValueError(f"`{name}` have the shape {array.shape}: expected ({count}, 3)")
    return array


def _shades(colors: Any) -> list[list[int]]:
    if colors.dtype.kind not in "iu" or colors.size and not (0 <= colors.min() and colors.max() <= 255):
        raise ValueError("`colors` must be whole numbers from 0 to 255")
    found: list[list[int]] = colors.tolist()
    return found
