//! Polygons that are none: each is answered or refused with its place, by all five searches, without a panic.

use std::time::Instant;

use super::common::{Random, Ring};
use super::countries;
use super::rings::{rows, square};
use taut_inscribe::{
    CircleOptions, ConvexOptions, EllipseOptions, Error, RectangleOptions, TriangleOptions,
    inscribed_circle, inscribed_ellipse, inscribed_polygon, inscribed_rectangle,
    inscribed_triangle,
};
use taut_points::Points;

use crate::test_length::long_or;

/// How all searches end for some rings: with an answer that the checker takes, or refused.
fn outcomes(rings: &[Ring]) -> Vec<Result<(), Error>> {
    let rows = rows(rings);
    let source = Points::new(&rows, 3).unwrap();
    macro_rules! outcome {
        ($search:ident, $options:expr) => {
            $search(&source, &$options).map(|found| {
                let verdict = found.check(&source);
                assert!(verdict.is_ok(), "{}: {verdict:?}, {rings:?}", stringify!($search));
            })
        };
    }
    let (epsilon, max_cells) = (0.1, 300);
    vec![
        outcome!(inscribed_circle, CircleOptions { epsilon, max_cells, ..Default::default() }),
        outcome!(inscribed_ellipse, EllipseOptions { epsilon, max_cells, ..Default::default() }),
        outcome!(
            inscribed_polygon,
            ConvexOptions { rounds: 2, starts: 2, epsilon, ..Default::default() }
        ),
        outcome!(
            inscribed_rectangle,
            RectangleOptions { epsilon, max_cells, ..Default::default() }
        ),
        outcome!(inscribed_triangle, TriangleOptions { epsilon, max_cells, ..Default::default() }),
    ]
}

/// The edges of a refusal, which all searches give alike; `None` where all answer.
fn refused(rings: &[Ring]) -> Option<[[u64; 2]; 2]> {
    let mut found = outcomes(rings).into_iter().map(|outcome| match outcome {
        Ok(()) => None,
        Err(Error::NotSimple { edge, other }) => Some([edge, other]),
        Err(error) => panic!("{error}: {rings:?}"),
    });
    let first = found.next().unwrap();
    assert!(found.all(|other| other == first), "{rings:?}");
    first
}

/// The ends of an edge by rows over all rings.
fn ends(rings: &[Ring], [from, to]: [u64; 2]) -> [[f64; 2]; 2] {
    let all = rings.concat();
    [all[from as usize], all[to as usize]]
}

/// Whether two closed segments have a common point, in whole numbers.
fn meet([a, b]: [[f64; 2]; 2], [c, d]: [[f64; 2]; 2]) -> bool {
    let turn = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| {
        let [px, py, qx, qy, rx, ry] = [p[0], p[1], q[0], q[1], r[0], r[1]].map(|x| x as i64);
        ((qx - px) * (ry - py) - (qy - py) * (rx - px)).signum()
    };
    let apart = |k: usize| a[k].max(b[k]) < c[k].min(d[k]) || c[k].max(d[k]) < a[k].min(b[k]);
    !apart(0)
        && !apart(1)
        && turn(a, b, c) * turn(a, b, d) <= 0
        && turn(c, d, a) * turn(c, d, b) <= 0
}

#[test]
fn invalid_polygons_of_bug_reports_are_refused_with_their_place() {
    let shell = || square(0.0, 0.0, 8.0);
    // What is known to make other programs loop, crash or answer wrongly.
    let invalid: [(&str, Vec<Ring>); 14] = [
        ("bow tie", vec![vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]]]),
        (
            "ring that touches itself at a vertex",
            vec![vec![[0.0, 0.0], [4.0, 0.0], [2.0, 2.0], [4.0, 4.0], [0.0, 4.0], [2.0, 2.0]]],
        ),
        (
            "vertex on an edge of the same ring",
            vec![vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [2.0, 0.0], [0.0, 4.0]]],
        ),
        (
            "hole that touches the shell at a vertex",
            vec![shell(), vec![[0.0, 4.0], [3.0, 3.0], [3.0, 5.0]]],
        ),
        ("hole that touches the shell along an edge", vec![shell(), square(0.0, 2.0, 2.0)]),
        ("hole that crosses the shell", vec![shell(), square(7.0, 1.0, 2.0)]),
        ("hole equal to the shell", vec![shell(), shell()]),
        (
            "holes that touch at a vertex",
            vec![shell(), square(1.0, 1.0, 2.0), square(3.0, 3.0, 2.0)],
        ),
        ("holes that cross", vec![shell(), square(1.0, 1.0, 3.0), square(3.0, 3.0, 3.0)]),
        ("holes that are equal", vec![shell(), square(1.0, 1.0, 3.0), square(1.0, 1.0, 3.0)]),
        ("spike out", vec![vec![[0.0, 0.0], [4.0, 0.0], [9.0, 0.0], [4.0, 0.0], [4.0, 4.0]]]),
        ("spike in", vec![vec![[0.0, 0.0], [4.0, 0.0], [2.0, 0.0], [4.0, 0.0], [4.0, 4.0]]]),
        ("flat ring", vec![vec![[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]]),
        ("ring around twice", vec![[square(0.0, 0.0, 2.0), square(0.0, 0.0, 2.0)].concat()]),
    ];
    for (name, rings) in invalid {
        let begun = Instant::now();
        let Some([edge, other]) = refused(&rings) else { panic!("{name} was answered") };
        println!("{name}: {:.3} ms for five searches", 1e3 * begun.elapsed().as_secs_f64());
        assert!(edge != other, "{name}");
        assert!(meet(ends(&rings, edge), ends(&rings, other)), "{name}: {edge:?} and {other:?}");
    }
}

#[test]
fn odd_but_valid_polygons_of_bug_reports_are_answered() {
    let corners = square(0.0, 0.0, 4.0);
    let doubled: Ring = corners.iter().flat_map(|&p| [p, p, p]).collect();
    let closed: Ring = corners.iter().chain(&corners[..1]).copied().collect();
    let valid: [(&str, Vec<Ring>); 6] = [
        ("duplicated vertices", vec![doubled]),
        ("closing vertex", vec![closed]),
        ("hole outside", vec![square(0.0, 0.0, 4.0), square(5.0, 0.0, 1.0)]),
        (
            "nested shells",
            vec![square(0.0, 0.0, 8.0), square(2.0, 2.0, 4.0), square(3.0, 3.0, 2.0)],
        ),
        (
            "both orientations",
            vec![square(0.0, 0.0, 8.0), square(2.0, 2.0, 4.0).into_iter().rev().collect()],
        ),
        (
            "a regular octagon",
            vec![vec![
                [2.0, 0.0],
                [4.0, 0.0],
                [6.0, 2.0],
                [6.0, 4.0],
                [4.0, 6.0],
                [2.0, 6.0],
                [0.0, 4.0],
                [0.0, 2.0],
            ]],
        ),
    ];
    for (name, rings) in valid {
        assert_eq!(refused(&rings), None, "{name}");
    }
}

#[test]
fn self_touching_countries_are_refused_fast() {
    let Some(all) = countries::rings("countries_10m_selftouching.json.xz") else { return };
    for (name, ring) in all {
        let source = Points::new(ring.as_flattened(), 2).unwrap();
        let begun = Instant::now();
        let found = inscribed_circle(&source, &CircleOptions::default());
        let taken = begun.elapsed();
        println!("{name}: {} vertices, {:.1} ms", ring.len(), 1e3 * taken.as_secs_f64());
        let Err(Error::NotSimple { edge, other }) = found else { panic!("{name} was answered") };
        assert!(edge != other, "{name}");
    }
}

#[test]
fn random_rings_are_answered_or_refused_with_two_edges_that_meet() {
    let count = long_or(10_000, 1000);
    let mut random = Random(11);
    let (mut answered, mut not_simple, mut short) = (0, 0, 0);
    for _ in 0..count {
        let size = 3 + (random.unit() * 6.0) as usize;
        let range = 2.0 + (random.unit() * 6.0).floor();
        let count = 1 + usize::from(random.unit() < 0.3);
        let rings: Vec<Ring> = (0..count)
            .map(|_| (0..size).map(|_| [(); 2].map(|()| (random.unit() * range).floor())).collect())
            .collect();
        let found = outcomes(&rings);
        match &found[0] {
            Ok(()) => {
                assert!(found.iter().all(Result::is_ok), "{found:?}: {rings:?}");
                answered += 1;
            }
            Err(Error::NotSimple { edge, other }) => {
                assert!(meet(ends(&rings, *edge), ends(&rings, *other)), "{rings:?}");
                not_simple += 1;
            }
            Err(Error::TooFewVertices { .. }) => short += 1,
            Err(error) => panic!("{error}: {rings:?}"),
        }
    }
    println!("{answered} answered, {not_simple} not simple, {short} with too few vertices");
    assert!(answered > count / 20 && not_simple > count / 2 && short > count / 1000);
}
