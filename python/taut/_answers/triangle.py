"""Largest triangles in polygons, what proves them, and what a checker says of them."""

from __future__ import annotations

from collections.abc import Iterable

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record, table, value


def _leaves(found: Iterable[Iterable[int]]) -> tuple[tuple[int, ...], ...]:
    return tuple(tuple(int(number) for number in leaf) for leaf in found)


@record("area", "corners")
class InscribedTriangle(Record):
    """A triangle in a polygon.

    Attributes
    ----------
    corners : ndarray of shape (3, 2)
        The corners, counterclockwise. Read-only.
    area : float
        The area.
    """

    corners: Floats = table(FLOAT, 2)
    area: float


@record("gap", "touching")
class TriangleCertificate(Record):
    """A subdivision of all positions of the corners: the proof that no triangle in the polygon is much larger.

    Attributes
    ----------
    touching : ndarray of int64, shape (t,)
        Rows at which the edges begin that the triangle touches, ascending. Read-only.
    skew : float
        The skew of the coordinates in which the subdivision is done.
    root : ndarray of shape (2, 2)
        The lower and the upper corner of the box that holds the polygon in these coordinates. Read-only.
    tree : str
        The cells, depth first: digits are split, ``l``, ``o``, ``c`` and ``e`` hold no triangle inside, ``a`` and ``b`` have a bound.
    leaves : tuple of tuples of int
        For each ``e`` a point of an edge, for each ``b`` conditions with whole weights.
    gap : float
        The gap claimed: largest area <= (1 + gap) * area.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    touching: RowNumbers = column(ROW)
    skew: float
    root: Floats = table(FLOAT, 2)
    tree: str
    leaves: tuple[tuple[int, ...], ...] = value(by=_leaves)
    gap: float
    points_hash: str


@record("lower", "upper", "gap")
class TriangleVerdict(Record):
    """What the checker proved of an inscribed triangle.

    Attributes
    ----------
    lower : float
        The area of the answer, rounded down: it lies in the polygon by the even-odd rule.
    upper : float
        No such triangle has an area above this.
    gap : float
        ``upper / lower - 1``, rounded up.
    """

    lower: float
    upper: float
    gap: float
