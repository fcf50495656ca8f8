"""Answers about points, with what proves them."""

from __future__ import annotations

import operator
from dataclasses import dataclass, field
from typing import Any, Generic, TypeVar, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _native
from ._answers.kinds import ARRAYS, KINDS
from ._answers.trace import Trace
from ._arrays import Rows, as_rows, with_groups
from ._export import to_pandas, to_trimesh
from ._notebook import page
from ._plot import plot
from ._record import brief


A = TypeVar("A")
"""The class of an answer."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Solution(Generic[A]):
    """An answer, what proves it, and how it came about; ``Solution[Ball]`` is one whose answer is a `Ball`.

    Two solutions are equal when all their numbers are. Solutions can be pickled.

    In a notebook a solution shows its main numbers and a picture. To draw it, and for nothing else, a solution that a
    function of taut returned keeps a reference to the array that it was found for, which thus lives as long: the array
    is neither compared nor pickled, and what was written to it since is drawn.

    Attributes
    ----------
    kind : str
        ``"ball"``, ``"ellipsoid"``, ``"inscribed-ellipsoid"``, ``"robust-ellipsoid"``, ``"centers"``,
        ``"curve"``, ``"surface"``, ``"order"`` or ``"delaunay"``.
    answer : Ball, Ellipsoid, InscribedEllipsoid, RobustEllipsoid, Centers, Curve, Surface, Order or Triangulation
        The shape.
    certificate : BallCertificate, EllipsoidCertificate and so on
        Its proof.
    trace : Trace
        Counters of the run.
    simplices, neighbors, hull, duplicates, fingerprint
        Those of a triangulation, its answer and certificate, for short. Other shapes have none.
    """

    _found: _native.Found
    _rows: Rows | None = None
    # Answer, certificate and trace once somebody asks for them: of thousands of solutions few are looked at.
    _parts: list[Any] = field(default_factory=list, init=False)

    def _part(self, number: int) -> Any:
        if not self._parts:
            kind = KINDS[self.kind]
            answer, certificate, trace = self._found.parts()
            both = {"answer": answer, "certificate": certificate}
            # Two threads may both come here; the first three stand.
            self._parts.extend(
                (
                    kind.answer._of({**answer, "within": both}),
                    kind.certificate._of({**certificate, "within": both}),
                    Trace._of(trace),
                )
            )
        return self._parts[number]

    @property
    def kind(self) -> str:
        return self._found.kind

    @property
    def answer(self) -> A:
        return cast(A, self._part(0))

    @property
    def certificate(self) -> Any:
        return self._part(1)

    @property
    def trace(self) -> Trace:
        trace: Trace = self._part(2)
        return trace

    @property
    def simplices(self) -> NDArray[np.int32]:
        """``answer.simplices`` of a triangulation."""
        simplices: NDArray[np.int32] = self._of_triangulation("answer.simplices")
        return simplices

    @property
    def neighbors(self) -> NDArray[np.int32]:
        """``answer.neighbors`` of a triangulation."""
        neighbors: NDArray[np.int32] = self._of_triangulation("answer.neighbors")
        return neighbors

    @property
    def hull(self) -> NDArray[np.int32]:
        """``answer.hull`` of a triangulation."""
        hull: NDArray[np.int32] = self._of_triangulation("answer.hull")
        return hull

    @property
    def duplicates(self) -> NDArray[np.int32]:
        """``answer.duplicates`` of a triangulation."""
        duplicates: NDArray[np.int32] = self._of_triangulation("answer.duplicates")
        return duplicates

    @property
    def fingerprint(self) -> str:
        """``certificate.fingerprint`` of a triangulation."""
        fingerprint: str = self._of_triangulation("certificate.fingerprint")
        return fingerprint

    def _of_triangulation(self, path: str) -> Any:
        if self.kind == "delaunay":
            return operator.attrgetter(path)(self)
        article = "an" if self.kind[0] in "aeiou" else "a"
        holder = "centers have" if self.kind == "centers" else f"{article} {self.kind} has"
        raise AttributeError(f"{holder} no {path.split('.')[1]}: triangulations do")

    def check(
        self,
        points: ArrayLike,
        radii: ArrayLike | None = None,
        *,
        shapes: ArrayLike | None = None,
        offsets: ArrayLike | None = None,
        weights: ArrayLike | None = None,
        groups: ArrayLike | None = None,
    ) -> Any:
        """A second opinion: judges the answer over the points, with code that shares nothing with the solver.

        Parameters
        ----------
        points : array_like of shape (n, d)
            The points, or the centers of the balls or ellipsoids, that the answer was found for; of an inscribed
            ellipsoid the normals.
        radii : array_like of shape (n,), optional
            The radii, when the answer is about balls.
        shapes : array_like of shape (n, d, d), optional
            The shape matrices, when the answer encloses ellipsoids.
        offsets : array_like of shape (n,), optional
            The offsets of the half-spaces, when the answer is inscribed.
        weights : array_like of shape (n,), optional
            The weights of the points, when the answer is about points that have some.
        groups : array_like of shape (n,), optional
            The groups of the rows, when the answer is about rows in groups.

        Returns
        -------
        Verdict, EllipsoidVerdict, InscribedVerdict, RobustVerdict, CentersVerdict, CurveVerdict, SurfaceVerdict,
        OrderVerdict or TriangulationVerdict
            Proved bounds ``lower`` and ``upper``, and their ``gap``; of a robust ellipsoid, of curves, of a surface, of an
            order and of a triangulation what was proved instead.

        Raises
        ------
        Violation
            When the answer or its certificate is wrong for these points, with the first place where.

        Examples
        --------
        >>> import taut
        >>> found = taut.ball([[0, 0], [2, 0], [1, 1]])
        >>> found.check([[0, 0], [2, 0], [1, 1]]).upper
        1.0
        >>> found.check([[0, 0], [2, 0], [1, 2]])
        Traceback (most recent call last):
        taut.Violation: ...
        """
        self._match_arrays({"radii": radii, "shapes": shapes, "offsets": offsets, "weights": weights})
        self._match_groups(groups)
        rows = as_rows(points, radii, shapes, offsets, weights)
        if groups is not None:
            rows = with_groups(rows, groups, self.certificate.group)
        items = getattr(self.certificate, "items", "points")
        return KINDS[self.kind].verdict._of(self._found.check(rows, items))

    def _match_arrays(self, arrays: dict[str, ArrayLike | None]) -> None:
        """Refuses arrays that do not belong to what the answer is about, and asks for those that do."""
        kind = KINDS[self.kind]
        items = getattr(self.certificate, "items", kind.items)
        if getattr(self.certificate, "weights", False):
            items = "points with weights"
        wanted = ARRAYS[items]
        for name, array in arrays.items():
            if array is None and name == wanted:
                raise ValueError(f"the answer {kind.does} {items}: give their {name}")
            if array is not None and name != wanted:
                raise ValueError(f"the answer {kind.does} {items}, which have no {name}")

    def _match_groups(self, groups: ArrayLike | None) -> None:
        """Refuses groups where the answer is about rows without, and asks for them where it is about rows in groups."""
        has_groups = getattr(self.certificate, "group", None) is not None
        if has_groups and groups is None:
            raise ValueError("the answer is about rows in groups: give the groups")
        if groups is not None and not has_groups:
            raise ValueError("the answer is not about rows in groups: leave out groups")

    def to_json(self) -> str:
        """The solution as a JSON document, as the command line writes it; numbers read back to the same bits.

        Returns
        -------
        str
        """
        return self._found.to_json()

    @staticmethod
    def from_json(text: str) -> Solution[Any]:
        """Reads what `to_json` or the command line wrote.

        Parameters
        ----------
        text : str
            The document. Nothing in it is believed until `check` has judged it.

        Returns
        -------
        Solution

        Raises
        ------
        ValueError
            When the text is not an answer of taut, or of a newer schema.
        """
        solution: Solution[Any] = Solution(_native.Found.from_json(text))
        solution._part(0)  # A document may hold rows that are no array: this is the place to say so.
        return solution

    def plot(self, ax: Any = None) -> Any:
        """Draws the answer and its points by matplotlib, in the plane or in space.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; by default in a new figure. For points of space it has to be three-dimensional.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            When answers of this kind or dimension have no plot.
        """
        return plot(self.kind, self.answer, self._rows, ax)

    def to_trimesh(self) -> Any:
        """A surface, or the hull of a triangulation in space, as a `trimesh.Trimesh` with one vertex for each row.

        Returns
        -------
        trimesh.Trimesh

        Raises
        ------
        ValueError
            When the answer is no mesh.
        """
        return to_trimesh(self.kind, self.answer, self._rows)

    def to_pandas(self) -> Any:
        """The main table of the answer: centers, simplices, triangles, vertices of curves, or rows in order.

        Returns
        -------
        pandas.DataFrame
            Of an answer without a table, its main numbers in one row.
        """
        return to_pandas(self.kind, self.answer, self._facts())

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Solution) and self._found == other._found

    def __reduce__(self) -> tuple[Any, ...]:
        return Solution.from_json, (self.to_json(),)

    def _facts(self) -> list[tuple[str, Any]]:
        """The main numbers, by name; of lists their lengths."""
        facts = []
        for path in KINDS[self.kind].facts:
            fact = operator.attrgetter(path)(self)
            facts.append((path.split(".")[1], len(fact) if isinstance(fact, (tuple, np.ndarray)) else fact))
        return facts

    def __repr__(self) -> str:
        facts = [("kind", self.kind), *self._facts()]
        return f"Solution({', '.join(f'{name}={brief(fact)}' for name, fact in facts)})"

    def _repr_html_(self) -> str:
        picture = None if self._rows is None else self._found.svg(self._rows)
        run = [(name, getattr(self.trace, name)) for name in ("method", "stop", "passes", "iterations")]
        return page(f"Solution: {self.kind}", [*self._facts(), *run], picture)


Solution.__module__ = "taut"
