"""Convex polygons in polygons, what proves them, and what a checker says of them."""

from __future__ import annotations

from .._record import FLOAT, Floats, Record, column, one, record, table
from .ellipse import EllipseCertificate, InscribedEllipse


@record("area", "vertices")
class ConvexPolygon(Record):
    """A convex polygon in a polygon.

    Attributes
    ----------
    vertices : ndarray of shape (m, 2)
        The corners, counterclockwise. Read-only.
    area : float
        The area.
    """

    vertices: Floats = table(FLOAT, 2)
    area: float


@record("gap", "inside")
class ConvexCertificate(Record):
    """The proof that a convex polygon is inside, and that no other is much larger.

    Attributes
    ----------
    inside : ndarray of shape (2,)
        A point inside the convex polygon. Read-only.
    ellipse : InscribedEllipse
        An ellipse in the outer polygon; the largest one bounds convex polygons.
    ellipse_certificate : EllipseCertificate
        The proof of the ellipse.
    gap : float
        The gap claimed: largest area <= (1 + gap) * area.
    """

    inside: Floats = column(FLOAT)
    ellipse: InscribedEllipse = one(InscribedEllipse)
    ellipse_certificate: EllipseCertificate = one(EllipseCertificate)
    gap: float


@record("lower", "upper", "gap")
class ConvexVerdict(Record):
    """What the checker proved of a convex polygon.

    Attributes
    ----------
    lower : float
        The area of the answer, rounded down: it is convex and inside, and no edge enters it.
    upper : float
        No convex set inside has an area above this.
    gap : float
        ``upper / lower - 1``, rounded up.
    """

    lower: float
    upper: float
    gap: float
