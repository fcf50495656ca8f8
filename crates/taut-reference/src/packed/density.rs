//! Defines how full a window of leaves may be.
//!
//! A window of level j is 2ʲ leaves that start at a multiple of 2ʲ, cut off at the last leaf; level H = ⌈log₂ leaves⌉ is
//! all of them. A window may be the fuller, and the emptier, the smaller it is: from 3/4 and 3/8 for all down to 1 and
//! 1/8 for a leaf, in equal steps. A window that is spread evenly gives its parts a share of room that lasts for a number
//! of insertions or deletions in proportion to their size, which pays for the spreading.
//! The thesis has δ′ with the wrong sign, heights of log log n for log n, and charges the window where its child is meant;
//! the child is what fills up.

use std::ops::Range;

/// A leaf has this many slots: at least log₂ of the slots of any array, and a few lines of memory.
pub(super) const LEAF_SLOTS: usize = 64;
/// A leaf has this many entries when keys come in ascending order: the densest that all leaves may be.
pub(super) const SEQUENTIAL_ENTRIES: usize = LEAF_SLOTS * 3 / 4;
/// The fewest entries of a leaf, the last leaf excepted.
pub(super) const LEAF_MIN: usize = LEAF_SLOTS / 8;

/// The windows over a number of leaves, and their bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Windows {
    leaves: usize,
    /// The level of the window of all leaves.
    height: u32,
}

impl Windows {
    pub(super) fn new(leaves: usize) -> Self {
        Self { leaves, height: leaves.next_power_of_two().ilog2() }
    }

    pub(super) fn height(self) -> u32 {
        self.height
    }

    /// The leaves of the window of a level that holds `leaf`.
    pub(super) fn around(self, leaf: usize, level: u32) -> Range<usize> {
        let first = leaf >> level << level;
        first..(first + (1 << level)).min(self.leaves)
    }

    /// The most entries of `leaves` leaves that are a window of a level.
    pub(super) fn most(self, leaves: usize, level: u32) -> usize {
        let steps = 4 * self.height.max(1) as usize;
        leaves * LEAF_SLOTS * (steps - level as usize) / steps
    }

    /// The fewest entries of `leaves` leaves that are a window of a level.
    pub(super) fn fewest(self, leaves: usize, level: u32) -> usize {
        let height = self.height.max(1) as usize;
        (leaves * LEAF_SLOTS * (height + 2 * level as usize)).div_ceil(8 * height)
    }

    /// The most entries of all leaves.
    pub(super) fn most_of_all(self) -> usize {
        self.most(self.leaves, self.height)
    }

    /// The fewest entries of all leaves. One leaf may be empty, and the last one hold a single entry.
    pub(super) fn fewest_of_all(self) -> usize {
        if self.leaves == 1 { 0 } else { self.fewest(self.leaves - 1, self.height) }
    }

    /// Leaves that `len` entries fill to three fifths.
    pub(super) fn leaves_for(len: usize) -> usize {
        if len < LEAF_SLOTS { 1 } else { (len * 5).div_ceil(LEAF_SLOTS * 3) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bounds that are wider for smaller windows are what makes spreading pay.
    #[test]
    fn bounds_widen_from_the_whole_to_a_leaf() {
        for leaves in [2, 3, 7, 64, 65, 100_000] {
            let windows = Windows::new(leaves);
            assert_eq!(windows.most(1, 0), LEAF_SLOTS);
            assert_eq!(windows.fewest(1, 0), LEAF_MIN);
            assert_eq!(windows.most_of_all(), leaves * LEAF_SLOTS * 3 / 4);
            for level in 0..windows.height() {
                let wide = 1 << (level + 1);
                assert!(2 * windows.most(wide / 2, level) >= windows.most(wide, level + 1));
                assert!(2 * windows.fewest(wide / 2, level) <= windows.fewest(wide, level + 1) + 1);
            }
            let target = Windows::leaves_for(windows.most_of_all() + 1);
            assert!(target > leaves, "{leaves}");
            let target = Windows::leaves_for(windows.fewest_of_all());
            assert!(target < leaves, "{leaves} {target}");
            assert_eq!(windows.around(leaves - 1, windows.height()), 0..leaves);
        }
        assert_eq!(Windows::new(1).most_of_all(), LEAF_SLOTS);
    }
}
