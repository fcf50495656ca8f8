"""Convex bodies in triangle meshes, what proves them, and what a checker says of them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._record import FLOAT, ROW, Floats, Record, RowNumbers, column, each, record, table, value


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
    bodies : tuple of ConvexBody
        The bodies, in the order in which they were found.
    """

    exponent: int
    origin: RowNumbers = column(ROW)
    disjoint: bool
    caps: RowNumbers = table(ROW, 3)
    at: Floats = table(FLOAT, 3)
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

    def vertices(self, body: int) -> Floats:
        """The vertices of a body in the coordinates of the mesh, rounded; their convex hull is the body.

        Parameters
        ----------
        body : int
            Number of the body, from 0.

        Returns
        -------
        ndarray of float64, shape (v, 3)
        """
        found = self.bodies[body]
        # Plain arithmetic leaves few triples of planes; of these Cramer's rule in Python's whole numbers, which have any size,
        # makes the vertices.
        normals = found.normals.astype(object)
        offsets = found.offsets.astype(object)
        i, j, k = _candidates(found.normals.astype(np.float64), found.offsets.astype(np.float64))
        u, v, w = normals[i], normals[j], normals[k]
        vw, wu, uv = _cross(v, w), _cross(w, u), _cross(u, v)
        divisor = (u * vw).sum(axis=1)
        at = offsets[i][:, None] * vw + offsets[j][:, None] * wu + offsets[k][:, None] * uv
        at, divisor = at[divisor != 0], divisor[divisor != 0]
        sign = np.where(divisor > 0, 1, -1)
        at, divisor = at * sign[:, None], divisor * sign
        is_vertex = np.all(at @ normals.T <= divisor[:, None] * offsets, axis=1)
        places = {
            tuple((o + x / d) for o, x in zip(self.origin.tolist(), row, strict=True))
            for row, d in zip(at[is_vertex].tolist(), divisor[is_vertex].tolist(), strict=True)
        }
        return np.array(sorted(places)).reshape(-1, 3) * math.ldexp(1.0, self.exponent)


# Triples of planes that are looked at together.
_TRIPLES_AT_ONCE = 20_000

# The distance from a vertex to a plane that rounding may add, as a part of the largest coordinate: far above 2**-53.
_ROUNDING = 1e-9


def _candidates(normals: Floats, offsets: Floats) -> tuple[NDArray[np.int64], ...]:
    """The triples of planes that meet in all half-spaces, or so near that rounding may hide it."""
    lengths = np.linalg.norm(normals, axis=1)
    units, distances = normals / lengths[:, None], offsets / lengths
    triples = itertools.combinations(range(len(offsets)), 3)
    kept = [np.empty((0, 3), dtype=np.int64)]
    while some := list(itertools.islice(triples, _TRIPLES_AT_ONCE)):
        rows = np.array(some)
        i, j, k = rows.T
        vw, wu, uv = (np.cross(units[a], units[b]) for a, b in ((j, k), (k, i), (i, j)))
        divisor = (units[i] * vw).sum(axis=1)
        at = distances[i][:, None] * vw + distances[j][:, None] * wu + distances[k][:, None] * uv
        # Planes that are nearly parallel have no place in plain arithmetic, and stay.
        is_flat = np.abs(divisor) < 1e-6
        at /= np.where(is_flat, 1.0, divisor)[:, None]
        slack = _ROUNDING * (1.0 + np.abs(distances).max() + np.abs(at).max(axis=1))
        is_near = np.all(at @ units.T <= distances + slack[:, None], axis=1)
        kept.append(rows[is_near | (is_flat & (divisor != 0))])
    i, j, k = np.concatenate(kept).T
    return i, j, k


def _cross(a: NDArray[Any], b: NDArray[Any]) -> NDArray[Any]:
    """Cross products of rows of whole numbers of any size."""
    x = a[:, 1] * b[:, 2] - a[:, 2] * b[:, 1]
    y = a[:, 2] * b[:, 0] - a[:, 0] * b[:, 2]
    z = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return np.stack([x, y, z], axis=1)


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
    at : int
        How many points given are in a body, the first in the first body and so on.
    volume_lower, volume_upper : float
        Bounds of the sum of the volumes.
    largest : float
        The volume of the largest body is at least this.
    """

    bodies: int
    disjoint: bool
    caps: int
    at: int
    volume_lower: float
    volume_upper: float
    largest: float
