"""Generated points are those of the Rust library."""

import typing

import numpy as np
import pytest

import taut

PARAMETERS = {
    "shell": {"thickness": 0.25},
    "clusters": {"count": 3, "spread": 0.01},
    "clouds": {"count": 3},
    "polygon": {"vertices": 7},
    "grid": {"side": 5, "angle": 30.0},
    "spiral": {"turns": 3.5},
    "roads": {"count": 4},
    "torus": {"noise": 0.1},
}
ALL = [*typing.get_args(taut._generate.Distribution)]


@pytest.mark.parametrize("distribution", ALL)
def test_a_point_depends_on_seed_and_number_alone(distribution):
    parameters = PARAMETERS.get(distribution, {})
    many = taut.generate(distribution, 20_000, 7, seed=3, **parameters)
    few = taut.generate(distribution, 10, 7, seed=3, **parameters)
    assert many.shape == (20_000, 7)
    assert many.dtype == np.float64
    assert (many[:10] == few).all()
    narrow = taut.generate(distribution, 10, 7, seed=3, dtype=np.float32, **parameters)
    assert (narrow == few.astype(np.float32)).all()


def test_shapes_are_what_they_say():
    assert set(np.unique(taut.generate("cube", 100, 5))) == {0.0, 1.0}
    norms = np.linalg.norm(taut.generate("sphere", 100, 9), axis=1)
    assert norms == pytest.approx(np.ones(100), rel=1e-14)
    assert taut.generate("polygon", 4, 2, vertices=4) == pytest.approx(
        np.array([[1, 0], [0, 1], [-1, 0], [0, -1]]), abs=1e-15
    )
    normal = taut.generate("normal", 100_000, 3, seed=1)
    assert abs(normal.mean()) < 0.01
    assert abs(normal.std() - 1) < 0.01
    assert not (normal == taut.generate("normal", 100_000, 3, seed=2)).any()


@pytest.mark.parametrize(
    ("arguments", "parameters", "message"),
    [
        (("gauss", 10, 2), {}, "`distribution` is gauss: expected normal"),
        (("normal", 10, 2), {"spread": 1.0}, "`spread` belongs to clusters, not to normal"),
        (("shell", 10, 2), {"thickness": -1.0}, "`thickness` is -1"),
        (("clusters", 10, 2), {"count": 0, "spread": 1.0}, "`count` is 0"),
        (("polygon", 10, 2), {"vertices": -1}, "`vertices` is -1"),
        (("polygon", 10, 2), {"count": 3}, "`count` belongs to clusters, clouds and roads, not to"),
        (("grid", 10, 2), {"side": 2**53 + 1}, "`side` is 9007199254740993"),
        (("spiral", 10, 2), {"turns": float("nan")}, "`turns` is NaN"),
        (("normal", 10, 0), {}, "`d` is 0: expected at least 1"),
        (("normal", 10, -2), {}, "`d` is -2: expected at least 1"),
        (("normal", -1, 2), {}, "`n` is -1: expected at least 0"),
        (("normal", 10, 2), {"dtype": np.int32}, "dtype is int32"),
        (("normal", 10, 2), {"seed": -1}, "`seed` is -1"),
    ],
)
def test_parameters_out_of_range_are_named(arguments, parameters, message):
    with pytest.raises(ValueError, match=message):
        taut.generate(*arguments, **parameters)


def test_defaults_are_those_of_the_command_line():
    for distribution, parameters in {
        "shell": {"thickness": 0.1},
        "clusters": {"count": 5, "spread": 0.05},
        "clouds": {"count": 10},
        "polygon": {"vertices": 12},
        "grid": {"side": 3, "angle": 0.0},
        "spiral": {"turns": 10.0},
        "roads": {"count": 8},
        "torus": {"noise": 1e-4},
    }.items():
        by_default = taut.generate(distribution, 12, 3)
        assert (by_default == taut.generate(distribution, 12, 3, **parameters)).all()


def test_no_points_are_no_points():
    assert taut.generate("normal", 0, 3).shape == (0, 3)


def test_more_points_than_memory_are_an_error():
    with pytest.raises(MemoryError):
        taut.generate("normal", 10**13, 1000)
    with pytest.raises(MemoryError, match="do not fit"):
        taut.generate("normal", 10**30, 3)


def test_numbers_of_points_are_whole():
    for n, d in [(1.5, 2), (10, "2"), (None, 2)]:
        with pytest.raises(TypeError):
            taut.generate("normal", n, d)
