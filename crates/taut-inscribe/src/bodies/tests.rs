//! Events beside brute force in whole numbers.

use std::sync::Arc;

use super::clip::{self, TOUCH};
use super::directions::{Directions, KINDS, Offsets, opposite};
use super::mesh::GridMesh;
use super::proof;
use super::tree::Tree;
use super::{BodiesOptions, BodyShape, inscribed_bodies};
use crate::random::Random;
use crate::test_length::long_or;

type Triangle = [[i32; 3]; 3];

/// Small triangles at even places of a grid.
fn soup(random: &mut Random, count: usize, side: usize) -> Vec<Triangle> {
    let triangle = |_| {
        let at = [0; 3].map(|_: i32| random.below(side) as i32);
        [0; 3].map(|_: i32| at.map(|x| 2 * (x + random.below(side / 3 + 2) as i32)))
    };
    (0..count).map(triangle).collect()
}

/// Whether no triangle enters the body.
fn is_empty(directions: &Directions, h: &Offsets, triangles: &[Triangle]) -> bool {
    triangles.iter().all(|corners| proof::weights(directions, h, corners).is_some())
}

/// The event by all triangles, each by the search for weights: the largest offset with which the body is empty.
fn by_weights(directions: &Directions, i: usize, h: &Offsets, most: i32, all: &[Triangle]) -> i32 {
    let (mut low, mut high, mut trial) = (h[i], most, *h);
    while low < high {
        let middle = low + (high - low + 1) / 2;
        trial[i] = middle;
        if is_empty(directions, &trial, all) { low = middle } else { high = middle - 1 }
    }
    low
}

/// The event by all triangles, each clipped.
fn by_clipping(directions: &Directions, i: usize, h: &Offsets, most: i32, all: &[Triangle]) -> i32 {
    let clipped = all.iter().filter_map(|corners| {
        let least = |j| corners.map(|p| directions.along(j, p) as i32).into_iter().min();
        let heights: Vec<i32> = (0..directions.len()).filter_map(least).collect();
        let scratch = &mut clip::Scratch::default();
        clip::lowest(&corners.map(|p| p.map(f64::from)), &heights, i, h, directions, scratch)
    });
    clipped.map(|height| (height + TOUCH).floor() as i32).fold(most, i32::min).max(h[i])
}

/// A random body in the grid that no triangle enters, the larger the earlier it is found.
fn empty_body(
    directions: &Directions,
    random: &mut Random,
    side: usize,
    all: &[Triangle],
) -> Option<Offsets> {
    (0..8).find_map(|halvings| {
        let p = [0; 3].map(|_: i32| 2 * random.below(side) as i32);
        let mut h = [0; _];
        for i in 0..directions.len() {
            let room = random.below((side >> halvings) + 1) as i32;
            h[i] = directions.along(i, p) as i32 + 1 + room;
        }
        is_empty(directions, &h, all).then_some(h)
    })
}

/// Each triangle as four, by the middles of its sides.
fn subdivided(all: &[Triangle]) -> Vec<Triangle> {
    let middle = |a: [i32; 3], b: [i32; 3]| [0, 1, 2].map(|c| i32::midpoint(a[c], b[c]));
    all.iter()
        .flat_map(|&[a, b, c]| {
            let (d, e, f) = (middle(a, b), middle(b, c), middle(c, a));
            [[a, d, f], [d, b, e], [f, e, c], [d, e, f]]
        })
        .collect()
}

#[test]
fn events_equal_brute_force_and_do_not_see_subdivision() {
    let mut random = Random::new(1);
    let (mut events, mut stopped) = (0, 0);
    // In the long tests more than 10⁵ events.
    let bodies = long_or(800, 6);
    let of_kinds = KINDS.map(|kind| (kind, Directions::of(kind)));
    let skew = [[1, 2, 3], [-2, 1, 0], [5, -3, 1], [0, 1, -1], [7, 7, -1]];
    let given = [&skew[..], &skew[..3]].map(|u| (2 * u.len(), Directions::given(u).unwrap()));
    for (kind, directions) in of_kinds.into_iter().chain(given) {
        let directions = Arc::new(directions);
        for (count, side) in [(1, 6), (60, 8), (200, 30), (300, 200), (100, 4000)] {
            for _ in 0..bodies {
                let all = soup(&mut random, count, side);
                let tree = Tree::new(&all, &directions);
                let finer = subdivided(&all);
                let finer_tree = Tree::new(&finer, &directions);
                let Some(h) = empty_body(&directions, &mut random, side, &all) else { continue };
                for i in 0..directions.len() {
                    let most = tree.extent(i).max(h[i]) + 3;
                    let expected = by_weights(&directions, i, &h, most, &all);
                    let event = tree.event(i, &h, most, None);
                    assert_eq!(event.height, expected, "{kind}, facet {i}: {h:?}");
                    assert_eq!(event.stop.is_some(), expected < most);
                    assert_eq!(by_clipping(&directions, i, &h, most, &all), expected);
                    assert_eq!(finer_tree.event(i, &h, most, None).height, expected);
                    for guess in [event.stop, Some(random.below(all.len()) as u32)] {
                        assert_eq!(tree.event(i, &h, most, guess).height, expected);
                    }
                    events += 1;
                    stopped += u32::from(expected < most);
                }
            }
        }
    }
    println!("{events} events, {stopped} stopped");
    assert!(events > 125 * bodies && stopped > 15 * bodies, "{events} events, {stopped} stopped");
}

#[test]
fn events_of_a_large_mesh_equal_brute_force() {
    let triangles: Vec<Triangle> = torus(220).iter().map(|t| t.map(|p| p.map(|x| 2 * x))).collect();
    let directions = Arc::new(Directions::of(18));
    let tree = Tree::new(&triangles, &directions);
    let mut random = Random::new(4);
    let (compared, timed) = long_or((3_000, 100_000), (20, 3_000));
    let (mut times, mut stopped) = (vec![], 0);
    let mut h = [0; _];
    for event in 0..timed {
        if event % directions.len() == 0 {
            // The tube around the middle line of the torus; a small cube in it, and then grown facet by facet.
            let turn = random.unit() * std::f64::consts::TAU;
            let at = [800.0 * turn.cos(), 800.0 * turn.sin(), 0.0].map(|x| x.round() as i32);
            for i in 0..directions.len() {
                let ones: i64 = directions.normals[i].iter().map(|n| n.abs()).sum();
                h[i] = directions.along(i, at) as i32 + 10 * ones as i32;
            }
        }
        let i = event % directions.len();
        let most = h[i] + 40 + random.below(4000) as i32;
        let begun = std::time::Instant::now();
        let found = tree.event(i, &h, most, None).height;
        times.push(begun.elapsed());
        if event < compared {
            assert_eq!(by_clipping(&directions, i, &h, most, &triangles), found, "{i}: {h:?}");
        }
        stopped += usize::from(found < most);
        h[i] = found;
    }
    times.sort_unstable();
    println!("{} triangles, median event {:?}", triangles.len(), times[timed / 2]);
    assert!(stopped > timed / 4, "{stopped} of {timed} stopped");
}

#[test]
fn redundant_facets_stop_where_the_others_end() {
    // A cube of side 2: the diagonals of its faces are redundant from 2, those of the cube from 3.
    for kind in KINDS {
        let directions = Directions::of(kind);
        let mut h = [9; _];
        h[..6].fill(1);
        for i in 6..directions.len() {
            let ones: i64 = directions.normals[i].iter().map(|n| n.abs()).sum();
            assert_eq!(directions.redundant_at(i, &h, 100), ones as i32);
        }
        // An axis is a sum of others except with k = 6.
        let expected = if kind == 6 { 100 } else { 9 };
        assert_eq!(directions.redundant_at(0, &h, 100), expected, "{kind}");
        for i in 0..directions.len() {
            let negated = directions.normals[i].map(|n| -n);
            assert_eq!(directions.normals[opposite(i)], negated);
        }
    }
}

#[test]
fn weights_of_triangles_that_touch_and_enter() {
    let directions = Directions::of(6);
    let mut h = [0; _];
    h[..6].fill(4);
    // The triangle x + y + z = 12 touches the corner (4, 4, 4); with three facets.
    let touching = [[12, 0, 0], [0, 12, 0], [0, 0, 12]];
    let weights = proof::weights(&directions, &h, &touching).unwrap();
    assert_eq!(weights, [(0, 1), (2, 1), (4, 1)]);
    assert!(proof::weights(&directions, &h, &touching.map(|p| p.map(|x| x - x / 12))).is_none());
    // Along an edge two facets do.
    let edge = [[8, 0, 0], [0, 8, 0], [0, 8, 9]];
    assert_eq!(proof::weights(&directions, &h, &edge).unwrap(), [(0, 1), (2, 1)]);
    // In the plane of a facet one does.
    let flat = [[4, 0, 0], [4, 3, 0], [4, 0, 3]];
    assert_eq!(proof::weights(&directions, &h, &flat).unwrap(), [(0, 1)]);
}

/// A torus with waves, with corners on the grid of whole numbers and a longest side of at least 2¹⁰.
fn torus(m: usize) -> Vec<Triangle> {
    let turn = |k: usize| std::f64::consts::TAU * k as f64 / m as f64;
    let place = |i: usize, j: usize| {
        let (s, t) = (turn(i % m), turn(j % m));
        let tube = 150.0 + 40.0 * (3.0 * s).sin() * (2.0 * t).cos();
        let radius = 400.0 + tube * t.cos();
        [radius * s.cos(), radius * s.sin(), tube * t.sin()].map(|x| x.round() as i32)
    };
    let cell = |k: usize| {
        let (i, j) = (k / m, k % m);
        let [a, b, c, d] = [place(i, j), place(i + 1, j), place(i + 1, j + 1), place(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    (0..m * m).flat_map(cell).collect()
}

#[test]
fn tight_facets_moved_outward_by_two_units_are_always_refused() {
    let triangles = torus(16);
    let rows: Vec<f64> =
        triangles.as_flattened().as_flattened().iter().map(|&x| f64::from(x)).collect();
    let points = taut_points::Points::new(&rows, 9).unwrap();
    for kind in KINDS {
        let options = BodiesOptions {
            shape: BodyShape::Dop(kind),
            count: 3,
            events: 3000,
            ..Default::default()
        };
        let found = inscribed_bodies(&points, &options).unwrap();
        assert_eq!(found.check(&points).unwrap().bodies, 3);
        let mesh = GridMesh::read(&points, false, &options.monitor).unwrap();
        assert!(mesh.is_exact);
        let directions = Directions::of(kind);
        let mut tight = 0;
        for body in 0..3 {
            let mut h = [0; _];
            for (h, &offset) in h.iter_mut().zip(&found.answer.bodies[body].offsets) {
                *h = offset as i32;
            }
            assert!(is_empty(&directions, &h, &mesh.corners));
            for facet in 0..kind {
                let mut moved = h;
                moved[facet] += 2;
                let is_tight = !is_empty(&directions, &moved, &mesh.corners);
                let mut changed = found.clone();
                changed.answer.bodies[body].offsets[facet] += 2;
                let refused = changed.check(&points).is_err();
                assert!(refused || !is_tight, "{kind}, body {body}, facet {facet}");
                tight += u32::from(is_tight);
            }
        }
        println!("k = {kind}: {tight} of {} facets are tight", 3 * kind);
        // Each body of a local optimum has facets that triangles stop on most sides.
        assert!(tight >= kind as u32, "{kind}: {tight} facets are tight");
    }
}
