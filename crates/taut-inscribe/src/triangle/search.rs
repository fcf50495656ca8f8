//! Best-first branch and bound over boxes of the three corners, whose tree is the certificate.
//!
//! *Idea.* The cell of the largest bound is split until that is within the gap. Each cell has the groups of edges that may enter one of
//! its triangles, out of those of its parent. Steps of the linear programs are starts of local [`ascent`](super::ascent).
//! *Order of reasons*, the cheapest first: corner 0 is not a lowest one, a box is outside, the boxes bound the area, an edge enters all
//! triangles, the mean of the middles is in all triangles and outside, conditions with weights bound the area.

use std::cmp::Ordering;
use std::collections::BinaryHeap;
use std::rc::Rc;

use taut_points::Cancelled;

use super::ascent::Candidate;
use super::bound::{doubled_area, row_error};
use super::cell::{self, Cell, ROWS};
use super::gauge::{self, Triangle, centroid};
use super::report::{self, Reported, Target};
use super::rows::{self, Condition, Entered};
use super::tile::Tiles;
use super::tree::{self, Leaf, Log, Node, Reason};
use super::{TriangleOptions, starts};
use crate::program::{self, Column};

/// Cells between two looks at the monitor.
const CELLS_BETWEEN_LOOKS: u64 = 256;

/// How much larger than the area sought that of the boxes alone may be for conditions to be worth their cost.
const WEIGHED_MAX: f64 = 6.0;

/// Most conditions by edges in the program of a cell; of more those that its middle breaks most.
const CONDITIONS_MAX: usize = 64;

/// How much larger than the best triangle another one must be to start an ascent, relatively.
const START_GAIN: f64 = 1e-7;

/// Bits of the weights and of the normals in a certificate: the first are tried, then the shorter or the longer ones.
const PRECISIONS: [[u32; 2]; 3] = [[12, 14], [5, 8], [22, 28]];

/// How much larger than a step the triangle may be that is taken instead, in length.
const SCALE_MAX: f64 = 2.0;

/// How far below the gap asked for bounds are to end, relatively, so that rounding does not miss it.
const GOAL_SLACK: f64 = 1e-12;

/// What a search found.
pub(super) struct Found {
    /// The largest triangle, if one was found.
    pub(super) best: Option<Reported>,
    /// Twice the area that none exceeds, in the frame.
    pub(super) upper: f64,
    pub(super) log: Log,
    pub(super) ascents: u64,
    /// Whether no cell was left open by the budget.
    pub(super) is_complete: bool,
}

/// A cell that waits to be split.
struct Waiting {
    bound: f64,
    node: usize,
    cell: Cell,
    /// The groups of edges that may enter.
    list: Rc<[u32]>,
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

/// The tree so far and the best triangle.
struct Search<'a> {
    target: &'a Target<'a>,
    tiles: Tiles<'a>,
    /// The error of a condition.
    error: f64,
    /// Twice the area of the best triangle, before it was rounded.
    best: f64,
    reported: Option<Reported>,
    nodes: Vec<Node>,
    waiting: BinaryHeap<Waiting>,
    /// The largest bound of cells that are closed or cannot be split.
    stuck: f64,
    epsilon: f64,
    ascents: u64,
}

/// Finds the largest triangle and the tree that proves it.
pub(super) fn search(
    target: &Target<'_>,
    options: &TriangleOptions<'_>,
) -> Result<Found, Cancelled> {
    let tiles = Tiles::of(target.frame);
    let root = tiles.root();
    let mut search = Search {
        target,
        tiles,
        error: row_error(target.frame.error),
        best: 0.0,
        reported: None,
        nodes: vec![],
        waiting: BinaryHeap::new(),
        stuck: 0.0,
        epsilon: options.epsilon,
        ascents: 0,
    };
    for start in starts::starts(target.frame, &target.groups) {
        options.monitor.check()?;
        search.climb(start);
    }
    if search.reported.is_none() {
        return Ok(search.found(false));
    }
    let list: Rc<[u32]> = Rc::new([target.groups.root()]);
    search.add([root.clone(), root.clone(), root], &list);
    let mut opened = 0;
    let is_complete = loop {
        if opened % CELLS_BETWEEN_LOOKS == 0 {
            options.monitor.check()?;
        }
        opened += 1;
        if search.nodes.len() as u64 + 2 > options.max_cells {
            break search.waiting.peek().is_none_or(|top| top.bound <= search.goal());
        }
        match search.waiting.pop() {
            None => break true,
            Some(top) if top.bound <= search.goal() => {
                search.stuck = search.stuck.max(top.bound);
                break true;
            }
            Some(top) => search.open(top),
        }
    };
    Ok(search.found(is_complete))
}

impl Search<'_> {
    /// The largest bound that closes a cell.
    fn goal(&self) -> f64 {
        let reported = self.reported.as_ref().map_or(0.0, |reported| reported.doubled);
        reported * (1.0 + self.epsilon) * (1.0 - GOAL_SLACK)
    }

    /// Takes a triangle, scaled until no edge enters, and what it climbs to, if that is the best so far.
    fn consider(&mut self, triangle: &Triangle) {
        let least = self.best * (1.0 + START_GAIN);
        if let Some(found) = Candidate::of(triangle, &self.target.groups, SCALE_MAX)
            && found.doubled > least
            && self.tiles.is_inside(centroid(&found.corners))
        {
            self.climb(found);
        }
    }

    /// Takes a triangle that no edge enters, and what it climbs to, if that is the best so far.
    fn climb(&mut self, from: Candidate) {
        self.ascents += 1;
        for found in [from, from.climbed(&self.target.groups)] {
            if found.doubled > self.best && self.tiles.is_inside(centroid(&found.corners)) {
                let reported = report::rounded(&found.corners, self.target);
                let before = self.reported.as_ref().map_or(0.0, |reported| reported.doubled);
                if let Some(reported) = reported.filter(|reported| reported.doubled > before) {
                    self.best = found.doubled;
                    self.reported = Some(reported);
                }
            }
        }
    }

    /// Makes a node of a cell, with a reason, and keeps it to be split if that does not close it.
    fn add(&mut self, cell: Cell, parents: &Rc<[u32]>) -> usize {
        let node = self.nodes.len();
        self.nodes.push(Node::Leaf(Reason::Area));
        if cell::is_disordered(&cell) {
            self.nodes[node] = Node::Leaf(Reason::Disordered);
            return node;
        }
        if cell.iter().any(|tile| tile.is_outside) {
            self.nodes[node] = Node::Leaf(Reason::Outside);
            return node;
        }
        let bound = doubled_area(&cell, &[], self.error);
        if bound <= self.goal() {
            self.stuck = self.stuck.max(bound);
            return node;
        }
        let lines = cell::lines(&cell);
        let (kept, conditions) =
            match rows::examine(&self.target.groups, &lines, parents, self.error) {
                Entered::Surely(edge, share) => {
                    self.nodes[node] = Node::Leaf(Reason::Entered(Leaf::Point(edge, share)));
                    return node;
                }
                Entered::Perhaps(kept, conditions) => (kept, conditions),
            };
        let mean = centroid(&cell::middle(&cell));
        if lines.iter().all(|side| side.range(mean)[0] > self.error) && !self.tiles.is_inside(mean)
        {
            self.nodes[node] = Node::Leaf(Reason::MeanOutside);
            return node;
        }
        let list = if kept[..] == parents[..] { parents.clone() } else { kept.into() };
        let bound = match bound <= WEIGHED_MAX * self.goal() {
            true => self.weigh(node, &cell, conditions, bound),
            false => bound,
        };
        match bound <= self.goal() {
            true => self.stuck = self.stuck.max(bound),
            false => self.waiting.push(Waiting { bound, node, cell, list }),
        }
        node
    }

    /// Looks for weights that bound the area in a cell, and for a larger triangle; returns the bound.
    fn weigh(
        &mut self,
        node: usize,
        cell: &Cell,
        mut conditions: Vec<(f64, Condition)>,
        mut bound: f64,
    ) -> f64 {
        if conditions.len() > CONDITIONS_MAX {
            conditions.select_nth_unstable_by(CONDITIONS_MAX, |one, other| {
                other.0.total_cmp(&one.0).then(one.1.key().cmp(&other.1.key()))
            });
            conditions.truncate(CONDITIONS_MAX);
        }
        let of_edges = conditions.into_iter().map(|pair| pair.1);
        let of_boxes = rows::half_planes(cell, &self.tiles);
        let column = |condition| (rows::column(cell, &self.tiles, &condition), condition);
        let mut all: Vec<(Column<ROWS>, Condition)> =
            of_edges.chain(of_boxes).map(column).collect();
        all.retain(|(column, _)| column.can_bind());
        let columns: Vec<Column<ROWS>> = all.iter().map(|pair| pair.0).collect();
        let middle = cell::middle(cell);
        let at_middle = gauge::doubled_area(&middle);
        let changes = cell::changes(cell);
        let enough = self.goal() - at_middle - 4.0 * self.error;
        let found = program::best(&columns, &changes, enough - 1e-9 * self.goal());
        if found.value > enough {
            let mut step = middle;
            let half = cell.each_ref().map(|tile| tile.half());
            for corner in 0..3 {
                for k in 0..2 {
                    step[corner][k] += found.step[2 * corner + k] * half[corner][k];
                }
            }
            self.consider(&step);
        }
        let weighted: Vec<(Condition, f64)> =
            found.parts.iter().map(|&(i, weight)| (all[i].1, weight)).collect();
        let goal = self.goal();
        let mut is_closed = false;
        for (place, precision) in PRECISIONS.into_iter().enumerate() {
            // The second is shorter, the third is for programs that close the cell with exact weights.
            let is_tried = match place {
                0 => true,
                1 => is_closed,
                _ => !is_closed && found.value <= enough,
            };
            if !is_tried {
                continue;
            }
            let leaf = rows::leaf(cell, &self.tiles, &weighted, precision, self.error);
            if let Some((leaf, value)) = leaf
                && (value < bound || value <= goal)
            {
                self.nodes[node] = Node::Leaf(Reason::Rows(leaf));
                (bound, is_closed) = (value, value <= goal);
            }
        }
        bound
    }

    /// Puts the children of a cell in its place.
    fn open(&mut self, waiting: Waiting) {
        let Waiting { node, cell, list, bound } = waiting;
        let mut order: Vec<(usize, f64)> =
            cell::influences(&cell).into_iter().enumerate().collect();
        order.sort_by(|one, other| other.1.total_cmp(&one.1));
        for (coordinate, _) in order {
            let (corner, axis) = (coordinate / 2, coordinate % 2);
            if let Some(halves) = self.tiles.halves(&cell[corner], axis) {
                let children = halves.map(|half| {
                    let mut child = cell.clone();
                    child[corner] = half;
                    self.add(child, &list)
                });
                self.nodes[node] = Node::Split(coordinate as u8, children);
                return;
            }
        }
        self.stuck = self.stuck.max(bound);
    }

    /// The tree in the form of the certificate, and what it proves.
    fn found(self, is_complete: bool) -> Found {
        let log = tree::log(&self.nodes);
        let waiting = self.waiting.peek().map_or(0.0, |top| top.bound);
        let reported = self.reported.as_ref().map_or(0.0, |reported| reported.doubled);
        let upper = waiting.max(self.stuck).max(reported);
        let (best, ascents) = (self.reported, self.ascents);
        Found { best, upper, log, ascents, is_complete }
    }
}
