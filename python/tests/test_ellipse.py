"""The largest ellipse in a polygon."""

import numpy as np
import pytest

import taut

RECTANGLE = np.array([[0.0, 0.0], [6.0, 0.0], [6.0, 2.0], [0.0, 2.0]])


def test_the_largest_ellipse_of_a_rectangle_is_proved():
    found = taut.inscribed_ellipse(RECTANGLE)
    assert found.kind == "inscribed-ellipse"
    assert abs(found.answer.area / (3 * np.pi) - 1) < 1e-3
    assert found.certificate.touching.tolist() == [0, 1, 2, 3]
    verdict = found.check(RECTANGLE)
    assert verdict.gap <= 1.0001e-3 and verdict.lower <= 3 * np.pi <= verdict.upper
    for name in ("InscribedEllipse(", "EllipseCertificate(gap=", "EllipseVerdict("):
        assert name in repr((found.answer, found.certificate, verdict))
    assert len(found.certificate.leaves) == found.certificate.tree.count("b")


def test_a_hole_is_kept_out():
    hole = [[2.5, 0.5], [3.5, 0.5], [3.5, 1.5], [2.5, 1.5]]
    rings = np.array([[x, y, 0] for x, y in RECTANGLE] + [[x, y, 1] for x, y in hole])
    found = taut.inscribed_ellipse(rings, epsilon=1e-4)
    assert found.check(rings).gap <= 1.0001e-4
    turns = np.linspace(0, 2 * np.pi, 400)
    x, y = found.answer.center[:, None] + found.answer.axes @ np.array([np.cos(turns), np.sin(turns)])
    assert not ((abs(x - 3) < 0.5 - 1e-9) & (abs(y - 1) < 0.5 - 1e-9)).any()
    circle = taut.inscribed_circle(rings).answer.radius
    assert found.answer.area > np.pi * circle**2
    again = taut.Solution.from_json(found.to_json())
    assert again == found and again.certificate.leaves == found.certificate.leaves
    with pytest.raises(taut.Violation, match="the data changed"):
        again.check(rings + [0, 1, 0])


def test_bad_rings_are_refused_by_row():
    with pytest.raises(ValueError, match="ring number of point 1 is 2"):
        taut.inscribed_ellipse([[0, 0, 0], [1, 0, 2], [0, 1, 2]])
    with pytest.raises(ValueError, match="`epsilon` is 0"):
        taut.inscribed_ellipse(RECTANGLE, epsilon=0)


def test_a_notebook_shows_the_ellipse():
    assert "<svg" in taut.inscribed_ellipse(RECTANGLE)._repr_html_()


def test_options_of_other_methods_are_refused():
    with pytest.raises(ValueError, match="option `fatness` is of method thesis and five-point, not of branch-and-bound"):
        taut.inscribed_ellipse([[0, 0], [1, 0], [0, 1]], fatness=-3.0)
