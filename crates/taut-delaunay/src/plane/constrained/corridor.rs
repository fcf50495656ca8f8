//! The triangles that a segment crosses, taken out and filled again on both sides of it.
//!
//! *Idea.* The side left of the segment is a polygon: the segment as its base, and a chain of vertices from its start
//! to its end. Of these take the one whose circle through the base holds no other; with the base it is a triangle,
//! and its two other edges are the bases of what is left. The right side is a left side seen from the other end.
//! *Guarantee.* Every vertex of a chain sees the base from inside the corridor, as an edge goes from it across the
//! segment; so each is strictly left of the base, also later on, and the choice is the constrained Delaunay triangle.
//! As many triangles go in as came out.
//! *Trap.* A vertex w may come up twice, but is not chosen before what lies between. The edges from w that cross the
//! segment cross it before and after those from there, so what lies between is inside the triangle of w and the base.
//! The ends of a base come up once: edges at the ends of the segment do not cross it, later ones have been chosen.

use taut_predicates::plane::conflict;

use super::NONE;
use crate::simplex::{Simplex, code, decode};

/// An edge of the corridor's border, from the chain's vertex here to the next.
#[derive(Clone, Copy)]
struct Border {
    vertex: u32,
    /// Its facet in the corridor as it was, and the one behind.
    inner: u32,
    outer: u32,
    owner: u32,
    /// Its facet in the corridor as it is now.
    filled: u32,
}

/// One corridor at a time; the memory serves them all.
pub(super) struct Corridor {
    /// The triangles, and for each of the mesh whether it is one of them.
    triangles: Vec<u32>,
    inside: Vec<bool>,
    /// From the start of the segment to its end.
    left: Vec<Border>,
    /// As it is met: each edge with its end that is nearer to the start.
    right: Vec<Border>,
    /// Bases that are yet to be filled: a range of the chain, and the facet on the other side.
    bases: Vec<(usize, usize, u32)>,
    /// Edges with both sides inside: the facet as it was and as it is now.
    hanging: Vec<(u32, u32)>,
}

impl Corridor {
    pub(super) fn new(triangles: usize) -> Corridor {
        Corridor {
            triangles: Vec::new(),
            inside: vec![false; triangles],
            left: Vec::new(),
            right: Vec::new(),
            bases: Vec::new(),
            hanging: Vec::new(),
        }
    }

    /// Starts at a site, with the triangle whose facet opposite this site is crossed first.
    pub(super) fn begin(&mut self, from: u32, all: &[Simplex<3>], owners: &[[u32; 3]], facet: u32) {
        let (triangle, i) = decode(facet);
        self.enter(triangle);
        // (from, a, b): a on the right, b on the left.
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        self.left.push(border(all, owners, from, triangle, j));
        self.right.push(border(all, owners, from, triangle, k));
    }

    /// Goes on through a triangle, entered by this facet with its apex on one side; returns the facet crossed next.
    pub(super) fn advance(
        &mut self,
        all: &[Simplex<3>],
        owners: &[[u32; 3]],
        behind: u32,
        left: bool,
    ) -> u32 {
        let (triangle, i) = decode(behind);
        self.enter(triangle);
        // (apex, l, r): from the side entered, l is on the left and r on the right.
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let t = &all[triangle as usize];
        if left {
            self.left.push(border(all, owners, t.vertices[j], triangle, k));
            code(triangle, j as u32)
        } else {
            self.right.push(border(all, owners, t.vertices[k], triangle, j));
            code(triangle, k as u32)
        }
    }

    /// Ends at the apex of a triangle entered by this facet.
    pub(super) fn end(&mut self, all: &[Simplex<3>], owners: &[[u32; 3]], behind: u32) {
        let (triangle, i) = decode(behind);
        self.enter(triangle);
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        let t = &all[triangle as usize];
        self.left.push(border(all, owners, t.vertices[j], triangle, k));
        self.right.push(border(all, owners, t.vertices[k], triangle, j));
        // Ends of the chains: vertices without an edge.
        let end =
            Border { vertex: t.vertices[i], inner: NONE, outer: NONE, owner: NONE, filled: NONE };
        self.left.push(end);
        self.right.push(end);
    }

    /// Forgets a corridor that is not to be filled.
    pub(super) fn abandon(&mut self) {
        for &triangle in &self.triangles {
            self.inside[triangle as usize] = false;
        }
        self.triangles.clear();
        self.left.clear();
        self.right.clear();
    }

    fn enter(&mut self, triangle: u32) {
        self.inside[triangle as usize] = true;
        self.triangles.push(triangle);
    }

    /// Fills both sides, with the segment as an edge between them.
    pub(super) fn fill(
        &mut self,
        sites: &[[f64; 2]],
        all: &mut [Simplex<3>],
        owners: &mut [[u32; 3]],
        around: &mut [u32],
        number: u32,
    ) {
        // The right chain from the end of the segment to its start: edges move to their other ends.
        for i in 1..self.right.len() {
            self.right[i - 1].vertex = self.right[i].vertex;
        }
        let start = self.left[0].vertex;
        self.right.pop();
        self.right.reverse();
        self.right.push(Border {
            vertex: start,
            inner: NONE,
            outer: NONE,
            owner: NONE,
            filled: NONE,
        });

        let mut slots = std::mem::take(&mut self.triangles);
        let [mut left, mut right] =
            [std::mem::take(&mut self.left), std::mem::take(&mut self.right)];
        for &slot in &slots {
            owners[slot as usize] = [NONE; 3];
        }
        let mut free = slots.iter().copied();
        let [above, below] = [&mut left, &mut right].map(|chain| {
            let base = self.fill_side(sites, all, around, &mut free, chain);
            owners[base as usize][2] = number;
            code(base, 2)
        });
        debug_assert!(free.next().is_none(), "as many triangles go in as came out");
        all[decode(above).0 as usize].neighbors[2] = below;
        all[decode(below).0 as usize].neighbors[2] = above;

        // Edges of the border meet what is outside, or the other side of themselves.
        let edges = || left.iter().chain(&right).filter(|edge| edge.filled != NONE);
        self.hanging.clear();
        self.hanging.extend(
            edges().filter(|edge| hangs(&self.inside, edge)).map(|edge| (edge.inner, edge.filled)),
        );
        self.hanging.sort_unstable();
        for edge in edges() {
            let (slot, facet) = decode(edge.filled);
            owners[slot as usize][facet] = edge.owner;
            all[slot as usize].neighbors[facet] = if hangs(&self.inside, edge) {
                let other = self.hanging.binary_search_by_key(&edge.outer, |&(inner, _)| inner);
                self.hanging[other.expect("an edge that hangs has two sides")].1
            } else {
                let (outer, place) = decode(edge.outer);
                all[outer as usize].neighbors[place] = edge.filled;
                edge.outer
            };
        }
        for &slot in &slots {
            self.inside[slot as usize] = false;
        }
        left.clear();
        right.clear();
        slots.clear();
        (self.triangles, self.left, self.right) = (slots, left, right);
    }

    /// Fills the polygon between a chain and its base, and returns the triangle at the base; its facet 2 is the base.
    fn fill_side(
        &mut self,
        sites: &[[f64; 2]],
        all: &mut [Simplex<3>],
        around: &mut [u32],
        free: &mut impl Iterator<Item = u32>,
        chain: &mut [Border],
    ) -> u32 {
        let mut first = NONE;
        self.bases.push((0, chain.len() - 1, NONE));
        while let Some((i, j, behind)) = self.bases.pop() {
            let c = apex(sites, chain, i, j);
            let slot = free.next().expect("as many triangles go in as came out");
            let vertices = [i, j, c].map(|at| chain[at].vertex);
            all[slot as usize] = Simplex { vertices, neighbors: [NONE, NONE, behind] };
            for site in vertices {
                around[site as usize] = slot;
            }
            if behind == NONE {
                first = slot;
            } else {
                let (other, facet) = decode(behind);
                all[other as usize].neighbors[facet] = code(slot, 2);
            }
            for (from, to, facet) in [(c, j, code(slot, 0)), (i, c, code(slot, 1))] {
                if to - from == 1 {
                    chain[from].filled = facet;
                } else {
                    self.bases.push((from, to, facet));
                }
            }
        }
        first
    }
}

/// Returns true if both sides of an edge are in the corridor.
fn hangs(inside: &[bool], edge: &Border) -> bool {
    edge.outer != NONE && inside[decode(edge.outer).0 as usize]
}

/// The edge of a triangle at this place, from `vertex` on.
fn border(
    all: &[Simplex<3>],
    owners: &[[u32; 3]],
    vertex: u32,
    triangle: u32,
    at: usize,
) -> Border {
    Border {
        vertex,
        inner: code(triangle, at as u32),
        outer: all[triangle as usize].neighbors[at],
        owner: owners[triangle as usize][at],
        filled: NONE,
    }
}

/// The vertex between i and j whose circle with the base from i to j holds no other.
fn apex(sites: &[[f64; 2]], chain: &[Border], i: usize, j: usize) -> usize {
    let point = |at: usize| sites[chain[at].vertex as usize];
    let mut best = i + 1;
    for at in i + 2..j {
        let again = chain[at].vertex == chain[best].vertex;
        if !again && conflict(point(i), point(j), point(best), point(at)) {
            best = at;
        }
    }
    best
}
