//! From curves to the answer with its certificate.

use std::collections::BTreeMap;

use taut_certify::{Curve, CurveCertificate, CurveComponent, Solution, Stop, TourBound, Trace};
use taut_points::{Monitor, PointSource, hash_points};

use super::CurveOptions;
use super::cloud::Cloud;
use crate::Error;

/// What a method found.
#[derive(Clone, Debug, Default)]
pub(super) struct Outcome {
    /// The method that was used, by its name on the command line.
    pub(super) method: &'static str,
    /// The curves.
    pub(super) curves: Vec<CurveComponent>,
    /// Sites that no curve accounts for, ascending.
    pub(super) outliers: Vec<u32>,
    /// Estimated half-width of the band of noise.
    pub(super) noise: f64,
    /// Of a tour, its bound.
    pub(super) tour: Option<TourBound>,
    /// Events worth counting.
    pub(super) counters: BTreeMap<String, u64>,
}

/// The answer and its certificate.
pub(super) fn finish(
    cloud: &Cloud,
    outcome: Outcome,
    _options: &CurveOptions,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let mut outliers: Vec<u64> = outcome
        .outliers
        .iter()
        .flat_map(|&site| cloud.rows(site).iter().map(|&row| u64::from(row)))
        .collect();
    outliers.sort_unstable();
    let points_hash = hash_points(source, monitor)?;
    let answer =
        Curve { curves: outcome.curves, noise: outcome.noise, outliers, places: Vec::new() };
    let certificate = CurveCertificate {
        band: 0.0,
        sampling_ratio: f64::MAX,
        noise_ratio: f64::MAX,
        certified: false,
        tour: outcome.tour,
        points_hash,
    };
    let trace = Trace {
        method: outcome.method.into(),
        stop: Stop::Converged,
        passes: 1,
        counters: outcome.counters,
        ..Trace::default()
    };
    Ok(Solution { answer, certificate, trace })
}
