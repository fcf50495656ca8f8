//! Ends that face each other across a gap are joined.

use taut_points::OrderBy;

use super::crossings::{self, EdgeTree};
use super::{NONE, links};
use crate::curve::boxes::{Bounds, Boxes};

/// A gap is closed up to this many times the longest of the last [`LOCAL_EDGES`] edges before either end. Gaps that
/// sampling leaves are of one missing edge, two spacings; four leaves room for spacings that vary.
const GAP_RATIO_MAX: f64 = 4.0;
/// This many edges tell the spacing near an end.
const LOCAL_EDGES: usize = 4;
/// A joining edge may deviate from the last edge at an end by an angle of this cosine: 60°.
const FACING_COS_MIN: f64 = 0.5;

/// An end of an open chain.
struct End {
    site: u32,
    at: [f64; 2],
    /// The unit vector along the last edge.
    ahead: [f64; 2],
    /// The widest gap for it.
    reach: f64,
}

/// Joins pairs of facing ends, the best first, unless that would meet another edge. Tells how many.
///
/// A gap d to be crossed at the angles α and β to the last edges costs d (3 − cos α − cos β).
pub(super) fn join(sites: &[[f64; 2]], edges: &mut Vec<[u32; 2]>) -> u64 {
    let links = links(sites.len(), edges);
    let ends: Vec<End> = (0u32..)
        .zip(&links)
        .filter(|(_, [low, high])| *low != NONE && *high == NONE)
        .map(|(site, _)| end(sites, &links, site))
        .collect();
    if ends.is_empty() {
        return 0;
    }
    let boxes = Boxes::over(ends.len(), |i| Bounds::of(ends[i].at));
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (i, a) in ends.iter().enumerate() {
        let reach2 = a.reach * a.reach;
        boxes.nearest(
            reach2,
            |b| b.distance2(a.at),
            |leaf, bound| {
                for k in boxes.leaf(leaf).filter(|&k| k != i) {
                    // A pair within reach of both is found twice.
                    let twice = k < i && ends[k].reach >= distance(a.at, ends[k].at);
                    if let Some(cost) = cost(a, &ends[k]).filter(|_| !twice) {
                        pairs.push((cost, i.min(k), i.max(k)));
                    }
                }
                bound
            },
        );
    }
    pairs.order_by(&|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let tree = EdgeTree::new(sites, edges);
    let mut free = vec![true; ends.len()];
    let mut added: Vec<[u32; 2]> = Vec::new();
    for (_, i, k) in pairs {
        // Ends are in the order of their sites, and i < k.
        let edge = [ends[i].site, ends[k].site];
        // Two sites that an edge joins already are a whole chain.
        if free[i] && free[k] && links[edge[0] as usize][0] != edge[1] && !tree.meets(edge) {
            (free[i], free[k]) = (false, false);
            added.push(edge);
        }
    }
    // None of these meets an edge from before; of those that meet each other the longer ones go.
    added.sort_unstable();
    crossings::remove(sites, &mut added);
    let joined = added.len() as u64;
    edges.append(&mut added);
    edges.sort_unstable();
    joined
}

fn end(sites: &[[f64; 2]], links: &[[u32; 2]], site: u32) -> End {
    let at = sites[site as usize];
    let (mut last, mut here) = (site, links[site as usize][0]);
    let before = sites[here as usize];
    let length = distance(at, before);
    let mut longest = length;
    for _ in 1..LOCAL_EDGES {
        let [low, high] = links[here as usize];
        let next = if low == last { high } else { low };
        if next == NONE {
            break;
        }
        longest = longest.max(distance(sites[here as usize], sites[next as usize]));
        (last, here) = (here, next);
    }
    let ahead = [(at[0] - before[0]) / length, (at[1] - before[1]) / length];
    End { site, at, ahead, reach: GAP_RATIO_MAX * longest }
}

/// What it costs to join two ends, if they face each other and the gap is not too wide.
fn cost(a: &End, b: &End) -> Option<f64> {
    let gap = distance(a.at, b.at);
    let way = [(b.at[0] - a.at[0]) / gap, (b.at[1] - a.at[1]) / gap];
    let there = way[0] * a.ahead[0] + way[1] * a.ahead[1];
    let back = -(way[0] * b.ahead[0] + way[1] * b.ahead[1]);
    (gap <= a.reach.max(b.reach) && there >= FACING_COS_MIN && back >= FACING_COS_MIN)
        .then_some(gap * (3.0 - there - back))
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (b[0] - a[0]).hypot(b[1] - a[1])
}
