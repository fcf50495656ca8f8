//! Working sets of far points: a few passes over all points, and Newton's method on what they find.
//!
//! *Idea.* A sample gives a whitener, a pass with it the points of largest leverage: the first working set. Its ellipsoid is
//! found ([`newton`]), a pass lists the points outside, some of them join the working set, and so on until none is outside by
//! more than the wanted gap. The working set's multipliers prove a lower bound for all points at any moment.
//! Of many points in few dimensions the rounds are over the sample first, and then over the few points that a pass with
//! its ellipsoid lists, as long as that list is known to hold every point outside ([`shortlist`]).
//! *Guarantee.* The best lower bound is kept; bounds do not fall but where points leave a hard working set. One pass or two with a list; without, three to five on ordinary data and about a
//! dozen where all points lie near one ellipsoid. The points in memory are those of the working set and of the list, up to a third of
//! these twice.
//! *Trap.* The points farthest outside are often near-copies of each other, so each sector around the center may only
//! give a few: a sector is a coordinate of the image and its sign.
//! *Trap.* A point that lies very far outside gets weight at once: models are made at multipliers, and one of leverage
//! 1e16 has no digit in a model made without it.

use taut_certify::Stop;
use taut_kernels::{Center, DoubleDouble};
use taut_points::OrderBy;

use super::counters::Counters;
use super::interior::largest_first;
use super::newton::{self, Tolerance, gap};
use super::outcome::{Candidate, Outcome, Progress};
use super::point_reader::{PassResult, PointReader, Query};
use super::proof::{pass_error, triangular_spread};
use super::sample::Sample;
use super::shortlist::{self, Shortlist};
use super::whitener::Whitener;
use super::working_set::{WorkingSet, basis_max, copy_row};
use super::{EllipsoidOptions, ROUNDING};
use crate::Error;
use crate::top::Far;

/// Points are listed that are at most this far from the border, relatively: the proof measures again what rounding
/// cannot tell apart.
pub(super) const LISTED_TOLERANCE: f64 = 1e-6;
/// A point this many times d beyond gets weight before the next step.
const WEIGHTED_EXCESS_MIN: f64 = 100.0;
/// A point of the working set with no multiplier whose |y|² is below this part of d is of no use any more.
const LEVERAGE_RATIO_MIN: f64 = 0.9;

/// Where points lie on an ellipsoid up to rounding, none is useless by that measure, and each step of the interior-point
/// method costs as many products as there are points: so many times m(m + 1)/2 without a multiplier stay, the nearest. Twice
/// as many took a tenth longer, four times as many a quarter, when each round still ended with a basis.
const HARD_SPARE: usize = 1;

/// Points that together have less than this share of the multipliers may leave a hard working set, the p of largest multiplier
/// excepted.
const SMALL_SHARE: f64 = 1e-2;

/// Where at most this many points are outside an ellipsoid of the interior-point method, the next round is probably the last, and goes to the
/// wanted gap at once: that spares a pass, and exchanges between its multipliers and those of few points. Of shells of 10⁴ points in
/// thirty dimensions, rounds that always stop early take 1.19, 1.06, 1.02 and 1.05 times as long in the mean for thickness 1e-8, 1e-4, 1e-6
/// and 1e-10, and up to 1.8 times for single seeds. In twenty dimensions, within 1e-8, they take 0.93 times as long. 8 points serve nearly
/// as well.
const LAST_OUTSIDE_MAX: usize = 16;

/// The claimed gap may exceed that of a pass by this for each dimension, and is not taken to exceed it by more than this share of what is
/// wanted: of three shells in 2 and 4 dimensions that missed 1e-12 for that alone, it did so by 1e-14 to 4e-14.
const PROOF_ROUNDING: f64 = 4e-14;
const PROOF_SHARE: f64 = 0.1;

/// This many passes without a better gap show that rounding is in the way, of gaps below [`SMALL_GAP`].
const STALE_PASSES_MAX: u32 = 3;
/// Below this gap, rounding may be what keeps passes from improving it.
const SMALL_GAP: f64 = 1e-6;

/// The largest |y|²/d at which the ellipsoid of a sample's working set is near enough, as it only selects a list: over all points it is
/// about 2. Of 10⁵ × 10 normal points 1.05 takes a tenth longer and 1.5 the same time; of 1344 sets (see `shortlist::share`) lists fell short
/// for 31 with 1.002, 25 with 1.1 and 24 with 1.2.
const SAMPLE_LARGEST_RATIO: f64 = 1.2;

/// Points of the first working set, and points that may join after a pass.
fn sizes(dim: usize, n: u64) -> (usize, usize) {
    let p = basis_max(dim);
    let first = match dim {
        0..=10 => 4 * p,
        11..=20 => 2 * p,
        21..=50 => p,
        _ => 1326.max(12 * dim),
    };
    // Of many points a larger working set costs nothing beside a pass, and saves one.
    let many = if n >= 100_000 { 1000 } else { 64 };
    let later = if dim <= 50 { p.min(600) } else { 6 * dim };
    (first.max(many), later.max(64))
}

/// The ellipsoid of the points of a source that do not lie in a hyperplane.
pub(super) fn solve(
    reader: &mut PointReader<'_>,
    sample: &Sample,
    mut whitener: Whitener,
    options: &EllipsoidOptions<'_>,
) -> Result<Outcome, Error> {
    let dim = reader.dim();
    // A pass finds the gap in plain arithmetic, and what is claimed of it includes roundings.
    let rounding = (PROOF_ROUNDING * dim as f64).min(PROOF_SHARE * options.epsilon);
    let wanted = (options.epsilon - rounding).max(ROUNDING * dim as f64);
    let (first, later) = sizes(dim, reader.len());
    let mut counters = Counters::default();
    let mut progress = Progress::new(dim);
    let share = shortlist::share(dim, &sample.set, reader.len());
    let mut list = share.map(|_| Shortlist::of_sample(sample));
    let share = share.unwrap_or(0.0);
    let mut set = match list {
        Some(_) => working_set_of_sample(sample, &whitener, first.min(4 * (dim + 1) * (dim + 2))),
        None => first_working_set(reader, sample, &mut whitener, first)?,
    };
    let points_of_basis = basis_max(dim);
    let mut later = later;
    // With all points in the working set there is nothing to come.
    let whole = set.len() as u64 == reader.len();
    let first = match list {
        _ if whole => 0.6 * wanted,
        Some(_) => gap(dim, SAMPLE_LARGEST_RATIO * dim as f64),
        None => 1e-2,
    };
    let mut tolerance = Tolerance { easy: first, hard: first, basis: whole };
    let mut last = f64::INFINITY;
    // The least gap of a round, and true once an answer on fewer points has been sought.
    let (mut nearest, mut polished) = (f64::INFINITY, false);
    let (mut best, mut stale) = (f64::INFINITY, 0);
    // Of the rounds over a list.
    let (mut least, mut idle) = (f64::INFINITY, 0);
    let stop = loop {
        newton::solve(&mut set, &mut whitener, tolerance, &mut counters, reader.monitor())?;
        let center = center_of(&sample.origin, &whitener);
        let matrix = whitener.matrix();
        let doubt = 3.0 * pass_error(dim, triangular_spread(matrix, dim));
        let above = dim as f64 * (1.0 - doubt.min(LISTED_TOLERANCE));
        let query = Query { matrix, center: &center, above, keep: 4 * later };
        let (found, all) = match &mut list {
            None => (reader.pass(query)?, true),
            Some(list) => {
                let mut found = list.pass(query, &whitener, doubt);
                let mut others = list.others(&whitener, doubt);
                idle = if found.largest < least { 0 } else { idle + 1 };
                least = least.min(found.largest);
                // While points of the list are outside, nobody asks for the others, unless rounding is in the way.
                let reached = gap(dim, found.largest);
                let open = reached > wanted
                    && !(idle >= STALE_PASSES_MAX && reached < SMALL_GAP)
                    && !outside(&found, dim, &set).is_empty();
                let mut all = others < dim as f64;
                if !all && !open {
                    if reader.passes() >= options.max_passes && progress.best_gap() < f64::INFINITY
                    {
                        break Stop::PassBudget;
                    }
                    (*list, found) = Shortlist::of_pass(reader, query, &whitener, sample, share)?;
                    others = list.others(&whitener, doubt);
                    all = true;
                    (least, idle) = (f64::INFINITY, 0);
                }
                found.listed_above = found.listed_above.max(others);
                (found, all)
            }
        };
        let largest = found.largest;
        if !largest.is_finite() {
            if polished {
                break Stop::Converged;
            }
            return Err(Error::Overflow);
        }
        let mut far = outside(&found, dim, &set);
        far.truncate(4 * later);
        let size = set.len();
        if all {
            progress.note(&whitener, size, largest, wanted, || {
                candidate(&set, &whitener, center, found)
            });
        }
        let reached = gap(dim, largest);
        if progress.best_gap() <= wanted {
            if polished
                || counters.interior == 0
                || progress.support() < points_of_basis
                || reader.passes() >= options.max_passes
            {
                break Stop::Converged;
            }
            // Good enough, but with multipliers on more points than it takes.
            polished = true;
            tolerance = Tolerance { easy: 0.6 * wanted, hard: 0.6 * wanted, basis: true };
            continue;
        }
        if all && list.is_none() && reader.passes() >= options.max_passes {
            break Stop::PassBudget;
        }
        // Points that leave may be missed: only after a round that was worth it, so that the working set does not go in circles.
        let may_drop = counters.interior > 0 && reached < 0.5 * nearest;
        let added = add(&mut set, reader, &sample.origin, &whitener, &far, later, may_drop)?;
        nearest = nearest.min(reached);
        if all {
            stale = if progress.best_gap() < best { 0 } else { stale + 1 };
            best = progress.best_gap();
        }
        // Rounds of a working set may pass without a better gap as long as that is large.
        if added == 0 && tolerance == Tolerance::NONE
            || stale == STALE_PASSES_MAX && best < SMALL_GAP
        {
            break Stop::Rounding;
        }
        // What is outside is in the working set already: only a sharper solution of the working set can help.
        // Points that join now move the ellipsoid by a part of what is reached: a tenth of it is near enough for an interior point,
        // and less the first time, when nobody knows yet how thin the points lie.
        let part = if counters.interior == 0 { 1e-2 } else { 1e-1 };
        let hard = (part * reached).max(0.6 * wanted);
        let easy = if 1e-2 * reached < 1e-3 && counters.interior == 0 {
            0.6 * wanted
        } else {
            (1e-2 * reached).max(0.6 * wanted)
        };
        let basis = hard <= 0.6 * wanted;
        // Such a round asks for no basis by itself: the one after it does, from multipliers that are sharp.
        let is_last = all && counters.interior > 0 && far.len() <= LAST_OUTSIDE_MAX;
        let (easy, hard) = if is_last { (0.6 * wanted, 0.6 * wanted) } else { (easy, hard) };
        let was_sharp = tolerance.easy.max(tolerance.hard) <= 0.6 * wanted;
        tolerance = match added {
            0 if was_sharp && tolerance.basis => Tolerance::NONE,
            0 => Tolerance { easy: 0.6 * wanted, hard: 0.6 * wanted, basis: true },
            _ => Tolerance { easy, hard, basis },
        };
        if reached > last / 3.0 {
            later *= 2;
        }
        last = reached;
        if largest > WEIGHTED_EXCESS_MIN * dim as f64 {
            jump(&mut set, added);
        }
    };
    let core_set = set.len();
    Ok(progress.into_outcome(stop, counters, core_set))
}

/// Equal weights on points of a sample: those of large leverage, what is extreme, and an affine basis unless these hold one.
fn working_set_of_sample(sample: &Sample, whitener: &Whitener, size: usize) -> WorkingSet {
    let images = whitener.apply(&sample.set);
    let mut order: Vec<usize> = (0..sample.set.len()).collect();
    let farther = |&a: &usize, &b: &usize| images.leverages[b].total_cmp(&images.leverages[a]);
    let size = size.min(order.len());
    if size < order.len() {
        order.select_nth_unstable_by(size, farther);
        order.truncate(size);
        order.sort_unstable();
    }
    let spread = sample.spread(&images.blocks, &order);
    let mut is_chosen = vec![false; sample.set.len()];
    order.iter().for_each(|&i| is_chosen[i] = true);
    order.extend(spread.into_iter().filter(|&i| !std::mem::replace(&mut is_chosen[i], true)));
    let mut set = sample.set.select(&order);
    set.weights_mut().fill(1.0);
    set.normalize();
    set
}

/// Equal weights on points of large leverage, on what is extreme in the sample, and on an affine basis unless that holds one.
fn first_working_set(
    reader: &mut PointReader<'_>,
    sample: &Sample,
    whitener: &mut Whitener,
    size: usize,
) -> Result<WorkingSet, Error> {
    let dim = reader.dim();
    let n = reader.len();
    if n == sample.set.len() as u64 && n <= 2 * size as u64 {
        return Ok(sample.set.clone());
    }
    let images = whitener.apply(&sample.set);
    let mut leverages = images.leverages.clone();
    leverages.order_by(&|a, b| b.total_cmp(a));
    // Few of the listed points should be thrown away again, and enough should be listed.
    let rank = 2 * size as u64 * leverages.len() as u64 / n + 10;
    let above = leverages.get(rank as usize).copied().unwrap_or(0.0);
    let center = center_of(&sample.origin, whitener);
    let query = Query { matrix: whitener.matrix(), center: &center, above, keep: size };
    let found = reader.pass(query)?;
    let mut set = WorkingSet::new(dim);
    let ids: Vec<u64> = found.far.iter().map(|far| far.id).collect();
    let rows = reader.rows_from(&sample.origin, &ids)?;
    for (&id, row) in ids.iter().zip(rows.chunks_exact(dim)) {
        set.push(id, row, 1.0);
    }
    let mut row = vec![0.0; dim];
    for i in sample.spread(&images.blocks, &[]) {
        sample.set.copy_row(i, &mut row);
        set.push(sample.set.ids()[i], &row, 1.0);
    }
    set.normalize();
    Ok(set)
}

/// The center of a whitener in the coordinates of the source; in two terms where rounding it to one could be seen.
pub(super) fn center_of(origin: &[f64], whitener: &Whitener) -> Center {
    /// A change of a leverage below this shows nothing: it is far below the rounding of a leverage.
    const LEVERAGE_CHANGE_MIN: f64 = 1e-16;
    let terms: Vec<DoubleDouble> =
        origin.iter().zip(whitener.center()).map(|(&o, c)| DoubleDouble::sum(o, c)).collect();
    let mut center = Center {
        high: terms.iter().map(|term| term.high).collect(),
        low: terms.iter().map(|term| term.low).collect(),
    };
    let rows = whitener.matrix().chunks_exact(origin.len());
    let moved = |row: &[f64]| row.iter().zip(&center.low).map(|(m, c)| (m * c).abs()).sum::<f64>();
    if rows.map(moved).fold(0.0, f64::max) < LEVERAGE_CHANGE_MIN {
        center.low.clear();
    }
    center
}

pub(super) fn candidate(
    set: &WorkingSet,
    whitener: &Whitener,
    center: Center,
    found: PassResult,
) -> Candidate {
    let weighted = set.ids().iter().zip(set.weights()).filter(|(_, u)| **u > 0.0);
    let mut pairs: Vec<(u64, f64)> = weighted.map(|(&id, &u)| (id, u)).collect();
    pairs.order_by_key(|pair| pair.0);
    let (support, multipliers) = pairs.into_iter().unzip();
    Candidate { support, multipliers, matrix: whitener.matrix().to_vec(), center, found }
}

/// The points outside that are not in the working set.
fn outside(found: &PassResult, dim: usize, set: &WorkingSet) -> Vec<Far> {
    let beyond = |far: &&Far| far.reach2 > dim as f64 * (1.0 + 1e-14) && !set.contains(far.id);
    found.far.iter().filter(beyond).copied().collect()
}

/// Takes some of the far points to the working set, and useless points out of it, more of them if the working set is `hard`; says how
/// many were taken.
fn add(
    set: &mut WorkingSet,
    reader: &PointReader<'_>,
    origin: &[f64],
    whitener: &Whitener,
    far: &[Far],
    most: usize,
    hard: bool,
) -> Result<usize, Error> {
    let dim = set.dim();
    if set.len() > 4 * most || hard {
        let leverages = whitener.apply(set).leverages;
        let weights = set.weights().to_vec();
        let mut least = LEVERAGE_RATIO_MIN * dim as f64;
        let p = basis_max(dim);
        let mut used: Vec<bool> = weights.iter().map(|u| *u > 0.0).collect();
        if hard {
            let mut kept = 0.0;
            for (rank, i) in largest_first(&weights).into_iter().enumerate() {
                used[i] &= rank < p || kept < 1.0 - SMALL_SHARE;
                kept += weights[i];
            }
            let spare = HARD_SPARE * p;
            let free = leverages.iter().zip(&used).filter(|(_, used)| !**used);
            let mut free: Vec<f64> = free.map(|(leverage, _)| *leverage).collect();
            if free.len() > spare {
                let (_, bound, _) = free.select_nth_unstable_by(spare, |a, b| b.total_cmp(a));
                least = least.max(*bound);
            }
        }
        set.retain(|i| used[i] || leverages[i] > least);
        set.normalize();
    }
    let ids: Vec<u64> = far.iter().map(|far| far.id).collect();
    let rows = reader.rows_from(origin, &ids)?;
    let mut arrivals = WorkingSet::new(dim);
    for (&id, row) in ids.iter().zip(rows.chunks_exact(dim)) {
        arrivals.push(id, row, 0.0);
    }
    let images = whitener.apply(&arrivals).blocks;
    let each = most.div_ceil(dim);
    let mut taken = vec![0; 2 * dim];
    let mut image = vec![0.0; dim];
    let mut added = 0;
    for (i, (&id, row)) in ids.iter().zip(rows.chunks_exact(dim)).enumerate() {
        copy_row(&images, dim, i, &mut image);
        let sector = &mut taken[sector(&image)];
        if *sector < each && added < most {
            *sector += 1;
            added += 1;
            set.push(id, row, 0.0);
        }
    }
    Ok(added)
}

/// The coordinate of largest absolute value, and its sign.
fn sector(image: &[f64]) -> usize {
    let largest = (0..image.len()).max_by(|&a, &b| image[a].abs().total_cmp(&image[b].abs()));
    largest.map_or(0, |j| 2 * j + usize::from(image[j] < 0.0))
}

/// Half of the weight goes to the points that came last.
fn jump(set: &mut WorkingSet, added: usize) {
    let k = set.len();
    for (i, u) in set.weights_mut().iter_mut().enumerate() {
        *u = if i + added < k { *u / 2.0 } else { 0.5 / added as f64 };
    }
    set.normalize();
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, Points, generate};

    use super::basis_max;
    use crate::{EllipsoidOptions, ellipsoid};

    /// Without a round that goes all the way once few points are outside, these take 27 passes, with it 23.
    #[test]
    fn hard_working_sets_spare_a_pass_at_the_end() {
        let options = EllipsoidOptions { epsilon: 1e-12, ..Default::default() };
        let mut passes = 0;
        for seed in 1..=3 {
            let shell = Distribution::Shell { thickness: 1e-8 };
            let rows: Vec<f64> = generate(shell, 2000, 20, seed).unwrap();
            let points = Points::new(&rows, 20).unwrap();
            let found = ellipsoid(&points, &options).unwrap();
            let verdict = found.check(&points).unwrap();
            assert!(verdict.gap <= 1e-12, "{}", verdict.gap);
            assert!(found.certificate.support.len() <= basis_max(20));
            passes += found.trace.passes;
        }
        assert!(passes <= 25, "{passes}");
    }
}
