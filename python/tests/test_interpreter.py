"""Long work leaves the interpreter free, and hears Ctrl-C."""

import subprocess
import sys
import textwrap
import threading
import time

import pytest

import taut


@pytest.fixture(scope="module")
def points():
    return taut.generate("sphere", 20_000, 20, seed=1)


# A job in the background may have been started with Ctrl-C ignored, and hands that on.
LISTEN = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
"""


def run(program):
    """What a program prints in an interpreter of its own, where a late Ctrl-C can stop no other test."""
    done = subprocess.run(
        [sys.executable, "-c", LISTEN + textwrap.dedent(program)],
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert done.stderr == ""
    return done.stdout.split()


def test_ctrl_c_stops_the_work_and_others_run_meanwhile():
    """Another thread takes 20 naps of 10 ms beside work that would last for hours, then presses Ctrl-C."""
    naps, seconds, radius = run(
        """
        import signal, threading, time
        import taut

        points = taut.generate("sphere", 20_000, 20, seed=1)
        naps = []

        def nap():
            for _ in range(20):
                time.sleep(0.01)
                naps.append(time.monotonic())
            signal.raise_signal(signal.SIGINT)

        thread = threading.Thread(target=nap)
        thread.start()
        try:
            # Steps to the farthest point need about 1/epsilon**2 passes.
            taut.ball(points, method="badoiu-clarkson", epsilon=1e-7, max_passes=2**60)
        except KeyboardInterrupt:
            print(len(naps), time.monotonic() - naps[-1])
        thread.join()
        print(taut.ball([[0.0], [2.0]]).answer.radius)
        """
    )
    assert int(naps) == 20
    assert float(seconds) < 5
    assert float(radius) == pytest.approx(1, rel=1e-9)


def test_ctrl_c_stops_a_triangulation():
    """Pressed once the work has begun, which would last for a second or more."""
    assert run(
        """
        import signal, threading, time
        import taut

        points = taut.generate("uniform", 600_000, 3, seed=1)
        threading.Timer(0.2, signal.raise_signal, [signal.SIGINT]).start()
        try:
            taut.delaunay(points, threads=1)
        except KeyboardInterrupt:
            print("stopped")
        print(len(taut.delaunay(points[:4]).simplices))
        """
    ) == ["stopped", "1"]


def test_short_work_does_not_wait_for_the_listener():
    taut.ball([[0.0, 1.0]])
    begin = time.perf_counter()
    for _ in range(100):
        taut.ball([[0.0, 0.0], [1.0, 1.0]])
    assert time.perf_counter() - begin < 2.5  # the listener's 50 ms, each time, would be 5 s


def test_work_runs_on_any_thread(points):
    found = []
    threads = [
        threading.Thread(target=lambda: found.append(taut.ball(points, epsilon=1e-2))) for _ in range(4)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(found) == 4
    assert all(each == found[0] for each in found)


def test_importing_says_nothing_and_knows_its_version():
    assert run("import taut; print(taut.__version__)") == [taut.__version__]
    assert taut.__version__.count(".") == 2
