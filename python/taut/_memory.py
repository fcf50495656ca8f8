"""Files larger than memory, samples, and points in an order where neighbors are near each other."""

from __future__ import annotations

import operator
import os
from typing import Any, Literal

import numpy as np
from numpy.lib import format as npy
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._answers.order import Order
from ._arrays import as_rows
from ._file_solution import FileSolution, Path
from ._solution import Solution

KeyKind = Literal["u64", "i64", "f64", "bytes"]
OrderCurve = Literal["hilbert", "morton"]


def sort_file(
    input: Path,
    output: Path,
    *,
    width: int,
    key: tuple[int, int] | None = None,
    kind: KeyKind = "u64",
    memory: int = 256 << 20,
    scratch: Path | None = None,
    resume: Path | None = None,
) -> FileSolution:
    """Sort a file of records of fixed width, which may be larger than memory.

    Records with equal keys keep their order. The output appears whole or not at all, and may be the input.

    Parameters
    ----------
    input, output : path
        The records, one after the other, and where to write them.
    width : int
        Bytes of a record, 1 to 16777216. Of a NumPy array in a file, ``array.itemsize``.
    key : (int, int), optional
        The bytes of a record that are the key: the first, and the one after the last. By default the first eight;
        of `kind` ``"bytes"`` all.
    kind : str, default "u64"
        What the key is: ``"u64"``, ``"i64"`` or ``"f64"``, least significant byte first, doubles in total order
        with NaN last; or ``"bytes"``, compared from the first one on.
    memory : int, default 256 MiB
        Most bytes of memory to use for records, at least 64 KiB.
    scratch : path, optional
        Folder for what does not fit in memory; by default that of the output. Not together with `resume`.
    resume : path, optional
        Keep what was done in this file until the output is there; go on from it if it is there. Then the input must be
        the same file, unchanged; what was done is compared with it by a hash.

    Returns
    -------
    FileSolution
        ``check(output)`` or ``check(output, input)`` is a second opinion; ``to_json()`` the certificate, as
        ``taut verify`` takes it.

    Raises
    ------
    ValueError
        When an option is out of range, the file ends within a record, or `resume` is a file of another sort.
    OSError
        When the system refuses; the earlier output is as it was.

    Examples
    --------
    >>> import pathlib, tempfile, numpy as np, taut
    >>> folder = tempfile.TemporaryDirectory()
    >>> path = pathlib.Path(folder.name)
    >>> records = np.zeros(1000, dtype=[("key", "<f8"), ("place", "<i8")])
    >>> records["key"] = np.random.default_rng(1).normal(size=1000)
    >>> records["place"] = range(1000)
    >>> records.tofile(path / "records")
    >>> found = taut.sort_file(path / "records", path / "sorted", width=16, key=(0, 8), kind="f64")
    >>> found.check(path / "sorted", path / "records")
    FileVerdict(items=1000, compared=True)
    >>> ordered = np.fromfile(path / "sorted", dtype=records.dtype)
    >>> bool((np.diff(ordered["key"]) >= 0).all())
    True
    >>> folder.cleanup()
    """
    width = operator.index(width)
    if key is None:
        key = (0, width if kind == "bytes" else 8)
    start, end = key
    if scratch is not None and resume is not None:
        raise ValueError("`scratch` and `resume` exclude each other: runs that are kept stand in the file of `resume`")
    input, output = os.fsdecode(input), os.fsdecode(output)
    scratch, resume = (path if path is None else os.fsdecode(path) for path in (scratch, resume))
    return FileSolution(_native.sort_file(input, output, width, (start, end), kind, memory, scratch, resume))


def transpose_file(
    input: Path,
    output: Path,
    *,
    rows: int | None = None,
    columns: int | None = None,
    width: int = 8,
    offset: int = 0,
    memory: int = 256 << 20,
) -> FileSolution:
    """Transpose a matrix in a file, which may be larger than memory.

    A ``.npy`` file says itself what it holds: elements of any fixed width, in C or Fortran order; its transpose is
    a ``.npy`` file in C order. Another file holds the elements row by row, and `rows` and `columns` must be given.
    Before the output takes its name both files are read again from end to end and compared, byte by byte, for the
    certificate.

    Parameters
    ----------
    input, output : path
        The matrix, and where to write its transpose: another file, which appears whole or not at all.
    rows, columns : int, optional
        Shape of a matrix in a raw file.
    width : int, default 8
        Bytes of an element of a raw file.
    offset : int, default 0
        Bytes of a raw file before the first element.
    memory : int, default 256 MiB
        Most bytes of memory to use for elements.

    Returns
    -------
    FileSolution
        ``check(output)`` or ``check(output, input)`` is a second opinion later on.

    Raises
    ------
    ValueError
        When the file holds no matrix, or not the one that was told.
    Violation
        When the check fails; the earlier output is as it was.
    OSError
        When the system refuses; the earlier output is as it was.

    Examples
    --------
    >>> import pathlib, tempfile, numpy as np, taut
    >>> folder = tempfile.TemporaryDirectory()
    >>> path = pathlib.Path(folder.name)
    >>> matrix = np.arange(6.0).reshape(2, 3)
    >>> np.save(path / "matrix.npy", matrix)
    >>> found = taut.transpose_file(path / "matrix.npy", path / "turned.npy")
    >>> np.load(path / "turned.npy")
    array([[0., 3.],
           [1., 4.],
           [2., 5.]])
    >>> found.check(path / "turned.npy").items
    6
    >>> folder.cleanup()
    """
    input, output = os.fsdecode(input), os.fsdecode(output)
    if os.path.exists(output) and os.path.samefile(input, output):
        raise ValueError(f"{output} is the input: name another file for the transpose")
    of_npy = [path.lower().endswith(".npy") for path in (input, output)]
    if of_npy[0] != of_npy[1]:
        raise ValueError("the transpose of a .npy file is one, and that of another file is none: rename the output")
    if not of_npy[0]:
        if rows is None or columns is None:
            raise ValueError(f"{input} is no .npy file: give `rows` and `columns`")
        found = _native.transpose_file(input, output, (rows, columns), width, False, offset, None, b"", memory)
        return FileSolution(found)
    if rows is not None or columns is not None or width != 8 or offset != 0:
        raise ValueError("`rows`, `columns`, `width` and `offset` belong to raw files: leave them out")
    shape, fortran, dtype, offset = _header(input)
    if len(shape) != 2:
        raise ValueError(f"{input} has shape {shape}: a matrix has 2 axes")
    descr = npy.dtype_to_descr(dtype)
    if dtype.hasobject or not isinstance(descr, str):
        raise ValueError(f"{input} has elements of type {dtype}: expected a type of fixed width without fields")
    text = f"{{'descr': '{descr}', 'fortran_order': False, 'shape': {shape[::-1]}, }}"
    # Spaces and a line feed bring the elements to a multiple of 64 bytes.
    text += " " * (-(len(text) + 11) % 64) + "\n"
    header = b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text.encode("latin1")
    found = _native.transpose_file(
        input, output, (shape[0], shape[1]), dtype.itemsize, fortran, offset, descr, header, memory
    )
    return FileSolution(found)


def _header(path: str) -> tuple[tuple[int, ...], bool, np.dtype[Any], int]:
    """Shape, order, type and place of the elements of a ``.npy`` file."""
    with open(path, "rb") as file:
        try:
            version = npy.read_magic(file)
            read = npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0
            shape, fortran, dtype = read(file)
        except ValueError as error:
            raise ValueError(f"{path}: {error}") from None
        return shape, fortran, dtype, file.tell()


def sample(n: int, k: int, *, seed: int = 0) -> NDArray[np.uint64]:
    """Draw k different numbers below n, in ascending order: every set of k is equally likely.

    Which numbers these are depends on n, k and the seed alone, not on the machine. O(k) time, for any n.

    Parameters
    ----------
    n : int
        How many there are to choose from, up to 2**64 - 1.
    k : int
        How many to draw, at most n.
    seed : int, default 0
        From 0 to 2**64 - 1.

    Returns
    -------
    ndarray of uint64, shape (k,)
        Read-only.

    Raises
    ------
    ValueError
        When k exceeds n, or more numbers are asked for than memory holds.

    Examples
    --------
    >>> import taut
    >>> rows = taut.sample(2**40, 5, seed=7)
    >>> len(rows), bool((rows[1:] > rows[:-1]).all())
    (5, True)
    """
    return _native.sample(n, k, seed)


def spatial_order(points: ArrayLike, *, curve: OrderCurve = "hilbert") -> Solution[Order]:
    """Put points of the plane or of space in an order in which neighbors are near each other.

    The order depends on the set of points alone; equal points are side by side, the first row first.

    Parameters
    ----------
    points : array_like of shape (n, 2) or (n, 3)
        Finite coordinates.
    curve : str, default "hilbert"
        ``"hilbert"``, whose steps are short; or ``"morton"``, Z-order, in which cells of a grid of any size are runs.

    Returns
    -------
    Solution
        ``answer.rows`` are the row numbers in order.

    Raises
    ------
    ValueError
        When a coordinate is not finite, or points have another dimension.

    Examples
    --------
    >>> import taut
    >>> square = [[0, 0], [1, 1], [0, 1], [1, 0]]
    >>> found = taut.spatial_order(square)
    >>> found.answer.rows
    array([0, 2, 1, 3])
    >>> found.check(square).points
    4
    """
    rows = as_rows(points)
    return Solution(_native.spatial_order(rows, curve), rows)
