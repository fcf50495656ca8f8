"""Many point sets at once."""

import re

import numpy as np
import pytest

import taut


def test_each_answer_is_that_of_its_set_alone_for_any_number_of_threads():
    rng = np.random.default_rng(1)
    sets = [rng.normal(size=(n, d)) for n, d in [(40, 3), (1, 2), (3, 5), (500, 1), (7000, 10), (20, 4)]]
    alone = [taut.ellipsoid(points).to_json() for points in sets]
    for threads in [None, 1, 3]:
        assert [found.to_json() for found in taut.ellipsoids(sets, threads=threads)] == alone
    for found, points in zip(taut.ellipsoids(sets), sets, strict=True):
        assert found.check(points).gap <= 1e-9


@pytest.mark.parametrize("dtype", [np.float64, np.float32, np.int64, np.uint8])
def test_one_array_and_lists_of_any_kind_mean_the_same(dtype):
    sets = np.random.default_rng(2).integers(0, 100, size=(30, 12, 3)).astype(dtype)
    wanted = [taut.ellipsoid(points).to_json() for points in sets]
    fixed = sets.copy()
    fixed.flags.writeable = False
    for given in [
        sets,
        fixed,
        np.asfortranarray(sets),
        sets[:, ::-1][:, ::-1],
        list(sets),
        tuple(sets),
        iter(sets),
        sets.tolist() if dtype != np.float32 else sets,
        sets.transpose(0, 2, 1).copy().transpose(0, 2, 1),
        np.split(sets.reshape(-1, 3), 30),
    ]:
        assert [found.to_json() for found in taut.ellipsoids(given)] == wanted


def test_options_are_those_of_one():
    sets = np.random.default_rng(3).normal(size=(5, 60, 4))
    found = taut.ellipsoids(sets, epsilon=1e-2, method="away-steps", seed=3)
    wanted = [taut.ellipsoid(points, epsilon=1e-2, method="away-steps", seed=3) for points in sets]
    assert [f.to_json() for f in found] == [f.to_json() for f in wanted]
    assert taut.ellipsoids([]) == []
    assert taut.ellipsoids(np.empty((0, 5, 2))) == []


@pytest.mark.parametrize(
    "sets, error, words",
    [
        ([[[0, 0], [1, 1]], [[0, np.nan]]], ValueError, "point set 1: coordinate 1 of point 0 is NaN"),
        ([np.zeros((3, 2)), np.zeros((0, 2))], ValueError, "point set 1: the point set is empty"),
        (np.zeros((4, 0, 2)), ValueError, "point set 0: the point set is empty"),
        ([[[0, 0]], [1, 2]], ValueError, "point set 1: points have shape (2,): expected (n, d)"),
        ([[["a", "b"]]], TypeError, "point set 0: points have dtype <U1: expected real numbers"),
        ([None], ValueError, "point set 0: points have shape ()"),
        (np.zeros((4, 2)), ValueError, "sets have shape (4, 2): expected (m, n, d)"),
        (np.zeros((4, 2, 2), dtype=complex), TypeError, "sets have dtype complex128"),
        (np.full((2, 2, 2), 2**53 + 1), ValueError, "coordinate 0 of point 0 of point set 0 is 9007199254740993"),
        (5, TypeError, "iterable"),
    ],
)
def test_what_is_wrong_is_named_with_its_set(sets, error, words):
    with pytest.raises(error, match=re.escape(words)):
        taut.ellipsoids(sets)


def test_wrong_options_are_no_fault_of_a_set():
    for option in [{"epsilon": 1.0}, {"max_passes": 0}, {"threads": 0}, {"method": "best"}, {"seed": -1}]:
        with pytest.raises(ValueError, match="^(option|method)") as caught:
            taut.ellipsoids(np.zeros((1, 3, 2)), **option)
        assert "point set" not in str(caught.value)
