"""The same JSON, byte for byte, as on one machine: for any partitions, shuffled rows, cached and from files, with ties."""

from collections.abc import Iterator
from typing import Any

import numpy as np
import taut
import taut.spark

from .context import Context, Line, columns_of

SETS = 30
PARTITIONS = (1, 4, 7, 16)
CENTERS = 4


def sets() -> Iterator[tuple[str, Any]]:
    """Point sets of three blocks: a grid of four steps a side has hundreds of rows for each place, lattice points and corners many that
    are equally far, and the second half of the copies is the first half again."""
    for d in (1, 2, 3, 10, 30):
        n = 3 * (65_536 // d) - 5
        rng = np.random.default_rng(d)
        yield f"grid in {d}", rng.integers(0, 4, (n, d)) / 4
        yield f"lattice in {d}", rng.integers(-50, 51, (n, d)).astype(np.float64)
        yield f"corners in {d}", 2.0 * rng.integers(0, 2, (n, d)) - 1.0 + 0.5 * (rng.random((n, 1)) < 0.5)
        half = taut.generate("normal", n, d, seed=d)
        half[n - n // 2 :] = half[: n // 2]
        yield f"copies in {d}", half
        signed = np.abs(taut.generate("cube", n, d, seed=d)) * (2.0 * rng.integers(0, 2, (n, d)) - 1.0)
        yield f"mirrored in {d}", np.concatenate([signed[: n // 2], -signed[: n - n // 2]]).astype(np.float32)
        yield f"sphere in {d}", taut.generate("sphere", n, d, seed=d).round(3)


def run(context: Context) -> Iterator[Line]:
    rng = np.random.default_rng(1)
    chosen = list(sets())[:: max(1, round(1 / context.scale))]
    tools = {"ball": 0, "ellipsoid": 0, "centers": 0}
    wrong: list[str] = []
    for number, (name, rows) in enumerate(chosen):
        order = rng.permutation(len(rows))
        source = context.session.read.parquet(context.stored(rows[order], str(number), order, 3))
        wanted = {
            "ball": taut.ball(rows).to_json(),
            "ellipsoid": taut.ellipsoid(rows).to_json(),
            "centers": taut.centers(rows, CENTERS, method="stream").to_json(),
        }
        for kind in ("file-backed", "cached"):
            if kind == "cached":
                source.cache().count()
            for partitions in PARTITIONS:
                with taut.spark.Points(source, columns_of(rows), id="key", partitions=partitions) as points:
                    found = {"ball": points.ball(), "ellipsoid": points.ellipsoid(), "centers": points.centers(CENTERS)}
                for tool, answer in found.items():
                    if answer.to_json() == wanted[tool]:
                        tools[tool] += 1
                    else:
                        wrong.append(f"{tool} of {name}, {kind}, {partitions} partitions")
        source.unpersist()
    every = len(chosen) * 2 * len(PARTITIONS)
    for tool, same in tools.items():
        what = f"{tool}: {len(chosen)} sets with ties x {PARTITIONS} partitions x cached, file-backed"
        yield Line(what, f"{same} of {every} the same bytes", f"must {every}", same == every)
    for name in wrong[:10]:
        yield Line(f"other bytes: {name}", "", "", False)
