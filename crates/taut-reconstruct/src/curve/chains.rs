//! From sets of edges to chains that never cross.
//!
//! *Problem.* Edges that a method chose may leave a site with three of them, stop short of each other, or cross; an answer must be
//! polylines that do none of it.
//! *Idea.* [`repair`]: a site keeps its best pair of edges; of two edges that meet the longer one goes; ends that face each other
//! are joined unless that crosses anything. [`chains`]: walk along what is left.
//! *Guarantee.* Degrees are at most two, no two edges meet but in a common end (exact signs), and chains, with where they begin and
//! which way they run, are functions of the set of edges.

mod crossings;
mod degrees;
mod gaps;

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, OrderBy};

use super::Ends;
use crate::Error;

/// Stands for no site.
const NONE: u32 = u32::MAX;

/// One connected curve through sites.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chain {
    /// The sites in order: from the end with the smaller number, or of a closed one from the smallest site towards the smaller
    /// of its neighbors.
    pub(super) sites: Vec<u32>,
    /// Whether an edge leads from the last back to the first.
    pub(super) closed: bool,
}

/// What was changed in a set of edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Repairs {
    /// Edges dropped at sites with more than two.
    pub(super) cut: u64,
    /// Edges dropped because they met a shorter one.
    pub(super) crossed: u64,
    /// Edges added between ends.
    pub(super) joined: u64,
}

/// Edges of which no site has more than two and no two meet but in a common end; each edge as (smaller, larger), in order.
pub(super) fn repair(
    sites: &[[f64; 2]],
    mut edges: Vec<[u32; 2]>,
    ends: Ends,
    monitor: &Monitor<'_>,
) -> Result<(Vec<[u32; 2]>, Repairs), Error> {
    let mut repairs = Repairs::default();
    for [a, b] in &mut edges {
        if a > b {
            std::mem::swap(a, b);
        }
    }
    if !edges.is_sorted() {
        edges.par_sort_unstable();
    }
    edges.dedup();
    repairs.cut = degrees::limit(sites, &mut edges);
    monitor.check()?;
    repairs.crossed = crossings::remove(sites, &mut edges);
    monitor.check()?;
    if ends == Ends::Auto {
        repairs.joined = gaps::join(sites, &mut edges);
    }
    Ok((edges, repairs))
}

/// Drops edges until no two meet but in a common end, and says how many.
///
/// For sites whose scaled copies [`repair`] was given: what is exact there need not be so here.
pub(super) fn remove_crossings(sites: &[[f64; 2]], edges: &mut Vec<[u32; 2]>) -> u64 {
    crossings::remove(sites, edges)
}

/// For each site its neighbors by edges of degree at most two; the smaller one first.
fn links(sites: usize, edges: &[[u32; 2]]) -> Vec<[u32; 2]> {
    let mut links = vec![[NONE; 2]; sites];
    for &[a, b] in edges {
        for (from, to) in [(a, b), (b, a)] {
            let [low, high] = &mut links[from as usize];
            debug_assert!(*high == NONE, "a site has at most two edges");
            (*low, *high) = ((*low).min(to), if *low == NONE { NONE } else { (*low).max(to) });
        }
    }
    links
}

/// The chains of a set of edges in which no site has more than two, by first site. Sites without an edge are in none.
pub(super) fn chains(sites: usize, edges: &[[u32; 2]]) -> Vec<Chain> {
    let links = links(sites, edges);
    let mut seen = vec![false; sites];
    let mut chains = Vec::new();
    let mut walk = |start: u32, closed: bool, seen: &mut [bool]| {
        let mut chain = vec![start];
        seen[start as usize] = true;
        let (mut last, mut here) = (start, links[start as usize][0]);
        while here != NONE && !seen[here as usize] {
            seen[here as usize] = true;
            chain.push(here);
            let [low, high] = links[here as usize];
            (last, here) = (here, if low == last { high } else { low });
        }
        chains.push(Chain { sites: chain, closed });
    };
    // First the open ones, so that what is left is closed.
    for closed in [false, true] {
        for (site, &[low, high]) in (0u32..).zip(&links) {
            let starts = if closed { high != NONE } else { low != NONE && high == NONE };
            if starts && !seen[site as usize] {
                walk(site, closed, &mut seen);
            }
        }
    }
    chains.order_by_key(|chain| chain.sites[0]);
    chains
}

#[cfg(test)]
mod tests;
