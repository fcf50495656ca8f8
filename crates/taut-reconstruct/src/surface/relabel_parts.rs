//! Small parts of the tree that most of their facets object to, turned over.
//!
//! *Problem.* The label of a cell hangs on a single path through the tree, however many facets around it say otherwise.
//! *Idea.* Without one of its edges the tree falls into two parts. The facets between them are what the edge stands for; if they
//! disagree with the labels by more than [`DISAGREEMENT_MIN`] in sum, the smaller part is turned over. Leaves are peeled off the tree as long as
//! what hangs on them is small; sums over all parts come from sums along the peeling: a facet counts at both its cells, and twice
//! against it where the ways from them meet. Few facets disagree at all, so sums are formed only for parts that those which do could
//! outweigh, as is found along the peeling as well; cells between two such parts count for the one around them. Once a part was turned
//! over, all parts under the outermost ones beside it are weighed.
//! *Guarantee.* Each round raises the agreement of all facets with the labels. Sums are exact, so the answer is a function of the points.
//! O(n), and O(suspects) for each of at most [`ROUNDS_MAX`] rounds.
//! *Trap.* Large parts are left alone: under strong noise whole regions would be turned back and forth.

use std::collections::HashSet;

use taut_delaunay::decode;
use taut_points::parallel::IntoParallel;

use super::cells::Cells;
use super::dual_edges::{CERTAIN_STEPS, DualEdge, DualEdges};

/// The largest part has this many cells.
const PART_CELLS_MAX: u8 = 100;
/// The least disagreement, half of what a certain facet says. Of 1, 0.5, 0.2 and 0 it did best on the seven sets at 70 %; from 0.2 down
/// other sets lose.
const DISAGREEMENT_MIN: i64 = CERTAIN_STEPS / 2;
const ROUNDS_MAX: usize = 12;
/// This many cells are weighed at a time.
const CELLS_PER_BATCH: usize = 256;
/// Cells of one task.
const TASK: usize = 1 << 14;
/// No place.
const NONE: u32 = u32::MAX;

/// The small parts of the tree: for each cell that was peeled off, what it hung on.
struct Peeling<'a> {
    cells: &'a Cells,
    /// The facets of the tree, one bit each.
    tree: &'a [u8],
    /// By cell the facet that it hung by, as seen from what it hung on; [`NONE`] for those that were not peeled off.
    up: Vec<u32>,
    /// The cells in the order in which they were peeled off: those of a part before what it hung on.
    order: Vec<u32>,
}

impl<'a> Peeling<'a> {
    /// Peels a tree of facets; ghosts stay.
    fn of(tree: &'a [u8], cells: &'a Cells) -> Self {
        let mut left = tree.to_vec();
        let mut size = vec![1u8; cells.len()];
        let mut up = vec![NONE; cells.len()];
        let mut order = Vec::with_capacity(cells.len());
        for start in 0..cells.len() as u32 {
            let mut leaf = start;
            while left[leaf as usize].is_power_of_two()
                && size[leaf as usize] <= PART_CELLS_MAX
                && !cells.is_ghost(leaf)
            {
                let place = left[leaf as usize].trailing_zeros();
                let facet = cells.mirror(leaf << 2 | place);
                up[leaf as usize] = facet;
                let (parent, back) = decode(facet);
                order.push(leaf);
                left[leaf as usize] = 0;
                left[parent as usize] &= !(1 << back);
                size[parent as usize] = size[parent as usize].saturating_add(size[leaf as usize]);
                leaf = parent;
            }
        }
        Self { cells, tree, up, order }
    }

    /// Returns what a peeled cell hung on.
    fn parent(&self, cell: u32) -> u32 {
        self.up[cell as usize] >> 2
    }

    /// The cell and all that hang on it, each after what it hangs on.
    fn under(&self, cell: u32) -> Vec<u32> {
        let mut all = vec![cell];
        let mut next = 0;
        while let Some(&cell) = all.get(next) {
            let across = (0..4).filter(|i| self.tree[cell as usize] >> i & 1 == 1);
            let across = across.map(|i| self.cells.across(cell, i).0);
            all.extend(across.filter(|&other| self.parent(other) == cell));
            next += 1;
        }
        all
    }

    /// Returns true if so much is said against the part that hangs by a peeled cell that it could be turned over.
    fn is_outweighed(
        &self,
        cell: u32,
        against: i64,
        dual_edges: &DualEdges,
        inside: &[bool],
    ) -> bool {
        if against <= DISAGREEMENT_MIN {
            return false;
        }
        if self.tree[cell as usize].is_power_of_two() {
            // The cell is all of the part.
            return agreement(cell, dual_edges, self.cells, inside) < -DISAGREEMENT_MIN;
        }
        // What the part hangs by was obeyed, and agrees.
        against > DISAGREEMENT_MIN + i64::from(dual_edges.at(self.up[cell as usize]).weight())
    }
}

/// Parts that the facets which disagree could outweigh, each after those around it.
struct Suspects<'a> {
    dual_edges: &'a DualEdges,
    peeling: &'a Peeling<'a>,
    parts: Vec<Part>,
    /// By cell the innermost part that it is in, counted from one, so that nothing is written for cells that are in none.
    home: Vec<u32>,
    /// The cells of parts that were turned over.
    turned: Vec<u32>,
}

/// The subtree below a cell, the cell included.
#[derive(Clone, Copy)]
struct Part {
    cell: u32,
    /// The next part around it, or none.
    outer: u32,
    /// The outermost part around it. What is under different ones never meets.
    top: u32,
    /// By how much the facets around it agree with the labels.
    sum: i64,
}

/// A dual edge of cells in two parts: the parts, and how much it agrees with the labels.
#[derive(Clone, Copy, Default)]
struct PartEdge {
    parts: [u32; 2],
    agrees: i64,
}

impl<'a> Suspects<'a> {
    fn of(
        objections: &[(u32, i64)],
        dual_edges: &'a DualEdges,
        peeling: &'a Peeling<'a>,
        inside: &[bool],
    ) -> Self {
        let against = against(objections, peeling);
        let home = vec![0u32; peeling.cells.len()];
        let mut suspects =
            Self { dual_edges, peeling, parts: Vec::new(), home, turned: Vec::new() };
        for &cell in peeling.order.iter().rev() {
            let around = suspects.home[peeling.parent(cell) as usize];
            suspects.home[cell as usize] = around;
            if peeling.is_outweighed(cell, against[cell as usize], dual_edges, inside) {
                let part = suspects.parts.len() as u32;
                let top = suspects.parts.get(around.wrapping_sub(1) as usize);
                suspects.begin(cell, top.map_or(part, |part| part.top));
            }
        }
        suspects.weigh_all(inside);
        suspects
    }

    /// Begins the part that hangs by a cell, within the one that the cell hangs on, if that is in any.
    fn begin(&mut self, cell: u32, top: u32) {
        let outer = self.part(self.peeling.parent(cell));
        self.parts.push(Part { cell, outer, top, sum: 0 });
        self.home[cell as usize] = self.parts.len() as u32;
    }

    /// The innermost part that a cell is in, or none.
    fn part(&self, cell: u32) -> u32 {
        self.home[cell as usize].wrapping_sub(1)
    }

    /// The innermost part that two are in, or none.
    fn meet(&self, [mut a, mut b]: [u32; 2]) -> u32 {
        if self.parts[a as usize].top != self.parts[b as usize].top {
            return NONE;
        }
        while a != b {
            // A part comes after those around it, so the latter of the two is not around the other.
            let latter = if a > b { &mut a } else { &mut b };
            *latter = self.parts[*latter as usize].outer;
        }
        a
    }

    /// Sums up the facets around all parts.
    fn weigh_all(&mut self, inside: &[bool]) {
        // In the order of cells, as they lie in memory.
        let (mut some, mut between) = (vec![0u32; CELLS_PER_BATCH + 1], Vec::new());
        for begin in (0..self.home.len()).step_by(CELLS_PER_BATCH) {
            let mut count = 0;
            for cell in begin..self.home.len().min(begin + CELLS_PER_BATCH) {
                // All are written and some of them written over: which are in parts cannot be guessed.
                some[count] = cell as u32;
                count += usize::from(self.home[cell] != 0);
            }
            self.weigh(&some[..count], &mut between, inside);
        }
        self.pass_on(0);
    }

    /// Adds what the facets of some cells say to the parts where it begins to count.
    fn weigh(&mut self, cells: &[u32], between: &mut Vec<PartEdge>, inside: &[bool]) {
        between.resize(4 * cells.len() + 1, PartEdge::default());
        let mut count = 0;
        for &cell in cells {
            let part = self.part(cell);
            let mut sum = 0;
            for (i, dual_edge) in (0..).zip(self.dual_edges.of_cell(cell)) {
                let (other, _) = self.peeling.cells.across(cell, i);
                let beyond = self.part(other);
                let agrees = agrees(dual_edge, [cell, other], inside);
                // What is within a part is within all around it. Nothing here can be guessed, so nothing is asked.
                let is_between = beyond != part;
                sum += agrees * i64::from(is_between);
                between[count] = PartEdge { parts: [part, beyond], agrees };
                // A dual edge of two parts is met at both.
                count += usize::from(is_between & (beyond != NONE) & (cell < other));
            }
            self.parts[part as usize].sum += sum;
        }
        for dual_edge in &between[..count] {
            let meet = self.meet(dual_edge.parts);
            if meet != NONE {
                self.parts[meet as usize].sum -= 2 * dual_edge.agrees;
            }
        }
    }

    /// Adds what is said around parts, from one on, to those around them.
    fn pass_on(&mut self, first: usize) {
        for part in (first..self.parts.len()).rev() {
            let Part { outer, sum, .. } = self.parts[part];
            if outer != NONE {
                self.parts[outer as usize].sum += sum;
            }
        }
    }

    /// Turns over the innermost parts that the facets around them object to, and says how many; none if, as parts that are beside each
    /// other can, they would do no good together.
    fn turn(&mut self, inside: &mut [bool]) -> u64 {
        // Around one that is turned over, none is.
        let mut is_around = vec![false; self.parts.len()];
        let mut found = Vec::new();
        for (k, part) in self.parts.iter().enumerate().rev() {
            let is_found = !is_around[k] && part.sum < -DISAGREEMENT_MIN;
            if is_found {
                found.push(part.cell);
            }
            if part.outer != NONE {
                is_around[part.outer as usize] |= is_around[k] || is_found;
            }
        }
        let turned: Vec<u32> = found.iter().flat_map(|&cell| self.peeling.under(cell)).collect();
        turned.iter().for_each(|&cell| inside[cell as usize] = !inside[cell as usize]);
        // The facets between what is turned over and what is not agree by so much more, and the tops beside them.
        let (mut more, mut tops) = (0, Vec::new());
        let is_turned: HashSet<u32> = turned.iter().copied().collect();
        for &cell in &turned {
            for (i, dual_edge) in (0..).zip(self.dual_edges.of_cell(cell)) {
                let (other, _) = self.peeling.cells.across(cell, i);
                if !is_turned.contains(&other) {
                    more += 2 * agrees(dual_edge, [cell, other], inside);
                    let parts = [cell, other].map(|cell| self.parts.get(self.part(cell) as usize));
                    tops.extend(parts.into_iter().flatten().map(|part| part.top));
                }
            }
        }
        if more <= 0 {
            turned.iter().for_each(|&cell| inside[cell as usize] = !inside[cell as usize]);
            return 0;
        }
        self.turned.extend(turned);
        tops.sort_unstable();
        tops.dedup();
        self.divide(&tops, inside);
        found.len() as u64
    }

    /// Has every cell under some tops begin a part of its own, as labels have changed around there, and any could be objected to now.
    fn divide(&mut self, tops: &[u32], inside: &[bool]) {
        let first = self.parts.len();
        for &top in tops {
            for cell in self.peeling.under(self.parts[top as usize].cell) {
                let former = self.part(cell);
                self.parts[former as usize].sum = 0;
                self.begin(cell, top);
            }
        }
        let cells: Vec<u32> = self.parts[first..].iter().map(|part| part.cell).collect();
        self.weigh(&cells, &mut Vec::new(), inside);
        self.pass_on(first);
    }
}

/// Returns what is said against the parts that hang by peeled cells. Within a part a dual edge counts twice here, as where ways meet is not known yet.
fn against(objections: &[(u32, i64)], peeling: &Peeling<'_>) -> Vec<i64> {
    let mut against = vec![0i64; peeling.cells.len()];
    for &(cell, objection) in objections {
        against[cell as usize] = objection;
    }
    for &cell in &peeling.order {
        let own = against[cell as usize];
        if own > 0 {
            against[peeling.parent(cell) as usize] += own;
        }
    }
    against
}

/// By how much the facets of a cell agree with the labels.
fn agreement(cell: u32, dual_edges: &DualEdges, cells: &Cells, inside: &[bool]) -> i64 {
    let own = dual_edges.of_cell(cell);
    (0..4).map(|i| agrees(own[i], [cell, cells.across(cell, i).0], inside)).sum()
}

/// The cells at facets that disagree with the labels, and the strength of these facets.
fn objections(dual_edges: &DualEdges, cells: &Cells, inside: &[bool]) -> Vec<(u32, i64)> {
    let of_cell = |cell: u32| {
        let own = dual_edges.of_cell(cell);
        let says = |i: usize| agrees(own[i], [cell, cells.across(cell, i).0], inside);
        let objection: i64 = (0..4).map(says).filter(|&agrees| agrees < 0).sum();
        (objection < 0).then_some((cell, -objection))
    };
    let all = (0..cells.len() as u32).into_par_iter().with_min_len(TASK);
    all.filter_map(of_cell).collect()
}

pub(super) struct Relabeled {
    pub(super) relabeled: u64,
    /// Of each facet that disagrees with the labels one cell at least is among these.
    pub(super) doubtful: Vec<u32>,
}

/// Turns parts over.
pub(super) fn flip(
    dual_edges: &DualEdges,
    tree: &[u8],
    cells: &Cells,
    inside: &mut [bool],
) -> Relabeled {
    let labels = &*inside;
    let (peeling, objections) = taut_points::parallel::join(
        || Peeling::of(tree, cells),
        || objections(dual_edges, cells, labels),
    );
    let mut suspects = Suspects::of(&objections, dual_edges, &peeling, inside);
    let mut relabeled = 0;
    for _ in 0..ROUNDS_MAX {
        match suspects.turn(inside) {
            0 => break,
            found => relabeled += found,
        }
    }
    let mut doubtful = suspects.turned;
    doubtful.extend(objections.iter().map(|(cell, _)| cell));
    Relabeled { relabeled, doubtful }
}

/// Returns what a dual edge between two cells adds to the agreement with the labels.
#[inline(always)]
fn agrees(dual_edge: DualEdge, cells: [u32; 2], inside: &[bool]) -> i64 {
    let [one, other] = cells;
    if inside[one as usize] == inside[other as usize] {
        dual_edge.signed()
    } else {
        -dual_edge.signed()
    }
}
