//! Which cells are inside: the strongest spanning tree of the cells, by the signs along it.
//!
//! *Problem.* Facets contradict each other about where the surface is; weak ones, on slivers and at sharp edges, are often wrong.
//! *Idea.* Facets are processed in the order of their weight. One that joins two parts of space which were not joined yet is obeyed: same
//! side, or opposite sides. All others are ignored, as what they say is decided already. The facets obeyed are a maximum spanning tree of
//! the dual graph, and the parity of opposites on the way from outside is the label. The thesis (4.2, 4.3) grows a surface along a
//! minimum spanning tree of triangles; this tree divides space.
//! *Way.* Borůvka's: in each round every part joins the one across its facet of the largest weight. No facet is sorted, and all are read in the order
//! in which their cells lie in memory; each round leaves half of the parts at most, of most samples a third, and of facets those between
//! them. In the first round a part is a cell, and its facets are at hand; then parts are numbered again in each round, so that what is kept
//! of them stays small.
//! *Guarantee.* The labels are a function of the points: equal weights are ordered by the numbers of facets, which are. O(n log n).
//! *Reference.* Borůvka 1926; Nešetřil, Milková and Nešetřilová, Discrete Math. 233, 2001.

use std::sync::atomic::AtomicU64;
use std::sync::atomic::Ordering::Relaxed;

use taut_delaunay::decode;
use taut_points::parallel::{IntoParallel, ParallelSlice};

use super::cells::Cells;
use super::dual_edges::DualEdges;
use super::parity::ParityUnionFind;

/// Cells of one task, and the cross edges that are listed from them.
const TASK: usize = 1 << 14;
// A rank has 16 bits for the place of a cross edge among those of its task, and as many for the task, as cells are fewer than 2³⁰.
const _: () = assert!(4 * TASK <= 1 << 16 && (1 << 30) / TASK <= 1 << 16);

/// A facet between two parts.
#[derive(Clone, Copy)]
struct CrossEdge {
    /// The parts; in the lowest bit of the first whether the facet says that they are opposite.
    ends: [u32; 2],
    facet: u32,
    weight: u32,
}

impl CrossEdge {
    fn parts(&self) -> [u32; 2] {
        [self.ends[0] >> 1, self.ends[1]]
    }
}

/// A labeling of cells and the tree it comes from.
pub(super) struct Labels {
    pub(super) inside: Vec<bool>,
    /// For each cell the facets obeyed, one bit each.
    pub(super) tree: Vec<u8>,
}

/// The cross edge of the highest rank is processed first. Weight comes first, then the lower task and the lower place in it, which are in the order
/// of facets: no two ranks are equal.
fn rank(cross_edge: &CrossEdge, task: usize, place: usize) -> u64 {
    u64::from(cross_edge.weight) << 32 | u64::from(!((task << 16 | place) as u32))
}

fn ranked(cross_edges: &[Vec<CrossEdge>], rank: u64) -> &CrossEdge {
    let at = !(rank as u32) as usize;
    &cross_edges[at >> 16][at & 0xffff]
}

/// Labels the cells: `root` is outside.
pub(super) fn labels(dual_edges: &DualEdges, cells: &Cells, root: u32) -> Labels {
    let mut tree = vec![0u8; cells.len()];
    let mut obey = |sides: [u32; 2]| {
        for (cell, i) in sides.map(decode) {
            tree[cell as usize] |= 1 << i;
        }
    };
    // From each level to the next: the part that a part is in, and in the lowest bit whether it is opposite to it.
    let mut levels = Vec::new();

    let strongest: Vec<u32> = (0..cells.len() as u32)
        .into_par_iter()
        .with_min_len(TASK)
        .map(|cell| strongest_of(cell, dual_edges, cells))
        .collect();
    let (level, mut parts) = followed(&strongest, dual_edges, cells, &mut obey);
    drop(strongest);
    let mut best = nothing(parts);
    let mut cross_edges = first_cross_edges(dual_edges, cells, &level, &best);
    levels.push(level);
    while parts > 1 {
        let mut parity = ParityUnionFind::new(parts);
        for best in best.iter_mut().map(|best| *best.get_mut()).filter(|&best| best > 0) {
            let cross_edge = ranked(&cross_edges, best);
            let [one, other] = cross_edge.parts();
            if parity.join(one, other, cross_edge.ends[0] & 1 == 1) {
                obey([cross_edge.facet, cells.mirror(cross_edge.facet)]);
            }
        }
        let level;
        (level, parts) = parity.numbered();
        best = nothing(parts);
        keep_between(&mut cross_edges, &level, &best);
        levels.push(level);
    }
    // From the last level back to the cells.
    let whole = levels.into_iter().rev().reduce(|above, mut level| {
        level.par_chunks_mut(TASK).for_each(|parts| {
            for part in parts {
                *part = above[(*part >> 1) as usize] ^ (*part & 1);
            }
        });
        level
    });
    let sides = whole.unwrap_or_default();
    let outside = sides.get(root as usize).map_or(0, |side| side & 1);
    Labels { inside: sides.iter().map(|side| side & 1 != outside).collect(), tree }
}

/// For each part the rank of the facet that is processed first, none yet.
fn nothing(parts: usize) -> Vec<AtomicU64> {
    (0..parts).map(|_| AtomicU64::new(0)).collect()
}

/// Offers the cross edges of a task to their parts: whoever comes first, the highest rank stays.
fn offer(best: &[AtomicU64], task: usize, cross_edges: &[CrossEdge]) {
    for (place, cross_edge) in cross_edges.iter().enumerate() {
        let rank = rank(cross_edge, task, place);
        for part in cross_edge.parts() {
            let best = &best[part as usize];
            if best.load(Relaxed) < rank {
                best.fetch_max(rank, Relaxed);
            }
        }
    }
}

/// The facet of a cell that is processed first.
fn strongest_of(cell: u32, dual_edges: &DualEdges, cells: &Cells) -> u32 {
    let own = dual_edges.of_cell(cell);
    let [a, b, c, d] = own;
    let most = a.max(b).max(c.max(d));
    let facets = (0..4).filter(|&i| own[i] == most).map(|i| cell << 2 | i as u32);
    // Few cells have two facets of one strength; all others need not know their neighbors.
    let alike = own.iter().filter(|&&dual_edge| dual_edge == most).count();
    match alike {
        1 => {
            cell << 2 | (u32::from(b == most) + 2 * u32::from(c == most) + 3 * u32::from(d == most))
        }
        _ => facets.min_by_key(|&facet| facet.min(cells.mirror(facet))).unwrap_or(cell << 2),
    }
}

/// The parts of cells that each join the one across their facet of the largest weight, as a level, and how many there are; the facets go to `obey`.
/// Whoever follows these facets comes to one that is the strongest for both its cells, as ranks only rise: the first of them stands for
/// all. Each cell takes the leap that the one it leaps to takes, until none leaps further: twice as far each time, and nobody
/// has to guess where a way ends.
fn followed(
    strongest: &[u32],
    dual_edges: &DualEdges,
    cells: &Cells,
    mut obey: impl FnMut([u32; 2]),
) -> (Vec<u32>, usize) {
    // Where a cell leaps to, and in the lowest bit whether that is opposite.
    let leap = |(cell, &facet): (u32, &u32)| {
        let back = cells.mirror(facet);
        obey([facet, back]);
        let other = back >> 2;
        let is_first = (strongest[other as usize] == back) & (cell < other);
        if is_first {
            cell << 1
        } else {
            other << 1 | u32::from(dual_edges.at(facet).is_opposite())
        }
    };
    let mut level: Vec<u32> = (0..).zip(strongest).map(leap).collect();
    let mut is_done = false;
    while !is_done {
        is_done = true;
        for cell in 0..level.len() {
            let leap = level[cell];
            let further = level[(leap >> 1) as usize] ^ leap & 1;
            is_done &= further == leap;
            level[cell] = further;
        }
    }
    // Those that stand for parts are numbered.
    let mut number = vec![0u32; level.len()];
    let mut parts = 0;
    for (cell, &to) in (0..).zip(&level) {
        number[cell as usize] = parts;
        parts += u32::from(to >> 1 == cell);
    }
    level.iter_mut().for_each(|leap| *leap = number[(*leap >> 1) as usize] << 1 | *leap & 1);
    (level, parts as usize)
}

/// The facets between parts of cells, each from its first cell, by tasks.
fn first_cross_edges(
    dual_edges: &DualEdges,
    cells: &Cells,
    level: &[u32],
    best: &[AtomicU64],
) -> Vec<Vec<CrossEdge>> {
    // A facet, and the levels of its two cells.
    let task = |between: &mut Vec<[u32; 3]>, begin: usize| {
        let some = begin as u32..cells.len().min(begin + TASK) as u32;
        between.resize(4 * some.len(), [0; 3]);
        let mut count = 0;
        for cell in some {
            let own = level[cell as usize];
            for i in 0..4 {
                let (other, _) = cells.across(cell, i);
                let beyond = level[other as usize];
                // All are written and most of them written over: which are between parts cannot be guessed.
                between[count] = [cell << 2 | i as u32, own, beyond];
                count += usize::from((other > cell) & (own >> 1 != beyond >> 1));
            }
        }
        let cross_edge = |&[facet, own, beyond]: &[u32; 3]| {
            let dual_edge = dual_edges.at(facet);
            let sign = (own ^ beyond) & 1 ^ u32::from(dual_edge.is_opposite());
            CrossEdge { ends: [own & !1 | sign, beyond >> 1], facet, weight: dual_edge.key }
        };
        let cross_edges: Vec<CrossEdge> = between[..count].iter().map(cross_edge).collect();
        offer(best, begin / TASK, &cross_edges);
        cross_edges
    };
    let begins: Vec<usize> = (0..cells.len()).step_by(TASK).collect();
    begins.into_par_iter().map_init(Vec::new, task).collect()
}

/// Keeps the cross edges that are between parts after these were joined.
fn keep_between(cross_edges: &mut [Vec<CrossEdge>], level: &[u32], best: &[AtomicU64]) {
    let keep = |(task, cross_edges): (usize, &mut Vec<CrossEdge>)| {
        let mut count = 0;
        for k in 0..cross_edges.len() {
            let mut cross_edge = cross_edges[k];
            let [one, two] = cross_edge.parts().map(|part| level[part as usize]);
            let sign = (one ^ two ^ cross_edge.ends[0]) & 1;
            cross_edge.ends = [one & !1 | sign, two >> 1];
            // Written whether it is kept or not, as that cannot be guessed.
            cross_edges[count] = cross_edge;
            count += usize::from(one >> 1 != two >> 1);
        }
        cross_edges.truncate(count);
        offer(best, task, cross_edges);
    };
    cross_edges.par_iter_mut().enumerate().for_each(keep);
}
