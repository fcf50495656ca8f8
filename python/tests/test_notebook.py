"""What a notebook shows of a solution: its main numbers, and a picture where there is one."""

import pickle
from xml.etree import ElementTree

import numpy as np
import pytest

import taut

PLANE = taut.generate("normal", 200, 2, seed=1)
SPACE = taut.generate("normal", 200, 3, seed=1)
T = np.arange(60) * (2 * np.pi / 60)


@pytest.mark.parametrize(
    "solve",
    [
        lambda: taut.ball(PLANE),
        lambda: taut.ball(SPACE),
        lambda: taut.ball(taut.generate("normal", 100, 8)),
        lambda: taut.ball_of_balls(PLANE, np.ones(len(PLANE))),
        lambda: taut.ellipsoid(PLANE.astype(np.float32)),
        lambda: taut.ellipsoids([PLANE, SPACE])[1],
        lambda: taut.inscribed_ellipsoid([[1, 0], [-1, 0], [0, 1], [0, -1]], [4, 0, 2, 0]),
        lambda: taut.robust_ellipsoid(PLANE),
        lambda: taut.centers(PLANE.tolist(), 3),
        lambda: taut.curve(np.c_[np.cos(T), np.sin(T)]),
        lambda: taut.surface(taut.generate("torus", 2000, 3)),
        lambda: taut.delaunay(PLANE),
    ],
)
def test_a_solution_is_drawn_above_its_numbers(solve):
    found = solve()
    page = found._repr_html_()
    shown = ElementTree.fromstring(page)
    picture, table = shown
    assert picture.tag == "{http://www.w3.org/2000/svg}svg" and table.tag == "table"
    assert found.kind in "".join(table.itertext()) and found.trace.method in "".join(table.itertext())
    # The points are known to this solution alone.
    for other in (pickle.loads(pickle.dumps(found)), taut.Solution.from_json(found.to_json())):
        assert other == found
        assert [part.tag for part in ElementTree.fromstring(other._repr_html_())] == ["table"]


def test_numbers_alone_where_there_is_no_picture():
    plain = [
        taut.spatial_order(PLANE),
        taut.delaunay(taut.generate("uniform", 11_000, 2)),  # too many triangles to keep in a notebook
        taut.delaunay(np.empty((0, 2))),
    ]
    for found in plain[:2]:
        page = found._repr_html_()
        assert "<svg" not in page and page.startswith("<div><table>")
    assert "<table>" in plain[2]._repr_html_()


def test_points_that_were_changed_since_are_no_error():
    points = PLANE.copy()
    found = taut.ball(points)
    points[:] = np.nan
    assert "<table>" in found._repr_html_()
    assert found.check(PLANE).gap <= 1e-9
