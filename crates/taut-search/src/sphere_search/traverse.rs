//! The walk through the tree that all searches from a place share.
//!
//! *Idea.* For what is near: the home block first, then up from it, level by level, as long as the cuts are near enough; of each
//! node on the way up the other children. For what is far: from the top down. The bounds of eight children are calculated at once
//! and stay in a frame of their level; the most promising child is the next one.
//! *Guarantee.* A node is left out only if its bound cannot be admitted, and of equal keys only if all of its rows are higher: the
//! rows found do not depend on the order of visits.
//! *Trap.* A search among a million rows mostly waits for memory: a third of the time for the first numbers of the home block. So
//! what is surely needed is asked for together, and no memory is taken for a search.

use super::cuts::LEVELS_MAX;
use super::dim::Dim;
use super::measure::Measure;
use super::nodes::{BLOCK_SIZE, FANOUT, Nodes};

/// The rows that a search keeps.
pub(super) trait Collector<K> {
    /// Tests whether a row with a key of at least (or in a search for the farthest at most) `bound` can still count.
    fn may_admit(&self, bound: K) -> bool;

    /// The same of rows that are all at least `lowest_row`.
    fn admits(&self, bound: K, lowest_row: u32) -> bool;

    /// Receives the keys of a block, whose rows ascend.
    fn offer(&mut self, keys: &[K; BLOCK_SIZE], rows: &[u32; BLOCK_SIZE]);
}

/// The children of a node, and which of them are left to visit.
#[derive(Clone, Copy)]
struct Frame<K> {
    bounds: [K; FANOUT],
    left: u32,
}

/// The frames of a search, kept from one place to the next.
pub(super) struct Frames<M: Measure>([Frame<M::Key>; LEVELS_MAX]);

impl<M: Measure> Default for Frames<M> {
    #[inline(always)]
    fn default() -> Self {
        Frames([Frame { bounds: [M::ABOVE_ALL; FANOUT], left: 0 }; LEVELS_MAX])
    }
}

/// A bit for each lane whose number passes a test.
#[inline(always)]
pub(super) fn lanes_where<K: Copy, const L: usize>(keys: &[K; L], test: impl Fn(K) -> bool) -> u32 {
    let mut mask = 0;
    for lane in 0..L {
        mask |= u32::from(test(keys[lane])) << lane;
    }
    mask
}

/// A search from a place.
#[derive(Clone, Copy)]
pub(super) struct Search<'a, D> {
    pub(super) nodes: &'a Nodes,
    pub(super) dim: D,
    pub(super) place: &'a [f64],
}

impl<D: Dim> Search<'_, D> {
    /// Offers all blocks that may hold rows of the answer, from the home block on.
    #[inline(always)]
    pub(super) fn near<M: Measure>(
        self,
        home: usize,
        frames: &mut Frames<M>,
        found: &mut impl Collector<M::Key>,
    ) {
        let margins = self.nodes.margins(self.place, home);
        // Nearly all searches need these, and so they come from memory together with the home block.
        let mut bounds = self.bounds::<M, false>(0, home / FANOUT);
        self.offer::<M, false>(home, found);
        let mut node = home;
        for level in 0..self.nodes.levels.len() {
            let outside =
                M::lengthen([M::key_along(margins[level])], |_| -self.nodes.row_radius_max);
            if !found.may_admit(outside[0]) {
                return;
            }
            let others = !(1 << (node % FANOUT));
            node /= FANOUT;
            if level > 0 {
                bounds = self.bounds::<M, false>(level, node);
            }
            self.walk::<M, false>((level, node), (&bounds, others), frames, found);
        }
    }

    /// Offers all blocks that may hold rows of the answer, the farthest first.
    #[inline(always)]
    pub(super) fn far<M: Measure>(
        self,
        frames: &mut Frames<M>,
        found: &mut impl Collector<M::Key>,
    ) {
        let top = self.nodes.levels.len() - 1;
        let bounds = self.bounds::<M, true>(top, 0);
        self.walk::<M, true>((top, 0), (&bounds, u32::MAX), frames, found);
    }

    #[inline(always)]
    fn offer<M: Measure, const IS_FAR: bool>(
        self,
        block: usize,
        found: &mut impl Collector<M::Key>,
    ) {
        let keys = self.nodes.block_keys::<D, M, IS_FAR>(self.dim, block, self.place);
        found.offer(&keys, self.nodes.rows_of(block));
    }

    /// Visits what is below some nodes of a group of a level.
    #[inline(always)]
    fn walk<M: Measure, const IS_FAR: bool>(
        self,
        (top, group): (usize, usize),
        (bounds, lanes): (&[M::Key; FANOUT], u32),
        Frames(frames): &mut Frames<M>,
        found: &mut impl Collector<M::Key>,
    ) {
        let (mut level, mut group) = (top, group);
        frames[level] = self.frame::<M>((level, group), bounds, found);
        frames[level].left &= lanes;
        loop {
            let frame = &mut frames[level];
            if frame.left == 0 {
                if level == top {
                    return;
                }
                (level, group) = (level + 1, group / FANOUT);
                continue;
            }
            let lane = frame.next::<IS_FAR>();
            let bound = frame.bounds[lane];
            if !found.may_admit(bound) {
                frame.left = 0;
                continue;
            }
            frame.left &= !(1 << lane);
            if !found.admits(bound, self.nodes.levels[level].lowest_rows_of(group)[lane]) {
                continue;
            }
            let node = group * FANOUT + lane;
            if level == 0 {
                self.offer::<M, IS_FAR>(node, found);
            } else {
                (level, group) = (level - 1, node);
                let bounds = self.bounds::<M, IS_FAR>(level, group);
                frames[level] = self.frame::<M>((level, group), &bounds, found);
            }
        }
    }

    /// The bounds of the nodes of a group of a level.
    #[inline(always)]
    fn bounds<M: Measure, const IS_FAR: bool>(
        self,
        level: usize,
        group: usize,
    ) -> [M::Key; FANOUT] {
        let (level, place) = (&self.nodes.levels[level], self.place);
        match IS_FAR {
            true => level.upper::<D, M>(self.dim, group, (place, place), (place, 0.0), 0.0),
            false => level.lower::<D, M>(self.dim, group, (place, place), 0.0),
        }
    }

    /// The nodes of a group of a level that may hold rows of the answer.
    #[inline(always)]
    fn frame<M: Measure>(
        self,
        (level, group): (usize, usize),
        bounds: &[M::Key; FANOUT],
        found: &impl Collector<M::Key>,
    ) -> Frame<M::Key> {
        let left = lanes_where(bounds, |bound| found.may_admit(bound));
        let width = self.nodes.levels[level].width(group);
        Frame { bounds: *bounds, left: left & ((1 << width) - 1) }
    }
}

impl<K: Copy + PartialOrd> Frame<K> {
    /// The most promising child of those that are left.
    #[inline(always)]
    fn next<const IS_FAR: bool>(&self) -> usize {
        let mut best = self.left.trailing_zeros() as usize;
        let mut others = self.left & (self.left - 1);
        while others != 0 {
            let lane = others.trailing_zeros() as usize % FANOUT;
            let (bound, least) = (self.bounds[lane], self.bounds[best % FANOUT]);
            let is_before = if IS_FAR { bound > least } else { bound < least };
            best = if is_before { lane } else { best };
            others &= others - 1;
        }
        best % FANOUT
    }
}
