"""Heights over a Delaunay triangulation of the plane: contour lines and rasters."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import Rows, as_rows
from ._tiles import Tiles


class Contour(NamedTuple):
    """A line of equal height; higher ground is to its left."""

    height: float
    """The height."""
    places: NDArray[np.float64]
    """Its places, of shape (k, 2); of a closed line the last is the first."""

    @property
    def closed(self) -> bool:
        """Whether it ends where it begins; else it goes from the hull to the hull."""
        return bool((self.places[0] == self.places[-1]).all())


class Raster(NamedTuple):
    """Heights at the centers of square cells."""

    values: NDArray[np.float64]
    """The heights, of shape (rows, columns): rows from the north, columns from the west; NaN outside the hull."""
    west: float
    """The x of the western border."""
    north: float
    """The y of the northern border."""
    cell: float
    """The side of a cell."""


def _split(points: ArrayLike, tiles: Tiles | None) -> tuple[Rows, Rows, str | None]:
    rows = as_rows(points)
    if rows.shape[1] != 3:
        raise ValueError(f"points have shape {rows.shape}: expected (n, 3), a height beside x and y")
    if tiles is None:
        return rows[:, :2].copy(), rows[:, 2:].copy(), None
    if (tiles.points, tiles.dimension) != (len(rows), 2):
        raise ValueError(f"{tiles.folder} has tiles of other points: expected those of points[:, :2]")
    return rows[:0, :2].copy(), rows[:, 2:].copy(), tiles.folder


def contours(
    points: ArrayLike,
    *,
    interval: float | None = None,
    levels: Iterable[float] | None = None,
    tiles: Tiles | None = None,
    memory: int = 512 << 20,
) -> list[Contour]:
    """Lines of equal height on the surface that is linear in each Delaunay triangle of x and y.

    A point at the height of a line counts as above it: a plateau has its line around it, a top at that height has none.
    Lines neither cross nor end within the hull.

    Parameters
    ----------
    points : array_like of shape (n, 3)
        x, y and the height of each point. Of points with equal x and y the first counts.
    interval : float > 0, optional
        There are lines at all multiples of this.
    levels : iterable of float, optional
        There are lines at these heights. Give either `interval` or `levels`.
    tiles : Tiles, optional
        The triangulation of ``points[:, :2]``, where it is in a folder already.
    memory : int, default 512 MiB
        Most bytes for the facets between tiles.

    Returns
    -------
    list of Contour

    Raises
    ------
    ValueError
        When a coordinate is NaN or infinite, or there would be more than a million heights.

    See Also
    --------
    raster : heights on a grid.

    Examples
    --------
    >>> import numpy as np, taut
    >>> x, y = np.meshgrid(np.arange(9.0), np.arange(9.0))
    >>> height = np.hypot(x - 4, y - 4)
    >>> line, = taut.contours(np.column_stack([x.ravel(), y.ravel(), height.ravel()]), levels=[2.5])
    >>> line.height, line.closed
    (2.5, True)
    """
    if (interval is None) == (levels is None):
        raise ValueError("expected either `interval` or `levels`")
    rows, heights, folder = _split(points, tiles)
    chosen = None if levels is None else [float(level) for level in levels]
    found, counts, flat = _native.contours(rows, heights, chosen, interval, folder, memory)
    parts = np.split(flat.reshape(-1, 2), np.cumsum(counts)[:-1]) if counts else []
    return [Contour(height, places) for height, places in zip(found, parts, strict=True)]


def raster(
    points: ArrayLike,
    cell: float,
    *,
    interpolation: str = "linear",
    tiles: Tiles | None = None,
    memory: int = 512 << 20,
) -> Raster:
    """Heights at the centers of square cells, interpolated between points.

    Parameters
    ----------
    points, tiles, memory
        As of `contours`.
    cell : float > 0
        The side of a cell. Cells begin at its multiples, and cover the box of the points.
    interpolation : {"linear", "natural"}, default "linear"
        Linear in each Delaunay triangle, or by Sibson's natural neighbors, which is smooth but at the points.

    Returns
    -------
    Raster

    Raises
    ------
    ValueError
        When a coordinate is NaN or infinite, or memory does not hold the cells.

    See Also
    --------
    contours : lines of equal height.

    Examples
    --------
    >>> import numpy as np, taut
    >>> points = taut.generate("uniform", 1000, 3)
    >>> points[:, 2] = 2 * points[:, 0] - points[:, 1]
    >>> found = taut.raster(points, 0.125)
    >>> found.values.shape, found.west, found.north
    ((8, 8), 0.0, 1.0)
    >>> round(found.values[0, 1], 12)
    np.float64(-0.5625)
    """
    rows, heights, folder = _split(points, tiles)
    columns, west, north, values = _native.raster(rows, heights, float(cell), interpolation, folder, memory)
    return Raster(values.reshape(-1, columns), west, north, float(cell))
