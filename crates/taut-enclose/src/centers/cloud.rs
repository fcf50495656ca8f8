//! All items in memory, in cells that let a search look at few of them.
//!
//! *Idea.* Items are put in the order of a k-d tree; the leaves, up to [`LEAF_SIZE`] neighbors each, have a middle and a spread. The
//! farthest item from some centers is sought in the cell whose bound is largest, then in the next, until no bound is larger than
//! what was found: some ten of hundreds of cells. Nearest centers are sought among those that can be nearest for a cell. A second level of
//! larger cells saves nothing: on 15,112 cities most of their bounds are too weak.
//! *Guarantee.* What is found is what a look at all items would find; of equals, the one of the lower row. Nothing depends on
//! threads.
//! *Groups.* Where one ball is to hold all items of a group, the farthest group is sought in place of the farthest item, and all items of
//! a group have one center ([`super::grouping`]). Cells are not used then: each look is at all items.
//! *Trap.* In many dimensions every bound is weak and every cell is opened: as much work as without cells, and little more.

use std::cmp::Ordering;
use std::ops::Range;

use taut_points::{Monitor, OrderBy, ReadError};

use super::avoiding_ball::AvoidingBall;
use super::grouping::Grouping;
use super::items::{ItemSet, Position, Shape, distance, square};
use super::links::Links;
use super::small_ball::{Ball, Workspace};
use crate::Error;

/// A cell has at most this many items. 16 to 64 serve equally well on 15,112 cities.
const LEAF_SIZE: usize = 32;
/// Covers the roundings of a bound.
const BOUND_FACTOR: f64 = 1.0 + 1e-12;
/// Distances whose squares are normal numbers are longer than this.
const SQUARES_MIN: f64 = 1e-150;
/// Up to here a list of the farthest items is kept in order; longer ones are selected from all.
const SHORT_LIST: usize = 256;

/// Items and their cells.
pub(super) struct Cloud<P> {
    pub(super) items: ItemSet<P>,
    pub(super) rows: Vec<u64>,
    cells: Vec<Cell<P>>,
    /// What positions may be off by, in length; 0 for rows as they are given.
    pub(super) place_error: f64,
    /// None where each item stands for itself.
    pub(super) grouping: Option<Grouping<P>>,
    /// True if the rows name groups, even where each has one item and there is no `grouping`. A proof is about groups then, and its checker knows
    /// of a group only the items of the core-set: for all it knows, a group left out has others outside. So no proof asks balls to avoid items
    /// left out, and none is made of nogoods.
    pub(super) is_grouped: bool,
}

struct Cell<P> {
    range: Range<usize>,
    middle: P,
    /// The largest distance of a position from the middle.
    spread: f64,
    /// The largest reach of an item from the middle, but for its weight.
    reach: f64,
    weight: f64,
}

/// An item and how far it reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Far {
    pub(super) item: u32,
    pub(super) reach: f64,
}

/// Items in the order in which they were found farthest from all before, each with how far it reached then.
pub(super) struct Traversal {
    pub(super) items: Vec<u32>,
}

impl<P: Position> Cloud<P> {
    /// `given` in the order of rows, with the number of the group of each, if they are in groups.
    pub(super) fn new(given: ItemSet<P>, groups: &[u32]) -> Self {
        let mut order: Vec<u32> = (0..given.len() as u32).collect();
        let mut ranges = vec![];
        let mut open: Vec<Range<usize>> = Vec::new();
        open.push(0..order.len());
        while let Some(range) = open.pop() {
            if range.len() <= LEAF_SIZE {
                ranges.push(range);
                continue;
            }
            let axis = widest_axis(&given, &order[range.clone()]);
            let half = range.len() / 2;
            order[range.clone()].select_nth_unstable_by(half, |&a, &b| {
                given.at(a as usize)[axis].total_cmp(&given.at(b as usize)[axis]).then(a.cmp(&b))
            });
            open.push(range.start + half..range.end);
            open.push(range.start..range.start + half);
        }
        let mut items = ItemSet::new(given.shape(), given.dim());
        for range in &ranges {
            // Select leaves the order within a part open.
            order[range.clone()].sort_unstable();
        }
        for &row in &order {
            items.push(given.at(row as usize), given.extra(row as usize));
        }
        let cells = ranges.into_iter().map(|range| Cell::new(&items, range)).collect();
        let grouping = (!groups.is_empty()).then(|| {
            let of = order.iter().map(|&row| groups[row as usize]).collect();
            Grouping::new(&items, of)
        });
        let rows = order.into_iter().map(u64::from).collect();
        let is_grouped = grouping.is_some();
        Cloud { items, rows, cells, place_error: 0.0, grouping, is_grouped }
    }

    /// Number of groups; of items where each stands for itself.
    pub(super) fn group_count(&self) -> usize {
        self.grouping.as_ref().map_or(self.len(), Grouping::len)
    }

    /// The group of an item, if items are in groups.
    pub(super) fn group_of(&self, item: u32) -> Option<u32> {
        self.grouping.as_ref().map(|grouping| grouping.of[item as usize])
    }

    /// The groups of items, if items are in groups.
    pub(super) fn links(&self, items: &[u32]) -> Option<Links> {
        let grouping = self.grouping.as_ref()?;
        let mut links = Links::default();
        items.iter().for_each(|&item| links.add(grouping.of[item as usize]));
        Some(links)
    }

    /// Returns true if balls can be asked to avoid the items left out.
    pub(super) fn can_avoid(&self) -> bool {
        !self.is_grouped && AvoidingBall::applies(&self.items)
    }

    /// The items that go where an item goes, itself among them.
    pub(super) fn linked(&self, item: u32) -> Vec<u32> {
        match &self.grouping {
            None => vec![item],
            Some(grouping) => grouping.members[grouping.of[item as usize] as usize].clone(),
        }
    }

    /// The place of an item, or that of its group.
    pub(super) fn place_of(&self, item: u32) -> P {
        match &self.grouping {
            None => self.items.position(item as usize),
            Some(grouping) => grouping.balls[grouping.of[item as usize] as usize].center.clone(),
        }
    }

    /// Items that stand for an item or its group in a core-set: those on the border of its own ball.
    pub(super) fn witnesses(&self, item: u32) -> Vec<u32> {
        match &self.grouping {
            None => vec![item],
            Some(grouping) => grouping.balls[grouping.of[item as usize] as usize].support.clone(),
        }
    }

    /// The smallest ball of the groups of two items.
    pub(super) fn ball_of_pair(&self, a: u32, b: u32) -> Ball<P> {
        let mut work = Workspace::new(self.items.dim());
        let members = match &self.grouping {
            None => vec![a, b],
            Some(grouping) => {
                let group = |item: u32| grouping.of[item as usize] as usize;
                grouping.union(group(a), group(b))
            }
        };
        Ball::of_all(&self.items, &members, &mut work)
    }

    /// A radius that no smaller ball of both items, or of their groups, has; but for rounding.
    pub(super) fn pair_radius(&self, a: u32, b: u32) -> f64 {
        match &self.grouping {
            None => self.items.pair_radius(a as usize, b as usize),
            Some(_) => self.ball_of_pair(a, b).lower_bound(&self.items),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Which of two reaches farther; of equals, the lower row.
    fn order(&self, a: Far, b: Far) -> Ordering {
        let rows = self.rows[a.item as usize].cmp(&self.rows[b.item as usize]);
        b.reach.total_cmp(&a.reach).then(rows)
    }

    /// The `count` items, each of another group, that reach farthest from the nearest center, farthest first; from no center, all reach infinitely far.
    pub(super) fn farthest(&self, centers: &[P], count: usize) -> Vec<Far> {
        if count == 0 {
            return vec![];
        }
        if count > SHORT_LIST || self.grouping.is_some() {
            let mut all: Vec<Far> = Vec::with_capacity(self.group_count());
            match &self.grouping {
                None => self.assign(centers, |item, _, distance| {
                    all.push(Far { item: item as u32, reach: self.items.reach_at(item, distance) });
                }),
                Some(grouping) => all.extend((0..grouping.len()).map(|group| {
                    let served = grouping.served(&self.items, group, centers);
                    Far { item: served.item, reach: served.reach }
                })),
            }
            let count = count.min(all.len());
            if count < all.len() {
                all.select_nth_unstable_by(count, |a, b| self.order(*a, *b));
                all.truncate(count);
            }
            all.order_by(&|a, b| self.order(*a, *b));
            return all;
        }
        let bounds = self.cells.iter().map(|cell| cell.bound(&self.items, centers));
        let mut open: Vec<(f64, u32)> = bounds.zip(0..).collect();
        let mut list: Vec<Far> = Vec::with_capacity(count + 1);
        let mut near = Near::default();
        loop {
            let (mut widest, mut bound) = (0, f64::NEG_INFINITY);
            for (at, &(value, _)) in open.iter().enumerate() {
                if value > bound {
                    (widest, bound) = (at, value);
                }
            }
            if bound == f64::NEG_INFINITY {
                return list;
            }
            let cell = &self.cells[open.remove(widest).1 as usize];
            near.find(cell, centers);
            for item in cell.range.clone() {
                let (_, distance) = near.nearest(self.items.at(item), centers);
                let far = Far { item: item as u32, reach: self.items.reach_at(item, distance) };
                if list.len() == count {
                    if self.order(far, list[count - 1]).is_ge() {
                        continue;
                    }
                    list.pop();
                }
                let place = list.partition_point(|other| self.order(*other, far).is_lt());
                list.insert(place, far);
            }
            // After the first look most cells cannot hold a farther item.
            if list.len() == count {
                let least = list[count - 1].reach;
                open.retain(|&(bound, _)| bound >= least);
            }
        }
    }

    /// Calls `visit(item, nearest center, its distance)` for each item; of equally near centers, the first. Without any center,
    /// that numbered 0 is infinitely far. Items of a group have the center from which the group reaches least far.
    pub(super) fn assign(&self, centers: &[P], mut visit: impl FnMut(usize, usize, f64)) {
        if let Some(grouping) = &self.grouping {
            for (group, members) in grouping.members.iter().enumerate() {
                let center = grouping.served(&self.items, group, centers).center;
                for &item in members {
                    let distance = centers.get(center).map_or(f64::INFINITY, |center| {
                        distance(self.items.at(item as usize), center.as_ref())
                    });
                    visit(item as usize, center, distance);
                }
            }
            return;
        }
        let mut near = Near::default();
        for cell in &self.cells {
            near.find(cell, centers);
            for item in cell.range.clone() {
                let (nearest, distance) = near.nearest(self.items.at(item), centers);
                visit(item, nearest, distance);
            }
        }
    }

    /// Calls `visit(cell, items, nearest center)` for runs of items of one cell that have one nearest center, as [`Self::assign`] finds it;
    /// of groups, for each item, and the cell says nothing.
    pub(super) fn assign_runs(
        &self,
        centers: &[P],
        mut visit: impl FnMut(usize, Range<usize>, usize),
    ) {
        if self.grouping.is_some() {
            return self.assign(centers, |item, center, _| visit(0, item..item + 1, center));
        }
        let mut near = Near::default();
        for (at, cell) in self.cells.iter().enumerate() {
            near.find(cell, centers);
            if let [only] = near.centers[..] {
                visit(at, cell.range.clone(), only);
                continue;
            }
            let nearest = |item: usize| near.nearest(self.items.at(item), centers).0;
            let (mut start, mut center) = (cell.range.start, nearest(cell.range.start));
            for item in cell.range.start + 1..cell.range.end {
                let next = nearest(item);
                if next != center {
                    visit(at, start..item, center);
                    (start, center) = (item, next);
                }
            }
            visit(at, start..cell.range.end, center);
        }
    }

    /// No item of a cell reaches farther from the nearest of some centers.
    pub(super) fn bound_of_cell(&self, cell: usize, centers: &[P]) -> f64 {
        self.cells[cell].bound(&self.items, centers)
    }

    /// Farthest-first traversal: `first`, then again and again the item that reaches farthest from the positions of all before.
    /// It ends early when no item is left, or only copies of points.
    pub(super) fn traverse(
        &self,
        first: u32,
        count: usize,
        monitor: &Monitor<'_>,
    ) -> Result<Traversal, Error> {
        if let Some(grouping) = &self.grouping {
            return self.traverse_groups(grouping, first, count, monitor);
        }
        let mut reaches = vec![f64::INFINITY; self.len()];
        let mut tops: Vec<Far> = self
            .cells
            .iter()
            .map(|cell| Far { item: cell.range.start as u32, reach: f64::INFINITY })
            .collect();
        let mut traversal = Traversal { items: vec![] };
        let mut next = first;
        while traversal.items.len() < count.min(self.len()) {
            monitor.check().map_err(ReadError::from)?;
            traversal.items.push(next);
            // It is not to come again, though a ball reaches beyond its own center.
            reaches[next as usize] = f64::NEG_INFINITY;
            let center = self.items.at(next as usize);
            for (cell, top) in self.cells.iter().zip(&mut tops) {
                let holds_it = cell.range.contains(&(next as usize));
                if self.items.shape() == Shape::Points && !holds_it {
                    let nearest =
                        distance(cell.middle.as_ref(), center) / BOUND_FACTOR - cell.spread;
                    if nearest > top.reach {
                        continue;
                    }
                }
                *top = Far { item: cell.range.start as u32, reach: f64::NEG_INFINITY };
                for item in cell.range.clone() {
                    let d = distance(self.items.at(item), center);
                    let reach = self.items.reach_at(item, d).min(reaches[item]);
                    reaches[item] = reach;
                    let far = Far { item: item as u32, reach };
                    if self.order(far, *top).is_lt() {
                        *top = far;
                    }
                }
            }
            let farthest = tops.iter().copied().min_by(|a, b| self.order(*a, *b));
            let farthest = farthest.expect("a set that is not empty has cells");
            let is_over = match self.items.shape() {
                Shape::Balls => farthest.reach == f64::NEG_INFINITY,
                Shape::Points | Shape::Weighted => farthest.reach <= 0.0,
            };
            if is_over {
                break;
            }
            next = farthest.item;
        }
        Ok(traversal)
    }

    /// The same of groups, seen from the centers of their balls, each by the item that reached farthest.
    fn traverse_groups(
        &self,
        grouping: &Grouping<P>,
        first: u32,
        count: usize,
        monitor: &Monitor<'_>,
    ) -> Result<Traversal, Error> {
        let mut reaches: Vec<Far> = grouping
            .members
            .iter()
            .map(|members| Far { item: members[0], reach: f64::INFINITY })
            .collect();
        let mut traversal = Traversal { items: vec![] };
        let mut next = first;
        while traversal.items.len() < count.min(grouping.len()) {
            monitor.check().map_err(ReadError::from)?;
            traversal.items.push(next);
            let taken = grouping.of[next as usize] as usize;
            // It is not to come again, though it reaches beyond its own center.
            reaches[taken].reach = f64::NEG_INFINITY;
            let center = &grouping.balls[taken].center;
            for (group, far) in reaches.iter_mut().enumerate() {
                let (item, reach) = grouping.farthest_in(&self.items, group, center, far.reach);
                if reach < far.reach {
                    *far = Far { item, reach };
                }
            }
            let farthest = reaches.iter().copied().min_by(|a, b| self.order(*a, *b));
            match farthest.filter(|far| far.reach > f64::NEG_INFINITY) {
                Some(far) => next = far.item,
                None => break,
            }
        }
        Ok(traversal)
    }
}

/// The lesser of two numbers, none of which is NaN: one instruction, where `f64::min` has several.
#[inline(always)]
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

/// The centers that can be the nearest for an item of some cell.
#[derive(Default)]
struct Near {
    centers: Vec<usize>,
    /// Squared distances of all centers from the middle of the cell.
    squares: Vec<f64>,
}

impl Near {
    fn find<P: Position>(&mut self, cell: &Cell<P>, centers: &[P]) {
        let middle = cell.middle.as_ref();
        self.squares.clear();
        self.squares.extend(centers.iter().map(|center| square(middle, center.as_ref())));
        let least = self.squares.iter().copied().fold(f64::INFINITY, lesser).sqrt();
        let cut = (least + 2.0 * cell.spread) * BOUND_FACTOR;
        // Squares below the normal numbers tell nothing.
        let cut = if cut > SQUARES_MIN { cut * cut * BOUND_FACTOR } else { f64::INFINITY };
        self.centers.clear();
        self.centers.extend((0..centers.len()).filter(|&j| self.squares[j] <= cut));
    }

    /// The nearest center to a place of the cell, the first of several, and its distance; infinite where there is none.
    #[inline(always)]
    fn nearest<P: Position>(&self, place: &[f64], centers: &[P]) -> (usize, f64) {
        let first = self.centers.first().copied().unwrap_or(0);
        let (mut nearest, mut least) = (first, f64::INFINITY);
        for &j in &self.centers {
            let d = square(place, centers[j].as_ref());
            if d < least {
                (nearest, least) = (j, d);
            }
        }
        (nearest, least.sqrt())
    }
}

impl<P: Position> Cell<P> {
    fn new(items: &ItemSet<P>, range: Range<usize>) -> Self {
        let mut low = items.position(range.start);
        let mut high = low.clone();
        for item in range.clone() {
            for (axis, &x) in items.at(item).iter().enumerate() {
                low.as_mut()[axis] = low.as_ref()[axis].min(x);
                high.as_mut()[axis] = high.as_ref()[axis].max(x);
            }
        }
        let mut middle = low;
        middle.as_mut().iter_mut().zip(high.as_ref()).for_each(|(m, h)| *m = 0.5 * *m + 0.5 * h);
        let (mut spread, mut reach, mut weight) = (0.0f64, 0.0f64, 0.0f64);
        for item in range.clone() {
            let d = distance(items.at(item), middle.as_ref());
            spread = spread.max(d);
            reach = reach.max(d + items.radius(item));
            weight = weight.max(items.weight(item));
        }
        Cell { range, middle, spread, reach, weight }
    }

    /// No item of this cell reaches farther from the nearest center.
    fn bound(&self, items: &ItemSet<P>, centers: &[P]) -> f64 {
        let squares = centers.iter().map(|center| square(self.middle.as_ref(), center.as_ref()));
        let nearest = squares.fold(f64::INFINITY, lesser).sqrt();
        let bound = match items.shape() {
            Shape::Weighted => self.weight * (nearest + self.spread),
            Shape::Points | Shape::Balls => nearest + self.reach,
        };
        bound * BOUND_FACTOR
    }
}

fn widest_axis<P: Position>(items: &ItemSet<P>, part: &[u32]) -> usize {
    let mut low = items.position(part[0] as usize);
    let mut high = low.clone();
    for &item in part {
        for (axis, &x) in items.at(item as usize).iter().enumerate() {
            low.as_mut()[axis] = low.as_ref()[axis].min(x);
            high.as_mut()[axis] = high.as_ref()[axis].max(x);
        }
    }
    let width = |axis: usize| high.as_ref()[axis] - low.as_ref()[axis];
    (0..items.dim()).fold(0, |best, axis| if width(axis) > width(best) { axis } else { best })
}

#[cfg(test)]
mod tests {
    use taut_points::{Distribution, generate};

    use super::*;

    fn clouds(mut judge: impl FnMut(&Cloud<Vec<f64>>, &str)) {
        for shape in [Shape::Points, Shape::Weighted, Shape::Balls] {
            for (n, dim, seed) in [(1, 2, 0), (40, 1, 1), (500, 2, 2), (700, 3, 3), (300, 9, 4)] {
                let values: Vec<f64> = generate(Distribution::Normal, n, dim + 1, seed).unwrap();
                let mut items = ItemSet::new(shape, dim);
                for row in values.chunks_exact(dim + 1) {
                    // Coarse coordinates bring ties.
                    let position: Vec<f64> = row[..dim].iter().map(|x| (4.0 * x).round()).collect();
                    items.push(&position, row[dim].abs() + 0.1);
                }
                judge(&Cloud::new(items, &[]), &format!("{shape:?} {n} × {dim}"));
            }
        }
    }

    fn reach(cloud: &Cloud<Vec<f64>>, item: usize, centers: &[Vec<f64>]) -> f64 {
        let squares = centers.iter().map(|center| square(cloud.items.at(item), center));
        cloud.items.reach_at(item, squares.fold(f64::INFINITY, f64::min).sqrt())
    }

    #[test]
    fn cells_find_what_a_look_at_all_items_finds() {
        clouds(|cloud, what| {
            let n = cloud.len();
            let some = [0, n / 3, n / 2].map(|item| cloud.items.position(item));
            for (count, centers) in [
                (1, &some[..]),
                (5, &some[..2]),
                (100, &some[..]),
                (300, &some[..]),
                (3, &some[..0]),
            ] {
                let mut all: Vec<Far> = (0..n)
                    .map(|item| Far { item: item as u32, reach: reach(cloud, item, centers) })
                    .collect();
                all.sort_by(|a, b| cloud.order(*a, *b));
                all.truncate(count);
                assert_eq!(cloud.farthest(centers, count), all, "{what}, {count}");
            }
            let mut seen = vec![false; n];
            cloud.assign(&some, |item, center, d| {
                assert!(!std::mem::replace(&mut seen[item], true));
                let distances =
                    some.iter().map(|c| square(cloud.items.at(item), c)).collect::<Vec<_>>();
                let least = distances.iter().copied().fold(f64::INFINITY, f64::min);
                assert_eq!(distances.iter().position(|&d| d == least), Some(center), "{what}");
                assert_eq!(d, least.sqrt());
            });
            assert!(seen.into_iter().all(|is_seen| is_seen), "{what}");
            let (mut singly, mut in_runs) = (vec![], vec![]);
            cloud.assign(&some, |item, center, _| singly.push((item, center)));
            cloud.assign_runs(&some, |cell, items, center| {
                assert!(!items.is_empty(), "{what}");
                for item in items {
                    let reach = cloud.items.reach(item, &some[center]);
                    assert!(reach <= cloud.bound_of_cell(cell, &some), "{what}, item {item}");
                    in_runs.push((item, center));
                }
            });
            assert_eq!(in_runs, singly, "{what}");
        });
    }

    #[test]
    fn a_traversal_takes_the_farthest_each_time() {
        clouds(|cloud, what| {
            let traversal = cloud.traverse(0, 12, &Monitor::silent()).unwrap().items;
            for at in 1..traversal.len() {
                let centers: Vec<Vec<f64>> = traversal[..at]
                    .iter()
                    .map(|&item| cloud.items.position(item as usize))
                    .collect();
                let farthest = (0..cloud.len())
                    .filter(|&item| !traversal[..at].contains(&(item as u32)))
                    .map(|item| Far { item: item as u32, reach: reach(cloud, item, &centers) })
                    .min_by(|a, b| cloud.order(*a, *b));
                assert_eq!(farthest.map(|far| far.item), Some(traversal[at]), "{what}, step {at}");
            }
            assert!(traversal.len() == 12.min(cloud.len()) || cloud.items.shape() != Shape::Balls);
        });
    }
}
