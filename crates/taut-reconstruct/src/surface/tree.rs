//! Which cells are inside: the strongest spanning tree of the cells, by the signs along it.
//!
//! *Problem.* Facets contradict each other about where the surface is; weak ones, on slivers and at sharp edges, are often wrong.
//! *Idea.* Facets are heard in the order of their strength. One that joins two parts of space which were not joined yet is obeyed: same
//! medium, or opposite. All others are ignored, as what they say is decided already. The facets obeyed are a maximum spanning tree of
//! the dual graph, and the parity of opposites on the way from outside is the label. It is the thesis' spanning tree, turned from
//! growing a surface to dividing space.
//! *Way.* Borůvka's: in each round every part joins the one across its strongest facet. No facet is sorted, and all are read in the order
//! in which their cells lie in memory; each round leaves a third of the parts, and of facets those between them. In the first round a part
//! is a cell, and its facets are at hand; then parts are numbered anew in each round, so that what is kept of them stays small.
//! *Guarantee.* The labels are a function of the points: equal strengths are ordered by the numbers of facets, which are. O(n log n).
//! *Reference.* Borůvka 1926; Nešetřil, Milková and Nešetřilová, Discrete Math. 233, 2001.

use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

use rayon::prelude::*;
use taut_delaunay::decode;

use super::cells::Cells;
use super::media::Media;
use super::strengths::{Tie, Ties};

/// Cells or bonds of one task.
const TASK: usize = 1 << 14;

/// A facet between two parts.
#[derive(Clone, Copy)]
struct Bond {
    /// The parts; in the lowest bit of the first whether the facet says that they are opposite.
    ends: [u32; 2],
    /// Strength first, then the facet: no two are equal.
    rank: u64,
}

impl Bond {
    fn parts(&self) -> [u32; 2] {
        [self.ends[0] >> 1, self.ends[1]]
    }
}

/// A labelling of cells and the tree it comes from.
pub(super) struct Labels {
    pub(super) inside: Vec<bool>,
    /// For each cell the facets obeyed, one bit each.
    pub(super) tree: Vec<u8>,
}

/// How soon a facet is heard: the later, the greater.
fn rank(tie: Tie, facet: u32) -> u64 {
    u64::from(tie.key) << 32 | u64::from(!facet)
}

/// The facet that has this rank.
fn ranked(rank: u64) -> u32 {
    !(rank as u32)
}

/// Labels the cells: `root` is outside.
pub(super) fn labels(ties: &Ties, cells: &Cells, root: u32) -> Labels {
    let mut tree = vec![0u8; cells.len()];
    let mut obey = |facet: u32| {
        for (cell, i) in [facet, cells.mirror(facet)].map(decode) {
            tree[cell as usize] |= 1 << i;
        }
    };
    // From each level to the next: the part that a part is in, and in the lowest bit whether it is opposite to it.
    let mut levels = Vec::new();

    let strongest: Vec<u32> = (0..cells.len() as u32)
        .into_par_iter()
        .with_min_len(TASK)
        .map(|cell| strongest_of(cell, ties, cells))
        .collect();
    let (level, mut parts) = followed(&strongest, ties, cells);
    strongest.into_iter().for_each(&mut obey);
    let mut best = nothing(parts);
    let mut bonds = first_bonds(ties, cells, &level, &best);
    levels.push(level);
    while parts > 1 {
        let mut media = Media::new(parts);
        for bond in bonds.iter().flatten() {
            let [one, other] = bond.parts();
            let is_best = |part: u32| best[part as usize].load(Relaxed) == bond.rank;
            if (is_best(one) || is_best(other)) && media.join(one, other, bond.ends[0] & 1 == 1) {
                obey(ranked(bond.rank));
            }
        }
        let level;
        (level, parts) = media.numbered();
        best = nothing(parts);
        keep_between(&mut bonds, &level, &best);
        levels.push(level);
    }
    // From the last level back to the cells.
    let whole = levels.into_iter().rev().reduce(|above, mut level| {
        level.par_iter_mut().with_min_len(TASK).for_each(|part| {
            *part = above[(*part >> 1) as usize] ^ (*part & 1);
        });
        level
    });
    let sides = whole.unwrap_or_default();
    let outside = sides.get(root as usize).map_or(0, |side| side & 1);
    Labels { inside: sides.iter().map(|side| side & 1 != outside).collect(), tree }
}

/// For each part the rank of the facet that is heard first, none yet.
fn nothing(parts: usize) -> Vec<AtomicU64> {
    (0..parts).map(|_| AtomicU64::new(0)).collect()
}

/// Offers a bond to its parts: whoever comes first, the highest rank stays.
fn offer(best: &[AtomicU64], bond: &Bond) {
    for part in bond.parts() {
        let best = &best[part as usize];
        if best.load(Relaxed) < bond.rank {
            best.fetch_max(bond.rank, Relaxed);
        }
    }
}

/// The facet of a cell that is heard first.
fn strongest_of(cell: u32, ties: &Ties, cells: &Cells) -> u32 {
    let own = ties.of_cell(cell);
    let [a, b, c, d] = own;
    let most = a.max(b).max(c.max(d));
    let facets = (0..4).filter(|&i| own[i] == most).map(|i| cell << 2 | i as u32);
    // Few cells have two facets of one strength; all others need not know their neighbours.
    let alike = own.iter().filter(|&&tie| tie == most).count();
    match alike {
        1 => {
            cell << 2 | (u32::from(b == most) + 2 * u32::from(c == most) + 3 * u32::from(d == most))
        }
        _ => facets.min_by_key(|&facet| facet.min(cells.mirror(facet))).unwrap_or(cell << 2),
    }
}

/// The parts of cells that each join the one across their strongest facet, as a level, and how many there are. Whoever follows these facets
/// comes to one that is the strongest for both its cells, as ranks only rise.
fn followed(strongest: &[u32], ties: &Ties, cells: &Cells) -> (Vec<u32>, usize) {
    const UNKNOWN: u32 = u32::MAX;
    let mut level = vec![UNKNOWN; strongest.len()];
    let mut parts = 0;
    let mut way = Vec::new();
    for start in 0..strongest.len() as u32 {
        let mut at = start;
        while level[at as usize] == UNKNOWN {
            let facet = strongest[at as usize];
            let next = cells.mirror(facet);
            way.push((at, u32::from(ties.at(facet).is_opposite())));
            let other = (next >> 2) as usize;
            if strongest[other] == next && level[other] == UNKNOWN {
                level[at as usize] = parts << 1;
                parts += 1;
                way.pop();
            } else {
                at = other as u32;
            }
        }
        let mut side = level[at as usize];
        while let Some((cell, sign)) = way.pop() {
            side ^= sign;
            level[cell as usize] = side;
        }
    }
    (level, parts as usize)
}

/// The facets between parts of cells, each from its first cell, by tasks.
fn first_bonds(ties: &Ties, cells: &Cells, level: &[u32], best: &[AtomicU64]) -> Vec<Vec<Bond>> {
    let part_of = |cell: u32| level[cell as usize] >> 1;
    let task = |between: &mut Vec<u32>, begin: usize| {
        let some = begin as u32..cells.len().min(begin + TASK) as u32;
        between.resize(4 * some.len(), 0);
        let mut count = 0;
        for cell in some {
            for i in 0..4 {
                // All are written and most of them written over: which are between parts cannot be guessed.
                between[count] = cell << 2 | i as u32;
                let (other, _) = cells.across(cell, i);
                count += usize::from((other > cell) & (part_of(cell) != part_of(other)));
            }
        }
        let bond = |&facet: &u32| {
            let [own, beyond] = [facet, cells.mirror(facet)].map(|f| level[(f >> 2) as usize]);
            let tie = ties.at(facet);
            let sign = (own ^ beyond) & 1 ^ u32::from(tie.is_opposite());
            let bond = Bond { ends: [own & !1 | sign, beyond >> 1], rank: rank(tie, facet) };
            offer(best, &bond);
            bond
        };
        between[..count].iter().map(bond).collect::<Vec<Bond>>()
    };
    let begins: Vec<usize> = (0..cells.len()).step_by(TASK).collect();
    begins.into_par_iter().map_init(Vec::new, task).collect()
}

/// Keeps the bonds that are between parts after these were joined.
fn keep_between(bonds: &mut [Vec<Bond>], level: &[u32], best: &[AtomicU64]) {
    let keep = |bonds: &mut Vec<Bond>| {
        let mut count = 0;
        for k in 0..bonds.len() {
            let mut bond = bonds[k];
            let [one, two] = bond.parts().map(|part| level[part as usize]);
            let sign = (one ^ two ^ bond.ends[0]) & 1;
            bond.ends = [one & !1 | sign, two >> 1];
            // Written whether it is kept or not, as that cannot be guessed.
            bonds[count] = bond;
            count += usize::from(one >> 1 != two >> 1);
        }
        bonds.truncate(count);
        bonds.iter().for_each(|bond| offer(best, bond));
    };
    bonds.par_iter_mut().for_each(keep);
}
