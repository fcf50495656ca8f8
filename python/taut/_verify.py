"""Checking answers that were stored."""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from ._answers.kinds import AnyVerdict
from ._solution import Solution


def verify(
    solution: Solution[Any] | str,
    points: ArrayLike,
    radii: ArrayLike | None = None,
    *,
    shapes: ArrayLike | None = None,
    offsets: ArrayLike | None = None,
    weights: ArrayLike | None = None,
    groups: ArrayLike | None = None,
) -> AnyVerdict:
    """Check an answer over the points it was found for.

    Parameters
    ----------
    solution : Solution or str
        The answer with its certificate, or their JSON as `Solution.to_json` and the command line write it.
    points : array_like of shape (n, d)
        The points, or the centers of the balls or ellipsoids; of an inscribed ellipsoid the normals.
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
        Proved bounds ``lower`` and ``upper``, and their ``gap``; of a robust ellipsoid, of curves, of a
        surface, of an order and of a triangulation what was proved instead.

    Raises
    ------
    Violation
        When the answer or its certificate is wrong for these points.
    ValueError
        When the text is not an answer of taut; it is not the name of a file either: read the file first.

    Examples
    --------
    >>> import taut
    >>> text = taut.ball([[0, 0], [2, 0], [1, 1]]).to_json()
    >>> taut.verify(text, [[0, 0], [2, 0], [1, 1]]).upper
    1.0
    """
    verdict: AnyVerdict = as_solution(solution).check(
        points, radii, shapes=shapes, offsets=offsets, weights=weights, groups=groups
    )
    return verdict


def as_solution(solution: Solution[Any] | str) -> Solution[Any]:
    """The solution of which this is the JSON, or which it is."""
    if isinstance(solution, str):
        if not solution.lstrip().startswith("{"):
            raise ValueError(
                f"expected a Solution or its JSON text, not {solution[:80]!r}: if this names a file, read it first"
            )
        return Solution.from_json(solution)
    if not isinstance(solution, Solution):
        kind = type(solution).__name__
        more = ": no certificate comes with it" if kind == "RobustFit" else ""
        raise TypeError(f"expected a Solution or its JSON text as str, not {kind}{more}")
    return solution
