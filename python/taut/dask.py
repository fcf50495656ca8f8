"""Answers about rows that lie with the workers of Dask, with the bytes of those on one machine.

>>> import taut.dask                                                              # doctest: +SKIP
>>> points = taut.dask.Points(client, [dask.delayed(np.load)(path) for path in paths])   # doctest: +SKIP
>>> found = points.ball()                                                         # doctest: +SKIP

Parts are made by tasks, so that Dask makes those again that are lost with a worker.
"""

from __future__ import annotations

import itertools
from operator import getitem
from typing import Any, Literal

import numpy as np

from . import passes
from ._arrays import Rows, as_rows
from ._solution import Solution
from ._verify import as_solution

__all__ = ["Points"]


class Points:
    """Points in parts, rows in the order of the parts.

    Parameters
    ----------
    client : distributed.Client
        The client of the cluster.
    parts : sequence of Delayed, or a Dask array or DataFrame
        Each makes an array of shape (m, d), or a DataFrame of numbers; of any m, none as well.
    """

    def __init__(self, client: Any, parts: Any) -> None:
        self._client = client
        # A Delayed seems to have any attribute, but its type does not.
        if hasattr(type(parts), "rechunk"):
            if parts.ndim != 2:
                raise ValueError(f"the array has shape {parts.shape}: expected (n, d)")
            parts = parts.rechunk({1: -1}).to_delayed().ravel()
        elif hasattr(type(parts), "to_delayed"):
            parts = parts.to_delayed()
        futures = enumerate(client.compute(list(parts)))
        arrays = [client.submit(_rows_of_part, part, number, pure=False) for number, part in futures]
        shapes = client.gather([client.submit(np.shape, array, pure=False) for array in arrays])
        ends = list(itertools.accumulate((count for count, _ in shapes), initial=0))
        columns = next((width for count, width in shapes if count), shapes[0][1] if shapes else 0)
        for number, (count, width) in enumerate(shapes):
            if count and width != columns:
                raise ValueError(f"part {number} has rows of {width} numbers, those before have {columns}")
        self.shape = (ends[-1], columns)
        step = passes.rows_of_block(columns)
        # The first row of each part that is whole blocks, and what it is cut from.
        cuts: dict[int, list[Any]] = {}
        for array, start, end in zip(arrays, ends, ends[1:]):
            first = min(-(-start // step) * step, end)
            last = end if end == ends[-1] else max(end // step * step, first)
            for low, high in ((start, first), (first, last), (last, end)):
                while low < high:
                    cut = high if low == first and high == last else min(high, (low // step + 1) * step)
                    piece = client.submit(getitem, array, slice(low - start, cut - start), pure=False)
                    cuts.setdefault(low // step * step, []).append(piece)
                    low = cut
        self._parts = [(first, client.submit(np.concatenate, pieces, pure=False)) for first, pieces in sorted(cuts.items())]

    def _ask(self, query: passes.Query) -> passes.Partial:
        tasks = [self._client.submit(passes.Query.run, query, rows, first, pure=False) for first, rows in self._parts]
        return passes.merge(self._client.gather(tasks))

    def ball(self, **options: Any) -> Solution[Any]:
        """Smallest ball enclosing the points; options are those of `taut.passes.Solver.ball`.

        Parameters
        ----------
        **options
            As in `taut.passes.Solver.ball`.

        Returns
        -------
        Solution
        """
        return passes.solve(passes.Solver.ball(*self.shape, **options), self._ask)

    def ellipsoid(self, **options: Any) -> Solution[Any]:
        """Ellipsoid of least volume enclosing the points; options are those of `taut.passes.Solver.ellipsoid`.

        Parameters
        ----------
        **options
            As in `taut.passes.Solver.ellipsoid`.

        Returns
        -------
        Solution
        """
        return passes.solve(passes.Solver.ellipsoid(*self.shape, **options), self._ask)

    def robust_ellipsoid(self, **options: Any) -> passes.RobustFit:
        """Center and scatter of most of the points; options are those of `taut.passes.RobustSolver`.

        Parameters
        ----------
        **options
            As in `taut.passes.RobustSolver`.

        Returns
        -------
        RobustFit
        """
        return passes.solve(passes.RobustSolver(*self.shape, **options), self._ask)

    def centers(
        self, k: int, *, method: Literal["stream", "farthest-first", "tree"] = "stream", discrete: bool = False, **options: Any
    ) -> Solution[Any]:
        """k centers. By "stream" the first pass visits one part after the other.

        Parameters
        ----------
        k, discrete
            As in `taut.centers`.
        method : {"stream", "farthest-first", "tree"}, default "stream"
            The way to find them, as in `taut.spark.Points.centers`.
        **options
            As in `taut.passes.Solver.k_centers`: epsilon and max_nodes by "tree", threads not by "stream".

        Returns
        -------
        Solution
        """
        options = passes.options_of_centers(method, discrete=discrete or None, **options)
        if method != "stream":
            return passes.solve(passes.Solver.k_centers(*self.shape, k, method=method, **options), self._ask)
        cover: Any = passes.StreamingCenters.new(self.shape[1], k)
        for _, rows in self._parts:
            cover = self._client.submit(passes.StreamingCenters.add, cover, rows, pure=False)
        return passes.solve(passes.Solver.centers(self._client.gather(cover), discrete=discrete), self._ask)

    def verify(self, solution: Solution[Any] | str) -> Any:
        """Check an answer over the points, in one pass.

        Parameters
        ----------
        solution : Solution or str
            The answer with its certificate, or their JSON.

        Returns
        -------
        Verdict
        """
        solution = as_solution(solution)
        check, total = passes.check_part, self.shape[0]
        tasks = [self._client.submit(check, solution, rows, first, total, pure=False) for first, rows in self._parts]
        return passes.check_parts(solution, self._client.gather(tasks))


def _rows_of_part(part: Any, number: int) -> Rows:
    try:
        return as_rows(part)
    except (TypeError, ValueError) as error:
        raise type(error)(f"part {number}: {error}") from None
