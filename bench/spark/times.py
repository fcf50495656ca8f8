"""The time of a steady pass beside an empty one, and of the whole ball."""

import os
from collections.abc import Iterator
from typing import Any

import numpy as np
import taut
import taut.spark
from taut import passes

from .context import Context, Line, columns_of, median_times, timed
from .processes import seconds

RUNS = 9
EMPTY_FACTOR = 1.5
MEMORY_FACTOR, MEMORY_MORE = 5, 0.3
BALL_MAX = 10.0


def empty_pass(points: Any, reads: bool) -> None:
    """A job over the same blocks that maps them, reads each number once if it is to, and answers nothing."""
    layout = points._layout

    def work(elements: Any) -> Any:
        from taut import _spark_tasks as tasks

        for element in elements:
            part = tasks.blocks(element, layout)
            if reads and part is not None:
                part[1].sum()
        yield False, None

    points._parts.mapPartitions(work).collect()


def last_query(points: Any) -> tuple[bytes, int]:
    """The last pass that the ball asks for, and how many there are."""
    asked: list[bytes] = []
    ask = points._ask

    def noted(kind: str, data: bytes) -> bytes:
        if kind == "query" and passes.Query(data).is_pass:
            asked.append(data)
        return bytes(ask(kind, data))

    points._ask = noted
    try:
        points.ball()
    finally:
        del points._ask
    return asked[-1], len(asked)


def first_job(context: Context) -> float:
    """The session stands when executors have handed rows of a small table to Python and taken them back, without taut. Spark loads on that
    occasion what every job needs, which is no part of what is measured after it. What was written before goes to the disk first."""
    small = taut.generate("normal", 1000, 10, seed=2)
    table = context.session.read.parquet(context.stored(small, "small")).repartition(4)
    columns = ", ".join(f"{name} double" for name in columns_of(small))
    os.sync()
    return timed(lambda: table.mapInArrow(lambda batches: batches, columns).rdd.map(tuple).collect())[1]


def run(context: Context) -> Iterator[Line]:
    n, d = context.count(10_000_000, 100_000), 10
    rows = taut.generate("normal", n, d, seed=1)
    columns = columns_of(rows)
    order = np.random.default_rng(0).permutation(n)
    plain = context.session.read.parquet(context.stored(rows, "plain"))
    shuffled = context.session.read.parquet(context.stored(rows[order], "shuffled", order))
    wanted = taut.ball(rows).to_json()
    yield Line("the first job of executors over rows, by Spark alone, before the rest", f"{first_job(context):.1f} s")
    before = seconds()
    made, writing = timed(lambda: taut.spark.Points(plain, columns))
    with made as points:
        _, solving = timed(points.ball)
        processor = seconds() - before
        goal = f"must <= {BALL_MAX:.0f} s"
        yield Line(f"ball, {n} x {d}, points open", f"{solving:.2f} s", goal, solving <= BALL_MAX)
        whole = writing + solving
        figure = f"{whole:.1f} s, {writing:.1f} of it to write the blocks"
        yield Line(f"ball, {n} x {d}, from Parquet, rows as they come", figure, goal, whole <= BALL_MAX)
        yield Line("processor time of that, of all processes", f"{processor:.1f} s")
        data, count = last_query(points)
        query = passes.Query(data)
        steady, idle, read, memory = median_times(
            [
                lambda: points._ask("query", data),
                lambda: empty_pass(points, False),
                lambda: empty_pass(points, True),
                lambda: query.run(rows, 0, threads=None),
            ],
            RUNS,
        )
        goal = f"must <= {EMPTY_FACTOR:g}"
        yield Line(
            "steady pass beside an empty one that reads each number", f"{steady:.3f} s, {read:.3f} s: {steady / read:.2f}", goal,
            steady <= EMPTY_FACTOR * read,
        )
        yield Line("the same beside one that reads nothing", f"{steady:.3f} s, {idle:.3f} s: {steady / idle:.2f}")
        limit = MEMORY_FACTOR * memory + MEMORY_MORE
        goal = f"aim <= {limit:.3f} s"
        yield Line("steady pass beside the one in memory", f"{steady:.3f} s, {memory:.3f} s", goal, steady <= limit)
        yield Line("passes of the ball", str(count))
    made, writing = timed(lambda: taut.spark.Points(shuffled, columns, id="key"))
    with made as points:
        found, solving = timed(points.ball)
    figure = f"{writing + solving:.1f} s, {writing:.1f} of it to sort and write"
    yield Line(f"ball, {n} x {d}, from shuffled Parquet, ordered by id", figure)
    is_same = found.to_json() == wanted
    yield Line("its bytes, beside those in memory", "the same" if is_same else "OTHER", "must be the same", is_same)
