"""Sorted and transposed files, samples and orders of points, beside NumPy."""

import json
import pickle

import numpy as np
import pytest

import taut


@pytest.mark.parametrize(
    ("kind", "dtype"), [("u64", "<u8"), ("i64", "<i8"), ("f64", "<f8"), ("bytes", "S8")]
)
@pytest.mark.parametrize("memory", [64 << 10, 256 << 20])
def test_records_are_sorted_as_by_numpy(tmp_path, kind, dtype, memory):
    generator = np.random.default_rng(3)
    records = np.zeros(20_000, dtype=[("place", "<u4"), ("key", dtype), ("more", "<u4")])
    records["place"] = np.arange(len(records))
    keys = generator.integers(-500, 500, len(records))
    records["key"] = keys.astype("S8") if kind == "bytes" else keys.astype("<i8").view(dtype)
    if kind == "f64":
        records["key"] = keys / 7
    records.tofile(tmp_path / "in")
    found = taut.sort_file(tmp_path / "in", tmp_path / "out", width=16, key=(4, 12), kind=kind, memory=memory)
    ordered = np.fromfile(tmp_path / "out", dtype=records.dtype)
    assert (ordered == records[np.argsort(records["key"], kind="stable")]).all()
    assert found.answer == {"records": 20_000, "width": 16, "key": [4, 12], "key_kind": kind}
    verdict = found.check(tmp_path / "out", tmp_path / "in")
    assert (verdict.items, verdict.compared) == (20_000, True)
    assert not found.check(tmp_path / "out").compared
    with pytest.raises(taut.Violation, match="is not sorted: record"):
        found.check(tmp_path / "in")


def test_solutions_of_files_travel(tmp_path):
    np.arange(100, dtype="<u8")[::-1].tofile(tmp_path / "in")
    found = taut.sort_file(str(tmp_path / "in"), str(tmp_path / "out"), width=8)
    again = taut.FileSolution.from_json(found.to_json())
    assert again == found == pickle.loads(pickle.dumps(found))
    assert json.loads(found.to_json())["kind"] == found.kind == "sort"
    assert found.trace.counters["runs"] == 1
    assert repr(found) == "FileSolution(kind='sort', records=100, width=8)"
    other = taut.FileSolution.from_json(found.to_json().replace('"records": 100', '"records": 99'))
    with pytest.raises(taut.Violation, match="has 800 bytes: expected 792"):
        other.check(tmp_path / "out")
    with pytest.raises(ValueError, match="kind \"ball\""):
        taut.FileSolution.from_json(taut.ball([[0, 0], [1, 1]]).to_json())
    with pytest.raises(ValueError, match="kind \"sort\""):
        taut.Solution.from_json(found.to_json())


def test_what_cannot_be_sorted_is_named(tmp_path):
    (tmp_path / "in").write_bytes(bytes(100))
    (tmp_path / "out").write_text("before")
    for options, said in [
        ({"width": 16}, "100 bytes"),
        ({"width": 0}, "width"),
        ({"width": -1}, "width"),
        ({"width": 10, "key": (4, 20)}, "4..20"),
        ({"width": 10, "memory": 1024}, "memory"),
        ({"width": 10, "kind": "u32"}, "u32"),
    ]:
        with pytest.raises(ValueError, match=said):
            taut.sort_file(tmp_path / "in", tmp_path / "out", **options)
    with pytest.raises(FileNotFoundError, match="missing"):
        taut.sort_file(tmp_path / "missing", tmp_path / "out", width=8)
    with pytest.raises(TypeError):
        taut.sort_file(tmp_path / "in", tmp_path / "out", width=1.5)
    assert (tmp_path / "out").read_text() == "before"


@pytest.mark.parametrize("dtype", ["<f8", ">i4", "u1", "?", "c16", "S5", "U3", "M8[ns]", "V7", "f2"])
@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("shape", [(40, 30), (1, 8), (8, 1), (0, 3), (3, 0)])
def test_arrays_are_turned_as_by_numpy(tmp_path, dtype, order, shape):
    dtype = np.dtype(dtype)
    count = shape[0] * shape[1]
    values = np.random.default_rng(5).integers(0, 2, count * dtype.itemsize, dtype="u1").tobytes()
    matrix = np.asarray(np.frombuffer(values, dtype=dtype, count=count).reshape(shape), order=order)
    np.save(tmp_path / "in.npy", matrix)
    found = taut.transpose_file(tmp_path / "in.npy", tmp_path / "out.npy", memory=4096)
    turned = np.load(tmp_path / "out.npy")
    assert turned.dtype == dtype
    assert turned.shape == shape[::-1]
    assert turned.flags.c_contiguous
    assert turned.tobytes() == matrix.T.tobytes()
    np.save(tmp_path / "same.npy", np.ascontiguousarray(matrix.T))
    assert len((tmp_path / "same.npy").read_bytes()) == len((tmp_path / "out.npy").read_bytes())
    assert found.check(tmp_path / "out.npy", tmp_path / "in.npy").items == count
    # NumPy's own transpose is confirmed, too.
    assert found.check(tmp_path / "same.npy").items == count


def test_what_cannot_be_turned_is_named(tmp_path):
    path = tmp_path / "in.npy"
    for array, said in [
        (np.zeros(3), r"\(3,\)"),
        (np.zeros((1, 2, 3)), "2 axes"),
        (np.zeros((2, 2), dtype=[("a", "f8")]), "without fields"),
        (np.array([[1, "a"]], dtype=object), "object"),
    ]:
        np.save(path, array)
        with pytest.raises(ValueError, match=said):
            taut.transpose_file(path, tmp_path / "out.npy")
    np.save(path, np.zeros((2, 2)))
    with pytest.raises(ValueError, match="is the input"):
        taut.transpose_file(path, path)
    with pytest.raises(ValueError, match="rename"):
        taut.transpose_file(path, tmp_path / "out.bin")
    with pytest.raises(ValueError, match="raw files"):
        taut.transpose_file(path, tmp_path / "out.npy", rows=2)
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(ValueError, match="159 bytes: expected 160"):
        taut.transpose_file(path, tmp_path / "out.npy")
    path.write_bytes(b"1,2\n")
    with pytest.raises(ValueError, match="in.npy"):
        taut.transpose_file(path, tmp_path / "out.npy")
    with pytest.raises(FileNotFoundError):
        taut.transpose_file(tmp_path / "missing.npy", tmp_path / "out.npy")
    (tmp_path / "in.bin").write_bytes(bytes(range(6)))
    with pytest.raises(ValueError, match="`rows` and `columns`"):
        taut.transpose_file(tmp_path / "in.bin", tmp_path / "out.bin")
    taut.transpose_file(tmp_path / "in.bin", tmp_path / "out.bin", rows=2, columns=3, width=1)
    assert (tmp_path / "out.bin").read_bytes() == bytes([0, 3, 1, 4, 2, 5])


def test_samples_are_different_in_order_and_in_range():
    for n, k in [(0, 0), (5, 5), (10, 3), (2**64 - 1, 1000), (10**6, 10**5)]:
        rows = taut.sample(n, k, seed=9)
        assert rows.dtype == np.uint64
        assert len(rows) == k
        assert (rows[1:] > rows[:-1]).all()
        assert k == 0 or int(rows[-1]) < n
        assert (rows == taut.sample(n, k, seed=9)).all()
    assert (taut.sample(10**6, 100) != taut.sample(10**6, 100, seed=1)).any()
    for wrong in [(3, 4), (-1, 0), (2**64, 1)]:
        with pytest.raises(ValueError, match="option `"):
            taut.sample(*wrong)
    with pytest.raises(ValueError, match="option `seed`"):
        taut.sample(3, 2, seed=-1)


@pytest.mark.parametrize("curve", ["hilbert", "morton"])
@pytest.mark.parametrize("d", [2, 3])
def test_orders_are_those_of_the_set(curve, d):
    points = taut.generate("clouds", 2000, d, dtype="float32")
    found = taut.spatial_order(points, curve=curve)
    shuffled = np.random.default_rng(1).permutation(len(points))
    again = taut.spatial_order(points[shuffled], curve=curve)
    assert (points[shuffled][again.answer.rows] == points[found.answer.rows]).all()
    assert found.check(points).points == taut.verify(found.to_json(), points).points == 2000
    assert taut.Solution.from_json(found.to_json()) == found == pickle.loads(pickle.dumps(found))
    with pytest.raises(taut.Violation, match="the data changed"):
        found.check(points[::-1])
    steps = np.linalg.norm(np.diff(points[found.answer.rows], axis=0), axis=1).sum()
    assert steps < np.linalg.norm(np.diff(points, axis=0), axis=1).sum() / 4


def test_what_has_no_order_is_named():
    with pytest.raises(ValueError, match="1 coordinates"):
        taut.spatial_order([[1.0], [2.0]])
    with pytest.raises(ValueError, match="coordinate 1 of point 0"):
        taut.spatial_order([[1.0, np.nan]])
    with pytest.raises(ValueError, match="peano"):
        taut.spatial_order([[1.0, 2.0]], curve="peano")
    with pytest.raises(AttributeError, match="an order has no simplices"):
        _ = taut.spatial_order([[1.0, 2.0]]).simplices


def test_options_and_names_are_as_those_of_the_command(tmp_path):
    np.arange(100, dtype="<u8")[::-1].tofile(tmp_path / "in")
    with pytest.raises(ValueError, match="`scratch` and `resume` exclude each other"):
        taut.sort_file(
            tmp_path / "in", tmp_path / "out", width=8, scratch=tmp_path, resume=tmp_path / "runs"
        )
    taut.sort_file(bytes(tmp_path / "in"), bytes(tmp_path / "out"), width=8)
    np.save(tmp_path / "a.npy", np.arange(6).reshape(2, 3))
    (tmp_path / "a.npy").rename(tmp_path / "A.NPY")
    taut.transpose_file(bytes(tmp_path / "A.NPY"), tmp_path / "B.NPY")
    assert np.load(tmp_path / "B.NPY").tolist() == [[0, 3], [1, 4], [2, 5]]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["A.NPY", "B.NPY", "in", "out"]
