"""The session of Spark, a folder, what is logged, and what the event log of Spark says."""

import json
import logging
import os
import shutil
import statistics
import sys
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow
import pyarrow.parquet

# Executors, cores of each, and the heap of its JVM in MiB.
MASTER = "local-cluster[2,1,1024]"

# Rows that are written as one file at least.
ROWS_OF_FILE = 1_000_000


@dataclass(frozen=True)
class Line:
    """One line of the report; it holds, misses, or has no goal."""

    what: str
    figure: str
    goal: str = ""
    holds: bool | None = None


@dataclass
class Context:
    """Where a part runs."""

    scale: float
    folder: Path
    # Of the session, beside those that all parts have.
    options: dict[str, str] = field(default_factory=dict)
    # Times since the epoch, and what was said.
    log: list[tuple[float, str]] = field(default_factory=list)

    def count(self, full: int, least: int = 1) -> int:
        """A size at this scale."""
        return max(least, round(full * self.scale))

    @cached_property
    def session(self) -> Any:
        """Two executors, each a process of its own with one core."""
        from pyspark.sql import SparkSession

        os.environ["PYSPARK_PYTHON"] = sys.executable
        # Workers find what this program finds.
        os.environ["PYTHONPATH"] = os.pathsep.join(path for path in sys.path if path)
        events = self.folder / "events"
        events.mkdir()
        options = {
            "spark.driver.host": "127.0.0.1",
            "spark.driver.bindAddress": "127.0.0.1",
            "spark.driver.memory": "2g",
            "spark.ui.enabled": "false",
            "spark.ui.showConsoleProgress": "false",
            "spark.sql.shuffle.partitions": "4",
            "spark.sql.execution.arrow.pyspark.enabled": "true",
            "spark.executorEnv.PYTHONPATH": os.environ["PYTHONPATH"],
            "spark.eventLog.enabled": "true",
            "spark.eventLog.compress": "false",
            "spark.eventLog.rolling.enabled": "false",
            "spark.eventLog.dir": events.as_uri(),
        }
        builder = SparkSession.builder
        for name, value in {"spark.master": MASTER, **options, **self.options}.items():
            builder = builder.config(name, value)
        session = builder.getOrCreate()
        session.sparkContext.setLogLevel("FATAL")
        return session

    def events(self, *names: str) -> list[dict[str, Any]]:
        """The events of these names that Spark has logged, in their order."""
        [path] = [path for path in (self.folder / "events").iterdir() if not path.name.startswith(".")]
        found = []
        with path.open(encoding="utf-8") as file:
            for text in file:
                # The last line may be written just now.
                if text.endswith("\n") and any(f'"{name}"' in text[:80] for name in names):
                    found.append(json.loads(text))
        return found

    def stored(self, rows: Any, name: str, ids: Any = None, files: int = 0) -> str:
        """Writes rows to a folder of Parquet files; ids become the column "key"."""
        path = self.folder / name
        path.mkdir()
        files = files or max(2, -(-len(rows) // ROWS_OF_FILE))
        cuts = [part * len(rows) // files for part in range(files + 1)]
        for part, (low, high) in enumerate(zip(cuts, cuts[1:])):
            columns = {f"x{at}": np.ascontiguousarray(rows[low:high, at]) for at in range(rows.shape[1])}
            if ids is not None:
                columns["key"] = ids[low:high]
            file = path / f"part-{part:05}.parquet"
            pyarrow.parquet.write_table(pyarrow.table(columns), file, compression="none", use_dictionary=False)
        return str(path)


def columns_of(rows: Any) -> list[str]:
    """The names that `Context.stored` gives to coordinates."""
    return [f"x{at}" for at in range(rows.shape[1])]


class _Kept(logging.Handler):
    """Keeps what is logged."""

    def __init__(self, log: list[tuple[float, str]]):
        super().__init__()
        self.log = log

    def emit(self, record: logging.LogRecord) -> None:
        self.log.append((record.created, record.getMessage()))


@contextmanager
def open_context(scale: float, options: dict[str, str]) -> Iterator[Context]:
    """A folder that goes at the end, and the log of taut.spark; the session begins when it is asked for."""
    folder = Path(tempfile.mkdtemp(prefix="taut-spark-"))
    context = Context(scale, folder, options)
    handler, logger = _Kept(context.log), logging.getLogger("taut.spark")
    level, propagates = logger.level, logger.propagate
    logger.addHandler(handler)
    logger.setLevel("INFO")
    logger.propagate = False
    try:
        yield context
    finally:
        logger.removeHandler(handler)
        logger.setLevel(level)
        logger.propagate = propagates
        if "session" in vars(context):
            context.session.stop()
        shutil.rmtree(folder, ignore_errors=True)


def passes_between(log: list[tuple[float, str]], first: int) -> list[tuple[str, float, float]]:
    """The passes that a log has from some entry on: what each is called, when it began, and when it ended."""
    found, begun = [], {}
    for at, message in log[first:]:
        name, _, what = message.rpartition(": ")
        if what == "begins":
            begun[name] = at
        elif what == "ends" and name in begun and name.startswith("pass "):
            found.append((name, begun[name], at))
    return found


def timed(work: Callable[[], Any]) -> tuple[Any, float]:
    """The result of some work, and its seconds."""
    begin = time.monotonic()
    result = work()
    return result, time.monotonic() - begin


def median_times(works: list[Callable[[], Any]], runs: int) -> list[float]:
    """The median of the seconds of each work; they take turns, so that all see the same machine."""
    seconds: list[list[float]] = [[] for _ in works]
    for _ in range(runs):
        for work, list_of_it in zip(works, seconds):
            list_of_it.append(timed(work)[1])
    return [statistics.median(list_of_it) for list_of_it in seconds]
