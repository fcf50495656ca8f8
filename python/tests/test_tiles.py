"""Folders of tiles beside the triangulation in memory, read with NumPy, verified, and resumed."""

import os

import numpy as np
import pytest

import taut
from taut._tiles import HULL, OTHER_TILE

MEMORY = 64 << 20
# Points of the plane that take several tiles.
MANY = 250_000 if "TAUT_LONG_TESTS" in os.environ else 120_000


def sets(simplices):
    return {tuple(sorted(row)) for row in np.asarray(simplices).tolist()}


@pytest.mark.parametrize(("n", "d"), [(3000, 2), (800, 3), (MANY, 2)])
def test_tiles_are_the_triangulation_in_memory(tmp_path, n, d):
    points = taut.generate("uniform", n, d, seed=3)
    tiles = taut.delaunay_tiles(points, tmp_path / "tiles", memory=MEMORY)
    found = taut.delaunay(points)
    assert (tiles.points, tiles.sites, tiles.dimension) == (n, n, d)
    assert tiles.fingerprint == found.fingerprint
    assert sets(np.concatenate([tile.simplices for tile in tiles])) == sets(found.simplices)
    verdict = tiles.check(points, memory=MEMORY, scratch=tmp_path)
    assert verdict["fingerprint"] == found.fingerprint
    assert verdict["counts"] == {"sites": n, "simplices": tiles.simplices, "hull": tiles.hull}
    owned = np.concatenate([np.delete(tile.rows, tile.copies) for tile in tiles])
    assert np.array_equal(np.sort(owned), np.arange(n))
    for tile in tiles:
        assert np.array_equal(tile.points, points[tile.rows])
        assert len(tile) == len(tile.vertices) == len(tile.neighbors)


def test_links_close_all_facets(tmp_path):
    points = taut.generate("uniform", MANY, 2, seed=4)
    tiles = taut.delaunay_tiles(points, tmp_path, memory=MEMORY)
    assert len(tiles) > 1
    across, linked, hull = 0, 0, 0
    for tile in tiles:
        across += np.count_nonzero(tile.neighbors == OTHER_TILE)
        hull += np.count_nonzero(tile.neighbors == HULL)
        inner = tile.links[:, 0] != HULL
        hull += np.count_nonzero(~inner)
        linked += 2 * np.count_nonzero(inner) + np.count_nonzero(~inner)
        for code, other, there in tile.links[inner][:50]:
            near, far = tile, tiles[tiles.numbers.index(other)]
            here = np.delete(near.simplices[code >> 2], code & 3)
            assert set(here) == set(np.delete(far.simplices[there >> 2], there & 3))
    assert (across, hull) == (linked, tiles.hull)


def test_a_file_is_mapped_and_equal_points_are_listed(tmp_path):
    points = taut.generate("uniform", 500, 3, seed=5)
    points = np.concatenate([points, points[:7]])
    np.save(tmp_path / "points.npy", points)
    tiles = taut.delaunay_tiles(tmp_path / "points.npy", tmp_path / "tiles")
    assert (tiles.sites, tiles.duplicates) == (500, 7)
    listed = np.concatenate([tile.duplicates for tile in tiles])
    assert sorted(map(tuple, listed.tolist())) == [(500 + k, k) for k in range(7)]
    assert tiles.check(str(tmp_path / "points.npy"))["duplicates"] == 7
    np.save(tmp_path / "wide.npy", np.asfortranarray(points))
    with pytest.raises(ValueError, match="C order"):
        taut.delaunay_tiles(tmp_path / "wide.npy", tmp_path / "other")


def area(polygon):
    x, y = polygon.T
    return 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))


def volume(faces):
    fans = [np.cross(face[1:-1], face[2:]) @ face[0] for face in faces]
    return np.concatenate(fans).sum() / 6


def test_cells_fill_the_box_and_are_those_of_their_sites(tmp_path):
    points = taut.generate("uniform", MANY, 2, seed=7)
    tiles = taut.delaunay_tiles(points, tmp_path / "plane", memory=MEMORY)
    assert len(tiles) > 1
    cells = list(tiles.voronoi_cells(([0, 0], [1, 1])))
    assert sorted(cell.row for cell in cells) == list(range(len(points)))
    assert sum(area(cell.faces[0]) for cell in cells) == pytest.approx(1, abs=1e-12)
    for cell in cells[::5000]:
        middle = cell.faces[0].mean(axis=0)
        assert np.square(points - middle).sum(axis=1).argmin() == cell.row
    solid = taut.generate("uniform", 2000, 3, seed=8)
    tiles = taut.delaunay_tiles(solid, tmp_path / "space")
    cells = list(tiles.voronoi_cells(([0, 0, 0], [2, 1, 1])))
    assert sorted(cell.row for cell in cells) == list(range(len(solid)))
    assert sum(volume(cell.faces) for cell in cells) == pytest.approx(2, abs=1e-12)


def test_the_box_of_cells_is_that_of_the_points_and_a_tenth_more(tmp_path):
    points = np.array([[0.0, 0], [10, 0], [0, 4], [10, 4]])
    tiles = taut.delaunay_tiles(points, tmp_path / "four")
    corners = np.concatenate([cell.faces[0] for cell in tiles.voronoi_cells()])
    assert corners.min(axis=0).tolist() == [-1, -1]
    assert corners.max(axis=0).tolist() == [11, 5]
    # Out of the box there is nothing of a cell.
    assert [cell.faces for cell in tiles.voronoi_cells(([0, 0], [1, 1]))].count([]) == 3
    line = taut.delaunay_tiles([[0.0, 0], [1, 0], [3, 0]], tmp_path / "line")
    assert [area(cell.faces[0]) for cell in sorted(line.voronoi_cells(([0, 0], [4, 1])))] == [0.5, 1.5, 2]
    nothing = taut.delaunay_tiles(np.empty((0, 2)), tmp_path / "nothing")
    assert list(nothing.voronoi_cells()) == []


@pytest.mark.parametrize(("n", "d", "alpha"), [(MANY, 2, 0.0015), (3000, 3, 0.06)])
def test_alpha_complexes_have_the_small_simplices(tmp_path, n, d, alpha):
    points = taut.generate("uniform", n, d, seed=9)
    tiles = taut.delaunay_tiles(points, tmp_path, memory=MEMORY)
    parts = list(tiles.alpha_complex(alpha))
    assert len(parts) == len(tiles)
    simplices = np.concatenate([part.simplices for part in parts])
    every = taut.delaunay(points).simplices
    corners = points[every]
    edges = corners[:, 1:] - corners[:, :1]
    centers = np.linalg.solve(2 * edges, np.square(edges).sum(axis=2)[:, :, None])[:, :, 0]
    radii = np.linalg.norm(centers, axis=1)
    # Radii so near to alpha are a matter of rounding.
    assert np.abs(radii - alpha).min() > 1e-12
    assert sets(simplices) == sets(every[radii <= alpha])
    # A facet of one of the simplices is on the boundary, one of two is not.
    facets = np.sort(np.concatenate([np.delete(simplices, k, axis=1) for k in range(d + 1)]), axis=1)
    found, counts = np.unique(facets, axis=0, return_counts=True)
    boundary = np.concatenate([part.boundary for part in parts])
    assert len(boundary) > 100
    assert sets(boundary) == sets(found[counts == 1])
    singular = np.concatenate([part.singular for part in parts])
    assert singular.shape[1] == d
    assert not sets(singular) & sets(found)


def test_wrong_boxes_and_radii_are_refused(tmp_path):
    tiles = taut.delaunay_tiles(taut.generate("uniform", 100, 2), tmp_path)
    for box in [([0, 0, 0], [1, 1, 1]), ([0, 0], [np.nan, 1]), ([1, 0], [0, 1])]:
        with pytest.raises(ValueError, match="box"):
            tiles.voronoi_cells(box)
    for alpha in [-1, np.nan]:
        with pytest.raises(ValueError, match="alpha"):
            tiles.alpha_complex(alpha)
    with pytest.raises(ValueError, match="memory"):
        tiles.alpha_complex(1, memory=-1)


def test_what_is_wrong_is_refused(tmp_path):
    points = taut.generate("uniform", 500, 2, seed=6)
    folder = tmp_path / "tiles"
    tiles = taut.delaunay_tiles(points, folder)
    with pytest.raises(ValueError, match="not empty"):
        taut.delaunay_tiles(points, folder)
    assert taut.delaunay_tiles(points, folder, resume=True).fingerprint == tiles.fingerprint
    with pytest.raises(taut.Violation, match="the data changed"):
        tiles.check(points[::-1])
    with pytest.raises(MemoryError):
        tiles.check(points, memory=1000)
    with pytest.raises(ValueError, match="memory"):
        taut.delaunay_tiles(points, tmp_path / "new", memory=1000)
    with pytest.raises(ValueError, match="coordinate 1 of point 2"):
        taut.delaunay_tiles([[0, 0], [1, 0], [0, np.nan]], tmp_path / "nan")
    path = folder / "tile-00000000.ttd"
    data = bytearray(path.read_bytes())
    data[200] ^= 1
    path.write_bytes(data)
    with pytest.raises(taut.Violation):
        tiles.check(points)
    path.write_bytes(data[:-30])
    with pytest.raises(ValueError, match="damaged or cut"):
        tiles[0]
    with pytest.raises(FileNotFoundError):
        taut.Tiles(tmp_path / "nothing")
