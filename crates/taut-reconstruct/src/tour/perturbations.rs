//! Shortening beyond local optima: a small random change, repaired by moves, is kept if the tour is shorter for it.
//!
//! *Idea.* Three short runs near a node that the bound leaves open change their order (a double bridge, which moves of three edges
//! cannot undo), the eight nodes at the cuts are queued, and moves do the rest. All that takes place within some dozens of
//! nodes, so a perturbation costs microseconds whatever n.
//! *Guarantee.* The tour never gets longer. The random numbers depend on n and the round alone.
//! *Reference.* Johnson and McGeoch 1997, iterated 3-opt with segment lengths bounded by 50.

use taut_points::Monitor;

use super::cycle::Cycle;
use super::moves::{Queue, Search};
use crate::Error;

/// A perturbation moves a run of at most this many sites.
const MOVED_RUN_MAX: u64 = 30;
/// Moves reverse a run of at most this many sites after a perturbation: without a limit, rare long ones would take most of the
/// time.
const REVERSED_RUN_MAX: usize = 1000;

/// Kicks near each of these nodes, again and again, so many times in all; each round has random numbers of its own. Returns by how much the tour got shorter.
pub(super) fn perturb(
    search: Search<'_>,
    cycle: &mut Cycle,
    near: &[u32],
    perturbations: usize,
    round: u64,
    monitor: &Monitor<'_>,
) -> Result<f64, Error> {
    let n = cycle.len();
    let search = Search { reach: REVERSED_RUN_MAX, ..search };
    if n < 8 || near.is_empty() {
        return Ok(0.0);
    }
    let longest = MOVED_RUN_MAX.min((n as u64 - 2) / 3);
    let mut random = SplitMix { state: n as u64 + (round << 32) };
    let mut queue = Queue::of(n);
    let mut total = 0.0;
    for turn in 0..perturbations {
        if turn % 256 == 0 {
            monitor.check()?;
        }
        let node = near[turn % near.len()];
        let lengths = [0; 3].map(|_| 1 + random.below(longest) as usize);
        let back = random.below((lengths.iter().sum::<usize>() + 1) as u64) as usize;
        let at = (cycle.place(node) as usize + n - back) % n;
        // The nodes on either side of each cut, by their places.
        let cuts = [0, lengths[0], lengths[0] + lengths[1], lengths.iter().sum()];
        let ends = cuts.map(|k| [k, k + 1].map(|k| cycle.at((at + k) % n)));
        let [[x1, x2], [y1, y2], [z1, z2], [w1, w2]] = ends;
        let d = |a, b| search.metric.between(a, b);
        let longer = d(x1, z2) + d(w1, y2) + d(z1, x2) + d(y1, w2)
            - (d(x1, x2) + d(y1, y2) + d(z1, z2) + d(w1, w2));
        cycle.note();
        cycle.double_bridge(at, lengths);
        ends.as_flattened().iter().for_each(|&node| queue.push(node));
        let gain = search.improve(cycle, &mut queue, || true) - longer;
        if gain > 1e-12 * longer.abs() {
            total += gain;
        } else {
            cycle.take_back();
        }
    }
    Ok(total)
}

/// Numbers that look random: Steele, Lea and Flood, Fast splittable pseudorandom number generators, 2014.
struct SplitMix {
    state: u64,
}

impl SplitMix {
    fn below(&mut self, bound: u64) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((u128::from(z ^ (z >> 31)) * u128::from(bound)) >> 64) as u64
    }
}
