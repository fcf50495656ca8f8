"""Triangulations of more points than memory holds: folders of tiles."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from typing import Any, overload

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
        data = np.memmap(path, dtype=np.uint8, mode="r")
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
