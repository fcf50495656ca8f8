//! What the certificate of a curve claims: the band, and how densely the sites sample the curve beside its own features.
//!
//! *Problem.* The checker in `taut-certify` judges an answer from points and vertices alone. Its figures have to be known here, so
//! that no more is claimed than it finds, at a small part of the time that the curve took.
//! *Idea.* The definitions are those of the certificate; code and structures are of this crate. Sites come along a Hilbert curve, so
//! the edge next to one is near the edge next to the one before, which bounds the search for it.
//! *Guarantee.* `certified` is claimed with some room to every threshold, so that roundings do not matter.
//! *Trap.* Thresholds and definitions here must not be laxer than the checker's; tests in this crate check every claim.

mod clusters;
mod features;
mod nearest;
mod peaks;
mod quick;
mod samples;
mod sight;

use taut_certify::CurveComponent;
use taut_points::{Cancelled, Monitor};

pub(super) use nearest::{Segments, Spot};

use features::Features;
use samples::Sample;

/// ε above which nothing is certified: of vertices that are points, and of noise.
const SAMPLING_MOST: [f64; 2] = [0.25, 0.125];
/// The noise ratio above which nothing is certified.
const NOISE_MOST: f64 = 0.25;
/// The fewest sites of a curve.
const SITES_MIN: [usize; 2] = [24, 128];
/// The largest turn at a vertex, in radians.
const TURN_MOST: f64 = std::f64::consts::FRAC_PI_3;
/// A figure may take up this part of a threshold here.
const THRESHOLD_RATIO: f64 = 0.95;

/// What can be claimed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Evidence {
    pub(super) sampling_ratio: f64,
    pub(super) noise_ratio: f64,
    pub(super) certified: bool,
}

impl Evidence {
    /// Nothing.
    pub(super) const NONE: Evidence =
        Evidence { sampling_ratio: f64::MAX, noise_ratio: f64::MAX, certified: false };
}

/// The figures for sites with their spots next to the curves, `None` for outliers.
pub(super) fn evidence(
    curves: &[CurveComponent],
    segments: &Segments,
    sites: &[[f64; 2]],
    spots: &[Option<Spot>],
    monitor: &Monitor<'_>,
) -> Result<Evidence, Cancelled> {
    let are_sites = curves.first().is_some_and(|one| !one.rows.is_empty());
    let kind = usize::from(!are_sites);
    if curves.is_empty() || curves.iter().any(|one| !one.closed) {
        return Ok(Evidence::NONE);
    }
    let by_curve = match are_sites {
        true => vec![Vec::new(); curves.len()],
        false => samples::by_curve(segments, spots, curves.len()),
    };
    let sites_of = |(one, spots): (&CurveComponent, &Vec<_>)| spots.len().max(one.rows.len());
    if curves.iter().zip(&by_curve).map(sites_of).any(|sites| sites < SITES_MIN[kind]) {
        return Ok(Evidence::NONE);
    }
    let band = spots.iter().flatten().fold(0.0f64, |band, spot| band.max(spot.distance));
    let mut evidence = Evidence { sampling_ratio: 0.0, noise_ratio: 0.0, certified: true };
    let mut gaps = Vec::with_capacity(sites.len());
    for (curve, spots) in by_curve.into_iter().enumerate() {
        let features = Features::of(segments, curve, band, are_sites, monitor)?;
        let samples: Vec<Sample> = match are_sites {
            true => samples::at_vertices(&features),
            false => samples::along(spots, segments, curve, &features),
        };
        let (sampling, noise) = samples::ratios(&samples, &features);
        evidence.sampling_ratio = evidence.sampling_ratio.max(sampling);
        evidence.noise_ratio = evidence.noise_ratio.max(noise);
        evidence.certified &= features.turn <= THRESHOLD_RATIO * TURN_MOST
            && samples::is_even(&samples, &features)
            && (are_sites || samples::is_one_band(&samples) && samples::are_by_chance(&samples));
        samples::gaps(&samples, features.length(), &mut gaps);
    }
    evidence.certified &= evidence.sampling_ratio <= THRESHOLD_RATIO * SAMPLING_MOST[kind]
        && evidence.noise_ratio <= THRESHOLD_RATIO * NOISE_MOST;
    if evidence.certified {
        evidence.certified = clusters::are_harmless(segments, sites, spots, gaps, band);
    }
    // Figures of curves that fold onto themselves hang on roundings, and nobody asks for those of doubtful ones.
    Ok(if evidence.certified { evidence } else { Evidence::NONE })
}
