"""Balls and ellipsoids around shapes, and ellipsoids inside polytopes: closed forms, proofs, and what is refused."""

import pickle

import numpy as np
import pytest

import taut


def shapes_of(rng, n, d):
    """Positive semidefinite matrices, of full rank and of less."""
    factors = rng.normal(size=(n, d, d)) * rng.uniform(0.1, 2, size=(n, 1, d))
    factors[::3, :, 0] = 0
    return factors @ factors.transpose(0, 2, 1)


def reach(centers, shapes, direction):
    """How far the ellipsoids reach in a direction."""
    return (centers @ direction + np.sqrt(np.einsum("j,ijk,k->i", direction, shapes, direction))).max()


def test_shapes_of_balls_are_balls():
    rng = np.random.default_rng(4)
    centers, radii = rng.normal(size=(60, 3)), rng.uniform(0, 2, 60)
    shapes = radii[:, None, None] ** 2 * np.eye(3)
    by_radii, by_shapes = taut.ball_of_balls(centers, radii), taut.ball(centers, shapes=shapes)
    assert by_shapes.answer.radius == pytest.approx(by_radii.answer.radius, rel=3e-9)
    assert by_shapes.check(centers, shapes=shapes).gap <= 2e-9
    by_radii, by_shapes = taut.ellipsoid(centers, radii=radii), taut.ellipsoid(centers, shapes=shapes)
    assert by_shapes.answer.log_volume == pytest.approx(by_radii.answer.log_volume, abs=3e-9)
    assert by_radii.certificate.items == "balls"
    assert by_radii.check(centers, radii=radii).gap <= 2e-9
    assert by_shapes.check(centers, shapes=shapes).gap <= 2e-9


@pytest.mark.parametrize("dim", [1, 2, 3, 5])
def test_random_ellipsoids_are_enclosed(dim):
    rng = np.random.default_rng(dim)
    centers, shapes = rng.normal(size=(40, dim)), shapes_of(rng, 40, dim)
    ball, ellipsoid = taut.ball(centers, shapes=shapes), taut.ellipsoid(centers, shapes=shapes)
    outer = np.linalg.inv(ellipsoid.answer.matrix)
    for direction in rng.normal(size=(200, dim)):
        direction /= np.linalg.norm(direction)
        far = reach(centers, shapes, direction)
        assert far <= ball.answer.center @ direction + ball.answer.radius * (1 + 1e-12)
        assert far <= ellipsoid.answer.center @ direction + np.sqrt(direction @ outer @ direction) * (1 + 1e-9)
    for found in (ball, ellipsoid):
        assert found.certificate.items == "ellipsoids"
        assert found.certificate.directions.shape == (len(found.certificate.support), dim)
        assert taut.verify(found.to_json(), centers, shapes=shapes).gap <= 2e-9
        assert pickle.loads(pickle.dumps(found)) == found
        moved = shapes * (1 + 1e-3)
        with pytest.raises(taut.Violation):
            found.check(centers, shapes=moved)


def test_the_arrays_have_to_fit_the_answer():
    centers, shapes = np.zeros((2, 2)), np.array([np.eye(2), np.eye(2)])
    found = taut.ball(centers, shapes=shapes)
    with pytest.raises(ValueError, match="encloses ellipsoids: give their shapes"):
        found.check(centers)
    with pytest.raises(ValueError, match="encloses ellipsoids, which have no radii"):
        found.check(centers, radii=[1, 1])
    with pytest.raises(ValueError, match="encloses points, which have no shapes"):
        taut.ball(centers).check(centers, shapes=shapes)
    with pytest.raises(ValueError, match="encloses points, which have no offsets"):
        taut.ball(centers).check(centers, offsets=[1, 1])
    with pytest.raises(TypeError, match="radii and shapes are given"):
        taut.ellipsoid(centers, radii=[1, 1], shapes=shapes)


@pytest.mark.parametrize("solve", [taut.ball, taut.ellipsoid])
@pytest.mark.parametrize(
    ("change", "error", "message"),
    [
        (lambda c, s: s.__setitem__((1, 0, 1), 0.5), ValueError, "shape 1 is not symmetric: entries differ by 0.5"),
        (lambda c, s: s.__setitem__((1, 0, 0), -1.0), ValueError, "ellipsoid 1 is not positive semidefinite"),
        (lambda c, s: s.__setitem__((2, 1, 1), np.nan), ValueError, r"entry \(1, 1\) of shape 2 is NaN"),
        (lambda c, s: s.__setitem__((2, 0, 0), np.inf), ValueError, r"entry \(0, 0\) of shape 2 is inf"),
        (lambda c, s: c.__setitem__((1, 1), np.nan), ValueError, "coordinate 1 of the center of ellipsoid 1 is NaN"),
    ],
)
def test_wrong_shapes_are_named(solve, change, error, message):
    centers, shapes = np.zeros((3, 2)), np.array([np.eye(2)] * 3)
    change(centers, shapes)
    with pytest.raises(error, match=message):
        solve(centers, shapes=shapes)


def test_shapes_of_another_size_are_refused():
    with pytest.raises(ValueError, match=r"shapes have shape \(2, 2\): expected \(n, d, d\)"):
        taut.ball([[0, 0], [1, 1]], shapes=np.eye(2))
    with pytest.raises(ValueError, match=r"expected \(2, 2, 2\)"):
        taut.ellipsoid([[0, 0], [1, 1]], shapes=np.zeros((3, 2, 2)))
    with pytest.raises(ValueError, match="the radius of ball 1 is -1"):
        taut.ellipsoid([[0, 0], [1, 1]], radii=[1, -1])
    with pytest.raises(ValueError, match="the point set is empty"):
        taut.ball(np.zeros((0, 2)), shapes=np.zeros((0, 2, 2)))
    with pytest.raises(ValueError, match="method"):
        taut.ellipsoid([[0, 0]], shapes=[np.eye(2)], method="away-steps")


def box(low, high):
    d = len(low)
    return np.vstack([np.eye(d), -np.eye(d)]), np.concatenate([high, -np.asarray(low)])


def test_the_ellipsoid_inside_a_box():
    A, b = box([-1.0, 2.0, 0.0], [3.0, 3.0, 10.0])
    found = taut.inscribed_ellipsoid(A, b)
    answer, verdict = found.answer, found.check(A, offsets=b)
    volume = np.log(4 / 3 * np.pi * 2 * 0.5 * 5)
    assert answer.log_volume == pytest.approx(volume, abs=2e-9)
    assert answer.center == pytest.approx([1, 2.5, 5], abs=1e-6)
    assert answer.axes @ answer.axes.T == pytest.approx(np.diag([4, 0.25, 25]), abs=1e-6)
    assert verdict.lower <= volume + 1e-12
    assert volume - 1e-12 <= verdict.upper
    assert verdict.gap <= 2e-9
    assert found.kind == "inscribed-ellipsoid"
    assert pickle.loads(pickle.dumps(found)) == found
    assert taut.verify(found.to_json(), A, offsets=b) is not None
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check(A, offsets=b * 0.9)
    with pytest.raises(ValueError, match="lies in half-spaces: give their offsets"):
        found.check(A)
    for name in ("InscribedEllipsoid(", "InscribedCertificate(gap=", "InscribedVerdict("):
        assert any(repr(part).startswith(name) for part in (answer, found.certificate, verdict))


def test_an_affine_map_of_the_polytope_maps_the_ellipsoid_along():
    rng = np.random.default_rng(7)
    A = np.vstack([rng.normal(size=(30, 4)), np.eye(4), -np.eye(4)])
    b = rng.uniform(0.5, 2, len(A))
    M = rng.normal(size=(4, 4))
    before, after = taut.inscribed_ellipsoid(A, b), taut.inscribed_ellipsoid(A @ np.linalg.inv(M), b)
    grown = np.linalg.slogdet(M)[1]
    assert after.answer.log_volume == pytest.approx(before.answer.log_volume + grown, abs=4e-9)
    assert after.answer.center == pytest.approx(M @ before.answer.center, abs=1e-3)


@pytest.mark.parametrize(
    ("A", "b", "message"),
    [
        ([[1, 0], [-1, 0], [0, 1]], [1, 1, 1], "unbounded"),
        ([[1.0], [-1.0]], [0.0, -1.0], "no interior point"),
        ([[1.0], [-1.0]], [1.0, -1.0], "no interior point"),
        (np.empty((0, 2)), [], "no half-spaces"),
        ([[1, 0], [0, 0]], [1, 1], "half-space 1 has no normal"),
        ([[1, 0], [np.nan, 1]], [1, 1], "coordinate 0 of normal 1 is NaN"),
        ([[1, 0], [0, 1]], [1, np.inf], "offset 1 is inf"),
        ([[1, 0], [0, 1]], [1], "there are 2 normals, but 1 offsets"),
    ],
)
def test_what_is_no_polytope_with_an_end_is_named(A, b, message):
    with pytest.raises(ValueError, match=message):
        taut.inscribed_ellipsoid(A, b)


def test_options_of_the_inscribed_ellipsoid_are_checked():
    A, b = box([0.0], [1.0])
    with pytest.raises(ValueError, match="epsilon"):
        taut.inscribed_ellipsoid(A, b, epsilon=0)
    with pytest.raises(ValueError, match="max_steps"):
        taut.inscribed_ellipsoid(A, b, max_steps=0)
    with pytest.raises(TypeError, match="offsets are None"):
        taut.inscribed_ellipsoid(A, None)
