//! Rounds of a working set and a pass, until the gap is proved.

use std::collections::BTreeSet;

use taut_certify::{Kernel, KernelBall, KernelBallCertificate, PassBounds, Solution, Stop, Trace};
use taut_points::{InputError, PointSource, PointsHash, ReadError};

use super::distance_bounds::{DistanceBounds, PreviousMultipliers};
use super::features::Features;
use super::first::{First, first_pass};
use super::pairs::Pairs;
use super::screen::Center;
use super::{KernelBallMethod, KernelBallOptions};
use crate::Error;

/// Rows of the sample whose mean the search starts from.
const SAMPLE_ROWS: u64 = 512;
/// One of so many rows of the sample is in the first working set of a hard ball.
const SAMPLE_STEP: usize = 4;
/// Points that a pass of a hard ball takes into the working set: this many, and twice the support, so that narrow kernels with large
/// supports take few passes.
const NEW_ROWS: usize = 256;
/// A soft ball starts from this many times the points that may be outside, and from no fewer than [`NEW_ROWS`].
const SOFT_START: f64 = 3.0;
/// Up to so many rows all are in the working set from the start.
const WHOLE_ROWS: u64 = 1024;
/// Parts of ε that the pairs, and the border of a hard ball, take up.
const SHARE_OF_PAIRS: f64 = 0.125;
const SHARE_OF_BORDER: f64 = 0.5;
/// The part of the gap of the last pass that the pairs are solved to, and the gap before the first.
const SHARE_OF_GAP: f64 = 0.01;
const START_GAP: f64 = 0.2;
/// The least tolerance of the pairs, relatively: below it rounding decides.
const TOLERANCE_MIN: f64 = 1e-14;

pub(super) fn solve(
    source: &dyn PointSource,
    options: &KernelBallOptions<'_>,
) -> Result<Solution<KernelBall>, Error> {
    let monitor = &options.monitor;
    let First { hash, is_one_point } = first_pass(source, monitor)?;
    if is_one_point && options.kernel != Kernel::Precomputed {
        let trace = Trace { method: name(), passes: 1, core_set: 1, ..Trace::default() };
        return Ok(solution(options, hash, (vec![0], vec![1.0]), [0.0; 2], trace));
    }
    let mut passes = 1;
    let mut pairs = start(source, options, &mut passes)?;
    let mut history = vec![];
    let mut gap = START_GAP;
    let mut bounds = match options.kernel {
        // Distances of the feature space keep the triangle inequality where the kernel is known to be one, and are exact enough.
        Kernel::Gaussian { .. } | Kernel::Linear => DistanceBounds::new(source.len()),
        _ => None,
    };
    loop {
        // While many points are outside, more digits of the multipliers would be lost with the next of them.
        let least = (SHARE_OF_PAIRS * options.epsilon).max(TOLERANCE_MIN);
        let tolerance = least.max(SHARE_OF_GAP * gap);
        let before = PreviousMultipliers::of(&pairs);
        let border =
            pairs.maximize(tolerance, tolerance == least, monitor).map_err(ReadError::from)?;
        let spread = pairs.spread();
        let center = center_of(&pairs, spread);
        if let Some(bounds) = &mut bounds {
            bounds.move_center(before.displacement(&pairs));
            for (&id, a) in pairs.features.ids.iter().zip(&pairs.mean) {
                bounds.set(id, a - spread);
            }
        }
        let mut level = match options.nu {
            // Points this far beyond the support are as good as inside.
            None => spread * (1.0 + SHARE_OF_BORDER * options.epsilon),
            Some(_) => (border - spread).max(0.0),
        };
        passes += 1;
        monitor.pass(passes, source.len());
        let keep = pairs.features.len() + NEW_ROWS + 2 * pairs.support().len();
        let found = center.pass(source, level, keep, bounds.as_mut(), monitor)?;
        let upper = match options.nu {
            None => found.largest,
            Some(nu) => {
                let most = nu * source.len() as f64;
                let mut excess = found.excess;
                // Of all R² that of the first point that may not be outside has the least objective for this center.
                if let Some(first) = found.far.get(most as usize)
                    && found.far.len() < keep
                {
                    level = first.reach2;
                    let beyond = found.far[..most as usize].iter();
                    excess = beyond.map(|far| far.reach2 - level).sum();
                }
                level + excess / most
            }
        };
        history.push(PassBounds { lower: spread, upper, working_set: pairs.features.len() as u64 });
        gap = (upper / spread - 1.0).min(gap);
        let is_done = upper <= spread * (1.0 + SHARE_OF_BORDER * options.epsilon);
        let known: BTreeSet<u64> = pairs.features.ids.iter().copied().collect();
        let fresh: Vec<u64> =
            found.far.iter().map(|far| far.id).filter(|id| !known.contains(id)).collect();
        let stop = match () {
            () if is_done => Stop::Converged,
            () if passes >= options.max_passes => Stop::PassBudget,
            () if fresh.is_empty() && tolerance > least => {
                gap = 0.0;
                continue;
            }
            // All points above the level are in the working set: more digits are not to be had.
            () if fresh.is_empty() => Stop::Rounding,
            () => {
                let new = match options.nu {
                    None => NEW_ROWS.max(2 * pairs.support().len()),
                    Some(_) => NEW_ROWS.max(fresh.len() / 2),
                };
                let rows = fresh.into_iter().take(new).collect();
                let features = Features::read(options.kernel, source, rows)?;
                pairs = pairs.replace(features, options.nu.is_some());
                continue;
            }
        };
        let trace = Trace {
            method: name(),
            stop,
            passes,
            iterations: pairs.steps,
            core_set: pairs.features.len() as u64,
            history,
            ..Trace::default()
        };
        let squared_radius = if options.nu.is_none() { upper } else { level };
        let places = pairs.support();
        let support = places.iter().map(|&i| pairs.features.ids[i]).collect();
        let lambda = places.iter().map(|&i| pairs.lambda[i]).collect();
        let objective = [upper, spread, found.own];
        let is_in_range = spread > f64::MIN_POSITIVE / f64::EPSILON && upper.is_finite();
        if !(is_in_range || upper == 0.0 && options.kernel == Kernel::Precomputed) {
            return Err(out_of_range(options.kernel));
        }
        return Ok(finish(
            source,
            options,
            hash,
            (support, lambda),
            squared_radius,
            objective,
            trace,
        ));
    }
}

/// The error where the radius is no normal number, or only by mistake.
pub(super) fn out_of_range(kernel: Kernel) -> Error {
    match kernel {
        Kernel::Precomputed => {
            let (name, value) = ("kernel", kernel.name().to_owned());
            let expected =
                "a symmetric positive semidefinite matrix with distances that are normal numbers";
            Error::Input(InputError::Option { name, value, expected })
        }
        _ => Error::Overflow,
    }
}

fn name() -> String {
    KernelBallMethod::WorkingSet.name().to_owned()
}

/// The center that the multipliers of a working set mean.
fn center_of(pairs: &Pairs, spread: f64) -> Center {
    let places = pairs.support();
    let lambda = places.iter().map(|&i| pairs.lambda[i]).collect();
    Center::new(pairs.kernel, pairs.dim, pairs.features.subset(&places, pairs.dim), lambda, spread)
}

/// The first working set: all rows where they are few; else those farthest from the mean of a sample, with some of the sample for a hard
/// ball; for a soft one as many of them have the largest multiplier as may be outside. For a hard ball of a kernel without such a mean it
/// is the sample.
fn start(
    source: &dyn PointSource,
    options: &KernelBallOptions<'_>,
    passes: &mut u64,
) -> Result<Pairs, Error> {
    let (n, dim, kernel) = (source.len(), source.dim(), options.kernel);
    let has_mean = matches!(kernel, Kernel::Gaussian { .. } | Kernel::Linear);
    let ids: Vec<u64> = if n <= WHOLE_ROWS {
        (0..n).collect()
    } else if options.nu.is_none() && !has_mean {
        sample(n, options.seed)
    } else {
        let drawn = sample(n, options.seed);
        let sampled = Features::read(kernel, source, drawn.clone())?;
        let outside = options.nu.map_or(0, |nu| (SOFT_START * nu * n as f64) as usize);
        let center = Center::rough(kernel, dim, sampled);
        *passes += 1;
        options.monitor.pass(*passes, n);
        let mut ids = center.farthest(source, outside.max(NEW_ROWS), &options.monitor)?;
        if options.nu.is_none() {
            // The farthest may all be on one side; a part of the sample tells of the others.
            let known: BTreeSet<u64> = ids.iter().copied().collect();
            ids.extend(drawn.into_iter().filter(|id| !known.contains(id)).step_by(SAMPLE_STEP));
        }
        ids
    };
    let features = Features::read(kernel, source, ids)?;
    let most = options.nu.map_or(1.0, |nu| (1.0 / (nu * n as f64)).min(1.0));
    let mut lambda = vec![0.0; features.len()];
    let mut left = 1.0f64;
    for lambda in &mut lambda {
        *lambda = left.min(most);
        left -= *lambda;
    }
    Ok(Pairs::new(kernel, dim, features, lambda, most))
}

/// Different rows, ascending, drawn from all.
fn sample(n: u64, seed: u64) -> Vec<u64> {
    let mut state = seed;
    let mut ids = BTreeSet::new();
    while (ids.len() as u64) < SAMPLE_ROWS.min(n) {
        // SplitMix64 (Steele, Lea, Flood 2014).
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ids.insert((z ^ (z >> 31)) % n);
    }
    ids.into_iter().collect()
}

/// The answer with room for rounding, so that the checker agrees.
///
/// With k multipliers in d dimensions the checker finds squared distances to within (d + 4k + 60)u of Σ λᵢρ + D ≤ 3(R² + D), and the
/// solver's own are as good; twice that is added to R², so that points of the border count as inside, and to the gap.
pub(super) fn finish(
    source: &dyn PointSource,
    options: &KernelBallOptions<'_>,
    hash: PointsHash,
    (support, lambda): (Vec<u64>, Vec<f64>),
    squared_radius: f64,
    [upper, spread, own]: [f64; 3],
    mut trace: Trace,
) -> Solution<KernelBall> {
    let relative = (source.dim() + 4 * support.len() + 60) as f64 * f64::EPSILON;
    // Kernels that are no function of a distance lose what cancels between K(x, x) and K(x, y), sizes of which are at most `own`.
    let degree = match options.kernel {
        Kernel::Polynomial { degree, .. } => f64::from(degree),
        _ => 1.0,
    };
    // Rows that are all equal have distances of 0, without an error.
    let room = match upper {
        0.0 => 0.0,
        _ => 8.0 * relative * (upper + spread + 4.0 * degree * own),
    };
    let sum: f64 = lambda.iter().sum();
    let lambda: Vec<f64> = lambda.into_iter().map(|l| l / sum).collect();
    let gap = if upper == 0.0 { 0.0 } else { (upper + 4.0 * room) / spread - 1.0 };
    if trace.stop == Stop::Converged && gap > options.epsilon {
        trace.stop = Stop::Rounding;
    }
    solution(options, hash, (support, lambda), [squared_radius + room, gap], trace)
}

fn solution(
    options: &KernelBallOptions<'_>,
    points_hash: PointsHash,
    (support, multipliers): (Vec<u64>, Vec<f64>),
    [squared_radius, gap]: [f64; 2],
    trace: Trace,
) -> Solution<KernelBall> {
    let KernelBallOptions { kernel, nu, .. } = *options;
    let answer = KernelBall { kernel, nu, support, multipliers, squared_radius };
    Solution {
        answer,
        certificate: KernelBallCertificate { gap: gap.max(0.0), points_hash },
        trace,
    }
}
