//! From curves to the answer with its certificate.

use std::collections::BTreeMap;

use taut_certify::{
    Curve, CurveCertificate, CurveComponent, Place, Solution, Stop, TourBound, Trace,
    curve_evidence,
};
use taut_points::parallel::ParallelSlice;
use taut_points::{Cancelled, Monitor, PointSource, hash_points};

use super::CurveOptions;
use super::cloud::Cloud;
use super::nearest::{Segments, Spot};
use crate::Error;

/// Sites of one task.
const TASK: usize = 1 << 12;

/// Relative slack of the band claimed; distances in `f64` differ by about 1e-16 from machine to machine.
const BAND_SLACK: f64 = 1e-12;

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

impl Outcome {
    /// The same for all sites, where this was found of some of them, ascending: the others are outliers if they are `far`.
    pub(super) fn spread(mut self, sites: &[u32], far: &[u32]) -> Self {
        self.outliers = self.outliers.iter().map(|&site| sites[site as usize]).collect();
        self.outliers.extend_from_slice(far);
        self.outliers.sort_unstable();
        self
    }
}

/// The answer and its certificate.
pub(super) fn finish(
    cloud: &Cloud,
    outcome: Outcome,
    options: &CurveOptions<'_>,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let Outcome { method, curves, mut outliers, noise, tour, counters } = outcome;
    if curves.is_empty() {
        outliers = (0..cloud.sites.len() as u32).collect();
    }
    let mut is_outlier = vec![false; cloud.sites.len()];
    outliers.iter().for_each(|&site| is_outlier[site as usize] = true);
    // The checker finds no evidence for a tour, and its vertices are points.
    let found = match tour {
        Some(_) => None,
        None => Some(curve_evidence(&curves, &cloud.sites, &is_outlier, monitor)?),
    };
    // Figures of doubtful curves depend on rounding, and nobody asks for them.
    let certified = found.filter(|found| found.doubt.is_none());
    let places = match options.places && !curves.is_empty() {
        true => places(cloud, source.len() as usize, &curves, &is_outlier, monitor)?,
        false => Vec::new(),
    };
    let mut rows: Vec<u64> = outliers
        .iter()
        .flat_map(|&site| cloud.rows(site).iter().map(|&row| u64::from(row)))
        .collect();
    rows.sort_unstable();
    let certificate = CurveCertificate {
        band: found.map_or(0.0, |found| with_slack(found.band)),
        sampling_ratio: certified.map_or(f64::MAX, |found| found.sampling_ratio),
        noise_ratio: certified.map_or(f64::MAX, |found| found.noise_ratio),
        certified: certified.is_some(),
        tour,
        points_hash: hash_points(source, monitor)?,
    };
    let trace = Trace {
        method: method.into(),
        stop: Stop::Converged,
        passes: 1,
        counters,
        ..Trace::default()
    };
    Ok(Solution { answer: Curve { curves, noise, outliers: rows, places }, certificate, trace })
}

/// Returns a band a little wider than the one found, for a checker on a machine whose `hypot` differs in the last place.
fn with_slack(band: f64) -> f64 {
    match band > 0.0 {
        true => (band * (1.0 + BAND_SLACK)).next_up().min(f64::MAX),
        false => 0.0,
    }
}

/// Returns the place of every row, of outliers too.
fn places(
    cloud: &Cloud,
    rows: usize,
    curves: &[CurveComponent],
    is_outlier: &[bool],
    monitor: &Monitor<'_>,
) -> Result<Vec<Place>, Cancelled> {
    let segments = Segments::of(curves);
    let mut spots = at_vertices(curves, &segments, cloud, is_outlier);
    spots.par_chunks_mut(TASK).enumerate().try_for_each(|(task, spots)| {
        monitor.check()?;
        let mut guess = usize::MAX;
        for (k, spot) in spots.iter_mut().enumerate() {
            let p = cloud.sites[task * TASK + k].map(|x| x * segments.scale);
            *spot = spot.or_else(|| segments.next_to(p, guess));
            guess = spot.map_or(guess, |spot| spot.edge as usize);
        }
        Ok(())
    })?;
    let mut places = vec![Place::default(); rows];
    for (site, spot) in (0u32..).zip(&spots) {
        let Some(spot) = spot else { continue };
        let curve = segments.first.partition_point(|&first| first <= spot.edge) - 1;
        let position = f64::from(spot.edge - segments.first[curve]) + spot.share;
        for &row in cloud.rows(site) {
            places[row as usize] = Place(curve as u32, position);
        }
    }
    Ok(places)
}

/// Returns the spots of sites that are vertices, where vertices are points.
fn at_vertices(
    curves: &[CurveComponent],
    segments: &Segments,
    cloud: &Cloud,
    is_outlier: &[bool],
) -> Vec<Option<Spot>> {
    let site_of_row = cloud.site_of_row();
    let mut spots = vec![None; cloud.sites.len()];
    for (one, &first) in curves.iter().zip(&segments.first) {
        for (vertex, &row) in one.rows.iter().enumerate() {
            // The last vertex of an open curve is at the end of an edge.
            let is_end = !one.closed && vertex > 0 && vertex + 1 == one.vertices.len();
            let (edge, share) = if is_end { (vertex - 1, 1.0) } else { (vertex, 0.0) };
            let site = site_of_row[row as usize] as usize;
            spots[site] = (!is_outlier[site]).then_some(Spot { edge: first + edge as u32, share });
        }
    }
    spots
}
