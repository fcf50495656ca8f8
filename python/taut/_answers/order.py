"""Points in the order of a curve, what they belong to, and what a checker says."""

from __future__ import annotations

from .._record import ROW, Record, RowNumbers, column, record


@record("curve", "rows")
class Order(Record):
    """The rows of points along a curve.

    Attributes
    ----------
    curve : str
        ``"hilbert"`` or ``"morton"``.
    rows : ndarray of int64, shape (n,)
        Row numbers in order: ``points[rows]`` are the points along the curve. Read-only.
    """

    curve: str
    rows: RowNumbers = column(ROW)


@record("points_hash")
class OrderCertificate(Record):
    """What an order belongs to; it is a function of the points alone, and is proved from these.

    Attributes
    ----------
    points_hash : str
        Hash of the points this was made for, 16 hexadecimal digits.
    """

    points_hash: str


@record("points", "grids")
class OrderVerdict(Record):
    """What was proved of an order: it is the one that the points have.

    Attributes
    ----------
    points : int
        Points.
    grids : int
        Grids that were laid over the points and, within cells of many, again.
    """

    points: int
    grids: int
