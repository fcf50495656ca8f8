//! C-steps: from a metric to the h rows nearest in it, to the metric these say, until nothing changes.
//!
//! *Guarantee.* Each step that changes the rows lowers what is minimized, det S or the volume of the ellipsoid
//! ([`enclosing`]), so the steps end, at rows that are the h nearest in their own metric. That is a local optimum under
//! C-steps and no more: finding the least determinant or volume of all is NP-hard.
//! *Reference.* Rousseeuw, Van Driessen, Technometrics 41, 1999, theorem 1.

use taut_certify::RobustMethod;
use taut_points::{Monitor, Points};

use super::estimate::{Estimate, RankedEstimate};
use super::flat::{Flat, hull};
use super::starts::nearest;
use super::{RobustOptions, enclosing};
use crate::Error;
use crate::ellipsoid::point_reader::PointReader;

/// The rows kept and their estimate.
pub(super) struct Raw {
    pub(super) estimate: Estimate,
    pub(super) kept: Vec<bool>,
}

/// Where steps ended.
pub(super) enum ConcentrationResult {
    Full(Raw),
    /// In a hyperplane that holds the rows kept: their determinant is 0.
    Flat(Flat),
}

/// The quantity to minimize.
#[derive(Clone, Copy)]
pub(super) enum Criterion {
    /// The determinant of the covariance.
    Determinant,
    /// The volume of the ellipsoid, found to this gap.
    Volume(f64),
}

impl Criterion {
    pub(super) fn of(options: &RobustOptions<'_>) -> Self {
        match options.method {
            RobustMethod::Mcd => Criterion::Determinant,
            RobustMethod::Mve | RobustMethod::Trim => Criterion::Volume(options.epsilon),
        }
    }

    /// By how much ln det S must fall for a step to have led on.
    fn least_step(self) -> f64 {
        match self {
            Criterion::Determinant => 0.0,
            // Both log-volumes, half of ln det S, may be off by the gap.
            Criterion::Volume(epsilon) => 4.0 * epsilon,
        }
    }
}

/// The metric of the rows kept, found with the help of another that is not too far off.
pub(super) fn estimate(
    criterion: Criterion,
    data: &mut PointReader<'_>,
    metric: &Estimate,
    kept: &[bool],
) -> Result<Result<Estimate, Flat>, Error> {
    if let Criterion::Volume(epsilon) = criterion {
        return enclosing::estimate(data, kept, epsilon);
    }
    match metric.of_rows(data, kept)? {
        RankedEstimate::Full(estimate) => Ok(Ok(estimate)),
        RankedEstimate::Noise(estimate) => Ok(hull(data, kept)?.map_or(Ok(estimate), Err)),
        RankedEstimate::Singular => hull(data, kept)?.map(Err).ok_or(Error::Overflow),
    }
}

/// C-steps from a metric, `limit` of them at most.
pub(super) fn concentrate(
    criterion: Criterion,
    data: &mut PointReader<'_>,
    start: &Estimate,
    h: usize,
    limit: usize,
    steps: &mut u64,
) -> Result<ConcentrationResult, Error> {
    let mut kept = nearest(&start.distances(data)?, h);
    let mut here = match estimate(criterion, data, start, &kept)? {
        Ok(estimate) => estimate,
        Err(flat) => return Ok(ConcentrationResult::Flat(flat)),
    };
    for _ in 1..limit {
        *steps += 1;
        let next = nearest(&here.distances(data)?, h);
        if next == kept {
            break;
        }
        let better = match estimate(criterion, data, &here, &next)? {
            Ok(estimate) => estimate,
            Err(flat) => return Ok(ConcentrationResult::Flat(flat)),
        };
        // Rows that differ by rounding alone could follow each other in a circle.
        let leads_on = better.log_det() < here.log_det() - criterion.least_step();
        if !leads_on {
            break;
        }
        (kept, here) = (next, better);
    }
    Ok(ConcentrationResult::Full(Raw { estimate: here, kept }))
}

/// C-steps until they end, from the nearest half by a ranking.
pub(super) fn from_ranking(
    criterion: Criterion,
    values: &[f64],
    dim: usize,
    ranking: &[f64],
    h: usize,
    steps: &mut u64,
) -> Result<ConcentrationResult, Error> {
    let points = Points::new(values, dim).expect("rows of the dimension");
    let silent = Monitor::silent();
    let mut data = PointReader::new(&points, &silent)?;
    let half = ranking.len().div_ceil(2);
    for count in [half, h] {
        let kept = nearest(ranking, count);
        let metric = Estimate::rough(&mut data, &kept)?;
        match estimate(criterion, &mut data, &metric, &kept)? {
            Ok(start) => return concentrate(criterion, &mut data, &start, h, usize::MAX, steps),
            // Half of the points may lie in a hyperplane that does not hold h of them.
            Err(flat) if count == h => return Ok(ConcentrationResult::Flat(flat)),
            Err(_) => {}
        }
    }
    unreachable!("the loop returns with its second turn")
}
