"""Seeded point sets of the literature."""

from __future__ import annotations

import operator
import sys
from typing import Literal

import numpy as np
from numpy.typing import DTypeLike

from . import _native
from ._arrays import Rows

Distribution = Literal[
    "normal",
    "uniform",
    "cube",
    "poisson",
    "sphere",
    "shell",
    "clusters",
    "clouds",
    "simplex",
    "polygon",
    "kuzmin",
    "grid",
    "spiral",
    "lines",
    "skew",
    "fan",
    "roads",
    "torus",
]


def generate(
    distribution: Distribution,
    n: int,
    d: int,
    *,
    seed: int = 0,
    dtype: DTypeLike = np.float64,
    thickness: float | None = None,
    count: int | None = None,
    spread: float | None = None,
    vertices: int | None = None,
    side: int | None = None,
    angle: float | None = None,
    turns: float | None = None,
    noise: float | None = None,
) -> Rows:
    """Draw n points of dimension d, the same on every machine.

    Point i depends on the seed, i, d and the distribution alone: not on n, and not on the number of threads.

    Parameters
    ----------
    distribution : str
        ``"normal"``; ``"uniform"`` in the unit cube; ``"cube"``, the vertices of the unit cube; ``"poisson"``
        with mean 1; ``"sphere"``, uniform on the unit sphere; ``"shell"``, uniform in direction, at a distance
        uniform in 1 - `thickness` to 1 + `thickness`; ``"clusters"``, `count` normal clouds of standard deviation
        `spread` around centers uniform in the unit cube; ``"clouds"``, the same with `count` widths from 1e-5 to
        1e-2; ``"simplex"``, the vertices of a regular simplex with unit edges, then points inside;
        ``"polygon"``, `vertices` points at equal angles on the unit circle, in turn; ``"kuzmin"``, the stars of a
        flat galaxy; ``"grid"``, an integer grid of `side` points along each axis in random order, turned by
        `angle` degrees in the plane of the first two axes; ``"torus"``, a torus in space with normal `noise`;
        ``"skew"``, two segments on skew lines in space; and in the plane ``"spiral"``, one of Archimedes with
        `turns` turns, ``"lines"``, two parallel segments, ``"fan"``, one point beside a segment and then points
        of it, and ``"roads"``, random walks of 50 steps around `count` towns, rounded to 1e-6. What a shape of the
        plane or of space lacks in dimension d is 0, and what it has beyond it is left out.
    n, d : int
        Number of points, at least 0, and dimension, at least 1.
    seed : int, default 0
        From 0 to 2**64 - 1.
    dtype : float64 or float32, default float64
        Points are drawn in float64, then rounded.
    thickness : float >= 0, optional
        Of a shell; by default 0.1.
    count : int >= 1, optional
        Of clusters, by default 5; of clouds, by default sqrt(n) / 4, at least 10; of towns of roads, by default
        sqrt(n / 50), at least 8.
    spread : float >= 0, optional
        Of clusters; by default 0.05.
    vertices : int >= 1, optional
        Of a polygon; by default n.
    side : int >= 1, optional
        Of a grid; by default the least for n points.
    angle : float, optional
        Of a grid, in degrees; by default 0.
    turns : float >= 0, optional
        Of a spiral; by default 10.
    noise : float >= 0, optional
        Of a torus, the standard deviation; by default 1e-4.

    Returns
    -------
    ndarray of shape (n, d)

    Raises
    ------
    ValueError
        When a parameter is out of range, or belongs to another distribution.
    MemoryError
        When the points do not fit.

    Examples
    --------
    >>> import taut
    >>> points = taut.generate("normal", 1000, 3, seed=42)
    >>> (points[:10] == taut.generate("normal", 10, 3, seed=42)).all()
    np.True_
    >>> taut.generate("cube", 3, 2, dtype="float32").dtype
    dtype('float32')
    """
    if np.dtype(dtype) not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype is {np.dtype(dtype)}: expected float32 or float64")
    n, d = operator.index(n), operator.index(d)
    if n < 0:
        raise ValueError(f"`n` is {n}: expected at least 0")
    if d < 1:
        raise ValueError(f"`d` is {d}: expected at least 1")
    if n * d * np.dtype(dtype).itemsize > sys.maxsize:
        raise MemoryError(f"{n} points of dimension {d} do not fit into an address space")
    # NumPy allocates, so that a set too large for memory is a MemoryError.
    points = np.empty((n, d), dtype=dtype)
    _native.generate(
        points, distribution, seed, thickness, count, spread, vertices, side, angle, turns, noise
    )
    return points
