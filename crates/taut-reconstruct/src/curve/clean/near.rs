//! Nearest sites with conditions, by the tree of boxes.
//!
//! *Problem.* For every site the nearest other one, among all or among those that a rule accepts.
//! *Idea.* Sites are in Hilbert order: the own leaf and the two beside it give a bound that is almost always the right one; a
//! descent from the root confirms or betters it.
//! *Guarantee.* The first in the order (squared distance in double precision, then coordinates): no cap on how many candidates
//! are looked at, and the answer does not depend on the order of the input.

use crate::curve::boxes::{Bounds, Boxes, FAN};

/// Sites in Hilbert order with the tree over them.
pub(super) struct Near<'a> {
    pub(super) sites: &'a [[f64; 2]],
    boxes: Boxes,
}

/// The squared distance, the same from either end.
#[inline(always)]
pub(super) fn distance2(p: [f64; 2], q: [f64; 2]) -> f64 {
    let (dx, dy) = (p[0] - q[0], p[1] - q[1]);
    dx * dx + dy * dy
}

impl<'a> Near<'a> {
    pub(super) fn new(sites: &'a [[f64; 2]]) -> Self {
        Self { sites, boxes: Boxes::over(sites.len(), |i| Bounds::of(sites[i])) }
    }

    /// The nearest site other than `from` that is accepted.
    #[inline(always)]
    pub(super) fn nearest(&self, from: u32, accept: impl Fn(u32) -> bool) -> Option<u32> {
        let p = self.sites[from as usize];
        let (mut found, mut at) = (None, [f64::INFINITY; 2]);
        let mut scan = |leaf: usize, mut bound: f64| {
            for i in self.boxes.leaf(leaf) {
                let q = self.sites[i];
                let d2 = distance2(p, q);
                let first = d2 < bound || d2 == bound && (found.is_none() || q < at);
                if first && i != from as usize && accept(i as u32) {
                    (bound, found, at) = (d2, Some(i as u32), q);
                }
            }
            bound
        };
        let own = from as usize / FAN;
        let beside = own.saturating_sub(1)..(own + 2).min(self.boxes.leaves());
        let mut bound = scan(own, f64::INFINITY);
        for leaf in beside.clone() {
            if leaf != own {
                bound = scan(leaf, bound);
            }
        }
        self.boxes.nearest(
            bound,
            |b| b.distance2(p),
            |leaf, bound| if beside.contains(&leaf) { bound } else { scan(leaf, bound) },
        );
        found
    }

    /// Whether some site lies nearer to a point than the square root of `reach2`.
    pub(super) fn any_within(&self, point: [f64; 2], reach2: f64) -> bool {
        let mut found = false;
        self.boxes.nearest(
            reach2,
            |b| b.distance2(point),
            |leaf, bound| {
                found |= self.boxes.leaf(leaf).any(|i| distance2(point, self.sites[i]) < reach2);
                if found { f64::NEG_INFINITY } else { bound }
            },
        );
        found
    }
}
