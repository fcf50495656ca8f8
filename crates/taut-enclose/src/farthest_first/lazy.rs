//! The traversal: which point is farthest, found without asking about points that cannot be it.
//!
//! *Idea.* The distance of a point to the chosen ones only falls as more are chosen, so what was known of it some time ago is
//! an upper bound. Points come in leaves, each with the bound of its farthest point; a queue has the leaf with the largest
//! bound in front. If the bound there is up to date, that point is the farthest of all. If not, it is brought up to
//! date, and so are the leaves behind it, in batches for the threads.
//! *Guarantee.* The point found is the farthest, the lowest row of equally far ones, whatever was up to date before. Which
//! leaves are looked at depends on the points alone, so the counters do not depend on threads either.
//! *Reference.* Minoux, Accelerated greedy algorithms for maximizing submodular set functions, 1978.

use std::cmp::{Ordering, Reverse};
use std::collections::{BinaryHeap, HashSet};

use rayon::prelude::*;
use taut_certify::{Stop, Trace};
use taut_points::{Monitor, PointSource, PointsHash, map_blocks};

use super::FarthestFirst;
use super::chosen::{Chosen, Scratch};
use crate::Error;
use crate::frame::{Frame, SQUARE_MIN};

/// Leaves that are brought up to date together at first: enough to share among threads, and few where each is a read of a
/// medium that may turn out to be for nothing. Twice as many each time that was not enough.
const BATCH: usize = 16;
const BATCH_STORED: usize = 2;
/// Most leaves that are brought up to date together.
const BATCH_MAX: usize = 4096;

/// The squared distance of a point from the chosen ones, as far as is known, and its row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Key {
    pub(super) value: f64,
    pub(super) row: u64,
}

impl Key {
    /// Below every point.
    pub(super) const MIN: Key = Key { value: -1.0, row: u64::MAX };
}

impl Eq for Key {}

impl Ord for Key {
    /// Larger is farther; of two that are equally far the one with the lower row is larger.
    fn cmp(&self, other: &Self) -> Ordering {
        self.value.total_cmp(&other.value).then(Reverse(self.row).cmp(&Reverse(other.row)))
    }
}

impl PartialOrd for Key {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The farthest point of a leaf, as far as is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Top {
    pub(super) key: Key,
    /// With how many of the chosen points it was compared.
    pub(super) seen: usize,
}

/// Some points, with an upper bound on the distance of each.
pub(super) trait Leaf: Send {
    /// Its farthest point by these bounds.
    fn top(&self) -> Top;
    /// Compares its points with chosen ones until its farthest is up to date or below `floor`; returns how many
    /// distances that took.
    fn update(&mut self, chosen: &Chosen, floor: Key, scratch: &mut Scratch) -> Result<u64, Error>;
}

/// Leaves, and what share of all points one look at one of them reads.
pub(super) struct Leaves<L> {
    pub(super) leaves: Vec<L>,
    /// True if the points of a leaf are read from a medium when it is updated.
    pub(super) stored: bool,
}

pub(super) struct Job<'a> {
    pub(super) source: &'a dyn PointSource,
    pub(super) monitor: &'a Monitor<'a>,
    pub(super) count: u64,
    pub(super) start: u64,
    pub(super) frame: Frame,
    pub(super) points_hash: PointsHash,
}

/// Counters of events.
#[derive(Default)]
struct Events {
    distances: u64,
    parts: u64,
}

impl Job<'_> {
    /// The traversal over these leaves.
    pub(super) fn run<L: Leaf>(&self, leaves: Leaves<L>) -> Result<FarthestFirst, Error> {
        let parts = leaves.leaves.len() as u64;
        let mut queue: BinaryHeap<(Key, Reverse<usize>)> =
            BinaryHeap::with_capacity(parts as usize);
        queue.extend(leaves.leaves.iter().enumerate().map(|(i, l)| (l.top().key, Reverse(i))));
        let mut slots: Vec<Option<L>> = leaves.leaves.into_iter().map(Some).collect();
        let mut chosen = Chosen::new(self.source.dim());
        let mut events = Events::default();
        let batch = if leaves.stored { BATCH_STORED } else { BATCH };
        let (mut order, mut radii) = (vec![], vec![]);
        let mut row = self.start;
        let next = loop {
            order.push(row);
            chosen.push(&self.frame.gather(self.source, &[row])?);
            let top = self.farthest(&mut queue, &mut slots, &chosen, batch, &mut events)?;
            if top.value < SQUARE_MIN {
                self.all_are_copies(&order)?;
                radii.push(0.0);
                break None;
            }
            radii.push(self.frame.bring_out(top.value.sqrt())?);
            if order.len() as u64 == self.count {
                break Some(top.row);
            }
            row = top.row;
        };
        let shares = if leaves.stored {
            events.parts.div_ceil(parts)
        } else {
            events.distances.div_ceil(self.source.len())
        };
        let trace = Trace {
            method: "farthest-first".into(),
            stop: Stop::Converged,
            passes: 1 + shares,
            iterations: order.len() as u64,
            core_set: order.len() as u64 + u64::from(next.is_some()),
            history: vec![],
            counters: [("distances", events.distances), ("parts", events.parts)]
                .map(|(name, count)| (name.to_owned(), count))
                .into(),
        };
        Ok(FarthestFirst { order, radii, next, points_hash: self.points_hash, trace })
    }

    /// Brings leaves up to date until the farthest point of all is known.
    fn farthest<L: Leaf>(
        &self,
        queue: &mut BinaryHeap<(Key, Reverse<usize>)>,
        slots: &mut [Option<L>],
        chosen: &Chosen,
        first_batch: usize,
        events: &mut Events,
    ) -> Result<Key, Error> {
        let is_stale = |slots: &[Option<L>], leaf: usize| {
            slots[leaf].as_ref().is_some_and(|leaf| leaf.top().seen < chosen.len())
        };
        let mut batch = first_batch;
        loop {
            self.monitor.check().map_err(taut_points::ReadError::from)?;
            let mut stale = vec![];
            while stale.len() < batch
                && let Some(&(_, Reverse(leaf))) = queue.peek()
                && is_stale(slots, leaf)
            {
                queue.pop();
                stale.extend(slots[leaf].take().map(|taken| (leaf, taken)));
            }
            let front = queue.peek().map_or(Key::MIN, |&(key, _)| key);
            if stale.is_empty() {
                return Ok(front);
            }
            let distances = stale
                .par_iter_mut()
                .map_init(Scratch::default, |scratch, (_, leaf)| {
                    leaf.update(chosen, front, scratch)
                })
                .collect::<Vec<_>>();
            for distances in distances {
                events.distances += distances?;
            }
            events.parts += stale.len() as u64;
            for (place, leaf) in stale {
                queue.push((leaf.top().key, Reverse(place)));
                slots[place] = Some(leaf);
            }
            batch = (2 * batch).min(BATCH_MAX);
        }
    }

    /// Tests whether every row is a copy of one in `order`, which distances too small to be squared leave open.
    fn all_are_copies(&self, order: &[u64]) -> Result<(), Error> {
        let dim = self.source.dim();
        // Adding 0 makes −0 and 0 one.
        let bits = |row: &[f64]| -> Vec<u64> { row.iter().map(|v| (v + 0.0).to_bits()).collect() };
        let chosen = taut_points::gather(self.source, order)?;
        let chosen: HashSet<Vec<u64>> = chosen.chunks_exact(dim).map(bits).collect();
        let copies = map_blocks(self.source, self.monitor, |_, rows| {
            let mut row = vec![0.0; dim];
            Ok::<_, Error>((0..rows.len()).all(|i| {
                rows.copy_row(i, &mut row);
                chosen.contains(&bits(&row))
            }))
        })?;
        if copies.into_iter().all(|all| all) { Ok(()) } else { Err(Error::Overflow) }
    }
}
