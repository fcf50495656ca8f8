//! The kd-tree that the order of the rows follows: from a place to its home block, and how far it is to the cuts on the way.
//!
//! *Idea.* A search for what is near reads the home block first, and then climbs only as far as the distances to the cuts demand:
//! few have to reach the top. The seven cuts between the eight nodes of a group fill one cache line, and are all compared at once, so
//! that no comparison waits for the one before it.
//! *Guarantee.* No row on one side of a cut has a coordinate beyond it, so that every row on the other side of it from a place
//! differs from the place by at least its distance to the cut.

use super::nodes::{FANOUT, Level, Nodes};

/// Levels of a tree of fewer than 2³² rows, at most.
pub(super) const LEVELS_MAX: usize = 10;

/// Axes along which rows are divided: the number of one takes a byte.
pub(super) const AXES_MAX: usize = 1 << u8::BITS;

/// Comparisons of a place with the cuts of a group.
const CUTS: usize = FANOUT - 1;

/// The child for each result of the comparisons.
const CHILDREN: [u8; 1 << CUTS] = {
    let mut children = [0; 1 << CUTS];
    let mut beyond = 0;
    while beyond < children.len() {
        let half = beyond & 1;
        let quarter = 2 * half + (beyond >> (1 + half) & 1);
        children[beyond] = (2 * quarter + (beyond >> (3 + quarter) & 1)) as u8;
        beyond += 1;
    }
    children
};

/// The cuts between the nodes of a group: between its halves, then those of the two halves, then those of the four quarters.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(super) struct Cuts {
    /// Infinite where there is no node beyond.
    at: [f64; CUTS],
    /// The axes of the cuts.
    axes: [u8; FANOUT],
}

impl Cuts {
    /// The cuts between nodes with such boxes: along an axis that has a gap, or where they touch, and there the widest.
    pub(super) fn between(boxes: &[(&[f64], &[f64])]) -> Self {
        let mut cuts = Cuts { at: [f64::INFINITY; CUTS], axes: [0; FANOUT] };
        for cut in 0..CUTS {
            let depth = (cut + 1).ilog2();
            let width = FANOUT >> depth;
            let first = (cut + 1 - (1 << depth)) * width;
            let middle = first + width / 2;
            if middle >= boxes.len() {
                continue;
            }
            let (below, above) =
                (&boxes[first..middle], &boxes[middle..boxes.len().min(first + width)]);
            let gap = |axis: usize| {
                let low =
                    below.iter().fold(f64::NEG_INFINITY, |end, (_, high)| end.max(high[axis]));
                let high = above.iter().fold(f64::INFINITY, |end, (low, _)| end.min(low[axis]));
                (low, high)
            };
            // Halves, as a difference may overflow.
            let size = |(low, high): (f64, f64)| high / 2.0 - low / 2.0;
            let axes = 0..boxes[0].0.len().min(AXES_MAX);
            let widest = axes.map(|axis| (axis, gap(axis))).filter(|(_, (low, high))| low <= high);
            let widest = widest.reduce(|a, b| if size(b.1) > size(a.1) { b } else { a });
            if let Some((axis, (low, high))) = widest {
                cuts.at[cut] = (low / 2.0 + high / 2.0).clamp(low, high);
                cuts.axes[cut] = axis as u8;
            }
        }
        cuts
    }

    /// The child on whose sides of the cuts a place is.
    #[inline(always)]
    fn child(&self, place: &[f64]) -> usize {
        let mut beyond = 0;
        for (cut, at) in self.at.iter().enumerate() {
            beyond |= usize::from(place[usize::from(self.axes[cut])] > *at) << cut;
        }
        usize::from(CHILDREN[beyond])
    }

    /// The distance from a place to the nearest of the three cuts around its child.
    #[inline(always)]
    fn margin(&self, place: &[f64], child: usize) -> f64 {
        let mut least = f64::INFINITY;
        for cut in [0, 1 + child / 4, 3 + child / 2] {
            let distance = (place[usize::from(self.axes[cut])] - self.at[cut]).abs();
            least = if distance < least { distance } else { least };
        }
        least
    }
}

impl Nodes {
    /// The block on whose side of all cuts a place is.
    #[inline(always)]
    pub(super) fn home(&self, place: &[f64]) -> usize {
        let step = |node: usize, level: &Level| node * FANOUT + level.cuts[node].child(place);
        self.levels.iter().rev().fold(0, step)
    }

    /// For each level a lower bound of the distance to rows that are not below the node of that level above the home block.
    #[inline(always)]
    pub(super) fn margins(&self, place: &[f64], home: usize) -> [f64; LEVELS_MAX] {
        let mut margins = [f64::INFINITY; LEVELS_MAX];
        let mut least = f64::INFINITY;
        for (index, level) in self.levels.iter().enumerate().rev() {
            let node = home >> (FANOUT.ilog2() as usize * index);
            let margin = level.cuts[node / FANOUT].margin(place, node % FANOUT);
            least = if margin < least { margin } else { least };
            margins[index] = least;
        }
        margins
    }
}
