//! The kernel of space: tetrahedra under insertion.
//!
//! *Problem.* Add sites one by one to a Delaunay triangulation of space, in about a microsecond each.
//! *Idea.* Walk from the last simplex made to the one that holds the new site; take out its cavity, all simplices whose
//! circumsphere holds it; put its star there. Sites come in the order of a space-filling curve, so all of this happens in
//! memory that was just in use, and what is left to do is arithmetic: 43 in-sphere tests per site on uniform points, which
//! run eight or four at a time where the machine has vectors.
//! *Guarantee.* The mesh is the Delaunay triangulation under the lexicographic perturbation: a function of the set of
//! inserted sites, whatever their order and whichever path took the signs. No recursion, no panic on any distinct sites;
//! more than 2³⁰ simplices are an error (two skew lines with n sites have n²/4).
//! *Trap.* The hull. A ghost is in conflict with what lies strictly beyond its facet; with what lies in the plane of that
//! facet it answers as the finite simplex behind it. That needs no in-circle test in a plane: the vertex off the plane has
//! coefficient zero in the perturbed sign.
//! *Reference.* Bowyer, Comput. J. 24(2), 1981; Watson, ibid.; Amenta, Choi and Rote, SoCG 2003, for the order.
//!
//! `walk` finds the simplex, `cavity` what must go, `star` what comes; `signs` says what they ask of arithmetic and
//! `lanes` answers it with vectors.

mod cavity;
mod lanes;
#[cfg(target_arch = "x86_64")]
mod pairs;
mod signs;
mod star;
#[cfg(test)]
mod tests;
mod walk;
#[cfg(target_arch = "x86_64")]
mod whole;

use std::marker::PhantomData;

use taut_predicates::Separate;

use crate::kernel::{Counters, Kernel, Settings, TooMany};
use crate::simplex::{DEAD_MARK, GHOST, Simplex, code};
use cavity::{Cavity, FACETS};
use lanes::Level;
use signs::{Judge, Scalar, Signs, Unfiltered};
use star::Star;

/// The coordinates of a site, padded so that one aligned load fetches them.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug)]
struct Site([f64; 4]);

impl Site {
    /// The vertex at infinity: makes every comparison with it false.
    const GHOST: Site = Site([f64::NAN; 4]);

    fn new([x, y, z]: [f64; 3]) -> Self {
        Site([x, y, z, 0.0])
    }

    /// The coordinates.
    #[inline(always)]
    fn point(&self) -> [f64; 3] {
        [self.0[0], self.0[1], self.0[2]]
    }
}

/// The row of a site: the vertex at infinity comes first, so that its number wraps to 0.
#[inline(always)]
fn row(vertex: u32) -> usize {
    vertex.wrapping_add(1) as usize
}

/// Most simplices, dead slots included: what 30 bits can number.
const SIMPLICES_MAX: usize = 1 << 30;

/// The mesh of space under construction.
pub(crate) struct Mesh {
    sites: Vec<Site>,
    simplices: Vec<Simplex<4>>,
    /// For `cavity`; zero between calls.
    marks: Vec<u8>,
    /// Dead slots.
    free: Vec<u32>,
    /// Where the next walk begins.
    last: u32,
    cavity: Cavity,
    star: Star,
    judge: Judge,
    counters: Counters,
    level: Level,
    /// Most simplices; [`SIMPLICES_MAX`] outside tests.
    limit: usize,
}

impl Kernel<3, 4> for Mesh {
    fn new(sites: Vec<[f64; 3]>, settings: Settings) -> Self {
        Self::gather(sites.len(), |i| sites[i], settings)
    }

    fn gather(count: usize, site: impl Fn(usize) -> [f64; 3], settings: Settings) -> Self {
        // Uniform points take 6.77 simplices each, ghosts included; cavities leave a few dead slots. Pages that are never
        // touched cost nothing.
        let slots = (count * 69 / 10 + 1024).min(SIMPLICES_MAX);
        let mut rows = Vec::with_capacity(count + 1);
        rows.push(Site::GHOST);
        rows.extend((0..count).map(|i| Site::new(site(i))));
        Mesh {
            sites: rows,
            simplices: Vec::with_capacity(slots),
            marks: Vec::with_capacity(slots),
            free: Vec::new(),
            last: 0,
            cavity: Cavity::default(),
            star: Star::new(count),
            judge: Judge::new(settings),
            counters: Counters::default(),
            level: Level::best(settings),
            limit: SIMPLICES_MAX,
        }
    }

    fn site_count(&self) -> u32 {
        self.sites.len() as u32 - 1
    }

    #[inline(always)]
    fn site(&self, site: u32) -> [f64; 3] {
        self.sites[row(site)].point()
    }

    fn start(&mut self, mut first: [u32; 4]) {
        debug_assert!(self.simplices.is_empty(), "a mesh starts once");
        let sign = self.judge.orient(first.map(|v| &self.sites[row(v)]));
        debug_assert!(!sign.is_zero(), "the first four sites span space");
        if sign.is_negative() {
            first.swap(2, 3);
        }
        // Ghost i + 1 lies across facet i: seen from outside, two vertices of that facet change places.
        let ghosts = FACETS.map(|[a, b, c]| [GHOST, first[b], first[a], first[c]]);
        let all: Vec<[u32; 4]> = std::iter::once(first).chain(ghosts).collect();
        let without = |vertices: [u32; 4], i: usize| {
            let mut facet = vertices;
            facet[i] = DEAD_MARK;
            facet.sort_unstable();
            facet
        };
        for (t, &vertices) in all.iter().enumerate() {
            let neighbors = [0, 1, 2, 3].map(|i| {
                let facet = without(vertices, i);
                let others = (0..5).filter(|&other| other != t);
                let mut sides = others.flat_map(|other| (0..4).map(move |j| (other, j)));
                let (other, j) = sides
                    .find(|&(other, j)| without(all[other], j) == facet)
                    .expect("a tetrahedron and its four ghosts close up");
                code(other as u32, j as u32)
            });
            self.simplices.push(Simplex { vertices, neighbors });
            self.marks.push(0);
        }
        self.counters.insertions += 4;
        self.counters.orientations += 1;
    }

    fn insert(&mut self, sites: &[u32]) -> Result<(), TooMany> {
        lanes::insert(self, sites)
    }

    fn push(&mut self, site: [f64; 3]) -> u32 {
        self.sites.push(Site::new(site));
        self.star.push();
        (self.sites.len() - 2) as u32
    }

    #[inline(always)]
    fn simplices(&self) -> &[Simplex<4>] {
        &self.simplices
    }

    fn last(&self) -> u32 {
        self.last
    }

    fn locate(&mut self, q: [f64; 3], hint: u32) -> u32 {
        let q = &Site::new(q);
        let Mesh { sites, simplices, judge, counters, level, .. } = self;
        if matches!(level, Level::Unfiltered) {
            walk::walk(Unfiltered, sites, simplices, judge, counters, q, hint)
        } else {
            walk::walk(Scalar::<Separate>(PhantomData), sites, simplices, judge, counters, q, hint)
        }
    }

    fn finish(self) -> (Vec<Simplex<4>>, Option<Vec<[f64; 3]>>, Counters) {
        let Mesh { simplices, mut counters, judge, .. } = self;
        let (stages, behind) = judge.into_parts();
        counters.conflict_tests += behind;
        counters.stages += stages;
        counters.stages.filter += counters.orientations + counters.conflict_tests - stages.calls();
        (simplices, None, counters)
    }
}

impl Mesh {
    /// Inserts sites in this order; the path of the signs is the caller's choice.
    #[inline(always)]
    fn insert_with<S: Signs>(&mut self, signs: S, sites: &[u32]) -> Result<(), TooMany> {
        for (i, &site) in sites.iter().enumerate() {
            // Four sites ahead: about the time that memory takes.
            if let Some(&soon) = sites.get(i + 4) {
                signs.fetch(self.sites.as_ptr().wrapping_add(row(soon)));
            }
            let q = self.sites[row(site)];
            self.find(signs, &q, self.last);
            self.replace(site)?;
        }
        Ok(())
    }

    /// Leaves the cavity of q in `cavity`; the mesh does not change.
    #[inline(always)]
    fn find<S: Signs>(&mut self, signs: S, q: &Site, hint: u32) {
        let Mesh { sites, simplices, marks, cavity, judge, counters, .. } = self;
        let start = walk::walk(signs, sites, simplices, judge, counters, q, hint);
        counters.conflict_tests += cavity.carve(signs, sites, simplices, marks, judge, q, start);
    }

    /// Puts the star of `site` in the place of its cavity.
    #[inline(always)]
    fn replace(&mut self, site: u32) -> Result<(), TooMany> {
        let Mesh { simplices, marks, free, cavity, star, counters, .. } = self;
        let (facets, slots) = cavity.facets_and_slots();
        counters.insertions += 1;
        counters.replaced += slots.len() as u64;
        // Slots of the cavity first: they are in the cache.
        while slots.len() > facets.len() {
            let slot = slots.pop().expect("the loop has just seen it");
            simplices[slot as usize].vertices[0] = DEAD_MARK;
            free.push(slot);
        }
        while slots.len() < facets.len()
            && let Some(slot) = free.pop()
        {
            slots.push(slot);
        }
        let more = facets.len() - slots.len();
        let len = simplices.len();
        if len + more > self.limit {
            return Err(TooMany);
        }
        if simplices.capacity() < len + more {
            // An eighth at a time: doubling would be the peak of the whole build.
            simplices.reserve_exact(more.max(len / 8));
            marks.reserve_exact(more.max(len / 8));
        }
        for slot in len..len + more {
            slots.push(slot as u32);
            simplices.push(Simplex { vertices: [DEAD_MARK; 4], neighbors: [0; 4] });
            marks.push(0);
        }
        star.fill(simplices, facets, slots, site);
        self.last = slots[slots.len() - 1];
        Ok(())
    }
}
