//! Neighbours of any place among points that are sorted along a Hilbert curve.
//!
//! *Guarantee.* Answers are exact; equal distances go to the smaller number, so answers do not depend on how the search goes.

use super::boxes::{Bounds, Boxes};

type Point = [f64; 2];

/// Points in the order of a Hilbert curve with the tree of boxes over them.
#[derive(Clone, Debug)]
pub(super) struct Index<'a> {
    points: &'a [Point],
    boxes: Boxes,
}

/// The square of a distance.
#[inline]
pub(super) fn distance2(a: Point, b: Point) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    dx * dx + dy * dy
}

impl<'a> Index<'a> {
    /// A tree over points that are near in the plane where they are near in number.
    pub(super) fn new(points: &'a [Point]) -> Self {
        Self { points, boxes: Boxes::over(points.len(), |i| Bounds::of(points[i])) }
    }

    /// Calls `visit` with the numbers of the points at most √`radius2` away, in ascending order.
    pub(super) fn within(&self, at: Point, radius2: f64, visit: &mut impl FnMut(u32)) {
        let is_near = |b: &Bounds| b.distance2(at) <= radius2;
        self.boxes.in_order(&is_near, &mut |leaf| {
            for i in self.boxes.leaf(leaf) {
                if distance2(self.points[i], at) <= radius2 {
                    visit(i as u32);
                }
            }
        });
    }

    /// The `k` points nearest to a place with the squares of their distances, nearest first, in `found`; fewer where there are no
    /// more. What is in `found` already is taken as candidates: points near the place save most of the search.
    pub(super) fn nearest(&self, at: Point, k: usize, found: &mut Vec<(f64, u32)>) {
        let bound = |found: &[(f64, u32)]| match found.len() == k {
            true => found[k - 1].0,
            false => f64::INFINITY,
        };
        if k == 0 {
            return;
        }
        // A box at the very distance may hold an equally near point of a smaller number, and is visited.
        self.boxes.nearest(
            bound(found),
            |b| b.distance2(at),
            |leaf, _| {
                for i in self.boxes.leaf(leaf) {
                    insert(found, k, (distance2(self.points[i], at), i as u32));
                }
                bound(found)
            },
        );
    }

    /// The `k` points nearest to point `i`, itself among them, as [`nearest`](Self::nearest) gives them.
    pub(super) fn neighbors(&self, i: usize, k: usize, found: &mut Vec<(f64, u32)>) {
        // Its neighbours in number bound the distance from the start.
        found.clear();
        let first = i.saturating_sub(k).min(self.points.len().saturating_sub(2 * k));
        let last = self.points.len().min(first + 2 * k);
        for (number, &point) in (first..last).zip(&self.points[first..last]) {
            insert(found, k, (distance2(point, self.points[i]), number as u32));
        }
        self.nearest(self.points[i], k, found);
    }
}

/// Puts a candidate in its place among the k best.
#[inline]
fn insert(found: &mut Vec<(f64, u32)>, k: usize, candidate: (f64, u32)) {
    if found.len() == k && candidate >= found[k - 1] {
        return;
    }
    let place = found.iter().rposition(|kept| *kept <= candidate).map_or(0, |p| p + 1);
    // Candidates may come twice.
    if place == 0 || found[place - 1] != candidate {
        found.truncate(k - 1);
        found.insert(place, candidate);
    }
}
