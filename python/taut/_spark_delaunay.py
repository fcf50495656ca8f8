"""Triangulations of the plane over the rows of a Spark DataFrame: leaves of a kd-tree, and what they leave unfinished.

*Idea.* A sample is cut into leaves, and one shuffle brings each point to its leaf. A leaf is triangulated by one task; simplices whose
circles meet no box with points of other leaves are final. The sites of the others go up, several levels at once, and are
triangulated again, up to the root. The simplices are those in memory, whatever the sample.
*Trap.* Row numbers have ids only where their partition is. So the ids of sites travel with them.

Like `_spark_tasks` this module travels to the workers by value.
"""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterator
from typing import Any, NamedTuple

from . import _spark_tasks as tasks

# Points of the sample, about.
SAMPLE_POINTS = 2**17

# Levels of the tree that fronts go up at once: they are small.
LEVELS_AT_ONCE = 4

# Most levels of leaves.
LEVELS_MAX = 14

# A node: its number, its tile, the ids of the sites of the tile, its front, the rows of that and their ids, and the counts of the tile.
# Ids are None where rows have none.
Node = tuple[int, bytes, Any, bytes, Any, Any, tuple[int, int, int, str]]


class Triangulation(NamedTuple):
    """A triangulation whose simplices are rows of a DataFrame, there as long as the points are open.

    It is computed when it is used, and fails if a task does not find its file then: call `Points.delaunay` again.
    """

    simplices: Any
    """A DataFrame with the columns a, b and c: the ids of the vertices, or row numbers where points have no ids. Counter-clockwise.
    Of points on a line a simplex is a segment, whose c is null; of one point it is that point, and b is null as well."""
    total: int
    """The number of simplices."""
    hull: int
    """Facets of the convex hull."""
    duplicates: int
    """Points that equal one with a smaller row number; they are in no simplex."""
    fingerprint: str
    """The hash of the simplices, as that of a triangulation in memory."""
    passed_up: int
    """Sites that leaves did not finish."""

    voronoi: Any = None
    """The edges of the Voronoi diagram as a DataFrame, if they were asked for. Its columns a and b are the two sites whose cells an edge
    parts, the lower row first; x0, y0 and x1, y1 its ends, the first to the left on the way from a to b. Of an edge without end there
    are x0, y0 and dx, dy, which points where it goes, and the others are null. Edges between simplices with one circle have no length,
    to rounding. Points on one line have no edges."""


class Cut(NamedTuple):
    """The sample that a kd-tree cuts into 2**levels leaves."""

    sample: Any
    levels: int


def sample(elements: Iterator[tasks.Record], layout: tasks.Layout) -> Iterator[Any]:
    """Rows at even distances; None where a file is not here."""
    import numpy as np

    stride = -(-layout.rows // SAMPLE_POINTS)
    for record in elements:
        if not tasks.is_here(record, layout):
            yield None
            return
        rows = tasks.mapped(record, layout)
        yield np.array(rows[-layout.starts[record[0]] % stride :: stride], np.float64)


def extent(elements: Iterator[tasks.Record], layout: tasks.Layout, cut: Cut) -> Iterator[bytes | None]:
    """Yields the extents of partitions, which all nodes must know; None where a file is not here."""
    taut = tasks.import_taut()
    for record in elements:
        if not tasks.is_here(record, layout):
            yield None
            return
        yield taut._native.deal_points(tasks.mapped(record, layout), *cut)[1]


def merge_extents(a: bytes | None, b: bytes | None) -> bytes | None:
    """Two of these as one."""
    return None if a is None or b is None else tasks.import_taut()._native.merge_extents([a, b])


def deal(elements: Iterator[tasks.Record], layout: tasks.Layout, cut: Cut) -> Iterator[tuple[int, Any]]:
    """Yields the rows of partitions by leaf: points, row numbers and ids. A file that is not here may have had rows of any leaf: None
    for each."""
    import numpy as np
    import pyarrow

    taut = tasks.import_taut()
    for record in elements:
        if not tasks.is_here(record, layout):
            yield from ((leaf, None) for leaf in range(1 << cut.levels))
            return
        rows = tasks.mapped(record, layout)
        ids = tasks.ids(record)
        leaves, _ = taut._native.deal_points(rows, *cut)
        order = np.argsort(leaves, kind="stable")
        bounds = np.flatnonzero(np.diff(leaves[order], prepend=-1, append=-1))
        for low, high in zip(bounds, bounds[1:]):
            here = order[low:high]
            numbers = (here + layout.starts[record[0]]).astype(np.uint64)
            named = None if ids is None else ids.take(pyarrow.array(here))
            yield int(leaves[here[0]]), (np.array(rows[here], np.float64), numbers, named)


def named(rows: Any, numbers: Any, ids: Any) -> Any:
    """The ids of rows among row numbers with these ids."""
    import numpy as np
    import pyarrow

    if ids is None:
        return None
    order = np.argsort(numbers)
    return ids.take(pyarrow.array(order[np.searchsorted(numbers, rows, sorter=order)]))


def joined(parts: list[Any]) -> Any:
    """The ids of several parts."""
    import pyarrow

    return None if parts[0] is None else pyarrow.concat_arrays(parts)


def node(number: int, found: tuple[bytes, bytes, Any, Any], numbers: Any, ids: Any) -> Node:
    """Returns the node with the ids of its sites."""
    tile, front, front_rows, counts = found
    rows = tasks.import_taut()._tiles.Tile.from_bytes(tile, 2).rows
    return number, tile, named(rows, numbers, ids), front, front_rows, named(front_rows, numbers, ids), counts


def triangulate_leaf(group: tuple[int, Any], whole: bytes, levels: int) -> Node | None:
    """A leaf; None where some of its points were not sent."""
    import numpy as np

    taut = tasks.import_taut()
    leaf, pieces = group[0], list(group[1])
    if any(piece is None for piece in pieces):
        return None
    points, numbers, ids = zip(*pieces)
    number, rows = (1 << levels) - 1 + leaf, np.concatenate(numbers)
    found = taut._native.triangulate_leaf(whole, number, np.concatenate(points), rows)
    return node(number, found, rows, joined(list(ids)))


def there(found: Node | None) -> Node:
    """Refuses a node that was there when the points were triangulated, and is not now that it is made again."""
    if found is None:
        raise RuntimeError("a task did not find its file: call points.delaunay() again")
    return found


def climb(below: Node | None, levels: int) -> tuple[int, Any]:
    """Sends the front of a node to the node so many levels above."""
    number, _, _, front, rows, ids, _ = there(below)
    for _ in range(levels):
        number = (number - 1) // 2
    return number, (front, rows, ids)


def triangulate_fronts(group: tuple[int, Any], whole: bytes) -> Node:
    """A node above others."""
    import numpy as np

    number, pieces = group
    fronts, rows, ids = zip(*pieces)
    found = tasks.import_taut()._native.triangulate_fronts(whole, number, list(fronts))
    return node(number, found, np.concatenate(rows), joined(list(ids)))


def counts(found: Node | None) -> tuple[int, int, int, str, int] | None:
    """The counts of a tile, and the sites that go up."""
    return None if found is None else (*found[6], len(found[4]))


def as_row(found: Node | None) -> tuple[bytearray, bytearray | None]:
    """A tile and the ids of its sites as bytes."""
    import pyarrow

    _, tile, ids, *_ = there(found)
    if ids is None:
        return bytearray(tile), None
    batch = pyarrow.RecordBatch.from_arrays([ids], names=["id"])
    sink = pyarrow.BufferOutputStream()
    with pyarrow.ipc.new_stream(sink, batch.schema) as writer:
        writer.write_batch(batch)
    return bytearray(tile), bytearray(sink.getvalue())


def tiles_of(batches: Iterator[Any]) -> Iterator[tuple[Any, Any]]:
    """The tiles of rows that `as_row` made, and the ids of their sites, or row numbers."""
    import pyarrow

    taut = tasks.import_taut()
    for batch in batches:
        for tile, ids in zip(*(column.to_pylist() for column in batch.columns)):
            found = taut._tiles.Tile.from_bytes(tile, 2)
            if ids is None:
                names = pyarrow.array(found.rows.astype("int64"))
            else:
                names = pyarrow.ipc.open_stream(ids).read_all().column("id").combine_chunks()
            yield found, names


def simplices(batches: Iterator[Any]) -> Iterator[Any]:
    """The vertices of the simplices of tiles, by id or row number."""
    import pyarrow

    for found, names in tiles_of(batches):
        corners = [names.take(pyarrow.array(column)) for column in found.vertices.T]
        corners += [pyarrow.nulls(len(found), names.type)] * (3 - len(corners))
        yield pyarrow.RecordBatch.from_arrays(corners, names=["a", "b", "c"])


def triangulate(
    session: Any, records: Any, layout: tasks.Layout, id_type: str, leaf_points: int
) -> tuple[Triangulation, Any, list[Any]] | None:
    """The triangulation, a DataFrame of its tiles and what is kept for it; None where files are missing.

    Parameters
    ----------
    session : SparkSession
        The session.
    records : RDD
        The records of the partitions.
    layout : Layout
        Where their rows stand.
    id_type : str
        The type of ids in the words of Spark.
    leaf_points : int
        Most points of a leaf, about.
    """
    import numpy as np
    from pyspark import StorageLevel

    levels = max(0, (-(-layout.rows // leaf_points) - 1).bit_length())
    drawn = records.mapPartitions(functools.partial(sample, layout=layout)).collect()
    if any(part is None for part in drawn):
        return None
    cut = Cut(np.concatenate(drawn), levels)
    extents = records.mapPartitions(functools.partial(extent, layout=layout, cut=cut))
    # Where there are many, workers merge some first, which shuffles them.
    few = extents.getNumPartitions() <= tasks.MERGED_BY_DRIVER_MAX
    whole = functools.reduce(merge_extents, extents.collect()) if few else extents.treeReduce(merge_extents)
    if whole is None:
        return None
    pieces = records.mapPartitions(functools.partial(deal, layout=layout, cut=cut)).groupByKey(1 << levels)
    level = pieces.map(functools.partial(triangulate_leaf, whole=whole, levels=levels))
    kept: list[Any] = []
    found: list[Any] = []
    passed_up = 0
    with contextlib.ExitStack() as undo:
        while True:
            kept.append(level.persist(StorageLevel.MEMORY_AND_DISK))
            undo.callback(level.unpersist)
            of_level = level.map(counts).collect()
            if None in of_level:
                return None
            found += of_level
            if len(kept) == 1:
                passed_up = sum(up for *_, up in of_level)
            if levels == 0:
                break
            step = min(levels, LEVELS_AT_ONCE)
            levels -= step
            fronts = level.map(functools.partial(climb, levels=step)).groupByKey(1 << levels)
            level = fronts.map(functools.partial(triangulate_fronts, whole=whole))
        undo.pop_all()
    tiles = session.createDataFrame(records.context.union(kept).map(as_row), "tile binary, ids binary")
    frame = tiles.mapInArrow(simplices, f"a {id_type}, b {id_type}, c {id_type}")
    total, hull, duplicates = (sum(numbers) for numbers in list(zip(*found))[:3])
    fingerprint = sum(int(digits, 16) for *_, digits, _ in found) % 2**128
    return Triangulation(frame, total, hull, duplicates, f"{fingerprint:032x}", passed_up), tiles, kept
