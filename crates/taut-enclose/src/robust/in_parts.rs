//! MCD of points that lie elsewhere: the search over a sample, then C-steps over all points.
//!
//! *Idea.* A C-step needs the h-th smallest distance and the moments of the h nearest rows. A first pass counts rows in shells around
//! where a sample has that distance; a second one takes the moments of the rows below one narrow shell, and brings its few rows along.
//! *Guarantee.* The h rows at the end are the nearest in their own metric, as no C-step leads on from them. The bits do not depend on how
//! rows are divided. Exchanges at the border, which the search in memory makes as well, are not tried.
//! *Ties.* Where very many rows are equally far, as far as the h-th, all of these are kept.
//! *Reference.* Rousseeuw, Van Driessen, Technometrics 41, 1999: C-steps, and starts from a part of the points.

use taut_certify::{RobustEllipsoid, RobustMethod, Stop, Trace, Unweighted};
use taut_points::{
    Elsewhere, InputError, Monitor, PartsError, PointSource, Points, PointsHash, ReadError, Rows,
    gather, on_threads,
};

use super::chi_square::{mcd_reweighted_scale, mcd_scale, quantile};
use super::concentrate::{ConcentrationResult, Criterion};
use super::estimate::{Estimate, Moments, Turned};
use super::fit::{Fit, Placed};
use super::search::{self, GOLDEN, mix};
use super::{RobustOptions, shape};
use crate::Error;
use crate::ellipsoid::point_reader::PointReader;
use crate::passes::{SHELLS, ask_border, ask_counts};

/// Points of the sample, which the solver holds: their distances tell those of all to about a percent of the rows.
const SAMPLE_SIZE: u64 = 8192;
/// The h-th smallest distance is sought within so many deviations of where the sample has it; outside of that where it is not there.
const DEVIATIONS: f64 = 6.0;
/// At most so many rows come along with moments.
const BORDER_ROWS_MAX: u64 = 1024;
/// Most C-steps over all points; what is reached then is returned, and says so.
const STEPS_MAX: u64 = 500;
/// One more than the bits of infinity: all distances are below.
const DISTANCE_BITS_END: u64 = f64::INFINITY.to_bits() + 1;

/// Center and scatter of most points of a set that lies in several places.
#[derive(Clone, Debug, PartialEq)]
pub struct RobustInParts {
    /// The estimate. Its `outliers` are not listed, as they may be many: a point x is one if |F(x − c)| > 1.
    pub answer: RobustEllipsoid,
    /// ln det of the covariance of the points kept.
    pub objective: f64,
    /// How many points were kept: h, or more where many are equally far.
    pub kept: u64,
    /// How many points were not weighed out, from which center and scatter are taken.
    pub weighed: u64,
    /// The hash of the points.
    pub points_hash: PointsHash,
    /// The way in which it came about; iterations are C-steps over all points.
    pub trace: Trace,
}

/// Solves for points that are held elsewhere.
pub(crate) fn in_parts(
    source: &dyn PointSource,
    options: &RobustOptions<'_>,
) -> Result<RobustInParts, Error> {
    if source.is_empty() {
        return Err(Error::Empty);
    }
    let elsewhere = source.elsewhere().ok_or(PartsError::Question)?;
    on_threads(options.threads, || {
        let sample = sample(source)?;
        let mut run = Run { source, elsewhere, sample, passes: 0, hash: None };
        run.solve(options)
    })
}

/// Rows drawn by number, ascending.
fn sample(source: &dyn PointSource) -> Result<Vec<f64>, Error> {
    let n = source.len();
    let mut ids: Vec<u64> = match n > 2 * SAMPLE_SIZE {
        true => (1..=SAMPLE_SIZE).map(|i| mix(i.wrapping_mul(GOLDEN)) % n).collect(),
        false => (0..n).collect(),
    };
    ids.sort_unstable();
    ids.dedup();
    let values = gather(source, &ids)?;
    // The first pass over all rows, which refuses such a number as well, comes after the search over these.
    match Rows::F64(Points::new(&values, source.dim()).map_err(ReadError::from)?).first_non_finite()
    {
        None => Ok(values),
        Some((row, column, value)) => {
            Err(InputError::NonFinite { row: ids[row], column, value }.into())
        }
    }
}

struct Run<'a> {
    source: &'a dyn PointSource,
    elsewhere: &'a dyn Elsewhere,
    sample: Vec<f64>,
    passes: u64,
    hash: Option<PointsHash>,
}

/// Where the h-th smallest distance is.
struct Shell {
    low: u64,
    high: u64,
    /// Rows below `low`, and from there to `high`.
    below: u64,
    within: u64,
}

impl Run<'_> {
    fn solve(&mut self, options: &RobustOptions<'_>) -> Result<RobustInParts, Error> {
        let (n, dim) = (self.source.len() as usize, self.source.dim());
        let h = options.kept(n, dim);
        let mut metric = self.start(h)?;
        let (mut best, mut steps) = (None::<(Estimate, u64)>, 0);
        let stop = loop {
            options.monitor.check().map_err(ReadError::from)?;
            let (moments, kept) = self.nearest(&metric, h as u64)?;
            let next = estimate(&metric, &moments)?.ok_or(Error::MostFlatInParts)?;
            steps += 1;
            if best.as_ref().is_some_and(|(best, _)| next.log_det() >= best.log_det()) {
                break Stop::Converged;
            }
            best = Some((next.clone(), kept));
            metric = next;
            if steps == STEPS_MAX {
                break Stop::PassBudget;
            }
        };
        let (raw, kept) = best.ok_or(Error::MostFlatInParts)?;
        let objective = raw.log_det();
        let (fit, weighed) = self.reweighted(raw, (h, kept), options)?;
        let answer = shape(dim, &Placed { flat: None, ids: None, fit }, RobustMethod::Mcd)?;
        let points_hash = self.hash.ok_or(PartsError::Open)?;
        let trace = Trace {
            method: RobustMethod::Mcd.name().to_owned(),
            stop,
            passes: self.passes,
            iterations: steps,
            core_set: kept,
            history: vec![],
            counters: [("reweighted".to_owned(), u64::from(weighed != kept))].into(),
        };
        Ok(RobustInParts { answer, objective, kept, weighed, points_hash, trace })
    }

    /// The metric that the search finds over the sample.
    fn start(&self, h: usize) -> Result<Estimate, Error> {
        let (dim, silent) = (self.source.dim(), Monitor::silent());
        let points = Points::new(&self.sample, dim).map_err(|_| Error::Empty)?;
        let part = (h * points.len()).div_ceil(self.source.len() as usize);
        let mut data = PointReader::new(&points, &silent)?;
        match search::solve(Criterion::Determinant, &mut data, part, &mut 0)? {
            ConcentrationResult::Full(raw) => Ok(raw.estimate),
            ConcentrationResult::Flat(_) => Err(Error::MostFlatInParts),
        }
    }

    /// The moments of the h rows that are nearest in a metric, and how many these are.
    fn nearest(&mut self, metric: &Estimate, h: u64) -> Result<(Moments, u64), Error> {
        let Shell { low, high, below, within } = self.shell(metric, h)?;
        if within > BORDER_ROWS_MAX {
            return Ok((self.border(metric, high, high)?.0, below + within));
        }
        let (mut moments, mut border) = self.border(metric, low, high)?;
        border.truncate((h - below) as usize);
        let rows = gather(self.source, &border)?;
        moments.merge(&metric.moments_of(&rows, |_| true));
        Ok((moments, h))
    }

    /// The shell with the h-th smallest distance: of few rows, or of one distance.
    fn shell(&mut self, metric: &Estimate, h: u64) -> Result<Shell, Error> {
        let (mut low, mut high) = self.guess(metric, h);
        loop {
            let width = (high - low).div_ceil(SHELLS as u64).max(1);
            let counts = self.counts(metric, low, width)?;
            let mut below = counts[0];
            if below >= h {
                (low, high) = (0, low);
                continue;
            }
            let shell = counts[1..=SHELLS].iter().position(|count| {
                let is_here = below + count >= h;
                below += if is_here { 0 } else { *count };
                is_here
            });
            let Some(shell) = shell else {
                (low, high) = (low + width * SHELLS as u64, DISTANCE_BITS_END);
                continue;
            };
            low += width * shell as u64;
            high = low + width;
            let within = counts[1 + shell];
            if within <= BORDER_ROWS_MAX || width == 1 {
                return Ok(Shell { low, high, below, within });
            }
        }
    }

    /// Bits between which the h-th smallest distance is likely to be.
    fn guess(&self, metric: &Estimate, h: u64) -> (u64, u64) {
        let mut distances = metric.distances_of(&self.sample);
        distances.sort_unstable_by(f64::total_cmp);
        let (count, part) = (distances.len() as f64, h as f64 / self.source.len() as f64);
        let slack = DEVIATIONS * (1.0 + (count * part * (1.0 - part)).sqrt());
        let (low, high) = (count * part - slack, count * part + slack);
        let low = if low < 0.0 { 0 } else { distances[low as usize].to_bits() };
        let high =
            if high >= count { DISTANCE_BITS_END } else { distances[high as usize].to_bits() + 1 };
        (low, high)
    }

    fn counts(&mut self, metric: &Estimate, low: u64, width: u64) -> Result<Vec<u64>, Error> {
        self.passes += 1;
        let is_first = self.hash.is_none();
        let (counts, hash) =
            ask_counts(self.elsewhere, self.source, metric, (low, width), is_first)?;
        self.hash.get_or_insert(hash);
        Ok(counts)
    }

    fn border(
        &mut self,
        metric: &Estimate,
        low: u64,
        high: u64,
    ) -> Result<(Moments, Vec<u64>), Error> {
        self.passes += 1;
        let (moments, border) = ask_border(self.elsewhere, self.source, metric, (low, high))?;
        Ok((moments, border.into_iter().map(|far| far.id).collect()))
    }

    /// Weighs out what lies beyond the quantile in the metric of the rows kept; returns how many rows are left.
    fn reweighted(
        &mut self,
        raw: Estimate,
        (h, kept): (usize, u64),
        options: &RobustOptions<'_>,
    ) -> Result<(Fit, u64), Error> {
        let (n, dim) = (self.source.len() as usize, self.source.dim());
        let (objective, cutoff) = (raw.log_det(), quantile(options.level, dim));
        let raw_scale = mcd_scale(h, n, dim);
        let mut weighed = None;
        if h < n {
            let end = (cutoff * raw_scale).to_bits() + 1;
            let (moments, _) = self.border(&raw, end, end)?;
            weighed = estimate(&raw, &moments)?.map(|found| (found, moments.count() as u64));
        }
        let unweighted = match weighed {
            Some(_) => None,
            None if h == n => Some(Unweighted::AllKept),
            None => Some(Unweighted::Flat),
        };
        let (estimate, left, scale) = match weighed {
            Some((found, left)) => {
                let scale = mcd_reweighted_scale(left as usize, h, n, dim);
                (found, left, scale)
            }
            None => (raw, kept, raw_scale),
        };
        let (kept, weighed, enclosure) = (vec![], vec![], None);
        let fit = Fit {
            kept,
            objective,
            raw_scale,
            weighed,
            estimate,
            scale,
            cutoff,
            unweighted,
            enclosure,
        };
        Ok((fit, left))
    }
}

/// Mean and covariance from moments; none where the rows lie in a flat, as far as their digits tell.
fn estimate(metric: &Estimate, moments: &Moments) -> Result<Option<Estimate>, Error> {
    match metric.turned(moments)? {
        Turned::Near(found) | Turned::Rough(found) => {
            Ok((!found.is_noise(&moments.sizes())).then_some(found))
        }
        Turned::Singular => Ok(None),
    }
}
