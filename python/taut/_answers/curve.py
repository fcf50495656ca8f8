"""Curves through points of the plane, what is claimed of them, and what a checker says."""

from __future__ import annotations

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, each, record, table, value


@record("closed", "vertices")
class CurveComponent(Record):
    """One connected curve.

    Attributes
    ----------
    vertices : ndarray of float64, shape (m, 2)
        The vertices in order. Read-only.
    closed : bool
        Whether an edge leads from the last vertex back to the first.
    rows : ndarray of int64, shape (m,), or None
        Where vertices are points of the input, the row of each. Read-only.
    """

    vertices: Floats = table(FLOAT, 2)
    closed: bool
    rows: RowNumbers | None = column(ROW, optional=True)


@record("curves", "noise", "outliers")
class Curve(Record):
    """Curves through points of the plane.

    Attributes
    ----------
    curves : tuple of CurveComponent
        The connected curves.
    noise : float
        Half the width of the band around the curves that noise fills, as estimated; 0 where vertices are points.
    outliers : ndarray of int64, shape (z,)
        Row numbers that no curve accounts for, ascending. Read-only.
    places : ndarray of float64, shape (n, 2), or None
        On request, for each row its curve and the position k + t on it: the share t of the edge after vertex k. Of
        outliers the place next to them. Read-only.
    """

    curves: tuple[CurveComponent, ...] = each(CurveComponent)
    noise: float
    outliers: RowNumbers = column(ROW)
    places: Floats | None = table(FLOAT, 2, optional=True)


@record("certified", "band")
class CurveCertificate(Record):
    """What is claimed of curves.

    Attributes
    ----------
    band : float
        No row but the outliers is farther than this from the curves.
    sampling_ratio : float
        The largest of half the gap between samples that follow each other, over the feature size there; the largest
        float where it is not known.
    noise_ratio : float
        The largest distance of a row over the feature size next to it; the largest float where it is not known.
    certified : bool
        Whether the sampling is dense enough, beside the features of the curves themselves, to call them homeomorphic
        to those that were sampled.
    tour_lower : float or None
        Of a tour, a length that none falls below.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    band: float
    sampling_ratio: float
    noise_ratio: float
    certified: bool
    tour_lower: float | None = value("tour.lower")
    points_hash: str


@record("certified", "simple", "band", "outliers", "rows")
class CurveVerdict(Record):
    """What the checker proved of curves.

    Attributes
    ----------
    rows, outliers : int
        How many rows there are, and how many of them were left out as outliers: nothing is claimed of these.
    band : float
        The largest distance of a row that is no outlier from the curves, rounded up.
    simple : bool
        Whether no two edges meet but neighbors at their vertex; only of tours it may be False.
    sampling_ratio, noise_ratio : float
        As the checker finds them; infinite where they are not known.
    certified : bool
        Whether the evidence for a homeomorphism was found.
    doubt : str or None
        Where it was not, the first reason.
    tour_gap : float or None
        Of a tour, its length over the lower bound, less 1, rounded up.
    """

    rows: int
    outliers: int
    band: float
    simple: bool = value("is_simple")
    sampling_ratio: float
    noise_ratio: float
    certified: bool
    doubt: str | None
    tour_gap: float | None
