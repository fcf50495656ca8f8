//! The answer is a function of the point set: not of the order of rows, of threads, of insertion.

use std::f64::consts::TAU;

use taut_certify::{Solution, Triangulation};
use taut_delaunay::{DelaunayOptions, InsertionOrder, delaunay};
use taut_points::Points;

use crate::test_length::long_or;

/// A small generator of numbers in [0, 1).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.next() * (i + 1) as f64) as usize);
        }
    }
}

fn on_circle(angle: f64) -> [f64; 2] {
    [angle.cos(), angle.sin()]
}

/// Named sets of points of the plane, each hard in its own way.
fn plane_sets() -> Vec<(&'static str, Vec<[f64; 2]>)> {
    let mut r = Numbers(0x2545_F491_4F6C_DD1D);
    let cells = |i: i32| (f64::from(i % 60), f64::from(i / 60));
    let (sin, cos) = 302.328f64.to_radians().sin_cos();
    let lattice = (-65i32..=65).flat_map(|x| (-65i32..=65).map(move |y| (x, y)));
    let on_circles = lattice.filter(|(x, y)| [4225, 2125, 625].contains(&(x * x + y * y)));
    vec![
        ("uniform", (0..4000).map(|_| [r.next(), r.next()]).collect()),
        ("grid", (0..3600).map(|i| cells(i).into()).collect()),
        ("grid of tenths", (0..3600).map(|i| [cells(i).0 * 0.1, cells(i).1 * 0.1]).collect()),
        (
            "tilted grid",
            (0..3600).map(cells).map(|(x, y)| [x * cos - y * sin, x * sin + y * cos]).collect(),
        ),
        ("circle", (0..1500).map(|_| on_circle(TAU * r.next())).collect()),
        (
            "hub and rim",
            [[0.0; 2]]
                .into_iter()
                .chain((0..700).map(|i| on_circle(f64::from(i) * TAU / 700.0)))
                .collect(),
        ),
        ("lattice on circles", on_circles.map(|(x, y)| [f64::from(x), f64::from(y)]).collect()),
        (
            "collinear and one",
            (0..2000).map(|i| [f64::from(i), 0.0]).chain([[700.5, 1000.0]]).collect(),
        ),
        ("two lines", (0..2000).map(|i| [f64::from(i / 2) * 0.37, f64::from(i % 2)]).collect()),
        (
            "cluster in a void",
            (0..3000)
                .map(|i| {
                    let (x, y) = (r.next(), r.next());
                    if i < 300 { [x * 1e6, y * 1e6] } else { [4e5 + x * 1e-3, 6e5 + y * 1e-3] }
                })
                .collect(),
        ),
        (
            "mixed signs",
            (0..2000).map(|_| [(r.next() - 0.5) * 1e-3, (r.next() - 0.5) * 1e3]).collect(),
        ),
        ("huge", (0..500).map(|_| [r.next() * 1e150, (r.next() - 0.5) * 1e150]).collect()),
        ("tiny", (0..500).map(|_| [r.next() * 1e-150, (r.next() - 0.5) * 1e-150]).collect()),
        (
            "all scales",
            (0..300).map(|i| 2f64.powi(i * 6 - 900)).map(|s| [s, r.next() * s]).collect(),
        ),
        (
            "subnormal",
            (0..400u64).map(|i| [f64::from_bits(i % 20), f64::from_bits(i / 20)]).collect(),
        ),
        ("collinear", (0..100).map(|i| [f64::from(i * 37 % 100) * 0.1; 2]).collect()),
        ("one point", vec![[3.0, -4.0]]),
        ("nothing", vec![]),
    ]
}

/// The same for space.
fn space_sets() -> Vec<(&'static str, Vec<[f64; 3]>)> {
    let mut r = Numbers(0x9E37_79B9_7F4A_7C15);
    let cells = |i: i32| [i % 10, i / 10 % 10, i / 100].map(f64::from);
    let on_sphere = |z: f64, angle: f64| {
        let s = (1.0 - z * z).sqrt();
        [s * angle.cos(), s * angle.sin(), z]
    };
    let tip = |i: usize, s: f64| {
        std::array::from_fn(|k| if k == i / 2 { s * [1.0, -1.0][i % 2] } else { 0.0 })
    };
    vec![
        ("uniform", (0..3000).map(|_| [r.next(), r.next(), r.next()]).collect()),
        ("grid", (0..1000).map(cells).collect()),
        ("grid of tenths", (0..1000).map(|i| cells(i).map(|x| x * 0.1)).collect()),
        ("sphere", (0..800).map(|_| on_sphere(2.0 * r.next() - 1.0, TAU * r.next())).collect()),
        (
            "skew lines",
            (0..160)
                .map(f64::from)
                .map(|i| if i % 2.0 == 0.0 { [i, 0.0, 0.0] } else { [3.0, i, 7.0] })
                .collect(),
        ),
        (
            "coplanar and one",
            (0..900)
                .map(|i| [f64::from(i % 30), f64::from(i / 30), 0.0])
                .chain([[3.5, 4.5, 9.0]])
                .collect(),
        ),
        ("coplanar", (0..900).map(|i| [i % 30, i / 30, i % 30 + i / 30].map(f64::from)).collect()),
        ("coplanar, upright", (0..500).map(|_| [r.next(), 7.0, r.next()]).collect()),
        ("collinear", (0..100).map(|i| [f64::from(i * 37 % 100) * 0.1; 3]).collect()),
        (
            "octahedra",
            [1.0, 0.5, 2.0].into_iter().flat_map(|s| (0..6).map(move |i| tip(i, s))).collect(),
        ),
        (
            "cluster in a void",
            (0..2000)
                .map(|i| {
                    let p = [r.next(), r.next(), r.next()];
                    if i < 200 { p.map(|x| x * 1e5) } else { p.map(|x| 5e4 + x * 1e-4) }
                })
                .collect(),
        ),
        // Slivers without end: the circumsphere of almost every tetrahedron touches most sites.
        (
            "two circles, hardly tilted",
            (0..700)
                .map(|i| (TAU * r.next(), f64::from(i % 2) * 1e-12))
                .map(|(angle, tilt)| {
                    [2e9 * angle.cos(), 2e8 * angle.cos() + tilt, 4e9 * angle.sin()]
                })
                .collect(),
        ),
        ("one point", vec![[3.0, -4.0, 0.5]]),
        ("nothing", vec![]),
    ]
}

/// All sets in the long tests; else the small ones, and of the others those with every fourth number, from `first` on.
fn some<const D: usize>(
    sets: Vec<(&'static str, Vec<[f64; D]>)>,
    first: usize,
) -> impl Iterator<Item = (&'static str, Vec<[f64; D]>)> {
    let sets = sets.into_iter().enumerate();
    let is_taken = move |place: usize, points: usize| {
        points <= SMALL_SET_POINTS_MAX || place % long_or(1, 4) == first % long_or(1, 4)
    };
    sets.filter(move |(place, set)| is_taken(*place, set.1.len())).map(|(_, set)| set)
}

/// Sets of up to so many points take no time.
const SMALL_SET_POINTS_MAX: usize = 500;

fn build<const D: usize>(
    points: &[[f64; D]],
    options: &DelaunayOptions<'_>,
) -> Solution<Triangulation> {
    let points = Points::new(points.as_flattened(), D).expect("whole rows");
    delaunay(&points, options).expect("finite points")
}

fn same_whatever_the_way<const D: usize>(name: &str, points: &[[f64; D]]) {
    let alone = DelaunayOptions { threads: Some(1), ..DelaunayOptions::default() };
    let expected = build(points, &alone);
    let source = Points::new(points.as_flattened(), D).expect("whole rows");
    expected.check(&source).unwrap_or_else(|e| panic!("{name}: {e}"));
    for &threads in long_or(&[2, 3, 8, 30][..], &[3, 30]) {
        for &sites_per_thread in long_or(&[Some(1), Some(40), None][..], &[Some(1), Some(40)]) {
            let options =
                DelaunayOptions { threads: Some(threads), sites_per_thread, ..alone.clone() };
            let found = build(points, &options);
            assert!(found == expected, "{name}: {threads} threads, {sites_per_thread:?}");
        }
    }
    for order in InsertionOrder::ALL {
        let method = order.name();
        let found = build(points, &DelaunayOptions { order, seed: 7, ..alone.clone() });
        assert!(
            found.answer == expected.answer && found.certificate == expected.certificate,
            "{name}: {method}"
        );
    }
    let scalar = build(points, &DelaunayOptions { vectors: false, ..alone.clone() });
    assert!(scalar == expected, "{name}: without vectors");

    let mut shuffled = points.to_vec();
    Numbers(99).shuffle(&mut shuffled);
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    let reversed: Vec<[f64; D]> = sorted.iter().rev().copied().collect();
    let doubled: Vec<[f64; D]> = points.iter().flat_map(|&p| [p, p]).collect();
    for (way, rows) in
        [("shuffled", shuffled), ("sorted", sorted), ("reversed", reversed), ("doubled", doubled)]
    {
        let options = DelaunayOptions {
            threads: Some(3),
            sites_per_thread: Some(1),
            ..DelaunayOptions::default()
        };
        let found = build(&rows, &options);
        assert_eq!(
            found.certificate.fingerprint, expected.certificate.fingerprint,
            "{name}: {way}"
        );
        assert_eq!(found.certificate.counts, expected.certificate.counts, "{name}: {way}");
        if way == "doubled" {
            // Each site twice, and each duplicate twice.
            assert_eq!(
                found.answer.duplicates.len(),
                points.len() + expected.answer.duplicates.len(),
                "{name}"
            );
        }
    }
}

#[test]
fn the_plane() {
    for (name, points) in some(plane_sets(), 1) {
        same_whatever_the_way(name, &points);
    }
}

#[test]
fn space() {
    for (name, points) in some(space_sets(), 3) {
        same_whatever_the_way(name, &points);
    }
}
