//! The k nearest of a set of points.
//!
//! *Idea.* A k-d tree without pointers: of each range of the points the middle one along the longest side of its box is in the middle,
//! the lower ones before it, the higher ones after it.
//! *Guarantee.* Equal distances are ordered by coordinates, so what is found depends on the points alone. O(n log n) to build.

use rayon::prelude::*;

use super::spheres::{Point, dot, minus};

/// Ranges of up to this many points are looked through.
const FEW: usize = 8;
/// Ranges of more points are divided by two threads.
const TASK: usize = 1 << 13;

/// A tree over points.
pub(super) struct Tree<'a> {
    points: &'a [Point],
    /// The points, arranged.
    order: Vec<u32>,
    /// Of the middle of each range, along which axis it is.
    axes: Vec<u8>,
}

/// A point with the square of its distance.
pub(super) type Near = (f64, u32);

impl<'a> Tree<'a> {
    pub(super) fn of(points: &'a [Point]) -> Self {
        let mut order: Vec<u32> = (0..points.len() as u32).collect();
        let mut axes = vec![0; points.len()];
        arrange(points, &mut order, &mut axes);
        Self { points, order, axes }
    }

    /// The `count` points nearest to one, the nearest first; itself among them.
    pub(super) fn nearest(&self, to: Point, count: usize, found: &mut Vec<Near>) {
        found.clear();
        self.search(0, self.order.len(), to, count, found);
    }

    fn search(&self, begin: usize, end: usize, to: Point, count: usize, found: &mut Vec<Near>) {
        if end - begin <= FEW {
            self.order[begin..end].iter().for_each(|&point| self.offer(point, to, count, found));
            return;
        }
        let middle = begin + (end - begin) / 2;
        let axis = self.axes[middle] as usize;
        let beyond = to[axis] - self.points[self.order[middle] as usize][axis];
        let sides = [(begin, middle), (middle + 1, end)];
        let [near, far] = if beyond < 0.0 { sides } else { [sides[1], sides[0]] };
        self.search(near.0, near.1, to, count, found);
        self.offer(self.order[middle], to, count, found);
        if found.len() < count || beyond * beyond <= found[found.len() - 1].0 {
            self.search(far.0, far.1, to, count, found);
        }
    }

    fn offer(&self, point: u32, to: Point, count: usize, found: &mut Vec<Near>) {
        let at = |point: u32| self.points[point as usize];
        let off = minus(at(point), to);
        let square = dot(off, off);
        let is_before =
            |other: &Near| other.0 < square || other.0 == square && at(other.1) <= at(point);
        let place = found.partition_point(is_before);
        if place < count {
            found.truncate(count - 1);
            found.insert(place, (square, point));
        }
    }
}

fn arrange(points: &[Point], order: &mut [u32], axes: &mut [u8]) {
    if order.len() <= FEW {
        return;
    }
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for point in &*order {
        for k in 0..3 {
            let x = points[*point as usize][k];
            (low[k], high[k]) = (low[k].min(x), high[k].max(x));
        }
    }
    let side = |k: usize| high[k] - low[k];
    let axis = (1..3).fold(0, |best, k| if side(k) > side(best) { k } else { best });
    let middle = order.len() / 2;
    let along = |point: u32| points[point as usize][axis];
    order.select_nth_unstable_by(middle, |&a, &b| along(a).total_cmp(&along(b)));
    axes[middle] = axis as u8;
    let is_large = order.len() > TASK;
    let (lower, rest) = order.split_at_mut(middle);
    let (axes_lower, axes_rest) = axes.split_at_mut(middle);
    let (upper, axes_upper) = (&mut rest[1..], &mut axes_rest[1..]);
    if is_large {
        rayon::join(|| arrange(points, lower, axes_lower), || arrange(points, upper, axes_upper));
    } else {
        arrange(points, lower, axes_lower);
        arrange(points, upper, axes_upper);
    }
}

/// For each point something of its nearest neighbours, on all threads.
pub(super) fn of_neighbors<R: Send>(
    points: &[Point],
    count: usize,
    of: impl Fn(usize, &[Near]) -> R + Sync,
) -> Vec<R> {
    let tree = Tree::of(points);
    let each = |found: &mut Vec<Near>, point: usize| {
        tree.nearest(points[point], count, found);
        of(point, found)
    };
    (0..points.len()).into_par_iter().with_min_len(1 << 8).map_init(Vec::new, each).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_are_found() {
        let mut state = 1u64;
        let mut number = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            // Few places, so that distances are often equal.
            (state >> 60) as f64
        };
        let mut points: Vec<Point> = (0..600).map(|_| [number(), number(), number()]).collect();
        points.sort_unstable_by(|a, b| a.partial_cmp(b).expect("numbers"));
        points.dedup();
        let tree = Tree::of(&points);
        let mut found = Vec::new();
        for &to in points.iter().step_by(17) {
            tree.nearest(to, 9, &mut found);
            let square = |point: &u32| {
                dot(minus(points[*point as usize], to), minus(points[*point as usize], to))
            };
            let mut all: Vec<u32> = (0..points.len() as u32).collect();
            all.sort_by(|a, b| square(a).total_cmp(&square(b)));
            let places: Vec<u32> = found.iter().map(|near| near.1).collect();
            // Points are sorted, so the stable sort leaves equal distances in the order of coordinates.
            assert_eq!(places, all[..9]);
        }
    }
}
