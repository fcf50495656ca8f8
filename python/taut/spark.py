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

import contextlib
import functools
import itertools
import logging
import operator
import os
import time
import uuid
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, Literal, NamedTuple, Self, TypeVar

import numpy as np

from . import _native, _spark_delaunay as delaunay, _spark_tasks as tasks, _spark_voronoi as diagram, passes
from ._ball import BallMethod
from ._solution import Solution
from ._spark_delaunay import Triangulation
from ._verify import as_solution
from .passes import RobustFit

__all__ = [
    "Points", "RobustRows", "Triangulation", "ball", "centers", "ellipsoid", "robust_ellipsoid", "ship", "verify",
]

T = TypeVar("T")

# Says which pass is made.
log = logging.getLogger("taut.spark")

# Types of columns that are numbers, and whether float32 holds all of them.
NUMBERS = {"byte": False, "short": False, "integer": False, "long": False, "float": True, "double": False}

# A pass is tried this many times where files are missing. The second time it finds them if tasks only ran away from their files
# (spark.locality.wait); from the third time on they are made again.
ATTEMPTS_MAX = 6
LOST = "files of the workers were lost again and again: give a folder that they keep as scratch"

# Files are removed by so many tasks for each executor, so that each executor gets some, and by so many jobs at so many seconds from each
# other: one whose cores are all taken, as by tasks that are being killed, is reached by none at first.
SWEEPERS_PER_EXECUTOR = 2
SWEEPS_MAX = 20
SWEEP_PAUSE = 0.25

# Types of ids: those whose values are equal in Arrow when they are equal in Spark, which NaN is not.
IDS = ("byte", "short", "integer", "long", "string", "date", "timestamp", "timestamp_ntz", "decimal", "binary")

# The collation of strings under which only equal bytes are equal.
BINARY = "UTF8_BINARY"

# One task takes the shared blocks of this many partitions.
PARTITIONS_PER_EDGES = 8


class RobustRows(NamedTuple):
    """A robust ellipsoid of the rows of a DataFrame."""

    fit: RobustFit
    """The ellipsoid, center and scatter, and how they were found."""
    outliers: Any
    """A DataFrame with the columns id, the ids of the rows outside of the ellipsoid or their numbers where they have none, and
    distance, the Mahalanobis distance; there as long as the points are open. It is computed when it is used, and fails if a task does not
    find its file then: call `Points.robust_ellipsoid` again."""


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
        A column of different values that names the rows: whole numbers, strings, dates, times, decimals or bytes. Rows are put in
        its order, so that answers do not depend on the order and the partitions of the DataFrame. Without it rows are taken as they
        come.
    partitions : int, optional
        Partitions to sort by id into, only with `id`; by default as many as the DataFrame has. To count those, Spark may make the
        shuffles of the DataFrame.
    scratch : str, optional
        A folder of each worker for its files, as an absolute path; by default that of Spark, which Spark removes. The files of a node
        that is lost stay there.
    """

    def __init__(
        self, df: Any, columns: Sequence[str], *, id: str | None = None, partitions: int | None = None,
        scratch: str | None = None,
    ) -> None:
        if isinstance(columns, str):
            raise TypeError(f"columns is {columns!r}: expected a sequence of names")
        if partitions is not None and id is None:
            raise ValueError("partitions are given without id: rows as they come stay in the partitions of the DataFrame")
        if partitions is not None and partitions < 1:
            raise ValueError(f"partitions is {partitions}: expected at least 1")
        if scratch is not None and not os.path.isabs(scratch):
            raise ValueError(f"scratch is {scratch!r}: expected an absolute path, as each worker has its own working folder")
        self._columns = list(columns)
        self._id = id
        self._session = df.sparkSession
        self._kept: list[Any] = []
        self._edges: Any = None
        self._is_closed = False
        dtype = _dtype(df, self._columns, id)
        self._id_kind: Any = None if id is None else df.schema[id].dataType
        self._id_type = "bigint" if self._id_kind is None else self._id_kind.simpleString()
        coordinates = [df[_quoted(name)].alias(f"taut_{at}") for at, name in enumerate(self._columns)]
        if id is None:
            picked = df.select(*coordinates)
        else:
            count = partitions or df.rdd.getNumPartitions()
            picked = df.select(df[_quoted(id)].alias("taut_id"), *coordinates)
            picked = picked.repartitionByRange(count, "taut_id").sortWithinPartitions("taut_id")
        _register_tasks()
        place = self._place = (scratch, uuid.uuid4().hex)
        self._tag = f"taut-{place[1]}"
        names, write_partition = self._columns, tasks.write_partition

        def write(batches: Iterator[Any]) -> Iterator[Any]:
            return write_partition(batches, names, id, dtype, place)

        schema = "partition int, rows long, path string, digest string, error string"
        self._records: Any = None
        try:
            with self._tagged():
                # The DataFrame of records is planned once: made again, a partition holds the same rows.
                self._records = picked.mapInArrow(write, schema).rdd.map(tuple).persist(_level())
                self._layout = self._layout_of(dtype)
                self._parts = self._with_edges()
        except BaseException:
            self.close()
            raise

    @contextlib.contextmanager
    def _tagged(self) -> Iterator[None]:
        """Jobs that closing cancels: after Ctrl-C, Spark goes on with them where the driver waited for their end."""
        context = self._session.sparkContext
        context.addJobTag(self._tag)
        try:
            yield
        finally:
            # An error that ended the jobs may have ended the session, too.
            with contextlib.suppress(Exception):
                context.removeJobTag(self._tag)

    def _layout_of(self, dtype: str) -> tasks.Layout:
        """Writes the files."""
        records = sorted(self._records.collect())
        problems = [error for *_, error in records if error]
        rows = sum(count for _, count, *_ in records)
        if problems or rows == 0:
            raise ValueError(*problems[:1] or ["the DataFrame has no rows: an enclosing shape needs at least one point"])
        ends = itertools.accumulate((count for _, count, *_ in records), initial=0)
        starts = {partition: start for (partition, *_), start in zip(records, ends)}
        digests = {partition: (count, digest) for partition, count, _, digest, _ in records}
        width = len(self._columns)
        step = _native.rows_of_block(width)
        return tasks.Layout(rows, dtype, width, step, starts, digests, self._id is not None)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of rows, and numbers of a row."""
        return self._layout.rows, self._layout.columns

    def _with_edges(self) -> Any:
        """The partitions, and the blocks that lie in several of them: few rows, the only ones that move."""
        pieces = self._records.mapPartitions(functools.partial(tasks.edge_pieces, layout=self._layout))
        count = -(-self._records.getNumPartitions() // PARTITIONS_PER_EDGES)
        if self._edges is not None:
            self._edges.unpersist()
        self._edges = pieces.groupByKey(count).map(tasks.join_edge).persist(_level())
        return self._records.union(self._edges)

    def _tried(self, attempt: Callable[[], T | None]) -> T:
        """Returns the result of an attempt, which is None where files are missing: then of the next one."""
        for number in range(ATTEMPTS_MAX):
            if self._is_closed:
                raise ValueError(tasks.CLOSED)
            with self._tagged():
                if number == 1:
                    log.warning("a task did not find its file: the pass is made again")
                    self._parts = self._with_edges()
                elif number > 1:
                    self._rebuild()
                found = attempt()
            if found is not None:
                return found
        raise RuntimeError(LOST)

    def _rebuild(self) -> None:
        """Makes the files of all partitions again."""
        log.warning("files of a worker are lost: they are made again")
        self._records.unpersist(blocking=True)
        self._records.persist(_level())
        records = self._records.collect()
        for partition, count, _, digest, _ in records:
            if (count, digest) != self._layout.digests[partition]:
                raise RuntimeError(
                    f"partition {partition} has other rows when the DataFrame is read again: persist or store it first"
                )
        # Those that were still there would else stay until the end.
        self._sweep(frozenset(os.path.basename(path) for _, _, path, *_ in records))
        self._parts = self._with_edges()

    def _sweep(self, kept: frozenset[str] | None) -> None:
        """Removes the files of the workers other than those to be kept, all of them for good where that is None.

        It is a job that has nothing to do with the rows, which would be read again where their records are missing. It raises no error of
        its own, which would hide the one that ended the work.
        """
        work = functools.partial(tasks.sweep, place=self._place, kept=kept)
        reached: set[str] = set()
        try:
            context = self._session.sparkContext
            if context._jsc is None:
                raise RuntimeError("the session has ended")
            if kept is None:
                context.cancelJobsWithTag(self._tag)
            for number in range(SWEEPS_MAX):
                time.sleep(SWEEP_PAUSE if number else 0)
                # The driver is listed as well, and in local mode is the only one.
                executors = max(1, context._jsc.sc().getExecutorMemoryStatus().size() - 1)
                count = executors * SWEEPERS_PER_EXECUTOR
                reached.update(context.parallelize(range(count), count).mapPartitions(work).collect())
                if len(reached) >= executors:
                    return
            log.warning("%d of %d executors were not reached: their files may be left", executors - len(reached), executors)
        except Exception as error:
            log.warning("files of the workers may be left: %s", error)

    def _ask(self, kind: str, data: bytes) -> bytes:
        """One pass: the merged answer of all parts."""
        work = functools.partial(tasks.answer, layout=self._layout, question=(kind, data))

        def attempt() -> bytes | None:
            found = self._parts.mapPartitions(work)
            if found.getNumPartitions() <= tasks.MERGED_BY_DRIVER_MAX:
                answers = found.collect()
            else:
                answers = [found.treeReduce(functools.partial(tasks.merge_answers, kind=kind), depth=2)]
            if any(missing for missing, _ in answers):
                return None
            parts = [data for _, data in answers if data is not None]
            return _native.merge_partials(parts) if kind == "query" else _native.merge_verdicts(parts)

        return self._tried(attempt)

    def _solve(self, solver: passes.Asking[T], count: int = 0) -> T:
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

    def robust_ellipsoid(
        self, *, coverage: float | None = None, level: float = 0.975, threads: int | None = None
    ) -> RobustRows:
        """Center and scatter of most of the points by minimum covariance determinant, and the outliers.

        The search of `taut.robust_ellipsoid` runs over some thousand rows on the driver. From what that finds, concentration steps over
        all rows, of two passes each, lead to a local optimum, which need not be that of the search in memory. Its bytes do not depend on
        the partitions.

        Parameters
        ----------
        coverage, level, threads
            As in `taut.robust_ellipsoid`; threads are those of the driver.

        Returns
        -------
        RobustRows
            The estimate, and a DataFrame of the outliers.

        Raises
        ------
        ValueError
            When most of the points lie in a flat: such an ellipsoid is found in memory or from a file.
        """
        rows, columns = self.shape
        fit = self._solve(passes.RobustSolver(rows, columns, coverage=coverage, level=level, threads=threads))
        ellipsoid = fit.ellipsoid
        # |F(x - c)| is the Mahalanobis distance over the square root of the cutoff, which is that of the scatter and the matrix.
        border = float(np.sqrt(columns / np.trace(fit.scatter @ ellipsoid.matrix)))
        shape = tuple(part.tolist() for part in (ellipsoid.center, ellipsoid.center_tail, ellipsoid.factor))
        work = functools.partial(tasks.outliers, layout=self._layout, shape=shape, border=border)
        found = self._records.mapPartitions(work)
        return RobustRows(fit, self._session.createDataFrame(found, f"id {self._id_type}, distance double"))

    def centers(
        self, k: int, *, method: Literal["stream", "farthest-first", "tree"] = "stream", discrete: bool = False,
        epsilon: float | None = None, max_nodes: int | None = None, threads: int | None = None,
    ) -> Solution[Any]:
        """k centers of the points.

        By "stream" the bytes are those of ``taut.centers(method="stream")`` over the points on one machine. The first of two passes
        visits one partition after the other, as each takes over the points kept of those before. By "farthest-first" answer and
        certificate are those on one machine, and passes are at most k and two. By "tree" a search over a core-set on the driver
        proves the gap that is wanted; passes add rows to the core-set that its centers leave out.

        Parameters
        ----------
        k : int >= 1
            Most centers.
        method : {"stream", "farthest-first", "tree"}, default "stream"
            The way to find them.
        discrete : bool, default False
            As in `taut.centers`; not by "tree".
        epsilon, max_nodes
            As in `taut.centers`; only by "tree".
        threads
            Those of the driver; not by "stream".

        Returns
        -------
        Solution
            Its row numbers have ids: `ids`.
        """
        rows, columns = self.shape
        options = passes.options_of_centers(
            method, discrete=discrete or None, epsilon=epsilon, max_nodes=max_nodes, threads=threads
        )
        if method != "stream":
            return self._solve(passes.Solver.k_centers(rows, columns, k, method=method, **options))
        data = passes.StreamingCenters.new(columns, k).data
        log.info("pass 1 over %d rows, by partition: begins", rows)
        for partition in sorted(self._layout.digests):
            data = self._add_to_stream(partition, data)
        log.info("pass 1 over %d rows, by partition: ends", rows)
        return self._solve(passes.Solver.centers(passes.StreamingCenters(data), discrete=discrete), 1)

    def _add_to_stream(self, partition: int, data: bytes) -> bytes:
        work = functools.partial(tasks.add_to_stream, layout=self._layout, data=data)
        run = self._records.context.runJob
        return bytes(self._tried(lambda: run(self._records, work, [partition])[0]))

    def delaunay(self, *, leaf_points: int = 2**18, voronoi: bool = False) -> Triangulation:
        """Delaunay triangulation of points in the plane: the simplices of `taut.delaunay` over them on one machine.

        One shuffle brings each point to its leaf; a task holds one leaf, which takes about 130 bytes for each point.

        Parameters
        ----------
        leaf_points : int, default 2**18
            Most points of a leaf, about. The simplices do not depend on it.
        voronoi : bool, default False
            Whether there is to be a DataFrame of the edges of the Voronoi diagram as well.

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
        found, tiles, kept = self._tried(
            lambda: delaunay.triangulate(self._session, self._records, self._layout, self._id_type, leaf_points)
        )
        self._kept += kept
        if not voronoi:
            return found
        return found._replace(voronoi=diagram.edges(self._session, tiles, kept, self._id_type))

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
        solution = as_solution(solution)
        # Faults that need no row are raised here, and not within a worker.
        passes.check_part(solution, np.empty((0, self.shape[1]), self._layout.dtype), 0, self.shape[0])
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
            Values of the id column as rows of Spark have them, in the order of `rows`.
        """
        if self._id is None:
            raise ValueError("the points have no ids: name the column of ids when the points are made")
        wanted = [_row_number(row) for row in rows]
        for row in wanted:
            if not 0 <= row < self.shape[0]:
                raise ValueError(f"there is no row {row}: rows are numbered from 0 to {self.shape[0] - 1}")
        work = functools.partial(tasks.ids_of, layout=self._layout, wanted=wanted)

        def attempt() -> dict[int, Any] | None:
            pairs = self._records.mapPartitions(work).collect()
            return None if None in pairs else dict(pairs)

        names, kind = self._tried(attempt), self._id_kind
        # Arrow has times with a zone; rows of Spark have those of the driver, without one.
        return [kind.fromInternal(kind.toInternal(names[row])) for row in wanted]

    def close(self) -> None:
        """Removes the files of the workers, as far as they can be reached. Afterwards neither the points nor DataFrames of them are of use."""
        if self._is_closed:
            return
        self._is_closed = True
        try:
            self._sweep(None)
        except KeyboardInterrupt:
            # Whoever presses Ctrl-C twice does not want the files.
            self._sweep(None)
            raise
        finally:
            for rdd in filter(None, (*self._kept, self._edges, self._records)):
                # Nothing is kept once the session has ended.
                with contextlib.suppress(Exception):
                    rdd.unpersist()

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
    df: Any, columns: Sequence[str], k: int, *, id: str | None = None, partitions: int | None = None, **options: Any
) -> Solution[Any]:
    """k centers of the rows of a DataFrame.

    Parameters
    ----------
    df, columns, id, partitions
        As in `Points`.
    k, **options
        As in `Points.centers`.

    Returns
    -------
    Solution
    """
    with Points(df, columns, id=id, partitions=partitions) as points:
        return points.centers(k, **options)


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


def robust_ellipsoid(
    df: Any, columns: Sequence[str], *, id: str | None = None, partitions: int | None = None, **options: Any
) -> RobustFit:
    """Center and scatter of most of the rows of a DataFrame; `Points.robust_ellipsoid` has the outliers as well.

    Parameters
    ----------
    df, columns, id, partitions
        As in `Points`.
    **options
        As in `Points.robust_ellipsoid`.

    Returns
    -------
    RobustFit
    """
    with Points(df, columns, id=id, partitions=partitions) as points:
        return points.robust_ellipsoid(**options).fit


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
        # By default Spark takes these for one name.
        fold = str if df.sparkSession.conf.get("spark.sql.caseSensitive") == "true" else str.lower
        same = [other for other in df.columns if fold(other) == fold(name)]
        if len(same) > 1:
            raise ValueError(f"column {name!r} is not the only one of that name: the DataFrame has {', '.join(map(repr, same))}")
    for name in columns:
        if types[name] not in NUMBERS:
            raise ValueError(f"column {name!r} is of type {types[name]}: expected {', '.join(NUMBERS)}")
    if id_column is not None and types[id_column] not in IDS:
        raise ValueError(f"column {id_column!r}, the id, is of type {types[id_column]}: expected {', '.join(IDS)}")
    if id_column is not None and getattr(df.schema[id_column].dataType, "collation", BINARY) != BINARY:
        raise ValueError(f"column {id_column!r}, the id, is collated: expected the collation {BINARY}")
    return "float32" if all(NUMBERS[types[name]] for name in columns) else "float64"


def _row_number(row: Any) -> int:
    if isinstance(row, bool):
        raise TypeError(f"{row} is no row number")
    return operator.index(row)


def _quoted(name: str) -> str:
    """The name of a column that may have dots, which else are fields of it."""
    return "`" + name.replace("`", "``") + "`"


def _level() -> Any:
    """Where records and shared blocks are kept: what memory drops would be made again from the DataFrame."""
    from pyspark import StorageLevel

    return StorageLevel.MEMORY_AND_DISK


@functools.cache
def _register_tasks() -> None:
    """Workers get the functions by value, as they may have to find taut in the wheel first."""
    from pyspark import cloudpickle

    cloudpickle.register_pickle_by_value(tasks)
    cloudpickle.register_pickle_by_value(delaunay)
    cloudpickle.register_pickle_by_value(diagram)
