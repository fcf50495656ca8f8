//! Neighbours of any place among points that are sorted along a Hilbert curve.
//!
//! Idea: runs of consecutive points are compact, so the boxes of runs of 16, of 16·8, of 16·8·8, … are a tree without pointers.
//! Guarantee: answers are exact; equal distances go to the smaller number, so answers do not depend on how the search goes.

/// Points in a leaf.
const LEAF: usize = 16;
/// Boxes under a box.
const FAN: usize = 8;

type Point = [f64; 2];

/// The smallest box around some points.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    low: Point,
    high: Point,
}

impl Bounds {
    const NOTHING: Self = Self { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };

    fn with(self, other: Self) -> Self {
        let mut sum = self;
        for i in 0..2 {
            sum.low[i] = sum.low[i].min(other.low[i]);
            sum.high[i] = sum.high[i].max(other.high[i]);
        }
        sum
    }

    /// The square of the distance of a place from the box.
    #[inline]
    fn distance2(&self, at: Point) -> f64 {
        let apart = |i: usize| (self.low[i] - at[i]).max(at[i] - self.high[i]).max(0.0);
        let (dx, dy) = (apart(0), apart(1));
        dx * dx + dy * dy
    }
}

/// A tree of boxes over points in the order of a Hilbert curve.
#[derive(Clone, Debug)]
pub(super) struct Index<'a> {
    points: &'a [Point],
    /// The boxes by level, leaves first; the last level has one box, unless there are no points.
    levels: Vec<Vec<Bounds>>,
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
        let around = |points: &[Point]| {
            points.iter().fold(Bounds::NOTHING, |sum, &p| sum.with(Bounds { low: p, high: p }))
        };
        let mut levels: Vec<Vec<Bounds>> = vec![points.chunks(LEAF).map(around).collect()];
        while let Some(below) = levels.last().filter(|below| below.len() > 1) {
            let join = |boxes: &[Bounds]| boxes.iter().fold(Bounds::NOTHING, |sum, &b| sum.with(b));
            let above = below.chunks(FAN).map(join).collect();
            levels.push(above);
        }
        Self { points, levels }
    }

    /// Calls `visit` with the numbers of the points at most √`radius2` away, in ascending order.
    pub(super) fn within(&self, at: Point, radius2: f64, visit: &mut impl FnMut(u32)) {
        if !self.points.is_empty() {
            self.descend(self.levels.len() - 1, 0, at, radius2, visit);
        }
    }

    fn descend(
        &self,
        level: usize,
        node: usize,
        at: Point,
        radius2: f64,
        visit: &mut impl FnMut(u32),
    ) {
        if self.levels[level][node].distance2(at) > radius2 {
            return;
        }
        if level == 0 {
            let first = node * LEAF;
            let last = self.points.len().min(first + LEAF);
            for (k, &point) in self.points[first..last].iter().enumerate() {
                if distance2(point, at) <= radius2 {
                    visit((first + k) as u32);
                }
            }
            return;
        }
        let last = self.levels[level - 1].len().min((node + 1) * FAN);
        for child in node * FAN..last {
            self.descend(level - 1, child, at, radius2, visit);
        }
    }

    /// The `k` points nearest to a place with the squares of their distances, nearest first, in `found`; fewer where there are no
    /// more. What is in `found` already is taken as candidates: points near the place save most of the search.
    pub(super) fn nearest(&self, at: Point, k: usize, found: &mut Vec<(f64, u32)>) {
        if !self.points.is_empty() && k > 0 {
            self.approach(self.levels.len() - 1, 0, at, k, found);
        }
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

    fn approach(
        &self,
        level: usize,
        node: usize,
        at: Point,
        k: usize,
        found: &mut Vec<(f64, u32)>,
    ) {
        if level == 0 {
            let first = node * LEAF;
            let last = self.points.len().min(first + LEAF);
            for (offset, &point) in self.points[first..last].iter().enumerate() {
                insert(found, k, (distance2(point, at), (first + offset) as u32));
            }
            return;
        }
        let first = node * FAN;
        let last = self.levels[level - 1].len().min(first + FAN);
        let mut order = [(f64::INFINITY, 0); FAN];
        let children = &mut order[..last - first];
        for (slot, child) in children.iter_mut().zip(first..last) {
            *slot = (self.levels[level - 1][child].distance2(at), child);
        }
        // The nearest box first, as that brings the bound down; of eight it is found faster than they are sorted.
        loop {
            let mut next = 0;
            for (i, slot) in children.iter().enumerate() {
                if slot.0 < children[next].0 {
                    next = i;
                }
            }
            let (distance2, child) = children[next];
            // A box at the very distance may hold an equally near point of a smaller number.
            if distance2 == f64::INFINITY || found.len() == k && distance2 > found[k - 1].0 {
                break;
            }
            children[next].0 = f64::INFINITY;
            self.approach(level - 1, child, at, k, found);
        }
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
