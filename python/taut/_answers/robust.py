"""Robust ellipsoids, what they are made of, and what a checker says of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from .._arrays import as_rows
from .._record import FLOAT, ITSELF, ROW, Floats, Record, RowNumbers, column, one, record, table, value
from .ellipsoid import Ellipsoid, EllipsoidVerdict, Hull


@record("log_det", "outliers", "center")
class RobustEllipsoid(Record):
    """Center and scatter of most of the points, the ellipsoid they mean, and the points that lie outside of it.

    Attributes
    ----------
    center : ndarray of shape (d,)
        The center c. Read-only.
    scatter : ndarray of shape (d, d)
        S: for normal points an estimate of their covariance. Read-only.
    log_det : float
        ln det S; of dimension r where `hull` is given.
    outliers : ndarray of int64, shape (k,)
        Row numbers outside the ellipsoid or off the hull, ascending. Read-only.
    ellipsoid : Ellipsoid
        By "mcd" and "mve" the tolerance ellipsoid, by "trim" the smallest around the points kept.
    matrix, factor, hull, log_volume, rank
        Those of `ellipsoid`, for short. Where `hull` is not None, most points lie in it exactly.
    """

    scatter: Floats = table(FLOAT, "center")
    log_det: float
    outliers: RowNumbers = column(ROW)
    ellipsoid: Ellipsoid = one(Ellipsoid, at=ITSELF)

    @property
    def center(self) -> Floats:
        return self.ellipsoid.center

    @property
    def matrix(self) -> Floats:
        return self.ellipsoid.matrix

    @property
    def factor(self) -> Floats:
        return self.ellipsoid.factor

    @property
    def hull(self) -> Hull | None:
        return self.ellipsoid.hull

    @property
    def log_volume(self) -> float:
        return self.ellipsoid.log_volume

    @property
    def rank(self) -> int:
        return self.ellipsoid.rank

    def distances(self, points: ArrayLike) -> Floats:
        """The Mahalanobis distance of each point, sqrt((x - c) @ inverse(S) @ (x - c)); infinite off the hull where there is one.

        Parameters
        ----------
        points : array_like of shape (n, d)
            Any points, converted as by `robust_ellipsoid`.

        Returns
        -------
        ndarray of shape (n,)

        Examples
        --------
        >>> import numpy as np
        >>> import taut
        >>> points = taut.generate("normal", 1000, 2)
        >>> found = taut.robust_ellipsoid(points)
        >>> cutoff = found.certificate.cutoff
        >>> np.flatnonzero(found.answer.distances(points) ** 2 > cutoff).tolist() == found.answer.outliers.tolist()
        True
        """
        rows = as_rows(points)
        norms = self.ellipsoid.norm(rows)
        if self.rank > 0:
            # F S F' is one over the square of the border, times the identity.
            border = self.rank / np.trace(self.factor @ self.scatter @ self.factor.T)
            norms = norms * np.sqrt(border)
        norms[self.ellipsoid._is_off_hull(rows, 1e-12)] = np.inf
        return norms


@record("method", "kept", "objective")
class RobustCertificate(Record):
    """What a robust ellipsoid is made of, so that all of it can be calculated again from the points.

    Attributes
    ----------
    method : str
        ``"mcd"``, ``"mve"`` or ``"trim"``.
    kept : int
        h, how many points were asked for.
    left_out : ndarray of int64, shape (l,)
        Row numbers not among them, ascending. Read-only.
    objective : float
        What was minimized, reached: ln det of the covariance of the points kept, or the log-volume around them.
    level : float
        The part of normal points that the tolerance ellipsoid holds; 1 by "trim".
    cutoff : float
        The quantile of chi-squared at `level`; 0 by "trim".
    raw_scale, scale : float
        By what the scatter of the points kept, and the covariance of those not weighed out, is multiplied.
    scaled_by : str
        ``"share"`` or ``"level"``: the part that `scale` is of.
    weighed_out : ndarray of int64, shape (w,)
        Row numbers beyond `cutoff` in the metric of the points kept, ascending. Read-only.
    gap : float or None
        By "mve" and "trim", the gap in log-volume of the ellipsoid around the points kept.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    method: str
    kept: int
    left_out: RowNumbers = column(ROW)
    objective: float
    level: float
    cutoff: float
    raw_scale: float
    scale: float
    scaled_by: str = value(by=lambda found: found or "share")
    weighed_out: RowNumbers = column(ROW)
    gap: float | None = value("enclosure.certificate.gap")
    points_hash: str


@record("objective", "on_hull", "rank")
class RobustVerdict(Record):
    """What the checker proved of a robust ellipsoid. That no other points kept would do better is not proved.

    Attributes
    ----------
    objective : float
        What the method minimizes, of the points kept, as found here.
    enclosure : EllipsoidVerdict or None
        By "mve" and "trim", what was proved of the ellipsoid around the points kept.
    wanted : int
        h, how many points were to be kept. By "mcd" and "mve" at least half of the points.
    kept : int
        How many are kept: h, and by "mve" and "trim" those that lie on the border besides.
    on_hull : int
        Points on the hull; all of them where there is none.
    flag_excess : float
        By how much a point that is no outlier lies beyond the border, or an outlier within, in units of the border; 0
        where the outliers are exactly the points outside.
    slack : float
        What center, scatter and border may be off by in that unit, where coordinates have few digits for the points.
    reweighted : bool
        Whether center and scatter are those of the points not weighed out.
    rank : int
        The dimension of the ellipsoid itself.
    """

    objective: float
    enclosure: EllipsoidVerdict | None = one(EllipsoidVerdict)
    wanted: int
    kept: int
    on_hull: int
    flag_excess: float
    slack: float
    reweighted: bool
    rank: int
