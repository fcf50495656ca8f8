//! Constrained triangulations against the definition: all segments are edges, all other edges locally Delaunay.

use std::collections::BTreeSet;

use taut_predicates::plane::conflict;

use super::*;
use crate::kernel::{Kernel, Settings};
use crate::plane::tests::{Random, mesh};

type Point = [f64; 2];

fn delaunay(points: &[Point]) -> Vec<Simplex<3>> {
    let order: Vec<u32> = (0..points.len() as u32).collect();
    mesh(points, &order, Settings { integral: false, filtered: true, vectors: true }).finish().0
}

fn line(from: u32, to: u32) -> Segment {
    Segment { from, to, ring: false }
}

fn ring(sites: &[u32]) -> Vec<Segment> {
    let next = sites.iter().cycle().skip(1);
    sites.iter().zip(next).map(|(&from, &to)| Segment { from, to, ring: true }).collect()
}

fn constrained(points: &[Point], segments: &[Segment]) -> Constrained {
    let mut triangles = delaunay(points);
    let pieces = constrain(points, &mut triangles, segments).unwrap();
    let found = Constrained::new(points.len(), triangles, pieces);
    check(points, segments, &found);
    found
}

fn check(points: &[Point], segments: &[Segment], found: &Constrained) {
    let point = |v: u32| points[v as usize];
    let mut edges = BTreeSet::new();
    for (number, t) in found.triangles().iter().enumerate() {
        for place in 0..3 {
            let (other, facet) = decode(t.neighbors[place]);
            let u = &found.triangles()[other as usize];
            assert_eq!(decode(u.neighbors[facet]), (number as u32, place));
            let [a, b] = [t.vertices[(place + 1) % 3], t.vertices[(place + 2) % 3]];
            assert_eq!([b, a], [u.vertices[(facet + 1) % 3], u.vertices[(facet + 2) % 3]]);
            let marked = found.is_constrained(number as u32, place);
            assert_eq!(marked, found.is_constrained(other, facet));
            if marked {
                edges.insert([a.min(b), a.max(b)]);
            }
            if t.is_ghost() {
                assert!(!found.is_inside(number as u32));
                continue;
            }
            let [a, b, c] = t.vertices.map(point);
            assert!(orient(a, b, c).is_positive());
            if !marked && u.vertices[facet] != GHOST {
                assert!(!conflict(a, b, c, point(u.vertices[facet])), "an edge to be flipped");
            }
        }
    }
    assert_eq!(edges, found.pieces().iter().map(|piece| piece.sites).collect());
    // Each segment is the edges between the sites on it, and there are no other constrained edges.
    let mut expected = BTreeSet::new();
    let mut splits = BTreeSet::new();
    for (number, segment) in segments.iter().enumerate() {
        let on = sites_on(points, segment);
        expected.extend(on.windows(2).map(|pair| [pair[0].min(pair[1]), pair[0].max(pair[1])]));
        if let [_, inner @ .., _] = &on[..] {
            splits.extend(inner.iter().map(|&site| Split { segment: number as u32, site }));
        }
    }
    assert_eq!(edges, expected);
    assert_eq!(found.splits(), splits.into_iter().collect::<Vec<_>>());
}

/// All sites on a segment, in lexicographic order.
fn sites_on(points: &[Point], segment: &Segment) -> Vec<u32> {
    let [p, q] = [segment.from, segment.to].map(|v| points[v as usize]);
    let (low, high) = if lexicographic(p, q).is_lt() { (p, q) } else { (q, p) };
    let on = |&v: &u32| {
        let x = points[v as usize];
        orient(p, q, x).is_zero() && lexicographic(low, x).is_le() && lexicographic(x, high).is_le()
    };
    let mut on: Vec<u32> = (0..points.len() as u32).filter(on).collect();
    on.sort_by(|&a, &b| lexicographic(points[a as usize], points[b as usize]));
    on
}

/// Returns true if two segments have a point in common that is inside both and no site on either.
fn cross(points: &[Point], s: &Segment, t: &Segment) -> bool {
    let [a, b, c, d] = [s.from, s.to, t.from, t.to].map(|v| points[v as usize]);
    let apart = |p, q, u, v| (orient(p, q, u) * orient(p, q, v)).is_negative();
    let shared = || {
        let on: BTreeSet<u32> = sites_on(points, s).into_iter().collect();
        sites_on(points, t).iter().any(|v| on.contains(v))
    };
    apart(a, b, c, d) && apart(c, d, a, b) && !shared()
}

fn sorted(found: &Constrained) -> BTreeSet<[u32; 3]> {
    let finite = found.triangles().iter().filter(|t| !t.is_ghost());
    finite
        .map(|t| {
            let mut v = t.vertices;
            v.sort_unstable();
            v
        })
        .collect()
}

/// Points on a small grid and in general position, with as many segments as do not cross.
fn scene(
    random: &mut Random,
    size: u64,
    points: usize,
    tries: usize,
) -> (Vec<Point>, Vec<Segment>) {
    let mut sites: Vec<Point> = Vec::new();
    while sites.len() < points {
        let p = if size == 0 {
            [random.unit(), random.unit()]
        } else {
            [(random.next() % size) as f64, (random.next() % size) as f64]
        };
        if !sites.contains(&p) {
            sites.push(p);
        }
    }
    let mut segments: Vec<Segment> = Vec::new();
    for _ in 0..tries {
        let mut site = || (random.next() % points as u64) as u32;
        let new = line(site(), site());
        if !segments.iter().any(|old| cross(&sites, old, &new)) {
            segments.push(new);
        }
    }
    (sites, segments)
}

#[test]
fn any_order_of_segments_gives_the_one_constrained_triangulation() {
    let mut random = Random(1);
    for (size, points, tries, runs) in
        [(4, 10, 12, 300), (8, 40, 40, 60), (0, 30, 40, 60), (0, 400, 150, 4)]
    {
        for _ in 0..runs {
            let (points, mut segments) = scene(&mut random, size, points, tries);
            if points.iter().all(|&p| orient(points[0], points[1], p).is_zero()) {
                continue;
            }
            let found = constrained(&points, &segments);
            random.shuffle(&mut segments);
            for segment in segments.iter_mut().step_by(2) {
                (segment.from, segment.to) = (segment.to, segment.from);
            }
            assert_eq!(sorted(&found), sorted(&constrained(&points, &segments)));
        }
    }
}

#[test]
fn an_edge_may_hang_into_the_corridor() {
    // (2, 3) is an edge with both its triangles, to 4 and to 5, in the way from 0 to 1.
    let points = [[-10.0, 0.0], [10.0, 0.0], [0.0, 4.0], [0.0, 1.0], [-2.0, -1.0], [2.0, -1.0]];
    let plain = constrained(&points, &[]);
    assert!(sorted(&plain).is_superset(&BTreeSet::from([[2, 3, 4], [2, 3, 5]])));
    constrained(&points, &[line(0, 1)]);
    // So it may if it is constrained itself, and on the other side, and on both.
    constrained(&points, &[line(3, 2), line(0, 1)]);
    let turned = points.map(|[x, y]| [-x, -y]);
    constrained(&turned, &[line(0, 1), line(2, 3)]);
    // A comb of such edges.
    let comb: Vec<Point> = (0..40)
        .flat_map(|i| {
            [
                [f64::from(i), 0.25 + f64::from(i % 3)],
                [f64::from(i) + 0.5, 9.0],
                [f64::from(i) + 0.3, -0.5],
            ]
        })
        .chain([[-9.0, 0.0], [60.0, 0.0]])
        .collect();
    constrained(&comb, &[line(120, 121)]);
}

#[test]
fn segments_that_cross_are_named() {
    let points = [[0.0, 0.0], [4.0, 4.0], [0.0, 4.0], [4.0, 0.0], [9.0, 1.0]];
    let mut triangles = delaunay(&points);
    let segments = [line(1, 4), line(0, 1), line(1, 1), line(3, 2)];
    let error = constrain(&points, &mut triangles, &segments).unwrap_err();
    assert_eq!(error, ConstraintError::Crossing { first: 1, second: 3 });
    // What is left is the triangulation of those before.
    let pieces = constrain(&points, &mut triangles, &segments[..3]).unwrap();
    check(&points, &segments[..3], &Constrained::new(5, triangles.clone(), pieces));
    // With the point where they cross as a site they do not.
    let points = [points.to_vec(), vec![[2.0, 2.0]]].concat();
    let found = constrained(&points, &segments);
    assert_eq!(found.splits(), [Split { segment: 1, site: 5 }, Split { segment: 3, site: 5 }]);
}

#[test]
fn wrong_segments_are_refused_before_anything_changes() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    let mut triangles = delaunay(&points);
    let before = triangles.clone();
    assert_eq!(
        constrain(&points, &mut triangles, &[line(0, 1), line(2, 3)]),
        Err(ConstraintError::NoSite { segment: 1, site: 3, sites: 3 })
    );
    let open = [Segment { from: 1, to: 2, ring: true }];
    assert_eq!(constrain(&points, &mut triangles, &open), Err(ConstraintError::Open { site: 1 }));
    assert_eq!(triangles, before);
}

/// Twice the area of the inside, in integers.
fn area(points: &[Point], found: &Constrained) -> i64 {
    let mut sum = 0;
    for (number, t) in found.triangles().iter().enumerate() {
        if found.is_inside(number as u32) {
            let [a, b, c] = t.vertices.map(|v| points[v as usize].map(|x| x as i64));
            sum += (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
        }
    }
    sum
}

#[test]
fn the_inside_of_rings_is_even_and_odd() {
    // A square with a hole, an island in the hole, and a square beside it that shares an edge.
    let square = |x: f64, y: f64, s: f64| [[x, y], [x + s, y], [x + s, y + s], [x, y + s]];
    let mut points: Vec<Point> =
        [square(0.0, 0.0, 10.0), square(2.0, 2.0, 6.0), square(4.0, 4.0, 1.0)].concat();
    points.extend([[20.0, 0.0], [20.0, 10.0], [15.0, 5.0], [30.0, 30.0]]);
    let mut segments = ring(&[0, 1, 2, 3]);
    segments.extend(ring(&[4, 5, 6, 7]));
    segments.extend(ring(&[8, 9, 10, 11]));
    segments.extend(ring(&[1, 12, 13, 2]));
    // A line that is no ring changes no side.
    segments.push(line(3, 4));
    let found = constrained(&points, &segments);
    assert_eq!(area(&points, &found), 2 * (100 - 36 + 1 + 100));
    // The same ring twice is no ring.
    let twice = [ring(&[0, 1, 2, 3]), ring(&[3, 2, 1, 0])].concat();
    assert_eq!(area(&points, &constrained(&points, &twice)), 0);
}

#[test]
fn a_polygon_of_many_corners_has_its_area() {
    // A star-shaped polygon on a lattice, with points in and around it.
    let mut random = Random(9);
    for _ in 0..20 {
        let mut corners: Vec<Point> = Vec::new();
        for i in 0..60 {
            let angle = std::f64::consts::TAU * f64::from(i) / 60.0;
            let radius = 100.0 + 900.0 * random.unit();
            corners.push([(radius * angle.cos()).round(), (radius * angle.sin()).round()]);
        }
        let next = |i: usize| corners[(i + 1) % 60];
        let twice: f64 =
            (0..60).map(|i| corners[i][0] * next(i)[1] - corners[i][1] * next(i)[0]).sum();
        let boundary = ring(&(0..60).collect::<Vec<_>>());
        let mut points = corners.clone();
        for _ in 0..200 {
            let p = [0; 2].map(|_| (random.unit() * 2000.0 - 1000.0).round());
            if !points.contains(&p) {
                points.push(p);
            }
        }
        assert_eq!(area(&points, &constrained(&points, &boundary)), twice as i64);
    }
}

/// Six points and two short segments on which another library did not come to an end (kninnug/Constrainautor#15).
#[test]
fn segments_that_others_failed_on() {
    let points = [
        [0.0, 0.0],
        [0.05626429153399996, 0.0],
        [0.024093852080076722, 4.80267923973791e-18],
        [0.01379050745122589, 0.1463775332929564],
        [0.05177587092034522, 0.015468457826306506],
        [0.024093852080076705, -5.204170427930421e-18],
    ];
    constrained(&points, &[line(0, 5), line(5, 2)]);
}
