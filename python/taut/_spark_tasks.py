"""The tasks that `taut.spark` runs in the workers: rows are written to files of the worker once, and mapped into memory by each pass.

*Idea.* A partition becomes a file of its rows as they come. Once all partitions are counted, the number of each row is known,
and the whole blocks within a partition are read where they lie. Blocks that two partitions share are few: their rows are
fetched and dealt out again (`edges`).
*Trap.* A worker may be asked for a file that it does not have: its executor was lost and Spark remembers the record of another
one, or the worker with the file was busy for too long. It says so, and the driver asks again.
*Trap.* A shuffle hides which tasks missed a file. So they send None in place of each piece, under the key of that piece: whoever
needs it fails, and no one works on part of the rows.
*Trap.* Spark makes a lost partition again without a word, and a DataFrame with `rand()` or a limit then has other rows. Each record
has a hash of its rows, which is compared with the first one before they are used.
*Trap.* A DataFrame over files may be used once the points are closed, and a task may outlive its job. So closing leaves a mark in the
folder of each executor that Spark removes, and a task that finds the mark writes nothing.
*Trap.* This module travels to the workers by value, so that they need not have taut installed: it imports taut within functions.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import socket
import sys
import tempfile
from collections.abc import Iterator
from typing import Any, NamedTuple

# The name under which a wheel travels to the workers.
ARCHIVE = "taut_wheel"

# The driver merges the answers of up to this many partitions. Where there are more, workers merge some of them first.
MERGED_BY_DRIVER_MAX = 64

# What is said to those who use points that are closed.
CLOSED = "the points are closed"

# Integers beyond this are not all numbers of float64.
EXACT_INTEGER_MAX = 2**53


# A partition in a file: its number, its rows, the path, a hash of the rows, and what is wrong with them instead. A plain tuple, as Spark
# hands it to workers that do not have this module.
Record = tuple[int, int, str, str, str]
FIELDS = ("partition", "rows", "path", "digest", "error")


class Layout(NamedTuple):
    """Where the rows of each partition stand among all, what a row is, and what the partitions were at first."""

    rows: int
    dtype: str
    columns: int
    step: int
    starts: dict[int, int]
    # The number of rows and their hash.
    digests: dict[int, tuple[int, str]]
    # Rows have ids.
    is_named: bool

    def whole_blocks(self, partition: int, count: int) -> tuple[int, int]:
        """From which row of all to which a partition has whole blocks; equal numbers where it has none."""
        start = self.starts[partition]
        end = start + count
        first = -(-start // self.step) * self.step
        last = end if end == self.rows else end // self.step * self.step
        return (first, last) if first < last else (end, end)


def is_here(record: Record, layout: Layout) -> bool:
    """Tests whether a partition has the rows that it had at first, in a file of this worker."""
    partition, count, path, digest, _ = record
    paths = [path, path + ".ids"] if layout.is_named and count else [path]
    return layout.digests[partition] == (count, digest) and all(map(os.path.exists, paths))


def mapped(record: Record, layout: Layout) -> Any:
    """The rows of a partition, mapped into memory."""
    import numpy as np

    _, count, path, _, _ = record
    shape = (count, layout.columns)
    return np.memmap(path, layout.dtype, "r", 0, shape) if count else np.empty(shape, layout.dtype)


def ids(record: Record) -> Any:
    """The ids of a partition as an Arrow array; None where rows have none."""
    import pyarrow

    path = record[2] + ".ids"
    if not os.path.exists(path):
        return None
    with pyarrow.memory_map(path) as file:
        return pyarrow.ipc.open_file(file).read_all().column("id").combine_chunks()


def import_taut() -> Any:
    """Imports the package: from the wheel that was sent along, if there is one, else from the environment."""
    if "taut" not in sys.modules:
        from pyspark import SparkFiles

        sent = os.path.join(SparkFiles.getRootDirectory(), ARCHIVE)
        if os.path.isdir(sent):
            sys.path.insert(0, sent)
    import taut.passes

    return taut


def local_folder() -> str:
    """The folder that this executor has for itself, which Spark removes at its end."""
    return os.environ.get("SPARK_LOCAL_DIRS", "").split(",")[0] or tempfile.gettempdir()


def folder(scratch: str | None, token: str) -> str:
    """The folder of the worker for the files of one point set."""
    return os.path.join(scratch or local_folder(), f"taut-{token}")


def closed_mark(token: str) -> str:
    """The file that is there once a point set is closed."""
    return os.path.join(local_folder(), f"taut-{token}.closed")


def make_folder(place: tuple[str | None, str]) -> None:
    """Makes the folder of a point set, unless that is closed."""
    # Other users of the machine do not read the files.
    os.makedirs(folder(*place), mode=0o700, exist_ok=True)
    # Only now, as whoever leaves the mark after this removes the folder too.
    if os.path.exists(closed_mark(place[1])):
        shutil.rmtree(folder(*place), ignore_errors=True)
        raise ValueError(CLOSED)


class Refused(Exception):
    """Something is wrong with the rows; the message is for people."""


def write_partition(
    batches: Iterator[Any], columns: list[str], id_column: str | None, dtype: str, place: tuple[str | None, str]
) -> Iterator[Any]:
    """Writes a partition as it comes to a file of numbers and one of ids, and says what was written."""
    import pyarrow
    from pyspark import TaskContext

    context = TaskContext.get()
    partition = context.partitionId()
    path = os.path.join(folder(*place), f"{partition}-{context.taskAttemptId()}.rows")
    try:
        make_folder(place)
        rows, digest = _write(batches, columns, id_column, dtype, path, partition)
        record = (partition, rows, path, digest, "")
    except Refused as refused:
        _remove_files(path)
        record = (partition, 0, "", "", str(refused))
    except OSError as error:
        _remove_files(path)
        raise OSError(f"files cannot be written to {folder(*place)} on {socket.gethostname()}: {error}") from error
    except BaseException:
        _remove_files(path)
        raise
    types = [pyarrow.int32(), pyarrow.int64(), *[pyarrow.string()] * 3]
    arrays = [pyarrow.array([value], kind) for value, kind in zip(record, types)]
    yield pyarrow.RecordBatch.from_arrays(arrays, names=list(FIELDS))


def _write(
    batches: Iterator[Any], columns: list[str], id_column: str | None, dtype: str, path: str, partition: int
) -> tuple[int, str]:
    import numpy as np
    import pyarrow

    digest, names = hashlib.blake2b(digest_size=16), (hashlib.blake2b(), hashlib.blake2b())
    rows, last_id, writer = 0, None, None
    with open(path, "wb") as file:
        for batch in batches:
            if id_column is not None:
                ids = _large(batch.column(0))
                _check_ids(ids, id_column, last_id, partition, rows)
                if len(ids):
                    last_id = ids[len(ids) - 1].as_py()
                table = pyarrow.RecordBatch.from_arrays([ids], names=["id"])
                writer = writer or pyarrow.ipc.new_file(path + ".ids", table.schema)
                writer.write_batch(table)
                for hash_of_part, part in zip(names, _id_bytes(ids)):
                    hash_of_part.update(part)
            block = np.empty((batch.num_rows, len(columns)), dtype)
            first = batch.num_columns - len(columns)
            for at, name in enumerate(columns):
                block[:, at] = _numbers(batch, first + at, name, id_column, partition, rows)
            file.write(block.data)
            digest.update(block.data)
            rows += batch.num_rows
    if writer is not None:
        writer.close()
        for hash_of_part in names:
            digest.update(hash_of_part.digest())
    return rows, digest.hexdigest()


def _large(ids: Any) -> Any:
    """Ids whose characters, of a partition together, may be more than 2 GiB."""
    import pyarrow

    for small, large in ((pyarrow.string(), pyarrow.large_string()), (pyarrow.binary(), pyarrow.large_binary())):
        if ids.type == small:
            return ids.cast(large)
    return ids


def _id_bytes(ids: Any) -> tuple[Any, Any]:
    """The lengths of ids, if they are of several, and their bytes: those of several batches after each other are those of one."""
    import numpy as np

    _, *buffers = ids.buffers()
    if len(buffers) == 1:
        width = ids.type.bit_width // 8
        return b"", memoryview(buffers[0])[ids.offset * width : (ids.offset + len(ids)) * width]
    places = np.frombuffer(buffers[0], np.int64)[ids.offset : ids.offset + len(ids) + 1]
    # Without characters there may be no buffer of them.
    data = memoryview(buffers[1] or b"")[places[0] : places[-1]] if len(places) else b""
    return np.diff(places).data, data


def _check_ids(ids: Any, name: str, last: Any, partition: int, rows: int) -> None:
    """Refuses ids that are null or occur twice: they come in order, and equal ones in one partition."""
    import pyarrow
    import pyarrow.compute as pc

    if ids.null_count:
        at = pc.index(pc.is_null(ids), True).as_py()
        raise Refused(f"column {name!r}, the id, is null in row {rows + at} of partition {partition}: ids name rows")
    try:
        ids.validate(full=True)
    except pyarrow.ArrowInvalid:
        at = next(at for at, value in enumerate(ids) if not _is_text(value))
        raise Refused(f"column {name!r}, the id, is not UTF-8 in row {rows + at} of partition {partition}") from None
    if len(ids) and last is not None and ids[0].as_py() == last:
        raise Refused(f"column {name!r}, the id, has {last!r} twice (partition {partition}): ids name rows")
    if len(ids) > 1:
        same = pc.equal(ids.slice(1), ids.slice(0, len(ids) - 1))
        at = pc.index(same, True).as_py()
        if at >= 0:
            raise Refused(
                f"column {name!r}, the id, has {ids[at].as_py()!r} twice (partition {partition}): ids name rows"
            )


def _is_text(value: Any) -> bool:
    try:
        value.as_py()
    except UnicodeDecodeError:
        return False
    return True


def _numbers(batch: Any, column_at: int, name: str, id_column: str | None, partition: int, rows: int) -> Any:
    """A column as numbers, without one that is null, NaN, infinite or an integer that float64 does not hold."""
    import numpy as np

    column = batch.column(column_at)

    def place(at: int) -> str:
        row = f"row {rows + at}" if id_column is None else f"id {batch.column(0)[at].as_py()!r}"
        return f"column {name!r} of {row} in partition {partition}"

    if column.null_count:
        at = int(np.flatnonzero(column.is_null().to_numpy(zero_copy_only=False))[0])
        raise Refused(f"{place(at)} is null: all coordinates must be finite numbers")
    values = column.to_numpy(zero_copy_only=False)
    if values.dtype.kind in "iu":
        wrong = (values > EXACT_INTEGER_MAX) | (values < -EXACT_INTEGER_MAX)
        problem = "which float64 may not hold exactly: scale or shift it"
    else:
        wrong = ~np.isfinite(values)
        problem = "and all coordinates must be finite numbers"
    if wrong.any():
        at = int(np.argmax(wrong))
        raise Refused(f"{place(at)} is {values[at]}, {problem}")
    return values


def blocks(element: Any, layout: Layout) -> tuple[int, Any] | None:
    """The first row and the rows of an element: of a partition, or of an edge as it is. None where the file is not here."""
    import numpy as np

    if element is None or len(element) == 2:
        return element  # type: ignore[no-any-return]
    partition, count, path, _, _ = element
    if not is_here(element, layout):
        return None
    first, end = layout.whole_blocks(partition, count)
    if first == end:
        return first, np.empty((0, layout.columns), layout.dtype)
    offset = (first - layout.starts[partition]) * layout.columns * np.dtype(layout.dtype).itemsize
    return first, np.memmap(path, layout.dtype, "r", offset, (end - first, layout.columns))


def edge_pieces(elements: Iterator[Record], layout: Layout) -> Iterator[tuple[int, Any]]:
    """Yields the rows of partitions that are not among their whole blocks, each with its block; None for rows that are not here."""
    import numpy as np

    for record in elements:
        partition = record[0]
        start, count = layout.starts[partition], layout.digests[partition][0]
        end = start + count
        first, last = layout.whole_blocks(partition, count)
        if count == 0 or (first, last) == (start, end):
            continue
        every = mapped(record, layout) if is_here(record, layout) else None
        for low, high in ((start, min(first, end)), (last, end)):
            while low < high:
                cut = min(high, (low // layout.step + 1) * layout.step)
                piece = None if every is None else (low, np.array(every[low - start : cut - start]))
                yield low // layout.step, piece
                low = cut


def join_edge(edge: tuple[int, Any]) -> tuple[int, Any] | None:
    """Joins the pieces of a block; None where one was not there."""
    import numpy as np

    pieces = list(edge[1])
    if any(piece is None for piece in pieces):
        return None
    ordered = sorted(pieces, key=lambda piece: piece[0])
    return ordered[0][0], np.concatenate([rows for _, rows in ordered])


def answer(elements: Iterator[Any], layout: Layout, question: tuple[str, bytes]) -> Iterator[tuple[bool, bytes | None]]:
    """The answers of the blocks of a partition, merged; and whether a file is missing."""
    taut = import_taut()
    kind, data = question
    found = []
    for element in elements:
        part = blocks(element, layout)
        if part is None:
            yield True, None
            return
        first, rows = part
        if len(rows) == 0:
            continue
        if kind == "query":
            found.append(taut.passes.Query(data).run(rows, first))
        else:
            solution = taut.Solution.from_json(data.decode())
            found.append(taut.passes.check_part(solution, rows, first, layout.rows))
    if not found:
        yield False, None
    elif kind == "query":
        yield False, taut.passes.merge(found).data
    else:
        yield False, taut.passes.merge_verdicts(found).data


def add_to_stream(elements: Iterator[Record], layout: Layout, data: bytes) -> Iterator[bytes | None]:
    """The cover of a stream with the rows of a partition added; None where the file is not here."""
    taut = import_taut()
    cover = taut.passes.StreamingCenters(data)
    for record in elements:
        if not is_here(record, layout):
            yield None
            return
        cover = cover.add(mapped(record, layout))
    yield cover.data


def merge_answers(
    a: tuple[bool, bytes | None], b: tuple[bool, bytes | None], kind: str
) -> tuple[bool, bytes | None]:
    """Two answers of `answer` as one."""
    data = [found for found in (a[1], b[1]) if found is not None]
    if a[0] or b[0] or len(data) < 2:
        return a[0] or b[0], data[0] if data else None
    taut = import_taut()
    if kind == "query":
        return False, taut.passes.merge(map(taut.passes.Partial, data)).data
    partials = [taut.passes.PartialVerdict(found, 0) for found in data]
    return False, taut.passes.merge_verdicts(partials).data


def ids_of(elements: Iterator[Any], layout: Layout, wanted: list[int]) -> Iterator[Any]:
    """The ids of rows by number, as pairs; None where a file is not here."""
    for record in elements:
        partition, count, *_ = record
        start = layout.starts[partition]
        mine = [row for row in wanted if start <= row < start + count]
        if not mine:
            continue
        if not is_here(record, layout):
            yield None
            continue
        names = ids(record)
        yield from [(row, names[row - start].as_py()) for row in mine]


def outliers(
    elements: Iterator[Record], layout: Layout, shape: tuple[Any, Any, Any], border: float
) -> Iterator[tuple[Any, float]]:
    """The ids of rows outside of an ellipsoid, or their numbers, and their distances, of which that of its border is given."""
    import numpy as np

    taut = import_taut()
    for record in elements:
        if not is_here(record, layout):
            raise RuntimeError("a task did not find its file: call points.robust_ellipsoid() again")
        if not record[1]:
            continue
        names, start = ids(record), layout.starts[record[0]]
        rows = mapped(record, layout)
        for low in range(0, len(rows), layout.step):
            norms = taut._native.norms(rows[low : low + layout.step], *shape)
            for at in np.flatnonzero(~(norms <= 1)).tolist():
                name = start + low + at if names is None else names[low + at].as_py()
                yield name, border * float(norms[at])


def sweep(elements: Iterator[int], place: tuple[str | None, str], kept: frozenset[str] | None) -> Iterator[str]:
    """Removes the files of this executor other than those to be kept; where that is None, for good. Yields which executor it is.

    Several tasks may do so at once.
    """
    path = folder(*place)
    if kept is None:
        # The disk may be full.
        with contextlib.suppress(OSError), open(closed_mark(place[1]), "w"):
            pass
        shutil.rmtree(path, ignore_errors=True)
    elif os.path.isdir(path):
        for name in os.listdir(path):
            if name.removesuffix(".ids") not in kept:
                with contextlib.suppress(FileNotFoundError):
                    os.remove(os.path.join(path, name))
    yield local_folder()


def _remove_files(path: str) -> None:
    """Removes the file of a partition and that of its ids, as far as they are there."""
    for name in (path, path + ".ids"):
        if os.path.exists(name):
            os.remove(name)
