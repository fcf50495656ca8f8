//! A packed tree of boxes over things that already come in Hilbert order.
//!
//! *Problem.* Curves fill a vanishing part of the plane, so a uniform grid over them is either empty or crowded.
//! *Idea.* Items along a Hilbert curve are near their neighbors in memory: eight in a row make a leaf, eight leaves a node, up to
//! one root. Nothing is sorted and no pointer is kept; a level is an array of boxes.
//! *Guarantee.* The lower bounds that prune are computed with the same roundings as distances of points and are monotone in
//! them: no item within the bound, ties included, is passed over. 4.6 bytes an item.
//! *Reference.* Kamel and Faloutsos 1993, the packed Hilbert R-tree.

use std::ops::Range;

use taut_points::parallel::IntoParallel;

/// A leaf has at most this many items, and a node at most this many children.
pub(super) const FAN_OUT: usize = 8;
/// Boxes that one task makes.
const TASK: usize = 1 << 12;

/// Low x, low y, high x, high y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds(pub(super) [f64; 4]);

impl Bounds {
    /// Holds nothing.
    pub(super) const EMPTY: Self =
        Self([f64::INFINITY, f64::INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY]);

    /// The box of one point.
    pub(super) fn of([x, y]: [f64; 2]) -> Self {
        Self([x, y, x, y])
    }

    /// The smallest box around both.
    #[inline(always)]
    pub(super) fn join(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0].min(b[0]), a[1].min(b[1]), a[2].max(b[2]), a[3].max(b[3])])
    }

    /// Whether they have a point in common.
    #[inline(always)]
    pub(super) fn meets(&self, other: &Self) -> bool {
        let (a, b) = (self.0, other.0);
        a[0] <= b[2] && b[0] <= a[2] && a[1] <= b[3] && b[1] <= a[3]
    }

    /// The squared distance of a point from the box.
    #[inline(always)]
    pub(super) fn distance2(&self, [x, y]: [f64; 2]) -> f64 {
        let b = self.0;
        let dx = (b[0] - x).max(x - b[2]).max(0.0);
        let dy = (b[1] - y).max(y - b[3]).max(0.0);
        dx * dx + dy * dy
    }

    /// The squared distance of its corners.
    pub(super) fn diagonal2(&self) -> f64 {
        let [x, y, right, top] = self.0;
        (right - x) * (right - x) + (top - y) * (top - y)
    }

    /// The squared distance of two boxes.
    #[inline(always)]
    pub(super) fn apart2(&self, other: &Self) -> f64 {
        let (a, b) = (self.0, other.0);
        let dx = (b[0] - a[2]).max(a[0] - b[2]).max(0.0);
        let dy = (b[1] - a[3]).max(a[1] - b[3]).max(0.0);
        dx * dx + dy * dy
    }
}

/// The tree.
#[derive(Clone, Debug)]
pub(super) struct Boxes {
    items: usize,
    /// From leaves to the root.
    levels: Vec<Vec<Bounds>>,
}

impl Boxes {
    /// The tree over items with these boxes.
    pub(super) fn over(items: usize, bounds: impl Fn(usize) -> Bounds + Sync) -> Self {
        let joined = |len: usize, of: &(dyn Fn(usize) -> Bounds + Sync)| -> Vec<Bounds> {
            (0..len.div_ceil(FAN_OUT))
                .into_par_iter()
                .with_min_len(TASK)
                .map(|node| {
                    (node * FAN_OUT..len.min(node * FAN_OUT + FAN_OUT))
                        .fold(Bounds::EMPTY, |sum, i| sum.join(of(i)))
                })
                .collect()
        };
        let mut levels = vec![joined(items, &bounds)];
        while levels.last().is_some_and(|level| level.len() > 1) {
            let below = &levels[levels.len() - 1];
            let above = joined(below.len(), &|i| below[i]);
            levels.push(above);
        }
        Self { items, levels }
    }

    /// The items of a leaf.
    pub(super) fn leaf(&self, leaf: usize) -> Range<usize> {
        leaf * FAN_OUT..self.items.min(leaf * FAN_OUT + FAN_OUT)
    }

    /// How many leaves there are.
    pub(super) fn leaves(&self) -> usize {
        self.levels[0].len()
    }

    /// The box of a leaf.
    pub(super) fn leaf_bounds(&self, leaf: usize) -> &Bounds {
        &self.levels[0][leaf]
    }

    /// Visits leaves, near ones first, as long as `lower` of their box is at most `bound`. What `visit` returns is the bound
    /// from then on.
    pub(super) fn nearest(
        &self,
        bound: f64,
        lower: impl Fn(&Bounds) -> f64,
        mut visit: impl FnMut(usize, f64) -> f64,
    ) {
        if self.items > 0 {
            let mut bound = bound;
            self.descend(self.levels.len() - 1, 0, &mut bound, &lower, &mut visit);
        }
    }

    fn descend(
        &self,
        level: usize,
        node: usize,
        bound: &mut f64,
        lower: &impl Fn(&Bounds) -> f64,
        visit: &mut impl FnMut(usize, f64) -> f64,
    ) {
        if level == 0 {
            *bound = visit(node, *bound);
            return;
        }
        let below = &self.levels[level - 1];
        let first = node * FAN_OUT;
        let (mut open, mut count) = ([(0.0, 0); FAN_OUT], 0);
        for (i, bounds) in below[first..below.len().min(first + FAN_OUT)].iter().enumerate() {
            let key = lower(bounds);
            if key <= *bound {
                let mut place = count;
                while place > 0 && open[place - 1].0 > key {
                    open[place] = open[place - 1];
                    place -= 1;
                }
                open[place] = (key, first + i);
                count += 1;
            }
        }
        for &(key, child) in &open[..count] {
            if key <= *bound {
                self.descend(level - 1, child, bound, lower, visit);
            }
        }
    }

    /// Visits leaves in their order, those whose boxes, and the boxes above them, are wanted.
    pub(super) fn in_order(
        &self,
        wanted: &impl Fn(&Bounds) -> bool,
        visit: &mut impl FnMut(usize),
    ) {
        if self.items > 0 {
            self.walk(self.levels.len() - 1, 0, wanted, visit);
        }
    }

    fn walk(
        &self,
        level: usize,
        node: usize,
        wanted: &impl Fn(&Bounds) -> bool,
        visit: &mut impl FnMut(usize),
    ) {
        match level {
            _ if !wanted(&self.levels[level][node]) => (),
            0 => visit(node),
            _ => {
                let children =
                    node * FAN_OUT..self.levels[level - 1].len().min((node + 1) * FAN_OUT);
                children.for_each(|child| self.walk(level - 1, child, wanted, visit));
            }
        }
    }

    /// Visits the leaves whose box meets the given one.
    pub(super) fn meeting(&self, bounds: &Bounds, mut visit: impl FnMut(usize)) {
        let lower = |b: &Bounds| if b.meets(bounds) { 0.0 } else { f64::INFINITY };
        self.nearest(0.0, lower, |leaf, bound| {
            visit(leaf);
            bound
        });
    }
}
