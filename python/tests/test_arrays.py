"""Points are read where they lie when they can be, and converted when they must be."""

import re
import subprocess
import sys
import textwrap

import numpy as np
import pytest

import taut
from taut._arrays import as_rows


@pytest.fixture
def points():
    return taut.generate("normal", 500, 3, seed=5)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_fitting_arrays_are_not_copied(points, dtype):
    fitting = points.astype(dtype)
    assert as_rows(fitting) is fitting
    fitting.setflags(write=False)
    assert as_rows(fitting) is fitting
    part = fitting[100:200]
    assert np.shares_memory(as_rows(part), fitting)


def test_peak_memory_does_not_grow_with_the_points():
    """A copy of the 96 MB of points anywhere on the way would show in the peak of the process."""
    program = """
        import resource, sys
        import taut
        taut.ball(taut.generate("uniform", 1000, 12))
        points = taut.generate("uniform", 1_000_000, 12)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        found = taut.ball(points, max_passes=3)
        found.check(points)
        print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024)
    """
    run = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(program)], capture_output=True, text=True, check=True
    )
    assert int(run.stdout) < 48_000_000


@pytest.mark.parametrize(
    "form",
    [
        lambda x: x.tolist(),
        np.asfortranarray,
        lambda x: np.repeat(x, 2, axis=0)[::2],
        lambda x: np.hstack([x, x])[:, :3],
        lambda x: x.astype(">f8"),
        lambda x: x.astype(np.longdouble),
        lambda x: x.astype(object),
        memoryview,
    ],
    ids=["lists", "fortran", "row stride", "column part", "big-endian", "longdouble", "object", "buffer"],
)
def test_other_forms_are_converted(points, form):
    wanted = taut.ball(points)
    other = form(points)
    assert taut.ball(other) == wanted
    assert wanted.check(other).upper == wanted.answer.radius


def test_unaligned_arrays_are_copied(points):
    raw = np.frombuffer(b"x" + points.tobytes(), dtype=np.uint8)[1:]
    unaligned = raw.view(np.float64).reshape(points.shape)
    assert not unaligned.flags.aligned
    assert taut.ball(unaligned) == taut.ball(points)


@pytest.mark.parametrize("dtype", [np.int8, np.uint16, np.int64, np.bool_, np.float16])
def test_small_whole_numbers_are_exact(dtype):
    assert taut.ball(np.array([[0, 0], [1, 0]], dtype=dtype)).answer.radius == 0.5


@pytest.mark.parametrize(
    ("points", "error", "message"),
    [
        ([1.0, 2.0], ValueError, r"points have shape \(2,\): expected \(n, d\)"),
        (3.0, ValueError, "shape"),
        (np.zeros((2, 2, 2)), ValueError, "shape"),
        ([[1.0, 2.0], [3.0]], ValueError, "points form no array: .*inhomogeneous"),
        (np.zeros((0, 3)), ValueError, "the point set is empty"),
        (np.zeros((3, 0)), ValueError, "the dimension is 0"),
        (np.zeros((2, 2), complex), TypeError, "complex128"),
        ([["a", "b"]], TypeError, "expected real numbers"),
        (np.zeros((2, 2), "datetime64[s]"), TypeError, "datetime64"),
        (np.ma.masked_array(np.zeros((2, 2)), [[0, 1], [0, 0]]), TypeError, "masked"),
        (None, ValueError, "shape"),
    ],
)
def test_what_is_not_a_point_set_is_refused(points, error, message):
    with pytest.raises(error, match=message):
        taut.ball(points)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("row", [0, 7777])
def test_non_finite_coordinates_are_named(dtype, value, row):
    points = taut.generate("uniform", 10_000, 5, dtype=dtype)
    points[row, 3] = value
    with pytest.raises(ValueError, match=rf"coordinate 3 of point {row} is -?(NaN|inf)"):
        taut.ball(points)


@pytest.mark.parametrize(
    ("option", "message"),
    [
        ({"epsilon": 1.0}, "`epsilon` is 1"),
        ({"epsilon": float("nan")}, "`epsilon` is NaN"),
        ({"epsilon": -1e-3}, "`epsilon` is -0.001"),
        ({"method": "welzl"}, "`method` is welzl: expected core-set"),
        ({"batch": 0}, "`batch` is 0"),
        ({"batch": -1}, "`batch` is -1"),
        ({"max_passes": 2}, "`max_passes` is 2: expected at least 3"),
        ({"max_passes": 3, "method": "thesis-pure"}, "`max_passes` is 3: expected at least 4"),
        ({"delta": 1e-3}, "`delta` is 0.001: expected none but for the methods thesis-pure and thesis-fast"),
        ({"delta": 2.0, "method": "thesis-fast"}, "`delta` is 2: expected a number in"),
        ({"max_passes": -1}, "`max_passes` is -1: expected at least 3, and 4 for the methods of the thesis"),
        ({"max_passes": 2**70}, "`max_passes` is 1180591620717411303424"),
        ({"threads": 0}, "`threads` is 0"),
        ({"threads": -1}, "`threads` is -1"),
        ({"seed": -1}, "`seed` is -1"),
    ],
)
def test_options_out_of_range_are_named(option, message):
    with pytest.raises(ValueError, match=message):
        taut.ball([[0.0, 1.0]], **option)


def test_options_of_a_wrong_type_are_type_errors():
    for option in ({"threads": "2"}, {"epsilon": "small"}, {"seed": 1.5}):
        with pytest.raises(TypeError):
            taut.ball([[0.0, 1.0]], **option)
    with pytest.raises(TypeError):
        taut.ball([[0.0, 1.0]], 1e-3)


@pytest.mark.parametrize(
    ("centers", "radii", "message"),
    [
        ([[0.0, 0.0], [1.0, 0.0]], [1.0], "2 centers, but 1 radii"),
        ([[0.0, 0.0]], [[1.0]], "radii have shape"),
        ([[0.0, 0.0], [1.0, 0.0]], [1.0, -2.0], "the radius of ball 1 is -2: all radii must be at least 0$"),
        ([[0.0, 0.0, 1.0]], [np.nan], "the radius of ball 0 is NaN: all radii must be finite$"),
        ([[0.0, 0.0], [1.0, np.inf]], [1.0, 1.0], "coordinate 1 of the center of ball 1 is inf"),
        ([[0.0, 0.0]], [2**60 + 1], "the radius of ball 0 is 1152921504606846977, which float64 cannot"),
        ([[0, 2**60 + 1]], [1.0], "coordinate 1 of the center of ball 0 is 1152921504606846977"),
        ([[]], [1.0], "centers have shape .* the dimension must be at least 1"),
        (np.zeros((0, 2)), [], "empty"),
    ],
)
def test_wrong_balls_are_refused(centers, radii, message):
    with pytest.raises(ValueError, match=message):
        taut.ball_of_balls(centers, radii)


def test_balls_without_radii_are_refused():
    """They were once taken for points whose last coordinates were radii."""
    with pytest.raises(TypeError, match="radii are None"):
        taut.ball_of_balls([[0.0, 0.0], [1.0, 1.0]], None)


def test_wrong_balls_are_refused_by_the_check_in_the_same_words():
    centers = [[0.0, 0.0], [1.0, 0.0]]
    found = taut.ball_of_balls(centers, [1.0, 1.0])
    for radius, message in [(np.nan, "the radius of ball 1 is NaN"), (-2.0, "the radius of ball 1 is -2")]:
        with pytest.raises(taut.Violation, match=message):
            found.check(centers, [1.0, radius])


@pytest.mark.parametrize("dtype", [np.int64, np.uint64, object])
def test_integers_are_exact_or_refused(dtype):
    """float64 holds each integer up to 2**53, and beyond it some."""
    exact = np.array([[2**53, 0], [2**53 + 2, 0], [2**63 - 2**10, 1]], dtype=dtype)
    assert taut.ball(exact) == taut.ball(exact.astype(np.float64))
    for value in (2**53 + 1, 2**63 - 1, *([2**64 - 1] if dtype == np.uint64 else [])):
        points = exact.copy()
        points[2, 1] = value
        with pytest.raises(ValueError, match=f"coordinate 1 of point 2 is {value}, which float64 cannot hold"):
            taut.ball(points)
    if dtype != np.uint64:
        with pytest.raises(ValueError, match="coordinate 0 of point 1 is -9007199254740993"):
            taut.ball(np.array([[-(2**63)], [-(2**53) - 1]], dtype=dtype))


@pytest.mark.parametrize(
    ("value", "error", "message"),
    [
        (2**70 + 1, ValueError, "is 1180591620717411303425, which float64 cannot hold exactly"),
        (10**400, ValueError, "exceeds the largest number of float64"),
        (None, TypeError, "is of type NoneType: expected a real number"),
        ("7", TypeError, "is '7': expected a real number"),
        (1j, TypeError, "is of type complex: expected a real number"),
    ],
)
def test_objects_that_are_no_coordinates_are_named(value, error, message):
    points = np.array([[0.0, 1.0], [2.0, None]], dtype=object)
    points[1, 1] = value
    with pytest.raises(error, match=re.escape(f"coordinate 1 of point 1 {message}")):
        taut.ball(points)


def test_large_integers_that_fit_are_taken():
    assert taut.ball([[0], [2**70]]).answer.radius == pytest.approx(2.0**69, rel=1e-9)


def test_balls_of_single_precision_stay_so():
    centers = np.zeros((3, 2), np.float32)
    assert as_rows(centers, np.ones(3, np.float32)).dtype == np.float32
    assert as_rows(centers, np.ones(3)).dtype == np.float64
