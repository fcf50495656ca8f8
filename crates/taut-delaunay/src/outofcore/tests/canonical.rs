//! What the tiles hold together is what the triangulation in memory holds.

use std::collections::{BTreeMap, BTreeSet};

use taut_points::Points;

use super::super::{Dim, Dimension, Link, NO_NEIGHBOR, OTHER_TILE, Tile, Totals};
use super::buckets::{Cut, tiles};
use super::sets;
use crate::simplex::decode;
use crate::test_length::long_or;
use crate::{DelaunayOptions, delaunay};

/// Rows in ascending order.
fn sorted(mut rows: Vec<u64>) -> Vec<u64> {
    rows.sort_unstable();
    rows
}

/// Each simplex with what lies across each facet, all by rows: opposite each vertex the neighbor, or nothing on the hull.
type Adjacency = BTreeMap<Vec<u64>, BTreeMap<u64, Option<Vec<u64>>>>;

fn adjacency_of_tiles<const D: usize>(all: &[Tile<D>]) -> Adjacency {
    let by_number: BTreeMap<u32, &Tile<D>> = all.iter().map(|t| (t.counts.tile, t)).collect();
    let rows = |tile: &Tile<D>, simplex: u32| -> Vec<u64> {
        let vertices = tile.simplex_rows().nth(simplex as usize).expect("a simplex of the tile");
        vertices.iter().map(|&v| tile.rows[v as usize]).collect()
    };
    let mut adjacency = Adjacency::new();
    let mut open = BTreeMap::new();
    for tile in all {
        let k = tile.counts.vertices_per_simplex as usize;
        for (number, neighbors) in (0u32..).zip(tile.neighbors.chunks(k.max(1))) {
            let ours = rows(tile, number);
            let mut across = BTreeMap::new();
            for (i, &n) in neighbors.iter().enumerate() {
                match n {
                    NO_NEIGHBOR => across.insert(ours[i], None),
                    OTHER_TILE => {
                        open.insert((tile.counts.tile, number << 2 | i as u32), ());
                        None
                    }
                    _ => across.insert(ours[i], Some(sorted(rows(tile, n)))),
                };
            }
            let earlier = adjacency.insert(sorted(ours), across);
            assert!(earlier.is_none(), "a simplex is in one tile");
        }
    }
    for tile in all {
        for link in &tile.links {
            let other = by_number[&link.link.tile];
            if link.code == Link::OUTSIDE {
                let (simplex, facet) = decode(link.link.code);
                let its = rows(other, simplex);
                let across = adjacency.get_mut(&sorted(its.clone())).unwrap();
                assert!(across.insert(its[facet], None).is_none(), "on the hull once");
                assert!(open.remove(&(link.link.tile, link.link.code)).is_some(), "of open facets");
                continue;
            }
            let sides = [(tile, link.code), (other, link.link.code)];
            for (a, b) in [(0, 1), (1, 0)] {
                let ((simplex, facet), there) = (decode(sides[a].1), decode(sides[b].1).0);
                let (ours, its) = (rows(sides[a].0, simplex), rows(sides[b].0, there));
                let opposite = ours[facet];
                let across = adjacency.get_mut(&sorted(ours)).unwrap();
                assert!(across.insert(opposite, Some(sorted(its))).is_none(), "joined once");
                let side = (sides[a].0.counts.tile, sides[a].1);
                assert!(open.remove(&side).is_some(), "only open facets are joined");
            }
        }
    }
    assert!(open.is_empty(), "all facets between tiles are joined");
    adjacency
}

fn adjacency_in_memory(simplices: &[u32], neighbors: &[u32], k: usize) -> Adjacency {
    let rows = |s: u32| -> Vec<u64> {
        simplices[s as usize * k..][..k].iter().map(|&v| u64::from(v)).collect()
    };
    let all = (0u32..).zip(neighbors.chunks(k.max(1)));
    let simplex = |(s, n): (u32, &[u32])| {
        let across = rows(s)
            .into_iter()
            .zip(n)
            .map(|(v, &n)| (v, (n != taut_certify::NO_NEIGHBOR).then(|| sorted(rows(n)))));
        (sorted(rows(s)), across.collect())
    };
    all.map(simplex).collect()
}

pub(super) fn check_same<const D: usize>(name: &str, points: &[[f64; D]], cuts: &[Cut])
where
    Dim<D>: Dimension<D>,
{
    let view = Points::new(points.as_flattened(), D).unwrap();
    let options = DelaunayOptions { threads: Some(1), ..DelaunayOptions::default() };
    let expected = delaunay(&view, &options).unwrap();
    let k = expected.answer.vertices_per_simplex();
    let adjacency =
        adjacency_in_memory(&expected.answer.simplices, &expected.certificate.neighbors, k);
    let mut same_tree: BTreeMap<(u32, u64, usize), Vec<u8>> = BTreeMap::new();
    for &cut in cuts {
        let (all, totals, bytes) = tiles(points, cut);
        let Totals { fingerprint, sites, simplices, hull, duplicates, .. } = totals;
        assert_eq!(fingerprint, expected.certificate.fingerprint, "{name}: {cut:?}");
        let counts = expected.certificate.counts;
        assert_eq!((sites, simplices), (counts.sites, counts.simplices), "{name}: {cut:?}");
        assert_eq!(duplicates as usize, expected.answer.duplicates.len(), "{name}: {cut:?}");
        if k == D + 1 {
            assert_eq!(hull, counts.hull, "{name}: {cut:?}");
        }
        assert_eq!(adjacency_of_tiles(&all), adjacency, "{name}: {cut:?}");
        let mut listed: Vec<[u64; 2]> = all.iter().flat_map(|t| t.duplicates.clone()).collect();
        listed.sort_unstable();
        let known: Vec<[u64; 2]> =
            expected.answer.duplicates.iter().map(|pair| pair.map(u64::from)).collect();
        assert_eq!(listed, known, "{name}: {cut:?}");
        let mut owned = BTreeSet::new();
        for tile in &all {
            for (site, &row) in (0u32..).zip(&tile.rows) {
                let is_copy = tile.copies.binary_search(&site).is_ok();
                assert!(is_copy || owned.insert(row), "{name}: {cut:?}: each site has one owner");
            }
        }
        assert_eq!(owned.len() as u64, sites, "{name}: {cut:?}");
        for tile in &all {
            for (p, &row) in tile.coordinates.iter().zip(&tile.rows) {
                assert_eq!(*p, points[row as usize].map(|x| x + 0.0), "{name}: {cut:?}");
            }
        }
        let tree = (cut.levels, cut.merge_above, cut.stride);
        assert!(
            *same_tree.entry(tree).or_insert_with(|| bytes.clone()) == bytes,
            "{name}: {cut:?}: bytes depend on threads"
        );
    }
}

const CUTS: [Cut; 7] = [
    Cut { levels: 0, merge_above: 1000, threads: 1, stride: 1 },
    Cut { levels: 3, merge_above: 0, threads: 1, stride: 1 },
    Cut { levels: 3, merge_above: 0, threads: 8, stride: 1 },
    Cut { levels: 5, merge_above: 300, threads: 2, stride: 3 },
    Cut { levels: 7, merge_above: 40, threads: 2, stride: 17 },
    Cut { levels: 1, merge_above: 0, threads: 2, stride: 1 },
    Cut { levels: 3, merge_above: 0, threads: 3, stride: 1 },
];

#[test]
fn tiles_of_the_plane_are_the_triangulation_in_memory() {
    for (name, points) in sets::some(sets::plane(), 0) {
        check_same(name, &points, &CUTS[..long_or(CUTS.len(), 5)]);
    }
}

#[test]
fn tiles_of_space_are_the_triangulation_in_memory() {
    for (name, points) in sets::some(sets::space(), 0) {
        check_same(name, &points, &CUTS[..long_or(CUTS.len(), 5)]);
    }
}

/// Rows of another order give the same simplices in the same tiles.
#[test]
fn tiles_do_not_depend_on_the_order_of_points() {
    let points = sets::plane().remove(0).1;
    let cut = Cut { levels: 3, merge_above: 0, threads: 2, stride: 1 };
    let (expected, ..) = tiles(&points, cut);
    let mut ascending = points.clone();
    ascending.sort_by(|a, b| a.partial_cmp(b).unwrap());
    let descending: Vec<[f64; 2]> = ascending.iter().rev().copied().collect();
    for other in [ascending, descending] {
        let (found, ..) = tiles(&other, cut);
        for (a, b) in expected.iter().zip(&found) {
            assert!(a.coordinates == b.coordinates && a.simplices == b.simplices);
            assert!(a.neighbors == b.neighbors && a.links == b.links);
        }
    }
}

/// A front is a small part of a node of well-spread points.
#[test]
fn fronts_are_small() {
    let points = sets::uniform::<2>(60_000, 5);
    let cut = Cut { levels: 3, merge_above: 0, threads: 2, stride: 1 };
    let (_, totals, _) = tiles(&points, cut);
    // 8 leaves of 7500: at most 5.5·√7500 = 476 sites each.
    assert!(totals.front_sites < 8 * 476, "{}", totals.front_sites);
    assert!(totals.root_sites < 1500, "{}", totals.root_sites);
}
