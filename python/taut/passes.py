"""Solvers that ask about rows which others hold, and answers to them: the contract of `taut.spark` and `taut.dask`.

A solver has one open `Query` at a time. Whoever holds rows runs it over whole blocks of them, merges the answers, and feeds
them to the solver until it has no query left. The solution has the bytes of the one in memory, however rows are divided.

>>> import taut
>>> from taut import passes
>>> rows = taut.generate("normal", 50_000, 3, seed=7)
>>> step = 2 * passes.rows_of_block(3)                       # parts are whole blocks
>>> solver = passes.Solver.ball(50_000, 3)
>>> while (query := solver.query()) is not None:
...     solver.feed(passes.merge([query.run(rows[first : first + step], first) for first in range(0, 50_000, step)]))
>>> found = solver.solution()
>>> found == taut.ball(rows)
True
>>> parts = [passes.check_part(found, rows[first : first + step], first, 50_000) for first in range(0, 50_000, step)]
>>> passes.check_parts(found, parts) == found.check(rows)
True
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple, Protocol, Self, TypeVar, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._answers.ellipsoid import Ellipsoid
from ._answers.kinds import KINDS
from ._answers.robust import RobustEllipsoid
from ._answers.trace import Trace
from ._arrays import as_rows
from ._ball import BallMethod
from ._solution import Solution

__all__ = [
    "Partial", "PartialVerdict", "Query", "RobustFit", "RobustSolver", "Solver", "StreamingCenters", "check_part",
    "check_parts", "merge", "merge_verdicts", "rows_of_block", "solve",
]

Found = TypeVar("Found", covariant=True)

# The options that the methods of `centers` take where rows lie in parts.
OPTIONS_OF_CENTERS = {
    "stream": {"discrete"},
    "farthest-first": {"discrete", "threads"},
    "tree": {"epsilon", "max_nodes", "threads"},
}


def options_of_centers(method: str, methods: Iterable[str] = OPTIONS_OF_CENTERS, **given: Any) -> dict[str, Any]:
    """The options that are given, and not None. Those that the method does not take are refused, and so are other methods."""
    if method not in methods:
        raise ValueError(f"option `method` is {method}: expected {' or '.join(methods)}")
    options = {name: value for name, value in given.items() if value is not None}
    for name, value in options.items():
        if name not in OPTIONS_OF_CENTERS[method]:
            raise ValueError(f"option `{name}` is {value}: the method {method} does not take it")
    return options


def rows_of_block(columns: int) -> int:
    """Rows of a block: parts begin at multiples of it.

    Parameters
    ----------
    columns : int
        Numbers of a row.

    Returns
    -------
    int
    """
    return _native.rows_of_block(columns)


@final
@dataclass(frozen=True, slots=True)
class Partial:
    """The answer of some blocks of rows to a query. Its bytes travel, and it can be pickled."""

    data: bytes


@final
@dataclass(frozen=True, slots=True)
class PartialVerdict:
    """The findings of the checker in some blocks of rows. Its bytes travel, and it can be pickled."""

    data: bytes
    columns: int


@final
@dataclass(frozen=True, slots=True)
class Query:
    """A question of a solver about all rows. Its bytes travel, and it can be pickled."""

    data: bytes

    @property
    def is_pass(self) -> bool:
        """True where it looks at every row, and not at a few by number."""
        return _native.query_shape(self.data)[2]

    def run(self, block: ArrayLike, first_row: int = 0, *, threads: int | None = 1) -> Partial:
        """Answers it for whole blocks of rows.

        Parameters
        ----------
        block : array_like of shape (m, d)
            Rows that follow each other; none at all is allowed.
        first_row : int, default 0
            The number of the first one, a multiple of `rows_of_block`.
        threads : int, optional, default 1
            Threads to use, None for all cores.

        Returns
        -------
        Partial

        Raises
        ------
        ValueError
            When rows are not whole blocks, or a number is NaN or infinite; the message has the number of the row.
        """
        return Partial(_native.run_query(self.data, as_rows(block), first_row, threads))


def merge(partials: Iterable[Partial]) -> Partial:
    """Puts answers of several parts together, in any order.

    Parameters
    ----------
    partials : iterable of Partial
        Answers to one query; merged ones as well.

    Returns
    -------
    Partial

    Raises
    ------
    ValueError
        When they overlap, answer different queries, or were worked on by kernels that round differently.
    """
    return Partial(_native.merge_partials([partial.data for partial in partials]))


@final
@dataclass(frozen=True, slots=True)
class StreamingCenters:
    """At most k points near all rows that came by, of a stream. Its bytes travel, and it can be pickled."""

    data: bytes

    @classmethod
    def new(cls, columns: int, k: int) -> Self:
        """The cover of no rows.

        Parameters
        ----------
        columns : int
            Numbers of a row.
        k : int >= 1
            Most centers.

        Returns
        -------
        StreamingCenters
        """
        return cls(_native.new_stream(columns, k))

    def add(self, rows: ArrayLike, *, threads: int | None = 1) -> StreamingCenters:
        """The cover of the rows so far and those that come next.

        Parameters
        ----------
        rows : array_like of shape (m, d)
            Any number of rows: only their order counts.
        threads : int, optional, default 1
            Threads to use, None for all cores.

        Returns
        -------
        StreamingCenters

        Raises
        ------
        ValueError
            When a number is NaN or infinite; the message has the number of the row in the stream.
        """
        return StreamingCenters(_native.add_to_stream(self.data, as_rows(rows), threads))


@final
class Solver:
    """A solver that waits for answers; made by `Solver.ball`, `Solver.ellipsoid`, `Solver.centers` or `Solver.k_centers`."""

    def __init__(self, native: _native.PassSolver) -> None:
        self._native = native

    @classmethod
    def ball(
        cls,
        rows: int,
        columns: int,
        *,
        items: Literal["points", "balls"] = "points",
        epsilon: float = 1e-9,
        method: BallMethod = "core-set",
        batch: int | None = None,
        delta: float | None = None,
        max_passes: int = 1_000_000,
        threads: int | None = None,
        seed: int = 0,
    ) -> Self:
        """The solver of `taut.ball`.

        Parameters
        ----------
        rows, columns : int
            The shape of all rows together.
        items : {"points", "balls"}, default "points"
            What a row is; of a ball the radius is the last column.
        epsilon, method, batch, delta, max_passes, threads, seed
            As in `taut.ball`.

        Returns
        -------
        Solver
        """
        native = _native.PassSolver.ball(
            rows, columns, items, epsilon, method, batch, delta, max_passes, threads, seed
        )
        return cls(native)

    @classmethod
    def ellipsoid(
        cls, rows: int, columns: int, *, epsilon: float = 1e-9, max_passes: int = 1_000_000, threads: int | None = None,
        seed: int = 0,
    ) -> Self:
        """The solver of `taut.ellipsoid` for points that do not lie in a flat; others are refused when that is seen.

        Parameters
        ----------
        rows, columns : int
            The shape of all rows together.
        epsilon, max_passes, threads, seed
            As in `taut.ellipsoid`.

        Returns
        -------
        Solver
        """
        return cls(_native.PassSolver.ellipsoid(rows, columns, epsilon, max_passes, threads, seed))

    @classmethod
    def centers(cls, cover: StreamingCenters, *, discrete: bool = False) -> Self:
        """The solver of `taut.centers` by its method "stream", for a cover that all rows were added to, in order.

        Parameters
        ----------
        cover : StreamingCenters
            The cover.
        discrete : bool, default False
            As in `taut.centers`.

        Returns
        -------
        Solver
        """
        return cls(_native.PassSolver.centers(cover.data, discrete))

    @classmethod
    def k_centers(
        cls, rows: int, columns: int, k: int, *, method: Literal["tree", "farthest-first"] = "tree", epsilon: float = 0.01,
        discrete: bool = False, max_nodes: int = 10_000_000, threads: int | None = None,
    ) -> Self:
        """The solver of `taut.centers` by two of its methods.

        By "farthest-first" answer and certificate are those in memory, and the trace counts passes. By "tree" the search goes over a
        core-set, to which passes add the rows that its centers leave out; it proves the gap as well, with other centers.

        Parameters
        ----------
        rows, columns : int
            The shape of all rows together.
        k : int >= 1
            Most centers.
        method : {"tree", "farthest-first"}, default "tree"
            The way to find them.
        epsilon, discrete, max_nodes, threads
            As in `taut.centers`. By "tree", centers are free.

        Returns
        -------
        Solver
        """
        options_of_centers(method, ("tree", "farthest-first"), discrete=discrete or None)
        return cls(_native.PassSolver.k_centers(rows, columns, k, method, epsilon, discrete, max_nodes, threads))

    def query(self) -> Query | None:
        """The open query; None once there is a solution.

        Returns
        -------
        Query or None
        """
        data = self._native.query()
        return None if data is None else Query(data)

    def feed(self, partial: Partial) -> None:
        """Hands over the merged answer of all rows to the open query.

        Parameters
        ----------
        partial : Partial
            The answer.

        Raises
        ------
        ValueError
            When blocks are missing or it answers another query; the query stays open.
        """
        self._native.feed(partial.data)

    def solution(self) -> Solution[Any]:
        """The solution, once there is no query left; the solver ends with it.

        Returns
        -------
        Solution

        Raises
        ------
        ValueError
            As the function in memory, and while a query is open.
        """
        if self.query() is not None:
            raise ValueError("the solver still has a question: run it on all parts and feed the answer")
        return Solution(self._native.solution())


class RobustFit(NamedTuple):
    """Center and scatter of most of the rows, and the tolerance ellipsoid. Rows outside of that are outliers; they may be too many to list."""

    ellipsoid: Ellipsoid
    """The ellipsoid that holds the part of normal rows that was asked for."""
    scatter: NDArray[np.float64]
    """For normal rows an estimate of their covariance."""
    log_det: float
    """The logarithm of the determinant of `scatter`."""
    objective: float
    """That of the determinant of the covariance of the rows kept. No C-step lowers it."""
    kept: int
    """How many rows were kept; more than asked for where very many are equally far."""
    weighed: int
    """How many rows were not weighed out, from which center and scatter are taken."""
    trace: Trace


@final
class RobustSolver:
    """A solver that waits for answers, of `taut.robust_ellipsoid` by its method "mcd".

    It searches a sample of the rows; from what that finds, concentration steps (C-steps) over all rows lead to a local optimum. No
    certificate comes with it, as that would name half of all rows.

    Parameters
    ----------
    rows, columns : int
        The shape of all rows together.
    coverage, level, threads
        As in `taut.robust_ellipsoid`.
    """

    def __init__(
        self, rows: int, columns: int, *, coverage: float | None = None, level: float = 0.975, threads: int | None = None
    ) -> None:
        self._native = _native.RobustPasses(rows, columns, coverage, level, threads)

    def query(self) -> Query | None:
        """As `Solver.query`.

        Returns
        -------
        Query or None
        """
        data = self._native.query()
        return None if data is None else Query(data)

    def feed(self, partial: Partial) -> None:
        """As `Solver.feed`.

        Parameters
        ----------
        partial : Partial
            The answer.
        """
        self._native.feed(partial.data)

    def solution(self) -> RobustFit:
        """The estimate, once there is no query left; the solver ends with it.

        Returns
        -------
        RobustFit

        Raises
        ------
        ValueError
            When most rows lie in a flat, and while a query is open.
        """
        if self.query() is not None:
            raise ValueError("the solver still has a question: run it on all parts and feed the answer")
        said, objective, kept, weighed, trace = self._native.solution()
        answer = RobustEllipsoid._of(said)
        return RobustFit(answer.ellipsoid, answer.scatter, answer.log_det, objective, kept, weighed, Trace._of(trace))


class Asking(Protocol[Found]):
    """A solver of any kind."""

    def query(self) -> Query | None:
        """The open query."""

    def feed(self, partial: Partial) -> None:
        """Hands over its answer."""

    def solution(self) -> Found:
        """What was found."""


def solve(solver: Asking[Found], ask: Callable[[Query], Partial]) -> Found:
    """Feeds a solver until it has a solution.

    Parameters
    ----------
    solver : Solver or RobustSolver
        The solver.
    ask : callable
        Returns the merged answer of all rows to a query.

    Returns
    -------
    Solution or RobustFit
    """
    while (query := solver.query()) is not None:
        solver.feed(ask(query))
    return solver.solution()


def check_part(
    solution: Solution[Any], block: ArrayLike, first_row: int, rows: int, *, threads: int | None = 1
) -> PartialVerdict:
    """Judges an answer over whole blocks of rows. Balls, ellipsoids around points, and centers of points are judged in parts.

    Parameters
    ----------
    solution : Solution
        The answer with its certificate.
    block : array_like of shape (m, d)
        Rows that follow each other.
    first_row : int
        The number of the first one, a multiple of `rows_of_block`.
    rows : int
        The number of all rows.
    threads : int, optional, default 1
        Threads to use, None for all cores.

    Returns
    -------
    PartialVerdict
        It also says which row is wrong, so that the first of all is named in the end.
    """
    array = as_rows(block)
    data = _native.check_part(solution._found, array, first_row, rows, threads)
    return PartialVerdict(data, array.shape[1])


def merge_verdicts(partials: Iterable[PartialVerdict]) -> PartialVerdict:
    """Puts what was found in several parts together, in any order.

    Parameters
    ----------
    partials : iterable of PartialVerdict
        What was found of one answer.

    Returns
    -------
    PartialVerdict
    """
    partials = list(partials)
    columns = partials[0].columns if partials else 0
    return PartialVerdict(_native.merge_verdicts([partial.data for partial in partials]), columns)


def check_parts(solution: Solution[Any], partials: Iterable[PartialVerdict]) -> Any:
    """The verdict over all rows.

    Parameters
    ----------
    solution : Solution
        The answer with its certificate.
    partials : iterable of PartialVerdict
        What was found in all parts.

    Returns
    -------
    Verdict
        That of `Solution.check` over all rows at once.

    Raises
    ------
    Violation
        That of `Solution.check`.
    ValueError
        When blocks are missing or come twice.
    """
    partials = list(partials)
    columns = partials[0].columns if partials else 0
    said = _native.check_parts(solution._found, columns, [partial.data for partial in partials])
    return KINDS[solution.kind].verdict._of(said)
