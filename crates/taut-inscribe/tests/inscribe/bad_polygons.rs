//! Polygons that others call invalid: each is solved or refused with the place named.

use super::common::{Random, Ring, verify};
use super::rings::{rows, square};
use taut_certify::{InscribedCircle, Solution};
use taut_inscribe::{CircleOptions, Error, inscribed_circle};
use taut_points::Points;

fn solve(rings: &[Ring]) -> Result<Solution<InscribedCircle>, Error> {
    inscribed_circle(&Points::new(&rows(rings), 3).unwrap(), &CircleOptions::default())
}

/// The rows of the two edges that a refusal names.
fn refused(rings: &[Ring]) -> [[u64; 2]; 2] {
    match solve(rings) {
        Err(Error::NotSimple { edge, other }) => [edge, other],
        other => panic!("{:?}: {rings:?}", other.map(|found| found.answer)),
    }
}

fn radius(rings: &[Ring]) -> f64 {
    let found = solve(rings).unwrap();
    found.check(&Points::new(&rows(rings), 3).unwrap()).unwrap();
    found.answer.radius
}

#[test]
fn polygons_of_bug_reports_are_named_or_solved() {
    let bow = vec![[0.0, 0.0], [2.0, 2.0], [2.0, 0.0], [0.0, 2.0]];
    assert_eq!(refused(&[bow]), [[0, 1], [2, 3]]);
    // A ring that touches itself at a vertex.
    let waist = vec![[0.0, 0.0], [4.0, 0.0], [2.0, 2.0], [4.0, 4.0], [0.0, 4.0], [2.0, 2.0]];
    let [edge, other] = refused(&[waist]);
    assert!(edge.contains(&2) && other.contains(&5), "{edge:?}, {other:?}");
    // A hole that touches the shell at a vertex, along an edge, and one that crosses it.
    let shell = square(0.0, 0.0, 8.0);
    for hole in [
        vec![[0.0, 4.0], [2.0, 3.0], [2.0, 5.0]],
        square(0.0, 3.0, 2.0),
        square(-1.0, 3.0, 2.0),
        shell.clone(),
    ] {
        let [edge, other] = refused(&[shell.clone(), hole]);
        assert!(edge.iter().all(|&row| row < 4) && other.iter().all(|&row| row >= 4));
    }
    // A spike out and one in.
    let out = vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [6.0, 4.0], [4.0, 4.0], [0.0, 4.0]];
    assert!(refused(&[out]).concat().contains(&3));
    let within = vec![[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [2.0, 0.0], [4.0, 0.0], [4.0, 4.0]];
    assert!(refused(&[within]).concat().contains(&2));
    // Three points on a line, and all points equal or on two places.
    refused(&[vec![[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]]);
    for ring in [vec![[1.0, 1.0]; 5], vec![[0.0, 0.0], [1.0, 0.0], [1.0, 0.0]]] {
        assert!(matches!(solve(&[ring]), Err(Error::TooFewVertices { ring: 0, .. })));
    }
    // Vertices that are repeated, a hole outside that is a part, and shells within shells.
    let repeated: Ring = shell.iter().flat_map(|&p| [p, p, p]).collect();
    assert!((radius(&[repeated]) - 4.0).abs() < 1e-8);
    assert!((radius(&[square(0.0, 0.0, 2.0), square(5.0, 0.0, 4.0)]) - 2.0).abs() < 1e-8);
    let nested = [shell.clone(), square(0.5, 0.5, 7.0), square(1.0, 1.0, 6.0)];
    assert!((radius(&nested) - 3.0).abs() < 1e-8);
    // The octagon that libgeos answered with 5.97 (libgeos/geos#1225), of circumradius 10.
    let octagon: Ring = super::common::regular(8).iter().map(|p| p.map(|x| 10.0 * x)).collect();
    let expected = 10.0 * (std::f64::consts::PI / 8.0).cos();
    assert!((radius(&[octagon]) - expected).abs() < 1e-7);
    // A sliver that held up the search of others (shapely#2351).
    let sliver = vec![[0.0, 0.0], [1e6, 1e-3], [2e6, 0.0], [1e6, 5e-4]];
    assert!(radius(&[sliver]) < 5e-4);
}

/// Whether two edges of a ring of whole numbers meet though they must not, by products of integers.
fn meets_itself(ring: &[[i64; 2]]) -> bool {
    let size = ring.len();
    let turn = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
        ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).signum()
    };
    let is_on = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
        turn(a, b, c) == 0 && (0..2).all(|k| a[k].min(b[k]) <= c[k] && c[k] <= a[k].max(b[k]))
    };
    let pair = |i: usize, j: usize| {
        let [a, b, c, d] = [i, i + 1, j, j + 1].map(|place| ring[place % size]);
        match () {
            () if (i + 1) % size == j => is_on(a, b, d) || is_on(c, d, a),
            () if (j + 1) % size == i => is_on(c, d, b) || is_on(a, b, c),
            () => {
                turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0
                    || [c, d].into_iter().any(|p| is_on(a, b, p))
                    || [a, b].into_iter().any(|p| is_on(c, d, p))
            }
        }
    };
    (0..size).any(|i| (i + 1..size).any(|j| pair(i, j)))
}

#[test]
fn random_rings_of_whole_numbers_are_solved_or_refused() {
    let mut random = Random(77);
    let mut whole = |end: f64| (end * random.unit()) as i64;
    let (mut solved, mut named) = (0, 0);
    for _ in 0..10_000 {
        let size = 3 + whole(8.0) as usize;
        let mut ring: Vec<[i64; 2]> = (0..size).map(|_| [whole(7.0), whole(7.0)]).collect();
        ring.dedup();
        while ring.len() > 1 && ring.first() == ring.last() {
            ring.pop();
        }
        let given: Ring = ring.iter().map(|p| p.map(|x| x as f64)).collect();
        match super::common::solve(&given) {
            Ok(found) => {
                assert!(!meets_itself(&ring), "{ring:?}");
                verify(&found, &given);
                solved += 1;
            }
            Err(Error::NotSimple { edge, other }) => {
                let size = ring.len() as u64;
                assert!(ring.len() > 2 && meets_itself(&ring), "{ring:?}");
                let follows = |[from, to]: [u64; 2]| (from + 1) % size == to;
                assert!(follows(edge) && follows(other) && edge < other, "{edge:?}, {other:?}");
                named += 1;
            }
            Err(Error::TooFewVertices { ring: 0, distinct }) => {
                assert!(ring.len() < 3 && distinct < 3, "{ring:?}");
            }
            Err(error) => panic!("{error}: {ring:?}"),
        }
    }
    assert!(solved > 500 && named > 5000, "{solved} solved, {named} named");
}
