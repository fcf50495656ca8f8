//! The independent checker of folders: it accepts what the tree writes, of every set, and refuses every forgery.

mod order;

use std::fs;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use taut_certify::{TilesError, TilesOptions, TilesVerdict, TilesViolation, check_tiles};
use taut_points::{
    Distribution, GeneratedSource, PointSource, Points, ReadError, Rows, ScalarKind, Scratch,
};

use super::super::front::Link;
use super::super::{
    Dim, Dimension, FolderOptions, NO_NEIGHBOR, OTHER_TILE, Tile, delaunay_to_folder,
};
use super::buckets::{Cut, tiles};
use super::folders::Forgery;
use super::sets::{plane, some, space, uniform};
use crate::test_length::long_or;
use crate::{DelaunayOptions, delaunay};

const CUT: Cut = Cut { levels: 4, merge_above: 60, threads: 2, stride: 1 };

fn check<const D: usize>(forgery: &Forgery<D>) -> Result<TilesVerdict, TilesError> {
    let folder = tempfile::tempdir().unwrap();
    forgery.write(folder.path());
    check_folder(folder.path(), &forgery.points)
}

fn check_folder<const D: usize>(
    folder: &Path,
    points: &[[f64; D]],
) -> Result<TilesVerdict, TilesError> {
    let points = Points::new(points.as_flattened(), D).unwrap();
    let options = TilesOptions { memory: 16 << 20, ..TilesOptions::default() };
    check_tiles(folder, &points, &options)
}

fn honest<const D: usize>(points: &[[f64; D]], cut: Cut) -> Forgery<D>
where
    Dim<D>: Dimension<D>,
{
    Forgery::new(points, tiles(points, cut).0)
}

fn violation<const D: usize>(forgery: &Forgery<D>) -> TilesViolation {
    match check(forgery) {
        Err(TilesError::Rejected(violation)) => violation,
        other => panic!("{other:?}"),
    }
}

fn all_are_accepted<const D: usize>(sets: impl Iterator<Item = (&'static str, Vec<[f64; D]>)>)
where
    Dim<D>: Dimension<D>,
{
    for (name, points) in sets {
        let view = Points::new(points.as_flattened(), D).unwrap();
        let expected = delaunay(&view, &DelaunayOptions::default()).unwrap();
        for cut in [CUT, Cut { levels: 1, merge_above: 1, stride: 3, ..CUT }] {
            let found =
                check(&honest(&points, cut)).unwrap_or_else(|error| panic!("{name}: {error}"));
            let certificate = &expected.certificate;
            assert_eq!(found.fingerprint, certificate.fingerprint, "{name}");
            assert_eq!(found.counts, certificate.counts, "{name}");
            assert_eq!(found.hull_dimension, expected.answer.hull_dimension, "{name}");
            assert_eq!(found.duplicates, expected.answer.duplicates.len() as u64, "{name}");
            let proved = expected.check(&view).unwrap();
            assert_eq!(found.ties, proved.ties, "{name}");
        }
    }
}

#[test]
fn every_set_of_the_plane_is_accepted() {
    all_are_accepted(some(plane(), 3));
}

#[test]
fn every_set_of_space_is_accepted() {
    all_are_accepted(some(space(), 3));
}

/// The forger's own neighbors are accepted as well: what is refused below is refused for what was changed.
#[test]
fn rebuilt_tiles_are_accepted() {
    for (name, points) in some(plane(), 4) {
        let mut forgery = honest(&points, CUT);
        forgery.rebuild();
        check(&forgery).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
    for (name, points) in some(space(), 4) {
        let mut forgery = honest(&points, CUT);
        forgery.rebuild();
        check(&forgery).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

/// Tiles of several chunks, from files.
#[test]
fn folders_on_disk_are_accepted_within_little_memory() {
    for (n, dim) in [(150_000, 2), (30_000, 3)] {
        let source =
            GeneratedSource::new(Distribution::Uniform, n, dim, 5, ScalarKind::F64).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let options = FolderOptions { memory: 64 << 20, threads: Some(2), ..Default::default() };
        let written = delaunay_to_folder(&source, folder.path(), &options).unwrap();
        let mut found = vec![];
        for memory in [16 << 20, 20 << 20, 512 << 20] {
            let options = TilesOptions { memory, ..TilesOptions::default() };
            found.push(check_tiles(folder.path(), &source, &options).unwrap());
        }
        assert!(found.iter().all(|verdict| *verdict == found[0]), "{found:?}");
        assert_eq!(found[0].fingerprint, written.totals.fingerprint);
        assert_eq!(found[0].points_hash, written.points_hash);
    }
}

#[test]
fn too_little_memory_is_told_with_what_is_needed() {
    let points = uniform::<2>(300, 3);
    let folder = tempfile::tempdir().unwrap();
    honest(&points, CUT).write(folder.path());
    let view = Points::new(points.as_flattened(), 2).unwrap();
    let options = TilesOptions { memory: 1 << 20, ..TilesOptions::default() };
    let refused = check_tiles(folder.path(), &view, &options);
    assert!(matches!(refused, Err(TilesError::Memory { needed: 16_777_216, .. })), "{refused:?}");
}

/// The place of a tile with at least so many simplices, and one of them that is surrounded by simplices of the tile.
fn inner_simplex<const D: usize>(forgery: &Forgery<D>) -> (usize, usize) {
    let is_inner = |tile: &Tile<D>, s: usize| {
        tile.neighbors[s * (D + 1)..][..D + 1].iter().all(|&n| n < OTHER_TILE)
    };
    let mut all = forgery
        .tiles
        .iter()
        .enumerate()
        .flat_map(|(place, tile)| (0..tile.counts.simplices as usize).map(move |s| (place, s)));
    all.find(|&(place, s)| is_inner(&forgery.tiles[place], s)).unwrap()
}

/// A simplex with a facet of this kind, and the facet.
fn facet_with<const D: usize>(forgery: &Forgery<D>, neighbor: u32) -> (usize, usize) {
    let mut all = forgery.tiles.iter().enumerate().flat_map(|(place, tile)| {
        tile.neighbors.iter().enumerate().map(move |(at, &n)| (place, at, n))
    });
    all.find(|&(_, _, n)| n == neighbor).map(|(place, at, _)| (place, at)).unwrap()
}

fn drop_simplex<const D: usize>(forgery: &mut Forgery<D>, (place, simplex): (usize, usize)) {
    let tile = &mut forgery.tiles[place];
    tile.simplices.drain(simplex * (D + 1)..(simplex + 1) * (D + 1));
    forgery.rebuild();
}

fn simplices_are_refused<const D: usize>(points: &[[f64; D]])
where
    Dim<D>: Dimension<D>,
{
    let right = honest(points, CUT);
    // Dropped inside: the hole is a dent of the hull.
    let mut forgery = right.clone();
    let inner = inner_simplex(&right);
    drop_simplex(&mut forgery, inner);
    let found = violation(&forgery);
    let is_of_hull = |found: &TilesViolation| {
        use TilesViolation::{HullDent, HullOpen, HullWinding};
        matches!(found, HullDent { .. } | HullOpen { .. } | HullWinding { .. })
    };
    assert!(is_of_hull(&found), "{found}");
    // Dropped on the hull.
    let mut forgery = right.clone();
    let (place, at) = facet_with(&right, NO_NEIGHBOR);
    drop_simplex(&mut forgery, (place, at / (D + 1)));
    let found = violation(&forgery);
    assert!(is_of_hull(&found) || matches!(found, TilesViolation::Site { .. }), "{found}");
    // Repeated, in its tile and in another one.
    for other in [false, true] {
        let mut forgery = right.clone();
        let (place, simplex) = inner;
        let vertices: Vec<u32> = right.tiles[place].simplex_rows().nth(simplex).unwrap().to_vec();
        if other {
            let to = (place + 1) % right.tiles.len();
            let numbers: Vec<u32> =
                vertices.iter().map(|&v| copy_site(&mut forgery, place, v, to)).collect();
            forgery.tiles[to].counts.vertices_per_simplex = D as u32 + 1;
            forgery.tiles[to].simplices.extend(numbers);
        } else {
            forgery.tiles[place].simplices.extend(vertices);
        }
        forgery.rebuild();
        let found = violation(&forgery);
        assert!(matches!(found, TilesViolation::Neighbor { .. }) || is_of_hull(&found), "{found}");
    }
    // Turned over.
    let mut forgery = right.clone();
    let (place, simplex) = inner;
    forgery.tiles[place].simplices.swap(simplex * (D + 1), simplex * (D + 1) + 1);
    forgery.rebuild();
    let tile = right.tiles[place].counts.tile;
    let expected = TilesViolation::Orientation { tile, simplex: simplex as u64 };
    assert_eq!(violation(&forgery), expected);
    // A vertex replaced by another site of the tile.
    let mut forgery = right.clone();
    let vertices = right.tiles[place].simplex_rows().nth(simplex).unwrap().to_vec();
    let other = (0..).find(|v| !vertices.contains(v)).unwrap();
    forgery.tiles[place].simplices[simplex * (D + 1)] = other;
    forgery.rebuild();
    violation(&forgery);
    // All tiles twice.
    let mut forgery = right.clone();
    forgery.tiles.extend(right.tiles.iter().map(|tile| {
        let mut tile = tile.clone();
        tile.counts.tile += 1000;
        tile.copies = (0..tile.rows.len() as u32).collect();
        tile.duplicates.clear();
        tile
    }));
    forgery.rebuild();
    let found = violation(&forgery);
    assert!(matches!(found, TilesViolation::Neighbor { .. }) || is_of_hull(&found), "{found}");
}

/// The number of a site of another tile in this tile, where it is a copy if it was not there.
fn copy_site<const D: usize>(forgery: &mut Forgery<D>, from: usize, site: u32, to: usize) -> u32 {
    let (row, p) = {
        let tile = &forgery.tiles[from];
        (tile.rows[site as usize], tile.coordinates[site as usize])
    };
    let tile = &mut forgery.tiles[to];
    if let Some(number) = tile.rows.iter().position(|&other| other == row) {
        return number as u32;
    }
    tile.rows.push(row);
    tile.coordinates.push(p);
    tile.copies.push(tile.rows.len() as u32 - 1);
    tile.rows.len() as u32 - 1
}

#[test]
fn forged_simplices_are_refused() {
    simplices_are_refused(&uniform::<2>(800, 21));
    simplices_are_refused(&uniform::<3>(500, 22));
}

/// Another Delaunay triangulation of a grid, and one that is none at all.
#[test]
fn flipped_edges_are_refused() {
    let grid: Vec<[f64; 2]> = (0..400).map(|i| [f64::from(i % 20), f64::from(i / 20)]).collect();
    for (points, is_tie) in [(grid, true), (uniform::<2>(400, 23), false)] {
        let right = honest(&points, CUT);
        let mut flips = 0;
        for place in 0..right.tiles.len() {
            for s in 0..right.tiles[place].counts.simplices as usize {
                for facet in 0..3 {
                    let tile = &right.tiles[place];
                    let t = tile.neighbors[3 * s + facet];
                    if t >= OTHER_TILE || (t as usize) < s || flips >= 40 {
                        continue;
                    }
                    let t = t as usize;
                    let [a, b, c] = [0, 1, 2].map(|k| tile.simplices[3 * s + (facet + k) % 3]);
                    let d = tile.simplices[3 * t..3 * t + 3].iter().find(|&&v| v != b && v != c);
                    let d = *d.unwrap();
                    let at = |v: u32| tile.coordinates[v as usize];
                    let turn = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
                        (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
                    };
                    if turn(at(a), at(b), at(d)) < 1e-9 || turn(at(a), at(d), at(c)) < 1e-9 {
                        continue;
                    }
                    flips += 1;
                    let mut forgery = right.clone();
                    let simplices = &mut forgery.tiles[place].simplices;
                    simplices[3 * s..3 * s + 3].copy_from_slice(&[a, b, d]);
                    simplices[3 * t..3 * t + 3].copy_from_slice(&[a, d, c]);
                    forgery.rebuild();
                    match violation(&forgery) {
                        TilesViolation::Conflict { tie, .. } => assert!(tie == is_tie || !tie),
                        other => panic!("{other}"),
                    }
                }
            }
        }
        assert!(flips > 20, "{flips}");
    }
}

/// Changes one site in every tile that has it.
fn with_site<const D: usize>(
    right: &Forgery<D>,
    row: u64,
    change: impl Fn(&mut u64, &mut [f64; D]),
) -> Forgery<D> {
    let mut forgery = right.clone();
    for tile in &mut forgery.tiles {
        for site in 0..tile.rows.len() {
            if tile.rows[site] == row {
                change(&mut tile.rows[site], &mut tile.coordinates[site]);
            }
        }
    }
    forgery.rebuild();
    forgery
}

fn sites_are_refused<const D: usize>(points: &[[f64; D]])
where
    Dim<D>: Dimension<D>,
{
    let right = honest(points, CUT);
    let n = points.len() as u64;
    // One unit in the last place.
    let found = violation(&with_site(&right, 7, |_, p| p[1] = p[1].next_up()));
    let expected = points[7][1];
    let coordinate =
        TilesViolation::Coordinate { row: 7, column: 1, found: expected.next_up(), expected };
    assert_eq!(found, coordinate);
    for value in [f64::NAN, f64::INFINITY, 1e308, -1e308, 5e-324, 1e-310] {
        let found = violation(&with_site(&right, 7, |_, p| p[0] = value));
        let is_told = match found {
            TilesViolation::Tile { ref problem, .. } => problem.contains("not finite"),
            _ => value.is_finite(),
        };
        assert!(is_told, "{value}: {found}");
    }
    // The rows of two sites exchanged, one row twice, one that is not there.
    let exchanged = |row: u64| [row, 8, 7][usize::from(row == 7) + 2 * usize::from(row == 8)];
    let mut forgery = right.clone();
    forgery.tiles.iter_mut().flat_map(|tile| &mut tile.rows).for_each(|row| *row = exchanged(*row));
    forgery.rebuild();
    let found = violation(&forgery);
    assert!(matches!(found, TilesViolation::Coordinate { row: 7 | 8, .. }), "{found}");
    violation(&with_site(&right, 7, |row, _| *row = 8));
    let found = violation(&with_site(&right, 7, |row, _| *row = n));
    assert!(matches!(found, TilesViolation::Tile { .. }), "{found}");
    // Owned by two tiles, by none.
    let place = right.tiles.iter().position(|tile| !tile.copies.is_empty()).unwrap();
    let mut forgery = right.clone();
    let copy = forgery.tiles[place].copies.remove(0);
    let row = right.tiles[place].rows[copy as usize];
    forgery.count();
    let problem = "is owned by more than one tile";
    assert_eq!(violation(&forgery), TilesViolation::Site { row, problem });
    let mut forgery = right.clone();
    let tile = &mut forgery.tiles[place];
    let owned = (0..tile.rows.len() as u32).find(|v| !tile.copies.contains(v)).unwrap();
    let row = tile.rows[owned as usize];
    tile.copies.push(owned);
    tile.copies.sort_unstable();
    forgery.count();
    let problem = "is owned by no tile";
    assert_eq!(violation(&forgery), TilesViolation::Site { row, problem });
    // A point that the triangulation leaves out.
    let mut forgery = honest(&points[..points.len() - 1], CUT);
    forgery.points = points.to_vec();
    let problem = "is a site of no tile, nor listed as a duplicate";
    assert_eq!(violation(&forgery), TilesViolation::Site { row: n - 1, problem });
    // The same, with the point as a site that no simplex has.
    let row_bytes = forgery.tiles[0].counts.row_bytes;
    forgery.tiles[0].rows.push(n - 1);
    forgery.tiles[0].coordinates.push(points[points.len() - 1]);
    forgery.tiles[0].counts.row_bytes = row_bytes;
    forgery.count();
    let problem = "is a vertex of no simplex";
    assert_eq!(violation(&forgery), TilesViolation::Site { row: n - 1, problem });
    // The same, named as a duplicate.
    forgery.tiles[0].rows.pop();
    forgery.tiles[0].coordinates.pop();
    forgery.tiles[0].duplicates = vec![[n - 1, 3]];
    forgery.count();
    let problem = "they differ";
    assert_eq!(violation(&forgery), TilesViolation::Duplicate { row: n - 1, first: 3, problem });
}

#[test]
fn forged_sites_are_refused() {
    sites_are_refused(&uniform::<2>(700, 31));
    sites_are_refused(&uniform::<3>(400, 32));
}

#[test]
fn forged_duplicates_are_refused() {
    let u = uniform::<2>(300, 33);
    let points: Vec<[f64; 2]> = (0..500).map(|i| u[i % 300]).collect();
    let right = honest(&points, CUT);
    check(&right).unwrap();
    let place = right.tiles.iter().position(|tile| !tile.duplicates.is_empty()).unwrap();
    let [row, first] = right.tiles[place].duplicates[0];
    let forged = |change: &dyn Fn(&mut Vec<[u64; 2]>)| {
        let mut forgery = right.clone();
        change(&mut forgery.tiles[place].duplicates);
        forgery.count();
        violation(&forgery)
    };
    let problem = "is a site of no tile, nor listed as a duplicate";
    assert_eq!(forged(&|list| _ = list.remove(0)), TilesViolation::Site { row, problem });
    let problem = "the first is listed twice";
    let twice = TilesViolation::Duplicate { row, first, problem };
    assert_eq!(forged(&|list| list.insert(0, [row, first])), twice);
    let problem = "the second must be the earlier one";
    let found = forged(&|list| list[0] = [row, row]);
    assert_eq!(found, TilesViolation::Duplicate { row, first: row, problem });
    let problem = "the first is a site of a tile";
    let found = forged(&|list| list.push([first.max(1), 0]));
    assert_eq!(found, TilesViolation::Duplicate { row: first.max(1), first: 0, problem });
    let found = forged(&|list| list[0] = [row, (first + 1) % 300]);
    assert!(matches!(found, TilesViolation::Duplicate { problem: "they differ", .. }), "{found}");
    let found = forged(&|list| list[0] = [row, 1 << 20]);
    assert!(matches!(found, TilesViolation::Duplicate { first: 0x10_0000, .. }), "{found}");
    // The later of two equal rows as the site.
    let mut forgery = with_site(&right, first, |site, _| *site = row);
    forgery.tiles[place].duplicates[0] = [first, row];
    forgery.count();
    let found = violation(&forgery);
    let is_refused =
        matches!(found, TilesViolation::Duplicate { .. } | TilesViolation::Site { .. });
    assert!(is_refused, "{found}");
}

#[test]
fn forged_neighbors_and_links_are_refused() {
    let right = honest(&uniform::<2>(800, 41), CUT);
    let (place, simplex) = inner_simplex(&right);
    let tile = right.tiles[place].counts.tile;
    for (wrong, is_counted) in
        [(0, true), (OTHER_TILE, true), (NO_NEIGHBOR, true), (1 << 29, false)]
    {
        let mut forgery = right.clone();
        forgery.tiles[place].neighbors[3 * simplex + 1] = wrong;
        if is_counted {
            forgery.count();
        }
        let found = violation(&forgery);
        use TilesViolation::{HullDent, HullOpen, Neighbor, Tile};
        let is_refused = match found {
            Neighbor { tile: of, .. } | Tile { tile: of, .. } => of == tile,
            HullDent { .. } | HullOpen { .. } => wrong == NO_NEIGHBOR,
            _ => false,
        };
        assert!(is_refused, "{wrong}: {found}");
    }
    let place = right.tiles.iter().position(|tile| tile.links.len() > 2).unwrap();
    let forged = |change: &dyn Fn(&mut Tile<2>)| {
        let mut forgery = right.clone();
        change(&mut forgery.tiles[place]);
        forgery.count();
        violation(&forgery)
    };
    let is_neighbor = |found: TilesViolation| {
        assert!(matches!(found, TilesViolation::Neighbor { .. }), "{found}");
    };
    is_neighbor(forged(&|tile| _ = tile.links.remove(0)));
    is_neighbor(forged(&|tile| tile.links[0].link.code ^= 1));
    is_neighbor(forged(&|tile| tile.links[0].link.tile ^= 1));
    is_neighbor(forged(&|tile| {
        let link = tile.links[0].link;
        tile.links[0].link = tile.links[1].link;
        tile.links[1].link = link;
    }));
    let found = forged(&|tile| tile.links.swap(0, 1));
    assert!(matches!(found, TilesViolation::Tile { .. }), "{found}");
    let found = forged(&|tile| {
        let link = tile.links.remove(0);
        tile.links.push(super::super::TileLink { code: Link::OUTSIDE, ..link });
    });
    assert!(matches!(found, TilesViolation::Neighbor { .. }), "{found}");
}

#[test]
fn files_that_are_damaged_are_refused() {
    let points = uniform::<2>(600, 51);
    let right = honest(&points, CUT);
    let whole = tempfile::tempdir().unwrap();
    right.write(whole.path());
    let names: Vec<_> =
        fs::read_dir(whole.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    let damaged = |change: &dyn Fn(&Path)| {
        let folder = tempfile::tempdir().unwrap();
        for name in &names {
            fs::copy(whole.path().join(name), folder.path().join(name)).unwrap();
        }
        change(folder.path());
        match check_folder(folder.path(), &points) {
            Err(TilesError::Rejected(violation)) => violation,
            other => panic!("{other:?}"),
        }
    };
    let tile = right.tiles.iter().find(|tile| tile.counts.simplices > 10).unwrap().counts.tile;
    let name = super::super::tile_name(tile);
    let of_tile = |found: TilesViolation| {
        assert!(matches!(found, TilesViolation::Tile { tile: of, .. } if of == tile), "{found}");
    };
    of_tile(damaged(&|folder| fs::remove_file(folder.join(&name)).unwrap()));
    let length = fs::metadata(whole.path().join(&name)).unwrap().len();
    for cut in [0, 1, 50, 120, length / 2, length - 1] {
        of_tile(damaged(&|folder| {
            let file = fs::File::options().write(true).open(folder.join(&name)).unwrap();
            file.set_len(cut).unwrap();
        }));
    }
    for at in (0..length as usize).step_by(long_or(97, 311)) {
        let found = damaged(&|folder| {
            let path = folder.join(&name);
            let mut bytes = fs::read(&path).unwrap();
            bytes[at] ^= 0x10;
            fs::write(path, bytes).unwrap();
        });
        assert!(!found.to_string().is_empty());
    }
    let extra = damaged(&|folder| fs::write(folder.join("tile-00009999.ttd"), "").unwrap());
    assert!(extra.to_string().contains("tile-00009999.ttd"), "{extra}");
    let empty = tempfile::tempdir().unwrap();
    let refused = check_folder(empty.path(), &points);
    assert!(matches!(refused, Err(TilesError::NoManifest { .. })), "{refused:?}");
    for at in (0..200).step_by(long_or(1, 7)) {
        let found = damaged(&|folder| {
            let path = folder.join("manifest.txt");
            let mut bytes = fs::read(&path).unwrap();
            bytes[at] ^= 1;
            fs::write(path, bytes).unwrap();
        });
        assert!(matches!(found, TilesViolation::Manifest { .. }), "byte {at}: {found}");
    }
}

#[test]
fn untrue_lines_of_the_manifest_are_refused() {
    let points = uniform::<3>(300, 61);
    let right = honest(&points, CUT);
    for (key, value) in [
        ("format", "taut-tiled-delaunay 2"),
        ("state", "begun"),
        ("dimension", "2"),
        ("points", "299"),
        ("points_hash", "0123456789abcdef"),
        ("row_bytes", "8"),
        ("row_bytes", "5"),
        ("vertices_per_simplex", "3"),
        ("sites", "299"),
        ("duplicates", "1"),
        ("simplices", "7"),
        ("hull", "7"),
        ("fingerprint", "00000000000000000000000000000007"),
        ("tiles", "3"),
        ("tiles", "18446744073709551615"),
    ] {
        let mut forgery = right.clone();
        forgery.lines.insert(key, value.to_owned());
        let found = violation(&forgery);
        assert!(!found.to_string().is_empty(), "{key}");
    }
    // What the manifest takes from the tiles.
    let mut forgery = right.clone();
    forgery.tiles[0].counts.fingerprint.0 ^= 1;
    let found = violation(&forgery);
    assert!(matches!(found, TilesViolation::Fingerprint { .. }), "{found}");
    let place = right.tiles.iter().position(|tile| tile.counts.hull > 0).unwrap();
    let mut forgery = right.clone();
    forgery.tiles[place].counts.hull -= 1;
    let found = violation(&forgery);
    assert!(matches!(found, TilesViolation::Count { what: "hull facets", .. }), "{found}");
}

#[test]
fn other_points_are_refused() {
    let points = uniform::<2>(300, 71);
    let folder = tempfile::tempdir().unwrap();
    honest(&points, CUT).write(folder.path());
    let mut other = points.clone();
    other[250][1] = other[250][1].next_up();
    let refused = check_folder(folder.path(), &other);
    let is_told = matches!(refused, Err(TilesError::Rejected(TilesViolation::Hash { .. })));
    assert!(is_told, "{refused:?}");
    other[250][1] = f64::NAN;
    let refused = check_folder(folder.path(), &other);
    let not_finite = TilesViolation::NonFinite { row: 250, column: 1, value: f64::NAN };
    assert_eq!(refused.unwrap_err().to_string(), not_finite.to_string());
    let fewer = check_folder(folder.path(), &points[..299]);
    assert!(matches!(fewer, Err(TilesError::Rejected(TilesViolation::Count { .. }))), "{fewer:?}");
    assert!(check_folder(Path::new("/no/such/folder"), &points).is_err());
}

/// Edges of a line: dropped, repeated, out of order.
#[test]
fn forged_chains_are_refused() {
    let points: Vec<[f64; 3]> = (0..60).map(|i| [f64::from(i * 7 % 60) * 0.3; 3]).collect();
    let right = honest(&points, CUT);
    check(&right).unwrap();
    let root = right.tiles.iter().position(|tile| tile.counts.simplices > 0).unwrap();
    for change in [
        |list: &mut Vec<u32>| drop(list.drain(20..22)),
        |list: &mut Vec<u32>| drop(list.drain(0..2)),
        |list: &mut Vec<u32>| list.extend_from_within(20..22),
        |list: &mut Vec<u32>| list.swap(20, 21),
        |list: &mut Vec<u32>| list.swap(21, 31),
    ] {
        let mut forgery = right.clone();
        change(&mut forgery.tiles[root].simplices);
        forgery.rebuild();
        let found = violation(&forgery);
        assert!(!found.to_string().is_empty());
    }
}

/// A single point has no facets: one in "another tile" that an outside link closes would be counted on the hull.
#[test]
fn a_single_point_with_a_facet_on_the_hull_is_refused() {
    let right = honest(&[[1.0, 2.0]], Cut { levels: 0, ..CUT });
    assert_eq!(check(&right).unwrap().counts.hull, 0);
    let mut forgery = right;
    let place = forgery.tiles.iter().position(|tile| !tile.neighbors.is_empty()).unwrap();
    let tile = &mut forgery.tiles[place];
    tile.neighbors[0] = OTHER_TILE;
    let link = Link { tile: tile.counts.tile, code: 0 };
    tile.links.push(super::super::TileLink { code: Link::OUTSIDE, link });
    forgery.count();
    let found = violation(&forgery);
    assert!(matches!(found, TilesViolation::Neighbor { .. }), "{found}");
}

/// Points whose coordinate z is 0 in one of the reads.
struct FlatOnce {
    points: Vec<[f64; 3]>,
    flat: Vec<[f64; 3]>,
    flat_read: usize,
    reads: AtomicUsize,
}

impl PointSource for FlatOnce {
    fn len(&self) -> u64 {
        self.points.len() as u64
    }

    fn dim(&self) -> usize {
        3
    }

    fn scalar(&self) -> ScalarKind {
        ScalarKind::F64
    }

    fn read<'a>(&'a self, range: Range<u64>, _: &'a mut Scratch) -> Result<Rows<'a>, ReadError> {
        let is_flat = self.reads.fetch_add(1, Ordering::Relaxed) == self.flat_read;
        let all = if is_flat { &self.flat } else { &self.points };
        let part = &all[range.start as usize..range.end as usize];
        Ok(Rows::F64(Points::new(part.as_flattened(), 3)?))
    }
}

/// The dimension is decided from what was hashed: points that change for a moment are no proof of a flat folder.
#[test]
fn points_that_change_between_two_reads_are_refused() {
    let mut points: Vec<[f64; 3]> =
        uniform::<2>(300, 71).iter().map(|&[x, y]| [x, y, 0.0]).collect();
    let flat = points.clone();
    // So little that all circles stay empty.
    points[299][2] = 1e-12;
    let mut forgery = honest(&flat, CUT);
    forgery.points = points.clone();
    for tile in &mut forgery.tiles {
        for (p, &row) in tile.coordinates.iter_mut().zip(&tile.rows) {
            *p = points[row as usize];
        }
    }
    forgery.count();
    let folder = tempfile::tempdir().unwrap();
    forgery.write(folder.path());
    for flat_read in 0..4 {
        let (points, flat, reads) = (points.clone(), flat.clone(), AtomicUsize::new(0));
        let source = FlatOnce { points, flat, flat_read, reads };
        let options = TilesOptions { memory: 16 << 20, ..TilesOptions::default() };
        let found = check_tiles(folder.path(), &source, &options);
        assert!(matches!(found, Err(TilesError::Rejected(_))), "{flat_read}: {found:?}");
    }
}
