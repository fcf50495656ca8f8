"""Convex bodies in triangle meshes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _native
from ._answers.bodies import InscribedBodies
from ._arrays import Rows, as_rows
from ._solution import Solution

Objective = Literal["volume", "occlusion"]
BodiesMethod = Literal["recreate", "thesis"]
ThesisSeeds = Literal["grid", "center", "random"]


def triangle_rows(
    vertices: ArrayLike,
    triangles: ArrayLike | None,
    *,
    obstacles: ArrayLike | None = None,
    surfaces: Sequence[tuple[ArrayLike, ArrayLike]] = (),
) -> Rows:
    """The triangles of a mesh as rows of nine numbers: the coordinates of their corners.

    Parameters
    ----------
    vertices : array_like of shape (n, 3)
        The vertices, finite real numbers.
    triangles : array_like of int, shape (m, 3), or None
        The triangles, as numbers of vertices from 0. With None the vertices are points that no body contains, after the 12
        triangles of their bounding box.
    obstacles : array_like of shape (p, 3), optional
        Points that no body contains: rows with three equal corners, after the triangles. Equal points come once.
    surfaces : sequence of (vertices, triangles), optional
        Surfaces that no body meets. Their closed parts are solids, in which no body lies; their other parts are walls.

    Returns
    -------
    ndarray of shape (m, 9), with obstacles (m + p, 9)
        Float32 where all that is given is, else float64. With surfaces rows have a tenth number: 0 for the mesh, 1, 2, … for
        solids, -1 for walls and points.

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
    rows = _mesh_rows(vertices, triangles)
    if obstacles is not None:
        rows = as_rows(np.concatenate([rows, _point_rows("obstacles", as_rows(obstacles))]))
    if len(surfaces) == 0:
        return rows
    if any(ids is None for _, ids in surfaces):
        raise ValueError("a surface has no triangles: give its points as obstacles")
    mesh = 12 if triangles is None else len(np.asarray(triangles))
    others = [_mesh_rows(places, ids).ravel().tolist() for places, ids in surfaces]
    numbers = _native.scene_rows(rows[:mesh].ravel().tolist(), others, rows[mesh:, :3].tolist())
    return as_rows(np.array(numbers).reshape(-1, 10))


def _mesh_rows(vertices: ArrayLike, triangles: ArrayLike | None) -> Rows:
    """The rows of a mesh, or of points in their bounding box."""
    places = as_rows(vertices)
    if triangles is None:
        points = _point_rows("vertices", places)
        ends = [places.min(axis=0), places.max(axis=0)] if len(places) else []
        walls = np.array(_native.box_rows([end.tolist() for end in ends]), dtype=places.dtype)
        return as_rows(np.concatenate([walls.reshape(-1, 9), points]))
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


def _point_rows(name: str, places: Rows) -> Rows:
    """Points as triangles with three equal corners; equal points come once."""
    if places.shape[1] != 3:
        raise ValueError(f"{name} have shape {places.shape}: expected (n, 3)")
    first = np.sort(np.unique(places, axis=0, return_index=True)[1])
    return as_rows(np.tile(places[first], 3))


def inscribed_bodies(
    vertices: ArrayLike,
    triangles: ArrayLike | None,
    *,
    obstacles: ArrayLike | None = None,
    surfaces: Sequence[tuple[ArrayLike, ArrayLike]] = (),
    facets: int = 256,
    objective: Objective = "volume",
    count: int | None = None,
    disjoint: bool = False,
    at: ArrayLike | None = None,
    coverage: float | None = None,
    hidden: float | None = None,
    merge_within: float | None = None,
    close_holes: bool = False,
    events: int = 200_000,
    seed: int = 0,
) -> Solution[InscribedBodies]:
    """Large convex bodies inside a triangle mesh, with facets in any directions, with a certificate.

    The certificate proves that each body lies inside the mesh. Nothing is claimed about how much such bodies can cover.

    Parameters
    ----------
    vertices : array_like of shape (n, 3)
        The vertices, finite real numbers. Vertices with equal coordinates are one.
    triangles : array_like of int, shape (m, 3), or None
        The triangles, as numbers of vertices from 0. Each edge belongs to an even number of triangles, unless
        `close_holes` is set. With None the bodies are among the vertices, in their bounding box.
    obstacles : array_like of shape (q, 3), optional
        Points that no body contains.
    surfaces : sequence of (vertices, triangles), optional
        Surfaces that no body meets, as those of `triangle_rows`: closed parts are solids, in which no body lies.
    facets : int from 8 to 256, default 256
        Most facets of a body; more facets cover more.
    objective : {"volume", "occlusion"}, default "volume"
        What the search counts: the part of the inside that bodies cover, or the lines through the mesh that they hide.
    count : int from 1 to 1000, optional
        Most bodies to find; fewer are found where no more fit. By default 1, or 1000 with `coverage` or `hidden`; as many as there are
        points in `at`, if these are more.
    disjoint : bool, default False
        Whether no two bodies may overlap.
    at : array_like of shape (p, 3) or (p, 2, 3), optional
        Points that the first bodies contain, one each, or segments by their two ends.
    coverage : float, optional
        The part of the inside to cover, above 0 and at most 1: no more bodies are added once they cover it, by the points
        that the search counts.
    hidden : float, optional
        The part of the lines through the mesh to hide, above 0 and at most 1, with the objective "occlusion": no more bodies are
        added once they hide it, by the lines that the search counts.
    merge_within : float, optional
        The part of what bodies cover or hide that may be lost to have fewer of them, from 0 to below 1: needless bodies go, and
        pairs of bodies give way to one.
    close_holes : bool, default False
        Whether the holes of a mesh that is not closed are closed by triangles, the ``caps`` of the answer.
    events : int >= 1, default 200_000
        How many facets one search may place, move, or try to move; more of these events cover more.
    seed : int >= 0, default 0
        Where the random choices begin.

    Returns
    -------
    Solution
        ``answer`` is an `InscribedBodies`; then ``certificate`` and ``trace``. Its `check` takes the rows that
        `triangle_rows` makes, with the same obstacles and surfaces. ``trace.counters`` has ``covered`` of ``sample_points`` points inside that the search did
        not see.

    Raises
    ------
    ValueError
        When the mesh is not closed, with an edge; when it has no inside, or holes that leave open what is inside; when no
        body contains a point of `at`, with the reason; when a number is NaN or infinite, or an option is out of range.
    KeyboardInterrupt
        Ctrl-C stops the work.

    Examples
    --------
    >>> import taut
    >>> vertices = [[0, 0, 0], [7, 1, 0], [1, 8, 0.5], [2, 3, 9]]
    >>> triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    >>> found = taut.inscribed_bodies(vertices, triangles, at=[[2, 2, 1]], events=1000)
    >>> len(found.answer.bodies), len(found.answer.bodies[0].offsets)
    (1, 4)
    >>> found.check(taut.triangle_rows(vertices, triangles)).at
    1
    """
    rows = triangle_rows(vertices, triangles, obstacles=obstacles, surfaces=surfaces)
    return Solution(
        _native.inscribed_bodies(
            rows, True, facets, [], objective, _count(count, coverage, hidden), disjoint, *_segments(at), coverage,
            hidden, merge_within, close_holes, events, seed, "recreate", "grid", 32, 5, False, False,
        ),
        rows,
    )


def inscribed_dops(
    vertices: ArrayLike,
    triangles: ArrayLike | None,
    *,
    obstacles: ArrayLike | None = None,
    surfaces: Sequence[tuple[ArrayLike, ArrayLike]] = (),
    directions: int | ArrayLike = 18,
    objective: Objective = "volume",
    count: int | None = None,
    disjoint: bool = False,
    at: ArrayLike | None = None,
    coverage: float | None = None,
    hidden: float | None = None,
    merge_within: float | None = None,
    close_holes: bool = False,
    events: int = 200_000,
    seed: int = 0,
    method: BodiesMethod = "recreate",
    seeds: ThesisSeeds = "grid",
    cells: int = 32,
    votes: int = 5,
    translate: bool = False,
    merge: bool = False,
) -> Solution[InscribedBodies]:
    """Large convex bodies with facets in fixed directions (k-dops) inside a triangle mesh, with a certificate.

    The certificate proves that each body lies inside the mesh. Nothing is claimed about how much such bodies can cover.
    Bodies with facets in any directions cover more: `inscribed_bodies`.

    Parameters
    ----------
    vertices : array_like of shape (n, 3)
        The vertices, finite real numbers. Vertices with equal coordinates are one.
    triangles : array_like of int, shape (m, 3), or None
        The triangles, as numbers of vertices from 0. Each edge belongs to an even number of triangles, unless
        `close_holes` is set. With None the bodies are among the vertices, in their bounding box.
    obstacles : array_like of shape (q, 3), optional
        Points that no body contains.
    surfaces : sequence of (vertices, triangles), optional
        Surfaces that no body meets, as those of `triangle_rows`: closed parts are solids, in which no body lies.
    directions : {6, 14, 18, 26} or array_like of int, shape (k, 3), default 18
        Directions of the facets: how many of those along the axes and diagonals, or from 3 to 13 of your own, no two of them
        parallel, not all in one plane, with absolute values that add up to at most 63. Each of these makes two facets, along it
        and against it.
    objective : {"volume", "occlusion"}, default "volume"
        What the search counts: the part of the inside that bodies cover, or the lines through the mesh that they hide.
    count : int from 1 to 1000, optional
        Most bodies to find; fewer are found where no more fit. By default 1, or 1000 with `coverage` or `hidden`; as many as there are
        points in `at`, if these are more.
    disjoint : bool, default False
        Whether no two bodies may overlap.
    at : array_like of shape (p, 3) or (p, 2, 3), optional
        Points that the first bodies contain, one each, or segments by their two ends.
    coverage : float, optional
        The part of the inside to cover, above 0 and at most 1: no more bodies are added once they cover it, by the points
        that the search counts.
    hidden : float, optional
        The part of the lines through the mesh to hide, above 0 and at most 1, with the objective "occlusion": no more bodies are
        added once they hide it, by the lines that the search counts.
    merge_within : float, optional
        The part of what bodies cover or hide that may be lost to have fewer of them, from 0 to below 1: needless bodies go, and
        pairs of bodies give way to one.
    close_holes : bool, default False
        Whether the holes of a mesh that is not closed are closed by triangles, the ``caps`` of the answer.
    events : int >= 1, default 200_000
        How many facets one search may place, move, or try to move; more of these events cover more.
    seed : int >= 0, default 0
        Where the random choices begin.
    method : {"recreate", "thesis"}, default "recreate"
        "recreate" grows bodies, ruins them in a few facets and grows them again. "thesis" is the procedure of section 8.5
        of the thesis: disjoint bodies, without a budget of events; the options after this one are of it alone. It needs
        triangles that are turned alike.
    seeds : {"grid", "center", "random"}, default "grid"
        Where dops start: at the point of a grid that is farthest from all vertices and dops; at the center of the bounding
        box, then at random points; at random points.
    cells : int from 2 to 256, default 32
        Cells of the grid along the longest side.
    votes : int from 1 to 100, default 5
        How many of the nearest vertices vote on whether a point is inside.
    translate : bool, default False
        Whether a dop that has doubled its size moves away from what it touches, and doubles again.
    merge : bool, default False
        Whether a dop starts around the centers of the largest sphere and its largest neighbor, with seeds of a grid.

    Returns
    -------
    Solution
        ``answer`` is an `InscribedBodies`; then ``certificate`` and ``trace``. Its `check` takes the rows that
        `triangle_rows` makes, with the same obstacles and surfaces. ``trace.counters`` has ``covered`` of ``sample_points`` points inside that the search did
        not see.

    Raises
    ------
    ValueError
        When the mesh is not closed, with an edge; when it has no inside, or holes that leave open what is inside; when no
        body contains a point of `at`, with the reason; when a number is NaN or infinite, or an option is out of range.
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
    rows = triangle_rows(vertices, triangles, obstacles=obstacles, surfaces=surfaces)
    kind, given = _directions(directions)
    return Solution(
        _native.inscribed_bodies(
            rows, False, kind, given, objective, _count(count, coverage, hidden), disjoint, *_segments(at), coverage,
            hidden, merge_within, close_holes, events, seed, method, seeds, cells, votes, translate, merge,
        ),
        rows,
    )


def _count(count: int | None, coverage: float | None, hidden: float | None) -> int:
    """The most bodies, by default as many as a part to cover or to hide needs."""
    return count if count is not None else 1 if coverage is None and hidden is None else 1000


def _directions(directions: int | ArrayLike) -> tuple[int, list[list[int]]]:
    """How many directions there are, and those given, if they are no number."""
    if np.ndim(directions) == 0:
        # What is no whole number is refused behind.
        return directions, []  # type: ignore[return-value]
    given = np.asarray(directions)
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in "iu" or not len(given):
        shape = f"shape {given.shape} and dtype {given.dtype}"
        raise ValueError(f"`directions` has {shape}: expected a number, or whole numbers, (k, 3)")
    found: list[list[int]] = given.tolist()
    return 6, found


def _segments(at: ArrayLike | None) -> tuple[list[list[float]], list[list[float]]]:
    """The points that bodies are to contain, and other ends where they are segments."""
    places = np.empty((0, 3)) if at is None else np.asarray(at, dtype=np.float64)
    if places.ndim == 3 and places.shape[1:] == (2, 3):
        from_: list[list[float]] = places[:, 0].tolist()
        to: list[list[float]] = places[:, 1].tolist()
        return from_, to
    if places.ndim != 2 or places.shape[1] != 3:
        raise ValueError(f"`at` has shape {places.shape}: expected (p, 3), or (p, 2, 3) for segments")
    found: list[list[float]] = places.tolist()
    return found, []
