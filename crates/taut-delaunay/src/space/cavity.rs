//! The cavity of a point: all simplices whose circumsphere holds it, and the facets around them.
//!
//! *Problem.* The simplices in conflict with q are connected; find them from one of them with few tests and few
//! branches that a processor cannot foresee.
//! *Idea.* Level by level. The neighbours of one level that nobody has seen yet become a list, without a branch: each
//! is written to the end of the list, and the list grows by one if its mark was zero. The list is then tested in groups
//! as wide as the machine allows, and who is in conflict forms the next level. Facets come last, in one pass of the same
//! kind: a facet is on the boundary if its neighbour was seen and is not inside.
//! *Guarantee.* Signs are exact under the perturbation, so the cavity is a ball, star-shaped around q. No recursion;
//! time linear in the cavity; marks are zero again at the end.
//! *Trap.* A ghost has no circumsphere. Its vertex at infinity is a row of NaN, which makes every comparison of a
//! determinant with its bound false: the test is left open, and what is left open asks for ghosts first.
//! *Reference.* Bowyer; Watson, both Comput. J. 24(2), 1981.

use crate::simplex::{GHOST, Simplex};

use super::Site;
use super::signs::{Judge, Signs};

/// This simplex has been listed as a neighbour of the cavity.
const SEEN: u8 = 2;
/// This simplex belongs to the cavity.
const INSIDE: u8 = 1;

/// Vertices of the facet opposite vertex i, in the order that makes (i, a, b, c) an even permutation: with a point on
/// the inner side of the facet in front, (q, a, b, c) is positive.
pub(super) const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [3, 0, 1], [2, 1, 0]];

/// A facet of the boundary of the cavity.
#[derive(Clone, Copy, Default)]
pub(super) struct Facet {
    /// Seen from the cavity in positive order: (q, a, b, c) is the simplex to make.
    pub(super) vertices: [u32; 3],
    /// The facet of the simplex outside, as a neighbour code.
    pub(super) outside: u32,
}

/// The lists of one cavity, kept between insertions so that nothing is allocated.
#[derive(Default)]
pub(super) struct Cavity {
    /// Simplices in conflict; the first is the start.
    pub(super) inside: Vec<u32>,
    /// Everything that was marked but the start; longer than what is in use.
    seen: Vec<u32>,
    /// The boundary; longer than what is in use.
    facets: Vec<Facet>,
    /// How much of `facets` is in use.
    boundary: usize,
}

impl Cavity {
    /// The facets around the cavity, and the slots in it, to be made as many as the facets.
    #[inline(always)]
    pub(super) fn facets_and_slots(&mut self) -> (&[Facet], &mut Vec<u32>) {
        (&self.facets[..self.boundary], &mut self.inside)
    }

    /// Finds all simplices in conflict with q, from `start`, which must be one. `marks` are all zero before and after.
    /// Returns how many tests it took.
    #[inline(always)]
    pub(super) fn carve<S: Signs>(
        &mut self,
        signs: S,
        sites: &[Site],
        simplices: &[Simplex<4>],
        marks: &mut [u8],
        judge: &mut Judge,
        q: &Site,
        start: u32,
    ) -> u64 {
        let marks = &mut marks[..simplices.len()];
        let (mut inside, mut listed, mut seen, mut tested) = (1, 0, 0, 0);
        if self.inside.len() < 64 {
            self.inside.resize(64, 0);
        }
        self.inside[0] = start;
        marks[start as usize] = INSIDE;
        loop {
            let room = seen + 4 * (inside - listed) + S::WIDTH;
            if self.seen.len() < room {
                self.seen.resize(2 * room, 0);
            }
            let list = &mut self.seen[..];
            for &t in &self.inside[listed..inside] {
                marks[t as usize] = INSIDE;
                for code in simplices[t as usize].neighbors {
                    let neighbor = code >> 2;
                    let mark = &mut marks[neighbor as usize];
                    list[seen] = neighbor;
                    seen += usize::from(*mark == 0);
                    *mark |= SEEN;
                }
            }
            listed = inside;
            if tested == seen {
                break;
            }
            // The last group is filled up with what is surely there.
            list[seen..seen + S::WIDTH].fill(start);
            let group = &list[tested..tested + S::WIDTH];
            let asked = u32::MAX >> (32 - (seen - tested).min(S::WIDTH));
            tested = (tested + S::WIDTH).min(seen);
            let (conflicts, open) = signs.conflicts(sites, simplices, group, q);
            let (mut conflicts, open) = (conflicts & asked, open & asked);
            if open != 0 {
                conflicts |= judge.conflicts(signs, sites, simplices, group, open, q);
            }
            if self.inside.len() < inside + S::WIDTH {
                self.inside.resize(2 * inside + S::WIDTH, 0);
            }
            let next = &mut self.inside[inside..inside + S::WIDTH];
            let mut more = 0;
            for lane in 0..S::WIDTH {
                next[more] = group[lane];
                more += (conflicts >> lane & 1) as usize;
            }
            inside += more;
        }
        self.inside.truncate(inside);
        self.bound(simplices, marks);
        for &t in &self.seen[..seen] {
            marks[t as usize] = 0;
        }
        marks[start as usize] = 0;
        seen as u64
    }

    /// Lists the facets between the cavity and the rest.
    #[inline(always)]
    fn bound(&mut self, simplices: &[Simplex<4>], marks: &[u8]) {
        let room = 4 * self.inside.len();
        if self.facets.len() < room {
            self.facets.resize(2 * room, Facet::default());
        }
        let list = &mut self.facets[..room];
        let mut boundary = 0;
        for &t in &self.inside {
            let Simplex { vertices, neighbors } = simplices[t as usize];
            for i in 0..4 {
                let ([a, b, c], outside) = (FACETS[i], neighbors[i]);
                list[boundary] =
                    Facet { vertices: [vertices[a], vertices[b], vertices[c]], outside };
                boundary += usize::from(marks[(outside >> 2) as usize] == SEEN);
            }
        }
        self.boundary = boundary;
    }
}

/// The place of the vertex at infinity.
#[inline(always)]
pub(super) fn ghost_place(simplex: &Simplex<4>) -> Option<usize> {
    simplex.vertices.iter().position(|&v| v == GHOST)
}
