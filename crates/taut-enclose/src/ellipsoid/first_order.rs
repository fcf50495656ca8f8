//! The methods of the thesis: weight moves to the farthest point, one pass for each step; and steps away from near ones.
//!
//! *Problem.* As in [`super::newton`]; κᵢ = 1 + |yᵢ|² are the leverages, m = d + 1, κ = κⱼ the largest.
//! *Idea.* u ← (1 − β)u + βeⱼ with β = (κ − m)/(m(κ − 1)), which raises ln det most. Algorithm 4 begins with equal
//! weights on all points, Algorithm 5 with those of Algorithm 3, so that only points it stepped to have weight: a
//! core-set. With steps away, weight also leaves the point of least leverage, when that is farther below m than κ is
//! above: β < 0, with the same formula, as far as its weight allows.
//! *Guarantee.* The log-volume is at most the optimum + ε when κ ≤ 1 + d·e^(2ε/d); the core-set of Algorithm 5 has
//! O(d²/ε) points. The trace says what the proof promises: `iteration-bound`, and `core-set-bound`, 2d more.
//! *Departures.* The thesis stops at κ ≤ m·e^(2ε/m), which promises the same of a larger κ. Formula (52) for the shape
//! lacks a factor 1 − β in its second term: Σ ← (1 − β)Σ + β(1 − β)(p − c)(p − c)′. The ellipsoid of (33) holds the
//! points only when it is enlarged by (κ − 1)/d.
//! *Trap.* Without steps away the gap falls like 1/passes: 1e-3 is far, 1e-6 is out of reach.
//! *Reference.* Khachiyan, Math. Oper. Res. 21(2), 1996; the thesis, 3.4; Todd and Yıldırım, Discrete Appl. Math.
//! 155(13), 2007, for the steps away.

use taut_certify::Stop;
use taut_points::{Points, ReadError, Rows};

use super::counters::Counters;
use super::initial;
use super::newton::{REBASE_TOLERANCE, gap};
use super::outcome::{Outcome, Progress};
use super::point_reader::{PointReader, Query};
use super::proof::{pass_error, triangular_spread};
use super::rounds::{LISTED_TOLERANCE, candidate, center_of};
use super::sample::Sample;
use super::whitener::{Rebased, Whitener};
use super::working_set::WorkingSet;
use super::{EllipsoidMethod, EllipsoidOptions};
use crate::Error;

/// The whitener is made again from the weights after this many steps: updates add up their rounding.
const STEPS_PER_REFRESH: u64 = 64;
/// A pass lists at most this many points near the border for the proof.
const LISTED_POINTS_MAX: usize = 1024;

/// Solves by one of the methods of the literature.
pub(super) fn solve(
    reader: &mut PointReader<'_>,
    sample: &Sample,
    options: &EllipsoidOptions<'_>,
) -> Result<Outcome, Error> {
    let dim = reader.dim();
    let mut set = match options.method {
        EllipsoidMethod::ThesisKhachiyan => all(reader, sample)?,
        _ => initial::points(reader, sample, options.seed)?,
    };
    let mut whitener = Whitener::of_scales(&sample.extents());
    let mut counters = Counters::default();
    let mut progress = Progress::new(dim);
    bounds(&mut counters, options, dim, reader.len());
    let stop = loop {
        if counters.steps.is_multiple_of(STEPS_PER_REFRESH)
            && whitener.rebase(&set, REBASE_TOLERANCE) == Rebased::Never
        {
            return Err(Error::Overflow);
        }
        let center = center_of(&sample.origin, &whitener);
        let matrix = whitener.matrix();
        let doubt = 3.0 * pass_error(dim, triangular_spread(matrix, dim));
        let above = dim as f64 * (1.0 - doubt.min(LISTED_TOLERANCE));
        let found =
            reader.pass(Query { matrix, center: &center, above, keep: LISTED_POINTS_MAX })?;
        let largest = found.largest;
        if !largest.is_finite() {
            return Err(Error::Overflow);
        }
        let farthest = found.far.first().map(|far| far.id);
        progress.note(&whitener, set.len(), largest, options.epsilon, || {
            candidate(&set, &whitener, center, found)
        });
        if gap(dim, largest) <= options.epsilon {
            break Stop::Converged;
        }
        // Algorithm 3 is done before any step.
        let only_start = options.method == EllipsoidMethod::ThesisInitial;
        if only_start || reader.passes() >= options.max_passes {
            break Stop::PassBudget;
        }
        let Some(farthest) = farthest else { break Stop::Rounding };
        counters.steps += 1;
        let away = options.method == EllipsoidMethod::AwaySteps;
        if !(away && step_away(&mut set, &mut whitener, largest, &mut counters)) {
            let row = reader.rows_from(&sample.origin, &[farthest])?;
            set.push(farthest, &row, 0.0);
            let i = set.position(farthest).expect("it has just been put there");
            let (m, kappa) = (dim as f64 + 1.0, largest + 1.0);
            step(&mut set, &mut whitener, i, (kappa - m) / (m * (kappa - 1.0)));
        }
    };
    let core_set = set.weights().iter().filter(|u| **u > 0.0).count();
    Ok(progress.into_outcome(stop, counters, core_set))
}

/// All points, with equal weights.
fn all(reader: &PointReader<'_>, sample: &Sample) -> Result<WorkingSet, Error> {
    let mut set = WorkingSet::new(reader.dim());
    let ids: Vec<u64> = (0..reader.len()).collect();
    for ids in ids.chunks(4096) {
        // No pass has read them yet, which would refuse such a number.
        Rows::F64(Points::new(&reader.rows(ids)?, reader.dim()).map_err(ReadError::from)?)
            .check_finite(ids[0])?;
        let rows = reader.rows_from(&sample.origin, ids)?;
        for (&id, row) in ids.iter().zip(rows.chunks_exact(reader.dim())) {
            set.push(id, row, 1.0);
        }
    }
    set.normalize();
    Ok(set)
}

/// u ← (1 − β)u + βeᵢ, and the whitener with it: in its coordinates the new covariance is (1 − β)(I + βyy′).
fn step(set: &mut WorkingSet, whitener: &mut Whitener, i: usize, beta: f64) {
    let mut row = vec![0.0; set.dim()];
    set.copy_row(i, &mut row);
    whitener.step(&row, beta);
    let weights = set.weights_mut();
    weights.iter_mut().for_each(|u| *u *= 1.0 - beta);
    weights[i] = (weights[i] + beta).max(0.0);
    // Roundings of many steps add up to more than a checker lets a sum be off.
    let total: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|u| *u /= total);
}

/// Moves weight away from the point of least leverage, if that is farther below m than the largest is above.
fn step_away(
    set: &mut WorkingSet,
    whitener: &mut Whitener,
    largest: f64,
    counters: &mut Counters,
) -> bool {
    let m = set.dim() as f64 + 1.0;
    let leverages = whitener.apply(set).leverages;
    let with_weight = (0..set.len()).filter(|&i| set.weights()[i] > 0.0);
    let Some(i) = with_weight.min_by(|&a, &b| leverages[a].total_cmp(&leverages[b])) else {
        return false;
    };
    let kappa = leverages[i] + 1.0;
    let u = set.weights()[i];
    if m - kappa <= largest + 1.0 - m || u >= 1.0 {
        return false;
    }
    // In the form of Todd: u ← (u + λeᵢ)/(1 + λ), λ < 0.
    let wanted = (kappa - m) / ((m - 1.0) * kappa);
    let lambda = wanted.max(-u);
    step(set, whitener, i, lambda / (1.0 + lambda));
    *counters.others.entry("away-steps".into()).or_default() += 1;
    if lambda > wanted {
        set.weights_mut()[i] = 0.0;
        let id = set.ids()[i];
        let ids = set.ids().to_vec();
        set.retain(|k| ids[k] != id);
        *counters.others.entry("drop-steps".into()).or_default() += 1;
    }
    set.normalize();
    true
}

/// Checks what the analysis promises of Algorithms 4 and 5, with its constants written out.
///
/// With εᵢ = κ/m − 1 and δ the distance of ln det from its optimum: δ ≤ m·ln(1 + ε), and a step gains at least
/// ln(1 + ε) − ε/(1 + ε). For ε ≥ 1 that is 0.278·ln(1 + ε) ≥ 0.278·δ/m, and at least 0.193: from δ₀ on no more than
/// m/0.278·ln(δ₀/0.193) + 1 steps. For ε < 1 it is at least ε²/8, so halving ε costs at most 32m/ε steps, and reaching
/// μ at most 64m/μ in all. δ₀ is m·ln n for equal weights; for Algorithm 3, twice 2d·ln d of its volume and m·ln 2d.
fn bounds(counters: &mut Counters, options: &EllipsoidOptions<'_>, dim: usize, n: u64) {
    let (d, m) = (dim as f64, dim as f64 + 1.0);
    let start = match options.method {
        EllipsoidMethod::ThesisKhachiyan => m * (n as f64).ln(),
        EllipsoidMethod::ThesisCoreSet => 4.0 * d * d.ln() + m * (2.0 * d).ln(),
        _ => return,
    };
    let mu = d * (2.0 * options.epsilon / d).exp_m1() / m;
    let steps = m / 0.278 * (start / 0.193).max(1.0).ln() + 1.0 + 64.0 * m / mu;
    // Larger numbers than any count are that in JSON, too.
    let steps = steps.ceil().min(1e15) as u64;
    counters.others.insert("iteration-bound".into(), steps);
    if options.method == EllipsoidMethod::ThesisCoreSet {
        counters.others.insert("core-set-bound".into(), steps + 2 * dim as u64);
    }
}
