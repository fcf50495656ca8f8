//! Best-first branch and bound over boxes of the three corners, whose tree is the certificate.
//!
//! *Idea.* The cell of the largest bound is split until that is within the gap. Each cell has the groups of edges that may enter one of
//! its triangles, out of those of its parent. Steps of the linear programs are starts of local [`ascent`](super::ascent).
//! *Threads.* Some cells of the largest bounds are split at once, and their children are examined side by side against the best triangle
//! known before; how many are split does not depend on the number of threads, and so neither does the answer.
//! *Order of reasons*, the cheapest first: corner 0 is not a lowest one, a box is outside, the boxes bound the area, an edge enters all
//! triangles, the mean of the middles is in all triangles and outside, conditions with weights bound the area.

use std::sync::Arc;

use taut_points::parallel::ParallelSlice;
use taut_points::{Cancelled, OrderBy};

use super::ascent::Candidate;
use super::bound::{doubled_area, row_error};
use super::cell::{self, Cell, ROWS};
use super::gauge::{self, Triangle, centroid};
use super::report::{self, Reported, Target};
use super::rows::{self, Condition, Entered};
use super::tile::Tiles;
use super::tree::{self, Leaf, Log, Node, Reason};
use super::{TriangleOptions, starts};
use crate::frontier::{Frontier, Waiting};
use crate::program::{self, Column};

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

/// A cell that waits to be split, and the groups of edges that may enter.
type Listed = (Cell, Arc<[u32]>);

/// What is known of a cell after it was examined.
struct Examined {
    reason: Reason,
    /// The bound of the area; `None` for a cell that holds no triangle of the polygon.
    bound: Option<f64>,
    /// The groups of edges, where they are not those of the parent.
    list: Option<Arc<[u32]>>,
    /// A triangle that is larger than the best one was.
    larger: Option<Candidate>,
}

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
    frontier: Frontier<Listed>,
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
        frontier: Frontier::new(),
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
    let list: Arc<[u32]> = Arc::new([target.groups.root()]);
    let cell = [root.clone(), root.clone(), root];
    let examined = search.examine(&cell, &list);
    search.add(cell, &list, examined);
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
    Ok(search.found(is_complete))
}

impl Search<'_> {
    /// The largest bound that closes a cell.
    fn goal(&self) -> f64 {
        let reported = self.reported.as_ref().map_or(0.0, |reported| reported.doubled);
        reported * (1.0 + self.epsilon) * (1.0 - GOAL_SLACK)
    }

    /// A triangle, scaled until no edge enters, if that is larger than the best so far.
    fn larger(&self, triangle: &Triangle) -> Option<Candidate> {
        let least = self.best * (1.0 + START_GAIN);
        Candidate::of(triangle, &self.target.groups, SCALE_MAX)
            .filter(|found| found.doubled > least && self.tiles.is_inside(centroid(&found.corners)))
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

    /// Looks for a reason that closes a cell, and for a larger triangle.
    fn examine(&self, cell: &Cell, parents: &[u32]) -> Examined {
        let closed = |reason| Examined { reason, bound: None, list: None, larger: None };
        if cell::is_disordered(cell) {
            return closed(Reason::Disordered);
        }
        if cell.iter().any(|tile| tile.is_outside) {
            return closed(Reason::Outside);
        }
        let bound = doubled_area(cell, &[], self.error);
        if bound <= self.goal() {
            return Examined { bound: Some(bound), ..closed(Reason::Area) };
        }
        let lines = cell::lines(cell);
        let (kept, conditions) =
            match rows::examine(&self.target.groups, &lines, parents, self.error) {
                Entered::Surely(edge, share) => {
                    return closed(Reason::Entered(Leaf::Point(edge, share)));
                }
                Entered::Perhaps(kept, conditions) => (kept, conditions),
            };
        let mean = centroid(&cell::middle(cell));
        if lines.iter().all(|side| side.range(mean)[0] > self.error) && !self.tiles.is_inside(mean)
        {
            return closed(Reason::MeanOutside);
        }
        let list = (kept[..] != *parents).then(|| kept.into());
        let mut found = Examined { bound: Some(bound), list, ..closed(Reason::Area) };
        if bound <= WEIGHED_MAX * self.goal() {
            self.weigh(cell, &mut found, conditions, bound);
        }
        found
    }

    /// Makes a node of a cell, and keeps it to be split if its bound does not close it.
    fn add(&mut self, cell: Cell, parents: &Arc<[u32]>, examined: Examined) -> usize {
        let Examined { reason, bound, list, larger } = examined;
        let node = self.nodes.len();
        self.nodes.push(Node::Leaf(reason));
        if let Some(larger) = larger.filter(|larger| larger.doubled > self.best) {
            self.climb(larger);
        }
        match bound {
            None => {}
            Some(bound) if bound <= self.goal() => self.frontier.close(bound),
            Some(bound) => {
                self.frontier.push(bound, node, (cell, list.unwrap_or_else(|| parents.clone())));
            }
        }
        node
    }

    /// Looks for weights that bound the area in a cell, and for a larger triangle.
    fn weigh(
        &self,
        cell: &Cell,
        examined: &mut Examined,
        mut conditions: Vec<(f64, Condition)>,
        mut bound: f64,
    ) {
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
            examined.larger = self.larger(&step);
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
                examined.reason = Reason::Rows(leaf);
                (bound, is_closed) = (value, value <= goal);
            }
        }
        examined.bound = Some(bound);
    }

    /// Puts children in the place of cells.
    fn open(&mut self, batch: Vec<Waiting<Listed>>) {
        let mut split = vec![];
        for waiting in batch {
            match self.split(&waiting.cell.0) {
                Some((coordinate, cells)) => split.push((waiting, coordinate, cells)),
                None => self.frontier.close(waiting.bound),
            }
        }
        // Threads change no count of references: counts lie beside what other threads read.
        let this = &*self;
        let children: Vec<[Examined; 2]> = split
            .par_iter()
            .map(|(Waiting { cell: (_, list), .. }, _, halves)| {
                halves.each_ref().map(|half| this.examine(half, list))
            })
            .collect();
        for ((waiting, coordinate, [low, high]), [below, above]) in split.into_iter().zip(children)
        {
            let Waiting { node, cell: (_, list), .. } = waiting;
            let children = [self.add(low, &list, below), self.add(high, &list, above)];
            self.nodes[node] = Node::Split(coordinate, children);
        }
    }

    /// The halves of a cell by the coordinate of the largest influence that has halves, and that coordinate.
    fn split(&mut self, cell: &Cell) -> Option<(u8, [Cell; 2])> {
        let mut order: Vec<(usize, f64)> = cell::influences(cell).into_iter().enumerate().collect();
        order.order_by(&|one, other| other.1.total_cmp(&one.1));
        order.into_iter().find_map(|(coordinate, _)| {
            let (corner, axis) = (coordinate / 2, coordinate % 2);
            let halves = self.tiles.halves(&cell[corner], axis)?.map(|half| {
                let mut child = cell.clone();
                child[corner] = half;
                child
            });
            Some((coordinate as u8, halves))
        })
    }

    /// The tree in the form of the certificate, and what it proves.
    fn found(self, is_complete: bool) -> Found {
        let log = tree::log(&self.nodes);
        let reported = self.reported.as_ref().map_or(0.0, |reported| reported.doubled);
        let upper = self.frontier.upper().max(reported);
        let (best, ascents) = (self.reported, self.ascents);
        Found { best, upper, log, ascents, is_complete }
    }
}
