"""``python -m taut tour``: every tool on points that it generates, each answer checked."""

from __future__ import annotations

import sys
from collections.abc import Callable

import numpy as np

import taut

RING = [[0, 0], [4, 1], [8, 0], [7, 3], [8, 6], [5, 5], [3, 7], [1, 6], [2, 3]]


def _ball() -> str:
    points = taut.generate("normal", 10_000, 10)
    found = taut.ball(points)
    return f"radius {found.answer.radius:.6f}, gap {found.check(points).gap:.1e}"


def _balls() -> str:
    points, radii = taut.generate("uniform", 1000, 3), np.linspace(0.0, 0.1, 1000)
    found = taut.ball_of_balls(points, radii)
    return f"radius {found.answer.radius:.6f}, gap {found.check(points, radii=radii).gap:.1e}"


def _ellipsoid() -> str:
    points = taut.generate("normal", 2000, 4)
    found = taut.ellipsoid(points)
    return f"log-volume {found.answer.log_volume:.6f}, gap {found.check(points).gap:.1e}"


def _robust() -> str:
    points = taut.generate("normal", 300, 3)
    points[:30] += 50
    found = taut.robust_ellipsoid(points)
    return f"{len(found.answer.outliers)} outliers, rank {found.check(points).rank}"


def _centers() -> str:
    points = taut.generate("clusters", 500, 2)
    found = taut.centers(points, 5)
    return f"radius {found.answer.radius:.6f}, gap {found.check(points).gap:.1e}"


def _inside() -> str:
    circle, rectangle = taut.inscribed_circle(RING), taut.inscribed_rectangle(RING)
    gaps = f"gaps {circle.check(RING).gap:.1e} and {rectangle.check(RING).gap:.1e}"
    return f"circle of radius {circle.answer.radius:.6f}, rectangle of area {rectangle.answer.area:.4f}, {gaps}"


def _triangulation() -> str:
    points = taut.generate("normal", 5000, 3)
    found = taut.delaunay(points)
    return f"{len(found.simplices)} tetrahedra of {found.check(points).sites} points"


def _curve() -> str:
    turn = np.arange(200) * (2 * np.pi / 200)
    points = np.c_[np.cos(turn), 0.5 * np.sin(turn)]
    found = taut.curve(points)
    return f"{len(found.answer.curves)} curve, simple: {found.check(points).simple}"


def _surface() -> str:
    points = taut.generate("torus", 1000, 3)
    found = taut.surface(points)
    return f"{len(found.answer.triangles)} triangles, genus {found.answer.genus}, certified: {found.check(points).certified}"


def _order() -> str:
    points = taut.generate("clouds", 5000, 2)
    found = taut.spatial_order(points)
    return f"{found.check(points).points} points along a Hilbert curve"


STOPS: dict[str, Callable[[], str]] = {
    "smallest ball": _ball,
    "around balls": _balls,
    "ellipsoid": _ellipsoid,
    "outliers": _robust,
    "k centers": _centers,
    "inside a polygon": _inside,
    "triangulation": _triangulation,
    "curve": _curve,
    "surface": _surface,
    "order": _order,
}


def tour() -> None:
    """Print a line for each tool; a check that rejects an answer ends the tour with its error."""
    for name, stop in STOPS.items():
        print(f"{name:<18}{stop()}")
    print(f"{len(STOPS)} stops, each answer verified (taut {taut.__version__})")


if __name__ == "__main__":
    if sys.argv[1:] != ["tour"]:
        sys.exit("usage: python -m taut tour")
    tour()
