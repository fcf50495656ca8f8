"""Bounding k-dops."""

import numpy as np
import pytest

import taut

CUBE = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])


def test_a_cube_without_a_corner_is_bounded():
    found = taut.bounding_dop(CUBE[:-1], directions=14)
    assert found.kind == "bounding-dop"
    answer = found.answer
    assert answer.normals.shape == (14, 3) and answer.vertices.shape == (7, 3)
    assert abs(answer.volume - 5 / 6) < 1e-12
    assert np.array_equal(answer.offsets, (CUBE[:-1] @ answer.normals.T).max(axis=0))
    verdict = found.check(CUBE[:-1])
    assert verdict.facets == 14 and verdict.volume_lower <= 5 / 6 <= verdict.volume_upper
    for name in ("BoundingDop(", "DopCertificate(touching=", "DopVerdict("):
        assert name in repr((answer, found.certificate, verdict))
    assert "<svg" in found._repr_html_()


def test_answers_travel_as_json_and_belong_to_their_points():
    found = taut.bounding_dop(CUBE.astype(np.float32))
    again = taut.Solution.from_json(found.to_json())
    assert again == found and again.check(CUBE).volume_upper >= 1
    with pytest.raises(taut.Violation, match="is outside facet"):
        again.check(CUBE + 1)


def test_what_has_no_dop_is_refused():
    with pytest.raises(ValueError, match="`directions` is 8"):
        taut.bounding_dop(CUBE, directions=8)
    with pytest.raises(ValueError, match="expected 3"):
        taut.bounding_dop(CUBE[:, :2])
    with pytest.raises(ValueError, match="coordinate 1 of point 2 is NaN"):
        taut.bounding_dop([[0, 0, 0], [1, 1, 1], [0, np.nan, 0]])
    with pytest.raises(ValueError, match="beyond what double precision can hold"):
        taut.bounding_dop(CUBE * 1e200)
