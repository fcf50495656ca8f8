"""Points out of files and meshes into files."""

import gzip

import numpy as np
import pytest

import taut


def test_points_of_text_files_by_columns(tmp_path):
    path = tmp_path / "table.csv"
    path.write_text("id,x,height,y\n1,0.5,9,2\n2,1e300,8,-0\n")
    for columns in ("x,y", ["x", "y"], [1, 3], "1,3"):
        assert taut.read_points(path, columns=columns).tolist() == [[0.5, 2], [1e300, 0]]
    assert taut.read_points(path, columns="1-2").tolist() == [[0.5, 9], [1e300, 8]]
    with pytest.raises(ValueError, match="comma"):
        taut.read_points(path, columns=["x,y"])


def test_header_and_format_can_be_said(tmp_path):
    path = tmp_path / "numbers.txt"
    path.write_text("1,2\n3,4\n")
    assert taut.read_points(path, format="csv").tolist() == [[1, 2], [3, 4]]
    assert taut.read_points(path, format="csv", header=True).tolist() == [[3, 4]]
    with pytest.raises(ValueError, match="nonsense"):
        taut.read_points(path, format="nonsense")


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_arrays_keep_their_bits_and_their_type(tmp_path, dtype):
    points = taut.generate("normal", 70_000, 3, dtype=dtype)
    np.save(tmp_path / "points.npy", points)
    found = taut.read_points(tmp_path / "points.npy")
    assert found.dtype == dtype and (found == points).all() and found.flags.owndata | found.flags.writeable
    kept = taut.read_points(tmp_path / "points.npy", bounds=[-1, -1, -1, 1, 1, 1])
    assert (kept == points[(np.abs(points) <= 1).all(axis=1)]).all()


def test_a_feature_by_name_or_number(tmp_path):
    path = tmp_path / "places.geojson"
    point = '{"type":"Feature","properties":{"name":"%s"},"geometry":{"type":"MultiPoint","coordinates":[[%d,1],[2,3]]}}'
    path.write_text('{"type":"FeatureCollection","features":[%s,%s]}' % (point % ("here", 5), point % ("there", 7)))
    assert taut.read_points(path, select="there").tolist() == [[7, 1], [2, 3]]
    assert taut.read_points(path, select=0).tolist() == [[5, 1], [2, 3]]


def test_messy_tables_are_read(tmp_path):
    path = tmp_path / "messy.csv"
    path.write_text("town;x;y\nUlm;1,5;2\nHof;NA;3\nHof;4;5,25\n")
    found = taut.read_points(path, columns="numeric", missing="drop", decimal=",")
    assert found.tolist() == [[1.5, 2], [4, 5.25]]
    with pytest.raises(ValueError, match=r'missing="drop"'):
        taut.read_points(path, columns="x,y", decimal=",")
    with pytest.raises(ValueError, match=r'decimal=","'):
        taut.read_points(path, columns="x,y", missing="drop")
    with pytest.raises(ValueError, match="missing is 'keep'"):
        taut.read_points(path, missing="keep")
    with pytest.raises(ValueError, match="decimal is ';'"):
        taut.read_points(path, decimal=";")


def test_what_is_wrong_is_named(tmp_path):
    path = tmp_path / "bad.csv"
    path.write_text("x,y\n1,2\n3,oops\n")
    with pytest.raises(ValueError, match=r"bad\.csv.*oops"):
        taut.read_points(path)
    with pytest.raises(FileNotFoundError, match="missing.csv"):
        taut.read_points(tmp_path / "missing.csv")
    whole = tmp_path / "whole.npy"
    np.save(whole, np.zeros((100, 2)))
    whole.write_bytes(whole.read_bytes()[:-8])
    with pytest.raises(ValueError, match=r"whole\.npy"):
        taut.read_points(whole)


def test_compressed_files_are_read_or_refused_by_name(tmp_path):
    path = tmp_path / "points.csv.gz"
    path.write_bytes(gzip.compress(b"0,1\n2,3\n"))
    assert taut.read_points(path).tolist() == [[0, 1], [2, 3]]
    path = tmp_path / "points.csv.zst"
    path.write_bytes(b"\x28\xb5\x2f\xfd")
    with pytest.raises(ValueError, match="zst"):
        taut.read_points(path)


def test_surfaces_with_normals_and_colors(tmp_path):
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.1], [0.3, 0.3, 1]])
    triangles = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]
    normals, colors = points - 0.3, np.arange(12).reshape(4, 3)
    for name in ("a.ply", "a.obj", "a.off"):
        more = {"normals": normals, "colors": colors} if name == "a.ply" else {}
        taut.write_mesh(tmp_path / name, points, triangles, **more)
        assert (taut.read_points(tmp_path / name) == points).all()
    taut.write_mesh(tmp_path / "text.ply", points, triangles, colors=colors, text=True)
    lines = (tmp_path / "text.ply").read_text().splitlines()
    assert lines[-4:] == ["3 0 2 1", "3 0 1 3", "3 1 2 3", "3 2 0 3"]
    assert lines[-8].split()[-3:] == ["0", "1", "2"]


def test_triangulations_in_the_plane_and_in_space(tmp_path):
    for d in (2, 3):
        points = taut.generate("uniform", 40, d)
        simplices = taut.delaunay(points).answer.simplices
        path = tmp_path / f"{d}.vtu"
        taut.write_mesh(path, points, simplices)
        assert path.stat().st_size > simplices.nbytes / 2


def test_meshes_that_are_none_write_nothing(tmp_path):
    path, points = tmp_path / "kept.ply", np.eye(3)
    path.write_text("earlier")
    for wrong, said in [
        ([[0, 1, 3]], "simplex 0 names row 3"),
        ([[0, 1, -1]], "row -1"),
        ([[0.5, 1, 2]], "float64"),
        ([0, 1, 2], "shape"),
        ([[0, 1, 2, 0, 1]], "shape"),
    ]:
        with pytest.raises(ValueError, match=said):
            taut.write_mesh(path, points, wrong)
    with pytest.raises(ValueError, match="normals"):
        taut.write_mesh(path, points, [[0, 1, 2]], normals=[[1, 2, 3]])
    with pytest.raises(ValueError, match="255"):
        taut.write_mesh(path, points, [[0, 1, 2]], colors=np.full((3, 3), 256))
    with pytest.raises(ValueError, match="surface"):
        taut.write_mesh(path, points[:, :2], [[0, 1, 2]], colors=np.zeros((3, 3), int))
    with pytest.raises(ValueError, match="NaN|finite"):
        taut.write_mesh(path, points * np.nan, [[0, 1, 2]])
    with pytest.raises(ValueError, match="nowhere"):
        taut.write_mesh(tmp_path / "a.nowhere", points, [[0, 1, 2]])
    with pytest.raises(FileNotFoundError):
        taut.write_mesh(tmp_path / "no" / "a.ply", points, [[0, 1, 2]])
    assert path.read_text() == "earlier"
