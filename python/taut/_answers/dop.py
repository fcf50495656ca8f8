"""Bounding k-dops, what proves them, and what a checker says of them."""

from __future__ import annotations

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, record, table


@record("volume", "normals")
class BoundingDop(Record):
    """The smallest intersection of half-spaces with given normals around points: all x with ``normals @ x <= offsets``.

    Attributes
    ----------
    normals : ndarray of int64, shape (k, 3)
        The normals, with entries of -1, 0 and 1. Read-only.
    offsets : ndarray of float64, shape (k,)
        For each normal the largest ``normal @ p`` over all points, rounded up. Read-only.
    vertices : ndarray of float64, shape (v, 3)
        The vertices, rounded. Read-only.
    volume : float
        The volume; 0 where the points lie in a plane with one of the normals.
    """

    normals: RowNumbers = table(ROW, 3)
    offsets: Floats = column(FLOAT)
    vertices: Floats = table(FLOAT, 3)
    volume: float


@record("touching")
class DopCertificate(Record):
    """The proof that no facet of a bounding dop can move inward.

    Attributes
    ----------
    touching : ndarray of int64, shape (k,)
        For each facet a row that it touches. Read-only.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    touching: RowNumbers = column(ROW)
    points_hash: str


@record("facets", "volume_lower", "volume_upper")
class DopVerdict(Record):
    """What the checker proved of a bounding dop: it holds all points, and each facet touches one.

    Attributes
    ----------
    facets : int
        How many facets it has, redundant ones among them.
    volume_lower, volume_upper : float
        Bounds of its volume.
    """

    facets: int
    volume_lower: float
    volume_upper: float
