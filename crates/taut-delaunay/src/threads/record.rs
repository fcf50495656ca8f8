//! A simplex of a mesh under construction, at which several threads may look while one changes it.
//!
//! *Idea.* A record is a [`Simplex`] whose numbers are relaxed atomic words: on one thread these are plain loads and stores,
//! and with several a walk may read a record while it is written, and see old numbers beside new ones, but nothing that was
//! never written. Who holds the vertices of a simplex (`held`) reads and changes it alone.
//! *Guarantee.* Records that were never written are zero, which is no simplex: its vertices are equal.

use std::sync::atomic::Ordering::Relaxed;

use crate::simplex::{DEAD_MARK, Simplex};
use crate::threads::atomics::AtomicU32;

/// A [`Simplex`] of atomic numbers.
#[repr(C)]
pub(crate) struct Record<const V: usize> {
    vertices: [AtomicU32; V],
    neighbors: [AtomicU32; V],
}

impl<const V: usize> Default for Record<V> {
    fn default() -> Self {
        let zeros = || std::array::from_fn(|_| AtomicU32::new(0));
        Self { vertices: zeros(), neighbors: zeros() }
    }
}

impl<const V: usize> Record<V> {
    /// Vertex `i`.
    #[inline(always)]
    pub(crate) fn vertex(&self, i: usize) -> u32 {
        self.vertices[i].load(Relaxed)
    }

    /// The code across the facet opposite vertex `i`.
    #[inline(always)]
    pub(crate) fn neighbor(&self, i: usize) -> u32 {
        self.neighbors[i].load(Relaxed)
    }

    /// All vertices.
    #[inline(always)]
    pub(crate) fn vertices(&self) -> [u32; V] {
        std::array::from_fn(|i| self.vertex(i))
    }

    /// All neighbors.
    #[inline(always)]
    pub(crate) fn neighbors(&self) -> [u32; V] {
        std::array::from_fn(|i| self.neighbor(i))
    }

    /// Writes the whole record.
    #[inline(always)]
    pub(crate) fn set(&self, simplex: Simplex<V>) {
        for i in 0..V {
            self.vertices[i].store(simplex.vertices[i], Relaxed);
        }
        for i in 0..V {
            self.neighbors[i].store(simplex.neighbors[i], Relaxed);
        }
    }

    /// Writes the whole record with wide stores. After eight narrow ones a vector load that follows soon has to wait for them, which
    /// took 4 % of the time of a torus with noise.
    ///
    /// # Safety
    /// No other thread reads or writes the record meanwhile, and there is no reference to the simplex in it.
    #[cfg(not(loom))]
    #[allow(unsafe_code)]
    #[inline(always)]
    pub(crate) unsafe fn set_alone(&self, simplex: Simplex<V>) {
        const {
            assert!(size_of::<Self>() == size_of::<Simplex<V>>());
            assert!(align_of::<Self>() == align_of::<Simplex<V>>());
        };
        // SAFETY: the same numbers at the same places, all of them atomic and so to be written while they are borrowed; the caller
        // promises that no thread does so at the same time.
        unsafe { std::ptr::from_ref(self).cast_mut().cast::<Simplex<V>>().write(simplex) }
    }

    /// Calls [`set`](Self::set), as loom knows atomic stores only.
    ///
    /// # Safety
    /// As outside of loom; this version does not need it.
    #[cfg(loom)]
    #[allow(unsafe_code)]
    pub(crate) unsafe fn set_alone(&self, simplex: Simplex<V>) {
        self.set(simplex);
    }

    /// Writes the code across the facet opposite vertex `i`.
    #[inline(always)]
    pub(crate) fn set_neighbor(&self, i: usize, code: u32) {
        self.neighbors[i].store(code, Relaxed);
    }

    /// Takes the simplex out of its slot.
    #[inline(always)]
    pub(crate) fn kill(&self) {
        self.vertices[0].store(DEAD_MARK, Relaxed);
    }

    /// The addresses of the vertices and of the neighbors, for vector instructions. A caller that reads there without
    /// atomic instructions must hold the simplex, or one across a facet.
    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    pub(crate) fn addresses(&self) -> [*const u32; 2] {
        [self.vertices.as_ptr().cast(), self.neighbors.as_ptr().cast()]
    }
}

#[cfg(all(test, not(loom)))]
mod tests {
    use super::*;

    /// Miri (`scripts/miri`) checks that a shared reference to a record allows this write.
    #[test]
    #[allow(unsafe_code)]
    fn a_record_is_written_at_once_as_it_is_number_by_number() {
        let records: [Record<4>; 3] = std::array::from_fn(|_| Record::default());
        let simplex = Simplex { vertices: [1, 2, 3, 4], neighbors: [50, 60, 70, 80] };
        // SAFETY: there is no other thread.
        unsafe { records[1].set_alone(simplex) };
        records[2].set(simplex);
        let read = |record: &Record<4>| (record.vertices(), record.neighbors());
        assert_eq!(read(&records[0]), ([0; 4], [0; 4]));
        assert_eq!(read(&records[1]), (simplex.vertices, simplex.neighbors));
        assert_eq!(read(&records[1]), read(&records[2]));
        records[1].set_neighbor(3, 81);
        records[1].kill();
        assert_eq!(read(&records[1]), ([DEAD_MARK, 2, 3, 4], [50, 60, 70, 81]));
    }
}
