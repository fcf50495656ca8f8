"""Edges of Voronoi diagrams of the plane over the rows of a Spark DataFrame, from the tiles of their triangulation.

*Idea.* An edge joins the centers of two simplices that share a facet, or goes off where a facet is on the hull. Most facets have both in
one tile. Of the others each tile sends its half to the two rows of the facet.
*Guarantee.* A center is calculated from a simplex that begins with its lowest row, so its bits do not depend on tiles.

Like `_spark_tasks` this module travels to the workers by value.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from . import _spark_delaunay as delaunay, _spark_tasks as tasks

# The columns of an edge after the ids of its sites.
COLUMNS = "x0 double, y0 double, x1 double, y1 double, dx double, dy double"

# Half of an edge whose facet has another tile beyond it, or the hull: whether its simplex is to the left of the facet, from the lower
# row to the higher one; the center of that; the way out; and the ids of both rows.
Half = tuple[bool, float, float, float, float, Any, Any]


class Facets(NamedTuple):
    """Facets of the simplices of a tile as arrays, one entry for each."""

    low: Any
    """The site with the lower row."""
    high: Any
    is_left: Any
    """Whether the simplex is to the left, on the way from the lower row to the higher one."""
    center: Any
    out: Any
    """At a right angle to the facet, out of the simplex."""
    beyond: Any
    """The center beyond; NaN where that is not in the tile."""
    is_alone: Any
    """Whether nothing in the tile is beyond. Of the others each facet is there once."""


def centers(corners: Any) -> Any:
    """The centers of the circles through three corners each, as `taut.spatial` calculates them."""
    import numpy as np

    edges = corners[:, 1:] - corners[:, :1]
    size = np.abs(edges).max(axis=(1, 2))
    u, v = (edges / size[:, None, None]).transpose(1, 0, 2)
    u2, v2 = np.square(u).sum(axis=1), np.square(v).sum(axis=1)
    # The flattest simplices have none in double precision.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        scale = size / (2 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]))
        offset = np.stack([v[:, 1] * u2 - u[:, 1] * v2, u[:, 0] * v2 - v[:, 0] * u2], axis=1) * scale[:, None]
    return corners[:, 0] + offset


def facets(tile: Any) -> Facets:
    """The facets of a tile."""
    import numpy as np

    taut = tasks.import_taut()
    vertices, neighbors = tile.vertices, tile.neighbors
    if vertices.shape[1] != 3:
        # Points on a line.
        vertices = neighbors = np.empty((0, 3), np.uint32)
    turn = (tile.rows[vertices].argmin(axis=1)[:, None] + np.arange(3)) % 3
    vertices, neighbors = (np.take_along_axis(array, turn, axis=1) for array in (vertices, neighbors))
    center = centers(tile.points[vertices])
    parts = []
    for k in range(3):
        a, b, other = vertices[:, (k + 1) % 3], vertices[:, (k + 2) % 3], neighbors[:, k]
        is_alone = other >= taut._tiles.OTHER_TILE
        # Of two simplices of the tile the one with the lower number has the facet.
        at = np.flatnonzero(is_alone | (other > np.arange(len(other))))
        a, b, is_alone, other = a[at], b[at], is_alone[at], other[at]
        along = tile.points[b] - tile.points[a]
        beyond = np.where(is_alone[:, None], np.nan, center[np.where(is_alone, 0, other)])
        is_left = tile.rows[a] < tile.rows[b]
        low, high = np.where(is_left, a, b), np.where(is_left, b, a)
        out = np.stack([along[:, 1], -along[:, 0]], axis=1)
        parts.append(Facets(low, high, is_left, center[at], out, beyond, is_alone))
    return Facets(*(np.concatenate(arrays) for arrays in zip(*parts)))


def whole_edges(batches: Iterator[Any]) -> Iterator[Any]:
    """The edges of tiles between two simplices of one tile."""
    import numpy as np
    import pyarrow

    for tile, names in delaunay.tiles_of(batches):
        found = facets(tile)
        at = np.flatnonzero(~found.is_alone)
        is_left = found.is_left[at][:, None]
        here, there = found.center[at], found.beyond[at]
        ends = np.concatenate([np.where(is_left, here, there), np.where(is_left, there, here)], axis=1)
        sites = [names.take(pyarrow.array(sites[at])) for sites in (found.low, found.high)]
        ways = [pyarrow.nulls(len(at), pyarrow.float64())] * 2
        yield pyarrow.RecordBatch.from_arrays(
            [*sites, *(pyarrow.array(column) for column in ends.T), *ways],
            names=["a", "b", "x0", "y0", "x1", "y1", "dx", "dy"],
        )


def halves(node: delaunay.Node | None) -> Iterator[tuple[tuple[int, int], Half]]:
    """The halves of the other edges of a tile, by the rows of their sites."""
    import numpy as np

    _, data, ids, *_ = delaunay.there(node)
    tile = tasks.import_taut()._tiles.Tile.from_bytes(data, 2)
    found = facets(tile)
    for at in np.flatnonzero(found.is_alone).tolist():
        sites = int(found.low[at]), int(found.high[at])
        low, high = (int(tile.rows[site]) for site in sites)
        names = (low, high) if ids is None else tuple(ids[site].as_py() for site in sites)
        yield (low, high), (bool(found.is_left[at]), *found.center[at].tolist(), *found.out[at].tolist(), *names)


def joined_edge(group: tuple[tuple[int, int], Any]) -> tuple[Any, ...]:
    """The edge of two halves, or of one, which is on the hull."""
    # The left one first.
    first, *rest = sorted(group[1], key=lambda half: not half[0])
    _, x, y, dx, dy, low, high = first
    return (low, high, x, y, *rest[0][1:3], None, None) if rest else (low, high, x, y, None, None, dx, dy)


def edges(session: Any, tiles: Any, levels: list[Any], id_type: str) -> Any:
    """The DataFrame of all edges.

    Parameters
    ----------
    session : SparkSession
        The session.
    tiles : DataFrame
        Tiles and the ids of their sites as bytes.
    levels : list of RDD
        The nodes of each level.
    id_type : str
        The type of ids in the words of Spark.
    """
    schema = f"a {id_type}, b {id_type}, {COLUMNS}"
    nodes = session.sparkContext.union(levels)
    crossing = nodes.flatMap(halves).groupByKey(levels[0].getNumPartitions()).map(joined_edge)
    return tiles.mapInArrow(whole_edges, schema).union(session.createDataFrame(crossing, schema))
