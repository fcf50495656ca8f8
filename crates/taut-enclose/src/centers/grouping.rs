//! Groups of items, each of which one ball is to hold whole.
//!
//! *Idea.* A group reaches as far from a center as the farthest of its items, and is served by the center from which that is least.
//! Each has a ball of its own, the smallest; its center stands for the group where a search needs a place.
//! *Guarantee.* Of k + 1 groups each reaching at least D from the centers of the balls of those before it, two share a ball of k;
//! such a ball of radius r holds the center of the ball of the one, and so D ≤ 2r. Farthest-first traversal has the factor of 2 that it
//! has for points.

use super::items::{ItemSet, Position, distance};
use super::small_ball::{Ball, Workspace};

/// Groups by number.
pub(super) struct Grouping<P> {
    /// The group of each item.
    pub(super) of: Vec<u32>,
    /// The items of each group.
    pub(super) members: Vec<Vec<u32>>,
    /// The smallest ball of each.
    pub(super) balls: Vec<Ball<P>>,
}

/// How a group is served.
#[derive(Clone, Copy, Debug)]
pub(super) struct Served {
    /// The center from which it reaches least far, the first of several; 0 where there is none.
    pub(super) center: usize,
    /// Its item that is farthest from there, the first of several.
    pub(super) item: u32,
    pub(super) reach: f64,
}

impl<P: Position> Grouping<P> {
    /// Groups of the items, given the number of each item's group.
    pub(super) fn new(items: &ItemSet<P>, of: Vec<u32>) -> Self {
        let count = of.iter().max().map_or(0, |&last| last as usize + 1);
        let mut members = vec![vec![]; count];
        for (item, &group) in (0..).zip(&of) {
            members[group as usize].push(item);
        }
        let mut work = Workspace::new(items.dim());
        let balls = members.iter().map(|members| Ball::of_all(items, members, &mut work)).collect();
        Grouping { of, members, balls }
    }

    /// Number of groups.
    pub(super) fn len(&self) -> usize {
        self.members.len()
    }

    /// The item of a group that reaches farthest from a center, the first of several, and how far; the search may end with one
    /// that reaches `enough`.
    pub(super) fn farthest_in(
        &self,
        items: &ItemSet<P>,
        group: usize,
        center: &P,
        enough: f64,
    ) -> (u32, f64) {
        let mut farthest = (self.members[group][0], f64::NEG_INFINITY);
        for &item in &self.members[group] {
            let reach = items.reach(item as usize, center);
            if reach > farthest.1 {
                farthest = (item, reach);
                if reach >= enough {
                    break;
                }
            }
        }
        farthest
    }

    /// How a group is served by centers.
    pub(super) fn served(&self, items: &ItemSet<P>, group: usize, centers: &[P]) -> Served {
        let mut served = Served { center: 0, item: self.members[group][0], reach: f64::INFINITY };
        // The nearest center is likely the best, which ends the look at others early.
        let place = self.balls[group].center.as_ref();
        let near = |a: &usize, b: &usize| {
            let distance = |j: usize| distance(place, centers[j].as_ref());
            distance(*a).total_cmp(&distance(*b))
        };
        let Some(first) = (0..centers.len()).min_by(near) else { return served };
        let (item, reach) = self.farthest_in(items, group, &centers[first], f64::INFINITY);
        served = Served { center: first, item, reach };
        for (center, place) in centers.iter().enumerate().filter(|(center, _)| *center != first) {
            let enough = if center < served.center { served.reach.next_up() } else { served.reach };
            let (item, reach) = self.farthest_in(items, group, place, enough);
            if reach < enough {
                served = Served { center, item, reach };
            }
        }
        served
    }

    /// The items of two groups.
    pub(super) fn union(&self, a: usize, b: usize) -> Vec<u32> {
        [&self.members[a][..], &self.members[b]].concat()
    }
}
