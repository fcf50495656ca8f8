"""Largest ellipses in polygons, what proves them, and what a checker says of them."""

from __future__ import annotations

from collections.abc import Iterable

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record, table, value


def _leaves(found: Iterable[Iterable[int]]) -> tuple[tuple[int, ...], ...]:
    return tuple(tuple(int(number) for number in leaf) for leaf in found)


def _root(found: Iterable[int]) -> tuple[int, ...]:
    return tuple(int(exponent) for exponent in found)


def _directions(found: Iterable[Iterable[float]]) -> tuple[tuple[float, ...], ...]:
    return tuple(tuple(float(number) for number in direction) for direction in found)


@record("area", "center")
class InscribedEllipse(Record):
    """An ellipse {c + G z : |z| <= 1} in a polygon.

    Attributes
    ----------
    center : ndarray of shape (2,)
        The center c. Read-only.
    axes : ndarray of shape (2, 2)
        G. Read-only.
    area : float
        The area, pi times the determinant of G.
    """

    center: Floats = column(FLOAT)
    axes: Floats = table(FLOAT, "center")
    area: float


@record("gap", "touching")
class EllipseCertificate(Record):
    """A subdivision of all shapes and centers: the proof that no ellipse in the polygon is much larger.

    Attributes
    ----------
    touching : ndarray of int64, shape (t,)
        Rows at which the edges begin that the ellipse touches, ascending. Read-only.
    root : tuple of int
        Exponents of two that bound the shapes.
    directions : tuple of pairs of float
        Directions in which the width of the polygon bounds ellipses.
    tree : str
        The cells, depth first: ``s``, ``t``, ``x`` and ``y`` are split, ``f`` gets centers, ``n`` is bounded by widths, ``o`` is
        outside, ``b`` has a bound in `leaves`.
    leaves : tuple of tuples of int
        For each ``b`` edges and whole weights, ``(edge, weight, edge, weight, ...)``, or one edge alone.
    gap : float
        The gap claimed: largest area <= (1 + gap) * area.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    touching: RowNumbers = column(ROW)
    root: tuple[int, ...] = value(by=_root)
    directions: tuple[tuple[float, ...], ...] = value(by=_directions)
    tree: str
    leaves: tuple[tuple[int, ...], ...] = value(by=_leaves)
    gap: float
    points_hash: str


@record("lower", "upper", "gap")
class EllipseVerdict(Record):
    """What the checker proved of an inscribed ellipse.

    Attributes
    ----------
    lower : float
        The area of the answer, rounded down: its center is inside by the even-odd rule, and no edge enters it.
    upper : float
        No such ellipse has an area above this.
    gap : float
        ``upper / lower - 1``, rounded up.
    """

    lower: float
    upper: float
    gap: float
