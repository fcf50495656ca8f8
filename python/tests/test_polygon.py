"""A large convex polygon in a polygon."""

import numpy as np
import pytest

import taut

L = np.array([[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])


def test_the_longer_leg_of_an_l_is_found_and_proved():
    found = taut.inscribed_polygon(L)
    assert found.kind == "convex-polygon"
    assert abs(found.answer.area - 3) < 1e-9 and found.answer.vertices.shape[1] == 2
    verdict = found.check(L)
    assert verdict.lower <= found.answer.area * (1 + 1e-12) and 3 <= verdict.upper < 4.5
    for name in ("ConvexPolygon(", "ConvexCertificate(gap=", "ConvexVerdict("):
        assert name in repr((found.answer, found.certificate, verdict))
    assert found.certificate.ellipse.area <= verdict.upper
    again = taut.Solution.from_json(found.to_json())
    assert again == found
    with pytest.raises(taut.Violation, match="the data changed"):
        again.check(L + [0, 1])


def test_corners_are_counterclockwise_and_convex():
    turns = np.linspace(0, 2 * np.pi, 50, endpoint=False)
    ring = np.column_stack([np.cos(turns), np.sin(turns)]) * (2 + np.cos(5 * turns))[:, None]
    corners = taut.inscribed_polygon(ring, rounds=20).answer.vertices
    sides = np.roll(corners, -1, axis=0) - corners
    after = np.roll(sides, -1, axis=0)
    assert (sides[:, 0] * after[:, 1] - sides[:, 1] * after[:, 0] > 0).all()


def test_bad_options_are_refused():
    for wrong in ({"starts": 0}, {"epsilon": 0}, {"rounds": -1}):
        with pytest.raises((ValueError, TypeError)):
            taut.inscribed_polygon(L, **wrong)


def test_a_notebook_shows_the_polygon():
    assert "<svg" in taut.inscribed_polygon(L, rounds=0)._repr_html_()
