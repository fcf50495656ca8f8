//! Potentials to begin with, read off a tour.
//!
//! *Problem.* Without potentials the least 1-tree of a dense sample of a closed curve lacks the longest edge, and an ascent moves that
//! information along the curve a few sites a step.
//! *Idea.* One end s of the longest edge st of the tour is the special site. Potentials are −|st|/2 at t and |st|/2 at s, and fall
//! off in size along the tour on either side, by [`POTENTIAL_SLOPE`] of the way. Then s is no farther from t than from any but its
//! other neighbor, and no edge across the gap is lighter than the longest of the rest.
//! *Guarantee.* None: they are tried, and kept if they prove more than none.
//! *Trap.* With slope 1 a chord would be lighter than the two edges it spans wherever the curve bends.

use super::metric::Metric;

/// Potentials fall off at this rate, against the way along the tour.
const POTENTIAL_SLOPE: f64 = 0.9;

/// The special site, and a potential for each site, of a cycle of sites.
pub(super) fn of_cycle(metric: &Metric, order: &[u32]) -> (u32, Vec<f64>) {
    let n = order.len();
    let edge = |i: usize| metric.distance(order[i % n], order[(i + 1) % n]);
    let longest = (0..n).fold(0, |a, i| if edge(i) > edge(a) { i } else { a });
    let gap = edge(longest);
    let mut potentials = vec![0.0; n];
    let (mut along, mut back) = (0.0, 0.0);
    for k in 0..n.div_ceil(2) {
        let ahead = (longest + 1 + k) % n;
        let behind = (longest + n - k) % n;
        let size = [along, back].map(|way: f64| (gap / 2.0 - POTENTIAL_SLOPE * way).max(0.0));
        potentials[order[behind] as usize] = -size[1];
        potentials[order[ahead] as usize] = size[0];
        if size == [0.0; 2] {
            break;
        }
        along += edge(ahead);
        back += edge(behind + n - 1);
    }
    (order[(longest + 1) % n], potentials)
}
