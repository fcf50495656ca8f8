//! The checker of bounding dops.
//!
//! *Inside.* For each row and facet the sign of u·p − h is exact: a rounded sum with a bound decides nearly all, an expansion
//! without rounding the others.
//! *Tight.* The offset is the least number that holds its row: the number before it does not.
//! *Vertices, volume.* They are compared with those that the half-spaces have: [`shape`](super::shape).
//! *Cost.* O(kn) for n rows and k facets, in one pass.

use taut_points::{Monitor, PointSource};

use super::shape::Shape;
use super::{BoundingDop, DopCertificate, DopVerdict, DopViolation};
use crate::hashed_pass::{WantedRows, all_finite, hashed_pass};
use crate::{CheckError, Violation};

/// Offsets are at most this, so that no sum of four numbers overflows.
pub(super) const OFFSET_MAX: f64 = 1e300;

/// How much the volume claimed may differ from the volume proved, relatively.
const VOLUME_SLACK: f64 = 1e-9;

/// A bound on the error of a sum of four numbers, relative to the sum of their absolute values: three additions, doubled.
const SUM_ERROR: f64 = 6.0 / (1u64 << 53) as f64;

pub(super) fn check(
    answer: &BoundingDop,
    certificate: &DopCertificate,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<DopVerdict, CheckError> {
    if source.dim() != 3 {
        return Err(DopViolation::Space { dim: source.dim() }.into());
    }
    let shape = Shape::of(&answer.normals, &answer.offsets)?;
    let facets = answer.normals.len();
    if certificate.touching.len() != facets {
        let (what, found) = ("the list of rows touched", certificate.touching.len());
        return Err(Violation::Length { what, found, expected: facets }.into());
    }
    if let Some(facet) = certificate.touching.iter().position(|&row| row >= source.len()) {
        return Err(DopViolation::NoRow { facet, row: certificate.touching[facet] }.into());
    }
    monitor.pass(1, source.len());
    let wanted = WantedRows::of(&certificate.touching);
    let half_spaces = || answer.normals.iter().zip(&answer.offsets);
    let (_, kept) =
        hashed_pass(source, certificate.points_hash, wanted, monitor, |first, rows| {
            all_finite(first, rows)?;
            let mut p = [0.0; 3];
            for k in 0..rows.len() {
                rows.copy_row(k, &mut p);
                let is_beyond = |(u, &h): (&[i64; 3], &f64)| is_above(u, &p, h);
                if let Some(facet) = half_spaces().position(is_beyond) {
                    return Err(DopViolation::Outside { row: first + k as u64, facet }.into());
                }
            }
            Ok(())
        })?;
    for (facet, ((u, h), &row)) in half_spaces().zip(&certificate.touching).enumerate() {
        let p = kept.row(row);
        if !is_above(u, &[p[0], p[1], p[2]], h.next_down()) {
            return Err(DopViolation::Loose { facet, row }.into());
        }
    }
    check_vertices(answer, &shape)?;
    let [volume_lower, volume_upper] = shape.volume();
    let is_right = answer.volume >= volume_lower * (1.0 - VOLUME_SLACK)
        && answer.volume <= volume_upper * (1.0 + VOLUME_SLACK);
    if !is_right {
        let found = volume_lower / 2.0 + volume_upper / 2.0;
        return Err(DopViolation::Volume { claimed: answer.volume, found }.into());
    }
    Ok(DopVerdict { facets: facets as u64, volume_lower, volume_upper })
}

/// Checks that each vertex of the list is near one of the shape, and the other way round.
fn check_vertices(answer: &BoundingDop, shape: &Shape) -> Result<(), DopViolation> {
    /// Entries of the list, at most: each vertex of 26 facets, and each as often as three of them meet.
    const ENTRIES_MAX: usize = 2600;
    let (found, slack) = (shape.vertices(), shape.slack());
    let has_near = |list: &[[f64; 3]], at: &[f64; 3]| {
        list.iter().any(|other| (0..3).all(|c| (other[c] - at[c]).abs() <= slack))
    };
    let wrong = |problem, at: &[f64; 3]| Err(DopViolation::Vertex { problem, at: *at });
    if answer.vertices.len() > ENTRIES_MAX {
        return wrong(
            "the list of vertices has more than 2600 entries, the last of them",
            &[0.0; 3],
        );
    }
    if let Some(at) = answer.vertices.iter().find(|at| !has_near(&found, at)) {
        return wrong("the half-spaces have no vertex at", at);
    }
    match found.iter().find(|at| !has_near(&answer.vertices, at)) {
        Some(at) => wrong("the list of vertices lacks the one at", at),
        None => Ok(()),
    }
}

/// Whether u·p > h, exactly where no sum overflows. A row for which one does is beyond a facet along an axis.
fn is_above(u: &[i64; 3], p: &[f64; 3], h: f64) -> bool {
    let terms = [u[0] as f64 * p[0], u[1] as f64 * p[1], u[2] as f64 * p[2], -h];
    let sum = terms[0] + terms[1] + terms[2] + terms[3];
    let size = terms.iter().map(|x| x.abs()).sum::<f64>();
    if sum.abs() > SUM_ERROR * size {
        return sum > 0.0;
    }
    exact_sum(terms).is_some_and(|largest| largest > 0.0)
}

/// The largest part of the exact sum, which has its sign; none for 0.
fn exact_sum(terms: [f64; 4]) -> Option<f64> {
    let mut parts: Vec<f64> = vec![];
    for term in terms {
        let mut sum = term;
        for part in &mut parts {
            let (a, b) = (sum, *part);
            sum = a + b;
            let virtual_b = sum - a;
            *part = (a - (sum - virtual_b)) + (b - virtual_b);
        }
        parts.push(sum);
    }
    parts.into_iter().rev().find(|&part| part != 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_exact() {
        let e = f64::EPSILON;
        for (p, h, above, at) in [
            ([1.0, e / 4.0, 0.0], 1.0, true, false),
            ([1.0, -e / 4.0, 0.0], 1.0, false, false),
            ([1e200, 1.0, -1e200], 1.0, false, true),
            ([1e200, 1.0, -1e200], 1.0 - e, true, false),
            ([0.1, 0.2, 0.0], 0.3, true, false),
            ([0.1, 0.2, 0.0], 0.1 + 0.2, false, false),
            ([5e-324, 5e-324, -5e-324], 5e-324, false, true),
        ] {
            assert_eq!(is_above(&[1, 1, 1], &p, h), above, "{p:?} {h}");
            assert_eq!(exact_sum([p[0], p[1], p[2], -h]).is_none(), at, "{p:?} {h}");
            assert_eq!(is_above(&[-1, -1, -1], &p, -h), !above && !at, "{p:?} {h}");
        }
        assert!(is_above(&[1, 0, 0], &[1e308, 1e308, 0.0], 1e300));
    }
}
