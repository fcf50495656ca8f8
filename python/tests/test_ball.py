"""Balls whose radius is known in closed form, and the ways to hand points over."""

import numpy as np
import pytest

import taut


def simplex(d):
    """The d + 1 vertices of a regular simplex with unit edges: circumradius sqrt(d / (2 (d + 1)))."""
    return taut.generate("simplex", d + 1, d)


@pytest.mark.parametrize(
    ("points", "radius"),
    [
        ([[5.0, -3.0]], 0.0),
        ([[1.0, 1.0]] * 7, 0.0),
        ([[0.0, 0.0], [3.0, 4.0]], 2.5),
        ([[0.0], [10.0], [3.0]], 5.0),
        ([[0.0, 0.0], [2.0, 0.0], [1.0, 1.0]], 1.0),
        (np.array(np.meshgrid(*[[0.0, 1.0]] * 5)).reshape(5, -1).T, np.sqrt(5) / 2),
        (simplex(3), np.sqrt(3 / 8)),
        (simplex(40), np.sqrt(40 / 82)),
        (taut.generate("polygon", 1000, 2, vertices=1000), 1.0),
    ],
)
def test_closed_forms(points, radius):
    found = taut.ball(points)
    assert found.answer.radius == pytest.approx(radius, rel=2e-9, abs=1e-300)
    verdict = found.check(points)
    assert verdict.gap <= 1e-9
    assert verdict.lower <= radius * (1 + 1e-15)
    assert radius * (1 - 1e-15) <= verdict.upper


def test_the_certificate_proves_the_radius():
    """The lower bound, recalculated here from the multipliers alone."""
    points = taut.generate("normal", 2000, 20, seed=3)
    found = taut.ball(points)
    support, multipliers = found.certificate.support, found.certificate.multipliers
    assert multipliers.sum() == pytest.approx(1)
    assert (multipliers > 0).all()
    assert (np.diff(support) > 0).all()
    rows = points[support]
    center = multipliers @ rows
    lower = np.sqrt(multipliers @ ((rows - center) ** 2).sum(axis=1))
    upper = np.sqrt(((points - found.answer.center) ** 2).sum(axis=1).max())
    assert upper <= found.answer.radius * (1 + 1e-14)
    assert found.answer.radius <= lower * (1 + 1e-9) * (1 + 1e-14)
    assert found.certificate.gap <= 1e-9


@pytest.mark.parametrize("method", ["core-set", "thesis-pure", "thesis-fast", "badoiu-clarkson"])
def test_every_method_ends_in_the_same_certificate(method):
    points = taut.generate("uniform", 300, 4, seed=1)
    found = taut.ball(points, method=method, epsilon=1e-2)
    assert found.check(points).gap <= 1e-2
    assert found.answer.radius == pytest.approx(taut.ball(points).answer.radius, rel=1.1e-2)
    assert found.trace.method == method


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("method", ["core-set", "thesis-fast"])
def test_threads_change_nothing(dtype, method):
    points = taut.generate("normal", 20_000, 30, seed=8, dtype=dtype)
    one, two, eight = (
        taut.ball(points, epsilon=1e-3, method=method, threads=threads) for threads in (1, 2, 8)
    )
    assert one == two == eight
    assert one.to_json() == two.to_json() == eight.to_json()


def test_single_precision_is_its_exact_copy_in_double():
    narrow = taut.generate("normal", 3000, 10, seed=2, dtype=np.float32)
    assert narrow.dtype == np.float32
    wide = narrow.astype(np.float64)
    found = taut.ball(narrow)
    assert found.answer.radius == pytest.approx(taut.ball(wide).answer.radius, rel=1e-9)
    found.check(wide)


def test_far_from_the_origin_the_tail_completes_the_center():
    found = taut.ball(np.array([[1e9, 1e9], [1e9 + 1, 1e9], [1e9 + 0.5, 1e9 + 0.25]]))
    assert found.answer.radius == pytest.approx(0.5, rel=1e-9)
    assert found.answer.center_tail.shape == (2,)
    assert found.answer.center + found.answer.center_tail == pytest.approx([1e9 + 0.5, 1e9])


def test_budget_of_passes_is_reported_not_hidden():
    points = taut.generate("normal", 5000, 50, seed=4)
    found = taut.ball(points, max_passes=3, epsilon=0, batch=1)
    assert found.trace.stop == "pass-budget"
    assert found.certificate.gap > 1e-6
    assert found.check(points).gap <= found.certificate.gap * (1 + 1e-12)


@pytest.mark.parametrize("d", [1, 2, 7])
def test_balls_of_radius_zero_are_points(d):
    points = taut.generate("normal", 500, d, seed=6)
    found = taut.ball_of_balls(points, np.zeros(len(points)))
    assert found.answer.radius == pytest.approx(taut.ball(points).answer.radius, rel=2e-9)
    assert found.certificate.items == "balls"
    assert found.answer.center.shape == (d,)


def test_balls_in_closed_form():
    centers, radii = [[0.0, 0.0], [3.0, 4.0]], [1.0, 2.0]
    found = taut.ball_of_balls(centers, radii)
    assert found.answer.radius == pytest.approx((5 + 1 + 2) / 2, rel=1e-9)
    assert found.check(centers, radii).gap <= 1e-9
    covered = taut.ball_of_balls([[0.0, 0.0], [1.0, 0.0]], [10.0, 1.0])
    assert covered.answer.radius == pytest.approx(10, rel=1e-9)
    assert covered.answer.center == pytest.approx([0, 0], abs=1e-6)
