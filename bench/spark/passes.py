"""How many times all points are looked at. A solver asks the same of any parts, so one part in memory counts them."""

from collections.abc import Iterator
from typing import Any

import taut
from taut import passes

from .context import Context, Line

SHAPES = ((10_000_000, 10), (1_000_000, 100))
DISTRIBUTIONS = {"normal": "normal", "sphere": "sphere", "cube": "cube", "clustered": "clusters"}
GAP = 1e-9
BALL_MAX, ELLIPSOID_MAX, STREAM = 8, 10, 2
CENTERS = 8


def counted(solver: passes.Solver, rows: Any, before: int = 0) -> tuple[int, Any]:
    """The passes of a solver, and its solution."""
    count = before

    def ask(query: passes.Query) -> passes.Partial:
        nonlocal count
        count += query.is_pass
        return query.run(rows, 0, threads=None)

    found = passes.solve(solver, ask)
    return count, found


def run(context: Context) -> Iterator[Line]:
    for full, d in SHAPES:
        n = context.count(full, 20_000)
        for name, distribution in DISTRIBUTIONS.items():
            rows = taut.generate(distribution, n, d, seed=1)
            of = f"of {name}, {n} x {d}"
            count, found = counted(passes.Solver.ball(n, d, epsilon=GAP), rows)
            gap = found.check(rows).gap
            yield Line(f"ball {of}", f"{count} passes, gap {gap:.1e}", f"must <= {BALL_MAX}", count <= BALL_MAX and gap <= GAP)
            count, found = counted(passes.Solver.ellipsoid(n, d, epsilon=GAP), rows)
            gap = found.check(rows).gap
            holds = count <= ELLIPSOID_MAX and gap <= GAP
            yield Line(f"ellipsoid {of}", f"{count} passes, gap {gap:.1e}", f"must <= {ELLIPSOID_MAX}", holds)
            cover = passes.StreamingCenters.new(d, CENTERS).add(rows, threads=None)
            count, _ = counted(passes.Solver.centers(cover), rows, 1)
            yield Line(f"stream of {CENTERS} centers {of}", f"{count} passes", f"must {STREAM}", count == STREAM)
