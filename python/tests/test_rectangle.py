"""The largest rectangle along the axes in a polygon."""

import numpy as np
import pytest

import taut

TRIANGLE = np.array([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]])


def test_the_largest_rectangle_of_a_triangle_is_half_of_it():
    found = taut.inscribed_rectangle(TRIANGLE)
    assert found.kind == "inscribed-rectangle"
    assert 3 / 1.001 <= found.answer.area <= 3
    assert np.allclose(found.answer.low, 0) and np.allclose(found.answer.high, [2, 1.5], atol=0.1)
    verdict = found.check(TRIANGLE)
    assert verdict.gap <= 1.0001e-3 and verdict.lower <= 3 <= verdict.upper
    for name in ("InscribedRectangle(", "RectangleCertificate(gap=", "RectangleVerdict("):
        assert name in repr((found.answer, found.certificate, verdict))
    assert len(found.certificate.edges) == found.certificate.tree.count("e")
    again = taut.Solution.from_json(found.to_json())
    assert again == found
    with pytest.raises(taut.Violation, match="the data changed"):
        again.check(TRIANGLE + [0, 1])


def test_a_budget_is_kept_and_bad_options_are_refused():
    found = taut.inscribed_rectangle(TRIANGLE, epsilon=1e-9, max_cells=500)
    assert len(found.certificate.tree) <= 500 and found.check(TRIANGLE).gap > 1e-9
    with pytest.raises(ValueError, match="`epsilon` is 0"):
        taut.inscribed_rectangle(TRIANGLE, epsilon=0)


def test_a_notebook_shows_the_rectangle():
    assert "<svg" in taut.inscribed_rectangle(TRIANGLE)._repr_html_()
