//! Best-first branch and bound over ranges of the slope and the offsets, whose tree is the certificate.
//!
//! *Idea.* The cell with the largest bound is split along the coordinate that changes its area and its conditions most. Each cell has the
//! edges that may meet its hull, out of those of its parent. Steps of the linear programs are starts of local
//! [`ascent`](super::ascent).

use std::collections::HashMap;
use std::rc::Rc;

use taut_points::{Cancelled, OrderBy};

use crate::frontier::{Frontier, Waiting};
use crate::inner_points::inner_points;
use crate::levels::Levels;
use crate::polygon::Segment;
use crate::program::{self, Column};
use crate::units::Units;

use super::OrientedRectangleOptions;
use super::ascent::{Candidate, along, around};
use super::cell::{Cell, MARGIN, SLOPE, height, point_at};
use super::report::{Reported, rounded};
use super::rows::{Boundary, Condition, Found, Terms, largest};
use super::tree::{Node, Reason};

/// Cells between two looks at the monitor.
const CELLS_BETWEEN_LOOKS: u64 = 256;

/// Starts of ascents before the search, the largest first.
const STARTS_MAX: usize = 16;

/// How much larger than the best rectangle another one must be to start an ascent, relatively.
const START_GAIN: f64 = 1e-7;

/// Most conditions in the program of a cell; of more those that its middle breaks most.
const CONDITIONS_MAX: usize = 96;

/// Bits of the largest weight in a certificate, and the largest power of two that weights are over.
const WEIGHT_BITS: (i32, i32) = (24, 60);

/// How far below the gap asked for bounds are to end, relatively, so that rounding of areas and of the gap does not miss it.
const GOAL_SLACK: f64 = 32.0 * f64::EPSILON;

/// What a search found.
pub(super) struct Outcome {
    pub(super) best: Option<Reported>,
    /// No rectangle has a larger area.
    pub(super) upper: f64,
    pub(super) nodes: Vec<Node>,
    pub(super) ascents: u64,
    /// Whether no cell was left open by the budget.
    pub(super) is_complete: bool,
}

/// The polygon in the coordinates of the search.
pub(super) struct Target<'a> {
    pub(super) units: &'a Units,
    /// The edges as given.
    pub(super) given: &'a [Segment],
    pub(super) boundary: Boundary,
    /// What is taken from the coordinates of the units, whose edges are those of `levels`.
    pub(super) pivot: [f64; 2],
    pub(super) levels: Levels,
}

impl Target<'_> {
    /// Whether a point of the search is inside.
    pub(super) fn is_inside(&self, p: [f64; 2]) -> bool {
        self.levels.is_inside(&self.units.edges, [0, 1].map(|k| p[k] + self.pivot[k]))
    }
}

/// What waits to be split.
struct Open {
    /// The cell as it was split off, and what is left of it.
    given: Cell,
    cell: Cell,
    list: Rc<[u32]>,
}

struct Search<'a> {
    target: &'a Target<'a>,
    best: Option<Reported>,
    nodes: Vec<Node>,
    frontier: Frontier<Open>,
    epsilon: f64,
    ascents: u64,
    /// The largest heights of vertices above the sides, by the range of slopes.
    extents: HashMap<[u64; 2], [f64; 4]>,
}

/// Finds the largest rectangle and the tree that proves it.
pub(super) fn search(
    target: &Target<'_>,
    options: &OrientedRectangleOptions<'_>,
) -> Result<Outcome, Cancelled> {
    let mut search = Search {
        target,
        best: None,
        nodes: vec![],
        frontier: Frontier::new(),
        epsilon: options.epsilon,
        ascents: 0,
        extents: HashMap::new(),
    };
    search.start();
    let list: Rc<[u32]> = (0..target.given.len() as u32).collect();
    search.add(Cell::root(), &list);
    let mut looked = 0;
    let is_complete = loop {
        if looked <= search.nodes.len() as u64 {
            looked = search.nodes.len() as u64 + CELLS_BETWEEN_LOOKS;
            options.monitor.check()?;
        }
        let goal = search.goal();
        if search.frontier.is_within(goal) {
            break true;
        }
        if search.nodes.len() as u64 + 2 > options.max_cells {
            break false;
        }
        if let Some(top) = search.frontier.pop(goal) {
            search.open(top);
        }
    };
    let upper = search.frontier.upper().max(search.goal());
    let Search { best, nodes, ascents, .. } = search;
    Ok(Outcome { best, upper, nodes, ascents, is_complete })
}

impl Search<'_> {
    /// The largest bound that ends the search.
    fn goal(&self) -> f64 {
        self.area() * (1.0 + self.epsilon) * (1.0 - GOAL_SLACK)
    }

    /// The area of the best rectangle, as it will be reported.
    fn area(&self) -> f64 {
        self.best.as_ref().map_or(0.0, |best| best.in_units)
    }

    /// Climbs from the largest of the rectangles around inner points.
    fn start(&mut self) {
        let edges = &self.target.boundary.edges;
        let mut starts: Vec<Candidate> = vec![];
        for center in inner_points(&self.target.units.edges, self.target.units.extent) {
            let center = [0, 1].map(|k| center[k] - self.target.pivot[k]);
            let largest = around(center)
                .chain(along(edges, center))
                .filter_map(|found| found.freed(edges.iter().copied(), f64::INFINITY))
                .max_by(|one, other| one.area.total_cmp(&other.area));
            starts.extend(largest);
        }
        starts.order_by(&|one, other| other.area.total_cmp(&one.area));
        starts.truncate(STARTS_MAX);
        for found in starts {
            self.climb(&found);
        }
    }

    /// Climbs from a rectangle and takes what is found if it is the best so far.
    fn climb(&mut self, start: &Candidate) {
        self.ascents += 1;
        let found = start.climbed(&self.target.boundary.edges);
        let area = self.area();
        if found.area > area && found.area.is_finite() {
            let reported = rounded(&found, self.target);
            self.best = reported.filter(|reported| reported.in_units > area).or(self.best.take());
        }
    }

    /// The largest heights of vertices above each side, over a range of slopes.
    fn extents(&mut self, cell: &Cell) -> [f64; 4] {
        let edges = &self.target.boundary.edges;
        let slopes = cell.slopes();
        *self.extents.entry(slopes.map(f64::to_bits)).or_insert_with(|| {
            [0, 1, 2, 3].map(|side| {
                let heights = |edge: &Segment| slopes.map(|slope| height(side, slope, edge[0]));
                let all = edges.iter().flat_map(heights);
                all.fold(f64::NEG_INFINITY, f64::max) + 8.0 * self.target.boundary.error
            })
        })
    }

    /// Makes a node of a cell.
    fn add(&mut self, given: Cell, parents: &Rc<[u32]>) -> usize {
        let node = self.nodes.len();
        self.nodes.push(Node::Leaf(Reason::Small));
        let extents = self.extents(&given);
        let Some(cell) = given.contracted(&extents, self.goal() * (1.0 - MARGIN)) else {
            return node;
        };
        let boundary = &self.target.boundary;
        let error = 2.0 * MARGIN + 8.0 * boundary.error;
        let hull = cell.hull();
        let apart = |place: &[[f64; 2]; 2], number: u32| {
            cell.is_apart(place, boundary.edges[number as usize], error)
        };
        let list: Rc<[u32]> = parents.iter().copied().filter(|&edge| !apart(&hull, edge)).collect();
        for number in 0..5 {
            let place = cell.place(number);
            if list.iter().all(|&edge| apart(&place, edge)) {
                let middle = place.map(|[low, high]| 0.5 * low + 0.5 * high);
                if !self.target.is_inside(point_at(cell.middle(SLOPE), middle)) {
                    self.nodes[node] = Node::Leaf(Reason::Outside(number));
                    return node;
                }
            }
        }
        let conditions = match boundary.conditions(&cell, &list) {
            Found::Entered(edge, share) => {
                self.nodes[node] = Node::Leaf(Reason::Entered(edge, share));
                return node;
            }
            Found::Conditions(conditions) => conditions,
        };
        let (reason, bound) = self.weighed(&cell, conditions);
        self.nodes[node] = Node::Leaf(reason);
        // The bound of its parent may be less, but this reason does not prove it.
        if bound > self.goal() {
            self.frontier.push(bound, node, Open { given, cell, list });
        }
        node
    }

    /// The weights of conditions that bound the areas of a cell best, and the bound.
    fn weighed(&mut self, cell: &Cell, conditions: Vec<Condition>) -> (Reason, f64) {
        let area = self.goal() * (1.0 - MARGIN);
        let at = [0, 1, 2, 3, 4].map(|k| cell.middle(k));
        let half = [0, 1, 2, 3, 4].map(|k| cell.half(k));
        let hull = (Reason::Small, cell.hull_area());
        let column = |condition: Condition| {
            let gradient = condition.terms.gradient(&at);
            let gradient = [0, 1, 2, 3, 4].map(|k| -gradient[k] * half[k]);
            let value = -condition.terms.value(&at) - condition.terms.remainder(&half);
            (Column::new(value, gradient), condition)
        };
        let mut all: Vec<(Column<5>, Condition)> = conditions.into_iter().map(column).collect();
        all.retain(|(column, _)| column.can_bind());
        if all.is_empty() {
            return hull;
        }
        all.order_by(&|one, other| other.0.value().total_cmp(&one.0.value()));
        all.truncate(CONDITIONS_MAX);
        let columns: Vec<Column<5>> = all.iter().map(|pair| pair.0).collect();
        let sums = [at[0] + at[2], at[1] + at[3]];
        let m = at[SLOPE];
        let mut target = [0.0; 5];
        for (k, target) in target.iter_mut().take(4).enumerate() {
            *target = half[k] * sums[1 - k % 2];
        }
        target[SLOPE] = -2.0 * area * m * half[SLOPE];
        let products = (half[0] + half[2]) * (half[1] + half[3]);
        let constant = sums[0] * sums[1] + products - area * (1.0 + m * m);
        let found = program::best(&columns, &target, -constant - 1e-6 * area);
        let most = found.parts.iter().fold(0.0f64, |most, part| most.max(part.1));
        let (digits, bits_max) = WEIGHT_BITS;
        let bits = (digits - most.max(f64::MIN_POSITIVE).log2().ceil() as i32).clamp(0, bits_max);
        let (mut terms, mut parts, mut total) = (Terms::default(), vec![], 1.0);
        for (place, weight) in found.parts {
            let named = (weight * (1u64 << bits) as f64).round();
            if named >= 1.0 && named <= (1u64 << 53) as f64 {
                let weight = named / (1u64 << bits) as f64;
                terms.add(&all[place].1.terms, weight);
                total += weight;
                parts.push((all[place].1.part, named as i64));
            }
        }
        let value = largest(cell, &terms, area) + total * 4.0 * MARGIN;
        if value > 0.0 {
            self.try_step(&at, &half, &found.step);
        }
        let bound = area + value.max(0.0) / cell.least_square() * (1.0 + 4.0 * MARGIN);
        // NaN carries no evidence.
        let is_better = bound < hull.1 && !parts.is_empty();
        if is_better { (Reason::Weighted { bits: bits as u32, parts }, bound) } else { hull }
    }

    /// Climbs from a step of a program if it promises more than the best rectangle.
    fn try_step(&mut self, at: &[f64; 5], half: &[f64; 5], step: &[f64; 5]) {
        let coordinates = [0, 1, 2, 3, 4].map(|k| at[k] + half[k] * step[k]);
        let edges = &self.target.boundary.edges;
        let best = self.area();
        let start = Candidate::of(coordinates)
            .filter(|start| start.area > best)
            .and_then(|start| start.freed(edges.iter().copied(), 1.0));
        let is_better = |start: &Candidate| {
            start.area > best * (1.0 + START_GAIN) && self.target.is_inside(start.center())
        };
        if let Some(start) = start.filter(is_better) {
            self.climb(&start);
        }
    }

    /// Puts the halves of a cell in its place.
    fn open(&mut self, waiting: Waiting<Open>) {
        let Waiting { bound, node, cell: Open { given, cell, list } } = waiting;
        let influences = influences(&cell);
        let mut coordinates = [0, 1, 2, 3, 4];
        coordinates.order_by(&|&one, &other| influences[other].total_cmp(&influences[one]));
        let halves = coordinates.into_iter().find_map(|k| Some((k, given.halves(k)?)));
        let Some((coordinate, halves)) = halves else {
            self.frontier.close(bound);
            return;
        };
        let children = halves.map(|half| self.add(half, &list));
        self.nodes[node] = Node::Split(coordinate, children);
    }
}

/// How much the range of each coordinate changes the area and the heights of edges.
fn influences(cell: &Cell) -> [f64; 5] {
    let sums = [0, 1].map(|k| cell.high[k] + cell.high[k + 2]);
    let mut found = [0, 1, 2, 3, 4].map(|k| cell.half(k));
    for (k, x) in found.iter_mut().take(4).enumerate() {
        *x *= sums[1 - k % 2];
    }
    // A turn moves the ends of a side by half of its length against the other side, and about the pivot.
    let far = (0..4).fold(0.0f64, |far, k| far.max(cell.middle(k).abs()));
    found[SLOPE] *= far.max(0.5 * sums[0]).max(0.5 * sums[1]) * sums[0].max(sums[1]);
    found
}
