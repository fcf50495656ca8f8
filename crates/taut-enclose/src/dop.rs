//! The bounding k-dop: the smallest intersection of half-spaces with k given normals that holds all points of space.
//!
//! *Problem.* For points p₁…pₙ and normals u₁…u_k find hⱼ = maxᵢ uⱼ·pᵢ.
//! *Idea.* One pass: each block finds its largest sums with the first rows that reach them. A sum is rounded up to the next number,
//! which keeps the order of sums, so that the largest of the rounded sums is the rounded largest.
//! *Guarantee.* hⱼ is the least `f64` that is at least uⱼ·pᵢ for all i. The answer is the same for every number of threads.
//! *Trap.* A rounded sum can be below the exact one: the point would be outside by an amount that no drawing shows, and every exact
//! test would.
//! *Reference.* Klosowski et al., Efficient collision detection using bounding volume hierarchies of k-dops, IEEE TVCG 4(1), 1998.

use taut_certify::{BoundingDop, DopCertificate, DopViolation, Solution, Stop, Trace};
use taut_points::{InputError, Monitor, PointSource, PointsHash, hash_block, map_blocks};

use crate::Error;

/// Coordinates are at most this, so that no sum of three overflows.
const COORDINATE_MAX: f64 = 1e299;

/// How to bound points. Write `DopOptions { directions: 26, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct DopOptions<'a> {
    /// Directions of the facets: 6, 14, 18 or 26. Default 18.
    pub directions: usize,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for DopOptions<'_> {
    fn default() -> Self {
        DopOptions { directions: 18, monitor: Monitor::silent() }
    }
}

/// Finds the bounding k-dop of points of space. O(kn), one pass, nothing held but a block.
///
/// ```
/// let corners = [0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0];
/// let points = taut_points::Points::new(&corners, 3)?;
/// let options = taut_enclose::DopOptions { directions: 14, ..Default::default() };
/// let found = taut_enclose::bounding_dop(&points, &options)?;
/// assert_eq!(found.answer.offsets[..7], [2.0, 0.0, 2.0, 0.0, 2.0, 0.0, 2.0]);
/// assert_eq!(found.answer.vertices.len(), 4);                // a tetrahedron with these faces is a 14-dop
/// assert!((found.check(&points)?.volume_lower - 4.0 / 3.0).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Error::Empty`]; [`Error::Overflow`] for points whose extent or coordinates are out of range; [`Error::Input`] for points that
/// are not in space or not finite, for other numbers of directions, and for what reading says.
pub fn bounding_dop(
    points: &dyn PointSource,
    options: &DopOptions<'_>,
) -> Result<Solution<BoundingDop>, Error> {
    let normals = BoundingDop::directions(options.directions);
    if normals.is_empty() {
        let (value, expected) = (options.directions.to_string(), "6, 14, 18 or 26");
        return Err(InputError::Option { name: "directions", value, expected }.into());
    }
    if points.dim() != 3 {
        let (dim, expected) = (points.dim(), "3, space");
        return Err(InputError::Dimension { dim, expected }.into());
    }
    if points.is_empty() {
        return Err(Error::Empty);
    }
    options.monitor.pass(1, points.len());
    let blocks = map_blocks(points, &options.monitor, |first, rows| {
        rows.check_finite(first)?;
        let mut largest = vec![(f64::NEG_INFINITY, first); normals.len()];
        let mut p = [0.0; 3];
        for row in 0..rows.len() {
            rows.copy_row(row, &mut p);
            if p.iter().any(|x| x.abs() > COORDINATE_MAX) {
                return Err(Error::Overflow);
            }
            for (normal, found) in normals.iter().zip(&mut largest) {
                let along = sum_up([0, 1, 2].map(|c| normal[c] as f64 * p[c]));
                if along > found.0 {
                    *found = (along, first + row as u64);
                }
            }
        }
        Ok((hash_block(&rows), largest))
    })?;
    let hashes = blocks.iter().map(|block| block.0);
    let points_hash = PointsHash::of_blocks(points.len(), points.dim(), hashes);
    let mut largest = vec![(f64::NEG_INFINITY, 0); normals.len()];
    for (_, of_block) in &blocks {
        for (found, &other) in largest.iter_mut().zip(of_block) {
            // Of equal sums the one of the earlier block stays.
            if other.0 > found.0 {
                *found = other;
            }
        }
    }
    // 0 rather than −0, so that answers read alike.
    let (offsets, touching) = largest.into_iter().map(|(h, row)| (h + 0.0, row)).unzip();
    let answer = BoundingDop::of_half_spaces(normals, offsets).map_err(|violation| {
        match violation {
            DopViolation::Range { .. } => Error::Overflow,
            // Points with all their digits are near enough to each other for the grid.
            _ => Error::Undecided,
        }
    })?;
    let trace = Trace {
        method: "dop".to_owned(),
        stop: Stop::Converged,
        passes: 1,
        iterations: 1,
        core_set: options.directions as u64,
        ..Trace::default()
    };
    Ok(Solution { answer, certificate: DopCertificate { touching, points_hash }, trace })
}

/// The least number that is at least a + b + c, which do not overflow.
fn sum_up([a, b, c]: [f64; 3]) -> f64 {
    let two_sum = |a: f64, b: f64| {
        let sum = a + b;
        let of_b = sum - a;
        (sum, (a - (sum - of_b)) + (b - of_b))
    };
    // The sum is high + middle + low; most often the latter two are 0.
    let (sum, low) = two_sum(a, b);
    let (high, middle) = two_sum(sum, c);
    if low == 0.0 && middle == 0.0 {
        return high;
    }
    let (middle, low) = two_sum(middle, low);
    let (high, middle) = two_sum(high, middle);
    let (middle, low) = two_sum(middle, low);
    // Now each part is at most half a unit in the last place of the one before it, and the first part that is not 0 has the sign.
    let rest = if middle == 0.0 { low } else { middle };
    if rest > 0.0 { high.next_up() } else { high }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_rounded_up() {
        let e = f64::EPSILON;
        for (terms, expected) in [
            ([1.0, 2.0, 3.0], 6.0),
            ([1.0, e / 4.0, 0.0], 1.0 + e),
            ([1.0, -e / 8.0, 0.0], 1.0),
            ([1.0, e / 4.0, -e / 4.0], 1.0),
            ([1e200, 1.0, -1e200], 1.0),
            ([1e200, 1.0, 1e-200], 1e200f64.next_up()),
            ([1.0, 1e-200, -1e-201], 1.0 + e),
            ([1.0, -1e-200, 1e-201], 1.0),
            ([-1.0, 1e-300, 0.0], -1.0 + e / 2.0),
            ([0.1, 0.2, 0.0], 0.30000000000000004),
            ([0.0, 5e-324, -5e-324], 0.0),
        ] {
            for [i, j, k] in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
                assert_eq!(sum_up([terms[i], terms[j], terms[k]]), expected, "{terms:?} {i}{j}{k}");
            }
        }
    }
}
