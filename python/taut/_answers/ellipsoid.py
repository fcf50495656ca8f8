"""Ellipsoids of least volume, what proves them, and what a checker says of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _native
from .._arrays import as_rows
from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, one, record, table


@record("basis", "distance")
class Hull(Record):
    """The affine subspace c + z @ basis in which flat points lie, but for rounding.

    Attributes
    ----------
    basis : ndarray of shape (r, d)
        Orthonormal rows. Read-only.
    distance : float
        No point lies farther than this from the subspace.
    """

    basis: Floats = table(FLOAT, "within.center")
    distance: float


@record("log_volume", "rank", "center")
class Ellipsoid(Record):
    """An ellipsoid {x : |F(x - c)| <= 1} in d dimensions, or in an affine subspace of dimension r < d.

    Attributes
    ----------
    center : ndarray of shape (d,)
        The center c, rounded to float64. Read-only.
    center_tail : ndarray of shape (d,)
        What is to be added to `center` for the exact center: zeros, unless the points lie so far from the origin
        that the rounding would cost more than rounding the rest. Read-only.
    matrix : ndarray of shape (d, d)
        Q = F.T @ F, symmetric: (x - c) @ Q @ (x - c) <= 1. Of rank r. Read-only.
    factor : ndarray of shape (r, d)
        F, which tells inside from outside more sharply than `matrix` where the axes differ much. Read-only.
    hull : Hull or None
        The affine subspace in which the points lie; None where they span the space, so that r = d.
    log_volume : float
        Natural logarithm of the volume, of dimension r; 0 for a single point.
    rank : int
        r, the dimension of the ellipsoid itself.
    """

    center: Floats = column(FLOAT)
    center_tail: Floats = column(FLOAT, zeros_like="center")
    matrix: Floats = table(FLOAT, "center")
    factor: Floats = table(FLOAT, "center")
    hull: Hull | None = one(Hull)
    log_volume: float

    @property
    def rank(self) -> int:
        return len(self.factor)

    def norm(self, points: ArrayLike) -> Floats:
        """|F(x - c)| of each point: at most 1 inside, but for rounding.

        Of points in a flat the distance from `hull` is not looked at. Ctrl-C stops the work.

        Parameters
        ----------
        points : array_like of shape (n, d)
            Any points, converted as by `ellipsoid`.

        Returns
        -------
        ndarray of shape (n,)

        Examples
        --------
        >>> import taut
        >>> disc = taut.ellipsoid([[0, 0], [2, 0], [2, 2], [0, 2]]).answer
        >>> disc.norm([[1, 1], [3, 1], [1, 1.5]]).round(8)
        array([0.        , 1.41421356, 0.35355339])
        """
        center, tail, factor = (part.tolist() for part in (self.center, self.center_tail, self.factor))
        return _native.norms(as_rows(points), center, tail, factor)

    def contains(self, points: ArrayLike, *, tolerance: float = 1e-9) -> NDArray[np.bool_]:
        """For each point whether it is in the ellipsoid or on its border, to a tolerance.

        All points that the ellipsoid was found for are: the tolerance is far above what ``check`` grants for rounding. Points
        off the hull of a flat ellipsoid are outside.

        Parameters
        ----------
        points : array_like of shape (n, d)
            Any points, converted as by `ellipsoid`.
        tolerance : float, default 1e-9
            By how much `norm` may exceed 1, and for a flat ellipsoid the distance from the hull that of its points, in units of
            their largest coordinate.

        Returns
        -------
        ndarray of bool, shape (n,)

        Examples
        --------
        >>> import taut
        >>> points = taut.generate("normal", 1000, 3)
        >>> found = taut.ellipsoid(points).answer
        >>> bool(found.contains(points).all()), found.contains([[9, 9, 9]])
        (True, array([False]))
        """
        rows = as_rows(points)
        is_inside = self.norm(rows) <= 1 + tolerance
        if self.hull is not None:
            is_inside &= ~self._is_off_hull(rows, tolerance)
        return is_inside

    def _is_off_hull(self, points: ArrayLike, tolerance: float) -> NDArray[np.bool_]:
        """For each point whether it is farther from the hull than the points of the ellipsoid, and than rounding."""
        if self.hull is None:
            return np.zeros(len(as_rows(points)), dtype=bool)
        offsets = (as_rows(points) - self.center) - self.center_tail
        off = offsets - offsets @ self.hull.basis.T @ self.hull.basis
        distances = np.sqrt(np.square(off).sum(axis=1))
        size = np.abs(self.center).max(initial=0.0) + np.abs(offsets).max(axis=1, initial=0.0)
        is_off: NDArray[np.bool_] = distances > self.hull.distance + tolerance * size
        return is_off


@record("gap", "items", "support")
class EllipsoidCertificate(Record):
    """Convex multipliers over few rows: the proof that no ellipsoid of much smaller volume exists.

    Attributes
    ----------
    items : str
        ``"points"``, ``"balls"`` or ``"ellipsoids"``.
    support : ndarray of int64, shape (s,)
        Row numbers with a positive multiplier, ascending; a ball or an ellipsoid that touches in several points
        occurs several times. Read-only.
    multipliers : ndarray of float64, shape (s,)
        The multipliers, in the order of `support`; they sum to 1. Read-only.
    directions : ndarray of float64, shape (s, d) or (0, d)
        For balls and ellipsoids {m + v : v v.T <= S}, directions a in which they touch: at m + S a / sqrt(a S a).
        Read-only.
    left_out : ndarray of int64, shape (l,)
        Row numbers that the ellipsoid leaves out, ascending; the rest is enclosed. Read-only.
    gap : float
        The gap claimed: log_volume <= least log-volume + gap.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    items: str
    support: RowNumbers = column(ROW)
    multipliers: Floats = column(FLOAT)
    directions: Floats = table(FLOAT, "within.answer.center")
    left_out: RowNumbers = column(ROW)
    gap: float
    points_hash: str


@record("lower", "upper", "gap", "rank")
class EllipsoidVerdict(Record):
    """What the checker proved of an ellipsoid.

    Attributes
    ----------
    lower : float
        No enclosing ellipsoid has a log-volume below this.
    upper : float
        Log-volume of the answer, enlarged by `excess` so that it encloses every row.
    gap : float
        ``upper - lower``, rounded up.
    excess : float
        By how much |F(x - c)| exceeds 1 at worst, rounded up; 0 when every row is inside without any tolerance.
    matrix_excess : float
        By how much (x - c) @ Q @ (x - c) can exceed 1 at worst, Q being `matrix` as it stands.
    off_hull : float
        No row is farther than this from the flat of a flat set, rounded up; 0 where there is no flat.
    rank : int
        The dimension of the ellipsoid itself.
    """

    lower: float
    upper: float
    gap: float
    excess: float
    matrix_excess: float
    off_hull: float
    rank: int
