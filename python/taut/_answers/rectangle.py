"""Largest rectangles in polygons, what proves them, and what a checker says of them."""

from __future__ import annotations

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record


@record("area", "low", "high")
class InscribedRectangle(Record):
    """A rectangle with sides along the axes in a polygon.

    Attributes
    ----------
    low : ndarray of shape (2,)
        The lower left corner. Read-only.
    high : ndarray of shape (2,)
        The upper right corner. Read-only.
    area : float
        The area.
    """

    low: Floats = column(FLOAT)
    high: Floats = column(FLOAT)
    area: float


@record("gap", "edges")
class RectangleCertificate(Record):
    """A subdivision of all pairs of corners: the proof that no rectangle along the axes is much larger.

    Attributes
    ----------
    tree : str
        The cells, depth first: ``l``, ``b``, ``r`` and ``t`` are split, ``m`` is bounded by its hull, ``e`` has an edge in its core,
        ``1`` to ``4`` have that corner outside.
    edges : ndarray of int64, shape (e,)
        For each ``e`` the row at which the edge begins. Read-only.
    gap : float
        The gap claimed: largest area <= (1 + gap) * area.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    tree: str
    edges: RowNumbers = column(ROW)
    gap: float
    points_hash: str


@record("lower", "upper", "gap")
class RectangleVerdict(Record):
    """What the checker proved of an inscribed rectangle.

    Attributes
    ----------
    lower : float
        The area of the answer, rounded down: it is inside by the even-odd rule, and no edge enters it.
    upper : float
        No rectangle along the axes inside has an area above this.
    gap : float
        ``upper / lower - 1``, rounded up.
    """

    lower: float
    upper: float
    gap: float
