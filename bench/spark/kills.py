"""An executor is killed within a pass: the same bytes, and not much later."""

import os
import signal
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import taut
import taut.spark

from .context import Context, Line, columns_of, passes_between, timed
from .processes import executors, seconds

KILLS = 5
DRAWS = 25
SEED = 5


class Killer:
    """Kills an executor some seconds after a pass began."""

    def __init__(self, log: list[tuple[float, str]], number: int, delay: float, which: int):
        # To list processes takes long: it is done before.
        found = executors()
        self.victim = found[which % len(found)]
        self.at: float | None = None
        self._log, self._first, self._number, self._delay = log, len(log), number, delay
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._kill, daemon=True)

    def _kill(self) -> None:
        begins = f"pass {self._number} "
        while not any(message.startswith(begins) for _, message in self._log[self._first :]):
            if self._ended.wait(0.0005):
                return
        time.sleep(self._delay)
        os.kill(self.victim, signal.SIGKILL)
        self.at = time.time()

    def __enter__(self) -> "Killer":
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join(60)


def around(context: Context, at: float, pass_of: tuple[str, float, float], victim: int) -> Iterator[str]:
    """What was logged around a kill, by taut and by Spark, with seconds since the pass began."""
    name, begin, end = pass_of
    lines = [(begin, f"taut: {name}: begins"), (at, f"SIGKILL to executor process {victim}"), (end, f"taut: {name}: ends")]
    for event in context.events("SparkListenerExecutorRemoved"):
        when = event["Timestamp"] / 1000
        if begin - 1 <= when <= end + 1:
            reason = " ".join(event["Removed Reason"].split())
            lines.append((when, f"Spark: executor {event['Executor ID']} removed: {reason[:60]}"))
    for when, text in sorted(lines):
        yield f"{when - begin:+8.3f} s  {text}"


def run(context: Context) -> Iterator[Line]:
    n, d = context.count(1_000_000, 50_000), 10
    rows = taut.generate("normal", n, d, seed=2)
    order = np.random.default_rng(0).permutation(n)
    df = context.session.read.parquet(context.stored(rows[order], "rows", order))
    wanted = taut.ball(rows).to_json()
    rng = np.random.default_rng(SEED)
    same, within, slow = 0, 0, 0.0
    with taut.spark.Points(df, columns_of(rows), id="key", partitions=8) as points:
        points.ball()
        first, before = len(context.log), seconds()
        _, undisturbed = timed(points.ball)
        processor = seconds() - before
        known = passes_between(context.log, first)
        limit = 3 * undisturbed + 15
        for _ in range(DRAWS):
            if within == KILLS:
                break
            number = int(rng.integers(1, len(known) + 1))
            _, begin, end = known[number - 1]
            delay, which = rng.uniform(0, end - begin), int(rng.integers(2))
            first = len(context.log)
            with Killer(context.log, number, delay, which) as killer:
                found, took = timed(points.ball)
            is_same = found.to_json() == wanted
            same += is_same
            name, begin, end = passes_between(context.log, first)[number - 1]
            if killer.at is None or not begin < killer.at < end:
                # The pass was over before its moment came: drawn again.
                continue
            within += 1
            slow = max(slow, took)
            for text in around(context, killer.at, (name, begin, end), killer.victim):
                print(f"    {text}")
            yield Line(
                f"kill {within} within {name}", f"{took:.1f} s, bytes {'the same' if is_same else 'OTHER'}",
                f"must <= {limit:.1f} s", is_same and took <= limit,
            )
            # A new executor takes its place before the next kill.
            wait_for_executors(points)
        verdict = points.verify(wanted) == taut.verify(wanted, rows)
    yield Line("the ball undisturbed", f"{undisturbed:.2f} s, {processor:.2f} s of processors, {len(known)} passes")
    yield Line("kills within a pass", str(within), f"must {KILLS}", within == KILLS)
    yield Line("verified after the kills", "the same verdict" if verdict else "ANOTHER verdict", "must", verdict)


def wait_for_executors(points: Any) -> None:
    """Waits until both executors run again and have their files, which one ball brings about."""
    for _ in range(100):
        if len(executors()) == 2:
            break
        time.sleep(0.1)
    points.ball()
