"""The largest triangle in a polygon."""

import numpy as np
import pytest

import taut

HEXAGON = np.array([[2.0, 0.0], [1.0, 2.0], [-1.0, 2.0], [-2.0, 0.0], [-1.0, -2.0], [1.0, -2.0]])


def test_half_of_a_hexagon_is_proved():
    found = taut.inscribed_triangle(HEXAGON)
    assert found.kind == "inscribed-triangle"
    assert abs(found.answer.area / 6 - 1) < 1e-3
    assert found.answer.corners.shape == (3, 2) and found.certificate.root.shape == (2, 2)
    (ux, uy), (vx, vy) = found.answer.corners[1:] - found.answer.corners[0]
    assert abs((ux * vy - uy * vx) / (2 * found.answer.area) - 1) < 1e-12
    verdict = found.check(HEXAGON)
    assert verdict.gap <= 1.0001e-3 and verdict.lower <= 6 <= verdict.upper
    for name in ("InscribedTriangle(", "TriangleCertificate(gap=", "TriangleVerdict("):
        assert name in repr((found.answer, found.certificate, verdict))
    tree = found.certificate.tree
    assert len(found.certificate.leaves) == tree.count("b") + tree.count("e")


def test_a_hole_is_kept_out():
    hole = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]]
    rings = np.array([[x, y, 0] for x, y in HEXAGON] + [[x, y, 1] for x, y in hole])
    found = taut.inscribed_triangle(rings, epsilon=1e-2)
    assert found.check(rings).gap <= 1.0001e-2
    assert found.answer.area < taut.inscribed_triangle(HEXAGON).answer.area
    weights = np.random.default_rng(1).dirichlet(np.ones(3), 2000)
    x, y = (weights @ found.answer.corners).T
    assert not ((abs(x) < 0.5 - 1e-9) & (abs(y) < 0.5 - 1e-9)).any()
    again = taut.Solution.from_json(found.to_json())
    assert again == found and again.certificate.leaves == found.certificate.leaves
    with pytest.raises(taut.Violation, match="the data changed"):
        again.check(rings + [0, 1, 0])


def test_bad_rings_are_refused_by_row():
    with pytest.raises(ValueError, match="ring number of point 1 is 2"):
        taut.inscribed_triangle([[0, 0, 0], [1, 0, 2], [0, 1, 2]])
    with pytest.raises(ValueError, match="`epsilon` is 0"):
        taut.inscribed_triangle(HEXAGON, epsilon=0)


def test_a_notebook_shows_the_triangle():
    assert "<svg" in taut.inscribed_triangle(HEXAGON)._repr_html_()


def test_options_of_other_methods_are_refused():
    with pytest.raises(ValueError, match="option `seed` is of method thesis, not of branch-and-bound"):
        taut.inscribed_triangle([[0, 0], [1, 0], [0, 1]], seed=7)
