"""The kinds of solutions about points, each stated once."""

from __future__ import annotations

from typing import NamedTuple

from .._record import Record
from .ball import Ball, BallCertificate, Verdict
from .bodies import BodiesCertificate, BodiesVerdict, InscribedBodies
from .centers import Centers, CentersCertificate, CentersVerdict
from .circle import CircleCertificate, CircleVerdict, InscribedCircle
from .curve import Curve, CurveCertificate, CurveVerdict
from .dop import BoundingDop, DopCertificate, DopVerdict
from .ellipse import EllipseCertificate, EllipseVerdict, InscribedEllipse
from .ellipsoid import Ellipsoid, EllipsoidCertificate, EllipsoidVerdict
from .inscribed import InscribedCertificate, InscribedEllipsoid, InscribedVerdict
from .kernel_ball import KernelBall, KernelBallCertificate, KernelBallVerdict
from .order import Order, OrderCertificate, OrderVerdict
from .oriented import InscribedOrientedRectangle, OrientedRectangleCertificate, OrientedRectangleVerdict
from .polygon import ConvexCertificate, ConvexPolygon, ConvexVerdict
from .rectangle import InscribedRectangle, RectangleCertificate, RectangleVerdict
from .robust import RobustCertificate, RobustEllipsoid, RobustVerdict
from .surface import Surface, SurfaceCertificate, SurfaceVerdict
from .triangle import InscribedTriangle, TriangleCertificate, TriangleVerdict
from .triangulation import Triangulation, TriangulationCertificate, TriangulationVerdict

AnyVerdict = (
    Verdict
    | KernelBallVerdict
    | EllipsoidVerdict
    | InscribedVerdict
    | CircleVerdict
    | EllipseVerdict
    | ConvexVerdict
    | OrientedRectangleVerdict
    | RectangleVerdict
    | TriangleVerdict
    | BodiesVerdict
    | DopVerdict
    | RobustVerdict
    | CentersVerdict
    | CurveVerdict
    | SurfaceVerdict
    | OrderVerdict
    | TriangulationVerdict
)


class Kind(NamedTuple):
    """What is particular about a kind."""

    answer: type[Record]
    certificate: type[Record]
    verdict: type[Record]
    does: str
    """What the answer does to its items, as errors say it."""
    facts: tuple[str, ...]
    """The attributes by which a solution prints itself, as paths."""
    items: str = "points"
    """What the rows are, where the certificate does not say so."""


KINDS = {
    "ball": Kind(Ball, BallCertificate, Verdict, "encloses", ("answer.radius", "certificate.gap")),
    "kernel-ball": Kind(
        KernelBall,
        KernelBallCertificate,
        KernelBallVerdict,
        "encloses",
        ("answer.kernel", "answer.squared_radius", "certificate.gap"),
    ),
    "ellipsoid": Kind(
        Ellipsoid,
        EllipsoidCertificate,
        EllipsoidVerdict,
        "encloses",
        ("answer.log_volume", "certificate.gap"),
    ),
    "inscribed-ellipsoid": Kind(
        InscribedEllipsoid,
        InscribedCertificate,
        InscribedVerdict,
        "lies in",
        ("answer.log_volume", "certificate.gap"),
        items="half-spaces",
    ),
    "inscribed-circle": Kind(
        InscribedCircle,
        CircleCertificate,
        CircleVerdict,
        "lies in",
        ("answer.radius", "certificate.gap"),
    ),
    "inscribed-ellipse": Kind(
        InscribedEllipse,
        EllipseCertificate,
        EllipseVerdict,
        "lies in",
        ("answer.area", "certificate.gap"),
    ),
    "convex-polygon": Kind(
        ConvexPolygon,
        ConvexCertificate,
        ConvexVerdict,
        "lies in",
        ("answer.area", "certificate.gap"),
    ),
    "inscribed-oriented-rectangle": Kind(
        InscribedOrientedRectangle,
        OrientedRectangleCertificate,
        OrientedRectangleVerdict,
        "lies in",
        ("answer.area", "certificate.gap"),
    ),
    "inscribed-rectangle": Kind(
        InscribedRectangle,
        RectangleCertificate,
        RectangleVerdict,
        "lies in",
        ("answer.area", "certificate.gap"),
    ),
    "inscribed-triangle": Kind(
        InscribedTriangle,
        TriangleCertificate,
        TriangleVerdict,
        "lies in",
        ("answer.area", "certificate.gap"),
    ),
    "inscribed-bodies": Kind(
        InscribedBodies,
        BodiesCertificate,
        BodiesVerdict,
        "lies in",
        ("answer.bodies", "answer.disjoint"),
    ),
    "bounding-dop": Kind(
        BoundingDop,
        DopCertificate,
        DopVerdict,
        "encloses",
        ("answer.volume", "answer.normals"),
    ),
    "robust-ellipsoid": Kind(
        RobustEllipsoid,
        RobustCertificate,
        RobustVerdict,
        "speaks of",
        ("answer.log_det", "answer.outliers"),
    ),
    "centers": Kind(
        Centers,
        CentersCertificate,
        CentersVerdict,
        "is about",
        ("certificate.k", "answer.radius", "answer.lower_bound"),
    ),
    "curve": Kind(Curve, CurveCertificate, CurveVerdict, "speaks of", ("answer.curves",)),
    "surface": Kind(
        Surface,
        SurfaceCertificate,
        SurfaceVerdict,
        "speaks of",
        ("answer.triangles", "answer.components"),
    ),
    "order": Kind(Order, OrderCertificate, OrderVerdict, "speaks of", ("answer.curve", "answer.rows")),
    "delaunay": Kind(
        Triangulation,
        TriangulationCertificate,
        TriangulationVerdict,
        "joins",
        ("certificate.sites", "answer.simplices", "answer.hull"),
    ),
}

# For what rows are, the array that belongs to them beside points, centers or normals.
ARRAYS = {
    "points": "",
    "balls": "radii",
    "ellipsoids": "shapes",
    "half-spaces": "offsets",
    "points with weights": "weights",
}
