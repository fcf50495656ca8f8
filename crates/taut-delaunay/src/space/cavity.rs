//! The cavity of a point: all simplices whose circumsphere holds it, and the facets around them.
//!
//! *Problem.* The simplices in conflict with q are connected; find them from one of them with few tests and few
//! branches that a processor cannot foresee.
//! *Idea.* A queue. The neighbors of what is inside that nobody has seen yet are listed without a branch: each is
//! written to the end of the list, and the list grows by one if its mark was zero. The list is tested in groups as wide
//! as the machine allows; who is in conflict is inside, and has its own neighbors listed, before the next group. Facets
//! come last, in one pass of the same kind: a facet is on the boundary if its neighbor was seen and is not inside.
//! *Guarantee.* Signs are exact under the perturbation, so the cavity is a ball, star-shaped around q. No recursion;
//! time linear in the cavity; marks are zero again at the end.
//! *Trap.* A ghost has no circumsphere. Its vertex at infinity is a row of NaN, which makes every comparison of a
//! determinant with its bound false: the test is left open, and what is left open asks for ghosts first.
//! *Measured.* Uniform points take 43 tests and 20 simplices inside; of their time a third is the arithmetic of the tests,
//! a quarter the listing and the facets, a quarter the star, the rest the walk. Marking each simplex where its answer
//! is known, one by one, cost 12 % more: how many of a group are inside is a branch that nobody can foresee. Fetching a
//! neighbor when it is listed saves 6 % of a million sites.
//! *Reference.* Bowyer; Watson, both Comput. J. 24(2), 1981.

use crate::simplex::GHOST;
use crate::threads::{Hold, Mark, Slot};

use super::Site;
use super::signs::{Judge, Signs};

/// This simplex has been listed as a neighbor of the cavity.
const SEEN_BIT: u8 = 2;
/// This simplex belongs to the cavity.
const INSIDE_BIT: u8 = 1;

/// Vertices of the facet opposite vertex i, in the order that makes (i, a, b, c) an even permutation: with a point on
/// the inner side of the facet in front, (q, a, b, c) is positive.
pub(super) const FACETS: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [3, 0, 1], [2, 1, 0]];

/// A facet of the boundary of the cavity.
#[repr(C)]
#[derive(Clone, Copy, Default)]
pub(super) struct Facet {
    /// Seen from the cavity in positive order: (q, a, b, c) is the simplex to make.
    pub(super) vertices: [u32; 3],
    /// The facet of the simplex outside, as a neighbor code.
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
    /// The part of `facets` that is in use.
    boundary: usize,
}

impl Cavity {
    /// The facets around the cavity, and the slots in it, to be made as many as the facets.
    #[inline(always)]
    pub(super) fn facets_and_slots(&mut self) -> (&[Facet], &mut Vec<u32>) {
        (&self.facets[..self.boundary], &mut self.inside)
    }

    /// Finds all simplices in conflict with q, from `start`, which must be one and held; holds the others. `marks` are
    /// all zero before and after. Returns how many tests it took, and false if another thread holds one of them.
    #[inline(always)]
    pub(super) fn carve<S: Signs, H: Hold>(
        &mut self,
        signs: S,
        sites: &[Site],
        simplices: &[H::Slot<4>],
        marks: &[H::Mark],
        judge: &mut Judge,
        hold: &mut H,
        q: &Site,
        start: u32,
    ) -> (u64, bool) {
        let marks = &marks[..simplices.len()];
        let (mut inside, mut listed, mut seen, mut tested) = (1, 0, 0, 0);
        if self.inside.len() < 64 {
            self.inside.resize(64, 0);
        }
        self.inside[0] = start;
        marks[start as usize].set(INSIDE_BIT);
        let mut all_held = true;
        loop {
            let room = seen + 4 * (inside - listed) + S::WIDTH;
            if self.seen.len() < room {
                self.seen.resize(2 * room, 0);
            }
            let list = &mut self.seen[..];
            for &t in &self.inside[listed..inside] {
                // Asked first, or one thread alone would load the vertices too.
                if H::SHARED && !hold.hold(simplices[t as usize].vertices()) {
                    all_held = false;
                    break;
                }
                marks[t as usize].set(INSIDE_BIT);
                for code in simplices[t as usize].neighbors() {
                    let neighbor = code >> 2;
                    let mark = &marks[neighbor as usize];
                    let before = mark.get();
                    list[seen] = neighbor;
                    signs.fetch(simplices.as_ptr().wrapping_add(neighbor as usize));
                    seen += usize::from(before == 0);
                    mark.set(before | SEEN_BIT);
                }
            }
            listed = inside;
            if tested == seen || !all_held {
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
        if all_held {
            self.inside.truncate(inside);
            self.bound(signs, simplices, marks);
        }
        for &t in &self.seen[..seen] {
            marks[t as usize].set(0);
        }
        marks[start as usize].set(0);
        (seen as u64, all_held)
    }

    /// Lists the facets between the cavity and the rest.
    #[inline(always)]
    fn bound<S: Signs>(&mut self, signs: S, simplices: &[impl Slot<4>], marks: &[impl Mark]) {
        let room = 4 * self.inside.len();
        if self.facets.len() < room {
            self.facets.resize(2 * room, Facet::default());
        }
        let list = &mut self.facets[..room];
        let mut boundary = 0;
        for &t in &self.inside {
            let simplex = &simplices[t as usize];
            let [a, b, c, d] = simplex.neighbors();
            let is_seen = |code: u32| marks[(code >> 2) as usize].get() == SEEN_BIT;
            signs.put::<0>(simplex, &mut list[boundary]);
            boundary += usize::from(is_seen(a));
            signs.put::<1>(simplex, &mut list[boundary]);
            boundary += usize::from(is_seen(b));
            signs.put::<2>(simplex, &mut list[boundary]);
            boundary += usize::from(is_seen(c));
            signs.put::<3>(simplex, &mut list[boundary]);
            boundary += usize::from(is_seen(d));
        }
        self.boundary = boundary;
    }
}

/// The place of the vertex at infinity.
#[inline(always)]
pub(super) fn ghost_place(vertices: [u32; 4]) -> Option<usize> {
    vertices.iter().position(|&v| v == GHOST)
}
