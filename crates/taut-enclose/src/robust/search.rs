//! Which rows to keep: C-steps from deterministic starts, on samples first where points are many.
//!
//! *Problem.* Of n points find the h whose covariance has the least determinant, or that fit the smallest ellipsoid.
//! *Idea.* Two kinds of starts, as they fail on different data: six rankings ([`starts`](super::starts)), and
//! [`SIMPLEX_COUNT`] simplices of d + 1 points where d ≤ [`ELEMENTS_DIM_MAX`]. Simplices are tried by two C-steps on few
//! points, and the best of them go on with the rankings, to the end, on at most [`SAMPLE_SIZE`] points (twice that if these
//! are all). The best of those are tried on all points, and the best of them go on to the end. For the determinant the
//! [`border`](super::border) of the rows kept is then searched for a better choice.
//! *Guarantee.* The rows found are the h nearest in their own metric: no C-step leads on from them. That no other h
//! rows do better is not proved. Everything is drawn by the hash of a point's bits, so that what is found depends on the
//! points and not on their order, but where distances are equal.
//! *Reference.* Rousseeuw, Van Driessen, Technometrics 41, 1999, for simplices and nesting; Hubert, Rousseeuw,
//! Verdonck, J. Computational and Graphical Statistics 21, 2012, for the rankings.

use taut_points::parallel::IntoParallel;
use taut_points::{Monitor, OrderBy, Points};

use super::border::Border;
use super::concentrate::{
    ConcentrationResult, Criterion, Raw, concentrate, estimate, from_ranking,
};
use super::estimate::{Estimate, RankedEstimate};
use super::flat::Flat;
use super::starts::{START_COUNT, Standardized};
use crate::Error;
use crate::ellipsoid::point_reader::PointReader;

/// Rankings look at this many points; with more than twice as many, a sample of this size stands for them.
const SAMPLE_SIZE: usize = 2000;
/// Points that simplices are tried on; with more than twice as many, a sample of this size stands for them.
const SMALL_SAMPLE: usize = 300;
/// This many simplices are tried, as many as FastMCD does.
const SIMPLEX_COUNT: u64 = 500;
/// Dimension beyond which none is tried: d + 1 points without an outlier among them are too rare then.
const ELEMENTS_DIM_MAX: usize = 20;
/// Simplices that go on.
const BEST_ELEMENTS: usize = 10;
/// At most this many candidates are tried on all points.
const CANDIDATES_MAX: usize = 6;
/// At most this many of them go on to the end.
const FINALISTS_MAX: usize = 4;
/// The best of them is given at most this many perturbations at the border.
const PERTURBATIONS_MAX: u64 = 40;

/// Finds the h rows, or a hyperplane that holds so many.
pub(super) fn solve(
    criterion: Criterion,
    data: &mut PointReader<'_>,
    h: usize,
    steps: &mut u64,
) -> Result<ConcentrationResult, Error> {
    let (n, dim) = (data.len() as usize, data.dim());
    let size = SAMPLE_SIZE.max(20 * dim);
    let ids = by_hash(data, if n > 2 * size { size } else { n })?;
    let sample = data.rows(&ids)?;
    let part = (h * ids.len()).div_ceil(n);
    let ends = ends_on_sample(criterion, &sample, dim, part)?;
    let mut candidates: Vec<Raw> = vec![];
    for (found, taken) in ends {
        *steps += taken;
        match found {
            ConcentrationResult::Full(raw)
                if candidates.iter().all(|other| other.kept != raw.kept) =>
            {
                candidates.push(raw);
            }
            ConcentrationResult::Full(_) => {}
            ConcentrationResult::Flat(flat) if holds(&flat, data, h)? => {
                return Ok(ConcentrationResult::Flat(flat));
            }
            ConcentrationResult::Flat(_) => {}
        }
    }
    if candidates.is_empty() {
        // Every start ended in a hyperplane of the sample that does not hold h points.
        let all = vec![true; n];
        let metric = Estimate::rough(data, &all)?;
        return match estimate(criterion, data, &metric, &all)? {
            Ok(start) => concentrate(criterion, data, &start, h, usize::MAX, steps),
            Err(flat) => Ok(ConcentrationResult::Flat(flat)),
        };
    }
    best(&mut candidates, CANDIDATES_MAX);
    for (limit, left) in [(2, FINALISTS_MAX), (usize::MAX, FINALISTS_MAX)] {
        for candidate in &mut candidates {
            match concentrate(criterion, data, &candidate.estimate, h, limit, steps)? {
                ConcentrationResult::Full(raw) => *candidate = raw,
                flat => return Ok(flat),
            }
        }
        best(&mut candidates, left);
        // Most starts of one basin end in the same rows.
        candidates.dedup_by(|a, b| a.kept == b.kept);
    }
    if let Criterion::Determinant = criterion {
        for perturbations in [0, PERTURBATIONS_MAX] {
            for candidate in &mut candidates {
                if let Some(flat) = polish(data, candidate, h, perturbations, steps)? {
                    return Ok(ConcentrationResult::Flat(flat));
                }
            }
            best(&mut candidates, 1);
        }
    }
    Ok(ConcentrationResult::Full(candidates.swap_remove(0)))
}

/// Goes down at the border and by C-steps on all rows, by turns, until neither leads on; a hyperplane, if that ends in
/// one.
fn polish(
    data: &mut PointReader<'_>,
    raw: &mut Raw,
    h: usize,
    mut perturbations: u64,
    steps: &mut u64,
) -> Result<Option<Flat>, Error> {
    while let Some(border) = Border::of(data, raw)? {
        let Some(kept) = border.search(raw, perturbations) else { break };
        let start = match estimate(Criterion::Determinant, data, &raw.estimate, &kept)? {
            Ok(start) => start,
            Err(flat) => return Ok(Some(flat)),
        };
        let next = match concentrate(Criterion::Determinant, data, &start, h, usize::MAX, steps)? {
            ConcentrationResult::Full(next) => next,
            ConcentrationResult::Flat(flat) => return Ok(Some(flat)),
        };
        // What rounding alone gained could be lost and gained endlessly.
        let leads_on = next.estimate.log_det() < raw.estimate.log_det();
        if !leads_on {
            break;
        }
        (*raw, perturbations) = (next, 0);
    }
    Ok(None)
}

/// Keeps the candidates with the least determinants, in that order; of equal ones, the first.
fn best(candidates: &mut Vec<Raw>, count: usize) {
    candidates.order_by(&|a, b| a.estimate.log_det().total_cmp(&b.estimate.log_det()));
    candidates.truncate(count);
}

/// Where C-steps on a sample end, from all rankings and the best simplices, and how many steps each took.
fn ends_on_sample(
    criterion: Criterion,
    sample: &[f64],
    dim: usize,
    part: usize,
) -> Result<Vec<(ConcentrationResult, u64)>, Error> {
    let simplices = best_simplices(sample, dim, part)?;
    let points = Standardized::of(sample, dim);
    let silent = Monitor::silent();
    (0..START_COUNT + simplices.len())
        .into_par_iter()
        .map(|which| {
            let mut steps = 0;
            let end = match which.checked_sub(START_COUNT) {
                None => {
                    let ranking = points.distances(which);
                    from_ranking(criterion, sample, dim, &ranking, part, &mut steps)?
                }
                Some(simplex) => {
                    let view = Points::new(sample, dim).expect("rows of the dimension");
                    let mut data = PointReader::new(&view, &silent)?;
                    let start = &simplices[simplex];
                    concentrate(criterion, &mut data, start, part, usize::MAX, &mut steps)?
                }
            };
            Ok((end, steps))
        })
        .collect()
}

/// The metrics with the least determinants after two C-steps from simplices of d + 1 of the first points.
///
/// A simplex in a hyperplane is passed over: rankings find what lies flat.
fn best_simplices(sample: &[f64], dim: usize, part: usize) -> Result<Vec<Estimate>, Error> {
    let rows = sample.len() / dim;
    let few = if rows > 2 * SMALL_SAMPLE { SMALL_SAMPLE.max(5 * dim).min(rows) } else { rows };
    if few <= dim + 1 || dim > ELEMENTS_DIM_MAX {
        return Ok(vec![]);
    }
    let part = (part * few).div_ceil(rows);
    let values = &sample[..few * dim];
    let view = Points::new(values, dim).expect("rows of the dimension");
    let silent = Monitor::silent();
    let ends: Vec<Option<Estimate>> = (0..SIMPLEX_COUNT)
        .into_par_iter()
        .map(|which| {
            let mut data = PointReader::new(&view, &silent)?;
            let kept = simplex(which, few, dim);
            let metric = Estimate::rough(&mut data, &kept)?;
            let RankedEstimate::Full(mut here) = metric.of_rows(&mut data, &kept)? else {
                return Ok(None);
            };
            for _ in 0..2 {
                let kept = super::starts::nearest(&here.distances(&mut data)?, part);
                let RankedEstimate::Full(next) = here.of_rows(&mut data, &kept)? else {
                    return Ok(None);
                };
                here = next;
            }
            Ok(Some(here))
        })
        .collect::<Result<_, Error>>()?;
    let mut ends: Vec<Estimate> = ends.into_iter().flatten().collect();
    ends.order_by(&|a, b| a.log_det().total_cmp(&b.log_det()));
    ends.dedup_by(|a, b| a.log_det() == b.log_det());
    ends.truncate(BEST_ELEMENTS);
    Ok(ends)
}

/// Marks d + 1 of n rows, by the numbers of one generator for each simplex.
fn simplex(which: u64, n: usize, dim: usize) -> Vec<bool> {
    let mut marks = vec![false; n];
    let (mut state, mut marked) = (which << 32, 0);
    while marked <= dim {
        state += 1;
        let row = (mix(state.wrapping_mul(GOLDEN)) % n as u64) as usize;
        marked += usize::from(!marks[row]);
        marks[row] = true;
    }
    marks
}

/// Tests whether at least h rows lie on a subspace.
fn holds(flat: &Flat, data: &mut PointReader<'_>, h: usize) -> Result<bool, Error> {
    Ok(flat.rows_on(data)?.0.len() >= h)
}

/// The rows whose bits hash lowest, in that order.
fn by_hash(data: &mut PointReader<'_>, size: usize) -> Result<Vec<u64>, Error> {
    let dim = data.dim();
    let blocks = data.visit(|first, rows| {
        let hashes = rows.chunks_exact(dim).map(hash);
        let mut block: Vec<(u64, u64)> = hashes.zip(first..).collect();
        keep_least(&mut block, size);
        block
    })?;
    let mut all = blocks.concat();
    keep_least(&mut all, size);
    all.sort_unstable();
    Ok(all.into_iter().map(|(_, id)| id).collect())
}

fn keep_least(list: &mut Vec<(u64, u64)>, size: usize) {
    if list.len() > size {
        list.select_nth_unstable(size);
        list.truncate(size);
    }
}

/// 2⁶⁴ over the golden ratio.
pub(super) const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

/// The finalizer of SplitMix64 (Steele, Lea, Flood 2014).
pub(super) fn mix(h: u64) -> u64 {
    let h = (h ^ (h >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let h = (h ^ (h >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    h ^ (h >> 31)
}

/// SplitMix64 over the bits of the coordinates; adding 0 makes −0 equal to 0.
fn hash(row: &[f64]) -> u64 {
    row.iter().fold(GOLDEN, |h, &x| mix(h ^ (x + 0.0).to_bits()).wrapping_add(GOLDEN))
}
