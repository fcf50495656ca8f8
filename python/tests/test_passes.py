"""Solutions from parts have the bytes of those in memory."""

import doctest
import json
import os
import pickle
import subprocess
import sys

import numpy as np
import pytest

import taut
from taut import passes


def in_parts(rows, count):
    """Whole blocks of the rows, dealt to so many parts, the last one first; some are empty where there are fewer blocks."""
    step = passes.rows_of_block(rows.shape[1])
    blocks = -(-len(rows) // step)
    cuts = [min(part * blocks // count * step, len(rows)) for part in range(count + 1)]
    return [(first, rows[first:end]) for first, end in zip(cuts, cuts[1:])][::-1]


def solve(solver, parts):
    def ask(query):
        query = pickle.loads(pickle.dumps(query))
        return passes.merge(pickle.loads(pickle.dumps(query.run(rows, first))) for first, rows in parts)

    return passes.solve(solver, ask)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("distribution", ["normal", "cube", "poisson", "sphere"])
@pytest.mark.parametrize("d", [2, 10])
def test_balls(distribution, d, dtype):
    n = 300_000 // d
    rows = taut.generate(distribution, n, d, seed=4).astype(dtype)
    wanted = taut.ball(rows)
    for count in (1, 4, 7, 16):
        parts = in_parts(rows, count)
        found = solve(passes.Solver.ball(n, d), parts)
        assert found.to_json() == wanted.to_json()
        verdict = passes.check_parts(found, [passes.check_part(found, block, first, n) for first, block in parts])
        assert verdict == wanted.check(rows)


def test_balls_of_balls():
    rows = np.abs(taut.generate("normal", 40_000, 4, seed=4))
    wanted = taut.ball_of_balls(rows[:, :3], rows[:, 3])
    found = solve(passes.Solver.ball(40_000, 4, items="balls"), in_parts(rows, 3))
    assert found.to_json() == wanted.to_json()


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(("distribution", "d"), [("normal", 2), ("poisson", 3), ("sphere", 10)])
def test_ellipsoids(distribution, d, dtype):
    n = 300_000 // d
    rows = taut.generate(distribution, n, d, seed=4).astype(dtype)
    wanted = taut.ellipsoid(rows)
    for count in (1, 7):
        parts = in_parts(rows, count)
        found = solve(passes.Solver.ellipsoid(n, d), parts)
        assert found.to_json() == wanted.to_json()
        verdict = passes.check_parts(found, [passes.check_part(found, block, first, n) for first, block in parts])
        assert verdict == wanted.check(rows)


def test_an_ellipsoid_in_a_flat_is_refused():
    rows = np.hstack([taut.generate("normal", 50_000, 2, seed=4), np.ones((50_000, 1))])
    with pytest.raises(ValueError, match="lie in a flat of dimension 2 in 3 dimensions"):
        solve(passes.Solver.ellipsoid(50_000, 3), in_parts(rows, 3))


@pytest.mark.parametrize("discrete", [False, True])
def test_centers_of_a_stream(discrete):
    rows = taut.generate("poisson", 100_000, 3, seed=4)
    wanted = taut.centers(rows, 8, method="stream", discrete=discrete)
    cover = passes.StreamingCenters.new(3, 8)
    for rest in np.array_split(rows, 11):
        cover = pickle.loads(pickle.dumps(cover.add(rest)))
    parts = in_parts(rows, 4)
    found = solve(passes.Solver.centers(cover, discrete=discrete), parts)
    assert found.to_json() == wanted.to_json()
    verdict = passes.check_parts(found, [passes.check_part(found, block, first, len(rows)) for first, block in parts])
    assert verdict == wanted.check(rows)
    with pytest.raises(ValueError, match="coordinate 1 of point 100002 is NaN"):
        cover.add([[0, 0, 0], [1, 1, 1], [2, np.nan, 2]])
    with pytest.raises(ValueError, match="dimension"):
        cover.add([[0, 0]])
    with pytest.raises(ValueError, match="no cover of this version"):
        passes.StreamingCenters(b"").add(rows)


@pytest.mark.parametrize("discrete", [False, True])
def test_a_traversal_has_the_answer_and_the_certificate_of_memory(discrete):
    rows = taut.generate("clusters", 100_000, 3, seed=4)
    wanted = taut.centers(rows, 6, method="farthest-first", discrete=discrete)
    for count in (1, 4):
        solver = passes.Solver.k_centers(*rows.shape, 6, method="farthest-first", discrete=discrete)
        found = solve(solver, in_parts(rows, count))
        assert (found.answer, found.certificate) == (wanted.answer, wanted.certificate)
        assert found.trace.passes <= 8


def test_centers_to_a_gap_are_found_over_a_core_set():
    rows = taut.generate("clusters", 100_000, 3, seed=4)
    parts = in_parts(rows, 4)
    found = solve(passes.Solver.k_centers(*rows.shape, 3, epsilon=1e-3), parts)
    assert found.to_json() == solve(passes.Solver.k_centers(*rows.shape, 3, epsilon=1e-3), in_parts(rows, 1)).to_json()
    verdict = passes.check_parts(found, [passes.check_part(found, block, first, len(rows)) for first, block in parts])
    assert verdict == found.check(rows)
    assert verdict.gap <= 1e-3
    assert found.answer.radius <= taut.centers(rows, 3, epsilon=1e-3).answer.radius * (1 + 1e-3)
    with pytest.raises(ValueError, match="option `discrete` is True: the method tree does not take it"):
        passes.Solver.k_centers(10, 2, 2, discrete=True)
    with pytest.raises(ValueError, match="tree or farthest-first"):
        passes.Solver.k_centers(10, 2, 2, method="stream")


def test_robust_ellipsoids():
    is_long = "TAUT_LONG_TESTS" in os.environ
    rows = taut.generate("normal", 60_000 if is_long else 17_000, 3, seed=4)
    rows[::4] += 30
    found = solve(passes.RobustSolver(*rows.shape), in_parts(rows, 4))
    if is_long:
        again = solve(passes.RobustSolver(*rows.shape), in_parts(rows, 1))
        assert found.ellipsoid == again.ellipsoid
        assert (found.objective, found.trace) == (again.objective, again.trace)
    wanted = taut.robust_ellipsoid(rows)
    assert found.kept == wanted.certificate.kept
    assert abs(found.objective - wanted.certificate.objective) < 1e-3
    assert np.abs(found.scatter - wanted.answer.scatter).max() < 0.05
    assert not found.ellipsoid.contains(rows[::4]).any()
    with pytest.raises(ValueError, match="most of the points lie in a flat"):
        solve(passes.RobustSolver(9000, 2), in_parts(np.hstack([rows[:9000, :1], np.ones((9000, 1))]), 1))
    with pytest.raises(ValueError, match="coverage"):
        passes.RobustSolver(9000, 2, coverage=0.1)


def test_a_wrong_answer_is_refused_with_the_first_row():
    rows = taut.generate("uniform", 100_000, 2, seed=4)
    found = taut.ball(rows)
    parts = in_parts(rows, 4)
    smaller = taut.Solution.from_json(found.to_json().replace(repr(found.answer.radius), repr(found.answer.radius / 2)))
    with pytest.raises(taut.Violation) as wanted:
        smaller.check(rows)
    with pytest.raises(taut.Violation) as raised:
        passes.check_parts(smaller, [passes.check_part(smaller, block, first, len(rows)) for first, block in parts])
    assert str(raised.value) == str(wanted.value)
    assert "lies" in str(raised.value)
    changed = rows.copy()
    changed[70_000] /= 2
    with pytest.raises(taut.Violation, match="the data changed"):
        passes.check_parts(
            found, [passes.check_part(found, block, first, len(rows)) for first, block in in_parts(changed, 4)]
        )


def test_parts_of_one_answer_prove_no_other():
    rows = taut.generate("uniform", 70_000, 2, seed=4)
    found = taut.ball(rows)
    parts = [passes.check_part(found, block, first, len(rows)) for first, block in in_parts(rows, 2)]
    assert passes.check_parts(found, parts) == found.check(rows)
    forged = json.loads(found.to_json())
    forged["answer"]["center"][0] += 1e-12
    moved = taut.Solution.from_json(json.dumps(forged))
    for other in (moved, taut.ellipsoid(rows)):
        with pytest.raises(ValueError, match="another question"):
            passes.check_parts(other, parts)


def test_kernels_that_round_differently_are_not_mixed():
    rows = taut.generate("uniform", 70_000, 2, seed=4)
    solver = passes.Solver.ball(*rows.shape)
    first, rest = rows[:32_768], rows[32_768:]
    solver.feed(passes.merge([solver.query().run(first, 0), solver.query().run(rest, 32_768)]))
    query = solver.query()
    script = (
        "import sys, taut; from taut import passes\n"
        "rows = taut.generate('uniform', 70_000, 2, seed=4)\n"
        "sys.stdout.buffer.write(passes.Query(sys.stdin.buffer.read()).run(rows[32_768:], 32_768).data)"
    )
    found = {
        kernels: subprocess.run(
            [sys.executable, "-c", script], input=query.data, capture_output=True, check=True,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), **kernels_of},
        ).stdout
        for kernels, kernels_of in (("own", {}), ("portable", {"TAUT_KERNELS": "portable"}))
    }
    mine = query.run(first, 0)
    passes.merge([mine, passes.Partial(found["own"])])
    if found["own"] == found["portable"]:
        pytest.skip("this processor has no other kernels than the portable ones")
    with pytest.raises(ValueError, match="kernels .* round differently: set TAUT_KERNELS"):
        passes.merge([mine, passes.Partial(found["portable"])])


def test_refusals():
    rows = taut.generate("uniform", 100_000, 2, seed=4)
    solver = passes.Solver.ball(*rows.shape)
    query = solver.query()
    assert not query.is_pass
    first, second = query.run(rows[:32768], 0), query.run(rows[32768:], 32768)
    with pytest.raises(ValueError, match="rows from 32768 on are missing"):
        solver.feed(first)
    with pytest.raises(ValueError, match="rows from 0 on come twice"):
        passes.merge([first, second, first])
    with pytest.raises(ValueError, match="not whole blocks"):
        query.run(rows[:1000], 0)
    with pytest.raises(ValueError, match="still has a question"):
        passes.Solver.ball(*rows.shape).solution()
    with pytest.raises(ValueError, match="still has a question"):
        solver.solution()
    assert solver.query() == query
    solver.feed(passes.merge([second, first]))
    with pytest.raises(ValueError, match="another question"):
        solver.feed(passes.merge([second, first]))
    rows[40_000, 1] = np.nan
    assert solver.query().is_pass
    with pytest.raises(ValueError, match="coordinate 1 of point 40000 is NaN"):
        solver.query().run(rows[32768:], 32768)
    with pytest.raises(ValueError, match="no query of this version"):
        passes.Query(b"taut 0.0.0 query\n").run(rows, 0)
    with pytest.raises(ValueError, match="epsilon"):
        passes.Solver.ball(10, 2, epsilon=2)
    with pytest.raises(ValueError, match="option `method` is thesis: expected tree or farthest-first"):
        passes.Solver.k_centers(10, 2, 3, method="thesis")
    robust = taut.robust_ellipsoid(rows[:1000])
    with pytest.raises(ValueError, match="kind robust-ellipsoid are not verified in parts"):
        passes.check_part(robust, rows[:1000], 0, 1000)


def test_the_example_runs():
    failed, attempted = doctest.testmod(passes)
    assert failed == 0
    assert attempted > 0
