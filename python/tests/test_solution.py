"""A solution can be stored, read back, checked, and cannot be altered."""

import copy
import json
import pickle

import numpy as np
import pytest

import taut


@pytest.fixture(scope="module")
def points():
    return taut.generate("normal", 1000, 6, seed=9)


@pytest.fixture(scope="module")
def found(points):
    return taut.ball(points)


def test_json_reads_back_to_the_same_bits(points, found):
    text = found.to_json()
    document = json.loads(text)
    assert sorted(document) == ["answer", "certificate", "kind", "schema", "trace"]
    assert document["kind"] == found.kind == "ball"
    assert document["answer"]["radius"] == found.answer.radius
    assert document["answer"]["center"] == found.answer.center.tolist()
    assert document["certificate"]["support"] == found.certificate.support.tolist()
    assert document["certificate"]["points_hash"] == found.certificate.points_hash
    assert document["trace"]["passes"] == found.trace.passes
    assert len(document["trace"]["history"]) == len(found.trace.history) > 0
    again = taut.Solution.from_json(text)
    assert again == found
    assert again.to_json() == text
    by_text, by_solution = taut.verify(text, points), taut.verify(again, points)
    assert (by_text.lower, by_text.upper, by_text.gap) == (
        by_solution.lower,
        by_solution.upper,
        by_solution.gap,
    )


def test_pickles_and_copies_are_equal(found):
    assert pickle.loads(pickle.dumps(found)) == found
    assert copy.deepcopy(found) == found
    assert found != taut.ball([[0.0, 0.0]])
    assert found != "a ball"


@pytest.mark.parametrize(
    "text", ["", "[]", "{}", '{"schema": 1}', '{"schema": 99, "kind": "ball"}', '{"schema": 1, "kind": "egg"}']
)
def test_other_documents_are_refused(text):
    with pytest.raises(ValueError):
        taut.Solution.from_json(text)


@pytest.mark.parametrize(
    ("answer", "error", "message"),
    [
        (None, TypeError, "expected a Solution or its JSON text as str, not NoneType"),
        ({}, TypeError, "expected a Solution or its JSON text as str, not dict"),
        (b"{}", TypeError, "not bytes"),
        ("d.json", ValueError, "expected a Solution or its JSON text, not 'd.json'"),
        ("", ValueError, "expected a Solution or its JSON text, not ''"),
        ("{}", ValueError, "not an answer of taut"),
    ],
)
def test_what_is_no_answer_is_not_verified(points, answer, error, message):
    with pytest.raises(error, match=message):
        taut.verify(answer, points)


@pytest.mark.parametrize("row", [0, 500, 999])
def test_changed_points_are_noticed(points, found, row):
    changed = points.copy()
    changed[row, 2] = np.nextafter(changed[row, 2], 10)
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check(changed)


def test_other_shapes_are_noticed(points, found):
    for other in (points[:-1], points[:, :-1], points[::-1]):
        with pytest.raises(taut.Violation):
            found.check(other)


def damaged(found, part, key, change):
    document = json.loads(found.to_json())
    document[part][key] = change(document[part][key])
    return json.dumps(document)


@pytest.mark.parametrize(
    ("part", "key", "change"),
    [
        ("answer", "radius", lambda r: r * (1 - 1e-7)),
        ("answer", "radius", lambda r: r * (1 + 1e-7)),
        ("answer", "radius", lambda r: -r),
        ("answer", "center", lambda c: [c[0] + 1e-6, *c[1:]]),
        ("answer", "center", lambda c: c[:-1]),
        ("certificate", "multipliers", lambda m: [m[0] + 1e-3, *m[1:]]),
        ("certificate", "multipliers", lambda m: [-m[0], *m[1:]]),
        ("certificate", "multipliers", lambda m: m[1:]),
        ("certificate", "support", lambda s: [s[0] + 1, *s[1:]]),
        ("certificate", "support", lambda s: [*s[:-1], 1000]),
        ("certificate", "support", lambda s: [s[1], *s[1:]]),
        ("certificate", "gap", lambda g: -1.0),
    ],
)
def test_damaged_answers_are_rejected(points, found, part, key, change):
    with pytest.raises(taut.Violation):
        taut.verify(damaged(found, part, key, change), points)


def test_row_numbers_beyond_int64_are_refused(found):
    with pytest.raises(ValueError, match="2\\*\\*63"):
        taut.Solution.from_json(damaged(found, "certificate", "support", lambda s: [*s[:-1], 2**63]))


def test_arrays_and_attributes_cannot_be_written_to(found):
    for array in (
        found.answer.center,
        found.answer.center_tail,
        found.certificate.support,
        found.certificate.multipliers,
    ):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 0
    with pytest.raises(AttributeError):
        found.answer.radius = 0.0
    assert found.answer.center is found.answer.center
    assert found.certificate.support.dtype == np.int64


def test_representations_say_what_matters(found):
    assert repr(found).startswith("Solution(kind='ball', radius=")
    assert repr(found.answer) == f"Ball(radius={found.answer.radius!r}, center=<6 numbers>)"
    assert f"passes={found.trace.passes}" in repr(found.trace)
    assert "gap=" in repr(found.certificate)
    assert repr(found.trace.history[-1]).startswith("PassBounds(lower=")


def test_bounds_close_in_by_pass(found):
    lower = [bounds.lower for bounds in found.trace.history]
    assert lower == sorted(lower)
    assert found.trace.history[-1].upper <= found.answer.radius * (1 + 1e-12)
    assert found.trace.core_set >= len(found.certificate.support)
    assert found.trace.stop == "converged"
    assert all(isinstance(count, int) for count in found.trace.counters.values())


def test_balls_are_checked_with_their_radii(points, found):
    radii = np.linspace(0, 1, len(points))
    balls = taut.ball_of_balls(points, radii)
    assert balls.check(points, radii).gap <= 1e-9
    with pytest.raises(taut.Violation):
        balls.check(points, radii[::-1])
    with pytest.raises(ValueError, match="give their radii"):
        balls.check(points)
    with pytest.raises(ValueError, match="have no radii"):
        found.check(points, radii)
