"""Balls in the feature space of a kernel, what proves them, and what a checker says of them."""

from __future__ import annotations

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record, value


@record("kernel", "squared_radius", "support")
class KernelBall(Record):
    """A ball in the feature space of a kernel, with the center sum(multipliers[i] * phi(points[support[i]])).

    Attributes
    ----------
    kernel : str
        ``"gaussian"``, ``"polynomial"``, ``"linear"`` or ``"precomputed"``.
    gamma, offset : float or None
        Parameters of the kernel, where it has them.
    degree : int or None
        The degree of a polynomial kernel.
    nu : float or None
        The share of points that a soft ball may leave outside.
    support : ndarray of int64, shape (k,)
        Rows with a multiplier, ascending. Read-only.
    multipliers : ndarray of float64, shape (k,)
        Their multipliers, which sum to 1. Read-only.
    squared_radius : float
        The squared radius.
    """

    kernel: str = value("kernel.name")
    gamma: float | None = value("kernel.gamma")
    offset: float | None = value("kernel.offset")
    degree: int | None = value("kernel.degree")
    nu: float | None
    support: RowNumbers = column(ROW)
    multipliers: Floats = column(FLOAT)
    squared_radius: float


@record("gap")
class KernelBallCertificate(Record):
    """What is claimed of a ball of a kernel; its multipliers are the proof.

    Attributes
    ----------
    gap : float
        The gap claimed: the objective is at most (1 + gap) times its minimum.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    gap: float
    points_hash: str


@record("lower", "upper", "gap", "outside")
class KernelBallVerdict(Record):
    """What the checker proved of a ball of a kernel; a precomputed kernel is taken as positive semidefinite.

    Attributes
    ----------
    lower : float
        No ball has a smaller objective: the squared radius where all points are inside.
    upper : float
        The objective of the answer is at most this.
    gap : float
        upper / lower - 1, rounded up.
    outside : int
        Points that are outside for certain.
    """

    lower: float
    upper: float
    gap: float
    outside: int
