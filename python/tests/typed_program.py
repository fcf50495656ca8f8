"""A program that uses the package with types: `mypy --strict` checks it, and the tests run it."""

import numpy as np
from numpy.typing import NDArray

import taut
from taut.spatial import AlphaComplex, ConstrainedTriangulation, Polytope, Triangulation, VoronoiDiagram, hull

Floats = NDArray[np.float64]


def shapes_around(points: Floats) -> float:
    ball: taut.Solution[taut.Ball] = taut.ball(points, epsilon=1e-6)
    inside: NDArray[np.bool_] = ball.answer.contains(points)
    distances: Floats = ball.answer.distance(points)
    ellipsoid: taut.Solution[taut.Ellipsoid] = taut.ellipsoid(points)
    many: list[taut.Solution[taut.Ellipsoid]] = taut.ellipsoids([points, points])
    robust: taut.Solution[taut.RobustEllipsoid] = taut.robust_ellipsoid(points)
    far: Floats = robust.answer.distances(points)
    kernel: taut.Solution[taut.KernelBall] = taut.kernel_ball(points[:20])
    balls: taut.Solution[taut.Ball] = taut.ball_of_balls(points, np.ones(len(points)))
    dop: taut.Solution[taut.BoundingDop] = taut.bounding_dop(np.column_stack([points, points[:, 0]]))
    assert inside.all() and ellipsoid.answer.contains(points).all() and len(many) == 2 and balls.answer.radius > 1
    assert len(far) == len(distances) and kernel.kind == "kernel-ball" and dop.kind == "bounding-dop"
    volume: float = ellipsoid.answer.log_volume
    return ball.answer.radius + volume


def clusters(points: Floats) -> int:
    found: taut.Solution[taut.Centers] = taut.centers(points, 3, epsilon=0.5)
    labels: NDArray[np.int64] = found.answer.assign(points)
    order: taut.FarthestFirst = taut.farthest_first(points, 5)
    tree: taut.SphereTree = taut.sphere_tree(points)
    curve_order: taut.Solution[taut.Order] = taut.spatial_order(points)
    rows, _ = taut.SphereSearch(points).nearest(points)
    assert len(tree.order) == len(curve_order.answer.rows) == len(rows)
    return int(labels.max()) + len(order.order)


def triangulations(points: Floats) -> int:
    found: taut.Solution[taut.Triangulation] = taut.delaunay(points)
    simplices: NDArray[np.int32] = found.answer.simplices
    kept = Triangulation(points)
    same: taut.Solution[taut.Triangulation] = kept.solution
    where: NDArray[np.int32] = kept.locate(points)
    values: Floats = kept.interpolate(points[:, 0], points, method="linear")
    diagram: VoronoiDiagram = kept.voronoi()
    alpha: AlphaComplex = kept.alpha_complex(0.5)
    joined: ConstrainedTriangulation = kept.constrained([[0, 1]])
    polygon: Polytope = hull(points)
    assert same == found and len(values) == len(where) and len(joined.simplices) == len(simplices)
    return len(diagram.vertices) + len(alpha.simplices) + len(polygon.vertices)


def shapes_through_and_inside() -> int:
    angles = np.arange(0, 6.2, 0.1)
    circle: Floats = np.column_stack([np.cos(angles), np.sin(angles)])
    curve: taut.Solution[taut.Curve] = taut.curve(circle)
    disc: taut.Solution[taut.InscribedCircle] = taut.inscribed_circle(circle)
    rectangle: taut.Solution[taut.InscribedRectangle] = taut.inscribe.rectangle(circle)
    sphere = taut.generate("normal", 200, 3)
    surface: taut.Solution[taut.Surface] = taut.surface(sphere / np.sqrt((sphere * sphere).sum(axis=1))[:, None])
    again = taut.Solution.from_json(disc.to_json())
    assert again == disc and disc.answer.radius > 0.9 and rectangle.answer.area > 1
    return len(curve.answer.curves) + len(surface.answer.triangles)


def main() -> None:
    points = np.asarray(taut.generate("normal", 60, 2), dtype=np.float64)
    assert shapes_around(points) > 0
    assert clusters(points) > 0
    assert triangulations(points) > 0
    assert shapes_through_and_inside() > 0


if __name__ == "__main__":
    main()
