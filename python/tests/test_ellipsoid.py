"""Ellipsoids whose volume is known in closed form, what proves them, and how they travel."""

import copy
import json
import os
import pickle
from pathlib import Path

import numpy as np
import pytest

import taut

RECTANGLE = [[0.0, 0.0], [4.0, 0.0], [4.0, 2.0], [0.0, 2.0], [1.0, 1.0]]
UNIT_BALL = [1.0, 2.0, np.pi, 4 / 3 * np.pi, np.pi**2 / 2]


@pytest.fixture(scope="module")
def points():
    return taut.generate("normal", 2000, 4, seed=9)


@pytest.fixture(scope="module")
def found(points):
    return taut.ellipsoid(points)


@pytest.mark.parametrize(
    ("points", "volume", "rank"),
    [
        ([[5.0, -3.0]], 1.0, 0),
        ([[1.0, 1.0]] * 7, 1.0, 0),
        ([[0.0, 0.0], [3.0, 4.0]], 5.0, 1),
        ([[0.0], [10.0], [3.0]], 10.0, 1),
        (RECTANGLE, 4 * np.pi, 2),
        ([[0.0, 0.0], [4.0, 0.0], [0.0, 3.0]], 6 * 4 * np.pi / 3**1.5, 2),
        ([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], np.pi * 2 / 3, 2),
        (np.array(np.meshgrid(*[[0.0, 2.0]] * 4)).reshape(4, -1).T, UNIT_BALL[4] * 4**2, 4),
        (np.vstack([np.eye(3), -np.eye(3)]) + 7, UNIT_BALL[3], 3),
    ],
)
def test_closed_forms(points, volume, rank):
    found = taut.ellipsoid(points)
    answer, verdict = found.answer, found.check(points)
    d = np.shape(points)[1]
    assert answer.log_volume == pytest.approx(np.log(volume), abs=2e-9)
    assert answer.rank == verdict.rank == rank
    assert verdict.lower <= np.log(volume) + 1e-12
    assert np.log(volume) - 1e-12 <= verdict.upper
    assert verdict.gap <= 1e-9
    assert (answer.center.shape, answer.matrix.shape, answer.factor.shape) == ((d,), (d, d), (rank, d))
    assert (answer.hull is None) == (rank == d)
    assert answer.norm(points).max(initial=0) <= 1 + 1e-12


def test_the_certificate_proves_the_volume(points, found):
    """Both bounds, recalculated here from the multipliers and the factor alone."""
    support, multipliers = found.certificate.support, found.certificate.multipliers
    assert multipliers.sum() == pytest.approx(1)
    assert (multipliers > 0).all()
    assert (np.diff(support) > 0).all()
    assert found.certificate.left_out.shape == (0,)
    rows, d = points[support], points.shape[1]
    offsets = rows - multipliers @ rows
    covariance = (multipliers * offsets.T) @ offsets
    unit = np.log(UNIT_BALL[d])
    lower = unit + d / 2 * np.log(d) + np.linalg.slogdet(covariance)[1] / 2
    answer = found.answer
    assert answer.log_volume == pytest.approx(unit - np.linalg.slogdet(answer.matrix)[1] / 2, abs=1e-12)
    assert lower - 1e-12 <= answer.log_volume <= lower + found.certificate.gap + 1e-12
    assert found.certificate.gap <= 1e-9
    norms = np.linalg.norm((points - answer.center) @ answer.factor.T, axis=1)
    assert norms.max() <= 1 + 1e-14
    assert answer.norm(points) == pytest.approx(norms, rel=1e-13)
    assert (answer.matrix == answer.matrix.T).all()
    assert answer.factor.T @ answer.factor == pytest.approx(answer.matrix, rel=1e-13, abs=1e-15)


def test_norms_of_other_points(found):
    answer = found.answer
    far = answer.center + np.array([[0.0] * 4, [100.0, 0, 0, 0]])
    assert answer.norm(far)[0] == 0
    assert answer.norm(far)[1] == pytest.approx(100 * np.linalg.norm(answer.factor[:, 0]))
    assert answer.norm(far.astype(np.float32)).dtype == np.float64
    assert answer.norm(np.empty((0, 4))).shape == (0,)
    assert np.isnan(answer.norm([[np.nan, 0, 0, 0]])).all()
    with pytest.raises(ValueError, match="points have dimension 3, but the ellipsoid has dimension 4"):
        answer.norm([[1, 2, 3]])


def test_a_flat_set_names_its_flat():
    rng = np.random.default_rng(4)
    plane = rng.normal(size=(100, 2)) @ np.array([[1.0, 0, 1], [0, 1, 1]]) + [3, 4, 5]
    found = taut.ellipsoid(plane)
    hull = found.answer.hull
    assert hull.basis.shape == (2, 3)
    assert hull.basis @ hull.basis.T == pytest.approx(np.eye(2), abs=1e-14)
    assert 0 <= hull.distance <= 1e-12
    assert hull.basis @ [1, 1, -1] == pytest.approx([0, 0], abs=1e-13)
    found.check(plane)
    plane[7, 2] += 1e-3
    assert taut.ellipsoid(plane).answer.rank == 3


@pytest.mark.parametrize(
    "method", ["newton", "thesis-initial", "thesis-khachiyan", "thesis-core-set", "away-steps"]
)
def test_every_method_ends_in_the_same_certificate(method):
    points = taut.generate("uniform", 300, 3, seed=1)
    found = taut.ellipsoid(points, method=method, epsilon=0.05)
    least = taut.ellipsoid(points, epsilon=0).answer.log_volume
    gap = found.check(points).gap
    assert least - 1e-12 <= found.answer.log_volume <= least + gap + 1e-12
    assert found.trace.method == method
    if method == "thesis-initial":
        assert found.trace.stop == "pass-budget"
        assert found != taut.ellipsoid(points, method=method, epsilon=0.05, seed=1)
    else:
        assert found.trace.stop == "converged"
        assert gap <= 0.05


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_threads_change_nothing(dtype):
    points = taut.generate("normal", 20_000, 12, seed=8, dtype=dtype)
    one, two, eight = (taut.ellipsoid(points, threads=threads) for threads in (1, 2, 8))
    assert one == two == eight
    assert one.to_json() == two.to_json() == eight.to_json()


def test_single_precision_is_its_exact_copy_in_double():
    narrow = taut.generate("normal", 3000, 5, seed=2, dtype=np.float32)
    found = taut.ellipsoid(narrow)
    assert found.check(narrow.astype(np.float64)).gap <= 1e-9
    assert found.answer.log_volume == pytest.approx(
        taut.ellipsoid(narrow.astype(np.float64)).answer.log_volume, abs=2e-9
    )


def test_far_from_the_origin_the_tail_completes_the_center():
    square = np.array([[0.0, 0.0], [1, 0], [0, 1], [1, 1]]) + 2.0**40
    found = taut.ellipsoid(square)
    assert found.answer.log_volume == pytest.approx(np.log(np.pi / 2), abs=2e-9)
    assert found.answer.center_tail.shape == (2,)
    assert found.answer.norm(square) == pytest.approx(1, abs=1e-9)


def test_budget_of_passes_is_reported_not_hidden():
    points = taut.generate("sphere", 3000, 12, seed=4)
    found = taut.ellipsoid(points, max_passes=2, epsilon=0)
    assert found.trace.stop == "pass-budget"
    assert found.trace.passes == 2
    assert found.certificate.gap > 1e-9
    assert found.check(points).gap <= found.certificate.gap * (1 + 1e-8)


@pytest.mark.parametrize(
    ("points", "options", "message"),
    [
        (np.empty((0, 2)), {}, "at least one point"),
        ([[0.0, 1.0], [2.0, np.nan]], {}, "coordinate 1 of point 1 is NaN"),
        ([[np.inf, 1.0]], {}, "coordinate 0 of point 0 is inf"),
        ([[1e308, 0.0], [-1e308, 0.0], [0.0, 1e308], [0.0, -1e308]], {}, "scale the coordinates"),
        (RECTANGLE, {"epsilon": 1.0}, "option `epsilon` is 1"),
        (RECTANGLE, {"epsilon": 0, "method": "away-steps"}, "option `epsilon` is 0"),
        (RECTANGLE, {"method": "simplex"}, "option `method` is simplex"),
        (RECTANGLE, {"max_passes": 1}, "option `max_passes` is 1"),
        (RECTANGLE, {"threads": 0}, "option `threads` is 0"),
        (RECTANGLE, {"seed": -1}, "option `seed` is -1"),
    ],
)
def test_wrong_input_is_named(points, options, message):
    with pytest.raises(ValueError, match=message):
        taut.ellipsoid(points, **options)


def test_json_pickles_and_copies(points, found):
    text = found.to_json()
    document = json.loads(text)
    assert document["kind"] == found.kind == "ellipsoid"
    answer = document["answer"]
    assert answer["center"] == found.answer.center.tolist()
    assert answer["matrix"] == found.answer.matrix.tolist()
    assert answer["factor"] == found.answer.factor.tolist()
    assert answer["log_volume"] == found.answer.log_volume
    again = taut.Solution.from_json(text)
    assert again == found == pickle.loads(pickle.dumps(found)) == copy.deepcopy(found)
    assert again.to_json() == text
    assert found != taut.ellipsoid(points[:-1])
    verdict = taut.verify(text, points)
    assert isinstance(verdict, taut.EllipsoidVerdict)
    assert (verdict.gap, verdict.excess) == (found.check(points).gap, 0)
    flat = taut.ellipsoid([[0, 0], [3, 4]])
    assert taut.Solution.from_json(flat.to_json()) == flat


@pytest.mark.parametrize(
    ("part", "key", "change"),
    [
        ("answer", "log_volume", lambda v: v - 1e-6),
        ("answer", "center", lambda c: [c[0] + 1e-6, *c[1:]]),
        ("answer", "factor", lambda f: [[x * (1 + 1e-7) for x in row] for row in f]),
        ("answer", "matrix", lambda m: [[m[0][0] * (1 + 1e-6), *m[0][1:]], *m[1:]]),
        ("certificate", "multipliers", lambda m: [m[0] + 1e-3, *m[1:]]),
        ("certificate", "support", lambda s: [*s[:-1], 2000]),
        ("certificate", "gap", lambda g: -1.0),
    ],
)
def test_damaged_answers_are_rejected(points, found, part, key, change):
    document = json.loads(found.to_json())
    document[part][key] = change(document[part][key])
    with pytest.raises(taut.Violation):
        taut.verify(json.dumps(document), points)


@pytest.mark.parametrize(("key", "problem"), [("matrix", "the matrix"), ("factor", "the factor")])
def test_rows_of_other_lengths_are_refused(found, key, problem):
    document = json.loads(found.to_json())
    document["answer"][key][1].append(0.0)
    with pytest.raises(ValueError, match=f"row 1 of {problem} has 5 numbers, but the center has 4"):
        taut.Solution.from_json(json.dumps(document))


def test_changed_points_and_radii_are_noticed(points, found):
    changed = points.copy()
    changed[500, 2] = np.nextafter(changed[500, 2], 10)
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check(changed)
    with pytest.raises(ValueError, match="which have no radii"):
        found.check(points, np.ones(len(points)))


def test_nothing_can_be_written_to(found):
    answer = found.answer
    for array in (answer.center, answer.center_tail, answer.matrix, answer.factor, found.certificate.support):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(AttributeError):
        answer.log_volume = 0.0
    with pytest.raises(AttributeError, match="an ellipsoid has no simplices"):
        found.simplices  # noqa: B018


def test_representations_say_what_matters(points, found):
    answer, gap = found.answer, found.certificate.gap
    assert repr(found) == f"Solution(kind='ellipsoid', log_volume={answer.log_volume!r}, gap={gap!r})"
    assert repr(answer) == f"Ellipsoid(log_volume={answer.log_volume!r}, rank=4, center=<4 numbers>)"
    assert repr(found.certificate).startswith("EllipsoidCertificate(gap=")
    assert "rank=4" in repr(found.check(points))
    assert repr(taut.ellipsoid([[0, 0], [3, 4]]).answer.hull).startswith("Hull(basis=<1 rows>")


@pytest.mark.skipif("TAUT_DATA" not in os.environ, reason="TAUT_DATA is not set")
def test_real_sets_have_the_volumes_known_for_them():
    """Each with a bracket of its optimum by other code, or, if it is flat, with its rank."""
    folder = Path(os.environ["TAUT_DATA"]) / "ellipsoid"
    optima = json.loads((folder / "reference_optima.json").read_text(encoding="utf-8"))
    assert len(optima) > 20
    step = 1 if "TAUT_LONG_TESTS" in os.environ else 3
    for name, known in list(optima.items())[::step]:
        points = np.loadtxt(folder / name, delimiter=",", skiprows=1, ndmin=2)
        found = taut.ellipsoid(points, epsilon=1e-11)
        assert found.check(points).gap <= 1e-11, name
        assert found.answer.rank == known["affine_rank"], name
        if known["affine_rank"] == known["d"]:
            assert known["log_volume_lower"] - 1e-10 <= found.answer.log_volume, name
            assert found.answer.log_volume <= known["log_volume_upper"] + 1e-10, name
