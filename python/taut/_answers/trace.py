"""How an answer came about."""

from __future__ import annotations

from .._record import Record, each, record, value


@record("lower", "upper", "working_set")
class PassBounds(Record):
    """The bounds known after one pass over all points.

    Attributes
    ----------
    lower, upper : float
        Proved lower bound on the optimal radius or log-volume, and one with which all points are enclosed.
    working_set : int
        Points in the working set then.
    """

    lower: float
    upper: float
    working_set: int


@record("method", "stop", "passes", "iterations", "core_set")
class Trace(Record):
    """How an answer came about: counters of events, the same on every run and for every number of threads.

    Attributes
    ----------
    method : str
        The method.
    stop : str
        ``"converged"``, ``"rounding"`` (no smaller gap can be proved in float64), ``"pass-budget"``,
        ``"node-budget"`` or ``"proof-budget"`` (what was found takes too many nodes to prove).
    passes : int
        Reads of all points.
    iterations : int
        Steps of the inner solver.
    core_set : int
        Points the method chose to work on; the support is a part of them.
    history : tuple of PassBounds
        Bounds by pass.
    counters : dict of str to int
        Other events worth counting, by name. A fresh copy each time.
    """

    method: str
    stop: str
    passes: int
    iterations: int
    core_set: int
    history: tuple[PassBounds, ...] = each(PassBounds)
    _counters: tuple[tuple[str, int], ...] = value("counters", by=lambda counters: tuple((counters or {}).items()))

    @property
    def counters(self) -> dict[str, int]:
        return dict(self._counters)
