//! Branch and bound over cells: first best first for a good circle, then depth first for the certificate.
//!
//! *Idea.* Each cell has the list of the edges that may be nearest to one of its points, out of the list of its parent. The first
//! search opens the cell of the largest bound, so that it runs into no thin part of the polygon, and finds the circle. The
//! second visits all cells depth first and writes down how each is closed. When it meets a better circle, what was closed
//! before stays valid; it is run again if the circle grew much, as fewer cells are needed for the larger one.
//! *Trap.* Depth first with a circle that is too small, cells that hold better centers are split until their middles are as
//! good as the best of them: as many cells as 1/ε.
//! *Budget.* A search that needs too many cells is run again for a larger gap.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use taut_certify::Stop;
use taut_points::{Cancelled, Monitor};

use super::cell::Cell;
use super::distance::Edges;
use super::polish::equidistant;
use super::{CircleOptions, weights};
use crate::simple::meets_cell;

/// Cells after which the first search stops; the second one is complete without it.
const FIRST_CELLS_MAX: u64 = 200_000;

/// Searches that write a log; the second one is run with the best circle of the first.
const LOGS_MAX: u64 = 3;

/// Factor of the gap to prove when the budget was used up.
const GAP_GROWTH: f64 = 16.0;

/// Edges up to which weights are sought in cells that are much larger than the circle.
const LIST_OF_LARGE_CELL_MAX: usize = 64;

/// The factor by which distances change along the shorter side of a cell that is split there.
const CHANGE_RATIO: f64 = 4.0;

/// Half diagonal of a cell, in radii, above which it is much larger than the circle.
const LARGE_CELL: f64 = 4.0;

/// Absolute rounding errors of distances in plain arithmetic, coordinates being below 2 in size: 16u.
const ROUNDING: f64 = 8.0 * f64::EPSILON;

/// A circle is thin when its scaled radius is less than this many times the rounding errors of plain distances.
const THIN_CIRCLE_ROUNDINGS: f64 = 1e12;

/// Cells between two looks at the monitor.
const CELLS_BETWEEN_CHECKS: u64 = 256;

/// Denominators of the weights in a certificate, as powers of two; the first that closes the cell is taken.
const WEIGHT_BITS: [u32; 4] = [6, 16, 32, 50];

pub(super) struct SearchResult {
    /// The center in coordinates of the input, if there is one.
    pub(super) center: Option<[f64; 2]>,
    /// The scaled radius: no edge is nearer.
    pub(super) radius: f64,
    /// No circle has a larger scaled radius.
    pub(super) upper: f64,
    pub(super) log: Log,
    pub(super) stop: Stop,
    pub(super) cells: u64,
    pub(super) searches: u64,
}

/// The subdivision, in the form of the certificate.
#[derive(Default)]
pub(super) struct Log {
    pub(super) tree: String,
    pub(super) leaves: Vec<Leaf>,
}

/// Edges with whole weights.
#[derive(Clone)]
pub(super) struct Leaf(Vec<(u32, u64)>);

impl Leaf {
    /// The numbers of the certificate, with edges by the rows at which they begin.
    pub(super) fn numbers(self, rows: &[u64]) -> Vec<u64> {
        match self.0[..] {
            [(edge, _)] => vec![rows[edge as usize]],
            _ => self.0.iter().flat_map(|&(edge, w)| [rows[edge as usize], w]).collect(),
        }
    }
}

/// Finds the largest circle, and the log that proves it.
pub(super) fn search(
    edges: &Edges,
    options: &CircleOptions<'_>,
) -> Result<SearchResult, Cancelled> {
    let monitor = &options.monitor;
    let mut search = Search { edges, monitor, center: None, radius: 0.0, cells: 0 };
    search.best_first(options.epsilon)?;
    let (mut gap, mut stop, mut searches) = (options.epsilon, Stop::Converged, 1);
    loop {
        searches += 1;
        let before = search.radius;
        let Some((log, upper)) = search.depth_first(gap, options.max_cells)? else {
            if search.center.is_none() {
                return Ok(SearchResult {
                    center: None,
                    radius: 0.0,
                    upper: f64::INFINITY,
                    log: Log::default(),
                    stop: Stop::NodeBudget,
                    cells: search.cells,
                    searches,
                });
            }
            (gap, stop) = (gap * GAP_GROWTH, Stop::NodeBudget);
            continue;
        };
        let has_grown = search.radius > before * (1.0 + gap);
        if has_grown && stop == Stop::Converged && searches <= LOGS_MAX {
            continue;
        }
        let radius = search.radius_over_all();
        let upper = upper.max(radius);
        let is_reached = upper <= radius * (1.0 + options.epsilon);
        if !is_reached && stop == Stop::Converged {
            stop = Stop::Rounding;
        }
        let (center, cells) = (search.center, search.cells);
        return Ok(SearchResult { center, radius, upper, log, stop, cells, searches });
    }
}

/// The best circle so far, and what it takes to look for a better one.
struct Search<'a> {
    edges: &'a Edges,
    monitor: &'a Monitor<'a>,
    center: Option<[f64; 2]>,
    radius: f64,
    cells: u64,
}

/// The known facts about a cell.
enum Outcome {
    /// No edge meets it, and it is outside.
    Outside,
    /// No center in it has a clearance above the bound, which is the one wanted.
    Closed(Leaf, f64),
    /// The bound is larger than the one wanted; split along the axis, if there is one.
    Open(Leaf, f64, Option<usize>),
}

/// A cell that waits to be split.
struct Waiting {
    bound: f64,
    number: u64,
    cell: Cell,
    axis: usize,
    list: Vec<u32>,
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.number.cmp(&self.number))
    }
}

impl PartialOrd for Waiting {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Waiting {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Waiting {}

impl Search<'_> {
    /// Opens the cell of the largest bound until that is within the gap.
    fn best_first(&mut self, gap: f64) -> Result<(), Cancelled> {
        let all: Vec<u32> = (0..self.edges.len()).collect();
        let mut heap = BinaryHeap::new();
        let mut parent = Waiting {
            bound: f64::INFINITY,
            number: 0,
            cell: Cell::root(self.edges),
            axis: 0,
            list: all,
        };
        let mut children = vec![parent.cell];
        loop {
            for cell in children {
                let mut list = vec![];
                let outcome = self.examine(&cell, &parent.list, &mut list, gap)?;
                if let Outcome::Open(_, bound, Some(axis)) = outcome {
                    heap.push(Waiting { bound, number: self.cells, cell, axis, list });
                }
            }
            let Some(next) = heap.pop() else { return Ok(()) };
            if next.bound <= self.radius * (1.0 + gap) || self.cells >= FIRST_CELLS_MAX {
                return Ok(());
            }
            children = next.cell.halves(next.axis, self.edges, &next.list).to_vec();
            parent = next;
        }
    }

    /// Closes all cells within the gap; returns the log with the largest bound, or `None` when that takes too many cells.
    fn depth_first(&mut self, gap: f64, max_cells: u64) -> Result<Option<(Log, f64)>, Cancelled> {
        let (mut log, mut upper) = (Log::default(), 0.0f64);
        let mut lists: Vec<Vec<u32>> = vec![(0..self.edges.len()).collect()];
        let mut pending = vec![(Cell::root(self.edges), 1)];
        let last = self.cells.saturating_add(max_cells);
        while let Some((cell, depth)) = pending.pop() {
            if self.cells >= last {
                return Ok(None);
            }
            if lists.len() == depth {
                lists.push(vec![]);
            }
            let (parents, own) = lists.split_at_mut(depth);
            let mut close = |log: &mut Log, leaf, bound: f64| {
                log.tree.push('b');
                log.leaves.push(leaf);
                upper = upper.max(bound);
            };
            match self.examine(&cell, &parents[depth - 1], &mut own[0], gap)? {
                Outcome::Outside => log.tree.push('o'),
                Outcome::Closed(leaf, bound) => close(&mut log, leaf, bound),
                Outcome::Open(_, _, Some(axis)) => {
                    log.tree.push(if axis == 0 { 'x' } else { 'y' });
                    let [below, above] = cell.halves(axis, self.edges, &own[0]);
                    pending.extend([(above, depth + 1), (below, depth + 1)]);
                }
                Outcome::Open(leaf, bound, None) => close(&mut log, leaf, bound),
            }
        }
        Ok(Some((log, upper)))
    }

    /// Bounds the clearance in a cell and looks for a better circle there. `list` becomes the list of the cell.
    fn examine(
        &mut self,
        cell: &Cell,
        parents: &[u32],
        list: &mut Vec<u32>,
        gap: f64,
    ) -> Result<Outcome, Cancelled> {
        self.cells += 1;
        if self.cells.is_multiple_of(CELLS_BETWEEN_CHECKS) {
            self.monitor.check()?;
        }
        let edges = self.edges;
        let corners = cell.corners().map(|corner| edges.scaled(corner));
        let middle = edges.scaled(cell.center());
        let size = [0, 1].map(|k| corners[3][k] - corners[0][k]);
        let half = 0.5 * size[0].hypot(size[1]);
        let (nearest, clearance) = near(edges, middle, half, parents, list);
        if clearance + ROUNDING > self.radius {
            self.consider(cell, cell.center(), list);
        }
        let has_no_edge = || {
            let meets = |&edge: &u32| meets_cell(edges.segment(edge), cell.low, cell.high);
            clearance > half * (1.0 + 1e-9) + ROUNDING || !list.iter().any(meets)
        };
        if !cell.is_inside && has_no_edge() {
            return Ok(Outcome::Outside);
        }
        let mut single = Leaf(vec![(nearest, 1)]);
        let mut bound = weighted(edges, &corners, &single);
        if bound <= self.wanted(gap) {
            return Ok(Outcome::Closed(single, bound));
        }
        let is_large = half > LARGE_CELL * self.radius.max(clearance);
        if is_large && list.len() > LIST_OF_LARGE_CELL_MAX {
            let distances = corners.map(|corner| edges.distance(corner, nearest));
            let excess = bound - self.wanted(gap);
            let axis = split_axis(cell, size, excess, [(1.0, distances)].into_iter());
            return Ok(Outcome::Open(single, bound, axis));
        }
        // Plain distances will do where the circle is much larger than their rounding errors.
        let is_thin = self.radius.max(clearance) < ROUNDING * THIN_CIRCLE_ROUNDINGS;
        let from = |corner, edge| match is_thin {
            true => edges.accurate(corner, edge),
            false => edges.distance(corner, edge),
        };
        let distances: Vec<[f64; 4]> =
            list.iter().map(|&edge| corners.map(|corner| from(corner, edge))).collect();
        let best = weights::best(&distances);
        if best.value > self.radius {
            let touched: Vec<u32> = best.parts.iter().map(|part| list[part.0]).collect();
            for some in groups(&touched) {
                if let Some(q) = equidistant(edges, &some, middle) {
                    let q = edges.unscaled(q);
                    // Beyond a side by rounding alone, as the best center is often on the border of cells.
                    let q = [0, 1].map(|k| q[k].clamp(cell.low[k], cell.high[k]));
                    self.consider(cell, q, list);
                }
            }
        }
        for bits in WEIGHT_BITS {
            let whole = |&(place, weight): &(usize, f64)| {
                (list[place], (weight * (1u64 << bits) as f64).round() as u64)
            };
            let parts: Vec<(u32, u64)> =
                best.parts.iter().map(whole).filter(|part| part.1 > 0).collect();
            let leaf = Leaf(parts);
            let value = weighted(edges, &corners, &leaf);
            if value < bound {
                (single, bound) = (leaf, value);
            }
            if bound <= self.wanted(gap) {
                return Ok(Outcome::Closed(single, bound));
            }
        }
        let parts = best.parts.iter().map(|&(place, weight)| (weight, distances[place]));
        let axis = split_axis(cell, size, bound - self.wanted(gap), parts);
        Ok(Outcome::Open(single, bound, axis))
    }

    /// The largest bound that closes a cell.
    fn wanted(&self, gap: f64) -> f64 {
        self.radius * (1.0 + gap) * (1.0 - ROUNDING)
    }

    /// Takes the circle around q, a point of the cell, if it is the largest so far.
    fn consider(&mut self, cell: &Cell, q: [f64; 2], list: &[u32]) {
        let (edges, p) = (self.edges, self.edges.scaled(q));
        let nearest = |least: f64, &edge: &u32| least.min(edges.distance(p, edge));
        let least = list.iter().fold(f64::INFINITY, nearest);
        if least + ROUNDING <= self.radius {
            return;
        }
        let near = list.iter().filter(|&&edge| edges.distance(p, edge) <= least + ROUNDING);
        let radius = near.map(|&edge| edges.rounded_down(p, edge)).fold(f64::INFINITY, f64::min);
        if radius > self.radius && cell.is_inside(q, edges, list) {
            (self.center, self.radius) = (Some(q), radius);
        }
    }

    /// The clearance of the center, from all edges and rounded down.
    fn radius_over_all(&self) -> f64 {
        let p = self.edges.scaled(self.center.unwrap_or_default());
        // The accurate distance of an edge that is farther by its plain one is above the radius.
        let most = self.radius * (1.0 + 16.0 * ROUNDING) + 2.0 * ROUNDING;
        let near = (0..self.edges.len()).filter(|&edge| self.edges.distance(p, edge) <= most);
        near.map(|edge| self.edges.rounded_down(p, edge)).fold(self.radius, f64::min)
    }
}

/// The axis along which a cell is split: its longer side, but for thin cells with an excess of the bound over the one wanted
/// that distances along the shorter side explain and those along the longer one do not.
///
/// A thin polygon fills a cell that is as thin; splitting the longer side alone would take as many cells as it is longer.
fn split_axis(
    cell: &Cell,
    size: [f64; 2],
    excess: f64,
    parts: impl Iterator<Item = (f64, [f64; 4])>,
) -> Option<usize> {
    let mut changes = [0.0; 2];
    for (weight, [low, right, top, high]) in parts {
        changes[0] += 0.5 * weight * ((right - low).abs() + (high - top).abs());
        changes[1] += 0.5 * weight * ((top - low).abs() + (high - right).abs());
    }
    let longer = usize::from(size[1] > size[0]);
    let shorter = 1 - longer;
    let explains = changes[shorter] > excess && changes[shorter] > CHANGE_RATIO * changes[longer];
    let first = if explains { shorter } else { longer };
    [first, 1 - first].into_iter().find(|&axis| cell.has_middle(axis))
}

/// All groups of two and three of at most four edges.
fn groups(edges: &[u32]) -> Vec<Vec<u32>> {
    let all = 0u32..1 << edges.len();
    let some = all.filter(|members| (2..=3).contains(&members.count_ones()));
    let members =
        |set: u32| (0..edges.len()).filter(|&i| set >> i & 1 == 1).map(|i| edges[i]).collect();
    some.map(members).collect()
}

/// Lists the edges that may be nearest to a point within `half` of the middle; returns the edge nearest to the middle and its
/// distance.
fn near(
    edges: &Edges,
    middle: [f64; 2],
    half: f64,
    parents: &[u32],
    list: &mut Vec<u32>,
) -> (u32, f64) {
    let distances: Vec<f64> = parents.iter().map(|&edge| edges.distance(middle, edge)).collect();
    let mut nearest = (parents[0], f64::INFINITY);
    for (&edge, &distance) in parents.iter().zip(&distances) {
        if distance < nearest.1 {
            nearest = (edge, distance);
        }
    }
    let most = nearest.1 + 2.0 * half * (1.0 + 1e-9) + ROUNDING;
    list.clear();
    list.extend(parents.iter().zip(&distances).filter(|pair| *pair.1 <= most).map(|pair| *pair.0));
    nearest
}

/// The largest weighted mean of distances over the corners, rounded up.
fn weighted(edges: &Edges, corners: &[[f64; 2]; 4], leaf: &Leaf) -> f64 {
    let sum = leaf.0.iter().map(|part| part.1).sum::<u64>() as f64;
    let mean = |corner: &[f64; 2]| {
        let term = |&(edge, weight): &(u32, u64)| weight as f64 * edges.rounded_up(*corner, edge);
        leaf.0.iter().map(term).sum::<f64>() / sum
    };
    corners.iter().map(mean).fold(0.0, f64::max) * (1.0 + ROUNDING)
}
