//! Flat cells, which say nothing of their own.
//!
//! *Problem.* Four points nearly on one circle, as every square of a grid has, make a cell without volume within or upon a face. All
//! spheres through the circle are in one pencil, and that of the cell is somewhere between those of the cells beyond its facets: it
//! divides the angle between them, and where they meet in an angle that says "opposite", two smaller ones say "same".
//! *Idea.* A flat cell that says "same" to all its neighbours, and not surely to all, has the sphere of one of them for its own: of the one
//! most like it. One of its sides is then as one cell with that neighbour, and the facets of the other side say what the two that are no
//! flat cells have to say to each other. Where such cells are beside each other, as polygons on a circle have them, they take what their
//! neighbour took, along the surest tree.
//! *Guarantee.* A function of the points: what is equally sure is ordered by the numbers of facets. O(n + f log f) for f such cells.
//! *Trap.* A cell that is flat but whose corners are far from any circle has a sphere as large as a half-space, and much to say; but so
//! have its neighbours.

use std::cmp::Reverse;

use super::cells::Cells;
use super::media::Media;
use super::spheres::{Point, Sphere, circumcircle};
use super::strengths::{CERTAIN, Tie, Ties, normal};

/// A cell is flat if the square of its volume, six times as large as it is, is at most this beside the product of those of the edges
/// from its first vertex. From 10⁻⁶ down, wedges whose points are off by a thousandth of their spacing get handles; from 10⁻⁴ up, ellipsoids that are close merge.
pub(super) const FLAT: f64 = 1e-5;
/// So much of "same" is sure.
const SURE: i64 = CERTAIN / 100 * 95;

/// A facet of a flat cell over which it may get its sphere; the surest is the greatest.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Offer {
    strength: i64,
    /// From the cell with the lower number.
    facet: Reverse<u32>,
}

/// Those of some flat cells that take the sphere of another one, in any order, with these spheres. The ties are of all cells with
/// spheres of their own.
pub(super) fn flats(
    flat: &[u32],
    ties: &Ties,
    (cells, points): (&Cells, &[Point]),
    spheres: &[Sphere],
) -> Vec<(u32, Sphere)> {
    let flat: Vec<u32> = flat.iter().copied().filter(|&cell| divides(cell, ties)).collect();
    if flat.is_empty() {
        return Vec::new();
    }
    // The nodes: all cells that are not flat are the first one, the flat ones follow.
    let mut node = vec![0u32; cells.len()];
    (1..).zip(&flat).for_each(|(k, &cell)| node[cell as usize] = k);
    let across = |facet: u32| cells.mirror(facet) >> 2;
    let mut tree = Tree::of(flat.len());
    for &cell in &flat {
        let surest = offers(cell, ties, cells).max();
        surest.into_iter().for_each(|offer| tree.join(offer, &node, cells));
    }
    // What hangs together with flat cells alone looks beyond itself.
    let mut alone: Vec<u32> = (1..=flat.len() as u32).collect();
    let mut best = vec![Offer::NONE; flat.len() + 1];
    loop {
        alone.retain(|&k| tree.parts.root(k) >> 1 != 0);
        if alone.is_empty() {
            break;
        }
        for &k in &alone {
            let (cell, own) = (flat[k as usize - 1], tree.parts.root(k) >> 1);
            for (i, offer) in (0..).zip(offers(cell, ties, cells)) {
                let other = node[across(cell << 2 | i) as usize];
                if tree.parts.root(other) >> 1 != own {
                    best[own as usize] = best[own as usize].max(offer);
                }
            }
        }
        for &k in &alone {
            let offer = std::mem::replace(&mut best[k as usize], Offer::NONE);
            if offer != Offer::NONE {
                tree.join(offer, &node, cells);
            }
        }
    }
    // From the cells that are not flat into the flat ones.
    let mut taken: Vec<(u32, Sphere)> = Vec::with_capacity(flat.len());
    let mut open = Vec::new();
    for &(cell, facet) in &tree.roots {
        let from = across(facet);
        let sphere = match cells.is_ghost(from) {
            true => half_space(cells.facet(cell, facet as usize & 3), points),
            false => spheres[from as usize],
        };
        open.push((cell, u32::MAX));
        while let Some((cell, from)) = open.pop() {
            taken.push((cell, sphere));
            let places = tree.places[node[cell as usize] as usize - 1];
            let beside = (0..4).filter(|i| places >> i & 1 == 1).map(|i| across(cell << 2 | i));
            open.extend(beside.filter(|&next| next != from).map(|next| (next, cell)));
        }
    }
    taken
}

impl Offer {
    const NONE: Self = Self { strength: i64::MIN, facet: Reverse(u32::MAX) };
}

/// Whether a cell says "same" to all its neighbours, though not surely to one of them.
fn divides(cell: u32, ties: &Ties) -> bool {
    let least = ties.of_cell(cell).map(Tie::signed).into_iter().min();
    least.is_some_and(|least| (0..SURE).contains(&least))
}

/// What may be taken over the facets of a cell. It counts how flat cells lie in their pencil, which is known from their own spheres: so
/// an offer is the same from both sides.
fn offers<'a>(cell: u32, ties: &'a Ties, cells: &'a Cells) -> impl Iterator<Item = Offer> + 'a {
    (0..).zip(ties.of_cell(cell)).map(move |(i, tie)| {
        let facet = cell << 2 | i;
        Offer { strength: tie.signed(), facet: Reverse(facet.min(cells.mirror(facet))) }
    })
}

/// The surest tree of flat cells and of all others as one.
struct Tree {
    parts: Media,
    /// For each flat cell the facets of the tree to other flat cells, one bit each.
    places: Vec<u8>,
    /// Flat cells and their facets of the tree to cells that are not.
    roots: Vec<(u32, u32)>,
}

impl Tree {
    fn of(count: usize) -> Self {
        Self { parts: Media::new(count + 1), places: vec![0; count], roots: Vec::new() }
    }

    /// Takes a facet into the tree, if it joins two parts.
    fn join(&mut self, offer: Offer, node: &[u32], cells: &Cells) {
        let facets = [offer.facet.0, cells.mirror(offer.facet.0)];
        let [a, b] = facets.map(|facet| node[(facet >> 2) as usize]);
        if !self.parts.join(a, b, false) {
            return;
        }
        for (facet, own, other) in [(facets[0], a, b), (facets[1], b, a)] {
            match (own, other) {
                (0, _) => {}
                (_, 0) => self.roots.push((facet >> 2, facet)),
                _ => self.places[own as usize - 1] |= 1 << (facet & 3),
            }
        }
    }
}

/// The half-space beyond a facet of the hull, as the sphere through its corners that is larger than any other by far.
fn half_space(facet: [u32; 3], points: &[Point]) -> Sphere {
    const FAR: f64 = (1u64 << 40) as f64;
    let mut sites = facet;
    sites.sort_unstable();
    let [a, b, c] = sites.map(|site| points[site as usize]);
    let circle = circumcircle(a, b, c);
    let (normal, _) = normal(facet, points);
    let radius = FAR * circle.radius;
    Sphere { center: [0, 1, 2].map(|k| circle.center[k] + radius * normal[k]), radius }
}
