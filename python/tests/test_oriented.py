"""The largest rectangle of any direction in a polygon."""

import numpy as np
import pytest

import taut

# A rectangle of sides 5 and 10 along (3, 4) and (-4, 3).
RING = np.array([[0.0, 0.0], [3.0, 4.0], [-5.0, 10.0], [-8.0, 6.0]])


def test_a_turned_rectangle_is_its_own_largest_rectangle():
    found = taut.inscribed_oriented_rectangle(RING)
    answer = found.answer
    assert found.kind == "inscribed-oriented-rectangle"
    assert answer.area == pytest.approx(50, rel=1e-6) and answer.ratio == pytest.approx(0.5, rel=1e-6)
    assert np.allclose(answer.center, [-2.5, 5.0], atol=1e-6)
    distances = np.linalg.norm(answer.corners[:, None] - RING[None], axis=2)
    assert distances.min(axis=1).max() < 1e-5
    verdict = found.check(RING)
    assert verdict.gap <= 1.0001e-3 and verdict.lower <= 50 <= verdict.upper
    for name in ("InscribedOrientedRectangle(", "OrientedRectangleCertificate(gap=", "OrientedRectangleVerdict("):
        assert name in repr((answer, found.certificate, verdict))
    again = taut.Solution.from_json(found.to_json())
    assert again == found
    with pytest.raises(taut.Violation, match="the data changed"):
        again.check(RING + [0, 1])


def test_no_rectangle_along_the_axes_is_larger():
    ring = np.array([[0.0, 0.0], [4.0, 0.0], [5.0, 3.0], [1.0, 4.0]])
    along_axes = taut.inscribed_rectangle(ring, epsilon=1e-2).answer.area
    assert along_axes <= taut.inscribed_oriented_rectangle(ring).answer.area * 1.001


def test_bad_options_are_refused_and_a_notebook_shows_the_rectangle():
    with pytest.raises(ValueError, match="`epsilon` is 0"):
        taut.inscribed_oriented_rectangle(RING, epsilon=0)
    assert "<svg" in taut.inscribed_oriented_rectangle(RING)._repr_html_()
