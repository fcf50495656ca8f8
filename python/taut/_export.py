"""Answers as the objects of other libraries."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def to_trimesh(kind: str, answer: Any, rows: NDArray[Any] | None) -> Any:
    """A surface, or the hull of a triangulation in space, as `trimesh.Trimesh` with one vertex for each row."""
    faces: Any = None
    vertices = rows
    if kind == "surface":
        faces = answer.triangles
        vertices = rows if answer.vertices is None else answer.vertices
    elif kind == "delaunay" and answer.hull_dimension == 3:
        faces = answer.hull
    if faces is None:
        raise ValueError(f"a solution of kind {kind!r} is no mesh: surfaces and triangulations in space are")
    if vertices is None:
        raise ValueError("the points that this was found for are not known any more: solve again")
    import trimesh

    return trimesh.Trimesh(np.asarray(vertices, dtype=np.float64), faces, process=False)


def to_pandas(kind: str, answer: Any, facts: list[tuple[str, Any]]) -> Any:
    """The main table of an answer as a frame; of an answer without one its main numbers in one row."""
    import pandas

    def frame(table: NDArray[Any], name: str) -> Any:
        return pandas.DataFrame(table, columns=[f"{name}{i}" for i in range(table.shape[1])])

    match kind:
        case "centers":
            found = frame(answer.centers, "x")
            if len(answer.rows):
                found.insert(0, "row", answer.rows)
            return found
        case "delaunay":
            return frame(answer.simplices, "vertex")
        case "surface":
            return frame(answer.triangles, "vertex")
        case "curve":
            parts = [frame(curve.vertices, "x").assign(curve=number) for number, curve in enumerate(answer.curves)]
            return pandas.concat(parts, ignore_index=True) if parts else frame(np.empty((0, 2)), "x").assign(curve=0)
        case "order":
            return pandas.DataFrame({"row": answer.rows})
        case _:
            return pandas.DataFrame([dict(facts)])
