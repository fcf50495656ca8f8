"""Options out of all bounds are refused at once, in the words of the library."""

import numpy as np
import pytest

import taut

PLANE = np.random.default_rng(1).random((40, 2))
SPACE = np.random.default_rng(2).random((40, 3))


@pytest.mark.parametrize("threads", [10**9, 1025, 65_536, 10**30])
@pytest.mark.parametrize(
    "solve",
    [
        lambda threads: taut.ball(PLANE, threads=threads),
        lambda threads: taut.ellipsoid(PLANE, threads=threads),
        lambda threads: taut.ellipsoids([PLANE], threads=threads),
        lambda threads: taut.robust_ellipsoid(PLANE, threads=threads),
        lambda threads: taut.centers(PLANE, 3, threads=threads),
        lambda threads: taut.farthest_first(PLANE, 3, threads=threads),
        lambda threads: taut.sphere_tree(PLANE, threads=threads),
        lambda threads: taut.delaunay(PLANE, threads=threads),
        lambda threads: taut.curve(PLANE, threads=threads),
        lambda threads: taut.surface(SPACE, threads=threads),
    ],
)
def test_threads_are_at_most_1024(solve, threads):
    with pytest.raises(ValueError, match=f"option `threads` is {threads}: expected 1 to 1024"):
        solve(threads)


def test_numbers_in_errors_are_short():
    with pytest.raises(ValueError, match=r"option `epsilon` is 1e308: expected"):
        taut.ball(PLANE, epsilon=1e308)
