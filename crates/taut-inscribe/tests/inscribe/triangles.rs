//! Largest triangles: closed forms, laws, holes, and brute force.

use super::common::{Random, Ring, comb, is_inside, regular, star_shaped, tour};
use super::rings::{rows, square};
use taut_certify::{InscribedTriangle, Solution, Stop, TriangleVerdict};
use taut_inscribe::{Error, TriangleOptions, inscribed_triangle};
use taut_points::Points;

/// Proved relative gap of most tests.
const EPSILON: f64 = 1e-4;

pub(super) fn solve(rings: &[Ring], epsilon: f64) -> Result<Solution<InscribedTriangle>, Error> {
    let options = TriangleOptions { epsilon, ..Default::default() };
    inscribed_triangle(&Points::new(&rows(rings), 3).unwrap(), &options)
}

pub(super) fn verified(found: &Solution<InscribedTriangle>, rings: &[Ring]) -> TriangleVerdict {
    let verdict = found.check(&Points::new(&rows(rings), 3).unwrap());
    verdict.unwrap_or_else(|error| panic!("{error}: {:?}, {rings:?}", found.answer))
}

/// The largest triangle, verified with the gap asked for.
pub(super) fn proved(rings: &[Ring]) -> Solution<InscribedTriangle> {
    let found = solve(rings, EPSILON).unwrap();
    let verdict = verified(&found, rings);
    assert_eq!(found.trace.stop, Stop::Converged, "{rings:?}");
    assert!(verdict.gap <= EPSILON * (1.0 + 1e-8), "{verdict:?}");
    assert!(verdict.lower <= found.answer.area && found.answer.area <= verdict.upper);
    found
}

/// Whether an area is the largest one, within the gap.
fn is_near(area: f64, expected: f64) -> bool {
    area <= expected * (1.0 + 1e-12) && area >= expected * (1.0 - 1.1 * EPSILON)
}

fn assert_area(rings: &[Ring], expected: f64) {
    let found = proved(rings);
    assert!(is_near(found.answer.area, expected), "{} instead of {expected}", found.answer.area);
}

fn mapped(ring: &[[f64; 2]], [[a, b], [c, d]]: [[f64; 2]; 2], shift: [f64; 2]) -> Ring {
    let map = |p: &[f64; 2]| [a * p[0] + b * p[1] + shift[0], c * p[0] + d * p[1] + shift[1]];
    ring.iter().map(map).collect()
}

#[test]
fn half_of_a_square_is_best() {
    let found = proved(&[square(0.0, 0.0, 1.0)]);
    println!("{:?} {} {:?}", found.answer, found.certificate.tree.len(), found.certificate.gap);
    assert_area(&[square(0.0, 0.0, 1.0)], 0.5);
}
