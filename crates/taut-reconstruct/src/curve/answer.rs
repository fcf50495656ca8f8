//! From curves to the answer with its certificate.

use std::collections::BTreeMap;

use rayon::prelude::*;
use taut_certify::{
    Curve, CurveCertificate, CurveComponent, Place, Solution, Stop, TourBound, Trace,
};
use taut_points::{Cancelled, Monitor, PointSource, hash_points};

use super::CurveOptions;
use super::cloud::Cloud;
use super::evidence::{Evidence, Segments, Spot, evidence};
use crate::Error;

/// Sites of one task.
const TASK: usize = 1 << 12;

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
    options: &CurveOptions<'_>,
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<Solution<Curve>, Error> {
    let Outcome { method, curves, mut outliers, noise, tour, counters } = outcome;
    if curves.is_empty() {
        outliers = (0..cloud.sites.len() as u32).collect();
    }
    let segments = Segments::of(&curves);
    let mut is_outlier = vec![false; cloud.sites.len()];
    outliers.iter().for_each(|&site| is_outlier[site as usize] = true);
    let are_sites = curves.first().is_some_and(|one| !one.rows.is_empty());
    let spots = match are_sites {
        true => at_vertices(&curves, &segments, cloud, &is_outlier),
        false => next_to(&segments, &cloud.sites, &is_outlier, monitor)?,
    };
    let found = match tour {
        Some(_) => Evidence::NONE,
        None => evidence(&curves, &segments, &cloud.sites, &spots, monitor)?,
    };
    let band = spots.iter().flatten().fold(0.0f64, |band, spot| band.max(spot.distance));
    let places = match options.places && segments.len() > 0 {
        true => places(cloud, source.len() as usize, &segments, &spots),
        false => Vec::new(),
    };
    let mut rows: Vec<u64> = outliers
        .iter()
        .flat_map(|&site| cloud.rows(site).iter().map(|&row| u64::from(row)))
        .collect();
    rows.sort_unstable();
    let certificate = CurveCertificate {
        band: if are_sites { 0.0 } else { band_above(band, &cloud.sites, &spots, &segments) },
        sampling_ratio: found.sampling_ratio,
        noise_ratio: found.noise_ratio,
        certified: found.certified,
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

/// Spots of sites that are vertices.
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
            let spot = Spot { edge: first + edge as u32, share, distance: 0.0, left: true };
            spots[site] = (!is_outlier[site]).then_some(spot);
        }
    }
    spots
}

/// Spots of sites next to the edges.
fn next_to(
    segments: &Segments,
    sites: &[[f64; 2]],
    is_outlier: &[bool],
    monitor: &Monitor<'_>,
) -> Result<Vec<Option<Spot>>, Cancelled> {
    let mut spots = vec![None; sites.len()];
    spots.par_chunks_mut(TASK).enumerate().try_for_each(|(task, spots)| {
        monitor.check()?;
        let mut guess = usize::MAX;
        for (k, spot) in spots.iter_mut().enumerate() {
            let site = task * TASK + k;
            if !is_outlier[site] {
                let p = sites[site].map(|x| x * segments.scale);
                *spot = segments.next_to(p, guess, f64::INFINITY);
                guess = spot.map_or(guess, |spot| spot.edge as usize);
            }
        }
        Ok(())
    })?;
    Ok(spots)
}

/// The band in units of the input, with all roundings of its distances added, and those of a checker's.
fn band_above(band: f64, sites: &[[f64; 2]], spots: &[Option<Spot>], segments: &Segments) -> f64 {
    if segments.len() == 0 {
        return 0.0;
    }
    // What is rounded are differences of coordinates, none larger than the boxes of sites and edges together, and the band.
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for (p, _) in sites.iter().zip(spots).filter(|(_, spot)| spot.is_some()) {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let width = (0..2).map(|k| ((high[k] - low[k]) * segments.scale).max(0.0)).sum::<f64>();
    let rounding = 32.0 * f64::EPSILON * (width + segments.reach() + band);
    // Below the smallest normal number nothing is relative.
    let least = 32.0 * f64::from_bits(1);
    ((band * (1.0 + 1e-12) + rounding) / segments.scale + least).next_up().min(f64::MAX)
}

/// The place of every row, of outliers too.
fn places(cloud: &Cloud, rows: usize, segments: &Segments, spots: &[Option<Spot>]) -> Vec<Place> {
    let mut guess = usize::MAX;
    let mut places = vec![Place::default(); rows];
    for (site, spot) in spots.iter().enumerate() {
        let p = cloud.sites[site].map(|x| x * segments.scale);
        let Some(spot) = spot.or_else(|| segments.next_to(p, guess, f64::INFINITY)) else {
            continue;
        };
        guess = spot.edge as usize;
        let curve = segments.first.partition_point(|&first| first <= spot.edge) - 1;
        let position = f64::from(spot.edge - segments.first[curve]) + spot.share;
        for &row in cloud.rows(site as u32) {
            places[row as usize] = Place(curve as u32, position);
        }
    }
    places
}
