//! Neighbors of any place among points that are sorted along a Hilbert curve.
//!
//! *Guarantee.* Answers are exact; equal distances go to the smaller number, so answers do not depend on how the search goes.

use taut_points::parallel::IntoParallel;

use super::boxes::{Bounds, Boxes, FAN_OUT};

type Point = [f64; 2];

/// The squares of distances with the numbers of points, ascending.
type Found = Vec<(f64, u32)>;

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

/// Memory of [`Index::nearest_to_each`] that is used again.
#[derive(Clone, Debug, Default)]
pub(super) struct Nearest {
    best: Found,
    candidates: Vec<u32>,
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
    pub(super) fn nearest(&self, at: Point, k: usize, found: &mut Found) {
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

    /// What `of` says of the `k` points nearest to each point, itself among them, as [`nearest`](Self::nearest) gives them.
    ///
    /// The leaves that may matter are the same for all points of a leaf, but for a few: they are sought once for all of them. With
    /// a descent for each point this took 1.7 times as long, and a third of the whole fit of a million points.
    pub(super) fn neighbors_of_all<T: Send>(
        &self,
        k: usize,
        of: impl Fn(&[(f64, u32)]) -> T + Sync,
    ) -> Vec<T> {
        let of_leaf = |(found, leaves): &mut (Vec<Found>, Vec<u32>), leaf: usize| {
            let points = self.boxes.leaf(leaf);
            found.resize(FAN_OUT, Vec::new());
            let mut far2 = 0.0f64;
            for (i, found) in points.clone().zip(found.iter_mut()) {
                // Its neighbors in number bound the distance from the start.
                found.clear();
                let first = i.saturating_sub(k).min(self.points.len().saturating_sub(2 * k));
                let last = self.points.len().min(first + 2 * k);
                // Outward from the point: the first are the nearest as a rule, and those that come later are seen to be farther at once.
                self.insert_all(i..last, self.points[i], k, found);
                self.insert_all((first..i).rev(), self.points[i], k, found);
                far2 = far2.max(if found.len() < k { f64::INFINITY } else { found[k - 1].0 });
            }
            leaves.clear();
            let own = self.boxes.leaf_bounds(leaf);
            let is_near = |b: &Bounds| b.apart2(own) <= far2;
            self.boxes.in_order(&is_near, &mut |leaf| leaves.push(leaf as u32));
            for (i, found) in points.clone().zip(found.iter_mut()) {
                for &near in &*leaves {
                    let distance2 = self.boxes.leaf_bounds(near as usize).distance2(self.points[i]);
                    // A box at the very distance may hold an equally near point of a smaller number.
                    if found.len() < k || distance2 <= found[k - 1].0 {
                        self.insert_all(self.boxes.leaf(near as usize), self.points[i], k, found);
                    }
                }
            }
            found[..points.len()].iter().map(|found| of(found)).collect::<Vec<T>>()
        };
        let leaves = if k == 0 { 0 } else { self.boxes.leaves() };
        (0..leaves)
            .into_par_iter()
            .with_min_len(1 << 8)
            .map_init(Default::default, of_leaf)
            .flat_map_iter(|of_leaf| of_leaf)
            .collect()
    }

    /// Puts points in their places among the k best.
    #[inline]
    fn insert_all(
        &self,
        numbers: impl Iterator<Item = usize>,
        at: Point,
        k: usize,
        found: &mut Found,
    ) {
        let mut most = if found.len() < k { f64::INFINITY } else { found[k - 1].0 };
        for number in numbers {
            let distance2 = distance2(self.points[number], at);
            if distance2 <= most {
                insert(found, k, (distance2, number as u32));
                most = if found.len() < k { f64::INFINITY } else { found[k - 1].0 };
            }
        }
    }

    /// Calls `visit` for each of some places, which are near each other as a rule, with the number of the point nearest to it.
    ///
    /// One search for the middle of the box around them names all points that matter.
    pub(super) fn nearest_to_each(
        &self,
        places: &[Point],
        found: &mut Nearest,
        mut visit: impl FnMut(usize, u32),
    ) {
        let around = places.iter().fold(Bounds::EMPTY, |sum, &p| sum.join(Bounds::of(p)));
        let Bounds([left, low, right, high]) = around;
        let middle = [0.5 * (left + right), 0.5 * (low + high)];
        let radius = 0.5 * around.diagonal2().sqrt();
        // The point nearest to the places before is a good candidate.
        if let Some(last) = found.best.first_mut() {
            last.0 = distance2(self.points[last.1 as usize], middle);
        }
        self.nearest(middle, 1, &mut found.best);
        let Some(&(nearest2, _)) = found.best.first() else { return };
        // To the nearest from the middle, from there to the place, and back again; with something for rounding.
        let reach = (nearest2.sqrt() + 2.0 * radius) * (1.0 + 1e-9);
        found.candidates.clear();
        let candidates = &mut found.candidates;
        self.within(middle, reach * reach, &mut |i| candidates.push(i));
        for (number, &place) in places.iter().enumerate() {
            let mut best = (f64::INFINITY, 0);
            for &i in &*candidates {
                let distance2 = distance2(self.points[i as usize], place);
                if distance2 < best.0 {
                    best = (distance2, i);
                }
            }
            visit(number, best.1);
        }
    }
}

/// Puts a candidate in its place among the k best.
#[inline]
fn insert(found: &mut Found, k: usize, candidate: (f64, u32)) {
    let is_after =
        |kept: (f64, u32)| kept.0 > candidate.0 || kept.0 == candidate.0 && kept.1 > candidate.1;
    if found.len() == k && !is_after(found[k - 1]) {
        return;
    }
    let place = found.iter().rposition(|&kept| !is_after(kept)).map_or(0, |p| p + 1);
    // Candidates may come twice.
    if place > 0 && found[place - 1] == candidate {
        return;
    }
    if found.len() < k {
        found.push(candidate);
    }
    // Those after it, a few, move on by one.
    for at in (place + 1..found.len()).rev() {
        found[at] = found[at - 1];
    }
    found[place] = candidate;
}

#[cfg(test)]
mod tests {
    use taut_oblivious::hilbert_order;

    use super::*;

    fn sorted(points: &[Point]) -> Vec<Point> {
        hilbert_order(points.len(), |i| points[i]).iter().map(|&i| points[i as usize]).collect()
    }

    /// Places by a multiplicative hash, on a grid for many equal distances.
    fn some(count: u32, grid: bool) -> Vec<Point> {
        let at = |i: u32| f64::from(i.wrapping_mul(2_654_435_761) >> 12) / f64::from(1 << 20);
        let at = |i: u32| if grid { (at(i) * 20.0).floor() } else { at(i).powi(3) };
        sorted(&(0..count).map(|i| [at(2 * i + 1), at(2 * i + 40_001)]).collect::<Vec<_>>())
    }

    #[test]
    fn neighbors_are_those_of_brute_force() {
        for (count, grid) in
            [(0, false), (1, false), (7, true), (40, true), (700, true), (900, false)]
        {
            let points = some(count, grid);
            let found = Index::new(&points).neighbors_of_all(9, <[_]>::to_vec);
            assert_eq!(found.len(), points.len());
            for (&p, found) in points.iter().zip(found) {
                let mut all: Vec<(f64, u32)> =
                    points.iter().zip(0..).map(|(&q, i)| (distance2(p, q), i)).collect();
                all.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                all.truncate(9);
                assert_eq!(found, all, "{count} {grid}");
            }
        }
    }

    #[test]
    fn the_nearest_to_each_is_that_of_brute_force() {
        for grid in [false, true] {
            let (points, places) = (some(300, grid), some(1000, false));
            let places: Vec<Point> = places.iter().map(|p| p.map(|x| x * 19.0)).collect();
            let (index, mut found) = (Index::new(&points), Nearest::default());
            for run in places.chunks(16) {
                index.nearest_to_each(run, &mut found, |k, nearest| {
                    let to = |i: u32| distance2(points[i as usize], run[k]);
                    assert!(
                        (0..300)
                            .all(|i| to(nearest) < to(i) || to(nearest) == to(i) && nearest <= i)
                    );
                });
            }
        }
    }
}
