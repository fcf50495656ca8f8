"""Few centers for many points, what proves them, and what a checker says of them; orders and trees of points."""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _native
from .._arrays import as_rows
from .._record import FLOAT, ID, ROW, Floats, Ids, Record, RowNumbers, column, record, table, value


@record("radius", "lower_bound", "centers")
class Centers(Record):
    """k centers, from one of which each item is at most `radius` away.

    Attributes
    ----------
    centers : ndarray of shape (m, d)
        The centers: k, or fewer where fewer are as good. Read-only.
    rows : ndarray of int64, shape (m,) or (0,)
        For centers among the points the row of each. Read-only.
    radius : float
        The largest distance of a point to the center next to it; times its weight, or with its radius, where it has
        one.
    lower_bound : float
        No k centers have a smaller radius.
    outliers : ndarray of int64, shape (z,)
        Row numbers that are left out, ascending. Read-only.
    assignment : ndarray of uint32, shape (n,), or None
        On request, for each row the number of the center next to it. Read-only.
    """

    centers: Floats = table(FLOAT, None)
    rows: RowNumbers = column(ROW)
    radius: float
    lower_bound: float
    outliers: RowNumbers = column(ROW)
    assignment: Ids | None = column(ID, optional=True)

    def assign(self, points: ArrayLike) -> RowNumbers:
        """The center next to each point, of equally near ones the first.

        Parameters
        ----------
        points : array_like of shape (n, d)
            Any finite points, converted as by `centers`.

        Returns
        -------
        ndarray of int64, shape (n,)

        Examples
        --------
        >>> import taut
        >>> found = taut.centers([[0, 0], [0, 2], [9, 0], [9, 1]], 2).answer
        >>> near, far = found.assign([[1, 1], [7, 0]])
        >>> bool(near != far)
        True
        """
        tree = _native.SearchTree(as_rows(self.centers), "points", None)
        return tree.nearest(as_rows(points), 1, None)[1]


@record("items", "k", "gap", "core_set", "proof")
class CentersCertificate(Record):
    """What was asked, and a few rows that prove the lower bound: no k smaller balls hold them all.

    Attributes
    ----------
    items : str
        ``"points"``, ``"balls"`` or ``"ellipsoids"``.
    weights : bool
        Whether the points have weights.
    group : int or None
        The column, from 0, whose value is the group of a row; None where each row stands for itself.
    discrete : bool
        Whether centers are points of the input.
    k : int
        Most centers.
    outliers : int
        Most rows that may be left out; groups of them, where rows are in groups.
    gap : float
        The gap claimed: radius <= (1 + gap) lower_bound.
    core_set : ndarray of int64, shape (m,)
        Row numbers, those of ellipsoids once for each of their points. Read-only.
    directions : ndarray of shape (m, d) or (0, 0)
        For ellipsoids {m + v : v v.T <= S}, directions a that name points of theirs, m + S a / sqrt(a S a). Read-only.
    proof : str
        ``"apart"`` (no two of the core-set fit in one ball), ``"branches"`` (the checker replays the branches of a
        search) or ``"avoiding"`` (branches, some of them refuted by points that are left out).
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    items: str
    weights: bool = value(by=bool)
    group: int | None
    discrete: bool = value("placement", by=lambda placement: placement == "rows")
    k: int
    outliers: int
    gap: float
    core_set: RowNumbers = column(ROW)
    directions: Floats = table(FLOAT, None)
    proof: str = value("proof.by")
    points_hash: str


@record("lower", "upper", "gap", "nodes")
class CentersVerdict(Record):
    """What the checker proved of centers.

    Attributes
    ----------
    lower : float
        No k centers have a smaller radius.
    upper : float
        The radius of the answer, within which every item that counts was found.
    gap : float
        ``upper / lower - 1``, rounded up; 0 where both are 0.
    nodes : int
        Branches that were replayed to prove the lower bound; 0 where it needs none.
    """

    lower: float
    upper: float
    gap: float
    nodes: int


@record("order", "next")
class FarthestFirst(Record):
    """Points in farthest-first order, and how far the others are from each beginning of it.

    Attributes
    ----------
    order : ndarray of int64, shape (m,)
        Row numbers, each that of the point farthest from all before it; fewer than asked for where all other points
        are copies of these. Read-only.
    radii : ndarray of float64, shape (m,)
        ``radii[k - 1]`` is the largest distance of a point to the nearest of the first k. No k balls of a radius
        below its half hold all points. Read-only.
    next : int or None
        The row that would come next.
    """

    order: RowNumbers = column(ROW)
    radii: Floats = column(FLOAT)
    next: int | None


@record("centers", "order")
class SphereTree(Record):
    """Balls within balls. Node 0 is the root, and each node comes before its children.

    Attributes
    ----------
    centers : ndarray of float64, shape (m, d)
        The center of the ball of each node. Read-only.
    radii : ndarray of float64, shape (m,)
        Its radius. Read-only.
    ranges : ndarray of int64, shape (m, 2)
        The points of node i are the rows ``order[ranges[i, 0]:ranges[i, 1]]``. Read-only.
    children : ndarray of int64, shape (m, 2)
        The two nodes that share its points; -1 for a leaf. Read-only.
    order : ndarray of int64, shape (n,)
        Row numbers, those of each node side by side. Read-only.
    """

    centers: Floats = table(FLOAT, None)
    radii: Floats = column(FLOAT)
    ranges: RowNumbers = table(ROW, 2)
    children: RowNumbers = table(ROW, 2)
    order: RowNumbers = column(ROW)
