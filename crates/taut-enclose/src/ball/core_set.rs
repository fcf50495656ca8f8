//! Minimum enclosing ball by batches of far points and an exact active set: the default method.
//!
//! *Problem.* Items (points, or balls with center cᵢ and radius rᵢ): find c that minimizes R(c) = maxᵢ |c − cᵢ| + rᵢ.
//! *Idea.* Each pass over all items brings the m that reach farthest beyond the current ball to a working set; the
//! exact ball of the working set ([`super::active_set`]) is the next ball. With m of 16 to 128 rather than 1, three
//! to five passes are enough on ordinary data, and the last of them finds nothing outside: exact costs no more than ε.
//! *Balls.* For fixed R, h(R) = min over c of maxᵢ |c − cᵢ|² + 2Rrᵢ − rᵢ² is a problem of points. With multipliers λ
//! and r̄ = Σ λᵢrᵢ, R* ≥ r̄ + √(Σ λᵢ(|cᵢ − c|² − (rᵢ − r̄)²)): this is both the Newton step in R, which never overshoots
//! because h is convex, and the certificate. Rounding can carry a step beyond R*. Its multipliers may prove less than
//! the previous ones; then it is undone. Origin and radii are taken relative to the largest ball, without which a ball
//! that touches it from inside costs half the digits.
//! *Guarantee.* The lower bound grows with every pass that adds an item, so the method ends; it stops at
//! R ≤ (1 + ε)·r, or when no item violates the ball beyond rounding.
//! *Trap.* Thousands of near-copies of one far point fill a batch and teach nothing: when few of a batch enter the
//! support, the next pass takes at most two per face of the cube around the center. Doing so always would cost twice
//! the passes on cube vertices. When most of a batch enters, the support is large, and the batch is doubled.
//! *Hard input.* Near a sphere an active set takes thousands of steps. When it drops too many items within one pass, an
//! interior-point method looks for a better support ([`super::interior_rounds`]), once, and for points only.
//! *First batch.* Of far points in many dimensions nearly all belong to the support: they come to it at once ([`ActiveSet::of_all`]).
//! *Few dimensions.* The first pass starts from the ball of a sample and lists the points far from its center; the rounds
//! are over that list as long as no other point can be outside ([`super::shortlist`]). Then one pass is all.
//! *Many dimensions.* The ball of a sample has its center too far off for that, and saves no pass. But the last centers are near to one
//! another, and the pass that confirms the ball reads few rows: of the others it is known that they are inside
//! (`item_reader::row_bounds`).

use taut_certify::{Items, PassBounds, Stop};
use taut_kernels::{Center, relative_error};
use taut_points::{Cancelled, Monitor, ReadError};

use super::active_set::{ActiveSet, VIOLATION_TOLERANCE};
use super::outcome::Outcome;
use super::working_set::WorkingSet;
use super::{BallOptions, interior_rounds, shortlist};
use crate::Error;
use crate::item_reader::{ItemReader, PassResult, Query};
use crate::top::Far;

/// Largest batch that doubling reaches.
const BATCH_MAX: usize = 1024;
/// A gap that ε = 0 is content with: what the tolerance leaves open, with room for sums over many coordinates.
pub(super) const ROUNDING: f64 = 10.0 * VIOLATION_TOLERANCE;
/// The active set gives way to an interior-point method when half the dimension, but at least so many items, leave the
/// support within one pass. Measured: points on a sphere and vertices of a cube, d = 100 to 1500, come to a third of the
/// dimension; a sphere with noise of 1e-8 comes to one and a half times the dimension when the support is first full.
const DELETIONS_LEAST: usize = 64;
/// Smallest batch of which the share that entered the support says anything.
const TELLING_BATCH: usize = 16;

/// Points of the first batch come to the support at once where there are at least so many dimensions for each. Most stay: of the 148 points
/// of the last working set of 10⁴ × 1000 normal points 125 are in the support.
const DIMENSIONS_PER_POINT_MIN: usize = 2;

/// Far items per pass: where passes are cheap beside the work on the set they bring, fewer.
fn batch_for(dim: usize) -> usize {
    match dim {
        ..=16 => 16,
        17..=300 => 64,
        _ => 128,
    }
}

pub(super) fn solve(
    reader: &mut ItemReader<'_>,
    options: &BallOptions<'_>,
) -> Result<Outcome, Error> {
    let patience = (reader.dim() / 2).max(DELETIONS_LEAST) as u32;
    solve_with_patience(reader, options, patience)
}

/// The same for an active set that gives way after `patience` deletions within one pass.
fn solve_with_patience(
    reader: &mut ItemReader<'_>,
    options: &BallOptions<'_>,
    patience: u32,
) -> Result<Outcome, Error> {
    let mut batch = options.batch.unwrap_or_else(|| batch_for(reader.dim()));
    let (middle, found, mut list) = shortlist::first(reader, batch.saturating_add(64), options)?;
    if found.farthest.reach2 == 0.0 {
        return Outcome::single(reader, found.farthest.id);
    }
    let mut set = empty_set(reader, middle)?;
    let mut outcome = Outcome::new();
    let upper = found.farthest.reach2.sqrt();
    outcome.bounds(PassBounds { lower: 0.0, upper, working_set: 0 });
    // Two at least, as one alone proves no lower bound.
    add(&mut set, reader, found.far.iter().map(|far| far.id), batch.max(2))?;
    let has_many_dimensions = DIMENSIONS_PER_POINT_MIN * set.len() <= reader.dim();
    // A larger batch, of the caller's choice, takes steps of which each asks whether to go on.
    let comes_at_once = has_many_dimensions && set.len() <= BATCH_MAX;
    let mut active = if comes_at_once && reader.items() == Items::Points {
        ActiveSet::of_all(&set, found.farthest.reach2)
    } else {
        ActiveSet::new(&set, found.farthest.reach2)
    };
    if reader.items() == Items::Points {
        active.give_up_after(Some(patience));
    }
    let mut radius = 0.0;
    let mut last_batch = 0..set.len();
    loop {
        radius = solve_working_set(&mut active, &set, radius, reader.monitor())
            .map_err(ReadError::from)?;
        if active.gave_up() {
            let found = interior_rounds::solve(reader, &mut outcome, &set, &active, options)?;
            if let Some(found) = found {
                (set, active) = found;
                last_batch = 0..0;
            }
            active.give_up_after(None);
            radius = solve_working_set(&mut active, &set, radius, reader.monitor())
                .map_err(ReadError::from)?;
        }
        active.refine(&set);
        let entered = active.support().iter().filter(|i| last_batch.contains(i)).count();
        // No more than d + 1 can enter at all.
        let could_enter = last_batch.len().min(reader.dim() + 1);
        let telling = options.batch.is_none() && could_enter >= TELLING_BATCH;
        if telling && 2 * entered > last_batch.len() {
            batch = (2 * batch).min(BATCH_MAX);
        }
        let by_face = telling && 8 * entered < could_enter;

        let center = set.center(active.support(), active.lambda(), radius);
        let keep = batch.saturating_add(active.support().len() + 64);
        let slack = 4.0 * relative_error(reader.dim());
        let above = radius * radius * (1.0 - slack).max(0.0);
        let violating = radius * radius * (1.0 + VIOLATION_TOLERANCE);
        let by_face_above = by_face.then_some(violating);
        let query = Query { center: &center, above, keep, by_face_above };
        let new = |found: &PassResult| -> Vec<u64> {
            let new = |far: &[Far]| -> Vec<u64> {
                let violators =
                    far.iter().filter(|far| far.reach2 > violating && !set.contains(far.id));
                violators.map(|far| far.id).collect()
            };
            let by_face = new(&found.by_face);
            if by_face.is_empty() { new(&found.far) } else { by_face }
        };
        // A list tells as much as a pass where it holds all that can be outside; as long as some of it is outside,
        // nobody asks for the others.
        let listed = list.as_ref().map(|list| list.pass(query)).transpose()?;
        let told = listed.filter(|(found, all)| *all || !new(found).is_empty());
        let (found, all) = match told {
            Some(told) => told,
            None => {
                list = None;
                (reader.farthest(query)?, true)
            }
        };
        let violators = new(&found);
        if !all {
            let before = set.len();
            add(&mut set, reader, violators.into_iter(), batch)?;
            last_batch = before..set.len();
            active.widen(&set);
            continue;
        }
        let upper = found.farthest.reach2.sqrt();
        outcome.bounds(PassBounds { lower: radius, upper, working_set: set.len() as u64 });
        let gap = if upper == 0.0 { 0.0 } else { upper / radius - 1.0 };
        outcome.offer(gap, || {
            let support = active.support().iter().map(|&i| set.id(i)).collect();
            (support, active.lambda().to_vec(), center, found)
        });
        let wanted = if options.epsilon > 0.0 { options.epsilon } else { ROUNDING };
        outcome.stop = if gap <= wanted && (options.epsilon > 0.0 || violators.is_empty()) {
            Some(Stop::Converged)
        } else if violators.is_empty() {
            Some(Stop::Rounding)
        } else if reader.passes() >= options.max_passes && radius > 0.0 {
            Some(Stop::PassBudget)
        } else {
            None
        };
        if outcome.stop.is_some() {
            outcome.iterations = active.pivots;
            outcome.core_set = set.len() as u64;
            outcome.count("stalls", active.stalls);
            return Ok(outcome);
        }
        let before = set.len();
        add(&mut set, reader, violators.into_iter(), batch)?;
        last_batch = before..set.len();
        active.widen(&set);
    }
}

/// The working set before its first batch: for balls it holds the largest, which is its origin.
fn empty_set(reader: &ItemReader<'_>, middle: Center) -> Result<WorkingSet, Error> {
    let Some(largest) = reader.largest() else { return Ok(WorkingSet::new(middle.high, 0.0)) };
    let row = reader.rows(&[largest])?;
    let mut set = WorkingSet::new(row[..reader.dim()].to_vec(), row[reader.dim()]);
    set.add(&[largest], row, true);
    Ok(set)
}

fn add(
    set: &mut WorkingSet,
    reader: &ItemReader<'_>,
    ids: impl Iterator<Item = u64>,
    most: usize,
) -> Result<(), Error> {
    let ids: Vec<u64> = ids.filter(|&id| !set.contains(id)).take(most).collect();
    set.add(&ids, reader.rows(&ids)?, reader.items() == Items::Balls);
    Ok(())
}

/// The exact ball of the working set; returns its radius. `radius` is a lower bound on it, from before the last batch.
pub(super) fn solve_working_set(
    active: &mut ActiveSet,
    set: &WorkingSet,
    radius: f64,
    monitor: &Monitor<'_>,
) -> Result<f64, Cancelled> {
    let offset = set.radius_offset();
    let mut relative = (radius - offset).max(0.0);
    let proved = |active: &ActiveSet| lower_bound(set, active.support(), active.lambda()).max(0.0);
    if offset == 0.0 {
        // Nothing depends on R.
        active.maximize(set, monitor)?;
        return Ok(proved(active).max(relative));
    }
    let mut before = None;
    loop {
        active.set_radius(set, relative);
        active.maximize(set, monitor)?;
        let bound = proved(active);
        let rounding = f64::EPSILON * (relative + offset);
        if bound > relative + rounding {
            relative = bound;
            before = Some(active.clone());
            continue;
        }
        // A loss below this is rounding, and the last center is the better one.
        let lost = VIOLATION_TOLERANCE * (relative + offset);
        if bound < relative - lost
            && let Some(before) = before
        {
            active.undo_to(before);
        }
        return Ok(bound.max(relative) + offset);
    }
}

/// r̄ + √(Σ λᵢ(|cᵢ − c|² − (rᵢ − r̄)²)), relative to the radius offset, for λ over the items named.
pub(super) fn lower_bound(set: &WorkingSet, support: &[usize], lambda: &[f64]) -> f64 {
    let center = Center { high: set.combination(support, lambda), low: vec![] };
    let mean: f64 = support.iter().zip(lambda).map(|(&i, l)| l * set.radius(i)).sum();
    let inner: f64 = support
        .iter()
        .zip(lambda)
        .map(|(&i, l)| {
            let distance = set.squared_distance(i, &center).sqrt();
            let radius = set.radius(i) - mean;
            l * (distance - radius) * (distance + radius)
        })
        .sum();
    mean + inner.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;
    use proptest::test_runner::{Config, RngSeed};
    use taut_points::{Distribution, Points, generate};

    use super::super::proof::prove;
    use super::*;

    /// Radius and proved gap of an active set of this patience, and the steps of the interior-point method.
    fn found(values: &[f64], dim: usize, patience: u32) -> (f64, f64, u64) {
        let points = Points::new(values, dim).unwrap();
        let monitor = Monitor::silent();
        let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
        let mut reader = ItemReader::new(&points, Items::Points, &monitor).unwrap();
        let outcome = solve_with_patience(&mut reader, &options, patience).unwrap();
        let interior = outcome.counters.get("interior").copied().unwrap_or(0);
        let solution = prove(&mut reader, outcome, &options).unwrap();
        (solution.answer.radius, solution.certificate.gap, interior)
    }

    /// Gives way at the first deletion, and finds the ball of an active set that never does.
    fn agrees(values: &[f64], dim: usize) -> bool {
        let (hasty, never) = (found(values, dim, 0), found(values, dim, u32::MAX));
        assert_eq!(never.2, 0);
        assert!(hasty.1 <= 1e-12, "{hasty:?} for {never:?}");
        assert!((hasty.0 - never.0).abs() <= 1e-12 * never.0, "{hasty:?} for {never:?}");
        hasty.2 > 0
    }

    #[test]
    fn giving_way_at_once_gives_the_same_ball() {
        let distributions = [
            Distribution::Normal,
            Distribution::CubeVertices,
            Distribution::Sphere,
            Distribution::Shell { thickness: 1e-8 },
            Distribution::Shell { thickness: 1e-14 },
            Distribution::Clusters { count: 7, spread: 0.0 },
            Distribution::Clusters { count: 7, spread: 1e-12 },
            Distribution::Poisson,
        ];
        let mut given_way = [0; 8];
        for (k, &distribution) in distributions.iter().enumerate() {
            for (n, dim) in [(1, 3), (40, 1), (60, 2), (300, 3), (300, 12), (400, 40)] {
                for seed in 8000..8004 {
                    let values: Vec<f64> = generate(distribution, n, dim, seed).unwrap();
                    given_way[k] += u32::from(agrees(&values, dim));
                }
            }
        }
        assert!(given_way.iter().filter(|&&times| times > 0).count() >= 6, "{given_way:?}");
    }

    /// A set whose items all come to the support at once has the ball of one whose items enter one by one.
    #[test]
    fn supports_of_all_items_have_the_same_ball() {
        let monitor = Monitor::silent();
        let mut left_out = 0;
        let distributions = [
            Distribution::Normal,
            Distribution::CubeVertices,
            Distribution::Shell { thickness: 1e-8 },
            Distribution::Clusters { count: 5, spread: 0.0 },
            Distribution::Clusters { count: 5, spread: 1e-12 },
            Distribution::Poisson,
        ];
        for (k, &distribution) in distributions.iter().enumerate() {
            for (n, dim) in [(1, 2), (2, 4), (9, 18), (24, 48), (130, 260)] {
                let rows: Vec<f64> = generate(distribution, n, dim, 60 + k as u64).unwrap();
                let mut set = WorkingSet::new(vec![0.0; dim], 0.0);
                set.add(&(0..n as u64).collect::<Vec<_>>(), rows, false);
                let reach2 = (0..n).map(|i| set.norm2(i)).fold(0.0, f64::max);
                let radius = |mut active: ActiveSet| {
                    let found = solve_working_set(&mut active, &set, 0.0, &monitor).unwrap();
                    (found, active.support().len())
                };
                let (one_by_one, size) = radius(ActiveSet::new(&set, reach2));
                let (at_once, _) = radius(ActiveSet::of_all(&set, reach2));
                let error = (at_once - one_by_one).abs();
                let rounding = 1e-12 * one_by_one + 8.0 * f64::EPSILON * reach2.sqrt();
                assert!(error <= rounding, "{distribution:?}: {at_once} {one_by_one}");
                left_out += usize::from(1 < size && size < n);
            }
        }
        assert!(left_out >= 8, "{left_out}");
    }

    #[test]
    fn giving_way_at_once_does_no_harm_on_lines_and_at_the_ends_of_the_range() {
        for scale in [1e300, 1.0, 1e-300] {
            for seed in 8100..8110 {
                let draw =
                    |distribution| -> Vec<f64> { generate(distribution, 50, 4, seed).unwrap() };
                let scaled = |values: Vec<f64>| -> Vec<f64> {
                    values.into_iter().map(|x| x * scale).collect()
                };
                agrees(&scaled(draw(Distribution::Normal)), 4);
                agrees(&scaled(draw(Distribution::Shell { thickness: 1e-9 })), 4);
                let line = draw(Distribution::Normal).chunks(4).flat_map(|p| [p[0]; 4]).collect();
                agrees(&scaled(line), 4);
            }
        }
    }

    proptest! {
        #![proptest_config(Config {
            cases: 300,
            rng_seed: RngSeed::Fixed(81),
            failure_persistence: None,
            ..Config::default()
        })]

        /// Small integers bring ties, copies, lines and cospherical points.
        #[test]
        fn giving_way_at_once_agrees_on_lattices(
            (values, dim) in (1usize..=5, 2usize..=40).prop_flat_map(|(dim, n)| {
                (vec((-3i32..4).prop_map(f64::from), n * dim), Just(dim))
            })
        ) {
            agrees(&values, dim);
        }
    }
}
