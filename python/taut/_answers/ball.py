"""Smallest enclosing balls, what proves them, and what a checker says of them."""

from __future__ import annotations

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record, table


@record("radius", "center")
class Ball(Record):
    """A ball in d dimensions.

    Attributes
    ----------
    center : ndarray of shape (d,)
        The center, rounded to float64. Read-only.
    center_tail : ndarray of shape (d,)
        What is to be added to `center` for the exact center: zeros, unless the points lie so far from the origin
        that the rounding would cost more than 1e-15 of the radius. Read-only.
    radius : float
        The radius.
    """

    center: Floats = column(FLOAT)
    center_tail: Floats = column(FLOAT, zeros_like="center")
    radius: float


@record("gap", "items", "support")
class BallCertificate(Record):
    """Convex multipliers over few rows: the proof that no much smaller ball exists.

    Attributes
    ----------
    items : str
        ``"points"``, ``"balls"`` or ``"ellipsoids"``.
    support : ndarray of int64, shape (s,)
        Row numbers with a positive multiplier, ascending; an ellipsoid that touches in several points occurs several
        times. Read-only.
    multipliers : ndarray of float64, shape (s,)
        The multipliers, in the order of `support`; they sum to 1. Read-only.
    directions : ndarray of float64, shape (s, d) or (0, d)
        For ellipsoids {m + v : v v.T <= S}, directions a in which they touch: at m + S a / sqrt(a S a). Read-only.
    gap : float
        The gap claimed: radius <= (1 + gap) R*.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    items: str
    support: RowNumbers = column(ROW)
    multipliers: Floats = column(FLOAT)
    directions: Floats = table(FLOAT, "within.answer.center")
    gap: float
    points_hash: str


@record("lower", "upper", "gap")
class Verdict(Record):
    """What the checker proved.

    Attributes
    ----------
    lower : float
        No enclosing shape is smaller than this.
    upper : float
        The size of the answer, which was found to enclose every point.
    gap : float
        ``upper / lower - 1``, rounded up; 0 where both are 0.
    """

    lower: float
    upper: float
    gap: float
