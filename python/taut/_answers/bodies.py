"""Convex bodies in triangle meshes, what proves them, and what a checker says of them."""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from .. import _native
from .._record import FLOAT, ROW, Floats, Ids, Record, RowNumbers, column, each, record, table, value


def _lists(found: Iterable[Iterable[int]]) -> tuple[tuple[int, ...], ...]:
    return tuple(tuple(int(number) for number in numbers) for numbers in found)


@record("volume", "normals")
class ConvexBody(Record):
    """The intersection of half-spaces with whole numbers, on the grid of the answer.

    Attributes
    ----------
    normals : ndarray of int64, shape (k, 3)
        The normals. Read-only.
    offsets : ndarray of int64, shape (k,)
        The offsets, in units of the grid. Read-only.
    volume : float
        The volume, in the cube of the unit of the mesh.
    """

    normals: RowNumbers = table(ROW, 3)
    offsets: RowNumbers = column(ROW)
    volume: float


@record("bodies", "disjoint")
class InscribedBodies(Record):
    """Convex bodies inside a triangle mesh.

    A body is the set of all points ``(origin + y) * 2**exponent`` with ``normals @ y <= offsets``.

    Attributes
    ----------
    exponent : int
        The unit of the grid is ``2**exponent``.
    origin : ndarray of int64, shape (3,)
        The origin of the grid, in units. Read-only.
    disjoint : bool
        Whether no two bodies have an interior point in common.
    caps : ndarray of int64, shape (m, 3)
        The triangles that close the mesh, if it has holes: corner c of row r has number ``3 * r + c``. Read-only.
    at : ndarray of float64, shape (p, 3)
        Points that the first bodies contain, one each. Read-only.
    ends : ndarray of float64, shape (p, 3) or (0, 3)
        Other ends of segments that the first bodies contain, or none. Read-only.
    bodies : tuple of ConvexBody
        The bodies, in the order in which they were found.
    """

    exponent: int
    origin: RowNumbers = column(ROW)
    disjoint: bool
    caps: RowNumbers = table(ROW, 3)
    at: Floats = table(FLOAT, 3)
    ends: Floats = table(FLOAT, 3)
    bodies: tuple[ConvexBody, ...] = each(ConvexBody)

    def half_spaces(self, body: int) -> tuple[Floats, Floats]:
        """The half-spaces of a body in the coordinates of the mesh: ``A @ x <= b``.

        Parameters
        ----------
        body : int
            Number of the body, from 0.

        Returns
        -------
        A : ndarray of float64, shape (k, 3)
            The normals.
        b : ndarray of float64, shape (k,)
            The offsets, rounded down: the body of these half-spaces lies in the body that was proved.
        """
        found = self.bodies[body]
        origin = self.origin.tolist()
        offsets = []
        for normal, offset in zip(found.normals.tolist(), found.offsets.tolist(), strict=True):
            whole = offset + sum(n * o for n, o in zip(normal, origin, strict=True))
            rounded = float(whole)
            if int(rounded) > whole:
                rounded = math.nextafter(rounded, -math.inf)
            offsets.append(math.ldexp(rounded, self.exponent))
        return found.normals.astype(np.float64), np.array(offsets)

    def mesh(self, body: int) -> tuple[Floats, Ids]:
        """The border of a body in the coordinates of the mesh: a closed mesh that faces outward.

        Parameters
        ----------
        body : int
            Number of the body, from 0.

        Returns
        -------
        vertices : ndarray of float64, shape (v, 3)
            The exact vertices, each rounded to the nearest numbers; their convex hull is the body.
        faces : ndarray of uint32, shape (f, 3)
            Triangles on the vertices, counter-clockwise from outside: ``trimesh.Trimesh(*answer.mesh(0))``.
        """
        found = self.bodies[body]
        return _native.body_mesh(self.exponent, self.origin.tolist(), found.normals.tolist(), found.offsets.tolist())

    def vertices(self, body: int) -> Floats:
        """The vertices of a body in the coordinates of the mesh, as `mesh` has them.

        Parameters
        ----------
        body : int
            Number of the body, from 0.

        Returns
        -------
        ndarray of float64, shape (v, 3)
        """
        return self.mesh(body)[0]

    def faces(self, body: int) -> Ids:
        """The facets of a body as triangles on its vertices, as `mesh` has them.

        Parameters
        ----------
        body : int
            Number of the body, from 0.

        Returns
        -------
        ndarray of uint32, shape (f, 3)
        """
        return self.mesh(body)[1]


@record("combined")
class BodyProof(Record):
    """The proof that one body lies inside the mesh.

    Attributes
    ----------
    inside : ndarray of int64, shape (3,)
        A point of the grid in the interior of the body, which is inside the mesh. Read-only.
    combined : tuple of tuples of int
        For each triangle that no facet alone separates from the body its row, then facets and weights:
        ``(row, facet, weight, facet, weight, ...)``.
    """

    inside: RowNumbers = column(ROW)
    combined: tuple[tuple[int, ...], ...] = value(by=_lists)


@record("proofs", "pairs")
class BodiesCertificate(Record):
    """The proof that each body lies inside the mesh.

    Attributes
    ----------
    proofs : tuple of BodyProof
        One proof for each body.
    pairs : tuple of tuples of int
        Of disjoint bodies, facets and weights that separate each pair: ``(facet, weight, facet, weight, ...)``; else empty.
    points_hash : str
        Hash of the rows this was made for, 16 hexadecimal digits.
    """

    proofs: tuple[BodyProof, ...] = each(BodyProof)
    pairs: tuple[tuple[int, ...], ...] = value(by=_lists)
    points_hash: str


@record("bodies", "disjoint", "volume_lower", "volume_upper")
class BodiesVerdict(Record):
    """What the checker proved of inscribed bodies: each lies inside the mesh with its caps, by the even-odd rule.

    Attributes
    ----------
    bodies : int
        How many bodies there are.
    disjoint : bool
        Whether they are disjoint, which then was proved.
    caps : int
        How many caps close the mesh.
    triangles : int
        How many rows are triangles of the mesh.
    points : int
        How many rows are points, which no body contains.
    solids : int
        How many closed obstacles there are, which bodies are outside of.
    walls : int
        How many rows are triangles of obstacles that are not closed, which no body meets.
    at : int
        How many points or segments given are in a body, the first in the first body and so on.
    volume_lower, volume_upper : float
        Bounds of the sum of the volumes.
    largest : float
        The volume of the largest body is at least this.
    """

    bodies: int
    disjoint: bool
    caps: int
    triangles: int
    points: int
    solids: int
    walls: int
    at: int
    volume_lower: float
    volume_upper: float
    largest: float
