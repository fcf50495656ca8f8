//! Answers whose lower bound is that more than k points are far apart.
//!
//! *Idea.* Two points that are D apart fit in no ball of a radius below D/2, and of k + 1 points two share one of k balls.
//! *Trap.* Distances are known to rounding only. Radii go up by what a plain sum of squares may be off, so that whoever measures
//! again finds nothing outside; bounds go down by more than any checker's arithmetic takes.

use taut_certify::{Centers, CentersCertificate, Items, LowerBound, Placement, Solution, Trace};
use taut_points::{PointsHash, two_to};

use crate::Error;

/// 2⁻⁵³.
const U: f64 = f64::EPSILON / 2.0;

/// A lower bound as it is claimed: less by what a few roundings at the lower end of the range may have added, which is nothing beside
/// other bounds. `weight` is the largest of the weights by which a checker divides.
pub(crate) fn claimed(bound: f64, weight: f64) -> f64 {
    (bound - two_to(-1072) * weight.max(1.0)).max(0.0)
}

/// Points of which no two are nearer than some distance.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct SeparatedSet {
    pub(crate) rows: Vec<u64>,
    /// The least distance of two, as evaluated.
    pub(crate) distance: f64,
}

/// A distance in d dimensions, as evaluated, with room for evaluating it in another order.
pub(crate) fn rounded_up(distance: f64, dim: usize) -> f64 {
    let up = distance * (1.0 + (dim as f64 + 16.0) * U);
    // Subnormal numbers are too far apart for a factor to count, and have been rounded to one of them.
    if up > 0.0 && up < 2.0 * f64::MIN_POSITIVE { up.next_up() } else { up }
}

impl SeparatedSet {
    /// No ball of a smaller radius holds two of the points: half the least distance, rounded down.
    pub(crate) fn bound(&self, dim: usize) -> f64 {
        claimed(self.distance / 2.0 * (1.0 - 1e-12 - dim as f64 * U), 1.0)
    }

    /// The answer with its radius, as evaluated, rounded up, and with these points for its lower bound.
    ///
    /// # Errors
    /// [`Error::Overflow`] where the radius or the gap is too large to be a number.
    pub(crate) fn prove(
        self,
        mut answer: Centers,
        k: u64,
        placement: Placement,
        points_hash: PointsHash,
        trace: Trace,
    ) -> Result<Solution<Centers>, Error> {
        let dim = answer.centers.first().map_or(0, Vec::len);
        answer.radius = rounded_up(answer.radius, dim);
        answer.lower_bound = if self.rows.is_empty() { 0.0 } else { self.bound(dim) };
        let certificate = CentersCertificate {
            items: Items::Points,
            weights: false,
            group: None,
            placement,
            k,
            outliers: 0,
            gap: gap(answer.radius, answer.lower_bound)?,
            core_set: self.rows,
            directions: vec![],
            proof: LowerBound::Separated,
            points_hash,
        };
        Ok(Solution { answer, certificate, trace })
    }
}

/// `upper / lower − 1`, and 0 where both are 0.
///
/// # Errors
/// [`Error::Overflow`] where that is no number.
pub(crate) fn gap(upper: f64, lower: f64) -> Result<f64, Error> {
    let gap = if upper == 0.0 { 0.0 } else { (upper / lower - 1.0).max(0.0) };
    if gap.is_finite() { Ok(gap) } else { Err(Error::Overflow) }
}
