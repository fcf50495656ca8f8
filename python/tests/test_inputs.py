"""The kinds of containers that points come in: read alike, without a copy where the layout allows it, or refused by name."""

import array
import importlib
import mmap
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import taut
from taut._arrays import as_rows

POINTS = np.random.default_rng(4).random((60, 3))


def library(name):
    return pytest.importorskip(name, reason=f"{name} is not installed")


class Tensor:
    """A container that speaks DLPack and nothing else."""

    def __init__(self, array, device=1):
        self.array, self.device = array, device

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.device, 0


class Stream:
    """A table that speaks Arrow and nothing else."""

    def __init__(self, table):
        self.table = table

    def __arrow_c_stream__(self, requested_schema=None):
        return self.table.__arrow_c_stream__(requested_schema)


class Mesh:
    """An object with points or vertices, as those of Open3D and PyVista are."""

    def __init__(self, **parts):
        self.__dict__.update(parts)


def arrow_lists(points):
    arrow = library("pyarrow")
    return arrow.FixedSizeListArray.from_arrays(arrow.array(points.ravel()), points.shape[1])


def arrow_table(points):
    return library("pyarrow").table({name: column for name, column in zip("xyz", points.T)})


def data_frame(points, dtype=None):
    frame = library("pandas").DataFrame(points, columns=list("xyz"), copy=False)
    if dtype == "double[pyarrow]":
        library("pyarrow")
    return frame if dtype is None else frame.astype(dtype)


def columns_frame(points):
    """Columns of two types, which pandas keeps in two blocks."""
    frame = data_frame(points.astype(np.float32).astype(np.float64))
    frame["x"] = frame["x"].astype(np.float64)
    for i, name in enumerate("xyz"):
        frame[name] = points[:, i]
    return frame


def polars_frame(points):
    return library("polars").DataFrame({name: column for name, column in zip("xyz", points.T)})


def polars_arrays(points):
    polars = library("polars")
    return polars.Series("points", points, dtype=polars.Array(polars.Float64, 3))


def geometries(points):
    return library("shapely").points(points)


def cloud(points):
    return library("trimesh").PointCloud(points)


def mapped(points):
    memory = mmap.mmap(-1, points.nbytes)
    memory.write(points.tobytes())
    return np.frombuffer(memory, dtype=np.float64).reshape(points.shape)


# Each kind with whether the memory of the points is read where it lies.
KINDS = {
    "float64": (lambda p: p.copy(), True),
    "read-only": (lambda p: np.frombuffer(p.tobytes()).reshape(p.shape), True),
    "rows of a larger array": (lambda p: np.vstack([p, p])[: len(p)], True),
    "mapped memory": (mapped, True),
    "memoryview": (memoryview, True),
    "subclass": (lambda p: p.view(np.recarray).view(np.ndarray), True),
    "DLPack": (Tensor, True),
    "points of an object": (lambda p: Mesh(points=p), True),
    "vertices of an object": (lambda p: Mesh(vertices=p), True),
    "points before vertices": (lambda p: Mesh(points=p, vertices=np.zeros((2, 3), int)), True),
    "pandas frame of one block": (data_frame, True),
    "polars arrays": (polars_arrays, True),
    "Arrow lists of one length": (arrow_lists, True),
    "Arrow lists in chunks of one": (lambda p: library("pyarrow").chunked_array([arrow_lists(p)]), True),
    "Arrow table of lists": (lambda p: library("pyarrow").table({"p": arrow_lists(p)}), True),
    "Arrow stream of lists": (lambda p: Stream(library("pyarrow").table({"p": arrow_lists(p)})), True),
    "Trimesh": (lambda p: library("trimesh").Trimesh(p, [[0, 1, 2]], process=False), True),
    "PointCloud": (cloud, True),
    "lists": (lambda p: p.tolist(), False),
    "tuple of tuples": (lambda p: tuple(map(tuple, p.tolist())), False),
    "rows as array.array": (lambda p: [array.array("d", row) for row in p.tolist()], False),
    "Fortran order": (np.asfortranarray, False),
    "strided": (lambda p: np.repeat(p, 2, axis=0)[::2], False),
    "columns of a larger array": (lambda p: np.hstack([p, p])[:, :3], False),
    "long double": (lambda p: p.astype(np.longdouble), False),
    "big-endian": (lambda p: p.astype(">f8"), False),
    "objects": (lambda p: p.astype(object), False),
    "fractions": (lambda p: [[Fraction(x) for x in row] for row in p.tolist()], False),
    "decimals": (lambda p: [[Decimal(x) for x in row] for row in p.tolist()], False),
    "pandas frame of columns": (columns_frame, False),
    "pandas nullable": (lambda p: data_frame(p, "Float64"), False),
    "pandas backed by Arrow": (lambda p: data_frame(p, "double[pyarrow]"), False),
    "polars frame": (polars_frame, False),
    "Arrow table": (arrow_table, False),
    "Arrow record batch": (lambda p: arrow_table(p).to_batches()[0], False),
    "Arrow stream": (lambda p: Stream(arrow_table(p)), False),
    "Arrow lists in chunks": (
        lambda p: library("pyarrow").chunked_array([arrow_lists(p[:20]), arrow_lists(p[20:])]), False),
    "Arrow structs": (lambda p: arrow_table(p).to_struct_array(), False),
    "shapely geometries": (geometries, False),
    "list of shapely geometries": (lambda p: list(geometries(p)), False),
    "shapely MultiPoint": (lambda p: library("shapely").MultiPoint(p), False),
    "GeoSeries": (lambda p: library("geopandas").GeoSeries(geometries(p)), False),
    "GeoDataFrame": (lambda p: library("geopandas").GeoDataFrame({"n": range(len(p))}, geometry=geometries(p)), False),
}


@pytest.mark.parametrize("kind", KINDS)
def test_kinds_of_containers_are_read_alike(kind):
    make, is_shared = KINDS[kind]
    given = make(POINTS)
    rows = as_rows(given)
    np.testing.assert_array_equal(rows, POINTS)
    assert rows.dtype == np.float64 and rows.flags.c_contiguous
    again = as_rows(given)
    if is_shared:
        assert rows.ctypes.data == again.ctypes.data, "read where it lies"
    assert taut.ball(given) == taut.ball(POINTS)


def test_there_are_37_kinds_and_more():
    assert len(KINDS) >= 37


REFUSED = {
    "sparse matrix": (
        lambda: importlib.import_module("scipy.sparse").csr_matrix(POINTS), "sparse csr_matrix: pass points.toarray"),
    "sparse array": (lambda: importlib.import_module("scipy.sparse").coo_array(POINTS), "sparse coo_array"),
    "lazy frame": (lambda: polars_frame(POINTS).lazy(), r"lazy LazyFrame: call collect\(\) first"),
    "tensor of a graphics card": (lambda: Tensor(POINTS, device=2), "on another device: move them to the CPU"),
    "null in pandas": (lambda: data_frame(POINTS, "Float64").mask(POINTS > POINTS.max() - 1e-9), "null in row"),
    "null in polars": (lambda: polars_frame(POINTS).with_columns(y=library("polars").lit(None)), "null in row 0, column 'y'"),
    "null in Arrow": (
        lambda: library("pyarrow").table({"x": [1.0, None], "y": [0.0, 1.0]}), "null in row 1, column 'x'"),
    "null in lists": (
        lambda: library("pyarrow").array([[0.0, 1.0], None], library("pyarrow").list_(library("pyarrow").float64(), 2)),
        "null in row 1"),
    "null within lists": (
        lambda: library("pyarrow").array(
            [[0.0, 1.0], [2.0, None]], library("pyarrow").list_(library("pyarrow").float64(), 2)),
        "null in row 1, column 1"),
    "empty geometry": (lambda: [*geometries(POINTS), library("shapely").Point()], "geometry 60 .* missing or empty"),
    "missing geometry": (
        lambda: library("geopandas").GeoSeries([*geometries(POINTS), None]), "geometry 60 .* missing or empty"),
    "texts in pandas": (lambda: library("pandas").DataFrame({"x": [0.0], "y": ["a"]}), "expected real numbers|real number"),
    "any object": (lambda: Mesh(), "points are a Mesh: expected an array, a frame, or an object with points"),
    "set": (lambda: {1.0, 2.0}, "points"),
}


@pytest.mark.parametrize("kind", REFUSED)
def test_what_cannot_be_read_is_named(kind):
    if kind.startswith("sparse"):
        library("scipy")
    make, message = REFUSED[kind]
    with pytest.raises((TypeError, ValueError), match=message):
        taut.ball(make())


def test_no_object_array_is_converted_number_by_number(monkeypatch):
    monkeypatch.setattr(taut._arrays, "_refuse_objects", None)
    integers = np.array([[0, 2**70], [1, -5]], dtype=object)
    assert as_rows(integers).tolist() == [[0, 2.0**70], [1, -5]]
    as_rows(POINTS.astype(object))
    as_rows([[True, 2], [0.5, 3]])


def test_integers_of_columns_stay_exact():
    pandas = library("pandas")
    frame = pandas.DataFrame({"x": [0, 2**53 + 1]}, dtype="Int64")
    with pytest.raises(ValueError, match="coordinate 0 of point 1 is 9007199254740993, which float64 cannot hold"):
        taut.ball(frame)
