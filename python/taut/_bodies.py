"""Convex bodies in triangle meshes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._arrays import Rows, as_rows
from ._solution import Solution


def triangle_rows(vertices: ArrayLike, triangles: ArrayLike) -> Rows:
    """The triangles of a mesh as rows of nine numbers: the coordinates of their corners.

    Parameters
    ----------
    vertices : array_like of shape (n, 3)
        The vertices, finite real numbers.
    triangles : array_like of int, shape (m, 3)
        The triangles, as numbers of vertices from 0.

    Returns
    -------
    ndarray of shape (m, 9)
        Float32 or float64, as `vertices`.

    Raises
    ------
    ValueError
        When a triangle names a vertex that does not exist.

    Examples
    --------
    >>> import taut
    >>> taut.triangle_rows([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 2, 1]])
    array([[0., 0., 0., 0., 1., 0., 1., 0., 0.]])
    """
    places = as_rows(vertices)
    if places.shape[1] != 3:
        raise ValueError(f"vertices have shape {places.shape}: expected (n, 3)")
    ids = np.asarray(triangles)
    if ids.ndim != 2 or ids.shape[1] != 3 or ids.dtype.kind not in "iu":
        raise ValueError(f"triangles have shape {ids.shape} and dtype {ids.dtype}: expected whole numbers, (m, 3)")
    wrong = np.argwhere((ids < 0) | (ids >= len(places)))
    if len(wrong):
        row, corner = wrong[0].tolist()
        raise ValueError(f"triangle {row} names vertex {ids[row, corner]}, but there are {len(places)} vertices")
    return as_rows(places[ids].reshape(-1, 9))


def inscribed_dops(
    vertices: ArrayLike,
    triangles: ArrayLike,
    *,
    directions: int = 18,
    count: int = 1,
    disjoint: bool = False,
    events: int = 200_000,
    seed: int = 0,
) -> Solution:
    """Large convex bodies with facets in fixed directions (k-dops) inside a closed triangle mesh, with a certificate.

    The certificate proves that each body lies inside the mesh. Nothing is claimed about how much such bodies can cover.

    Parameters
    ----------
    vertices : array_like of shape (n, 3)
        The vertices, finite real numbers. Vertices with equal coordinates are one.
    triangles : array_like of int, shape (m, 3)
        The triangles, as numbers of vertices from 0. Each edge belongs to an even number of triangles.
    directions : {6, 14, 18, 26}, default 18
        Directions of the facets.
    count : int from 1 to 1000, default 1
        Most bodies to find; fewer are found where no more fit.
    disjoint : bool, default False
        Whether no two bodies may overlap.
    events : int >= 1, default 200_000
        How many facet events one search may compute; more events cover more.
    seed : int >= 0, default 0
        Where the random choices begin.

    Returns
    -------
    Solution
        ``answer`` is an `InscribedBodies`; then ``certificate`` and ``trace``. Its `check` takes the rows that
        `triangle_rows` makes. ``trace.counters`` has ``covered`` of ``sample_points`` points inside that the search did
        not see.

    Raises
    ------
    ValueError
        When the mesh is not closed, with an edge; when it has no inside; when a number is NaN or infinite, or an option is
        out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    Examples
    --------
    >>> import taut
    >>> vertices = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    >>> triangles = [[x, y, z] for x in (0, 1) for y in (2, 3) for z in (4, 5)]
    >>> found = taut.inscribed_dops(vertices, triangles, directions=14, events=1000)
    >>> round(found.answer.bodies[0].volume, 6)
    1.333333
    >>> found.check(taut.triangle_rows(vertices, triangles)).bodies
    1
    """
    rows = triangle_rows(vertices, triangles)
    return Solution(_native.inscribed_dops(rows, directions, count, disjoint, events, seed), rows)
