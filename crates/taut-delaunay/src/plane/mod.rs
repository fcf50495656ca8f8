//! The kernel of the plane: one site after another is walked to, and what it is in conflict with is replaced by its star.
//!
//! *Problem.* The Delaunay triangulation of sites in ℝ², closed by ghost triangles, under the lexicographic
//! perturbation.
//! *Idea.* A triangle is in conflict with a new site q if its circumcircle holds q; such triangles form a disc, seen
//! whole from q. Find one of them by a visibility walk from the site before, dig from edge to edge through all
//! of them, counter-clockwise around q, and make every edge of the rim a triangle of the star at once.
//! *Guarantee.* Signs are exact and never tie, so the mesh is a function of the set of inserted sites. A ghost answers
//! for the outside of its hull edge. Per insertion two slots are added and none is left dead. No recursion.
//! *Trap.* All tests take place in coordinates relative to q. A vertex that two tests share keeps its difference, its
//! lift and its 2 × 2 minor from one to the next: of the three vertices of a triangle only one is ever loaded.
//! *Cost.* For uniform points in rounds along a Hilbert curve, per site: 1.3 triangles walked through, 9.0 conflict
//! tests, 6 triangles written. A fifth of the time goes to first touches of new pages, a fifth to the walk, the rest
//! to the cavity. Indices without bounds checks and slots made in batches gave nothing.
//! *Reference.* Bowyer 1981 and Watson 1981 for the cavity; Devillers, Pion and Teillaud 2002 for the walk; Amenta,
//! Choi and Rote 2003 for the rounds that the caller inserts in.

pub(crate) mod constrained;
mod dig;
mod dispatch;
mod seen;
mod star;
#[cfg(test)]
mod tests;
mod walk;

use taut_predicates::plane::orient_exact;
use taut_predicates::{Exact, MulAdd, Separate};

use crate::kernel::{Counters, Kernel, Settings, TooMany};
use crate::simplex::{DEAD_MARK, GHOST, Simplex, code};
use dig::{Edge, dig};
use seen::View;
use star::Star;
use walk::walk;

/// Triangles are numbered with 30 bits, as a code has two more for the facet.
const TRIANGLES_MAX: usize = 1 << 30;

/// A Delaunay triangulation under construction.
pub(crate) struct Mesh {
    sites: Vec<[f64; 2]>,
    triangles: Vec<Simplex<3>>,
    /// Where the next walk begins: a triangle of the site inserted last.
    last: u32,
    settings: Settings,
    exact: Exact,
    counters: Counters,
    /// Edges still to be looked through while digging; kept for its memory.
    pending: Vec<Edge>,
    /// Slots that the star may take; kept for its memory.
    free: Vec<u32>,
}

const DEAD_SLOT: Simplex<3> = Simplex { vertices: [DEAD_MARK; 3], neighbors: [0; 3] };

impl Kernel<2, 3> for Mesh {
    fn new(sites: Vec<[f64; 2]>, settings: Settings) -> Mesh {
        Mesh {
            // A closed mesh of n sites and the ghost vertex has 2n − 2 triangles.
            triangles: Vec::with_capacity(2 * sites.len()),
            sites,
            last: 0,
            settings,
            exact: Exact::new(settings.integral),
            counters: Counters::default(),
            pending: Vec::new(),
            free: Vec::new(),
        }
    }

    fn site_count(&self) -> u32 {
        self.sites.len() as u32
    }

    #[inline(always)]
    fn site(&self, site: u32) -> [f64; 2] {
        self.sites[site as usize]
    }

    fn start(&mut self, [a, b, c]: [u32; 3]) {
        let [p, q, r] = [a, b, c].map(|v| self.sites[v as usize]);
        self.counters.orientations += 1;
        self.counters.insertions += 3;
        let (b, c) =
            if orient_exact(p, q, r, &mut self.exact).is_positive() { (b, c) } else { (c, b) };
        // Ghost i lies across the edge opposite vertex i; its ghost vertex has place 0, as has the hull edge.
        let ghost = |from: u32, to: u32, inside: u32, next: u32, last: u32| Simplex {
            vertices: [GHOST, to, from],
            neighbors: [inside, code(last, 2), code(next, 1)],
        };
        self.triangles.clear();
        self.triangles.extend([
            Simplex { vertices: [a, b, c], neighbors: [code(1, 0), code(2, 0), code(3, 0)] },
            ghost(b, c, code(0, 0), 2, 3),
            ghost(c, a, code(0, 1), 3, 1),
            ghost(a, b, code(0, 2), 1, 2),
        ]);
        self.last = 0;
    }

    fn insert(&mut self, sites: &[u32]) -> Result<(), TooMany> {
        if self.triangles.len() + 2 * sites.len() > TRIANGLES_MAX {
            return Err(TooMany);
        }
        dispatch::insert(self, sites);
        self.counters.insertions += sites.len() as u64;
        // The walk finds the first triangle of each cavity, digging counts the others.
        self.counters.replaced += sites.len() as u64;
        Ok(())
    }

    fn push(&mut self, site: [f64; 2]) -> u32 {
        let number = u32::try_from(self.sites.len()).expect("sites are numbered with 32 bits");
        self.sites.push(site);
        number
    }

    #[inline(always)]
    fn simplices(&self) -> &[Simplex<3>] {
        &self.triangles
    }

    fn last(&self) -> u32 {
        self.last
    }

    fn locate(&mut self, q: [f64; 2], hint: u32) -> u32 {
        let view = View::new(&self.sites, q, self.settings.filtered);
        walk::<Separate>(&view, &self.triangles, hint, &mut self.exact, &mut self.counters).triangle
    }

    fn finish(mut self) -> (Vec<Simplex<3>>, Option<Vec<[f64; 2]>>, Counters) {
        // The filters of the common path count nothing: what no other stage decided was theirs.
        let mut stages = self.exact.stages;
        let open = stages.calls() - stages.filter;
        stages.filter =
            (self.counters.orientations + self.counters.conflict_tests).saturating_sub(open);
        self.counters.stages = stages;
        (self.triangles, Some(self.sites), self.counters)
    }
}

impl Mesh {
    #[inline(always)]
    fn insert_all<M: MulAdd>(&mut self, sites: &[u32]) {
        for (place, &site) in sites.iter().enumerate() {
            self.insert_one::<M>(site, *sites.get(place + 1).unwrap_or(&site));
        }
    }

    #[inline(always)]
    fn insert_one<M: MulAdd>(&mut self, site: u32, next: u32) {
        // Every insertion adds one vertex to a sphere, hence two triangles.
        let slot = self.triangles.len() as u32;
        self.triangles.extend([DEAD_SLOT; 2]);
        self.free.extend([slot + 1, slot]);
        let view = View::new(&self.sites, self.sites[site as usize], self.settings.filtered);
        let triangles = &mut self.triangles[..];
        let found = walk::<M>(&view, triangles, self.last, &mut self.exact, &mut self.counters);
        let mut star = Star::new(site, triangles, &mut self.free, &found, view.see::<M>(next));
        dig::<M, _>(
            &view,
            found,
            &mut self.pending,
            &mut self.exact,
            &mut self.counters,
            &mut star,
        );
        self.last = star.close();
    }
}
