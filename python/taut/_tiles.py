"""Triangulations of more points than memory holds: folders of tiles."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, Self, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._arrays import Rows, as_rows

# Bytes of the counts at the end of a tile, and before its sites.
COUNTS_BYTES = 104
HEAD_BYTES = 16

# Among neighbors.
HULL = 2**32 - 1
OTHER_TILE = 2**32 - 2


class VoronoiCell(NamedTuple):
    """All that is nearer to a site than to any other, within a box."""

    row: int
    """The row of the input, of equal points the smallest."""
    faces: list[NDArray[np.float64]]
    """In the plane one polygon, its corners counter-clockwise, of shape (k, 2). In space the faces, each counter-clockwise from
    outside, of shape (k, 3). Empty if nothing of the cell lies in the box."""


class AlphaPart(NamedTuple):
    """The part of an alpha complex that belongs to one tile, as rows of the input."""

    simplices: NDArray[np.uint64]
    """The simplices with a circumradius of at most alpha, of shape (k, d + 1)."""
    boundary: NDArray[np.uint64]
    """The facets that have such a simplex on one side only, turned outward, of shape (k, d)."""
    singular: NDArray[np.uint64]
    """The facets that have none on either side, though an empty ball of radius at most alpha touches them, of shape (k, d)."""


class Tile:
    """One file of a folder of tiles; its arrays are parts of the file, which the system reads as they are used.

    Attributes
    ----------
    number : int
        The number in the name of the file.
    points : ndarray of float64, shape (sites, d)
        Coordinates of the sites of the tile.
    rows : ndarray of uint32 or uint64, shape (sites,)
        The row of the input of each site, of equal points the smallest.
    duplicates : ndarray of the same type, shape (k, 2)
        Rows that equal a smaller one, each with the smallest.
    vertices : ndarray of uint32, shape (simplices, d + 1)
        Vertices of the simplices as sites of the tile.
    neighbors : ndarray of uint32, shape (simplices, d + 1)
        For each vertex the simplex across the facet opposite, `HULL`, or `OTHER_TILE`.
    copies : ndarray of uint32
        The sites that another tile owns.
    links : ndarray of uint32, shape (links, 3)
        Facets with a simplex of an earlier tile on the other side: ``simplex << 2 | facet`` here, tile, and the same there.
    """

    def __init__(self, path: str, dimension: int) -> None:
        self._read(np.memmap(path, dtype=np.uint8, mode="r"), path, dimension)

    @classmethod
    def from_bytes(cls, data: bytes, dimension: int) -> Self:
        """The tile that these bytes of a file are.

        Parameters
        ----------
        data : bytes
            All of the file.
        dimension : int
            Coordinates of a point.

        Returns
        -------
        Tile
        """
        tile = cls.__new__(cls)
        tile._read(np.frombuffer(data, dtype=np.uint8), "this", dimension)
        return tile

    def _read(self, data: NDArray[np.uint8], path: str, dimension: int) -> None:
        if len(data) < HEAD_BYTES + COUNTS_BYTES or bytes(data[-COUNTS_BYTES:][:8]) != b"TAUTTILE":
            raise ValueError(f"{path} is no tile: it is damaged or cut")
        end = np.array(data[-COUNTS_BYTES:])
        version, d, width, row_bytes, number, _ = (int(value) for value in end[8:32].view("<u4"))
        copies, sites, duplicates, simplices, links, _ = (int(value) for value in end[32:80].view("<u8"))
        lengths = [8 * d * sites, row_bytes * sites, 2 * row_bytes * duplicates, 8 * width * simplices, 4 * copies]
        lengths += [12 * links]
        if version != 1 or d != dimension or sum(lengths) + HEAD_BYTES + COUNTS_BYTES != len(data):
            raise ValueError(f"{path} is no tile of points of dimension {dimension}: it is damaged or cut")
        starts = np.cumsum([HEAD_BYTES, *lengths])
        parts = [data[start : start + length] for start, length in zip(starts, lengths, strict=False)]
        kind = f"<u{row_bytes}"
        self.number = number
        self.points: NDArray[np.float64] = parts[0].view("<f8").reshape(sites, d)
        self.rows: NDArray[Any] = parts[1].view(kind)
        self.duplicates: NDArray[Any] = parts[2].view(kind).reshape(duplicates, 2)
        table = parts[3].view("<u4").reshape(simplices, 2 * width)
        self.vertices: NDArray[np.uint32] = table[:, :width]
        self.neighbors: NDArray[np.uint32] = table[:, width:]
        self.copies: NDArray[np.uint32] = parts[4].view("<u4")
        self.links: NDArray[np.uint32] = parts[5].view("<u4").reshape(links, 3)

    @property
    def simplices(self) -> NDArray[Any]:
        """The vertices of the simplices as rows of the input, in a new array."""
        return self.rows[self.vertices]

    def __len__(self) -> int:
        return len(self.vertices)

    def __repr__(self) -> str:
        return f"Tile({self.number}, {len(self.vertices)} simplices, {len(self.rows)} sites)"


class Tiles(Sequence[Tile]):
    """A triangulation in a folder of tiles, as `delaunay_tiles` writes it; nothing but the manifest is read at first.

    The tiles are the items of a sequence. All simplices of all tiles are the triangulation, each once.

    Parameters
    ----------
    folder : str or path
        The folder.

    Attributes
    ----------
    folder : str
    dimension, points, sites, duplicates, simplices, hull : int
        Coordinates of a point, and how many points, distinct points, equal points, simplices and facets of the hull.
    fingerprint : str
        The hash of the simplices, as that of a triangulation in memory.
    numbers : list of int
        The number of each tile.

    Raises
    ------
    ValueError
        When the folder has no triangulation, or one that is not complete.
    OSError
        When it cannot be read.
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.folder = os.fsdecode(folder)
        path = os.path.join(self.folder, "manifest.txt")
        with open(path, encoding="ascii") as file:
            lines = [line.rstrip("\n").partition(" ")[::2] for line in file]
        values = dict(lines)
        if values.get("format") != "taut-tiled-delaunay 1":
            raise ValueError(f"{path} is no manifest of a folder of tiles")
        if values.get("state") != "complete":
            raise ValueError(f"{self.folder}: the triangulation is not complete: resume it")
        self.dimension = int(values["dimension"])
        self.points = int(values["points"])
        self.sites = int(values["sites"])
        self.duplicates = int(values["duplicates"])
        self.simplices = int(values["simplices"])
        self.hull = int(values["hull"])
        self.fingerprint = values["fingerprint"]
        self.numbers = [int(value.split()[0]) for key, value in lines if key == "tile"]

    def __len__(self) -> int:
        return len(self.numbers)

    @overload
    def __getitem__(self, place: int) -> Tile: ...

    @overload
    def __getitem__(self, place: slice) -> list[Tile]: ...

    def __getitem__(self, place: int | slice) -> Tile | list[Tile]:
        if isinstance(place, slice):
            return [self[k] for k in range(*place.indices(len(self)))]
        return Tile(os.path.join(self.folder, f"tile-{self.numbers[place]:08}.ttd"), self.dimension)

    def __iter__(self) -> Iterator[Tile]:
        return (self[place] for place in range(len(self)))

    def __repr__(self) -> str:
        return f"Tiles({self.folder!r}, {self.points} points, {self.simplices} simplices, {len(self)} tiles)"

    def check(
        self,
        points: ArrayLike | str | os.PathLike[str],
        *,
        memory: int = 512 << 20,
        scratch: str | os.PathLike[str] | None = None,
    ) -> dict[str, Any]:
        """Prove from the points and the files alone that the tiles are the Delaunay triangulation of the points.

        Parameters
        ----------
        points : array_like of shape (n, d), or path of a ``.npy`` file
            The points that were triangulated.
        memory : int, default 512 MiB
            Most bytes of memory to use, at least 16 MiB.
        scratch : str or path, optional
            Folder for temporary files, by default that of the system.

        Returns
        -------
        dict
            What was proved: ``counts`` (``sites``, ``simplices``, ``hull``), ``fingerprint``, ``ties`` and more.

        Raises
        ------
        Violation
            When something is wrong: the message names the first of it.
        """
        scratch = None if scratch is None else os.fsdecode(scratch)
        return _native.check_tiles(_rows(points), self.folder, memory, scratch)

    def voronoi_cells(
        self,
        box: tuple[ArrayLike, ArrayLike] | None = None,
        *,
        memory: int = 512 << 20,
    ) -> Iterator[VoronoiCell]:
        """Voronoi cells of all sites, each once, with those of one tile in memory at a time.

        Parameters
        ----------
        box : pair of array_like of shape (d,), optional
            The two corners of a box that cells are clipped to. Default: the box of the points and, on each side, a tenth of its
            longest side more.
        memory : int, default 512 MiB
            Most bytes for the facets between tiles, 32 for each.

        Returns
        -------
        iterator of VoronoiCell
            In the order of the tiles, which are read as their cells are asked for.

        Raises
        ------
        ValueError
            When the box has not d finite coordinates in each corner, or is empty.
        OSError
            When a tile cannot be read, or is damaged.
        MemoryError
            When the facets between tiles take more memory.

        Examples
        --------
        >>> import tempfile, taut
        >>> folder = tempfile.TemporaryDirectory()
        >>> tiles = taut.delaunay_tiles([[0, 0], [2, 0], [0, 2], [2, 2], [1, 1]], folder.name)
        >>> cells = {cell.row: cell.faces[0] for cell in tiles.voronoi_cells(([-1, -1], [3, 3]))}
        >>> sorted(cells[4].tolist())
        [[0.0, 1.0], [1.0, 0.0], [1.0, 2.0], [2.0, 1.0]]
        >>> folder.cleanup()
        """
        opened = _native.OpenTiles(self.folder, self.dimension, memory)
        frame = self._box(opened) if box is None else box
        if frame is None:
            return iter(())
        low, high = (np.asarray(corner, dtype=np.float64) for corner in frame)
        if low.shape != (self.dimension,) or high.shape != low.shape:
            raise ValueError(f"box has corners of shape {low.shape} and {high.shape}: expected ({self.dimension},)")
        if not (np.isfinite(low).all() and np.isfinite(high).all() and (low < high).all()):
            raise ValueError(f"box is {low.tolist()}, {high.tolist()}: expected finite corners, the first below the second")
        return self._cells(opened, low.tolist(), high.tolist())

    def _cells(self, opened: _native.OpenTiles, low: list[float], high: list[float]) -> Iterator[VoronoiCell]:
        for number in opened.numbers():
            rows, faces, corners, places = opened.voronoi_cells(number, low, high)
            polygons = np.split(places.reshape(-1, self.dimension), np.cumsum(corners)[:-1]) if len(corners) else []
            ends = np.cumsum(faces)
            for row, count, end in zip(rows.tolist(), faces.tolist(), ends.tolist(), strict=True):
                yield VoronoiCell(row, polygons[end - count : end])

    def _box(self, opened: _native.OpenTiles) -> tuple[ArrayLike, ArrayLike] | None:
        """The box of the points and a tenth more, as of ``taut delaunay --voronoi``; none without points."""
        extent = opened.extent()
        if extent is None:
            return None
        low, high = np.array(extent)
        with np.errstate(over="ignore"):
            side = (high - low).max()
            room = 0.1 * side if side > 0 else 1.0
            return low - room, high + room

    def alpha_complex(self, alpha: float, *, memory: int = 512 << 20) -> Iterator[AlphaPart]:
        """Alpha complex down to facets, the part of one tile after the other.

        It has the simplices with a circumradius of at most alpha, their facets, and facets on their own whose smallest sphere is
        empty and no larger. All parts together are the complex, each simplex and facet once.

        Parameters
        ----------
        alpha : float >= 0
            The radius, a length.
        memory : int, default 512 MiB
            Most bytes for the facets between tiles, 32 for each.

        Returns
        -------
        iterator of AlphaPart
            One for each tile, which is read as its part is asked for.

        Raises
        ------
        ValueError
            When alpha is negative or NaN.
        OSError
            When a tile cannot be read, or is damaged.
        MemoryError
            When the facets between tiles take more memory.

        Examples
        --------
        >>> import tempfile, taut
        >>> folder = tempfile.TemporaryDirectory()
        >>> tiles = taut.delaunay_tiles([[0, 0], [3, 0], [0, 4], [40, 0]], folder.name)
        >>> part, = tiles.alpha_complex(2.5)
        >>> part.simplices.tolist(), len(part.boundary), len(part.singular)
        ([[0, 1, 2]], 3, 0)
        >>> folder.cleanup()
        """
        if not alpha >= 0:
            raise ValueError(f"alpha is {alpha}: expected a length, at least 0")
        return self._parts(_native.OpenTiles(self.folder, self.dimension, memory), float(alpha))

    def _parts(self, opened: _native.OpenTiles, alpha: float) -> Iterator[AlphaPart]:
        widths = [self.dimension + 1, self.dimension, self.dimension]
        for number in opened.numbers():
            parts = opened.alpha_complex(number, alpha)
            yield AlphaPart(*(rows.reshape(-1, width) for rows, width in zip(parts, widths, strict=True)))


def delaunay_tiles(
    points: ArrayLike | str | os.PathLike[str],
    folder: str | os.PathLike[str],
    *,
    memory: int = 512 << 20,
    threads: int | None = None,
    resume: bool = False,
) -> Tiles:
    """Delaunay triangulation of more points than memory holds, as tiles in a folder.

    The simplices are those of `delaunay`, whatever the limit on memory.

    Parameters
    ----------
    points : array_like of shape (n, 2) or (n, 3), or path of a ``.npy`` file
        Finite real numbers. A file is read through a mapping, so that it may be larger than memory; its array must be of
        float32 or float64 in C order.
    folder : str or path
        The folder for the tiles, new or empty.
    memory : int, default 512 MiB
        Most bytes of memory to use beside points that are in memory, at least 64 MiB.
    threads : int in [1, 1024], optional
        Threads to use, by default all cores. No byte depends on it.
    resume : bool, default False
        Go on with what an earlier run has left in the folder.

    Returns
    -------
    Tiles

    Raises
    ------
    ValueError
        When points have neither 2 nor 3 coordinates, a coordinate is NaN or infinite, or the folder has other files.
    OSError
        When the disk has less room than the work needs, or the system refuses. What was done stays for ``resume``.
    MemoryError
        When the unfinished points of one node do not fit: resume with more memory.
    KeyboardInterrupt
        Ctrl-C stops the work, which can be resumed.

    See Also
    --------
    delaunay : the triangulation in memory.

    Examples
    --------
    >>> import tempfile, taut
    >>> folder = tempfile.TemporaryDirectory()
    >>> points = taut.generate("uniform", 1000, 2)
    >>> tiles = taut.delaunay_tiles(points, folder.name)
    >>> sum(len(tile.simplices) for tile in tiles) == tiles.simplices
    True
    >>> tiles.check(points)["counts"]["sites"]
    1000
    >>> tiles.fingerprint == taut.delaunay(points).fingerprint
    True
    >>> folder.cleanup()
    """
    folder = os.fsdecode(folder)
    _native.delaunay_tiles(_rows(points), folder, memory, threads, resume)
    return Tiles(folder)


def _rows(points: ArrayLike | str | os.PathLike[str]) -> Rows:
    """Rows in memory, or those of a file, mapped."""
    if not isinstance(points, (str, os.PathLike)):
        return as_rows(points)
    mapped = np.load(points, mmap_mode="r")
    if mapped.dtype not in (np.float32, np.float64) or not mapped.flags.c_contiguous or mapped.ndim != 2:
        name = os.fsdecode(points)
        raise ValueError(f"{name} has an array of {mapped.dtype}, shape {mapped.shape}: expected float32 or float64 in C order")
    return np.asarray(mapped)
