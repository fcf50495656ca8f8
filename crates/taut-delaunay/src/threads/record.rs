//! A simplex of a mesh under construction, at which several threads may look while one changes it.
//!
//! *Idea.* A record is a [`Simplex`] whose numbers are relaxed atomic words: a walk may read a record while it is written, and see
//! old numbers beside new ones, but nothing that was never written. Who holds the vertices of a simplex (`held`) reads and changes
//! it alone.
//! *Guarantee.* Records that were never written are zero, which is no simplex: its vertices are equal.
//! *Trap.* The compiler takes a relaxed load for one that may change all memory, so it loads every pointer and length again after
//! each. One thread alone has plain numbers instead (`alone`), and the kernels are generic over the two.

use std::sync::atomic::Ordering::Relaxed;

use crate::simplex::{DEAD_MARK, Simplex};
use crate::threads::atomics::{AtomicU8, AtomicU32};

/// A simplex that is read and written through a shared reference.
pub(crate) trait Slot<const V: usize> {
    /// Vertex `i`.
    fn vertex(&self, i: usize) -> u32;

    /// The code across the facet opposite vertex `i`.
    fn neighbor(&self, i: usize) -> u32;

    /// All vertices.
    fn vertices(&self) -> [u32; V];

    /// All neighbors.
    fn neighbors(&self) -> [u32; V];

    /// Writes the whole record.
    fn set(&self, simplex: Simplex<V>);

    /// Writes the code across the facet opposite vertex `i`.
    fn set_neighbor(&self, i: usize, code: u32);

    /// Takes the simplex out of its slot.
    fn kill(&self);

    /// The addresses of the vertices and of the neighbors, for vector instructions: V numbers each, those that the other methods
    /// read. A caller that reads there without atomic instructions must hold the simplex, or one across a facet.
    #[cfg(target_arch = "x86_64")]
    fn addresses(&self) -> [*const u32; 2];
}

/// A byte beside a simplex that is read and written through a shared reference.
pub(crate) trait Mark {
    fn get(&self) -> u8;

    fn set(&self, value: u8);
}

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

impl<const V: usize> Slot<V> for Record<V> {
    #[inline(always)]
    fn vertex(&self, i: usize) -> u32 {
        self.vertices[i].load(Relaxed)
    }

    #[inline(always)]
    fn neighbor(&self, i: usize) -> u32 {
        self.neighbors[i].load(Relaxed)
    }

    #[inline(always)]
    fn vertices(&self) -> [u32; V] {
        std::array::from_fn(|i| self.vertex(i))
    }

    #[inline(always)]
    fn neighbors(&self) -> [u32; V] {
        std::array::from_fn(|i| self.neighbor(i))
    }

    #[inline(always)]
    fn set(&self, simplex: Simplex<V>) {
        for i in 0..V {
            self.vertices[i].store(simplex.vertices[i], Relaxed);
        }
        for i in 0..V {
            self.neighbors[i].store(simplex.neighbors[i], Relaxed);
        }
    }

    #[inline(always)]
    fn set_neighbor(&self, i: usize, code: u32) {
        self.neighbors[i].store(code, Relaxed);
    }

    #[inline(always)]
    fn kill(&self) {
        self.vertices[0].store(DEAD_MARK, Relaxed);
    }

    #[cfg(target_arch = "x86_64")]
    #[inline(always)]
    fn addresses(&self) -> [*const u32; 2] {
        [self.vertices.as_ptr().cast(), self.neighbors.as_ptr().cast()]
    }
}

impl Mark for AtomicU8 {
    #[inline(always)]
    fn get(&self) -> u8 {
        self.load(Relaxed)
    }

    #[inline(always)]
    fn set(&self, value: u8) {
        self.store(value, Relaxed);
    }
}
