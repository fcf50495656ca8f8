"""Pictures by matplotlib: the points and the shape, in the plane or in space."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

# Points on a circle, and along each direction of a sphere.
CIRCLE_STEPS = 181
SPHERE_STEPS = 25

# Most points that are drawn one by one; of more, every so many is.
POINTS_SHOWN_MAX = 20_000


def plot(kind: str, answer: Any, rows: NDArray[Any] | None, ax: Any) -> Any:
    """Draws an answer and the points it was found for; returns the axes."""
    draw = DRAWINGS.get(kind)
    dimension = _dimension(kind, answer)
    if draw is None or dimension not in (2, 3):
        what = f"{kind} answers" if draw is None else f"answers in {dimension} dimensions"
        raise ValueError(f"{what} have no plot: those of {', '.join(DRAWINGS)} in the plane and in space do")
    if kind in ("curve", "surface", "delaunay") and rows is None:
        raise ValueError("the points that this was found for are not known any more: solve again, or draw the arrays of the answer")
    if ax is None:
        from matplotlib import pyplot

        ax = pyplot.figure().add_subplot(projection="3d" if dimension == 3 else None)
    if rows is not None and rows.shape[1] == dimension:
        step = -(-len(rows) // POINTS_SHOWN_MAX) or 1
        ax.scatter(*rows[::step].T, s=4, color="0.4")
    draw(ax, answer, rows, dimension)
    ax.set_aspect("equal")
    return ax


def _dimension(kind: str, answer: Any) -> int:
    match kind:
        case "centers":
            return int(answer.centers.shape[1])
        case "delaunay":
            return int(answer.dimension)
        case "surface":
            return 3
        case "ball" | "ellipsoid" | "robust-ellipsoid":
            return len(answer.center)
        case _:
            return 2


def _sphere(dimension: int) -> tuple[Floats, ...]:
    """Coordinates of the unit circle, or of a grid on the unit sphere."""
    around = np.linspace(0, 2 * np.pi, CIRCLE_STEPS if dimension == 2 else SPHERE_STEPS)
    if dimension == 2:
        return np.cos(around), np.sin(around)
    down = np.linspace(0, np.pi, SPHERE_STEPS)[:, None]
    return np.cos(around) * np.sin(down), np.sin(around) * np.sin(down), np.cos(down) + 0 * around


def _draw_image(ax: Any, matrix: Floats, center: Floats) -> None:
    """Draws what a matrix makes of the unit sphere, around a center."""
    unit = np.stack(_sphere(len(center)))
    places = np.tensordot(matrix, unit, axes=1) + center.reshape(-1, *[1] * (unit.ndim - 1))
    if len(center) == 2:
        ax.plot(*places, color="C0")
    else:
        ax.plot_wireframe(*places, color="C0", linewidth=0.4)


def _draw_ball(ax: Any, answer: Any, rows: Any, dimension: int) -> None:
    _draw_image(ax, answer.radius * np.eye(dimension), answer.center)


def _draw_ellipsoid(ax: Any, answer: Any, rows: Any, dimension: int) -> None:
    _draw_image(ax, np.linalg.pinv(answer.factor), answer.center)
    outliers = getattr(answer, "outliers", None)
    if rows is not None and outliers is not None and len(outliers):
        ax.scatter(*rows[outliers].T, s=9, color="C3")


def _draw_centers(ax: Any, answer: Any, rows: Any, dimension: int) -> None:
    for center in answer.centers:
        _draw_image(ax, answer.radius * np.eye(dimension), center)
    ax.scatter(*answer.centers.T, s=25, color="C0", marker="x")


def _draw_triangulation(ax: Any, answer: Any, rows: Any, dimension: int) -> None:
    if answer.hull_dimension != dimension:
        return
    if dimension == 2:
        ax.triplot(rows[:, 0], rows[:, 1], answer.simplices, color="C0", linewidth=0.6)
    else:
        ax.plot_trisurf(*rows.T, triangles=answer.hull, color="C0", alpha=0.3, edgecolor="C0", linewidth=0.3)


def _draw_curve(ax: Any, answer: Any, rows: Any, dimension: int) -> None:
    for number, curve in enumerate(answer.curves):
        vertices = np.vstack([curve.vertices, curve.vertices[:1]]) if curve.closed else curve.vertices
        ax.plot(*vertices.T, color=f"C{number % 10}")


def _draw_surface(ax: Any, answer: Any, rows: Any, dimension: int) -> None:
    vertices = rows if answer.vertices is None else answer.vertices
    ax.plot_trisurf(*np.asarray(vertices, dtype=np.float64).T, triangles=answer.triangles, color="C0")


DRAWINGS = {
    "ball": _draw_ball,
    "ellipsoid": _draw_ellipsoid,
    "robust-ellipsoid": _draw_ellipsoid,
    "centers": _draw_centers,
    "delaunay": _draw_triangulation,
    "curve": _draw_curve,
    "surface": _draw_surface,
}
