"""Folders of tiles beside the triangulation in memory, read with NumPy, verified, and resumed."""

import numpy as np
import pytest

import taut
from taut._tiles import HULL, OTHER_TILE

MEMORY = 64 << 20


def sets(simplices):
    return {tuple(sorted(row)) for row in np.asarray(simplices).tolist()}


@pytest.mark.parametrize(("n", "d"), [(3000, 2), (800, 3), (250_000, 2)])
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
    points = taut.generate("uniform", 250_000, 2, seed=4)
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
