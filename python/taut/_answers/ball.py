"""Smallest enclosing balls, what proves them, and what a checker says of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._arrays import as_rows
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

    def distance(self, points: ArrayLike) -> Floats:
        """The distance of each point from the center.

        Rounded: that of a point on the border may exceed `radius` by some units in the last place. To ask what is inside use
        `contains`.

        Parameters
        ----------
        points : array_like of shape (n, d)
            Any points, converted as by `ball`.

        Returns
        -------
        ndarray of shape (n,)

        Examples
        --------
        >>> import taut
        >>> taut.ball([[0, 0], [2, 0]]).answer.distance([[1, 0], [5, 3]])
        array([0., 5.])
        """
        rows = as_rows(points)
        if rows.shape[1] != len(self.center):
            raise ValueError(f"points have dimension {rows.shape[1]}, but the ball has dimension {len(self.center)}")
        offsets = (rows - self.center) - self.center_tail
        largest = np.abs(offsets).max(axis=1, initial=0.0)
        # Divided by the largest coordinate, squares neither overflow nor vanish.
        unit = np.where((largest > 0) & np.isfinite(largest), largest, 1.0)
        distances: Floats = unit * np.sqrt(np.square(offsets / unit[:, None]).sum(axis=1))
        return distances

    def contains(self, points: ArrayLike) -> NDArray[np.bool_]:
        """For each point whether it is in the ball or on its border.

        All points that the ball was found for are: what is farther out by less than the rounding of `distance` counts as within.

        Parameters
        ----------
        points : array_like of shape (n, d)
            Any points, converted as by `ball`; one that is not finite is outside.

        Returns
        -------
        ndarray of bool, shape (n,)

        Examples
        --------
        >>> import taut
        >>> points = taut.generate("normal", 1000, 3)
        >>> found = taut.ball(points).answer
        >>> bool(found.contains(points).all()), found.contains([[9, 9, 9]])
        (True, array([False]))
        """
        # Each term of the sum passes at most d + 6 roundings, and the root halves what they add up to.
        rounding = (len(self.center) + 6) * np.finfo(np.float64).eps
        is_inside: NDArray[np.bool_] = self.distance(points) <= self.radius * (1 + rounding)
        return is_inside


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
