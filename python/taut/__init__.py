"""Tight shapes around, through and inside point sets, with proof.

Each function returns a `Solution`: the answer, a certificate that proves it, and a trace of how it came about.

>>> import taut
>>> points = taut.generate("normal", 1000, 3)
>>> found = taut.ball(points)
>>> found.check(points).gap <= 1e-9        # a second opinion, not the solver's
True

The names, options and defaults are those of the Rust library and of the command line.
"""

from typing import TYPE_CHECKING, Any

from . import inscribe
from ._answers.ball import Ball, BallCertificate, Verdict
from ._answers.bodies import BodiesCertificate, BodiesVerdict, BodyProof, ConvexBody, InscribedBodies
from ._answers.centers import Centers, CentersCertificate, CentersVerdict, FarthestFirst, SphereTree
from ._answers.circle import CircleCertificate, CircleVerdict, InscribedCircle
from ._answers.curve import Curve, CurveCertificate, CurveComponent, CurveVerdict
from ._answers.dop import BoundingDop, DopCertificate, DopVerdict
from ._answers.ellipse import EllipseCertificate, EllipseVerdict, InscribedEllipse
from ._answers.ellipsoid import Ellipsoid, EllipsoidCertificate, EllipsoidVerdict, Hull
from ._answers.file import FileVerdict
from ._answers.inscribed import InscribedCertificate, InscribedEllipsoid, InscribedVerdict
from ._answers.kernel_ball import KernelBall, KernelBallCertificate, KernelBallVerdict
from ._answers.order import Order, OrderCertificate, OrderVerdict
from ._answers.oriented import InscribedOrientedRectangle, OrientedRectangleCertificate, OrientedRectangleVerdict
from ._answers.polygon import ConvexCertificate, ConvexPolygon, ConvexVerdict
from ._answers.rectangle import InscribedRectangle, RectangleCertificate, RectangleVerdict
from ._answers.robust import RobustCertificate, RobustEllipsoid, RobustVerdict
from ._answers.surface import Surface, SurfaceCertificate, SurfaceComponent, SurfaceVerdict
from ._answers.trace import PassBounds, Trace
from ._answers.triangle import InscribedTriangle, TriangleCertificate, TriangleVerdict
from ._answers.triangulation import Triangulation, TriangulationCertificate, TriangulationVerdict
from ._ball import ball, ball_of_balls, kernel_ball
from ._bodies import inscribed_bodies, inscribed_dops, triangle_rows
from ._centers import centers, farthest_first, sphere_tree
from ._circle import inscribed_circle
from ._curve import curve
from ._delaunay import delaunay
from ._dop import bounding_dop
from ._ellipse import inscribed_ellipse
from ._ellipsoid import ellipsoid, ellipsoids, inscribed_ellipsoid
from ._file_solution import FileSolution
from ._generate import generate
from ._io import read_points, write_mesh
from ._memory import sample, sort_file, spatial_order, transpose_file
from ._native import Violation, __version__
from ._polygon import inscribed_polygon
from ._oriented import inscribed_oriented_rectangle
from ._rectangle import inscribed_rectangle
from ._robust import robust_ellipsoid
from ._solution import Solution
from ._sphere_search import SphereSearch
from ._surface import surface
from ._terrain import Contour, Raster, contours, raster
from ._tiles import AlphaPart, Tile, Tiles, VoronoiCell, delaunay_tiles
from ._triangle import inscribed_triangle
from ._verify import verify

if TYPE_CHECKING:
    from ._classify import MebClassifier, Svdd

__all__ = [
    "AlphaPart",
    "Ball",
    "BallCertificate",
    "BodiesCertificate",
    "BodiesVerdict",
    "BodyProof",
    "BoundingDop",
    "Centers",
    "CentersCertificate",
    "CentersVerdict",
    "CircleCertificate",
    "CircleVerdict",
    "Contour",
    "ConvexBody",
    "ConvexCertificate",
    "ConvexPolygon",
    "ConvexVerdict",
    "Curve",
    "CurveCertificate",
    "CurveComponent",
    "CurveVerdict",
    "DopCertificate",
    "DopVerdict",
    "EllipseCertificate",
    "EllipseVerdict",
    "Ellipsoid",
    "EllipsoidCertificate",
    "EllipsoidVerdict",
    "FarthestFirst",
    "FileSolution",
    "FileVerdict",
    "Hull",
    "InscribedBodies",
    "InscribedCertificate",
    "InscribedCircle",
    "InscribedEllipse",
    "InscribedEllipsoid",
    "InscribedOrientedRectangle",
    "InscribedRectangle",
    "InscribedTriangle",
    "InscribedVerdict",
    "KernelBall",
    "KernelBallCertificate",
    "KernelBallVerdict",
    "MebClassifier",
    "Order",
    "OrderCertificate",
    "OrderVerdict",
    "OrientedRectangleCertificate",
    "OrientedRectangleVerdict",
    "PassBounds",
    "Raster",
    "RectangleCertificate",
    "RectangleVerdict",
    "RobustCertificate",
    "RobustEllipsoid",
    "RobustVerdict",
    "Solution",
    "SphereSearch",
    "SphereTree",
    "Surface",
    "SurfaceCertificate",
    "SurfaceComponent",
    "SurfaceVerdict",
    "Svdd",
    "Tile",
    "Tiles",
    "Trace",
    "TriangleCertificate",
    "TriangleVerdict",
    "Triangulation",
    "TriangulationCertificate",
    "TriangulationVerdict",
    "Verdict",
    "Violation",
    "VoronoiCell",
    "__version__",
    "ball",
    "ball_of_balls",
    "bounding_dop",
    "centers",
    "contours",
    "curve",
    "delaunay",
    "delaunay_tiles",
    "ellipsoid",
    "ellipsoids",
    "farthest_first",
    "generate",
    "inscribe",
    "inscribed_bodies",
    "inscribed_circle",
    "inscribed_dops",
    "inscribed_ellipse",
    "inscribed_ellipsoid",
    "inscribed_oriented_rectangle",
    "inscribed_polygon",
    "inscribed_rectangle",
    "inscribed_triangle",
    "kernel_ball",
    "raster",
    "read_points",
    "robust_ellipsoid",
    "sample",
    "sort_file",
    "spatial_order",
    "sphere_tree",
    "surface",
    "transpose_file",
    "triangle_rows",
    "verify",
    "write_mesh",
]


def __getattr__(name: str) -> Any:
    """The estimators, which are loaded with their first use: they stand on those of scikit-learn where it is installed."""
    if name in ("MebClassifier", "Svdd"):
        from . import _classify

        return getattr(_classify, name)
    raise AttributeError(f"module 'taut' has no attribute {name!r}")
