"""Checking answers that were stored."""

from __future__ import annotations

from numpy.typing import ArrayLike

from ._native import EllipsoidVerdict, Solution, TriangulationVerdict, Verdict


def verify(
    solution: Solution | str, points: ArrayLike, radii: ArrayLike | None = None
) -> Verdict | EllipsoidVerdict | TriangulationVerdict:
    """Check an answer over the points it was found for.

    Parameters
    ----------
    solution : Solution or str
        The answer with its certificate, or their JSON as `Solution.to_json` and the command line write it.
    points : array_like of shape (n, d)
        The points, or the centres of the balls.
    radii : array_like of shape (n,), optional
        The radii, when the answer encloses balls.

    Returns
    -------
    Verdict, EllipsoidVerdict or TriangulationVerdict
        Proved bounds ``lower`` and ``upper``, and their ``gap``; of a triangulation the counts that were proved.

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
    if isinstance(solution, str):
        if not solution.lstrip().startswith("{"):
            raise ValueError(
                f"expected a Solution or its JSON text, not {solution[:80]!r}: if this names a file, read it first"
            )
        solution = Solution.from_json(solution)
    elif not isinstance(solution, Solution):
        raise TypeError(f"expected a Solution or its JSON text as str, not {type(solution).__name__}")
    verdict: Verdict | EllipsoidVerdict | TriangulationVerdict = solution.check(points, radii)
    return verdict
