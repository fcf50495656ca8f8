//! Circles in polygons of several rings: holes and parts.

use super::common::{Random, Ring, clearance, is_inside};
use taut_certify::{CheckError, Fault, InscribedCircle, PolygonViolation, Solution, Violation};
use taut_inscribe::{CircleOptions, Error, inscribed_circle};
use taut_points::{Monitor, Points, hash_points};

/// Rows (x, y, number of the ring).
pub(crate) fn rows(rings: &[Ring]) -> Vec<f64> {
    let numbered = |(number, ring): (usize, &Ring)| {
        ring.iter().flat_map(|p| [p[0], p[1], number as f64]).collect::<Vec<_>>()
    };
    rings.iter().enumerate().flat_map(numbered).collect()
}

pub(crate) fn square(x: f64, y: f64, side: f64) -> Ring {
    vec![[x, y], [x + side, y], [x + side, y + side], [x, y + side]]
}

fn solve(rings: &[Ring]) -> Result<Solution<InscribedCircle>, Error> {
    inscribed_circle(&Points::new(&rows(rings), 3).unwrap(), &CircleOptions::default())
}

fn proved(rings: &[Ring]) -> Solution<InscribedCircle> {
    let found = solve(rings).unwrap();
    let verdict = found.check(&Points::new(&rows(rings), 3).unwrap()).unwrap();
    assert!(verdict.gap <= 1.01e-9, "{verdict:?}");
    found
}

#[test]
fn a_hole_moves_the_optimum() {
    // The circle in a corner touches two sides and a corner of the hole: r + r√2 = √2.
    let found = proved(&[square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0)]);
    assert!((found.answer.radius - (2.0 - 2f64.sqrt())).abs() <= 1e-8);
    let found = proved(&[square(0.0, 0.0, 8.0), square(1.0, 1.0, 1.0)]);
    let expected = 6.0 * 2f64.sqrt() / (1.0 + 2f64.sqrt());
    assert!((found.answer.radius - expected).abs() <= 1e-8, "{}", found.answer.radius);
    // An island in a hole, and a part beside it.
    let nested = [
        square(0.0, 0.0, 8.0),
        square(0.5, 0.5, 7.0),
        square(1.0, 1.0, 6.0),
        square(9.0, 0.0, 5.0),
    ];
    let found = proved(&nested);
    assert!((found.answer.radius - 3.0).abs() <= 1e-8);
    let found = proved(&[&nested[..2], &nested[3..]].concat());
    assert!((found.answer.radius - 2.5).abs() <= 1e-8 && found.answer.center[0] > 9.0);
}

#[test]
fn one_ring_is_the_same_with_and_without_its_number() {
    let ring = super::common::tour(5, 30);
    let numbered = proved(std::slice::from_ref(&ring));
    let plain = super::common::proved(&ring).0;
    assert_eq!(numbered.answer, plain.answer);
    assert_eq!(numbered.certificate.tree, plain.certificate.tree);
    assert_eq!(numbered.certificate.leaves, plain.certificate.leaves);
    // The number is in the hash.
    let said = numbered.check(&Points::new(ring.as_flattened(), 2).unwrap());
    assert!(matches!(said, Err(CheckError::Rejected(Violation::Hash { .. }))));
}

#[test]
fn no_sampled_center_is_better() {
    let mut random = Random(8);
    let holes: Vec<Ring> = (0..9)
        .map(|i| {
            let (x, y) = (f64::from(i % 3), f64::from(i / 3));
            square(x + 0.1 + 0.4 * random.unit(), y + 0.1 + 0.4 * random.unit(), 0.3)
        })
        .collect();
    let rings = [vec![square(0.0, 0.0, 3.0)], holes].concat();
    let found = proved(&rings);
    let of_all = |q: [f64; 2]| {
        let inside = rings.iter().filter(|ring| is_inside(q, ring)).count() % 2 == 1;
        let nearest = rings.iter().map(|ring| clearance(q, ring)).fold(f64::INFINITY, f64::min);
        if inside { nearest } else { 0.0 }
    };
    assert!((of_all(found.answer.center) - found.answer.radius).abs() <= 1e-9);
    for _ in 0..20_000 {
        let q = [3.0 * random.unit(), 3.0 * random.unit()];
        assert!(of_all(q) <= found.answer.radius * (1.0 + 1e-8), "{q:?}");
    }
}

#[test]
fn rings_that_meet_or_are_misnumbered_are_refused_by_row() {
    let of = |rings: &[Ring]| solve(rings).unwrap_err().to_string();
    assert_eq!(
        of(&[square(0.0, 0.0, 4.0), square(3.0, 1.0, 2.0)]),
        "the edge from point 1 to point 2 meets the edge from point 4 to point 5: rings may neither cross nor touch \
         themselves or each other"
    );
    assert!(
        of(&[square(0.0, 0.0, 4.0), square(1.0, 0.0, 1.0)]).contains("from point 0 to point 1")
    );
    let two = vec![[1.0, 1.0], [2.0, 2.0], [1.0, 1.0]];
    assert!(of(&[square(0.0, 0.0, 4.0), two]).contains("ring 1 (from 0) has 2 distinct vertices"));
    let good = rows(&[square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0)]);
    for (row, value) in [(0, 1.0), (0, -1.0), (5, 0.0), (4, 2.0), (3, 0.5), (7, 3.0)] {
        let mut bad = good.clone();
        bad[3 * row + 2] = value;
        let points = Points::new(&bad, 3).unwrap();
        let error = inscribed_circle(&points, &CircleOptions::default()).unwrap_err();
        let named = if row == 0 { 0..=1 } else { row..=row };
        let is_named =
            matches!(error, Error::RingNumber { row, .. } if named.contains(&(row as usize)));
        assert!(is_named, "{row}: {error}");
        // The checker reads rings by itself.
        let mut forged = proved(&[square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0)]);
        forged.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
        let Err(CheckError::Rejected(said)) = forged.check(&points) else { panic!("{row}") };
        let is_named = matches!(said, Violation::Polygon(PolygonViolation::RingNumber { .. }));
        assert!(is_named && matches!(said.fault(8), Fault::Row(_)), "{said}");
    }
}

#[test]
fn a_hole_that_appears_or_goes_is_rejected() {
    let rings = [square(0.0, 0.0, 4.0), square(1.0, 1.0, 2.0), square(1.5, 1.5, 1.0)];
    let found = proved(&rings);
    for changed in [&rings[..1], &rings[..2], &[rings[0].clone(), square(0.2, 0.2, 0.3)][..]] {
        let values = rows(changed);
        let points = Points::new(&values, 3).unwrap();
        let mut forged = found.clone();
        forged.certificate.points_hash = hash_points(&points, &Monitor::silent()).unwrap();
        // Without the island the same circle is still the largest one.
        let is_same = changed.len() == 2 && changed[1] == rings[1];
        let said = forged.check(&points);
        assert!(is_same || said.is_err(), "{}: {said:?}", changed.len());
    }
}
