"""Ellipsoids of largest volume inside, what proves them, and what a checker says of them."""

from __future__ import annotations

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record, table


@record("log_volume", "center")
class InscribedEllipsoid(Record):
    """An ellipsoid {c + G z : |z| <= 1} inside a polytope.

    Attributes
    ----------
    center : ndarray of shape (d,)
        The center c. Read-only.
    axes : ndarray of shape (d, d)
        G. Read-only.
    log_volume : float
        Natural logarithm of the volume.
    """

    center: Floats = column(FLOAT)
    axes: Floats = table(FLOAT, "center")
    log_volume: float


@record("gap", "support")
class InscribedCertificate(Record):
    """Multipliers over few half-spaces: the proof that no ellipsoid of much larger volume fits.

    Attributes
    ----------
    support : ndarray of int64, shape (s,)
        Row numbers with a positive multiplier, ascending. Read-only.
    multipliers : ndarray of float64, shape (s,)
        The multipliers, in the order of `support`. Read-only.
    gap : float
        The gap claimed: largest log-volume <= log_volume + gap.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    support: RowNumbers = column(ROW)
    multipliers: Floats = column(FLOAT)
    gap: float
    points_hash: str


@record("lower", "upper", "gap")
class InscribedVerdict(Record):
    """What the checker proved of an inscribed ellipsoid.

    Attributes
    ----------
    lower : float
        Log-volume of the answer, which was found to lie in every half-space.
    upper : float
        No ellipsoid in the polytope has a log-volume above this.
    gap : float
        ``upper - lower``, rounded up.
    """

    lower: float
    upper: float
    gap: float
