"""The largest circle in a polygon."""

import numpy as np
import pytest

import taut

SQUARE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])


def test_the_largest_circle_of_a_square_is_proved():
    found = taut.inscribed_circle(SQUARE)
    assert found.kind == "inscribed-circle"
    assert abs(found.answer.radius - 1) < 1e-9
    assert np.allclose(found.answer.center, [1, 1], atol=1e-8)
    assert found.certificate.touching.tolist() == [0, 1, 2, 3]
    verdict = found.check(SQUARE)
    assert verdict.gap <= 1.0001e-9 and verdict.lower <= 1 + 1e-14 and verdict.upper >= 1 - 1e-14
    for name in ("InscribedCircle(", "CircleCertificate(gap=", "CircleVerdict("):
        assert name in repr((found.answer, found.certificate, verdict))
    assert len(found.certificate.leaves) == found.certificate.tree.count("b")


def test_answers_travel_as_json():
    found = taut.inscribed_circle(SQUARE.astype(np.float32))
    again = taut.Solution.from_json(found.to_json())
    assert again == found and again.certificate.leaves == found.certificate.leaves
    with pytest.raises(taut.Violation, match="the data changed"):
        again.check(SQUARE + 1)


def test_rings_that_meet_themselves_are_refused_by_row():
    with pytest.raises(ValueError, match="from point 0 to point 1 meets the edge from point 2 to point 3"):
        taut.inscribed_circle([[0, 0], [2, 2], [2, 0], [0, 2]])
    with pytest.raises(ValueError, match="distinct vertices"):
        taut.inscribed_circle([[0, 0], [1, 1], [0, 0]])
    with pytest.raises(ValueError, match="coordinate 1 of point 2 is NaN"):
        taut.inscribed_circle([[0, 0], [1, 1], [0, np.nan]])
    with pytest.raises(ValueError, match="`epsilon` is 0"):
        taut.inscribed_circle(SQUARE, epsilon=0)


def test_a_notebook_shows_the_circle():
    assert "<svg" in taut.inscribed_circle(SQUARE)._repr_html_()
