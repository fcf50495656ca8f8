"""The drop-ins beside SciPy, and MinCovDet beside scikit-learn: the same inputs, in one run, with the answers compared first.

To reproduce: build the module with `maturin develop --release`, then `python bench/peers/drop_ins.py [SECTION]... [--runs N]`.
Without sections all run: delaunay, find_simplex, voronoi, hull, covariance. One row for each comparison: medians in seconds, how many
times faster taut is, and by how much it must and would be (docs/python.md). A peer that takes more than a second runs once. The exit status
is 1 if a row misses what it must reach.
"""

from __future__ import annotations

import argparse
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

# A peer that takes longer, in seconds, runs once.
LONG_RUN = 1.0


class Table:
    """Prints a row for each comparison, and remembers which of them miss what they must reach."""

    def __init__(self, runs: int) -> None:
        self.runs = runs
        self.misses: list[str] = []
        print(f"{'':<46} {'taut s':>9} {'peer s':>9} {'faster':>9} {'must':>6} {'aim':>6}")

    def row(self, name, ours, theirs, *, agree, must=None, aim=None):
        mine, found = self._seconds(ours)
        other, expected = self._seconds(theirs, LONG_RUN)
        assert agree(found, expected), name
        ratio = other / mine
        missed = must is not None and ratio < must
        if missed:
            self.misses.append(name)
        bounds = " ".join(f"{'' if bound is None else bound:>6}" for bound in (must, aim))
        print(f"{name:<46} {mine:>9.4f} {other:>9.4f} {ratio:>7.1f} x {bounds}{'  missed' if missed else ''}", flush=True)

    def _seconds(self, work, most=float("inf")):
        """The median time and the last result; of one run if it takes longer than `most`."""
        times, found = [], None
        while len(times) < self.runs and (not times or times[0] <= most):
            found = None
            begin = time.perf_counter()
            found = work()
            times.append(time.perf_counter() - begin)
        return statistics.median(times), found


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


def delaunay(table):
    for n, d, must in ((10**6, 2, 15), (10**5, 3, 10)):
        points = np.random.default_rng(1).random((n, d))
        table.row(f"Delaunay, {n} in {d} dimensions", lambda: taut.spatial.Delaunay(points),
                  lambda: scipy.spatial.Delaunay(points), agree=same_simplices, must=must)


def find_simplex(table):
    for n, d, must in ((2 * 10**5, 2, 4), (5 * 10**4, 3, 2.5)):
        rng = np.random.default_rng(2)
        points, places = rng.random((n, d)), rng.random((10**6, d))
        ours, theirs = taut.spatial.Delaunay(points), scipy.spatial.Delaunay(points)
        theirs.transform
        in_order = places[taut.spatial_order(places).answer.rows]
        for order, at, must, aim in (("random", places, must, 20), ("sorted", in_order, 1, None)):
            table.row(f"find_simplex, 10^6 {order} of {n} in {d} dimensions", lambda: (ours, ours.find_simplex(at)),
                      lambda: (theirs, theirs.find_simplex(at)), agree=same_corners, must=must, aim=aim)


def voronoi(table):
    for n, d in ((2 * 10**5, 2), (2 * 10**4, 3)):
        points = np.random.default_rng(3).random((n, d))
        table.row(f"Voronoi, {n} in {d} dimensions", lambda: taut.spatial.Voronoi(points),
                  lambda: scipy.spatial.Voronoi(points), agree=same_counts, must=5)


def hull(table):
    def same(found, expected):
        return np.array_equal(np.sort(found.vertices), np.sort(expected.vertices)) and np.isclose(found.volume, expected.volume)

    rng = np.random.default_rng(4)
    sphere = rng.normal(size=(10**5, 3))
    sphere /= np.sqrt(np.square(sphere).sum(axis=1))[:, None]
    for name, points, must, aim in (
        ("10^5 of a cube", rng.random((10**5, 3)), 1, 3),
        ("10^5 normal", rng.normal(size=(10**5, 3)), 1, 3),
        ("10^5 on a sphere", sphere, 1, 3),
        ("10^6 of the plane", rng.random((10**6, 2)), None, None),
        ("10^7 of a cube", rng.random((10**7, 3)), 1, 3),
        ("10^7 normal", rng.normal(size=(10**7, 3)), 1, 3),
    ):
        table.row(f"ConvexHull, {name}", lambda: taut.spatial.ConvexHull(points), lambda: scipy.spatial.ConvexHull(points),
                  agree=same, must=must, aim=aim)


def covariance(table):
    for n, d, share, must, aim in ((5 * 10**4, 10, 0.0, 5, 10), (5000, 5, 0.3, None, None)):
        rng = np.random.default_rng(5)
        rows = rng.normal(size=(n + (n + d + 1) % 2, d)) @ rng.normal(size=(d, d))
        rows[: int(share * n)] += 20
        table.row(f"MinCovDet, {n} x {d}, {share:.0%} elsewhere", lambda: MinCovDet().fit(rows),
                  lambda: ScikitMinCovDet(random_state=0).fit(rows), must=must, aim=aim,
                  agree=lambda a, b: np.linalg.slogdet(a.raw_covariance_)[1] <= np.linalg.slogdet(b.raw_covariance_)[1] + 1e-9)


SECTIONS = {f.__name__: f for f in (delaunay, find_simplex, voronoi, hull, covariance)}


def main():
    parser = argparse.ArgumentParser(description="The drop-ins of taut beside SciPy and scikit-learn.")
    parser.add_argument("sections", nargs="*", metavar="SECTION", help=f"one of {', '.join(SECTIONS)}; by default all")
    parser.add_argument("--runs", type=int, default=3, help="runs whose median counts (default 3)")
    options = parser.parse_args()
    unknown = [name for name in options.sections if name not in SECTIONS]
    if unknown or options.runs < 1:
        parser.error(f"unknown section {unknown[0]}" if unknown else "--runs must be at least 1")
    print(f"taut {taut.__version__}, SciPy {scipy.__version__}, scikit-learn {sklearn.__version__}, NumPy {np.__version__}")
    table = Table(options.runs)
    for name in options.sections or SECTIONS:
        SECTIONS[name](table)
    print(f"missed: {'; '.join(table.misses) or 'none'}")
    sys.exit(bool(table.misses))


if __name__ == "__main__":
    main()
