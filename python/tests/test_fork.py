"""A forked child has its parent's memory, but none of its threads: taut works in it all the same."""

import os
import subprocess
import sys
import textwrap

import pytest

if not hasattr(os, "fork"):
    pytest.skip("this system has no fork", allow_module_level=True)


def run(program):
    """What a program prints in an interpreter of its own; one that hangs is stopped with all its children."""
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", textwrap.dedent(program)]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, start_new_session=True) as process:
        try:
            out, err = process.communicate(timeout=60)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            raise
    assert err == ""
    assert process.returncode == 0
    return out.split()


def test_a_fork_and_its_fork_solve_check_and_generate():
    said = run(
        """
        import os
        import taut

        points = taut.generate("normal", 20_000, 10)
        found = taut.ball(points)

        def work(name, after):
            child = os.fork()
            if child == 0:
                assert (taut.generate("normal", 20_000, 10) == points).all()
                assert taut.ball(points) == found
                assert taut.ball(points, threads=2) == found
                assert taut.verify(found.to_json(), points).gap == found.check(points).gap <= 1e-9
                print(name, flush=True)
                after()
                os._exit(0)
            assert os.waitpid(child, 0)[1] == 0

        work("child", lambda: work("grandchild", lambda: None))
        work("sibling", lambda: None)
        assert taut.ball(points) == found
        """
    )
    assert said == ["child", "grandchild", "sibling"]


def test_a_fork_drives_solvers():
    said = run(
        """
        import os
        import taut
        from taut import passes

        points = taut.generate("normal", 20_000, 3)
        ball, ellipsoid = taut.ball(points), taut.ellipsoid(points)
        child = os.fork()
        if child == 0:
            ask = lambda query: query.run(points)
            assert passes.solve(passes.Solver.ball(*points.shape), ask) == ball
            assert passes.solve(passes.Solver.ellipsoid(*points.shape), ask) == ellipsoid
            print("child", flush=True)
            os._exit(0)
        assert os.waitpid(child, 0)[1] == 0
        """
    )
    assert said == ["child"]


def test_a_pool_of_forked_processes_solves():
    said = run(
        """
        import multiprocessing
        import taut

        points = taut.generate("normal", 20_000, 10)
        found = taut.ball(points)
        with multiprocessing.get_context("fork").Pool(2) as pool:
            assert pool.map(taut.ball, [points] * 4) == [found] * 4
        print("done")
        """
    )
    assert said == ["done"]
