//! Small parts of the tree that most of their facets object to, turned over.
//!
//! *Problem.* The label of a cell hangs on a single path through the tree, however many facets around it say otherwise.
//! *Idea.* Without one of its edges the tree falls into two parts. The facets between them are what the edge stands for; if they
//! disagree with the labels by more than [`LEAST`] in sum, the smaller part is turned over. Leaves are peeled off the tree as long as
//! what hangs on them is small; sums over all parts come from sums along the peeling: a facet counts at both its cells, and twice
//! against it where the ways from them meet. Few facets disagree at all, so the sums are formed only where those that do could suffice.
//! *Guarantee.* Each round raises the agreement of all facets with the labels. Sums are exact, so the answer is a function of the points.
//! O(n), and O(suspects) for each of at most [`ROUNDS`] rounds.
//! *Trap.* Large parts are left alone: under strong noise whole regions would be turned back and forth.

use super::cells::Cells;
use super::strengths::{CERTAIN, Tie, Ties};

/// Cells of the largest part.
const MOST: u32 = 100;
/// The least disagreement, half of what a certain facet says. Of 1, 0.5, 0.2 and 0 it did best on the seven sets at 70 %; from 0.2 down
/// other sets lose.
const LEAST: i64 = CERTAIN / 2;
const ROUNDS: usize = 12;

/// Neither parent nor place.
const NONE: u32 = u32::MAX;

/// The small parts of the tree: the cells that were peeled off, with what they hung on.
struct Peeling {
    link: Vec<Link>,
    /// The cells in the order in which they were peeled off: those of a part before its own.
    order: Vec<u32>,
}

/// Where a cell hung, and when it was peeled off.
#[derive(Clone, Copy)]
struct Link {
    parent: u32,
    when: u32,
    /// The strength of what it hung by.
    strength: u32,
}

impl Peeling {
    /// Peels a tree of facets; ghosts stay.
    fn of(tree: &[Tie], cells: &Cells) -> Self {
        // The neighbours in the tree and the strengths towards them, all in one number: of a leaf it is the only one.
        let mut degree = vec![0u32; cells.len()];
        let mut beside = vec![[0u32; 2]; cells.len()];
        for tie in tree {
            let [a, b] = tie.nodes();
            for (one, other) in [(a, b), (b, a)] {
                degree[one as usize] += 1;
                beside[one as usize][0] ^= other;
                beside[one as usize][1] ^= tie.strength();
            }
        }
        let mut size = vec![1u32; cells.len()];
        let stays = Link { parent: NONE, when: NONE, strength: 0 };
        let mut peeling = Self { link: vec![stays; cells.len()], order: Vec::new() };
        for start in 0..cells.len() as u32 {
            let mut leaf = start;
            while degree[leaf as usize] == 1 && size[leaf as usize] <= MOST && !cells.is_ghost(leaf)
            {
                let [parent, strength] = beside[leaf as usize];
                let when = peeling.order.len() as u32;
                peeling.link[leaf as usize] = Link { parent, when, strength };
                peeling.order.push(leaf);
                degree[leaf as usize] = 0;
                degree[parent as usize] -= 1;
                beside[parent as usize][0] ^= leaf;
                beside[parent as usize][1] ^= strength;
                size[parent as usize] += size[leaf as usize];
                leaf = parent;
            }
        }
        peeling
    }

    fn is_peeled(&self, cell: u32) -> bool {
        self.link[cell as usize].when != NONE
    }

    /// What a cell hung on, if that was peeled off as well.
    fn above(&self, cell: u32) -> Option<u32> {
        let parent = self.link[cell as usize].parent;
        (parent != NONE && self.is_peeled(parent)).then_some(parent)
    }

    /// Where the ways from two cells meet, if that was peeled off.
    fn meet(&self, a: u32, b: u32) -> Option<u32> {
        let link = |cell: u32| (cell, self.link[cell as usize]);
        let (mut a, mut b) = (link(a), link(b));
        while a.0 != b.0 {
            let earlier = if a.1.when <= b.1.when { &mut a } else { &mut b };
            if earlier.1.when == NONE {
                return None;
            }
            *earlier = link(earlier.1.parent);
        }
        (a.1.when != NONE).then_some(a.0)
    }
}

/// Peeled cells whose parts the facets that disagree could outweigh, and all cells of these parts.
struct Suspects {
    /// In the order of their peeling.
    cells: Vec<u32>,
    /// For each the place of the suspect above it, or none.
    above: Vec<u32>,
    /// What the facets at them say.
    near: Vec<Near>,
}

/// A tie at suspects.
struct Near {
    tie: Tie,
    /// The places of its cells and of where their ways meet, of those that are suspects.
    places: [u32; 3],
}

impl Suspects {
    fn of(ties: &Ties, peeling: &Peeling, inside: &[bool]) -> Self {
        // Within a part a tie counts twice here, as where ways meet is not known yet.
        let mut against = vec![0i64; inside.len()];
        for tie in ties.iter() {
            let agrees = agrees(tie, inside);
            if agrees < 0 {
                tie.nodes().iter().for_each(|&cell| against[cell as usize] -= agrees);
            }
        }
        for &cell in &peeling.order {
            if let Some(above) = peeling.above(cell) {
                against[above as usize] += against[cell as usize];
            }
        }
        let (mut cells, mut place) = (Vec::new(), vec![NONE; inside.len()]);
        for &cell in peeling.order.iter().rev() {
            let is_below = |above: u32| place[above as usize] != NONE;
            // What the part hangs by was obeyed, and agrees.
            let least = LEAST + i64::from(peeling.link[cell as usize].strength);
            if against[cell as usize] > least || peeling.above(cell).is_some_and(is_below) {
                place[cell as usize] = 0;
                cells.push(cell);
            }
        }
        cells.reverse();
        (0..).zip(&cells).for_each(|(k, &cell)| place[cell as usize] = k);
        let place = |cell: Option<u32>| cell.map_or(NONE, |cell| place[cell as usize]);
        let near = |tie: Tie| {
            let [a, b] = tie.nodes();
            let [from, to] = [a, b].map(|cell| place(Some(cell)));
            let top = || place(peeling.meet(a, b));
            (from != NONE || to != NONE).then(|| Near { tie, places: [from, to, top()] })
        };
        Self {
            above: cells.iter().map(|&cell| place(peeling.above(cell))).collect(),
            near: ties.iter().filter_map(near).collect(),
            cells,
        }
    }

    /// Turns over the lowest parts that the ties near them object to, and says how many; none if, as parts that are beside each other
    /// can, they would do no good together.
    fn turn(&self, inside: &mut [bool]) -> u64 {
        let sums = self.agreement(inside);
        // From the leaves up; above one that is turned over, none is.
        let mut is_turned = vec![false; self.cells.len()];
        let mut is_above = vec![false; self.cells.len()];
        let mut found = 0;
        for (k, &above) in self.above.iter().enumerate() {
            if !is_above[k] && sums[k] < -LEAST {
                is_turned[k] = true;
                found += 1;
            }
            if above != NONE {
                is_above[above as usize] |= is_above[k] || is_turned[k];
            }
        }
        if found == 0 {
            return 0;
        }
        for (k, &above) in self.above.iter().enumerate().rev() {
            is_turned[k] |= above != NONE && is_turned[above as usize];
        }
        let total = |inside: &[bool]| -> i64 {
            self.near.iter().map(|near| agrees(near.tie, inside)).sum()
        };
        let turn = |inside: &mut [bool]| {
            let turned = self.cells.iter().zip(&is_turned);
            turned.for_each(|(&cell, is_turned)| inside[cell as usize] ^= is_turned);
        };
        let before = total(inside);
        turn(inside);
        if total(inside) <= before {
            turn(inside);
            return 0;
        }
        found
    }

    /// For each part, by how much the facets around it agree with the labels.
    fn agreement(&self, inside: &[bool]) -> Vec<i64> {
        let mut sums = vec![0i64; self.cells.len()];
        for Near { tie, places } in &self.near {
            let agrees = agrees(*tie, inside);
            for (&place, times) in places.iter().zip([1, 1, -2]) {
                if place != NONE {
                    sums[place as usize] += times * agrees;
                }
            }
        }
        for (k, &above) in self.above.iter().enumerate() {
            if above != NONE {
                sums[above as usize] += sums[k];
            }
        }
        sums
    }
}

/// Turns parts over, and says how many.
pub(super) fn flip(ties: &Ties, tree: &[Tie], cells: &Cells, inside: &mut [bool]) -> u64 {
    let peeling = Peeling::of(tree, cells);
    let suspects = Suspects::of(ties, &peeling, inside);
    let mut flipped = 0;
    for _ in 0..ROUNDS {
        match suspects.turn(inside) {
            0 => break,
            found => flipped += found,
        }
    }
    flipped
}

/// What a tie adds to the agreement with the labels.
fn agrees(tie: Tie, inside: &[bool]) -> i64 {
    let [a, b] = tie.nodes().map(|cell| inside[cell as usize]);
    if a == b { tie.signed() } else { -tie.signed() }
}
