"""Surfaces through points of space, what is claimed of them, and what a checker says."""

from __future__ import annotations

from .._record import FLOAT, ID, ROW, Floats, Ids, Record, RowNumbers, column, each, record, table, value


@record("triangles", "genus", "boundary_loops")
class SurfaceComponent(Record):
    """A connected part of a surface.

    Attributes
    ----------
    first_triangle : int
        Its first triangle.
    vertices, edges, triangles : int
        How many it has.
    boundary_loops : int
        Its boundary loops; 0 of a closed part.
    orientable : bool
        Whether it has two sides.
    genus : int or None
        Handles, or cross-caps of a part with one side; None of what is no surface.
    """

    first_triangle: int
    vertices: int
    edges: int
    triangles: int
    boundary_loops: int
    orientable: bool
    genus: int | None


@record("triangles", "components", "genus", "boundary_loops")
class Surface(Record):
    """A surface through points of space: triangles between the rows.

    Attributes
    ----------
    triangles : ndarray of uint32, shape (m, 3)
        The rows at the corners of each triangle, counter-clockwise seen from outside. Of equal rows the first stands
        for all. Read-only.
    vertices : ndarray of float64, shape (n, 3), or None
        Where points were moved, the place of each row; None where every vertex is where its row is. Read-only.
    components : tuple of SurfaceComponent
        The connected parts.
    genus : int or None
        Handles of all parts together; None if one of them is not a surface with two sides.
    boundary_loops : int
        Loops of edges with one triangle.
    boundary_edges, non_manifold_edges, non_manifold_vertices, inconsistent_edges : int
        Edges of one triangle, edges of more than two, vertices whose triangles are not one fan, and edges whose two
        triangles run along them in the same direction. Of a closed surface all are 0.
    euler_characteristic : int
        Vertices less edges plus triangles.
    duplicates : ndarray of uint32, shape (c, 2)
        Rows that equal an earlier one, each with the first that it equals. Read-only.
    outliers, interior, unreferenced : ndarray of uint32
        The other rows that no triangle has: those left out from the beginning, those inside closed parts, and all
        others. Read-only.
    """

    triangles: Ids = table(ID, 3)
    vertices: Floats | None = table(FLOAT, 3, optional=True)
    components: tuple[SurfaceComponent, ...] = each(SurfaceComponent, at="topology.components")
    genus: int | None = value("topology.genus")
    boundary_loops: int = value("topology.boundary_loops")
    boundary_edges: int = value("topology.boundary_edges")
    non_manifold_edges: int = value("topology.non_manifold_edges")
    non_manifold_vertices: int = value("topology.non_manifold_vertices")
    inconsistent_edges: int = value("topology.inconsistent_edges")
    euler_characteristic: int = value("topology.euler_characteristic")
    duplicates: Ids = table(ID, 2, at="unused.duplicates")
    outliers: Ids = column(ID, at="unused.outliers")
    interior: Ids = column(ID, at="unused.interior")
    unreferenced: Ids = column(ID, at="unused.unreferenced")


@record("method", "embedded", "outward")
class SurfaceCertificate(Record):
    """What is claimed of a surface, beside its topology.

    Attributes
    ----------
    method : str
        How it was found.
    apexes : ndarray of int64, shape (m,)
        For each triangle what shows that it is a Delaunay triangle: a row such that no point is inside the sphere
        through it and the triangle; -1 for a facet of the convex hull, -2 where the smallest sphere through the
        triangle is empty. Read-only.
    embedded : bool
        Whether it meets itself nowhere.
    outward : bool
        Whether closed parts face outwards, or inwards if they are inside others.
    displacement : float
        The largest distance of a vertex from its row.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    method: str
    apexes: RowNumbers = column(ROW)
    embedded: bool
    outward: bool
    displacement: float
    points_hash: str


@record("certified", "closed", "displacement", "outliers", "rows")
class SurfaceVerdict(Record):
    """What the checker proved of a surface.

    Attributes
    ----------
    rows, outliers : int
        How many rows there are, and how many of them were left out as outliers: nothing is claimed of these.
    triangles, vertices, components, boundary_loops : int
        How many there are.
    genus : int or None
        Handles of all parts together; None if one of them is not a surface with two sides.
    closed, manifold, oriented, embedded, delaunay, outward : bool
        Whether it has no boundary; whether each edge has at most two triangles and each vertex one fan; whether
        triangles agree about sides; whether it meets itself nowhere; whether each triangle has an empty ball; whether
        closed parts face outwards.
    displacement : float
        The largest distance of a vertex from its row, rounded up.
    sound : bool
        Whether it is an oriented manifold of Delaunay triangles that meets itself nowhere and faces outwards: proved.
    confident : bool
        Whether the method named no place where handles or parts are in doubt: evidence, with the error rates of the page on
        surfaces.
    certified : bool
        Whether it is both.
    doubt : str or None
        Where it is not, the first reason.
    """

    rows: int
    outliers: int
    triangles: int
    vertices: int
    components: int
    boundary_loops: int
    genus: int | None
    closed: bool = value("is_closed")
    manifold: bool = value("is_manifold")
    oriented: bool = value("is_oriented")
    embedded: bool = value("is_embedded")
    delaunay: bool = value("is_delaunay")
    outward: bool = value("is_outward")
    displacement: float
    sound: bool = value("is_sound")
    confident: bool = value("is_confident")
    certified: bool
    doubt: str | None
