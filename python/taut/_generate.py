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
    "simplex",
    "polygon",
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
) -> Rows:
    """Draw n points of dimension d, the same on every machine.

    Point i depends on the seed, i, d and the distribution alone: not on n, and not on the number of threads.

    Parameters
    ----------
    distribution : str
        ``"normal"``; ``"uniform"`` in the unit cube; ``"cube"``, the vertices of the unit cube; ``"poisson"``
        with mean 1; ``"sphere"``, uniform on the unit sphere; ``"shell"``, uniform in direction, at a distance
        uniform in 1 - `thickness` to 1 + `thickness`; ``"clusters"``, `count` normal clouds of standard deviation
        `spread` around centres uniform in the unit cube; ``"simplex"``, the vertices of a regular simplex with
        unit edges, then points inside; ``"polygon"``, `vertices` points at equal angles on the unit circle, in
        turn.
    n, d : int
        Number of points, at least 0, and dimension, at least 1.
    seed : int, default 0
        From 0 to 2**64 - 1.
    dtype : float64 or float32, default float64
        Points are drawn in float64, then rounded.
    thickness : float >= 0, optional
        Of a shell; by default 0.1.
    count : int >= 1, optional
        Of clusters; by default 5.
    spread : float >= 0, optional
        Of clusters; by default 0.05.
    vertices : int >= 1, optional
        Of a polygon; by default n.

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
    _native.generate(points, distribution, seed, thickness, count, spread, vertices)
    return points
