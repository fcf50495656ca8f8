//! Where the search starts: farthest-first traversals.
//!
//! *Idea.* Each next center is the item that reaches farthest from all before. k of them are at most twice
//! as bad as the best (with weights or outliers that is not promised); k + z + 1 of them prove a bound: two of them share a ball, whichever z are
//! left out. Where items may be left out, traversals that take the (z + 1)-th farthest do not end among the outliers.
//! *Reference.* Gonzalez, Theoretical Computer Science 38, 1985; with weights, Dyer and Frieze, Operations Research
//! Letters 3(6), 1985.

use std::collections::HashSet;

use taut_points::{Monitor, ReadError};

use super::sites::Sites;
use crate::Error;

/// This many traversals start from different items; each next one from the last item of the one before.
const TRAVERSALS: usize = 4;
/// Beyond this many centers, a traversal costs more than another one gains.
const TRAVERSED_CENTERS_MAX: usize = 64;

/// Centers at rows.
#[derive(Clone, Debug)]
pub(super) struct Incumbent {
    /// Sites.
    pub(super) centers: Vec<usize>,
    /// The largest reach that counts.
    pub(super) radius: f64,
}

/// Where the search starts.
pub(super) struct Start {
    pub(super) incumbent: Incumbent,
    /// No k centers have a radius less than this; 0 where nothing is known.
    pub(super) lower: f64,
    /// The items that prove it, or the first of X.
    pub(super) members: Vec<usize>,
}

/// The largest of the reaches when `outliers` of the farthest are left out.
pub(super) fn radius(reaches: &[f64], outliers: usize) -> f64 {
    if outliers == 0 {
        return reaches.iter().copied().fold(0.0, f64::max);
    }
    if outliers >= reaches.len() {
        return 0.0;
    }
    let mut reaches = reaches.to_vec();
    *reaches.select_nth_unstable_by(outliers, |a, b| b.total_cmp(a)).1
}

/// At most `count` items, from `first` on, each next the one that reaches farthest but `skip`; and the reach of the last
/// when it was taken. Ends before `count` when nothing is left to be reached.
fn farthest_first(
    sites: &Sites,
    first: usize,
    count: usize,
    skip: usize,
    monitor: &Monitor<'_>,
) -> Result<(Vec<usize>, f64), Error> {
    let mut order = vec![first];
    let mut reaches = sites.reaches(&order);
    // A group is taken once, though it reaches beyond its center.
    let mut taken = HashSet::from([sites.group(first)]);
    let mut last = f64::INFINITY;
    while order.len() < count {
        monitor.check().map_err(ReadError::from)?;
        let reach = |site: usize| match sites.are_grouped() && taken.contains(&sites.group(site)) {
            true => f64::NEG_INFINITY,
            false => reaches[site],
        };
        let farther = |a: &usize, b: &usize| reach(*b).total_cmp(&reach(*a)).then(a.cmp(b));
        let next = match skip {
            0 => (0..sites.len()).min_by(farther),
            _ if skip >= sites.len() => None,
            _ => {
                let mut all: Vec<usize> = (0..sites.len()).collect();
                Some(*all.select_nth_unstable_by(skip, farther).1)
            }
        };
        let Some(next) = next.filter(|&next| reach(next) > sites.own_reach(next)) else { break };
        last = reaches[next];
        order.push(next);
        taken.insert(sites.group(next));
        sites.lower(&mut reaches, next);
    }
    Ok((order, last))
}

/// The best of some traversals.
pub(super) fn start(
    sites: &Sites,
    k: usize,
    outliers: usize,
    monitor: &Monitor<'_>,
) -> Result<Start, Error> {
    let count = k.saturating_add(outliers).saturating_add(1);
    let runs = if count <= TRAVERSED_CENTERS_MAX { TRAVERSALS } else { 1 };
    let incumbent = |order: &[usize]| {
        let centers = order[..k.min(order.len())].to_vec();
        let radius = radius(&sites.reaches(&centers), outliers);
        Incumbent { centers, radius }
    };
    let mut best: Option<Start> = None;
    let mut first = 0;
    for _ in 0..runs {
        let (order, last) = farthest_first(sites, first, count, 0, monitor)?;
        first = order[order.len() - 1];
        let mut found = incumbent(&order);
        if outliers > 0 {
            let (order, _) = farthest_first(sites, first, k, outliers, monitor)?;
            let robust = incumbent(&order);
            if robust.radius < found.radius {
                found = robust;
            }
        }
        let pairs = || (0..order.len()).flat_map(|a| (0..a).map(move |b| (a, b)));
        let lower = match order.len() == count {
            false => 0.0,
            true if sites.are_plain() && !sites.are_grouped() => 0.5 * last,
            true => pairs()
                .map(|(a, b)| sites.reach_of_pair(order[a], order[b]))
                .fold(f64::INFINITY, f64::min),
        };
        // Rounding may have made it too large.
        let lower = lower * (1.0 - super::rounding(sites));
        match &mut best {
            None => best = Some(Start { incumbent: found, lower, members: order }),
            Some(best) => {
                if found.radius < best.incumbent.radius {
                    best.incumbent = found;
                }
                if lower > best.lower {
                    (best.lower, best.members) = (lower, order);
                }
            }
        }
    }
    Ok(best.expect("there is a run"))
}
