//! Short tours through points of the plane, with a bound on how much shorter one could be.
//!
//! *Problem.* A closed tour through all sites, or a path, as short as can be, without crossings, and potentials that prove how short
//! any tour must be.
//! *Idea.* Candidates from the Delaunay triangulation; fragments that grow together (greedy matching); moves of three edges; the
//! ascent of Held and Karp, from potentials read off the tour, later with one coordinate for each cluster; and, where the bound leaves something
//! open, perturbations that are repaired by moves. Crossings that are left are removed with exact signs.
//! *Guarantee.* The tour is a simple polygon or path. The bound holds for all tours, not only those of candidates. All budgets count
//! events. O(n) memory.
//! *Trap.* Sites on a line have no closed tour that is simple: they get the path from end to end.
//! *Reference.* Giesen, Curve reconstruction, the traveling salesman problem and Menger's theorem on length, 1999: of dense samples
//! of a closed curve the shortest tour is the curve.

mod ascent;
mod candidates;
mod cluster_direction;
mod cycle;
mod fragments;
mod metric;
mod moves;
mod perturbations;
mod simple;
mod start;
#[cfg(test)]
mod tests;
mod tree;
pub(crate) mod union;

use taut_certify::{tour_bound, tour_length};
use taut_points::{Monitor, OrderBy};
use taut_predicates::plane::{lexicographic, orient};

use crate::Error;
use ascent::{Ascent, special_site};
use candidates::Candidates;
use cycle::Cycle;
use metric::Metric;
use moves::{Queue, Search};
use perturbations::perturb;
use simple::untangle;

/// The ascent has this many steps, a third of them before the perturbations, and fewer where sites times steps would be more
/// than [`STEPS_WORK`].
const ASCENT_STEPS: usize = 90;
const STEPS_MIN: usize = 30;
const STEPS_WORK: usize = 3_000_000;
/// This many perturbations are made per site that the bound leaves open.
const KICKS_PER_SITE: usize = 2;
/// Few sites afford more of both, in rounds, until the tour is within [`GAP_WANTED`] of its bound: this many, and fewer
/// where sites times rounds would be more than [`ROUNDS_WORK`]. A round takes [`ASCENT_STEPS`], and as many perturbations per
/// site of the tour.
const ROUNDS_MAX: usize = 12;
const ROUNDS_WORK: usize = 1500;
const ROUND_KICKS: usize = 4;
const GAP_WANTED: f64 = 0.01;
/// A round is the last if it left more than this share of the gap.
const GAP_RATIO_MAX: f64 = 0.95;

/// A tour with its bound.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Tour {
    pub(crate) order: Vec<u32>,
    /// True if it returns to the first; false for fewer than three sites and for sites on a line, whatever was asked.
    pub(crate) closed: bool,
    pub(crate) length: f64,
    /// The potentials that prove the bound: a number for each site, in the order of the tour.
    pub(crate) potentials: Vec<f64>,
    /// No tour, or path if this is one, is shorter.
    pub(crate) lower: f64,
    pub(crate) events: Events,
}

/// Events worth counting.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Events {
    pub(crate) steps: u64,
    /// Changes that removed crossings.
    pub(crate) untangled: u64,
}

/// A short tour, or path, through distinct sites in Hilbert order.
pub(crate) fn tour(sites: &[[f64; 2]], open: bool, monitor: &Monitor<'_>) -> Result<Tour, Error> {
    let metric = Metric::of(sites);
    if let Some(order) = along_line(sites) {
        return finish(sites, &metric, order, true, |_| 0.0, Events::default(), monitor);
    }
    let n = sites.len();
    let candidates = Candidates::of(sites, &metric, monitor)?;
    let mut order = fragments::path(sites, &metric, &candidates, monitor)?;
    if open {
        // The node through which a cycle is a path.
        order.push(n as u32);
    }
    let search = Search { metric: &metric, candidates: &candidates, reach: n };
    let mut cycle = Cycle::new(order);
    shorten(search, &mut cycle, monitor)?;
    let length = metric.length(cycle.order());
    let steps = (STEPS_WORK / n).clamp(STEPS_MIN, ASCENT_STEPS);
    let (mut ascent, mut closed) = begin(&metric, &candidates, &cycle, length, open, monitor)?;
    closed = closed || ascent.climb(length, steps / 3, monitor)?;
    if !closed {
        let near = ascent.open_sites();
        let (kicked, climbed) = taut_points::parallel::join(
            || perturb(search, &mut cycle, &near, KICKS_PER_SITE * near.len(), 0, monitor),
            || ascent.climb(length, steps - steps / 3, monitor),
        );
        kicked?;
        climbed?;
        again(search, &mut cycle, &mut ascent, monitor)?;
    }
    let untangled = untangle(sites, &mut cycle, monitor)?;
    let mut order = cycle.order().to_vec();
    // A path begins behind the node it was closed through, a tour at the special site.
    let first = ascent.special.unwrap_or(n as u32);
    let at = order.iter().position(|&v| v == first).unwrap_or(0);
    order.rotate_left(at);
    if open {
        order.remove(0);
    }
    let events = Events { steps: ascent.steps, untangled };
    finish(sites, &metric, order, open, |v| ascent.best[v as usize], events, monitor)
}

/// The first step of the ascent, for a closed tour of two that begin differently the better one; true if that is all.
fn begin<'a>(
    metric: &Metric,
    candidates: &'a Candidates,
    cycle: &Cycle,
    length: f64,
    open: bool,
    monitor: &Monitor<'_>,
) -> Result<(Ascent<'a>, bool), Error> {
    let n = metric.sites();
    let step = |special: Option<u32>, potentials: Vec<f64>| {
        let mut ascent = Ascent::new(candidates, special, potentials);
        let closed = ascent.climb(length, 1, monitor)?;
        Ok::<_, Error>((ascent, closed))
    };
    if open {
        return step(None, vec![0.0; n]);
    }
    let (special, potentials) = start::of_cycle(metric, cycle.order());
    let told = step(Some(special), potentials)?;
    if told.1 {
        return Ok(told);
    }
    let plain = step(Some(special_site(candidates, n)), vec![0.0; n])?;
    Ok(if told.0.bound > plain.0.bound { told } else { plain })
}

/// Kicks and steps by turns, for few sites whose tour the bound leaves open.
fn again(
    search: Search<'_>,
    cycle: &mut Cycle,
    ascent: &mut Ascent<'_>,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let n = search.metric.sites();
    let mut before = f64::INFINITY;
    for round in 1..=ROUNDS_MAX.min(ROUNDS_WORK / n) {
        let length = search.metric.length(cycle.order());
        let gap = length - ascent.bound;
        if gap <= GAP_WANTED * length || gap > GAP_RATIO_MAX * before {
            break;
        }
        before = gap;
        perturb(search, cycle, &ascent.open_sites(), ROUND_KICKS * n, round as u64, monitor)?;
        ascent.restart();
        if ascent.climb(search.metric.length(cycle.order()), ASCENT_STEPS, monitor)? {
            break;
        }
    }
    Ok(())
}

/// All moves that shorten.
fn shorten(search: Search<'_>, cycle: &mut Cycle, monitor: &Monitor<'_>) -> Result<(), Error> {
    let mut queue = Queue::of(cycle.len());
    cycle.order().iter().for_each(|&v| queue.push(v));
    let (mut moves, mut cancelled) = (0u64, Ok(()));
    search.improve(cycle, &mut queue, || {
        moves += 1;
        if moves % 256 == 0 {
            cancelled = monitor.check();
        }
        cancelled.is_ok()
    });
    Ok(cancelled?)
}

/// Of sites on a line, the order along it.
fn along_line(sites: &[[f64; 2]]) -> Option<Vec<u32>> {
    let all = 0..sites.len() as u32;
    let by = |&a: &u32, &b: &u32| lexicographic(sites[a as usize], sites[b as usize]);
    if let (Some(first), Some(last)) = (all.clone().min_by(by), all.clone().max_by(by)) {
        let [a, b] = [first, last].map(|v| sites[v as usize]);
        if sites.iter().any(|&p| !orient(a, b, p).is_zero()) {
            return None;
        }
    }
    let mut order: Vec<u32> = all.collect();
    order.order_by(&by);
    Some(order)
}

/// The tour with its length, and the bound that the potentials prove for all tours.
fn finish(
    sites: &[[f64; 2]],
    metric: &Metric,
    order: Vec<u32>,
    open: bool,
    potential: impl Fn(u32) -> f64,
    events: Events,
    monitor: &Monitor<'_>,
) -> Result<Tour, Error> {
    let potentials: Vec<f64> = order.iter().map(|&v| metric.back(potential(v))).collect();
    let at: Vec<[f64; 2]> = order.iter().map(|&v| sites[v as usize]).collect();
    let lower = tour_bound(&at, &potentials, open, monitor)?;
    let length = tour_length(&at, open);
    Ok(Tour { closed: !open, length, order, potentials, lower, events })
}
