"""Answers about the rows of a Spark DataFrame, with the bytes of those on one machine.

>>> import taut.spark                                                             # doctest: +SKIP
>>> with taut.spark.Points(df, ["x", "y", "z"], id="key") as points:              # doctest: +SKIP
...     found = points.ball()
...     points.verify(found).gap
...     points.ids(found.certificate.support)

Rows are numbered in the order of the id column, else in that of the partitions. They are written to files of the workers once;
each pass is one job over these files, and what comes back of it are a few rows. See docs/spark.md.
"""

from __future__ import annotations

import functools
import itertools
import logging
import uuid
from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Self

from . import _native, _spark_delaunay as delaunay, _spark_tasks as tasks, passes
from ._ball import BallMethod
from ._solution import Solution
from ._spark_delaunay import Triangulation

__all__ = ["Points", "Triangulation", "ball", "centers", "ellipsoid", "ship", "verify"]

# Says which pass is made.
log = logging.getLogger("taut.spark")

# Types of columns that are numbers, and whether float32 holds all of them.
NUMBERS = {"byte": False, "short": False, "integer": False, "long": False, "float": True, "double": False}

# Up to this many partitions the driver merges their answers; of more, the workers merge some first.
MERGED_BY_DRIVER_MAX = 64

# How often partitions whose files were lost are made again within one pass.
REBUILDS_MAX = 5
LOST = "files of the workers were lost again and again: give a folder that they keep as scratch"

# One task takes the shared blocks of this many partitions.
PARTITIONS_PER_EDGES = 8


def ship(spark: Any, wheel: str) -> None:
    """Sends a wheel of taut to the workers, for those that do not have it installed.

    Parameters
    ----------
    spark : SparkSession
        The session.
    wheel : str
        The path of a wheel that fits the interpreters of the workers, as a copy that ends in ``.zip``. NumPy and pyarrow must be
        there already.
    """
    spark.sparkContext.addArchive(f"{wheel}#{tasks.ARCHIVE}")


class Points:
    """Rows of a DataFrame as points, in files of the workers.

    Parameters
    ----------
    df : DataFrame
        A DataFrame of PySpark.
    columns : sequence of str
        The coordinates: columns of numbers, without null, NaN and infinity. float32 if all of them are, else float64.
    id : str, optional
        A column of different values that names the rows. Rows are put in its order, so that answers do not depend on the order and
        the partitions of the DataFrame. Without it rows are taken as they come.
    partitions : int, optional
        Partitions to sort by id into; by default as many as the DataFrame has.
    scratch : str, optional
        A folder of each worker for its files; by default that of Spark, which Spark removes.
    """

    def __init__(
        self, df: Any, columns: Sequence[str], *, id: str | None = None, partitions: int | None = None,
        scratch: str | None = None,
    ) -> None:
        self._columns = list(columns)
        self._id = id
        self._session = df.sparkSession
        self._kept: list[Any] = []
        dtype = _dtype(df, self._columns, id)
        self._id_type = "bigint" if id is None else df.schema[id].dataType.simpleString()
        coordinates = [df[name].alias(f"taut_{at}") for at, name in enumerate(self._columns)]
        if id is None:
            picked = df.select(*coordinates)
        else:
            count = partitions or df.rdd.getNumPartitions()
            picked = df.select(df[id].alias("taut_id"), *coordinates)
            picked = picked.repartitionByRange(count, "taut_id").sortWithinPartitions("taut_id")
        _register_tasks()
        place = (scratch, uuid.uuid4().hex)
        names, write_partition = self._columns, tasks.write_partition

        def write(batches: Iterator[Any]) -> Iterator[Any]:
            return write_partition(batches, names, id, dtype, place)

        schema = "partition int, rows long, path string, digest string, error string"
        # The DataFrame of records is planned once: made again, a partition holds the same rows.
        self._records = picked.mapInArrow(write, schema).rdd.map(tuple).persist()
        records = sorted(self._records.collect())
        problems = [error for *_, error in records if error]
        rows = sum(count for _, count, *_ in records)
        if problems or rows == 0:
            self.close()
            raise ValueError(*problems[:1] or ["the DataFrame has no rows: an enclosing shape needs at least one point"])
        ends = itertools.accumulate((count for _, count, *_ in records), initial=0)
        starts = {partition: start for (partition, *_), start in zip(records, ends)}
        digests = {partition: (count, digest) for partition, count, _, digest, _ in records}
        width = len(self._columns)
        self._layout = tasks.Layout(rows, dtype, width, _native.rows_of_block(width), starts, digests)
        self._parts = self._with_edges()

    @property
    def shape(self) -> tuple[int, int]:
        """Number of rows, and numbers of a row."""
        return self._layout.rows, self._layout.columns

    def _with_edges(self) -> Any:
        """The partitions, and the blocks that lie in several of them: few rows, the only ones that move."""
        pieces = self._records.mapPartitions(functools.partial(tasks.edge_pieces, layout=self._layout))
        count = -(-self._records.getNumPartitions() // PARTITIONS_PER_EDGES)
        return self._records.union(pieces.groupByKey(count).map(tasks.join_edge).persist())

    def _rebuild(self) -> None:
        """Makes the files of all partitions again."""
        log.warning("files of a worker are lost: they are made again")
        self._records.unpersist(blocking=True)
        self._records.persist()
        for record in self._records.collect():
            partition, count, _, digest, _ = record
            if (count, digest) != self._layout.digests[partition]:
                raise RuntimeError(
                    f"partition {partition} has other rows when the DataFrame is read again: persist or store it first"
                )
        self._parts = self._with_edges()

    def _ask(self, kind: str, data: bytes) -> bytes:
        """One pass: the merged answer of all parts."""
        work = functools.partial(tasks.answer, layout=self._layout, question=(kind, data))
        for _ in range(REBUILDS_MAX):
            found = self._parts.mapPartitions(work)
            if found.getNumPartitions() <= MERGED_BY_DRIVER_MAX:
                answers = found.collect()
            else:
                answers = [found.treeReduce(functools.partial(tasks.merge_answers, kind=kind), depth=2)]
            if not any(missing for missing, _ in answers):
                parts = [data for _, data in answers if data is not None]
                return _native.merge_partials(parts) if kind == "query" else _native.merge_verdicts(parts)
            self._rebuild()
        raise RuntimeError(LOST)

    def _solve(self, solver: passes.Solver, count: int = 0) -> Solution[Any]:
        """The solution, after so many passes that were made already."""

        def ask(query: passes.Query) -> passes.Partial:
            nonlocal count
            count += query.is_pass
            what = f"pass {count} over {self.shape[0]} rows" if query.is_pass else "rows by number"
            log.info("%s: begins", what)
            partial = passes.Partial(self._ask("query", query.data))
            log.info("%s: ends", what)
            return partial

        return passes.solve(solver, ask)

    def ball(
        self, *, epsilon: float = 1e-9, method: BallMethod = "core-set", batch: int | None = None,
        delta: float | None = None, max_passes: int = 1_000_000, threads: int | None = None, seed: int = 0,
    ) -> Solution[Any]:
        """Smallest ball enclosing the points: the bytes of `taut.ball` over them on one machine.

        Parameters
        ----------
        epsilon, method, batch, delta, max_passes, threads, seed
            As in `taut.ball`; threads are those of the driver.

        Returns
        -------
        Solution
            Its row numbers have ids: `ids`.
        """
        rows, columns = self.shape
        return self._solve(
            passes.Solver.ball(
                rows, columns, epsilon=epsilon, method=method, batch=batch, delta=delta, max_passes=max_passes,
                threads=threads, seed=seed,
            )
        )

    def ellipsoid(
        self, *, epsilon: float = 1e-9, max_passes: int = 1_000_000, threads: int | None = None, seed: int = 0
    ) -> Solution[Any]:
        """Ellipsoid of least volume enclosing the points: the bytes of `taut.ellipsoid` over them on one machine.

        Parameters
        ----------
        epsilon, max_passes, threads, seed
            As in `taut.ellipsoid`; threads are those of the driver.

        Returns
        -------
        Solution
            Its row numbers have ids: `ids`.

        Raises
        ------
        ValueError
            When the points lie in a flat: such an ellipsoid is found in memory or from a file.
        """
        rows, columns = self.shape
        solver = passes.Solver.ellipsoid(
            rows, columns, epsilon=epsilon, max_passes=max_passes, threads=threads, seed=seed
        )
        return self._solve(solver)

    def centers(self, k: int, *, discrete: bool = False) -> Solution[Any]:
        """k centers: the bytes of ``taut.centers(method="stream")`` over the points on one machine.

        The first of two passes visits one partition after the other, as each takes over the points kept of those before.

        Parameters
        ----------
        k, discrete
            As in `taut.centers`.

        Returns
        -------
        Solution
            Its row numbers have ids: `ids`.
        """
        data = passes.StreamingCenters.new(self.shape[1], k).data
        log.info("pass 1 over %d rows, by partition: begins", self.shape[0])
        for partition in sorted(self._layout.digests):
            data = self._add_to_stream(partition, data)
        log.info("pass 1 over %d rows, by partition: ends", self.shape[0])
        return self._solve(passes.Solver.centers(passes.StreamingCenters(data), discrete=discrete), 1)

    def _add_to_stream(self, partition: int, data: bytes) -> bytes:
        work = functools.partial(tasks.add_to_stream, layout=self._layout, data=data)
        for _ in range(REBUILDS_MAX):
            added = self._records.context.runJob(self._records, work, [partition])
            if added != [None]:
                return bytes(added[0])
            self._rebuild()
        raise RuntimeError(LOST)

    def delaunay(self, *, leaf_points: int = 2**18) -> Triangulation:
        """Delaunay triangulation of points in the plane: the simplices of `taut.delaunay` over them on one machine.

        One shuffle brings each point to its leaf; a task holds one leaf, which takes about 130 bytes for each point.

        Parameters
        ----------
        leaf_points : int, default 2**18
            Most points of a leaf, about. The simplices do not depend on it.

        Returns
        -------
        Triangulation
            Its simplices are a DataFrame, to be used as long as the points are open.
        """
        rows, columns = self.shape
        if columns != 2:
            raise ValueError(f"the points have {columns} coordinates: on a cluster, triangulations are those of the plane")
        if leaf_points < 1 or rows > leaf_points * 2**delaunay.LEVELS_MAX:
            raise ValueError(f"leaf_points is {leaf_points}: expected at least {max(1, rows >> delaunay.LEVELS_MAX)}")
        for _ in range(REBUILDS_MAX):
            made = delaunay.triangulate(self._session, self._records, self._layout, self._id_type, leaf_points)
            if made is not None:
                self._kept += made[1]
                return made[0]
            self._rebuild()
        raise RuntimeError(LOST)

    def verify(self, solution: Solution[Any] | str) -> Any:
        """Check an answer over the points, in one pass: the verdict of `taut.verify` over them on one machine.

        Parameters
        ----------
        solution : Solution or str
            The answer with its certificate, or their JSON.

        Returns
        -------
        Verdict

        Raises
        ------
        Violation
            When the answer or its certificate is wrong for these points.
        """
        if isinstance(solution, str):
            solution = Solution.from_json(solution)
        data = self._ask("verify", solution.to_json().encode())
        return passes.check_parts(solution, [passes.PartialVerdict(data, self.shape[1])])

    def ids(self, rows: Iterable[int]) -> list[Any]:
        """The ids of rows.

        Parameters
        ----------
        rows : iterable of int
            Row numbers of an answer.

        Returns
        -------
        list
            Values of the id column, in the order of `rows`.
        """
        if self._id is None:
            raise ValueError("the points have no ids: name the column of ids when the points are made")
        wanted = [int(row) for row in rows]
        work = functools.partial(tasks.ids_of, layout=self._layout, wanted=wanted)
        for _ in range(REBUILDS_MAX):
            pairs = self._records.mapPartitions(work).collect()
            if None not in pairs:
                names = dict(pairs)
                return [names[row] for row in wanted]
            self._rebuild()
        raise RuntimeError(LOST)

    def close(self) -> None:
        """Removes the files of the workers."""
        for rdd in self._kept:
            rdd.unpersist()
        self._records.mapPartitions(tasks.remove).count()
        self._records.unpersist()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *raised: object) -> None:
        self.close()


def ball(
    df: Any, columns: Sequence[str], *, id: str | None = None, partitions: int | None = None, **options: Any
) -> Solution[Any]:
    """Smallest ball enclosing the rows of a DataFrame.

    Parameters
    ----------
    df, columns, id, partitions
        As in `Points`.
    **options
        As in `Points.ball`.

    Returns
    -------
    Solution
        The bytes of `taut.ball` over the rows on one machine.
    """
    with Points(df, columns, id=id, partitions=partitions) as points:
        return points.ball(**options)


def centers(
    df: Any, columns: Sequence[str], k: int, *, id: str | None = None, partitions: int | None = None, discrete: bool = False
) -> Solution[Any]:
    """k centers of the rows of a DataFrame.

    Parameters
    ----------
    df, columns, id, partitions
        As in `Points`.
    k, discrete
        As in `Points.centers`.

    Returns
    -------
    Solution
        The bytes of ``taut.centers(method="stream")`` over the rows on one machine.
    """
    with Points(df, columns, id=id, partitions=partitions) as points:
        return points.centers(k, discrete=discrete)


def ellipsoid(
    df: Any, columns: Sequence[str], *, id: str | None = None, partitions: int | None = None, **options: Any
) -> Solution[Any]:
    """Ellipsoid of least volume enclosing the rows of a DataFrame.

    Parameters
    ----------
    df, columns, id, partitions
        As in `Points`.
    **options
        As in `Points.ellipsoid`.

    Returns
    -------
    Solution
        The bytes of `taut.ellipsoid` over the rows on one machine.
    """
    with Points(df, columns, id=id, partitions=partitions) as points:
        return points.ellipsoid(**options)


def verify(
    solution: Solution[Any] | str, df: Any, columns: Sequence[str], *, id: str | None = None, partitions: int | None = None
) -> Any:
    """Check an answer over the rows of a DataFrame.

    Parameters
    ----------
    solution : Solution or str
        The answer with its certificate, or their JSON.
    df, columns, id, partitions
        As in `Points`.

    Returns
    -------
    Verdict
        That of `taut.verify` over the rows on one machine.
    """
    with Points(df, columns, id=id, partitions=partitions) as points:
        return points.verify(solution)


def _dtype(df: Any, columns: list[str], id_column: str | None) -> str:
    """Looks at the types of the columns; returns that of a coordinate."""
    types = {field.name: field.dataType.typeName() for field in df.schema.fields}
    if not columns:
        raise ValueError("no columns: a point has at least one coordinate")
    for name in [*columns, *([] if id_column is None else [id_column])]:
        if name not in types:
            raise ValueError(f"the DataFrame has no column {name!r}: it has {', '.join(map(repr, types))}")
    for name in columns:
        if types[name] not in NUMBERS:
            raise ValueError(f"column {name!r} is of type {types[name]}: expected {', '.join(NUMBERS)}")
    return "float32" if all(NUMBERS[types[name]] for name in columns) else "float64"


@functools.cache
def _register_tasks() -> None:
    """Workers get the functions by value, as they may have to find taut in the wheel first."""
    from pyspark import cloudpickle

    cloudpickle.register_pickle_by_value(tasks)
    cloudpickle.register_pickle_by_value(delaunay)
