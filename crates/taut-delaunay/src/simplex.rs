//! The record of a simplex, shared by the kernels and the finished triangulation.

/// Stands for the vertex at infinity: a simplex that has it is a *ghost*, a facet of the hull seen from outside.
pub const GHOST: u32 = u32::MAX;

/// In place of vertex 0: this slot holds no simplex.
pub(crate) const DEAD_MARK: u32 = u32::MAX - 1;

/// A triangle (`V = 3`) or a tetrahedron (`V = 4`) with its neighbors.
///
/// Vertices are site numbers in positive order. A ghost has [`GHOST`] among its vertices and is oriented as if that
/// vertex lay far outside the hull, so that all simplices together close up to a sphere and every facet has two sides.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Simplex<const V: usize> {
    /// Site numbers; [`GHOST`] for the vertex at infinity.
    pub vertices: [u32; V],
    /// Across the facet opposite vertex i: `neighbor << 2 | facet`, where `facet` is the place of the same facet in
    /// the neighbor.
    pub neighbors: [u32; V],
}

impl<const V: usize> Simplex<V> {
    /// Returns true if the vertex at infinity is among the vertices.
    pub fn is_ghost(&self) -> bool {
        self.vertices.contains(&GHOST)
    }

    /// Returns true if this slot holds a simplex; if not, its other contents mean nothing.
    pub fn is_live(&self) -> bool {
        self.vertices[0] != DEAD_MARK
    }
}

/// The simplices of a triangulation by number.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Slots<const V: usize>(Vec<Simplex<V>>);

impl<const V: usize> Slots<V> {
    /// Numbers the simplices in this order.
    pub(crate) fn of(simplices: Vec<Simplex<V>>) -> Self {
        Self(simplices)
    }

    /// Returns how many slots there are.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns true if there is none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All slots in one array, which numbers them as before.
    pub(crate) fn into_array(self) -> Vec<Simplex<V>> {
        self.0
    }

    /// All slots in order.
    pub fn iter(&self) -> impl Iterator<Item = &Simplex<V>> {
        self.0.iter()
    }
}

impl<const V: usize> std::ops::Index<usize> for Slots<V> {
    type Output = Simplex<V>;

    #[inline(always)]
    fn index(&self, number: usize) -> &Simplex<V> {
        &self.0[number]
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
