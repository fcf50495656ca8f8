//! What speaks against the topology of the labels, with where it was found.
//!
//! *Problem.* A sound mesh can have another topology than what was sampled: a handle through a wall, two bodies grown together. No checker
//! can see that, as it does not know what was sampled.
//! *Idea.* Where samples are dense enough, labels need next to no repair, repair never changes the number of handles and parts, and no
//! facet that strongly says "a surface is here" lies within one side. Each of these that fails is named.
//! *Guarantee.* None: this is evidence. How often it is right is measured by class on drawn shapes (`bench surface unseen`; docs/surface.md).

use taut_certify::{TopologyDoubt, TopologyReason};

use super::cells::Cells;
use super::repair::Repaired;

/// This share of sites can be repaired without a doubt.
const REPAIRS_SHARE: f64 = 1e-3;
/// So many facets in a thousand sites can be overruled without a doubt.
const OVERRULED_SHARE: f64 = 1e-3;
/// This share of rows can look as if noise were as large as what is around them without a doubt: curvature is exaggerated by noise, and
/// four fifths of the rows look so where topology begins to be wrong.
const UNCLEAR_SHARE: f64 = 0.5;
/// This many of any say nothing, however few sites there are.
const COUNT_MIN: f64 = 2.0;

/// The reasons, each with the sites that it is about.
pub(super) type Doubts = Vec<(TopologyReason, Vec<u32>)>;

/// Lists the reasons to doubt labels, from what had to be done to them.
pub(super) fn doubts(
    repaired: &Repaired,
    overruled: &[u32],
    tips: Vec<u32>,
    cells: &Cells,
    sites: usize,
) -> Doubts {
    let most = |share: f64| (share * sites as f64).max(COUNT_MIN);
    let mut doubts = Vec::new();
    if !repaired.rebuilt.is_empty() {
        doubts.push((TopologyReason::Rebuilt, repaired.rebuilt.clone()));
    }
    if repaired.sites.len() as f64 > most(REPAIRS_SHARE) {
        doubts.push((TopologyReason::Repairs, repaired.sites.clone()));
    }
    if overruled.len() as f64 > most(OVERRULED_SHARE) {
        // Strong facets are none of two ghosts, so the first site is one.
        let at = overruled.iter().map(|&facet| cells.name(facet)[0]);
        doubts.push((TopologyReason::Overruled, at.collect()));
    }
    if !tips.is_empty() {
        doubts.push((TopologyReason::Spikes, tips));
    }
    for (_, sites) in &mut doubts {
        sites.sort_unstable();
        sites.dedup();
    }
    doubts
}

/// The doubt that noise makes, of so many rows, some of which have noise as large as what is around them.
pub(super) fn doubt_of_noise(unclear: &[u32], rows: usize) -> Option<TopologyDoubt> {
    let most = (UNCLEAR_SHARE * rows as f64).max(COUNT_MIN);
    let is_doubtful = unclear.len() as f64 > most;
    is_doubtful.then(|| TopologyDoubt { reason: TopologyReason::Noise, rows: unclear.to_vec() })
}
