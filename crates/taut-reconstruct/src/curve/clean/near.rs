//! Nearest sites with conditions, by the tree of boxes.
//!
//! *Problem.* For every site the nearest other one, among all or among those that a rule accepts.
//! *Idea.* Sites are in Hilbert order: the own leaf and the two beside it give a bound that is almost always the right one; a
//! descent from the root confirms or betters it.
//! *Guarantee.* The first in the order (squared distance in double precision, then coordinates): no cap on how many candidates
//! are looked at, and the answer does not depend on the order of the input.

use rayon::prelude::*;

use crate::curve::boxes::{Bounds, Boxes, FAN_OUT};

/// Stands for no site.
pub(in crate::curve) const NONE: u32 = u32::MAX;

/// Sites in Hilbert order with the tree over them.
pub(in crate::curve) struct Near<'a> {
    pub(in crate::curve) sites: &'a [[f64; 2]],
    boxes: Boxes,
}

/// The squared distance, the same from either end.
#[inline(always)]
pub(in crate::curve) fn distance2(p: [f64; 2], q: [f64; 2]) -> f64 {
    let (dx, dy) = (p[0] - q[0], p[1] - q[1]);
    dx * dx + dy * dy
}

impl<'a> Near<'a> {
    pub(in crate::curve) fn new(sites: &'a [[f64; 2]]) -> Self {
        Self { sites, boxes: Boxes::over(sites.len(), |i| Bounds::of(sites[i])) }
    }

    /// For each wanted site the nearest other one, if there is one; [`NONE`] for all others.
    ///
    /// `rank(p)(q, d²)` is d², or infinite where q will not do for p: a choice of numbers, as a branch would be guessed wrong every
    /// other time. `admits(p)(box)` is whether the box can hold something that will do. One descent serves all sites of a leaf.
    pub(in crate::curve) fn nearest<R, A>(
        &self,
        wanted: impl Fn(u32) -> bool + Sync,
        rank: impl Fn(u32) -> R + Sync,
        admits: impl Fn(u32) -> A + Sync,
    ) -> Vec<u32>
    where
        R: Fn([f64; 2], f64) -> f64,
        A: Fn(&Bounds) -> bool,
    {
        let mut nearest = vec![NONE; self.sites.len()];
        nearest.par_chunks_mut(FAN_OUT).enumerate().with_min_len(1 << 9).for_each(
            |(leaf, found)| {
                let first = (leaf * FAN_OUT) as u32;
                let mut seekers = [Seeker::default(); FAN_OUT];
                let mut count = 0;
                for site in first..first + found.len() as u32 {
                    if wanted(site) {
                        seekers[count] = Seeker { site, ..Seeker::default() };
                        count += 1;
                    }
                }
                self.seek(leaf, &mut seekers[..count], &rank, &admits);
                for seeker in &seekers[..count] {
                    found[(seeker.site - first) as usize] = seeker.found;
                }
            },
        );
        nearest
    }

    fn seek<R, A>(
        &self,
        own: usize,
        seekers: &mut [Seeker],
        rank: &impl Fn(u32) -> R,
        admits: &impl Fn(u32) -> A,
    ) where
        R: Fn([f64; 2], f64) -> f64,
        A: Fn(&Bounds) -> bool,
    {
        let beside = own.saturating_sub(1)..(own + 2).min(self.boxes.leaves());
        for seeker in seekers.iter_mut() {
            let rank = rank(seeker.site);
            for leaf in [own].into_iter().chain(beside.clone().filter(|&leaf| leaf != own)) {
                seeker.scan(self, leaf, &rank);
            }
        }
        let other = |leaf: usize| !beside.contains(&leaf);
        // A site whose bound is wide beside the leaf looks around alone: it must not send the others far.
        let size2 = self.boxes.leaf_bounds(own).diagonal2();
        let (mut around, mut reach2) = (Bounds::EMPTY, f64::NEG_INFINITY);
        for seeker in seekers.iter_mut() {
            let p = self.sites[seeker.site as usize];
            if seeker.bound > size2 {
                let (rank, admits) = (rank(seeker.site), admits(seeker.site));
                self.boxes.nearest(
                    seeker.bound,
                    |b| if admits(b) { b.distance2(p) } else { f64::NAN },
                    |leaf, _| {
                        if other(leaf) {
                            seeker.scan(self, leaf, &rank);
                        }
                        seeker.bound
                    },
                );
            } else {
                around = around.join(Bounds::of(p));
                reach2 = reach2.max(seeker.bound);
            }
        }
        self.boxes.nearest(
            reach2,
            |b| b.apart2(&around),
            |leaf, bound| {
                for seeker in seekers.iter_mut().filter(|_| other(leaf)) {
                    let p = self.sites[seeker.site as usize];
                    if self.boxes.leaf_bounds(leaf).distance2(p) <= seeker.bound {
                        seeker.scan(self, leaf, &rank(seeker.site));
                    }
                }
                bound
            },
        );
    }

    /// The site nearest to a point, if it is nearer than the square root of `reach2`.
    pub(super) fn nearest_within(&self, point: [f64; 2], reach2: f64) -> Option<u32> {
        let mut found = None;
        self.boxes.nearest(
            reach2,
            |b| b.distance2(point),
            |leaf, mut bound| {
                for i in self.boxes.leaf(leaf) {
                    let d2 = distance2(point, self.sites[i]);
                    if d2 < bound {
                        (bound, found) = (d2, Some(i as u32));
                    }
                }
                bound
            },
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

/// A site and what it found so far.
#[derive(Clone, Copy)]
struct Seeker {
    site: u32,
    found: u32,
    /// The squared distance of what was found.
    bound: f64,
}

impl Default for Seeker {
    fn default() -> Self {
        Self { site: NONE, found: NONE, bound: f64::INFINITY }
    }
}

impl Seeker {
    /// Looks at the sites of a leaf.
    #[inline(always)]
    fn scan(&mut self, near: &Near<'_>, leaf: usize, rank: &impl Fn([f64; 2], f64) -> f64) {
        let p = near.sites[self.site as usize];
        for i in near.boxes.leaf(leaf) {
            let q = near.sites[i];
            let d2 = distance2(p, q);
            if d2 > self.bound {
                continue;
            }
            let d2 = rank(q, d2);
            if d2 <= self.bound && i as u32 != self.site && d2 < f64::INFINITY {
                let first = d2 < self.bound || q < near.sites[self.found as usize];
                if first {
                    (self.bound, self.found) = (d2, i as u32);
                }
            }
        }
    }
}
