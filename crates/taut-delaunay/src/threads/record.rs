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
