//! Sites in their order along a curve: gaps, noise, and what lies across the band.

use rayon::prelude::*;

use super::features::Features;
use super::nearest::{Segments, Spot};
use super::peaks::has_one_peak;

/// A gap is compared with this many gaps on either side.
const NEIGHBOR_GAPS: usize = 16;
/// Neighbours are compared along windows of this many sites.
const WINDOW_SITES: usize = 128;
/// Windows across the band have this many sites; the last is all sites.
const BAND_WINDOW_SITES: [usize; 5] = [64, WINDOW_SITES, 512, 2048, usize::MAX];
/// ln of how seldom chance may leave this few sites between two bands, with some room.
const GAP_RARITY: f64 = 3.5;
/// Gaps that are more even are supposed to have this coefficient of variation, with some room.
const VARIATION_MIN: f64 = 0.099;
/// The least mean squared difference of neighbours, over twice the variance, with some room: chance makes it 1 ± 0.09.
const WINDING_LEAST: f64 = 0.52;

/// A site on its curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    /// The way along the curve.
    way: f64,
    /// The vertex before it.
    vertex: u32,
    /// How far off, less than 0 on the right.
    offset: f64,
}

/// Spots with their sites, by curve.
pub(super) fn by_curve(
    segments: &Segments,
    spots: &[Option<Spot>],
    curves: usize,
) -> Vec<Vec<(u32, Spot)>> {
    let mut of_curves = vec![Vec::new(); curves];
    if let [one] = of_curves.as_mut_slice() {
        one.reserve(spots.len());
    }
    for (site, spot) in spots.iter().enumerate() {
        if let Some(spot) = spot {
            let curve = segments.first.partition_point(|&first| first <= spot.edge) - 1;
            of_curves[curve].push((site as u32, *spot));
        }
    }
    of_curves
}

/// The samples of a curve in order.
pub(super) fn along(
    spots: Vec<(u32, Spot)>,
    segments: &Segments,
    curve: usize,
    features: &Features,
) -> Vec<Sample> {
    let first = segments.first[curve];
    let mut samples: Vec<(u32, Sample)> = spots
        .into_par_iter()
        .map(|(site, spot)| {
            let vertex = spot.edge - first;
            let (from, to) = (features.way[vertex as usize], features.way[vertex as usize + 1]);
            let offset = if spot.left { spot.distance } else { -spot.distance };
            (site, Sample { way: from + spot.share * (to - from), vertex, offset })
        })
        .collect();
    // Many have one foot, a vertex.
    samples.par_sort_unstable_by(|a, b| {
        let by_place = a.1.way.total_cmp(&b.1.way).then(a.1.offset.total_cmp(&b.1.offset));
        by_place.then(a.0.cmp(&b.0))
    });
    samples.into_iter().map(|sample| sample.1).collect()
}

/// The samples of a curve whose vertices they are.
pub(super) fn at_vertices(features: &Features) -> Vec<Sample> {
    let ways = features.way[..features.phi.len()].iter();
    (0u32..).zip(ways).map(|(vertex, &way)| Sample { way, vertex, offset: 0.0 }).collect()
}

/// The gap after sample k, around the curve.
fn gap(samples: &[Sample], k: usize, length: f64) -> f64 {
    match samples.get(k + 1) {
        Some(next) => next.way - samples[k].way,
        None => samples[0].way + length - samples[k].way,
    }
}

/// Adds all gaps.
pub(super) fn gaps(samples: &[Sample], length: f64, gaps: &mut Vec<f64>) {
    gaps.extend((0..samples.len()).map(|k| gap(samples, k, length)));
}

/// The largest of half a gap over the least φ in it, and of an offset over φ beside it.
pub(super) fn ratios(samples: &[Sample], features: &Features) -> (f64, f64) {
    let (n, mut sampling, mut noise) = (features.phi.len(), 0.0f64, 0.0f64);
    for (k, sample) in samples.iter().enumerate() {
        let (from, is_last) = (sample.vertex as usize, k + 1 == samples.len());
        let next =
            if is_last { samples[0].vertex as usize + n } else { samples[k + 1].vertex as usize };
        let phi = |range: std::ops::RangeInclusive<usize>| {
            range.map(|v| features.phi[v % n]).fold(f64::INFINITY, f64::min)
        };
        let gap = gap(samples, k, features.length());
        if gap > 0.0 {
            sampling = sampling.max(gap / (2.0 * phi(from..=next + 1)));
        }
        if sample.offset != 0.0 {
            noise = noise.max(sample.offset.abs() / phi(from..=from + 1));
        }
    }
    (sampling, noise)
}

/// Whether no gap is much longer than those beside it, by what chance would leave at samples drawn at random.
pub(super) fn is_even(samples: &[Sample], features: &Features) -> bool {
    let n = samples.len();
    let beside = NEIGHBOR_GAPS.min((n - 1) / 2);
    let chance = 8.9 + 1.5 * (n as f64).ln();
    let length = features.length();
    let way = |k: usize| samples[k % n].way + (k / n) as f64 * length;
    (n..2 * n).all(|k| {
        let gap_at = |k: usize| gap(samples, k % n, length);
        let around = || (k - beside..=k + beside).filter(|&other| other != k).map(gap_at);
        let many = (2 * beside) as f64;
        let mean = ((way(k) - way(k - beside)) + (way(k + 1 + beside) - way(k + 1))) / many;
        let gap = gap_at(k);
        // Most are short beside others however even those are.
        if gap <= (1.0 + chance * VARIATION_MIN) * mean {
            return true;
        }
        let square = |x: f64| x * x;
        let variance = around().map(|other| square(other - mean)).sum::<f64>() / many;
        let varied = (variance.sqrt() / mean).clamp(VARIATION_MIN, 1.0);
        gap <= (1.0 + chance * varied) * mean
    })
}

/// Whether offsets follow each other no more than chance would have it: else the curve that was sampled winds about this one.
pub(super) fn are_by_chance(samples: &[Sample]) -> bool {
    let n = samples.len();
    let starts: Vec<usize> = (0..n).step_by(WINDOW_SITES / 2).collect();
    starts.into_par_iter().all(|start| {
        let offset = |k: usize| samples[k % n].offset;
        let window = start..start + WINDOW_SITES;
        let mean = window.clone().map(offset).sum::<f64>() / WINDOW_SITES as f64;
        let square = |x: f64| x * x;
        let variance: f64 = window.clone().map(|k| square(offset(k) - mean)).sum();
        let steps: f64 = window.skip(1).map(|k| square(offset(k) - offset(k - 1))).sum();
        steps >= WINDING_LEAST * 2.0 * variance
    })
}

/// Whether the band is one, not two or more with fewer sites between.
pub(super) fn is_one_band(samples: &[Sample]) -> bool {
    let n = samples.len();
    let most = (n as f64).ln() + GAP_RARITY;
    BAND_WINDOW_SITES.into_iter().map(|window| window.min(n)).all(|window| {
        let starts: Vec<usize> = (0..n).step_by(window.div_ceil(2)).collect();
        starts.into_par_iter().with_min_len(16).all(|start| {
            let mut offsets: Vec<f64> =
                (start..start + window).map(|k| samples[k % n].offset).collect();
            offsets.sort_unstable_by(f64::total_cmp);
            has_one_peak(&offsets, most)
        })
    })
}
