from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = [
    "Ball",
    "BallCertificate",
    "PassBounds",
    "Solution",
    "Trace",
    "Triangulation",
    "TriangulationCertificate",
    "TriangulationVerdict",
    "Verdict",
    "Violation",
    "__version__",
    "ball",
    "delaunay",
    "generate",
]

__version__: str

def ball(
    rows: NDArray[np.float32] | NDArray[np.float64],
    balls: bool,
    epsilon: float,
    method: str,
    batch: int | None,
    max_passes: int,
    threads: int | None,
    seed: int,
) -> Solution: ...
def delaunay(
    rows: NDArray[np.float32] | NDArray[np.float64],
    order: str,
    threads: int | None,
    seed: int,
) -> Solution: ...
def generate(
    out: NDArray[np.float32] | NDArray[np.float64],
    distribution: str,
    seed: int,
    thickness: float | None,
    count: int | None,
    spread: float | None,
    vertices: int | None,
    side: int | None,
    angle: float | None,
    turns: float | None,
    noise: float | None,
) -> None: ...

class Violation(Exception): ...

@final
class Ball:
    @property
    def center(self) -> NDArray[np.float64]: ...
    @property
    def center_tail(self) -> NDArray[np.float64]: ...
    @property
    def radius(self) -> float: ...

@final
class BallCertificate:
    @property
    def items(self) -> str: ...
    @property
    def support(self) -> NDArray[np.int64]: ...
    @property
    def multipliers(self) -> NDArray[np.float64]: ...
    @property
    def gap(self) -> float: ...
    @property
    def points_hash(self) -> str: ...

@final
class PassBounds:
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def working_set(self) -> int: ...

@final
class Trace:
    @property
    def method(self) -> str: ...
    @property
    def stop(self) -> str: ...
    @property
    def passes(self) -> int: ...
    @property
    def iterations(self) -> int: ...
    @property
    def core_set(self) -> int: ...
    @property
    def history(self) -> tuple[PassBounds, ...]: ...
    @property
    def counters(self) -> dict[str, int]: ...

@final
class Verdict:
    @property
    def lower(self) -> float: ...
    @property
    def upper(self) -> float: ...
    @property
    def gap(self) -> float: ...

@final
class Triangulation:
    @property
    def dimension(self) -> int: ...
    @property
    def hull_dimension(self) -> int | None: ...
    @property
    def simplices(self) -> NDArray[np.uint32]: ...
    @property
    def neighbors(self) -> NDArray[np.int64]: ...
    @property
    def hull(self) -> NDArray[np.uint32]: ...
    @property
    def duplicates(self) -> NDArray[np.uint32]: ...

@final
class TriangulationCertificate:
    @property
    def fingerprint(self) -> str: ...
    @property
    def points_hash(self) -> str: ...
    @property
    def sites(self) -> int: ...

@final
class TriangulationVerdict:
    @property
    def sites(self) -> int: ...
    @property
    def simplices(self) -> int: ...
    @property
    def hull(self) -> int: ...
    @property
    def ties(self) -> int: ...
    @property
    def refined(self) -> int: ...
    @property
    def fingerprint(self) -> str: ...

@final
class Solution:
    @property
    def kind(self) -> str: ...
    @property
    def answer(self) -> Any: ...
    @property
    def certificate(self) -> Any: ...
    @property
    def trace(self) -> Trace: ...
    @property
    def simplices(self) -> NDArray[np.uint32]: ...
    @property
    def neighbors(self) -> NDArray[np.int64]: ...
    @property
    def hull(self) -> NDArray[np.uint32]: ...
    @property
    def duplicates(self) -> NDArray[np.uint32]: ...
    @property
    def fingerprint(self) -> str: ...
    def check(self, points: ArrayLike, radii: ArrayLike | None = None) -> Any: ...
    def to_json(self) -> str: ...
    @staticmethod
    def from_json(text: str) -> Solution: ...
