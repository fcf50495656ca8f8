"""Largest circles in polygons, what proves them, and what a checker says of them."""

from __future__ import annotations

from collections.abc import Iterable

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record, value


def _leaves(found: Iterable[Iterable[int]]) -> tuple[tuple[int, ...], ...]:
    return tuple(tuple(int(number) for number in leaf) for leaf in found)


@record("radius", "center")
class InscribedCircle(Record):
    """A circle in a polygon.

    Attributes
    ----------
    center : ndarray of shape (2,)
        The center. Read-only.
    radius : float
        The radius.
    """

    center: Floats = column(FLOAT)
    radius: float


@record("gap", "touching")
class CircleCertificate(Record):
    """A subdivision of the bounding box: the proof that no circle in the polygon is much larger.

    Attributes
    ----------
    touching : ndarray of int64, shape (t,)
        Rows at which the edges begin that the circle touches, ascending. Read-only.
    tree : str
        The cells, depth first: ``x`` and ``y`` are split, ``o`` is outside, ``b`` has a bound in `leaves`.
    leaves : tuple of tuples of int
        For each ``b`` edges and whole weights, ``(edge, weight, edge, weight, ...)``, or one edge alone.
    gap : float
        The gap claimed: largest radius <= (1 + gap) * radius.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    touching: RowNumbers = column(ROW)
    tree: str
    leaves: tuple[tuple[int, ...], ...] = value(by=_leaves)
    gap: float
    points_hash: str


@record("lower", "upper", "gap")
class CircleVerdict(Record):
    """What the checker proved of an inscribed circle.

    Attributes
    ----------
    lower : float
        The radius of the answer: its center is inside by the even-odd rule, and no edge enters it.
    upper : float
        No such circle has a radius above this.
    gap : float
        ``upper / lower - 1``, rounded up.
    """

    lower: float
    upper: float
    gap: float
