//! The walk down the tree that all searches from a place share.
//!
//! *Idea.* A stack of nodes, each with a bound of its keys; of the children of a node those that may hold a row are pushed, the most
//! promising one last. The bounds of eight children are calculated at once.
//! *Guarantee.* A node is left out only if its bound cannot be admitted, and of equal keys only if all of its rows are higher: the
//! rows found do not depend on the order of visits.

use super::dim::Dim;
use super::measure::Measure;
use super::nodes::{BLOCK_SIZE, FANOUT, Nodes};

/// A node that may hold rows of the answer.
#[derive(Clone, Copy, Debug)]
pub(super) struct Pending<K> {
    bound: K,
    level: u32,
    node: u32,
    lowest_row: u32,
}

/// The rows that a search keeps.
pub(super) trait Collector<K> {
    /// Tests whether a row with a key of at least (or in a search for the farthest at most) `bound` can still count.
    fn may_admit(&self, bound: K) -> bool;

    /// The same of rows that are all at least `lowest_row`.
    fn admits(&self, bound: K, lowest_row: u32) -> bool;

    /// Receives the keys of a block.
    fn offer(&mut self, keys: &[K; BLOCK_SIZE], rows: &[u32; BLOCK_SIZE]);
}

/// The stack of a search, kept from one place to the next.
pub(super) type Stack<K> = Vec<Pending<K>>;

/// Offers all blocks that may hold rows of the answer, nearest (with `IS_FAR` farthest) first.
#[inline(always)]
pub(super) fn search<D: Dim, M: Measure, const IS_FAR: bool>(
    nodes: &Nodes,
    dim: D,
    place: &[f64],
    stack: &mut Stack<M::Key>,
    found: &mut impl Collector<M::Key>,
) {
    stack.clear();
    let mut next = Some(Pending {
        bound: if IS_FAR { M::ABOVE_ALL } else { M::BELOW_ALL },
        level: nodes.root_level(),
        node: 0,
        lowest_row: 0,
    });
    while let Some(here) = next {
        if here.level == 0 {
            let block = here.node as usize;
            let keys = nodes.block_keys::<D, M, IS_FAR>(dim, block, place);
            found.offer(&keys, nodes.rows_of(block));
        } else {
            open::<D, M, IS_FAR>(nodes, dim, place, here, stack, found);
        }
        next = loop {
            match stack.pop() {
                Some(top) if !found.admits(top.bound, top.lowest_row) => {}
                top => break top,
            }
        };
    }
}

/// Pushes the children of a node that may hold rows of the answer, the most promising one last.
#[inline(always)]
fn open<D: Dim, M: Measure, const IS_FAR: bool>(
    nodes: &Nodes,
    dim: D,
    place: &[f64],
    here: Pending<M::Key>,
    stack: &mut Stack<M::Key>,
    found: &impl Collector<M::Key>,
) {
    let level = here.level - 1;
    let (below, group) = (&nodes.levels[level as usize], here.node as usize);
    let keys = match IS_FAR {
        true => below.upper::<D, M>(dim, group, (place, place), (place, 0.0), 0.0),
        false => below.lower::<D, M>(dim, group, (place, place), 0.0),
    };
    let lowest_rows = below.lowest_rows_of(group);
    let mut mask = 0u32;
    for lane in 0..FANOUT {
        mask |= u32::from(found.may_admit(keys[lane])) << lane;
    }
    mask &= (1 << below.width(group)) - 1;
    let first = stack.len();
    while mask != 0 {
        let lane = mask.trailing_zeros() as usize;
        mask &= mask - 1;
        let (bound, lowest_row) = (keys[lane], lowest_rows[lane]);
        if !found.admits(bound, lowest_row) {
            continue;
        }
        let node = (group * FANOUT + lane) as u32;
        stack.push(Pending { bound, level, node, lowest_row });
        let mut at = stack.len() - 1;
        let is_before = |other: M::Key| if IS_FAR { bound > other } else { bound < other };
        while at > first && !is_before(stack[at - 1].bound) {
            stack.swap(at, at - 1);
            at -= 1;
        }
    }
}
