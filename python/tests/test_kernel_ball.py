"""Balls in the feature space of a kernel."""

import numpy as np
import pytest

import taut

POINTS = np.random.default_rng(5).normal(size=(200, 3))


def gaussian(gamma):
    squares = ((POINTS[:, None] - POINTS[None]) ** 2).sum(-1)
    return np.exp(-gamma * squares)


def distances(found, matrix):
    """Squared distances of all points from the center, by the matrix of the kernel."""
    rows, weights = found.answer.support, found.answer.multipliers
    return np.diag(matrix) - 2 * matrix[:, rows] @ weights + weights @ matrix[np.ix_(rows, rows)] @ weights


@pytest.mark.parametrize("gamma", [0.01, 0.5, 5.0])
def test_all_points_are_inside_and_the_support_is_on_the_border(gamma):
    found = taut.kernel_ball(POINTS, gamma=gamma)
    squares = distances(found, gaussian(gamma))
    assert squares.max() <= found.answer.squared_radius * (1 + 1e-12)
    assert squares[found.answer.support].min() >= found.answer.squared_radius * (1 - 1e-5)
    assert found.check(POINTS).gap <= 1e-6
    assert found.answer.kernel == "gaussian" and found.answer.gamma == gamma and found.answer.nu is None
    for name in ("KernelBall(", "KernelBallCertificate(gap=", "KernelBallVerdict("):
        assert name in repr((found.answer, found.certificate, found.check(POINTS)))
    assert "<svg" in found._repr_html_()


def test_the_precomputed_kernel_and_the_soft_ball():
    matrix = gaussian(0.2)
    soft = taut.kernel_ball(POINTS, gamma=0.2, nu=0.1)
    given = taut.kernel_ball((matrix + matrix.T) / 2, kernel="precomputed", nu=0.1)
    assert abs(soft.answer.squared_radius - given.answer.squared_radius) < 1e-5
    assert soft.check(POINTS).outside <= 20 <= len(soft.answer.support)
    assert soft.answer.multipliers.max() <= 1 / 20 * (1 + 1e-9)


def test_answers_travel_as_json_and_belong_to_their_points():
    found = taut.kernel_ball(POINTS, kernel="polynomial", gamma=0.3, offset=1, degree=3)
    again = taut.Solution.from_json(found.to_json())
    assert again == found and again.answer.degree == 3 and again.check(POINTS).lower > 0
    with pytest.raises(taut.Violation, match="hash"):
        again.check(POINTS + 1)


def test_options_out_of_range_are_refused():
    for options, message in [
        ({"kernel": "cosine"}, "`kernel` is cosine"),
        ({"gamma": 0.0}, "`gamma` is 0"),
        ({"nu": 1.5}, r"`nu` is 1\.5"),
        ({"thesis_steps": 1}, "`thesis_steps` is 1"),
        ({"nu": 0.1, "thesis_steps": 9}, "`method`"),
        ({"kernel": "precomputed"}, "square"),
    ]:
        with pytest.raises(ValueError, match=message):
            taut.kernel_ball(POINTS, **options)
