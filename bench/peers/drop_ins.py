"""The drop-ins beside SciPy, and MinCovDet beside scikit-learn: the same inputs, in one run, with the answers compared first.

To reproduce: build the module with `maturin develop --release`, then `python bench/peers/drop_ins.py [NAME]...`. One row for
each comparison: the median of three runs of taut and one of the peer, in seconds, and their quotient.
"""

from __future__ import annotations

import statistics
import sys
import time

import numpy as np
import scipy
import scipy.spatial
import sklearn
from sklearn.covariance import MinCovDet as ScikitMinCovDet

import taut
import taut.spatial
from taut.sklearn import MinCovDet

RUNS = 3


def seconds(work, runs=RUNS):
    """The median time and the last result."""
    times, found = [], None
    for _ in range(runs):
        begin = time.perf_counter()
        found = work()
        times.append(time.perf_counter() - begin)
    return statistics.median(times), found


def row(name, ours, theirs, *, agree):
    mine, found = seconds(ours)
    other, expected = seconds(theirs, 1)
    assert agree(found, expected), name
    print(f"{name:<44} {mine:>9.4f} {other:>9.4f} {other / mine:>7.1f} x", flush=True)


def same_simplices(found, expected):
    return np.array_equal(
        np.unique(np.sort(found.simplices, axis=1), axis=0), np.unique(np.sort(expected.simplices, axis=1), axis=0)
    )


def same_corners(found, expected):
    """Whether simplices found hold the same rows, over the few that rounding decides otherwise."""
    triangulation, numbers = found
    other, others = expected
    inside = (numbers >= 0) & (others >= 0)
    mine, theirs = (np.sort(t.simplices[n[inside]], axis=1) for t, n in ((triangulation, numbers), (other, others)))
    return (mine == theirs).all(axis=1).mean() > 0.9999 and inside.mean() > 0.99 * max((numbers >= 0).mean(), (others >= 0).mean())


def same_counts(found, expected):
    """Whether there are as many vertices and ridges, over the few that rounding decides otherwise."""
    d = found.ndim
    # Ridges in space between one vertex and infinity, which SciPy leaves out.
    mine, theirs = ([len(v.vertices), sum(len(ridge) >= d for ridge in v.ridge_vertices)] for v in (found, expected))
    return np.allclose(mine, theirs, rtol=1e-4)


def delaunay():
    for n, d in ((10**6, 2), (10**5, 3)):
        points = np.random.default_rng(1).random((n, d))
        row(f"Delaunay, {n} in {d} dimensions", lambda: taut.spatial.Delaunay(points),
            lambda: scipy.spatial.Delaunay(points), agree=same_simplices)


def find_simplex():
    for n, d in ((2 * 10**5, 2), (5 * 10**4, 3)):
        rng = np.random.default_rng(2)
        points, places = rng.random((n, d)), rng.random((10**6, d))
        ours, theirs = taut.spatial.Delaunay(points), scipy.spatial.Delaunay(points)
        theirs.transform
        for order, at in (("random", places), ("sorted", places[taut.spatial_order(places).answer.rows])):
            row(f"find_simplex, 10^6 {order} of {n} in {d} dimensions", lambda: (ours, ours.find_simplex(at)),
                lambda: (theirs, theirs.find_simplex(at)), agree=same_corners)


def voronoi():
    for n, d in ((2 * 10**5, 2), (2 * 10**4, 3)):
        points = np.random.default_rng(3).random((n, d))
        row(f"Voronoi, {n} in {d} dimensions", lambda: taut.spatial.Voronoi(points), lambda: scipy.spatial.Voronoi(points),
            agree=same_counts)


def hull():
    def same(found, expected):
        return np.array_equal(np.sort(found.vertices), np.sort(expected.vertices)) and np.isclose(found.volume, expected.volume)

    rng = np.random.default_rng(4)
    sphere = rng.normal(size=(10**5, 3))
    sphere /= np.sqrt(np.square(sphere).sum(axis=1))[:, None]
    for name, points in (
        ("10^5 of a cube", rng.random((10**5, 3))),
        ("10^5 normal", rng.normal(size=(10**5, 3))),
        ("10^5 on a sphere", sphere),
        ("10^6 of the plane", rng.random((10**6, 2))),
        ("10^7 of a cube", rng.random((10**7, 3))),
        ("10^7 normal", rng.normal(size=(10**7, 3))),
    ):
        row(f"ConvexHull, {name}", lambda: taut.spatial.ConvexHull(points), lambda: scipy.spatial.ConvexHull(points), agree=same)


def covariance():
    for n, d, share in ((5 * 10**4, 10, 0.0), (5000, 5, 0.3)):
        rng = np.random.default_rng(5)
        rows = rng.normal(size=(n + (n + d + 1) % 2, d)) @ rng.normal(size=(d, d))
        rows[: int(share * n)] += 20
        row(f"MinCovDet, {n} x {d}, {share:.0%} elsewhere", lambda: MinCovDet().fit(rows),
            lambda: ScikitMinCovDet(random_state=0).fit(rows),
            agree=lambda a, b: np.linalg.slogdet(a.raw_covariance_)[1] <= np.linalg.slogdet(b.raw_covariance_)[1] + 1e-9)


COMPARISONS = {f.__name__: f for f in (delaunay, find_simplex, voronoi, hull, covariance)}


def main():
    print(f"taut {taut.__version__}, SciPy {scipy.__version__}, scikit-learn {sklearn.__version__}, NumPy {np.__version__}")
    print(f"{'':<44} {'taut s':>9} {'peer s':>9} {'faster':>9}")
    for name in sys.argv[1:] or COMPARISONS:
        COMPARISONS[name]()


if __name__ == "__main__":
    main()
