"""Contour lines and rasters, of points in memory and of a folder of tiles."""

import numpy as np
import pytest

import taut


def hills(n=5000):
    points = taut.generate("uniform", n, 3, seed=3)
    points[:, 2] = np.sin(7 * points[:, 0]) + np.cos(5 * points[:, 1])
    return points


def test_a_plane_is_reproduced():
    points = np.floor(taut.generate("uniform", 2000, 3, seed=1) * 1024)
    points[:, 2] = 3 * points[:, 0] - 7 * points[:, 1] + 0.5
    for interpolation in ["linear", "natural"]:
        found = taut.raster(points, 16, interpolation=interpolation)
        rows, columns = np.nonzero(~np.isnan(found.values))
        assert len(rows) > 3500
        x = found.west + (columns + 0.5) * found.cell
        y = found.north - (rows + 0.5) * found.cell
        assert (found.values[rows, columns] == 3 * x - 7 * y + 0.5).all()


def test_lines_are_closed_or_end_at_the_hull():
    lines = taut.contours(hills(), interval=0.25)
    assert len(lines) > 10
    hull = taut.delaunay(hills()[:, :2]).hull
    ends = hills()[hull][:, :, :2]
    for line in lines:
        assert line.height % 0.25 == 0
        if not line.closed:
            for p in (line.places[0], line.places[-1]):
                a, b = ends[:, 0], ends[:, 1]
                cross = (b - a)[:, 0] * (p - a)[:, 1] - (b - a)[:, 1] * (p - a)[:, 0]
                assert np.abs(cross).min() < 1e-12


def test_tiles_give_the_same(tmp_path):
    points = hills()
    tiles = taut.delaunay_tiles(points[:, :2], tmp_path / "tiles", memory=64 << 20)
    for interpolation in ["linear", "natural"]:
        expected = taut.raster(points, 0.01, interpolation=interpolation)
        found = taut.raster(points, 0.01, interpolation=interpolation, tiles=tiles)
        assert np.array_equal(found.values, expected.values, equal_nan=True)

    def key(line):
        return line.height, line.places.tolist()

    expected = sorted(map(key, taut.contours(points, levels=[-0.5, 0.5])))
    assert sorted(map(key, taut.contours(points, levels=[0.5, -0.5], tiles=tiles))) == expected
    with pytest.raises(ValueError, match="other points"):
        taut.contours(points[1:], levels=[0.5], tiles=tiles)


def test_wrong_input_is_refused():
    points = hills(100)
    with pytest.raises(ValueError, match="either `interval` or `levels`"):
        taut.contours(points)
    with pytest.raises(ValueError, match="interval"):
        taut.contours(points, interval=0.0)
    with pytest.raises(ValueError, match="levels"):
        taut.contours(points, levels=[np.nan])
    with pytest.raises(ValueError, match="cell"):
        taut.raster(points, -1.0)
    with pytest.raises(ValueError, match="interpolation"):
        taut.raster(points, 0.1, interpolation="cubic")
    with pytest.raises(ValueError, match=r"\(n, 3\)"):
        taut.raster(points[:, :2], 0.1)
    points[7, 2] = np.nan
    with pytest.raises(ValueError, match="7"):
        taut.contours(points, levels=[0.5])
    assert taut.contours(hills(100), levels=[1e9]) == []
