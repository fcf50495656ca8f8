//! Small parts of the tree that most of their facets object to, turned over.
//!
//! *Problem.* The label of a cell hangs on a single path through the tree, however many facets around it say otherwise.
//! *Idea.* Without one of its edges the tree falls into two parts. The facets between them are what the edge stands for; if they
//! disagree with the labels by more than [`LEAST`] in sum, the smaller part is turned over. Leaves are peeled off the tree as long as
//! what hangs on them is small; sums over all parts come from sums along the peeling: a facet counts at both its cells, and twice
//! against it where the ways from them meet. Few facets disagree at all, so the sums are formed only where those that do could suffice,
//! which is found along the peeling as well.
//! *Guarantee.* Each round raises the agreement of all facets with the labels. Sums are exact, so the answer is a function of the points.
//! O(n), and O(suspects) for each of at most [`ROUNDS`] rounds.
//! *Trap.* Large parts are left alone: under strong noise whole regions would be turned back and forth.

use rayon::prelude::*;

use super::cells::Cells;
use super::strengths::{CERTAIN, Tie, Ties};

/// Cells of the largest part.
const MOST: u8 = 100;
/// The least disagreement, half of what a certain facet says. Of 1, 0.5, 0.2 and 0 it did best on the seven sets at 70 %; from 0.2 down
/// other sets lose.
const LEAST: i64 = CERTAIN / 2;
const ROUNDS: usize = 12;
/// Cells of one task.
const TASK: usize = 1 << 14;
/// No place.
const NONE: u32 = u32::MAX;

/// The small parts of the tree: for each cell that was peeled off, what it hung on.
struct Peeling<'a> {
    cells: &'a Cells,
    /// The facets of the tree, one bit each.
    tree: &'a [u8],
    /// By cell; [`NONE`] for those that were not peeled off.
    parent: Vec<u32>,
    /// The cells in the order in which they were peeled off: those of a part before what it hung on.
    order: Vec<u32>,
}

impl<'a> Peeling<'a> {
    /// Peels a tree of facets; ghosts stay.
    fn of(tree: &'a [u8], cells: &'a Cells) -> Self {
        let mut left = tree.to_vec();
        let mut size = vec![1u8; cells.len()];
        let mut parents = vec![NONE; cells.len()];
        let mut order = Vec::with_capacity(cells.len());
        for start in 0..cells.len() as u32 {
            let mut leaf = start;
            while left[leaf as usize].is_power_of_two()
                && size[leaf as usize] <= MOST
                && !cells.is_ghost(leaf)
            {
                let place = left[leaf as usize].trailing_zeros() as usize;
                let (parent, back) = cells.across(leaf, place);
                parents[leaf as usize] = parent;
                order.push(leaf);
                left[leaf as usize] = 0;
                left[parent as usize] &= !(1 << back);
                size[parent as usize] = size[parent as usize].saturating_add(size[leaf as usize]);
                leaf = parent;
            }
        }
        Self { cells, tree, parent: parents, order }
    }

    /// Whether so much is said against the part that hangs by a peeled cell that it could be turned over.
    fn is_outweighed(&self, cell: u32, against: i64, ties: &Ties, inside: &[bool]) -> bool {
        if against <= LEAST {
            return false;
        }
        if self.tree[cell as usize].is_power_of_two() {
            // The cell is all of the part.
            return agreement(cell, ties, self.cells, inside) < -LEAST;
        }
        // What the part hangs by was obeyed, and agrees.
        let hung_by = || {
            let parent = self.parent[cell as usize];
            let tree = self.tree[cell as usize];
            let is_up = |&i: &usize| tree >> i & 1 == 1 && self.cells.across(cell, i).0 == parent;
            (0..4).find(is_up).map_or(0, |i| i64::from(ties.of_cell(cell)[i].strength()))
        };
        against > LEAST + hung_by()
    }
}

/// Peeled cells whose parts the facets that disagree could outweigh, and all cells of these parts.
struct Suspects<'a> {
    ties: &'a Ties,
    cells: &'a Cells,
    /// Those of a part before what it hangs on.
    found: Vec<u32>,
    /// For each the place of the suspect above it, or none.
    above: Vec<u32>,
    /// For each the place of the last one above it: ways from under different ones do not meet.
    top: Vec<u32>,
    /// By cell its place, counted from one, so that nothing is written for all other cells.
    place: Vec<u32>,
    /// For each part, by how much the facets around it agree with the labels.
    sums: Vec<i64>,
    /// The cells of parts that were turned over.
    turned: Vec<u32>,
}

impl<'a> Suspects<'a> {
    fn of(
        objections: &[(u32, i64)],
        ties: &'a Ties,
        peeling: &Peeling<'a>,
        inside: &[bool],
    ) -> Self {
        let cells = peeling.cells;
        let against = against(objections, peeling);
        let mut place = vec![0u32; cells.len()];
        let mut found = Vec::new();
        // From the tops of parts down.
        for &cell in peeling.order.iter().rev() {
            let is_within = place[peeling.parent[cell as usize] as usize] != 0;
            if is_within || peeling.is_outweighed(cell, against[cell as usize], ties, inside) {
                found.push(cell);
                place[cell as usize] = 1;
            }
        }
        found.reverse();
        (1..).zip(&found).for_each(|(k, &cell)| place[cell as usize] = k);
        let above = |&cell: &u32| place[peeling.parent[cell as usize] as usize].wrapping_sub(1);
        let above: Vec<u32> = found.iter().map(above).collect();
        let mut top: Vec<u32> = (0..found.len() as u32).collect();
        for k in (0..found.len()).rev().filter(|&k| above[k] != NONE) {
            top[k] = top[above[k] as usize];
        }
        let sums = vec![0; found.len()];
        let turned = Vec::new();
        let mut suspects = Self { ties, cells, found, above, top, place, sums, turned };
        suspects.sum_up(inside);
        suspects
    }

    fn place(&self, cell: u32) -> u32 {
        self.place[cell as usize].wrapping_sub(1)
    }

    /// Where the ways up from two places meet.
    fn meet(&self, mut a: u32, mut b: u32) -> u32 {
        if b == NONE || self.top[a as usize] != self.top[b as usize] {
            return NONE;
        }
        while a != b {
            // What hangs on another comes before it, so the former of the two is not above the other.
            let former = if a < b { &mut a } else { &mut b };
            *former = self.above[*former as usize];
        }
        a
    }

    fn sum_up(&mut self, inside: &[bool]) {
        for k in 0..self.found.len() {
            let (cell, from) = (self.found[k], k as u32);
            for (i, tie) in (0..).zip(self.ties.of_cell(cell)) {
                let (other, _) = self.cells.across(cell, i);
                let to = self.place(other);
                // A tie of two suspects is met at both.
                if to != NONE && to < from {
                    continue;
                }
                let agrees = agrees(tie, [cell, other], inside);
                for (place, times) in [(from, 1), (to, 1), (self.meet(from, to), -2)] {
                    if place != NONE {
                        self.sums[place as usize] += times * agrees;
                    }
                }
            }
        }
        for k in 0..self.found.len() {
            if self.above[k] != NONE {
                self.sums[self.above[k] as usize] += self.sums[k];
            }
        }
    }

    /// Turns over the lowest parts that the facets around them object to, and says how many; none if, as parts that are beside each
    /// other can, they would do no good together.
    fn turn(&mut self, inside: &mut [bool]) -> u64 {
        // From the leaves up; above one that is turned over, none is.
        let mut is_turned = vec![false; self.found.len()];
        let mut is_above = vec![false; self.found.len()];
        let mut count = 0;
        for (k, &above) in self.above.iter().enumerate() {
            if !is_above[k] && self.sums[k] < -LEAST {
                is_turned[k] = true;
                count += 1;
            }
            if above != NONE {
                is_above[above as usize] |= is_above[k] || is_turned[k];
            }
        }
        if count == 0 {
            return 0;
        }
        for (k, &above) in self.above.iter().enumerate().rev() {
            is_turned[k] |= above != NONE && is_turned[above as usize];
        }
        // The facets between what is turned over and what is not, and by how much more they agree then.
        let mut changes: Vec<([u32; 2], i64)> = Vec::new();
        for (k, _) in is_turned.iter().enumerate().filter(|(_, is_turned)| **is_turned) {
            let cell = self.found[k];
            for (i, tie) in (0..).zip(self.ties.of_cell(cell)) {
                let (other, _) = self.cells.across(cell, i);
                let to = self.place(other);
                if to == NONE || !is_turned[to as usize] {
                    changes.push(([k as u32, to], -2 * agrees(tie, [cell, other], inside)));
                }
            }
        }
        if changes.iter().map(|(_, more)| more).sum::<i64>() <= 0 {
            return 0;
        }
        let turned = self.found.iter().zip(&is_turned).filter(|(_, is_turned)| **is_turned);
        for (&cell, _) in turned {
            inside[cell as usize] = !inside[cell as usize];
            self.turned.push(cell);
        }
        for ([from, to], more) in changes {
            let top = self.meet(from, to);
            for mut at in [from, to] {
                while at != NONE && at != top {
                    self.sums[at as usize] += more;
                    at = self.above[at as usize];
                }
            }
        }
        count
    }
}

/// What is said against the parts that hang by peeled cells. Within a part a tie counts twice here, as where ways meet is not known yet.
fn against(objections: &[(u32, i64)], peeling: &Peeling<'_>) -> Vec<i64> {
    let mut against = vec![0i64; peeling.cells.len()];
    for &(cell, objection) in objections {
        against[cell as usize] = objection;
    }
    for &cell in &peeling.order {
        let own = against[cell as usize];
        if own > 0 {
            against[peeling.parent[cell as usize] as usize] += own;
        }
    }
    against
}

/// By how much the facets of a cell agree with the labels.
fn agreement(cell: u32, ties: &Ties, cells: &Cells, inside: &[bool]) -> i64 {
    let own = ties.of_cell(cell);
    (0..4).map(|i| agrees(own[i], [cell, cells.across(cell, i).0], inside)).sum()
}

/// The cells at facets that disagree with the labels, and the strength of these facets.
fn objections(ties: &Ties, cells: &Cells, inside: &[bool]) -> Vec<(u32, i64)> {
    let of_cell = |cell: u32| {
        let own = ties.of_cell(cell);
        let says = |i: usize| agrees(own[i], [cell, cells.across(cell, i).0], inside);
        let objection: i64 = (0..4).map(says).filter(|&agrees| agrees < 0).sum();
        (objection < 0).then_some((cell, -objection))
    };
    let all = (0..cells.len() as u32).into_par_iter().with_min_len(TASK);
    all.filter_map(of_cell).collect()
}

/// What turning parts over came to.
pub(super) struct Flipped {
    /// How many were.
    pub(super) flips: u64,
    /// All cells that have a facet which disagrees with the labels are among these.
    pub(super) doubtful: Vec<u32>,
}

/// Turns parts over.
pub(super) fn flip(ties: &Ties, tree: &[u8], cells: &Cells, inside: &mut [bool]) -> Flipped {
    let labels = &*inside;
    let (peeling, objections) =
        rayon::join(|| Peeling::of(tree, cells), || objections(ties, cells, labels));
    let mut suspects = Suspects::of(&objections, ties, &peeling, inside);
    let mut flips = 0;
    for _ in 0..ROUNDS {
        match suspects.turn(inside) {
            0 => break,
            found => flips += found,
        }
    }
    let mut doubtful = suspects.turned;
    doubtful.extend(objections.iter().map(|(cell, _)| cell));
    Flipped { flips, doubtful }
}

/// What a tie between two cells adds to the agreement with the labels.
fn agrees(tie: Tie, cells: [u32; 2], inside: &[bool]) -> i64 {
    let [a, b] = cells.map(|cell| inside[cell as usize]);
    if a == b { tie.signed() } else { -tie.signed() }
}
