//! Whether rows sample the curves densely enough to call them homeomorphic to those that were sampled.
//!
//! The thresholds are choices that keep below the theorem for clean samples, tried on known curves, noisy and clean.

use taut_points::{Cancelled, Monitor};

use super::super::{CurveComponent, CurveDoubt};
use super::band::{Foot, Placed, next_to, of_vertices};
use super::edges::Edges;
use super::{bands, features, outliers, sampling, swell, vacancy};

/// ε, the most that half a gap may be of φ, where vertices are rows. NN-Crust's theorem asks for 1/3 of the local feature size, which
/// is at most φ.
const SAMPLING_MOST: f64 = 0.25;

/// The same for noise. Of 500 honest draws with forty samples to the length of a feature one in fifty has more than 0.07, and one more than 0.15.
const NOISY_SAMPLING_MOST: f64 = 0.16;

/// The most that the distance of a row may be of φ: below one half, rows lie on their own side of the medial axis.
const NOISE_MOST: f64 = 0.5;

/// A curve has at least this many rows where vertices are rows, and this many where they are not. A window of a band
/// takes 128.
const CURVE_ROWS_MIN: usize = 24;
const NOISY_CURVE_ROWS_MIN: usize = 128;

/// The most that a curve may turn at one vertex, in radians.
const TURN_MOST: f64 = std::f64::consts::FRAC_PI_3;

/// The evidence that curves are those that points were sampled from: what [`CurveVerdict`](crate::CurveVerdict) tells of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveEvidence {
    /// The largest distance of a point that is no outlier from the curves, rounded up, in the unit of the points.
    pub band: f64,
    /// The largest of half a gap over the feature size in it; infinite where it is not known.
    pub sampling_ratio: f64,
    /// The largest distance of a point over the feature size beside it; infinite where it is not known.
    pub noise_ratio: f64,
    /// The first reason not to certify the curves. A row named in it is a position among the points.
    pub doubt: Option<CurveDoubt>,
}

impl CurveEvidence {
    /// The figures are not known.
    pub(super) fn unknown(band: f64, doubt: CurveDoubt) -> Self {
        let unknown = f64::INFINITY;
        Self { band, sampling_ratio: unknown, noise_ratio: unknown, doubt: Some(doubt) }
    }
}

/// Returns the evidence that curves are those that finite, distinct points were sampled from, as [`Solution::check`](crate::Solution::check)
/// finds it, so that a solver need claim no more and no less.
///
/// The curves are simple, which is not checked here, and have finite vertices, at least three if closed and one if open. `points[k]` is left
/// out where `is_outlier[k]`. Where vertices are rows, each point is a vertex or an outlier. The order of the points changes no figure.
///
/// # Errors
/// [`Cancelled`] when the monitor stops the work.
pub fn curve_evidence(
    curves: &[CurveComponent],
    points: &[[f64; 2]],
    is_outlier: &[bool],
    monitor: &Monitor<'_>,
) -> Result<CurveEvidence, Cancelled> {
    let edges = Edges::of(curves, points);
    let is_set_aside = |&k: &usize| is_outlier.get(k).is_some_and(|&is_outlier| is_outlier);
    let (outliers, inliers): (Vec<usize>, Vec<usize>) = (0..points.len()).partition(is_set_aside);
    let is_exact = curves.first().is_some_and(|first| !first.rows.is_empty());
    let inliers = match is_exact {
        true => of_vertices(curves),
        false => next_to(&edges, points, &inliers, monitor)?,
    };
    judge(curves, &edges, &Placed::of(&edges, points, inliers, outliers, is_exact), monitor)
}

/// Judges curves from the places of all rows.
pub(super) fn judge(
    curves: &[CurveComponent],
    edges: &Edges,
    placed: &Placed,
    monitor: &Monitor<'_>,
) -> Result<CurveEvidence, Cancelled> {
    let unknown = |doubt| CurveEvidence::unknown(placed.band, doubt);
    if curves.is_empty() {
        return Ok(unknown(CurveDoubt::Empty));
    }
    if let Some(curve) = curves.iter().position(|one| !one.closed) {
        return Ok(unknown(CurveDoubt::Open { curve }));
    }
    let mut feet: Vec<Vec<Foot>> = vec![vec![]; curves.len()];
    for foot in &placed.inliers {
        feet[edges.name(foot.edge).0].push(*foot);
    }
    let (least, sampling_most, gap_rarity) = match placed.is_exact {
        true => (CURVE_ROWS_MIN, SAMPLING_MOST, sampling::GAP_RARITY),
        false => (NOISY_CURVE_ROWS_MIN, NOISY_SAMPLING_MOST, sampling::NOISY_GAP_RARITY),
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
        doubts.wide_gap =
            doubts.wide_gap.or_else(|| sampling::wide_gap(curve, &samples, &features, gap_rarity));
        if !placed.is_exact {
            let split = || {
                sampling::split(curve, &samples).or_else(|| bands::several_bands(curve, &samples))
            };
            doubts.split = doubts.split.or_else(split);
            doubts.winding = doubts.winding.or_else(|| sampling::winding(curve, &samples));
            let length = features.along[features.size.len()];
            doubts.vacancy = doubts.vacancy.or_else(|| vacancy::vacancy(curve, &samples, length));
            doubts.swell = doubts.swell.or_else(|| swell::swell(curve, &samples, length));
        }
        gaps.extend(sampling::lengths(&samples, &features));
    }
    let Doubts { corner, sparse, wide_gap, vacancy, noisy, split, winding, swell } = doubts;
    let doubt = corner
        .or(sparse)
        .or(noisy)
        .or(wide_gap)
        .or(vacancy)
        .or(winding)
        .or(split)
        .or(swell)
        .or_else(|| outliers::doubt(edges, placed, gaps, band));
    Ok(CurveEvidence { band: placed.band, sampling_ratio, noise_ratio, doubt })
}

/// The first doubt of each kind, or the worst.
#[derive(Default)]
struct Doubts {
    corner: Option<CurveDoubt>,
    sparse: Option<CurveDoubt>,
    wide_gap: Option<CurveDoubt>,
    vacancy: Option<CurveDoubt>,
    noisy: Option<CurveDoubt>,
    split: Option<CurveDoubt>,
    winding: Option<CurveDoubt>,
    swell: Option<CurveDoubt>,
}
