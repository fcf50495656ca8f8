//! Best-first branch and bound over boxes of rectangles, whose tree is the certificate.
//!
//! *Idea.* The cell with the largest hull is split along the axis that changes its area most. Each cell has the edges that meet its hull,
//! out of those of its parent. The middle rectangle of a cell, widened between its levels, is a candidate.

use std::rc::Rc;

use taut_points::{Cancelled, OrderBy};

use crate::frontier::{Frontier, Waiting};
use crate::polygon::{Segment, is_inside};

use super::RectangleOptions;
use super::cell::{Axis, Cell, Rectangle};
use super::strip::{polished, widened};
use super::tree::{self, Log, Node};

/// Cells between two looks at the monitor.
const CELLS_BETWEEN_LOOKS: u64 = 256;

/// Levels of the first candidates along each axis.
const LEVELS: usize = 24;

/// How far below the gap asked for bounds are to end, relatively, so that rounding does not miss it.
const GOAL_SLACK: f64 = 1e-12;

/// Gain for which a candidate is polished, relatively.
const GAIN_MIN: f64 = 1e-9;

/// First share by which a rectangle is shrunk where rounding lets edges into it, the factor of the next ones, and the last.
const SHRINKING: [f64; 3] = [1e-16, 4.0, 1e-6];

/// What a search found.
pub(super) struct Found {
    pub(super) best: Option<Rectangle>,
    /// No rectangle has a larger area.
    pub(super) upper: f64,
    pub(super) log: Log,
    pub(super) strips: u64,
    /// Whether no cell was left open by the budget.
    pub(super) is_complete: bool,
}

/// A cell that waits to be split, and the edges that meet it.
type Listed = (Cell, Rc<[u32]>);

struct Search<'a> {
    edges: &'a [Segment],
    whole: Rectangle,
    best: Option<Rectangle>,
    nodes: Vec<Node>,
    frontier: Frontier<Listed>,
    epsilon: f64,
    strips: u64,
}

/// Finds the largest rectangle and the tree that proves it.
pub(super) fn search(
    edges: &[Segment],
    options: &RectangleOptions<'_>,
) -> Result<Found, Cancelled> {
    let whole = Rectangle::around(edges);
    let mut search = Search {
        edges,
        whole,
        best: None,
        nodes: vec![],
        frontier: Frontier::new(),
        epsilon: options.epsilon,
        strips: 0,
    };
    search.start();
    let list: Rc<[u32]> = (0..edges.len() as u32).collect();
    search.add(Cell::of(whole), &list);
    let mut opened = 0;
    let is_complete = loop {
        if opened % CELLS_BETWEEN_LOOKS == 0 {
            options.monitor.check()?;
        }
        opened += 1;
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
    let (best, strips) = (search.best, search.strips);
    let upper = search.frontier.upper().max(best.map_or(0.0, |best| best.area()));
    Ok(Found { best, upper, log: tree::log(&search.nodes), strips, is_complete })
}

impl Search<'_> {
    fn area(&self) -> f64 {
        self.best.map_or(0.0, |best| best.area())
    }

    /// The largest bound that ends the search.
    fn goal(&self) -> f64 {
        self.area() * (1.0 + self.epsilon) * (1.0 - GOAL_SLACK)
    }

    /// Tries rectangles between all pairs of some levels, around the middles of the free intervals at the level between.
    fn start(&mut self) {
        let whole = self.whole;
        for axis in 0..2 {
            let other = 1 - axis;
            let level = |i: usize| {
                let share = (i as f64 + 0.5) / LEVELS as f64;
                whole.low[axis] * (1.0 - share) + whole.high[axis] * share
            };
            for from in 0..LEVELS {
                for to in from + 1..LEVELS {
                    let middle = 0.5 * level(from) + 0.5 * level(to);
                    for center in self.middles(axis, middle) {
                        let mut given = whole;
                        (given.low[axis], given.high[axis]) = (level(from), level(to));
                        (given.low[other], given.high[other]) = (center, center);
                        self.strips += 1;
                        let found = widened(&given, axis, &whole, self.edges.iter().copied());
                        self.consider(&found);
                    }
                }
            }
        }
    }

    /// The middles of the free intervals along a line.
    fn middles(&self, axis: usize, level: f64) -> Vec<f64> {
        let other = 1 - axis;
        let crossing = |[a, b]: &Segment| {
            let share = (level - a[axis]) / (b[axis] - a[axis]);
            ((a[axis] <= level) != (b[axis] <= level))
                .then(|| a[other] + share * (b[other] - a[other]))
        };
        let mut crossings: Vec<f64> = self.edges.iter().filter_map(crossing).collect();
        crossings.sort_by(f64::total_cmp);
        crossings.chunks_exact(2).map(|pair| 0.5 * pair[0] + 0.5 * pair[1]).collect()
    }

    /// Takes a rectangle, polished, if it is the best so far.
    fn consider(&mut self, found: &Rectangle) {
        if found.area() <= self.area() * (1.0 + GAIN_MIN) || !self.is_inside(found.center()) {
            return;
        }
        for candidate in [*found, polished(found, &self.whole, self.edges)] {
            if candidate.area() > self.area()
                && let Some(clear) = self.cleared(&candidate)
                && clear.area() > self.area()
            {
                self.best = Some(clear);
            }
        }
    }

    /// The rectangle, shrunk until no edge enters it, if its center is inside.
    fn cleared(&self, found: &Rectangle) -> Option<Rectangle> {
        let [first, factor, last] = SHRINKING;
        let mut share = 0.0;
        while share <= last {
            let largest = |k: usize| found.low[k].abs().max(found.high[k].abs());
            let cut = [0, 1].map(|k| share * largest(k));
            let shrunk = Rectangle {
                low: [0, 1].map(|k| found.low[k] + cut[k]),
                high: [0, 1].map(|k| found.high[k] - cut[k]),
            };
            let center = shrunk.center();
            let holds = (0..2).all(|k| shrunk.low[k] < center[k] && center[k] < shrunk.high[k]);
            if !holds {
                return None;
            }
            if !self.edges.iter().any(|&edge| shrunk.is_entered(edge)) {
                return self.is_inside(center).then_some(shrunk);
            }
            share = if share == 0.0 { first } else { factor * share };
        }
        None
    }

    /// Whether an odd number of edges cross the line to the left of p.
    fn is_inside(&self, p: [f64; 2]) -> bool {
        is_inside(self.edges.iter().copied(), p)
    }

    /// Makes a node of a cell.
    fn add(&mut self, cell: Cell, parents: &Rc<[u32]>) -> usize {
        let node = self.nodes.len();
        self.nodes.push(Node::Small);
        let hull = cell.hull();
        let bound = rounded_up(hull.area());
        if bound <= self.goal() {
            self.frontier.close(bound);
            return node;
        }
        let edge = |&&number: &&u32| self.edges[number as usize];
        let core = cell.core();
        if let Some(&entering) = parents.iter().find(|number| core.is_entered(edge(number))) {
            self.nodes[node] = Node::Entered(entering);
            return node;
        }
        let list: Rc<[u32]> =
            parents.iter().filter(|number| hull.is_met(edge(number))).copied().collect();
        for (corner, at) in cell.corner_boxes().iter().enumerate() {
            let is_clear = !list.iter().any(|number| at.is_met(self.edges[*number as usize]));
            if is_clear && !self.is_inside(at.low) {
                self.nodes[node] = Node::Outside(corner);
                return node;
            }
        }
        let middle = cell.middle();
        for axis in 0..2 {
            self.strips += 1;
            let near = list.iter().map(|&number| self.edges[number as usize]);
            let found = widened(&middle, axis, &hull, near);
            self.consider(&found);
        }
        self.frontier.push(bound, node, (cell, list));
        node
    }

    /// Puts the halves of a cell in its place.
    fn open(&mut self, waiting: Waiting<Listed>) {
        let Waiting { bound, node, cell: (cell, list) } = waiting;
        let mut axes = Axis::ALL;
        axes.order_by(&|&one, &other| cell.influence(other).total_cmp(&cell.influence(one)));
        let halves = axes.into_iter().find_map(|axis| Some((axis, cell.halves(axis)?)));
        let Some((axis, [below, above])) = halves else {
            self.frontier.close(bound);
            return;
        };
        let children = [below, above].map(|half| self.add(half, &list));
        self.nodes[node] = Node::Split(axis, children);
    }
}

/// An upper bound of an area of three roundings.
fn rounded_up(area: f64) -> f64 {
    if area > 0.0 { area * (1.0 + 4.0 * f64::EPSILON) } else { 0.0 }
}
