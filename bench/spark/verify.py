"""Answers are verified in one pass, with the verdict of one machine; a forged one is refused with its row."""

import json
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import taut
import taut.spark

from .context import Context, Line, columns_of

CENTERS = 6


def refusal(judge: Callable[[], Any]) -> str:
    """The words with which an answer is refused; none if it is not."""
    try:
        judge()
    except (taut.Violation, ValueError) as refused:
        return str(refused)
    return ""


def forgeries(kind: str, solution: Any, n: int) -> Iterator[tuple[str, str]]:
    """Answers that are wrong by one number; each must be refused with a row."""
    size = {"ball": "radius", "ellipsoid": "matrix", "centers": "radius"}[kind]
    forged = json.loads(solution.to_json())
    if kind == "ellipsoid":
        forged["answer"]["factor"] = [[1.001 * x for x in row] for row in forged["answer"]["factor"]]
        forged["answer"][size] = [[1.002001 * x for x in row] for row in forged["answer"][size]]
        forged["answer"]["log_volume"] += -len(forged["answer"]["center"]) * float(np.log(1.001))
    else:
        forged["answer"][size] *= 0.999
    yield f"{kind}, too small", json.dumps(forged)
    forged = json.loads(solution.to_json())
    names = "support" if "support" in forged["certificate"] else "core_set"
    forged["certificate"][names][-1] = n + 7
    yield f"{kind}, with a row that is not there", json.dumps(forged)


def run(context: Context) -> Iterator[Line]:
    n, d = context.count(1_000_000, 50_000), 10
    rows = taut.generate("normal", n, d, seed=3)
    order = np.random.default_rng(0).permutation(n)
    df = context.session.read.parquet(context.stored(rows[order], "rows", order))
    solutions = {
        "ball": taut.ball(rows),
        "ellipsoid": taut.ellipsoid(rows),
        "centers": taut.centers(rows, CENTERS, method="stream"),
    }
    spark = context.session.sparkContext
    with taut.spark.Points(df, columns_of(rows), id="key", partitions=7) as points:
        for kind, solution in solutions.items():
            spark.setJobGroup(kind, kind)
            verdict = points.verify(solution.to_json())
            jobs = len(spark.statusTracker().getJobIdsForGroup(kind))
            yield Line(f"verify {kind}, {n} x {d}", f"{jobs} pass", "must 1", jobs == 1)
            same = verdict == solution.check(rows)
            yield Line(f"verdict of the {kind}", "the same" if same else "ANOTHER", "must be the same", same)
            for what, forged in forgeries(kind, solution, n):
                here = refusal(lambda: points.verify(forged))
                wanted = refusal(lambda: taut.verify(forged, rows))
                names_row = any(word in here for word in ("point ", "row "))
                print(f"    {what}: {here or 'NOT REFUSED'}")
                yield Line(f"refused with the row: {what}", "as on one machine" if here == wanted else f"ELSE: {wanted[:60]}",
                           "must", bool(here) and here == wanted and names_row)
