from os import PathLike
from typing import Any, Self, final

import numpy as np
from numpy.typing import NDArray

from ._arrays import Rows

__all__ = [
    "Classifier",
    "Found",
    "FoundFile",
    "OpenTiles",
    "Violation",
    "__version__",
    "ball",
    "body_mesh",
    "bounding_dop",
    "centers",
    "contours",
    "curve",
    "check_tiles",
    "delaunay",
    "delaunay_tiles",
    "ellipsoid",
    "ellipsoids",
    "farthest_first",
    "generate",
    "inscribed_circle",
    "box_rows",
    "inscribed_bodies",
    "inscribed_ellipse",
    "inscribed_ellipsoid",
    "inscribed_polygon",
    "inscribed_oriented_rectangle",
    "inscribed_rectangle",
    "inscribed_triangle",
    "kernel_ball",
    "names",
    "norms",
    "raster",
    "robust_ellipsoid",
    "sample",
    "scene_rows",
    "sort_file",
    "spatial_order",
    "sphere_tree",
    "surface",
    "train_classifier",
    "transpose_file",
]

__version__: str

class Violation(Exception): ...

@final
class Classifier:
    def predict(self, rows: Rows) -> tuple[list[int], list[float]]: ...
    def to_json(self) -> str: ...
    @staticmethod
    def from_json(text: str) -> Classifier: ...

@final
class Found:
    @property
    def kind(self) -> str: ...
    def parts(self) -> list[dict[str, Any]]: ...
    def check(self, rows: Rows, items: str) -> dict[str, Any]: ...
    def svg(self, rows: Rows) -> str | None: ...
    def to_json(self) -> str: ...
    @staticmethod
    def from_json(text: str) -> Found: ...

@final
class FoundFile:
    @property
    def kind(self) -> str: ...
    def parts(self) -> list[dict[str, Any]]: ...
    def check(self, output: str | PathLike[str], input: str | PathLike[str] | None) -> dict[str, Any]: ...
    def to_json(self) -> str: ...
    @staticmethod
    def from_json(text: str) -> FoundFile: ...

@final
class OpenTiles:
    def __new__(cls, folder: str, dimension: int, memory: int) -> Self: ...
    def numbers(self) -> list[int]: ...
    def extent(self) -> list[list[float]] | None: ...
    def voronoi_cells(
        self, tile: int, low: list[float], high: list[float]
    ) -> tuple[NDArray[np.uint64], NDArray[np.uint64], NDArray[np.uint64], NDArray[np.float64]]: ...
    def alpha_complex(self, tile: int, alpha: float) -> list[NDArray[np.uint64]]: ...

def ball(
    rows: Rows, items: str, epsilon: float, method: str, batch: int | None, delta: float | None, max_passes: int,
    threads: int | None, seed: int,
) -> Found: ...
def body_mesh(
    exponent: int, origin: list[int], normals: list[list[int]], offsets: list[int],
) -> tuple[NDArray[np.float64], NDArray[np.uint32]]: ...
def bounding_dop(rows: Rows, directions: int) -> Found: ...
def centers(
    rows: Rows, k: int, items: str, weights: bool, groups: bool, epsilon: float, method: str, discrete: bool,
    outliers: int, max_nodes: int, assignment: bool, threads: int | None,
) -> Found: ...
def curve(
    rows: Rows, method: str, open: bool, rho: float, omega: float, feature: float | None, places: bool,
    threads: int | None,
) -> Found: ...
def check_tiles(rows: Rows, folder: str, memory: int, scratch: str | None) -> dict[str, Any]: ...
def delaunay(rows: Rows, order: str, threads: int | None, seed: int) -> Found: ...
def contours(
    rows: Rows,
    heights: Rows,
    levels: list[float] | None,
    interval: float | None,
    folder: str | None,
    memory: int,
) -> tuple[list[float], list[int], NDArray[np.float64]]: ...
def raster(
    rows: Rows, heights: Rows, cell: float, interpolation: str, folder: str | None, memory: int
) -> tuple[int, float, float, NDArray[np.float64]]: ...
def delaunay_tiles(rows: Rows, folder: str, memory: int, threads: int | None, resume: bool) -> None: ...
def ellipsoid(
    rows: Rows, items: str, epsilon: float, method: str, max_passes: int, threads: int | None, seed: int,
) -> Found: ...
def ellipsoids(
    sets: list[Rows], epsilon: float, method: str, max_passes: int, threads: int | None, seed: int,
) -> list[Found]: ...
def farthest_first(
    rows: Rows, count: int, start: int, threads: int | None,
) -> tuple[NDArray[np.int64], NDArray[np.float64], int | None]: ...
def generate(
    out: Rows, distribution: str, seed: int, thickness: float | None, count: int | None, spread: float | None,
    vertices: int | None, side: int | None, angle: float | None, turns: float | None, noise: float | None,
) -> None: ...
def box_rows(points: list[list[float]]) -> list[float]: ...
def scene_rows(mesh: list[float], surfaces: list[list[float]], points: list[list[float]]) -> list[float]: ...
def inscribed_bodies(
    rows: Rows, is_free: bool, facets: int, given: list[list[int]], objective: str, count: int, disjoint: bool,
    at: list[list[float]], ends: list[list[float]], coverage: float | None, hidden: float | None, merge_within: float | None, close_holes: bool, events: int, seed: int, method: str, seeds: str, cells: int, votes: int,
    translate: bool, merge: bool,
) -> Found: ...
def inscribed_circle(rows: Rows, epsilon: float, max_cells: int) -> Found: ...
def inscribed_ellipse(
    rows: Rows, epsilon: float, max_cells: int, method: str, sample_count: int, fatness: float, angle: float, seed: int,
) -> Found: ...
def inscribed_triangle(
    rows: Rows, epsilon: float, max_cells: int, method: str, sample_count: int, seed: int,
) -> Found: ...
def inscribed_ellipsoid(rows: Rows, epsilon: float, max_steps: int) -> Found: ...
def inscribed_polygon(rows: Rows, epsilon: float, rounds: int, starts: int, seed: int) -> Found: ...
def inscribed_oriented_rectangle(rows: Rows, epsilon: float, max_cells: int) -> Found: ...
def inscribed_rectangle(rows: Rows, epsilon: float, max_cells: int) -> Found: ...
def kernel_ball(
    rows: Rows, kernel: str, parameters: tuple[float, float, int], nu: float | None, epsilon: float, steps: int | None,
    limits: tuple[int, int | None, int],
) -> Found: ...
def names() -> dict[str, list[str]]: ...
def norms(
    rows: Rows, center: list[float], center_tail: list[float], factor: list[list[float]],
) -> NDArray[np.float64]: ...
def robust_ellipsoid(
    rows: Rows, method: str, coverage: float | None, level: float, epsilon: float, threads: int | None,
) -> Found: ...
def sample(n: int, k: int, seed: int) -> NDArray[np.uint64]: ...
def sort_file(
    input: str | PathLike[str], output: str | PathLike[str], width: int, key: tuple[int, int], kind: str, memory: int,
    scratch: str | PathLike[str] | None, resume: str | PathLike[str] | None,
) -> FoundFile: ...
def spatial_order(rows: Rows, curve: str) -> Found: ...
def sphere_tree(rows: Rows, leaf_size: int, epsilon: float, threads: int | None) -> list[NDArray[Any]]: ...
def surface(
    rows: Rows, method: str, open: bool, denoise: bool, neighbors: int, iterations: int, original: bool,
    alpha: float | None, epsilon: float, sliver_angle: float | None, forbidden_angle: float | None, priority: str,
    restarts: bool, threads: int | None,
) -> Found: ...
def transpose_file(
    input: str | PathLike[str], output: str | PathLike[str], shape: tuple[int, int], width: int, fortran: bool,
    offset: int, dtype: str | None, header: bytes, memory: int,
) -> FoundFile: ...
def train_classifier(
    rows: Rows,
    labels: NDArray[np.uint32],
    classes: int,
    method: str,
    names: tuple[str | None, str | None, str | None],
    numbers: tuple[float | None, int | None],
    seed: int,
    threads: int | None,
) -> Classifier: ...
