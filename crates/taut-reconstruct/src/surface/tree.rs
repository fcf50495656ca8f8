//! Which cells are inside: the strongest spanning tree of the cells, by the signs along it.
//!
//! *Problem.* Facets contradict each other about where the surface is; weak ones, on slivers and at sharp edges, are often wrong.
//! *Idea.* Facets are heard in the order of their strength. One that joins two parts of space which were not joined yet is obeyed: same
//! medium, or opposite. All others are ignored, as what they say is decided already. The facets obeyed are a maximum spanning tree of
//! the dual graph, and the parity of opposites on the way from outside is the label. It is the thesis' spanning tree, turned from
//! growing a surface to dividing space.
//! *Way.* Borůvka's: in each round every part joins the one across its strongest facet. No facet is sorted, and all are read in the order
//! in which their cells lie in memory; each round leaves a third of the parts, and of facets those between them.
//! *Guarantee.* The labels are a function of the points: equal strengths are ordered by the sites of their facets. O(n log n).
//! *Reference.* Borůvka 1926; Nešetřil, Milková and Nešetřilová, Discrete Math. 233, 2001.

use std::cmp::Ordering;

use super::cells::Cells;
use super::media::Media;
use super::strengths::{Tie, Ties};

const NO_TIE: Tie = Tie { key: 0, facet: u32::MAX, other: 0 };

/// A tie and the roots of the two parts that it is between.
#[derive(Clone, Copy)]
struct Bond {
    ends: [u32; 2],
    tie: Tie,
}

/// A labelling of cells and the tree it comes from.
pub(super) struct Labels {
    /// By slot.
    pub(super) inside: Vec<bool>,
    /// The ties obeyed.
    pub(super) tree: Vec<Tie>,
}

/// Labels the cells: `root` is outside, and with it all ghosts that it stands for.
pub(super) fn labels(ties: &Ties, cells: &Cells, root: u32) -> Labels {
    let is_stronger = |one: Tie, other: Tie| match one.strength().cmp(&other.strength()) {
        Ordering::Equal => cells.name(one.facet) < cells.name(other.facet),
        unequal => unequal == Ordering::Greater,
    };
    let mut media = Media::new(cells.len());
    let mut tree = Vec::with_capacity(cells.len());
    // Of each part the strongest tie to another.
    let mut best = vec![NO_TIE; cells.len()];
    let offer = |best: &mut [Tie], Bond { ends, tie }: Bond| {
        for end in ends {
            let best = &mut best[end as usize];
            if best.facet == NO_TIE.facet || is_stronger(tie, *best) {
                *best = tie;
            }
        }
    };
    ties.iter().for_each(|tie| offer(&mut best, Bond { ends: tie.nodes(), tie }));
    let mut parts: Vec<u32> = (0..cells.len() as u32).collect();
    let mut bonds: Option<Vec<Bond>> = None;
    loop {
        for &part in &parts {
            let tie = std::mem::replace(&mut best[part as usize], NO_TIE);
            let [one, other] = tie.nodes();
            if tie.facet != NO_TIE.facet && media.join(one, other, tie.is_opposite()) {
                tree.push(tie);
            }
        }
        media.flatten();
        parts.retain(|&part| media.parent(part) == part);
        let between_parts = |mut bond: Bond| {
            bond.ends = bond.ends.map(|end| media.parent(end));
            (bond.ends[0] != bond.ends[1]).then_some(bond)
        };
        let left: Vec<Bond> = match bonds {
            None => {
                let bonds = ties.iter().map(|tie| Bond { ends: tie.nodes(), tie });
                bonds.filter_map(between_parts).collect()
            }
            Some(bonds) => bonds.into_iter().filter_map(between_parts).collect(),
        };
        if left.is_empty() {
            break;
        }
        left.iter().for_each(|&bond| offer(&mut best, bond));
        bonds = Some(left);
    }
    let outside = media.is_opposite(root);
    // A ghost that another stands for has no tie, and is alone.
    let is_with_root = |cell: u32| media.parent(cell) == media.parent(root);
    let label = |cell: u32| is_with_root(cell) && media.is_opposite(cell) != outside;
    Labels { inside: (0..cells.len() as u32).map(label).collect(), tree }
}
