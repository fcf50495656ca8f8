//! Best-first branch and bound over cells of shapes and centers, whose tree is the certificate.
//!
//! *Idea.* The cell of the largest bound is split until that is within the gap. Each cell has the edges that may be nearest to one
//! of its ellipses, out of those of its parent. Middles of cells and the steps of the linear programs are starts of local
//! [`ascent`](super::ascent).
//! *Threads.* Some cells of the largest bounds are split at once, and their children are examined side by side against the best ellipse
//! known before; how many are split does not depend on the number of threads, and so neither does the answer.
//! *Cells of shapes alone* are split until an ellipse changes little in them; then a frame gives them centers, skewed as the shapes.

use std::cmp::Ordering;
use std::sync::Arc;

use taut_points::parallel::ParallelSlice;
use taut_points::{Cancelled, OrderBy, two_to};

use super::ascent::Ellipse;
use super::cell::{Axis, Cell, Frame, Width};
use super::shape::{Nearest, Shape};
use super::tree::{self, Log, Node, Reason};
use super::view::View;
use super::weights::{self, Column};
use super::{EllipseOptions, report, widths};
use crate::frontier::{Frontier, Waiting};
use crate::inner_points::inner_points;
use crate::levels::Levels;
use crate::polygon::Segment;
use crate::units::Units;

/// Half the extent of the shapes of a cell, from its middle, below which it has a frame.
const FRAME_SHAPE_MAX: f64 = 0.51;

/// How far shapes and centers change distances in a cell, relative to the size sought, for weights to be worth their cost.
const WEIGHED_MAX: f64 = 1.2;

/// How much larger than the size sought distances are of edges that are kept.
const KEPT: f64 = 1.1;

/// Starts of ascents before the search, the largest circles first.
const STARTS_MAX: usize = 6;

/// How much larger than the best ellipse another one must be to start an ascent, relatively.
const START_GAIN: f64 = 1e-7;

/// Denominators of the weights in a certificate, as powers of two; the first that closes the cell is taken.
const WEIGHT_BITS: [u32; 3] = [6, 12, 24];

/// Least z of a bound, relative to the size sought.
const LEAST_LENGTH: f64 = 1e-3;

/// How far below the gap asked for bounds are to end, relatively, so that rounding does not miss it.
const GOAL_SLACK: f64 = 1e-12;

/// Largest exponent of the root in size that a checker takes.
const EXPONENT_MAX: f64 = 200.0;

/// Errors of coordinates in a frame, per 1 + |m|, by which an edge must be apart from a box: 2⁻⁴⁰.
const SIDE_ERROR: f64 = two_to(-40);

/// Errors by which a box of all centers is enlarged, per 1 + |m|: 2⁻⁴⁶.
const BOX_ERROR: f64 = two_to(-46);

/// What a search found.
pub(super) struct Found {
    /// The largest ellipse, in units, if one was found.
    pub(super) best: Option<Ellipse>,
    /// No ellipse is larger.
    pub(super) upper: f64,
    pub(super) log: Log,
    /// Exponents of the root: |s| ≤ 2^root[0], 2^root[1] ≤ t ≤ 2^root[2].
    pub(super) root: [i32; 3],
    /// Directions of widths besides the axes.
    pub(super) directions: Vec<[f64; 2]>,
    pub(super) ascents: u64,
    /// Whether no cell was left open by the budget.
    pub(super) is_complete: bool,
}

/// What waits to be split.
struct Open {
    cell: Cell,
    next: Next,
    list: Arc<[u32]>,
    /// Whether the cell, which no edge meets, is known to be inside.
    is_inside: bool,
}

/// What is known of a cell after it was examined.
struct Examined {
    cell: Cell,
    reason: Reason,
    /// The bound of sizes; `None` for a cell outside of the polygon.
    bound: Option<f64>,
    next: Next,
    list: Arc<[u32]>,
    is_inside: bool,
    /// An ellipse that is larger than the best one was.
    larger: Option<Ellipse>,
}

/// What is done to a cell next.
#[derive(Clone, Copy)]
enum Next {
    Split(Axis),
    Frame,
    Nothing,
}

/// The tree so far and the best ellipse.
struct Search<'a> {
    units: &'a Units,
    levels: Levels,
    widths: Vec<Width>,
    best: Option<Ellipse>,
    /// The size of the best ellipse after rounding.
    rounded: f64,
    nodes: Vec<Node>,
    frontier: Frontier<Open>,
    epsilon: f64,
    /// The size of the answer, which a checker knows, where that is not the best ellipse.
    answer_size: Option<f64>,
    ascents: u64,
}

/// Finds the largest ellipse, in units, and the tree that proves it.
///
/// `answer_size` is the size of the answer where that is another ellipse than the one found here.
pub(super) fn search(
    units: &Units,
    options: &EllipseOptions<'_>,
    answer_size: Option<f64>,
) -> Result<Found, Cancelled> {
    let directions = widths::narrow_directions(&units.edges);
    let all = [[1.0, 0.0], [0.0, 1.0]].into_iter().chain(directions.iter().copied());
    let mut search = Search {
        units,
        levels: Levels::of(&units.edges, units.extent[1]),
        widths: all.map(|direction| widths::width(&units.edges, direction)).collect(),
        best: None,
        rounded: 0.0,
        nodes: vec![],
        frontier: Frontier::new(),
        epsilon: options.epsilon,
        answer_size,
        ascents: 0,
    };
    search.start();
    if search.rounded <= 0.0 {
        search.best = None;
        return Ok(search.found([0, -1, 1], directions, false));
    }
    let (root, beyond) = search.root();
    search.frontier.close(beyond);
    let [s, low, high] = root.map(two_to);
    let list: Arc<[u32]> = (0..units.edges.len() as u32).collect();
    let cell = Cell { s: [-s, s], t: [low, high], frame: None };
    let examined = search.examine(cell, &list, false);
    search.add(examined);
    let is_complete = loop {
        options.monitor.check()?;
        let room = options.max_cells.saturating_sub(search.nodes.len() as u64) / 2;
        if room == 0 {
            break search.frontier.is_within(search.goal());
        }
        let goal = search.goal();
        let batch = search.frontier.batch(goal, room as usize);
        if batch.is_empty() {
            break true;
        }
        search.open(batch);
    };
    Ok(search.found(root, directions, is_complete))
}

impl Search<'_> {
    fn size(&self) -> f64 {
        self.best.map_or(0.0, |best| best.size)
    }

    /// The largest bound that closes a cell.
    fn goal(&self) -> f64 {
        self.rounded * (1.0 + self.epsilon).sqrt() * (1.0 - GOAL_SLACK)
    }

    /// Climbs from the largest circles around middles of lines.
    fn start(&mut self) {
        for circle in largest_circles(self.units, STARTS_MAX) {
            self.climb(circle);
        }
    }

    /// Exponents of a root beyond which no ellipse is as large as the best, and a bound of the sizes beyond.
    fn root(&self) -> ([i32; 3], f64) {
        let (w, h) = (self.widths[0].square, self.widths[1].square);
        let least = self.size() * self.size();
        let s = (h / (2.0 * least)).log2().ceil().clamp(0.0, EXPONENT_MAX);
        let low = (least / w).log2().floor().clamp(-EXPONENT_MAX, -1.0);
        let high = (h / least).log2().ceil().clamp(1.0, EXPONENT_MAX);
        let beyond = (w * low.exp2()).max(h / high.exp2()).max(h / (2.0 * s.exp2())).sqrt();
        ([s as i32, low as i32, high as i32], beyond * (1.0 + 1e-14))
    }

    /// The ellipse among all edges in the place of one among a list of them, if it is larger than the best so far.
    fn larger(&self, ellipse: Ellipse) -> Option<Ellipse> {
        let least = self.size() * (1.0 + START_GAIN);
        let edges = &self.units.edges;
        if ellipse.size <= least || !self.levels.is_inside(edges, ellipse.center) {
            return None;
        }
        Some(Ellipse::of(ellipse.shape, ellipse.center, edges)).filter(|all| all.size > least)
    }

    /// Takes an ellipse with its center inside and what it climbs to, if that is the best so far.
    fn climb(&mut self, from: Ellipse) {
        self.ascents += 1;
        let edges = &self.units.edges;
        for ellipse in [from, from.climbed(edges)] {
            if ellipse.size > self.size()
                && self.levels.is_inside(edges, ellipse.center)
                && let Some(reported) = report::rounded(&ellipse, self.units)
                && reported.size > self.rounded
            {
                self.best = Some(ellipse);
                self.rounded = reported.size;
            }
        }
    }

    /// Makes a node of a cell, and keeps it to be split if its bound does not close it.
    fn add(&mut self, examined: Examined) -> usize {
        let Examined { cell, reason, bound, next, list, is_inside, larger } = examined;
        let node = self.nodes.len();
        self.nodes.push(Node::Leaf(reason));
        if let Some(larger) = larger.filter(|larger| larger.size > self.size()) {
            self.climb(larger);
        }
        let Some(bound) = bound else { return node };
        match next {
            Next::Nothing => self.frontier.close(bound),
            _ if bound <= self.goal() => self.frontier.close(bound),
            _ => self.frontier.push(bound, node, Open { cell, next, list, is_inside }),
        }
        node
    }

    /// Finds a reason for a cell, and what is done to it next.
    fn examine(&self, cell: Cell, parents: &Arc<[u32]>, is_inside: bool) -> Examined {
        let bound = cell.width_bound(&self.widths);
        let by_widths = |next| {
            let (reason, list) = (Reason::Widths, parents.clone());
            Examined { cell, reason, bound: Some(bound), next, list, is_inside, larger: None }
        };
        match cell.frame {
            None => {
                let [s, t] = cell.half_shape();
                by_widths(match () {
                    () if s > FRAME_SHAPE_MAX && s > t => Next::Split(Axis::S),
                    () if t > FRAME_SHAPE_MAX => Next::Split(Axis::T),
                    () => Next::Frame,
                })
            }
            Some(_) if bound <= self.goal() => by_widths(Next::Nothing),
            Some(frame) => self.examine_centers(cell, &frame, parents, is_inside),
        }
    }

    /// Finds a reason for a cell with centers, and how to split it.
    fn examine_centers(
        &self,
        cell: Cell,
        frame: &Frame,
        parents: &Arc<[u32]>,
        inside: bool,
    ) -> Examined {
        let units = self.units;
        let edge = |number: u32| units.edges[number as usize];
        let view = View::of(&cell, frame);
        let all: Vec<Nearest> =
            parents.iter().map(|&number| view.shape.nearest(view.middle, edge(number))).collect();
        let (mut first, mut distance) = (0, f64::INFINITY);
        for (i, nearest) in all.iter().enumerate() {
            if nearest.length < distance {
                (first, distance) = (i, nearest.length);
            }
        }
        let most = ((distance + view.reach()) * view.factor).min(KEPT * self.goal());
        let kept = view.factor * most.max(distance) + view.reach();
        let places: Vec<usize> = (0..all.len()).filter(|&i| all[i].length <= kept).collect();
        let list: Arc<[u32]> = places.iter().map(|&i| parents[i]).collect();
        let mut is_inside = inside;
        if !inside && !list.iter().any(|&number| meets(edge(number), frame)) {
            is_inside = self.levels.is_inside(&units.edges, view.middle);
            if !is_inside {
                let (reason, bound, next) = (Reason::Outside, None, Next::Nothing);
                return Examined { cell, reason, bound, next, list, is_inside, larger: None };
            }
        }
        let middle = Ellipse { shape: view.shape, center: view.middle, size: distance };
        let mut larger = self.larger(middle);
        let least = LEAST_LENGTH * self.answer_size.unwrap_or(self.size());
        // There is a nearest edge, as each list has one.
        let single = parents[first];
        let mut bound = cell.edge_bound(&[(edge(single), 1.0)], least);
        let mut reason = Reason::Edges(vec![(single, 1)]);
        let by_widths = cell.width_bound(&self.widths);
        if by_widths < bound {
            (reason, bound) = (Reason::Widths, by_widths);
        }
        let changes = view.changes(self.size().max(distance));
        if bound > self.goal() && changes.iter().sum::<f64>() <= WEIGHED_MAX {
            let columns: Vec<Column> = places.iter().map(|&i| view.column(&all[i])).collect();
            let found = weights::best(&columns);
            if found.value > self.size() * (1.0 + START_GAIN) {
                let (shape, center) = view.stepped(frame, found.step);
                let some: Vec<Segment> = list.iter().map(|&number| edge(number)).collect();
                let stepped = self.larger(Ellipse::of(shape, center, &some));
                larger = [larger, stepped].into_iter().flatten().max_by(by_size);
            }
            for bits in WEIGHT_BITS {
                let whole = |&(i, weight): &(usize, f64)| {
                    (list[i], (weight * (1u64 << bits) as f64).round() as u64)
                };
                let parts: Vec<(u32, u64)> =
                    found.parts.iter().map(whole).filter(|part| part.1 > 0).collect();
                let sum = parts.iter().map(|part| part.1).sum::<u64>() as f64;
                let weighted: Vec<(Segment, f64)> =
                    parts.iter().map(|&(number, w)| (edge(number), w as f64 / sum)).collect();
                let value = cell.edge_bound(&weighted, least);
                if value < bound {
                    (reason, bound) = (Reason::Edges(parts), value);
                }
                if bound <= self.goal() {
                    break;
                }
            }
        }
        let mut axes =
            [Axis::S, Axis::T, Axis::X, Axis::Y].into_iter().zip(changes).collect::<Vec<_>>();
        axes.order_by(&|one, other| other.1.total_cmp(&one.1));
        let axis = axes.into_iter().map(|axis| axis.0).find(|&axis| cell.halves(axis).is_some());
        let next = axis.map_or(Next::Nothing, Next::Split);
        Examined { cell, reason, bound: Some(bound), next, list, is_inside, larger }
    }

    /// Puts children in the place of cells.
    fn open(&mut self, batch: Vec<Waiting<Open>>) {
        let this = &*self;
        let children: Vec<Vec<Examined>> = batch
            .par_iter()
            .map(|Waiting { cell: Open { cell, next, list, is_inside }, .. }| match next {
                Next::Split(axis) => {
                    let halves = cell.halves(*axis).into_iter().flatten();
                    halves.map(|half| this.examine(half, list, *is_inside)).collect()
                }
                Next::Frame => vec![this.examine(this.framed(cell), list, false)],
                Next::Nothing => vec![],
            })
            .collect();
        for (Waiting { node, bound, cell: Open { next, .. } }, examined) in
            batch.into_iter().zip(children)
        {
            let added: Vec<usize> = examined.into_iter().map(|child| self.add(child)).collect();
            match (next, &added[..]) {
                (Next::Split(axis), &[below, above]) => {
                    self.nodes[node] = Node::Split(axis, [below, above]);
                }
                (Next::Frame, &[child]) => self.nodes[node] = Node::Framed(child),
                _ => self.frontier.close(bound),
            }
        }
    }

    /// The cell with all centers, skewed as the middle of its shapes.
    fn framed(&self, cell: &Cell) -> Cell {
        let skew = 0.5 * cell.s[0] + 0.5 * cell.s[1];
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for [p, _] in &self.units.edges {
            let p = [p[0], p[1] + skew * p[0]];
            for k in 0..2 {
                (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
            }
        }
        let error = BOX_ERROR * (1.0 + skew.abs());
        let (low, high) = (low.map(|x| x - error), high.map(|x| x + error));
        let s = cell.s.map(|s| s - skew);
        Cell { s, t: cell.t, frame: Some(Frame { skew, low, high }) }
    }

    /// The tree in the form of the certificate, and what it proves.
    fn found(self, root: [i32; 3], directions: Vec<[f64; 2]>, is_complete: bool) -> Found {
        let log = tree::log(&self.nodes);
        // Cells that were closed on the way have bounds up to the goal.
        let upper = self.frontier.upper().max(self.goal());
        let (best, ascents) = (self.best, self.ascents);
        Found { best, upper, log, root, directions, ascents, is_complete }
    }
}

fn by_size(one: &Ellipse, other: &Ellipse) -> Ordering {
    one.size.total_cmp(&other.size)
}

/// The largest of the circles around middles of lines, in descending order.
pub(super) fn largest_circles(units: &Units, most: usize) -> Vec<Ellipse> {
    let circle = |center| Ellipse::of(Shape::new(0.0, 1.0), center, &units.edges);
    let centers = inner_points(&units.edges, units.extent);
    let mut circles: Vec<Ellipse> = centers.into_iter().map(circle).collect();
    circles.order_by(&|one, other| other.size.total_cmp(&one.size));
    circles.truncate(most);
    circles
}

/// Whether an edge may meet the box of centers of a frame, or come as near as rounding.
fn meets(edge: Segment, frame: &Frame) -> bool {
    let error = SIDE_ERROR * (1.0 + frame.skew.abs());
    let [a, b] = edge.map(|p| frame.skewed(p));
    let (low, high) = (frame.low.map(|x| x - error), frame.high.map(|x| x + error));
    if (0..2).any(|k| a[k].max(b[k]) < low[k] || a[k].min(b[k]) > high[k]) {
        return false;
    }
    let corners = Frame { skew: frame.skew, low, high }.corners();
    let sides = corners.map(|c| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    !(sides.iter().all(|&side| side > error) || sides.iter().all(|&side| side < -error))
}
