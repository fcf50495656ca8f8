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

/// The simplices of a triangulation by number: one array, or one for each cell that had a part in it.
///
/// Cells hand their arrays over as they are; to copy them into one would cost about as much as all else that sharing
/// the work among threads costs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Slots<const V: usize> {
    parts: Vec<Vec<Simplex<V>>>,
    /// The number of the first simplex of each part.
    begins: Vec<usize>,
}

impl<const V: usize> Slots<V> {
    /// Numbers the simplices of all parts, one part after another.
    pub(crate) fn of(parts: Vec<Vec<Simplex<V>>>) -> Self {
        let begins = parts.iter().scan(0, |next, part| {
            let begin = *next;
            *next += part.len();
            Some(begin)
        });
        Self { begins: begins.collect(), parts }
    }

    /// Returns how many slots there are.
    pub fn len(&self) -> usize {
        self.parts.iter().map(Vec::len).sum()
    }

    /// Returns true if there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// All slots in one array, which numbers them as before.
    pub(crate) fn into_array(mut self) -> Vec<Simplex<V>> {
        match self.parts.len() {
            1 => self.parts.swap_remove(0),
            _ => self.parts.concat(),
        }
    }

    /// All slots in order.
    pub fn iter(&self) -> impl Iterator<Item = &Simplex<V>> {
        self.parts.iter().flatten()
    }

    /// The live simplices in one array, numbered again in the same order.
    pub(crate) fn compact(&self) -> Vec<Simplex<V>> {
        let numbers: Vec<u32> = self
            .iter()
            .scan(0, |next, simplex| {
                let number = *next;
                *next += u32::from(simplex.is_live());
                Some(number)
            })
            .collect();
        let renumber = |old: u32| {
            let (number, facet) = decode(old);
            code(numbers[number as usize], facet as u32)
        };
        let live = self.iter().filter(|simplex| simplex.is_live());
        live.map(|s| Simplex { vertices: s.vertices, neighbors: s.neighbors.map(renumber) })
            .collect()
    }

    /// The part and the place in it of a number.
    #[inline(always)]
    fn place(&self, number: usize) -> (usize, usize) {
        if self.parts.len() == 1 {
            return (0, number);
        }
        let part = self.begins.partition_point(|&begin| begin <= number) - 1;
        (part, number - self.begins[part])
    }
}

impl<const V: usize> std::ops::Index<usize> for Slots<V> {
    type Output = Simplex<V>;

    #[inline(always)]
    fn index(&self, number: usize) -> &Simplex<V> {
        let (part, place) = self.place(number);
        &self.parts[part][place]
    }
}

impl<const V: usize> std::ops::IndexMut<usize> for Slots<V> {
    fn index_mut(&mut self, number: usize) -> &mut Simplex<V> {
        let (part, place) = self.place(number);
        &mut self.parts[part][place]
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
