//! The cells of a Delaunay triangulation, the ghosts outside its hull among them.
//!
//! *Idea.* Every facet has a cell on both sides, so whatever turns around an edge or a vertex never meets an end. Cells have the numbers
//! of their slots, which depend on how the triangulation was built: what is decided about cells must not depend on them.

use taut_delaunay::{Simplex, decode};

/// What a slot holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A tetrahedron.
    Finite,
    /// The room outside a facet of the hull.
    Ghost,
    /// Nothing.
    Empty,
}

/// All cells by slot.
pub(super) struct Cells {
    pub(super) all: Vec<Simplex<4>>,
    kinds: Vec<Kind>,
}

impl Cells {
    pub(super) fn of(slots: Vec<Simplex<4>>) -> Self {
        let kind = |cell: &Simplex<4>| match cell.is_live() {
            false => Kind::Empty,
            true if cell.is_ghost() => Kind::Ghost,
            true => Kind::Finite,
        };
        let kinds = slots.iter().map(kind).collect();
        Self { all: slots, kinds }
    }

    /// How many slots there are.
    pub(super) fn len(&self) -> usize {
        self.all.len()
    }

    pub(super) fn kind(&self, cell: u32) -> Kind {
        self.kinds[cell as usize]
    }

    pub(super) fn is_ghost(&self, cell: u32) -> bool {
        self.kind(cell) == Kind::Ghost
    }

    pub(super) fn sites(&self, cell: u32) -> [u32; 4] {
        self.all[cell as usize].vertices
    }

    /// The cell across a facet, and the place of the facet in it.
    pub(super) fn across(&self, cell: u32, facet: usize) -> (u32, usize) {
        decode(self.all[cell as usize].neighbors[facet])
    }

    /// The sites of the facet opposite the i-th of a cell, counter-clockwise as seen from beyond it.
    pub(super) fn facet(&self, cell: u32, i: usize) -> [u32; 3] {
        let sites = self.sites(cell);
        OUTWARD[i].map(|k| sites[k])
    }

    /// The same in ascending order: the name of a facet, whatever the cells are called. The vertex at infinity comes last.
    pub(super) fn name(&self, code: u32) -> [u32; 3] {
        let (cell, i) = decode(code);
        let mut sites = self.facet(cell, i);
        sites.sort_unstable();
        sites
    }

    /// The ghost that comes first by its sites; none if there are no cells.
    pub(super) fn first_ghost(&self) -> Option<u32> {
        let sorted = |&cell: &u32| {
            let mut sites = self.sites(cell);
            sites.sort_unstable();
            sites
        };
        (0..self.len() as u32).filter(|&cell| self.is_ghost(cell)).min_by_key(sorted)
    }
}

/// For a cell a, b, c, d with det(b − a, c − a, d − a) > 0, the corners of the facet opposite each, counter-clockwise from outside.
pub(super) const OUTWARD: [[usize; 3]; 4] = [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::spheres::{cross, dot, minus};

    #[test]
    fn facets_look_outward() {
        let p = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(dot(minus(p[1], p[0]), cross(minus(p[2], p[0]), minus(p[3], p[0]))) > 0.0);
        for (i, facet) in OUTWARD.into_iter().enumerate() {
            let [a, b, c] = facet.map(|k| p[k]);
            let normal = cross(minus(b, a), minus(c, a));
            assert!(dot(normal, minus(p[i], a)) < 0.0, "{i}");
        }
    }
}
