//! Whether rows sample the curves densely enough to call them homeomorphic to those that were sampled.
//!
//! The thresholds are choices that keep below the theorem for clean samples, tried on known curves, noisy and clean.

use taut_points::{Monitor, ReadError};

use super::super::{Curve, CurveDoubt};
use super::band::{Foot, Placed};
use super::edges::Edges;
use super::{features, outliers, sampling};

/// ε, the most that half a gap may be of φ, where vertices are rows. NN-Crust's theorem asks for 1/3 of the local feature size, which
/// is at most φ.
const SAMPLING_MOST: f64 = 0.25;

/// The same for noise.
const NOISY_SAMPLING_MOST: f64 = 0.125;

/// The most that the distance of a row may be of φ.
const NOISE_MOST: f64 = 0.25;

/// A curve has at least this many rows where vertices are rows, and this many where they are not. A window of a band
/// takes 128.
const CURVE_ROWS_MIN: usize = 24;
const NOISY_CURVE_ROWS_MIN: usize = 128;

/// The most that a curve may turn at one vertex, in radians.
const TURN_MOST: f64 = std::f64::consts::FRAC_PI_3;

/// What was found.
pub(super) struct Evidence {
    /// Infinite where it is not known.
    pub(super) sampling_ratio: f64,
    /// Infinite where it is not known.
    pub(super) noise_ratio: f64,
    /// The first reason against.
    pub(super) doubt: Option<CurveDoubt>,
}

pub(super) fn judge(
    curve: &Curve,
    is_tour: bool,
    edges: &Edges,
    crossing: Option<[usize; 2]>,
    placed: &Placed,
    monitor: &Monitor<'_>,
) -> Result<Evidence, ReadError> {
    let unknown = |doubt| Evidence {
        sampling_ratio: f64::INFINITY,
        noise_ratio: f64::INFINITY,
        doubt: Some(doubt),
    };
    if curve.curves.is_empty() {
        return Ok(unknown(CurveDoubt::Empty));
    }
    if let Some([one, _]) = crossing {
        let (curve, edge) = edges.name(one);
        return Ok(unknown(CurveDoubt::Crossing { curve, edge }));
    }
    if is_tour {
        return Ok(unknown(CurveDoubt::Tour));
    }
    if let Some(curve) = curve.curves.iter().position(|one| !one.closed) {
        return Ok(unknown(CurveDoubt::Open { curve }));
    }
    let mut feet: Vec<Vec<Foot>> = vec![vec![]; curve.curves.len()];
    for foot in &placed.inliers {
        feet[edges.name(foot.edge).0].push(*foot);
    }
    let (least, sampling_most) = match placed.is_exact {
        true => (CURVE_ROWS_MIN, SAMPLING_MOST),
        false => (NOISY_CURVE_ROWS_MIN, NOISY_SAMPLING_MOST),
    };
    let few = feet.iter().position(|feet| feet.len() < least);
    if let Some(curve) = few {
        return Ok(unknown(CurveDoubt::Few { curve, rows: feet[curve].len(), least }));
    }
    let band = placed.inliers.iter().fold(0.0f64, |most, foot| most.max(foot.offset.abs()));
    let (mut sampling_ratio, mut noise_ratio) = (0.0f64, 0.0f64);
    let (mut doubts, mut gaps) = (Doubts::default(), vec![]);
    for (curve, feet) in feet.iter().enumerate() {
        let features = features::features(edges, curve, band, placed.is_exact, monitor)?;
        let samples = sampling::ordered(feet, edges.first_edge[curve], &features);
        let (vertex, turn) = features.corner;
        if turn > TURN_MOST {
            let degrees = turn.to_degrees();
            doubts.corner.get_or_insert(CurveDoubt::Corner { curve, vertex, degrees });
        }
        let worst = sampling::sampling_ratio(&samples, &features);
        if worst.value > sampling_ratio && worst.value > sampling_most {
            let (vertex, ratio, most) = (worst.at, worst.value, sampling_most);
            doubts.sparse = Some(CurveDoubt::Sparse { curve, vertex, ratio, most });
        }
        sampling_ratio = sampling_ratio.max(worst.value);
        let worst = sampling::noise_ratio(&samples, &features);
        if worst.value > noise_ratio && worst.value > NOISE_MOST {
            let (row, ratio, most) = (worst.at as u64, worst.value, NOISE_MOST);
            doubts.noisy = Some(CurveDoubt::Noisy { row, curve, ratio, most });
        }
        noise_ratio = noise_ratio.max(worst.value);
        doubts.lacuna = doubts.lacuna.or_else(|| sampling::lacuna(curve, &samples, &features));
        if !placed.is_exact {
            doubts.split = doubts.split.or_else(|| sampling::split(curve, &samples));
            doubts.winding = doubts.winding.or_else(|| sampling::winding(curve, &samples));
        }
        gaps.extend(sampling::lengths(&samples, &features));
    }
    let Doubts { corner, sparse, lacuna, noisy, split, winding } = doubts;
    let doubt = corner
        .or(sparse)
        .or(noisy)
        .or(lacuna)
        .or(winding)
        .or(split)
        .or_else(|| outliers::doubt(edges, placed, gaps, band));
    Ok(Evidence { sampling_ratio, noise_ratio, doubt })
}

/// The first doubt of each kind, or the worst.
#[derive(Default)]
struct Doubts {
    corner: Option<CurveDoubt>,
    sparse: Option<CurveDoubt>,
    lacuna: Option<CurveDoubt>,
    noisy: Option<CurveDoubt>,
    split: Option<CurveDoubt>,
    winding: Option<CurveDoubt>,
}
