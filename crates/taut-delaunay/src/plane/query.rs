//! Questions to a finished triangulation: where a point is, and what it would be in conflict with.

use taut_predicates::{Exact, Separate};

use super::dig::{Edge, Sink, dig};
use super::seen::{Seen, View};
use super::walk::walk;
use crate::kernel::Counters;
use crate::simplex::Simplex;

/// A triangulation that is asked and not changed, with the memory that answers need.
pub(crate) struct Query<'a> {
    sites: &'a [[f64; 2]],
    triangles: &'a [Simplex<3>],
    filtered: bool,
    pending: Vec<Edge>,
    exact: Exact,
    counters: Counters,
}

/// What the insertion of a point would replace.
#[derive(Debug, Default)]
pub(crate) struct Cavity {
    /// The triangles in conflict, ghosts too; each but the first shares an edge with one before it.
    pub(crate) triangles: Vec<u32>,
    /// The vertices of the rim, counter-clockwise; the ghost vertex is among them if the point is outside the hull or
    /// on it.
    pub(crate) rim: Vec<u32>,
}

impl<'a> Query<'a> {
    /// Asks a closed mesh without dead slots. `filtered` and `integral` mean what they mean in `Settings`, and hold for
    /// the points asked about, too.
    pub(crate) fn new(
        sites: &'a [[f64; 2]],
        triangles: &'a [Simplex<3>],
        filtered: bool,
        integral: bool,
    ) -> Query<'a> {
        Query {
            sites,
            triangles,
            filtered,
            pending: Vec::new(),
            exact: Exact::new(integral),
            counters: Counters::default(),
        }
    }

    /// A triangle that holds q, on its border perhaps, or a ghost whose hull edge has q strictly outside. The walk
    /// begins at `hint`; q may be a site.
    pub(crate) fn locate(&mut self, q: [f64; 2], hint: u32) -> u32 {
        let view = View::new(self.sites, q, self.filtered);
        walk::<Separate>(&view, self.triangles, hint, &mut self.exact, &mut self.counters).triangle
    }

    /// What q is in conflict with, put into `cavity` in place of what is there. The walk begins at `hint`; q is no site.
    pub(crate) fn cavity(&mut self, q: [f64; 2], hint: u32, cavity: &mut Cavity) {
        let view = View::new(self.sites, q, self.filtered);
        let found =
            walk::<Separate>(&view, self.triangles, hint, &mut self.exact, &mut self.counters);
        cavity.triangles.clear();
        cavity.rim.clear();
        let mut sink =
            List { all: self.triangles, triangles: &mut cavity.triangles, rim: &mut cavity.rim };
        sink.enter(found.triangle);
        dig::<Separate, _>(
            &view,
            found,
            &mut self.pending,
            &mut self.exact,
            &mut self.counters,
            &mut sink,
        );
    }
}

/// Lists the cavity and leaves the mesh as it is.
pub(super) struct List<'a> {
    pub(super) all: &'a [Simplex<3>],
    pub(super) triangles: &'a mut Vec<u32>,
    pub(super) rim: &'a mut Vec<u32>,
}

impl Sink for List<'_> {
    fn triangles(&self) -> &[Simplex<3>] {
        self.all
    }

    fn enter(&mut self, triangle: u32) {
        self.triangles.push(triangle);
    }

    fn rim(&mut self, _: u32, [_, to]: [u32; 2], _: Seen) {
        self.rim.push(to);
    }
}
