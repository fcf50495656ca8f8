//! The record of a simplex, shared by the kernels and the finished triangulation.

/// Stands for the vertex at infinity: a simplex that has it is a *ghost*, a facet of the hull seen from outside.
pub const GHOST: u32 = u32::MAX;

/// In place of vertex 0: this slot holds no simplex.
pub(crate) const DEAD: u32 = u32::MAX - 1;

/// A triangle (`V = 3`) or a tetrahedron (`V = 4`) with its neighbours.
///
/// Vertices are site numbers in positive order. A ghost has [`GHOST`] among its vertices and is oriented as if that
/// vertex lay far outside the hull, so that all simplices together close up to a sphere and every facet has two sides.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Simplex<const V: usize> {
    /// Site numbers; [`GHOST`] for the vertex at infinity.
    pub vertices: [u32; V],
    /// Across the facet opposite vertex i: `neighbour << 2 | facet`, where `facet` is the place of the same facet in
    /// the neighbour.
    pub neighbors: [u32; V],
}

impl<const V: usize> Simplex<V> {
    /// Whether the vertex at infinity is among the vertices.
    pub fn is_ghost(&self) -> bool {
        self.vertices.contains(&GHOST)
    }

    /// Whether this slot holds a simplex.
    pub(crate) fn is_live(&self) -> bool {
        self.vertices[0] != DEAD
    }
}

/// The code of facet `facet` of simplex `simplex`.
#[inline(always)]
pub(crate) fn code(simplex: u32, facet: u32) -> u32 {
    simplex << 2 | facet
}

/// The simplex and the facet that a code names.
#[inline(always)]
pub fn decode(code: u32) -> (u32, usize) {
    (code >> 2, (code & 3) as usize)
}
