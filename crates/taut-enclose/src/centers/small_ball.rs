//! The exact smallest ball of a few items: points, points with weights, balls.
//!
//! *Problem.* Items p₁…pₘ, mostly two to twenty: the center c that minimizes the largest reach, |pᵢ − c| or wᵢ|pᵢ − c| or
//! |pᵢ − c| + rᵢ. A search asks for it again and again, each time with one item more.
//! *Idea.* The ball is that of its support, at most d + 1 items whose centers it holds in their hull: c = Σβᵢpᵢ, β ≥ 0. An
//! item q outside is in the support of the ball of the old support and q, so that one is among the balls through q and some of
//! the old support ([`spheres`]): for up to four of these all are tried, and the one from whose center the others reach least
//! far is taken. Then the farthest of all items enters, until none is outside. The radius grows with each. Larger supports, and
//! what rounding leaves open, are for [`active_set`].
//! *Guarantee.* At any moment the ball is that of some of its items, and β proves a lower bound on its radius
//! ([`Ball::lower_bound`]) whatever rounding did before: for points of weight w, R² ≥ Σβᵢ|pᵢ − c|² / Σβᵢ/wᵢ² with c = Σβᵢpᵢ.
//! *Trap.* Balls through nearly dependent items have centers far away and weights of any sign; they are not judged by these
//! but by how far the others reach, and so never taken in place of a smaller one.
//! *Reference.* The loop is that of Gärtner, Fast and robust smallest enclosing balls, ESA 1999; that an entering item stays in
//! the support holds for balls, too (Fischer and Gärtner, SoCG 2003), where Welzl's recursion does not.

mod active_set;
mod low_dimension;
mod spheres;
#[cfg(test)]
mod tests;

use super::items::{ItemSet, Position, Shape, square};
pub(super) use spheres::Workspace;

/// Rounding may add this to a reach; in parts of the radius.
pub(super) const REACH_TOLERANCE: f64 = 1e-13;
/// After this many items that make the radius grow by no more than rounding, nothing else is left. One may do so without being the last: a
/// point outside by δ raises the radius by δ²/2 where it lies across a diameter, and the next may raise it by δ.
pub(super) const STALLS_MAX: u32 = 4;
/// Of supports up to this size all subsets are tried.
const ALL_SUBSETS_MAX: usize = 4;

/// A smallest ball, with what proves it.
#[derive(Clone, Debug)]
pub(super) struct Ball<P> {
    pub(super) center: P,
    pub(super) radius: f64,
    /// Items that determine it.
    pub(super) support: Vec<u32>,
    /// β, one for each of the support, of sum 1.
    pub(super) shares: Vec<f64>,
}

impl<P: Position> Ball<P> {
    pub(super) fn of_one(items: &ItemSet<P>, item: u32) -> Self {
        let at = item as usize;
        let (center, radius) = (items.position(at), items.radius(at));
        Ball { center, radius, support: vec![item], shares: vec![1.0] }
    }

    pub(super) fn of_all(items: &ItemSet<P>, members: &[u32], work: &mut Workspace<P>) -> Self {
        let mut ball = Ball::of_one(items, members[0]);
        ball.grow(items, members, members[0], f64::INFINITY, work);
        ball
    }

    /// A copy, in the memory of a ball that is not needed any more, if there is one.
    pub(super) fn copied_into(&self, spare: Option<Self>) -> Self {
        let Some(mut copy) = spare else { return self.clone() };
        copy.center.clone_from(&self.center);
        copy.radius = self.radius;
        copy.support.clone_from(&self.support);
        copy.shares.clone_from(&self.shares);
        copy
    }

    /// Returns true if an item is inside, but for rounding.
    #[inline(always)]
    pub(super) fn holds(&self, items: &ItemSet<P>, item: u32) -> bool {
        items.reach(item as usize, &self.center) <= self.radius * (1.0 + REACH_TOLERANCE)
    }

    /// Makes it the ball of `members`, whose ball or a part of whose it is, and of `more`; once its radius is at least `limit` it
    /// may stay that of a part of them.
    pub(super) fn grow(
        &mut self,
        items: &ItemSet<P>,
        members: &[u32],
        more: u32,
        limit: f64,
        work: &mut Workspace<P>,
    ) {
        let mut entering = more;
        if self.holds(items, more) {
            match self.farthest_outside(items, members, more) {
                Some((item, _)) => entering = item,
                None => return,
            }
        }
        let mut stalls = 0;
        loop {
            let before = self.radius;
            if self.support.len() > ALL_SUBSETS_MAX || !self.enter(items, entering, work) {
                let active_set = &mut work.active_set;
                return active_set.grow(items, self, entering, members, more, limit);
            }
            if self.radius >= limit {
                return;
            }
            let Some((item, reach)) = self.farthest_outside(items, members, more) else { return };
            stalls += u32::from(self.radius <= before * (1.0 + REACH_TOLERANCE));
            if stalls > STALLS_MAX || self.support.contains(&item) {
                self.radius = self.radius.max(reach);
                return;
            }
            entering = item;
        }
    }

    fn farthest_outside(
        &self,
        items: &ItemSet<P>,
        members: &[u32],
        more: u32,
    ) -> Option<(u32, f64)> {
        let mut farthest = None;
        let mut most = self.radius * (1.0 + REACH_TOLERANCE);
        // Points whose squared distance is no more than this are no farther: it spares their roots.
        let no_farther = |most: f64| match items.shape() {
            Shape::Points if (most * most).is_normal() => most * most * (1.0 - 4.0 * f64::EPSILON),
            _ => f64::NEG_INFINITY,
        };
        let mut skipped = no_farther(most);
        for &item in members.iter().chain(&[more]) {
            let square = square(items.at(item as usize), self.center.as_ref());
            if square <= skipped {
                continue;
            }
            let reach = items.reach_at(item as usize, square.sqrt());
            if reach > most {
                (farthest, most) = (Some((item, reach)), reach);
                skipped = no_farther(most);
            }
        }
        farthest
    }

    /// Makes it the ball of its support and an item outside, by trying all subsets. False where rounding leaves none whose shares
    /// prove it; then it is the smallest found.
    fn enter(&mut self, items: &ItemSet<P>, item: u32, work: &mut Workspace<P>) -> bool {
        work.old.clear();
        work.old.extend_from_slice(&self.support);
        let known = work.old.len();
        let mut least = f64::INFINITY;
        let alone = usize::from(items.shape() != Shape::Balls);
        for size in alone..=known.min(items.dim()) {
            for subset in (0..1u64 << known).filter(|s| s.count_ones() as usize == size) {
                work.through.clear();
                work.through.push(item);
                for (at, &old) in work.old.iter().enumerate() {
                    if subset >> at & 1 == 1 {
                        work.through.push(old);
                    }
                }
                work.spheres_through(items);
                for which in 0..2 {
                    let Some((center, radius)) = &work.spheres[which] else { continue };
                    let reaches = work.old.iter().enumerate().map(|(at, &old)| {
                        if subset >> at & 1 == 1 { 0.0 } else { items.reach(old as usize, center) }
                    });
                    let reach = reaches.fold(*radius, f64::max);
                    if reach < least {
                        least = reach;
                        self.center.clone_from(center);
                        self.radius = reach;
                        self.support.clone_from(&work.through);
                        let is_tight = reach <= radius * (1.0 + REACH_TOLERANCE);
                        work.find_shares(items, which);
                        self.shares.clone_from(&work.shares);
                        if is_tight && self.shares.iter().all(|&share| share >= -REACH_TOLERANCE) {
                            return true;
                        }
                    }
                }
            }
        }
        false
    }

    /// Returns what the shares prove: no ball that holds the support has a smaller radius, but for a few roundings; 0 where they prove
    /// nothing.
    pub(super) fn lower_bound(&self, items: &ItemSet<P>) -> f64 {
        // Items without a share are left out, as their weights may be such that 0 times something is no number.
        let used = || {
            let used = self.support.iter().zip(&self.shares).filter(|(_, share)| **share > 0.0);
            used.map(|(&item, &share)| (item as usize, share))
        };
        let total: f64 = used().map(|(_, share)| share).sum();
        // About an item: far from the origin, the sum itself would be rounded by more than what is proved.
        let first = items.at(self.support[0] as usize);
        let mut center = P::zeros(items.dim());
        let mut mean = 0.0;
        for (item, share) in used() {
            for ((c, x), o) in center.as_mut().iter_mut().zip(items.at(item)).zip(first) {
                *c += share / total * (x - o);
            }
            mean += share / total * items.radius(item);
        }
        let (mut squares, mut weights, mut largest) = (0.0, 0.0, 0.0f64);
        for (item, share) in used() {
            let share = share / total;
            let mut from_center = 0.0;
            for ((c, x), o) in center.as_ref().iter().zip(items.at(item)).zip(first) {
                from_center += ((x - o) - c) * ((x - o) - c);
            }
            let beyond = items.radius(item) - mean;
            squares += share * (from_center - beyond * beyond);
            weights += share / (items.weight(item) * items.weight(item));
            largest = largest.max(items.radius(item));
        }
        let bound = (mean + (squares.max(0.0) / weights).sqrt()).max(largest);
        if bound.is_finite() { bound } else { 0.0 }
    }
}
