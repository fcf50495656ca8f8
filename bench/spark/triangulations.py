"""A triangulation of the plane in 16 partitions: the hash of one machine, the memory of executors, and what is shuffled."""

import os
import threading
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
import taut
import taut.spark

from .context import Context, Line, columns_of, timed
from .processes import below, children, executors, memory_of

PARTITIONS = 16
MEMORY_MAX = 1 << 30
SHARE_MAX = 0.05
SAMPLE_INTERVAL = 0.1

# Small executors. The largest heap is about the least that Spark takes; it begins smaller and gives back what it does not need. Little
# beside it grows: one compiler is enough for what it does. The thresholds of malloc do not rise, so it gives back what a task has freed.
OPTIONS = {
    "spark.master": "local-cluster[2,1,480]",
    "spark.executor.memory": "480m",
    "spark.executor.extraJavaOptions": (
        "-XX:+UseSerialGC -Xms128m -Xmn48m -XX:MinHeapFreeRatio=5 -XX:MaxHeapFreeRatio=15 "
        "-XX:MaxDirectMemorySize=64m -XX:TieredStopAtLevel=1 -XX:ReservedCodeCacheSize=32m -Xss512k"
    ),
    "spark.executorEnv.MALLOC_ARENA_MAX": "2",
    "spark.executorEnv.MALLOC_MMAP_THRESHOLD_": "131072",
    "spark.executorEnv.MALLOC_TRIM_THRESHOLD_": "131072",
    "spark.network.io.preferDirectBufs": "false",
    "spark.shuffle.io.preferDirectBufs": "false",
    "spark.reducer.maxSizeInFlight": "16m",
    "spark.python.worker.memory": "64m",
}


class Memory:
    """The largest memory of an executor, its workers with it, while something runs."""

    def __init__(self) -> None:
        # The largest sums: what is resident, and of it what is not a file.
        self.resident, self.private = 0, 0
        # Of the largest: the JVM, and the workers.
        self.jvm, self.workers = 0, 0
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)

    def _watch(self) -> None:
        roots: list[int] = []
        while not self._stop.wait(SAMPLE_INTERVAL):
            if not roots or not all(os.path.exists(f"/proc/{pid}") for pid in roots):
                roots = executors()
            listed = children()
            for root in roots:
                jvm = memory_of(root)
                workers = [memory_of(pid) for pid in below(root, listed)]
                resident = jvm[0] + sum(one for one, _ in workers)
                if resident > self.resident:
                    self.resident, self.jvm, self.workers = resident, jvm[0], resident - jvm[0]
                self.private = max(self.private, jvm[1] + sum(one for _, one in workers))

    def __enter__(self) -> "Memory":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._stop.set()
        self._thread.join(10)


class Shuffled(NamedTuple):
    """Bytes that stages wrote for others: the largest of them, which is the one that brings points somewhere, and those before and after."""

    before: int
    largest: int
    after: int


def shuffled(context: Context, first: int) -> Shuffled:
    """The bytes of the stages from some number on."""
    written = {}
    for event in context.events("SparkListenerStageCompleted"):
        info = event["Stage Info"]
        for value in info["Accumulables"]:
            if value["Name"] == "internal.metrics.shuffle.write.bytesWritten" and info["Stage ID"] >= first:
                written[info["Stage ID"]] = int(value["Value"])
    moves = [written[stage] for stage in sorted(written)] or [0]
    at = moves.index(max(moves))
    return Shuffled(sum(moves[:at]), moves[at], sum(moves[at + 1 :]))


def last_stage(context: Context) -> int:
    """The number of the last stage so far."""
    return max((event["Stage Info"]["Stage ID"] for event in context.events("SparkListenerStageCompleted")), default=-1)


def run(context: Context) -> Iterator[Line]:
    n = context.count(10_000_000, 50_000)
    rows = taut.generate("uniform", n, 2, seed=1)
    order = np.random.default_rng(0).permutation(n)
    df = context.session.read.parquet(context.stored(rows[order], "rows", order))
    size = rows.nbytes
    with Memory() as memory:
        before = last_stage(context)
        points, writing = timed(lambda: taut.spark.Points(df, columns_of(rows), id="key", partitions=PARTITIONS))
        with points:
            sorting = shuffled(context, before + 1)
            before = last_stage(context)
            found, took = timed(points.delaunay)
            moved = shuffled(context, before + 1)
            simplices = found.simplices.count()
    expected = taut.delaunay(rows)
    is_same = found.fingerprint == expected.fingerprint and simplices == found.total == len(expected.simplices)
    yield Line(f"{n} points in {PARTITIONS} partitions", found.fingerprint, "must be the same", is_same)
    yield Line("time to sort and write, to triangulate", f"{writing:.1f} s, {took:.1f} s")
    yield from memory_lines(memory)
    goal = f"must <= {100 * SHARE_MAX:.0f} %"
    rest = (moved.before + moved.after) / size
    figure = f"{100 * rest:.2f} %: {100 * moved.before / size:.2f} before, {100 * moved.after / size:.2f} after"
    yield Line("shuffled beside the move to the leaves, of the points", figure, goal, rest <= SHARE_MAX)
    yield Line("the move of each point to its leaf, with row and id", f"{100 * moved.largest / size:.0f} %")
    yield Line("shuffled to sort by id", f"{100 * sum(sorting) / size:.0f} %")
    yield Line("sites that leaves pass up, of the points", f"{100 * found.passed_up / n:.2f} %")


def memory_lines(memory: Any) -> Iterator[Line]:
    mib = 1 << 20
    goal = f"must <= {MEMORY_MAX // mib} MiB"
    figure = f"{memory.resident // mib} MiB: JVM {memory.jvm // mib}, Python {memory.workers // mib}"
    yield Line("peak memory of an executor, its workers with it", figure, goal, memory.resident <= MEMORY_MAX)
    yield Line("of it not pages of files", f"{memory.private // mib} MiB")
