"""Delaunay triangulations, what ties them to their points, and what a checker says."""

from __future__ import annotations

from .._record import SIMPLEX_ID, Record, SimplexIds, record, table, value


@record("dimension", "simplices", "hull")
class Triangulation(Record):
    """The Delaunay triangulation of a point set. Ids are rows of the points, from 0.

    Attributes
    ----------
    dimension : int
        Dimension of the points, 2 or 3.
    hull_dimension : int or None
        Dimension of the affine hull of the points: less where all are on a plane, on a line or equal. None for no
        points.
    simplices : ndarray of int32, shape (m, k + 1)
        Vertices of the simplices, positively oriented; k is `hull_dimension`. Read-only.
    neighbors : ndarray of int32, shape (m, k + 1)
        For each vertex the simplex across the facet opposite it; -1 on the hull. Read-only.
    hull : ndarray of int32, shape (h, k)
        The facets of the convex hull, turned outward. Read-only.
    duplicates : ndarray of int32, shape (c, 2)
        Rows that equal an earlier row, each with the first row it equals. Read-only.
    """

    dimension: int
    hull_dimension: int | None
    simplices: SimplexIds = table(SIMPLEX_ID, None)
    neighbors: SimplexIds = table(SIMPLEX_ID, "simplices", at="within.certificate.neighbors")
    hull: SimplexIds = table(SIMPLEX_ID, None)
    duplicates: SimplexIds = table(SIMPLEX_ID, 2)


@record("sites", "fingerprint")
class TriangulationCertificate(Record):
    """What ties a triangulation to its points, and makes its check one linear pass.

    Attributes
    ----------
    fingerprint : str
        A hash of the set of simplices and their coordinates, whatever their order.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    sites : int
        Distinct points.
    """

    fingerprint: str
    points_hash: str
    sites: int = value("counts.sites")


@record("sites", "simplices", "hull", "ties")
class TriangulationVerdict(Record):
    """What the checker proved: these simplices are the Delaunay triangulation, and there is no other.

    Attributes
    ----------
    sites, simplices, hull : int
        Distinct points, simplices, and facets of the convex hull.
    ties : int
        Facets whose two simplices lie on one sphere, so that the perturbation decided between them.
    refined : int
        Signs that double precision left open, decided exactly.
    fingerprint : str
        The hash of the simplices.
    """

    sites: int = value("counts.sites")
    simplices: int = value("counts.simplices")
    hull: int = value("counts.hull")
    ties: int
    refined: int
    fingerprint: str
