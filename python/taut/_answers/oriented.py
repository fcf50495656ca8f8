"""Largest rectangles of any direction in polygons, what proves them, and what a checker says of them."""

from __future__ import annotations

import numpy as np

from .._record import FLOAT, Floats, Record, column, record, value
from .ellipse import _leaves


@record("area", "center", "ratio")
class InscribedOrientedRectangle(Record):
    """A rectangle of any direction in a polygon: all c + x a + y r a' with x and y from -1 to 1, where a' = (-a[1], a[0]).

    Attributes
    ----------
    center : ndarray of shape (2,)
        The center c. Read-only.
    axis : ndarray of shape (2,)
        Half of a longer side as a vector, a. Read-only.
    ratio : float
        The shorter side over the longer one, r.
    area : float
        The area, 4 r |a|^2.
    """

    center: Floats = column(FLOAT)
    axis: Floats = column(FLOAT)
    ratio: float
    area: float

    @property
    def corners(self) -> Floats:
        """The four corners, counterclockwise, as rows."""
        across = self.ratio * np.array([-self.axis[1], self.axis[0]])
        signs = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
        corners: Floats = self.center + signs @ np.array([self.axis, across])
        return corners


@record("gap")
class OrientedRectangleCertificate(Record):
    """A subdivision of all rectangles by slope and offsets: the proof that none in the polygon is much larger.

    Attributes
    ----------
    pivot : ndarray of shape (2,)
        The point about which offsets are measured, in units of the bounding box. Read-only.
    tree : str
        The cells, depth first, one letter each: ``0`` to ``3`` and ``m`` are split, the others end for a reason.
    leaves : tuple of tuples of int
        What bounds the cells with the letter ``b``, and what enters those with the letter ``e``.
    gap : float
        The gap proved: largest area <= (1 + gap) * area.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    pivot: Floats = column(FLOAT)
    tree: str
    leaves: tuple[tuple[int, ...], ...] = value(by=_leaves)
    gap: float
    points_hash: str


@record("lower", "upper", "gap")
class OrientedRectangleVerdict(Record):
    """What the checker proved of an inscribed rectangle of any direction.

    Attributes
    ----------
    lower : float
        The area of the answer, rounded down: it is inside by the even-odd rule, and no edge enters it.
    upper : float
        No rectangle inside has an area above this.
    gap : float
        The gap of the certificate, for which all cells were checked.
    """

    lower: float
    upper: float
    gap: float
