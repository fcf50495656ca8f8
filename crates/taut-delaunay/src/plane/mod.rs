//! The kernel of the plane: one site after another is walked to, and what it is in conflict with is replaced by its star.
//!
//! *Problem.* The Delaunay triangulation of sites in ℝ², closed by ghost triangles, under the lexicographic
//! perturbation.
//! *Idea.* A triangle is in conflict with a new site q if its circumcircle holds q; such triangles form a disc, seen
//! whole from q. Find one of them by a visibility [`walk`] from the triangle made last; [`dig`] from edge to edge
//! through all of them, counter-clockwise around q; every edge of the rim becomes a triangle of the star at once.
//! *Guarantee.* Signs are exact and never tie, so the mesh is a function of the set of inserted sites. A ghost answers
//! for the outside of its hull edge. Per insertion two slots are added and none is left dead. No recursion.
//! *Trap.* All tests take place in coordinates relative to q. A vertex that two tests share keeps its difference, its
//! lift and its 2 × 2 minor from one to the next: of the three vertices of a triangle only one is ever loaded.
//! *Reference.* Bowyer 1981 and Watson 1981 for the cavity; Devillers, Pion and Teillaud 2002 for the walk; Amenta,
//! Choi and Rote 2003 for the rounds that the caller inserts in.

mod dig;
mod seen;
#[cfg(test)]
mod tests;
mod walk;

use taut_predicates::Exact;
use taut_predicates::plane::orient_exact;

use crate::kernel::{Counters, Kernel, Settings, TooMany};
use crate::simplex::{DEAD, GHOST, Simplex, code};
use dig::{Collect, Edge, Star, dig};
use seen::View;
use walk::walk;

/// Triangles are numbered with 30 bits, as a code has two more for the facet.
const TRIANGLES_MAX: usize = 1 << 30;

/// A Delaunay triangulation under construction.
pub(crate) struct Mesh {
    /// Coordinates by site number, and one more that is not a number: it stands for the ghost vertex, so that every
    /// comparison with it is false and the common path need not ask for it.
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

const NOWHERE: [f64; 2] = [f64::NAN, f64::NAN];
const DEAD_SLOT: Simplex<3> = Simplex { vertices: [DEAD; 3], neighbors: [0; 3] };

impl Kernel<2, 3> for Mesh {
    fn new(mut sites: Vec<[f64; 2]>, settings: Settings) -> Mesh {
        sites.reserve_exact(1);
        sites.push(NOWHERE);
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
        self.sites.len() as u32 - 1
    }

    fn site(&self, site: u32) -> [f64; 2] {
        self.sites[site as usize]
    }

    fn start(&mut self, [a, b, c]: [u32; 3]) {
        let [p, q, r] = [a, b, c].map(|v| self.sites[v as usize]);
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
        for (place, &site) in sites.iter().enumerate() {
            self.insert_one(site, *sites.get(place + 1).unwrap_or(&site));
        }
        self.counters.insertions += sites.len() as u64;
        Ok(())
    }

    fn push(&mut self, site: [f64; 2]) -> u32 {
        let number = self.sites.len() - 1;
        self.sites[number] = site;
        self.sites.push(NOWHERE);
        u32::try_from(number).expect("sites are numbered with 32 bits")
    }

    fn simplices(&self) -> &[Simplex<3>] {
        &self.triangles
    }

    fn last(&self) -> u32 {
        self.last
    }

    fn locate(&mut self, q: [f64; 2], hint: u32) -> u32 {
        let view = View::new(&self.sites, q, self.settings.filtered);
        walk(&view, &self.triangles, hint, &mut self.exact, &mut self.counters).triangle
    }

    /// In the order of digging: each triangle but the first shares an edge with one before it.
    fn conflicts(&mut self, q: [f64; 2], hint: u32, out: &mut Vec<u32>) {
        let view = View::new(&self.sites, q, self.settings.filtered);
        let found = walk(&view, &self.triangles, hint, &mut self.exact, &mut self.counters);
        out.push(found.triangle);
        dig(
            &view,
            &mut self.triangles,
            found,
            &mut self.pending,
            &mut self.exact,
            &mut self.counters,
            &mut Collect { out },
        );
    }

    fn finish(mut self) -> (Vec<Simplex<3>>, Vec<[f64; 2]>, Counters) {
        self.counters.stages = self.exact.stages;
        self.sites.pop();
        (self.triangles, self.sites, self.counters)
    }
}

impl Mesh {
    #[inline(always)]
    fn insert_one(&mut self, site: u32, next: u32) {
        // Every insertion adds one site, hence two triangles to the sphere. The star takes these slots and those of
        // the cavity as they become free: k edges of the rim are out when at least k − 2 triangles are in.
        let slot = self.triangles.len() as u32;
        self.triangles.extend([DEAD_SLOT; 2]);
        self.free.extend([slot + 1, slot]);
        let view = View::new(&self.sites, self.sites[site as usize], self.settings.filtered);
        let triangles = &mut self.triangles[..];
        let found = walk(&view, triangles, self.last, &mut self.exact, &mut self.counters);
        let mut star = Star::new(site, &mut self.free, &found, view.see(next));
        dig(
            &view,
            triangles,
            found,
            &mut self.pending,
            &mut self.exact,
            &mut self.counters,
            &mut star,
        );
        self.last = star.close(triangles);
    }
}
