//! Branch and bound over cells: first best first for a good circle, then depth first for the certificate.
//!
//! *Idea.* A cell is bounded by the edges that may be nearest to one of its points. The first search opens the cell of the largest
//! bound, so that it runs into no thin part of the polygon, and finds the circle; its tree is the certificate, less cells that
//! were split for a smaller circle. Where it takes too many cells, another search visits all cells depth first, without keeping
//! them. When that meets a better circle, what was closed before stays valid; it is run again if the circle grew much, as fewer
//! cells are needed for the larger one.
//! *Trap.* Depth first with a circle that is too small, cells that hold better centers are split until their middles are as
//! good as the best of them: as many cells as 1/ε.
//! *Budget.* A search that needs too many cells is run again for a larger gap: at once for the one that the first search reached, if
//! that says nothing about the radius, as in a polygon that is as thin as the last digits of its coordinates.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use taut_certify::Stop;
use taut_points::{Cancelled, Monitor, two_to};

use super::cell::Cell;
use super::distance::Edges;
use super::log::{Leaf, Log, Node};
use super::polish::equidistant;
use super::{CircleOptions, ROUNDING, weights};

/// Cells after which the first search stops; the second one is complete without it.
const FIRST_CELLS_MAX: u64 = 200_000;

/// Searches depth first; each but the first is run with the best circle of the one before.
const LOGS_MAX: u64 = 3;

/// Factor of the gap to prove when the budget was used up.
const GAP_GROWTH: f64 = 16.0;

/// A gap above this says nothing about the radius; that of the first search is then as good as one to which a longer search comes.
const GAP_OF_USE_MAX: f64 = 1e3;

/// The least scaled radius for which distances have digits, 2⁻⁹³.
const RADIUS_LEAST: f64 = two_to(-93);

/// Half diagonal of a cell, in radii, above which weights are not worth their cost: many edges are about as near as the nearest.
const LARGE_CELL: f64 = 1.4;

/// Edges of a polygon up to which weights are sought in large cells as well.
const EDGES_OF_LARGE_CELL_MAX: u32 = 64;

/// The factor by which distances change along the shorter side of a cell that is split there.
const CHANGE_RATIO: f64 = 4.0;

/// A circle is thin when its scaled radius is less than this many times the rounding errors of plain distances.
const THIN_CIRCLE_ROUNDINGS: f64 = 1e12;

/// Share of the radius beyond it up to which edges are looked at for the radius that is claimed.
const CHECKED_BEYOND: f64 = 1e-9;

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

/// Finds the largest circle, and the log that proves it.
pub(super) fn search(
    edges: &Edges<'_>,
    options: &CircleOptions<'_>,
) -> Result<SearchResult, Cancelled> {
    let monitor = &options.monitor;
    let mut search = Search { edges, monitor, center: None, radius: 0.0, cells: 0, list: vec![] };
    if edges.are_too_near() {
        return Ok(search.refused(0, options.epsilon));
    }
    let first = search.best_first(options.epsilon)?;
    let (mut gap, mut stop, mut searches) = (options.epsilon, Stop::Converged, 1);
    let mut gap_reached = 0.0;
    match first {
        First::Complete(nodes) => {
            let (log, upper) = Log::of(&nodes, search.wanted(gap));
            if log.tree.len() as u64 <= options.max_cells {
                return Ok(search.result(log, upper, stop, searches, options.epsilon));
            }
        }
        First::Stopped(upper) => gap_reached = upper / search.radius - 1.0,
    }
    loop {
        searches += 1;
        let before = search.radius;
        let Some((log, upper)) = search.depth_first(gap, options.max_cells)? else {
            if search.center.is_none() || search.radius < RADIUS_LEAST {
                return Ok(search.refused(searches, options.epsilon));
            }
            (gap, stop) = (gap * GAP_GROWTH, Stop::NodeBudget);
            if gap_reached > GAP_OF_USE_MAX {
                gap = gap.max(gap_reached);
            }
            continue;
        };
        let has_grown = search.radius > before * (1.0 + gap);
        if has_grown && stop == Stop::Converged && searches <= LOGS_MAX {
            continue;
        }
        return Ok(search.result(log, upper, stop, searches, options.epsilon));
    }
}

/// What the first search comes to.
enum First {
    /// A tree within the gap.
    Complete(Vec<Node>),
    /// Too many cells, and the largest bound of those that are open.
    Stopped(f64),
}

/// The best circle so far, and what it takes to look for a better one.
struct Search<'a> {
    edges: &'a Edges<'a>,
    monitor: &'a Monitor<'a>,
    center: Option<[f64; 2]>,
    radius: f64,
    cells: u64,
    /// The edges that are nearest to a point, up to rounding.
    list: Vec<u32>,
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
    node: usize,
    cell: Cell,
    axis: usize,
    /// The edge nearest to its middle.
    nearest: u32,
}

impl Ord for Waiting {
    fn cmp(&self, other: &Self) -> Ordering {
        self.bound.total_cmp(&other.bound).then(other.node.cmp(&self.node))
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
    /// Returns the result for a polygon in which no circle is large enough for a checker.
    fn refused(mut self, searches: u64, epsilon: f64) -> SearchResult {
        self.center = None;
        self.result(Log::default(), f64::INFINITY, Stop::NodeBudget, searches, epsilon)
    }

    /// Opens the cell of the largest bound until that is within the gap.
    fn best_first(&mut self, gap: f64) -> Result<First, Cancelled> {
        let (mut nodes, mut heap) = (vec![], BinaryHeap::new());
        self.add(Cell::root(self.edges), 0, gap, &mut nodes, &mut heap)?;
        while let Some(next) = heap.pop() {
            if next.bound <= self.wanted(gap) {
                break;
            }
            if self.cells >= FIRST_CELLS_MAX {
                return Ok(First::Stopped(next.bound));
            }
            let [below, above] = next.cell.halves(next.axis);
            let children = [
                self.add(below, next.nearest, gap, &mut nodes, &mut heap)?,
                self.add(above, next.nearest, gap, &mut nodes, &mut heap)?,
            ];
            nodes[next.node].split = Some((next.axis, children));
        }
        Ok(First::Complete(nodes))
    }

    /// Makes a node of a cell, and lets the cell wait if it is open.
    fn add(
        &mut self,
        cell: Cell,
        hint: u32,
        gap: f64,
        nodes: &mut Vec<Node>,
        heap: &mut BinaryHeap<Waiting>,
    ) -> Result<usize, Cancelled> {
        let node = nodes.len();
        let (outcome, nearest) = self.examine(&cell, hint, gap)?;
        let bound = match outcome {
            Outcome::Outside => None,
            Outcome::Closed(leaf, bound) => Some((leaf, bound)),
            Outcome::Open(leaf, bound, axis) => {
                if let Some(axis) = axis {
                    heap.push(Waiting { bound, node, cell, axis, nearest });
                }
                Some((leaf, bound))
            }
        };
        nodes.push(Node { bound, split: None });
        Ok(node)
    }

    /// Closes all cells within the gap; returns the log with the largest bound, or `None` when that takes too many cells.
    fn depth_first(&mut self, gap: f64, max_cells: u64) -> Result<Option<(Log, f64)>, Cancelled> {
        let mut log = Log::default();
        let mut pending = vec![(Cell::root(self.edges), 0)];
        let mut upper = 0.0f64;
        let last = self.cells.saturating_add(max_cells);
        while let Some((cell, hint)) = pending.pop() {
            if self.cells >= last {
                return Ok(None);
            }
            let (outcome, nearest) = self.examine(&cell, hint, gap)?;
            match outcome {
                Outcome::Outside => log.outside(),
                Outcome::Open(_, _, Some(axis)) => {
                    log.split(axis);
                    let [below, above] = cell.halves(axis);
                    pending.extend([(above, nearest), (below, nearest)]);
                }
                Outcome::Closed(leaf, bound) | Outcome::Open(leaf, bound, None) => {
                    log.close(leaf);
                    upper = upper.max(bound);
                }
            }
        }
        Ok(Some((log, upper)))
    }

    /// Bounds the clearance in a cell and looks for a better circle there; also returns the edge nearest to the middle.
    fn examine(&mut self, cell: &Cell, hint: u32, gap: f64) -> Result<(Outcome, u32), Cancelled> {
        self.cells += 1;
        if self.cells.is_multiple_of(CELLS_BETWEEN_CHECKS) {
            self.monitor.check()?;
        }
        let edges = self.edges;
        let corners = cell.corners().map(|corner| edges.scaled(corner));
        let middle = edges.scaled(cell.center());
        let size = [0, 1].map(|k| corners[3][k] - corners[0][k]);
        let half = 0.5 * size[0].hypot(size[1]);
        let (nearest, clearance) = edges.nearest(middle, hint);
        if clearance + ROUNDING > self.radius {
            self.consider(cell.center(), nearest);
        }
        let is_apart =
            || clearance > half * (1.0 + 1e-9) + ROUNDING || !edges.meet(cell.low, cell.high);
        if is_apart() && !edges.is_inside(cell.low) {
            return Ok((Outcome::Outside, nearest));
        }
        let mut single = Leaf(vec![(nearest, 1)]);
        let mut bound = weighted(edges, &corners, &single);
        if bound <= self.wanted(gap) {
            return Ok((Outcome::Closed(single, bound), nearest));
        }
        if half > LARGE_CELL * self.radius.max(clearance) && edges.len() > EDGES_OF_LARGE_CELL_MAX {
            let distances = corners.map(|corner| edges.distance(corner, nearest));
            let excess = bound - self.wanted(gap);
            let axis = split_axis(cell, size, excess, [(1.0, distances)].into_iter());
            return Ok((Outcome::Open(single, bound, axis), nearest));
        }
        // Plain distances will do where the circle is much larger than their rounding errors.
        let is_thin = self.radius.max(clearance) < ROUNDING * THIN_CIRCLE_ROUNDINGS;
        let from = |corner, edge| match is_thin {
            true => edges.accurate(corner, edge),
            false => edges.distance(corner, edge),
        };
        let distances = |edge| corners.map(|corner| from(corner, edge));
        let least = |mu| edges.least_sum(&corners, mu, nearest, &distances);
        // Half of the gap is left for whole weights.
        let enough = self.radius * (1.0 + 0.5 * gap);
        let best = weights::best((nearest, distances(nearest)), enough, least);
        if best.value > self.radius {
            let touched: Vec<u32> = best.parts.iter().map(|part| part.0.0).collect();
            for some in groups(&touched) {
                if let Some(q) = equidistant(edges, &some, middle) {
                    let q = edges.unscaled(q);
                    // Beyond a side by rounding alone, as the best center is often on the border of cells.
                    let q = [0, 1].map(|k| q[k].clamp(cell.low[k], cell.high[k]));
                    self.consider(q, some[0]);
                }
            }
        }
        for bits in WEIGHT_BITS {
            let whole = |&((edge, _), weight): &(weights::Row, f64)| {
                (edge, (weight * (1u64 << bits) as f64).round() as u64)
            };
            let parts: Vec<(u32, u64)> =
                best.parts.iter().map(whole).filter(|part| part.1 > 0).collect();
            let leaf = Leaf(parts);
            let value = weighted(edges, &corners, &leaf);
            if value < bound {
                (single, bound) = (leaf, value);
            }
            if bound <= self.wanted(gap) {
                return Ok((Outcome::Closed(single, bound), nearest));
            }
        }
        let parts = best.parts.iter().map(|&((_, distances), weight)| (weight, distances));
        let axis = split_axis(cell, size, bound - self.wanted(gap), parts);
        Ok((Outcome::Open(single, bound, axis), nearest))
    }

    /// The largest bound that closes a cell.
    fn wanted(&self, gap: f64) -> f64 {
        self.radius * (1.0 + gap) * (1.0 - ROUNDING)
    }

    /// Takes the circle around q if it is the largest so far. `hint` is an edge that may be near.
    fn consider(&mut self, q: [f64; 2], hint: u32) {
        let (edges, p) = (self.edges, self.edges.scaled(q));
        if edges.distance(p, hint) + ROUNDING <= self.radius {
            return;
        }
        let (_, least) = edges.nearest(p, hint);
        if least + ROUNDING <= self.radius {
            return;
        }
        let radius = self.rounded_down(p, least + ROUNDING);
        if radius > self.radius && edges.is_inside(q) {
            (self.center, self.radius) = (Some(q), radius);
        }
    }

    /// The clearance of a scaled point, rounded down, from the edges up to a distance.
    fn rounded_down(&mut self, p: [f64; 2], most: f64) -> f64 {
        self.edges.within(p, most, usize::MAX, &mut self.list);
        let near = self.list.iter().map(|&edge| self.edges.rounded_down(p, edge));
        near.fold(f64::INFINITY, f64::min)
    }

    /// The circle with its log; `upper` is the largest bound of a leaf.
    fn result(
        mut self,
        log: Log,
        upper: f64,
        mut stop: Stop,
        searches: u64,
        epsilon: f64,
    ) -> SearchResult {
        let p = self.edges.scaled(self.center.unwrap_or_default());
        // All other edges are farther than the radius even where plain distances are off.
        let radius = self.rounded_down(p, self.radius * (1.0 + CHECKED_BEYOND) + 8.0 * ROUNDING);
        let radius = self.radius.min(radius);
        let upper = upper.max(radius);
        if upper > radius * (1.0 + epsilon) && stop == Stop::Converged {
            stop = Stop::Rounding;
        }
        let (center, cells) = (self.center, self.cells);
        SearchResult { center, radius, upper, log, stop, cells, searches }
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

/// The largest weighted mean of distances over the corners, rounded up.
fn weighted(edges: &Edges<'_>, corners: &[[f64; 2]; 4], leaf: &Leaf) -> f64 {
    let sum = leaf.0.iter().map(|part| part.1).sum::<u64>() as f64;
    let mean = |corner: &[f64; 2]| {
        let term = |&(edge, weight): &(u32, u64)| weight as f64 * edges.rounded_up(*corner, edge);
        leaf.0.iter().map(term).sum::<f64>() / sum
    };
    corners.iter().map(mean).fold(0.0, f64::max) * (1.0 + ROUNDING)
}
