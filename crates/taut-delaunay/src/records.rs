//! The simplices of a mesh under construction, at which several threads may look while others change them.
//!
//! *Idea.* A record is a [`Simplex`] whose numbers are relaxed atomic words: on one thread these are plain loads and stores,
//! and with several a walk may read a record while it is written, and see old numbers beside new ones, but nothing that was
//! never written. Who holds the vertices of a simplex (`held`) reads and changes it alone.
//! *Guarantee.* Records that were never written are zero, which is no simplex: its vertices are equal.
#![allow(unsafe_code)]

use std::sync::atomic::Ordering::Relaxed;
use std::sync::atomic::{AtomicU8, AtomicU32};

use crate::simplex::{DEAD_MARK, Simplex};

/// A [`Simplex`] of atomic numbers.
#[repr(C)]
pub(crate) struct Record<const V: usize> {
    vertices: [AtomicU32; V],
    neighbors: [AtomicU32; V],
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

    /// The addresses of the vertices and of the neighbors, for vector instructions. To read there, all but atomically, hold
    /// the simplex.
    #[inline(always)]
    pub(crate) fn addresses(&self) -> [*const u32; 2] {
        [self.vertices.as_ptr().cast(), self.neighbors.as_ptr().cast()]
    }
}

/// Zeros, in pages that nobody has touched yet.
pub(crate) fn zeros(count: usize) -> Vec<AtomicU8> {
    // SAFETY: zeros are valid atomic numbers.
    unsafe { Box::<[AtomicU8]>::new_zeroed_slice(count).assume_init() }.into_vec()
}

/// The slots of a mesh: those in use, and zeros behind them.
pub(crate) struct Records<const V: usize> {
    all: Vec<Record<V>>,
    used: usize,
}

impl<const V: usize> Records<V> {
    /// Room for `capacity` slots, none of them in use. Pages that are never touched cost nothing.
    pub(crate) fn new(capacity: usize) -> Self {
        // SAFETY: zeros are valid atomic numbers.
        let all = unsafe { Box::<[Record<V>]>::new_zeroed_slice(capacity).assume_init() };
        Self { all: all.into_vec(), used: 0 }
    }

    /// Returns how many slots are in use, dead ones included.
    #[inline(always)]
    pub(crate) fn len(&self) -> usize {
        self.used
    }

    /// All slots, in use or not.
    #[inline(always)]
    pub(crate) fn all(&self) -> &[Record<V>] {
        &self.all
    }

    /// Takes the first `len` slots into use.
    pub(crate) fn set_len(&mut self, len: usize) {
        debug_assert!(len <= self.all.len(), "there is room");
        self.used = len;
    }

    /// Makes room for `capacity` slots.
    pub(crate) fn grow(&mut self, capacity: usize) {
        self.all.reserve_exact(capacity.saturating_sub(self.all.len()));
        self.all.resize_with(capacity, || Record {
            vertices: std::array::from_fn(|_| AtomicU32::new(0)),
            neighbors: std::array::from_fn(|_| AtomicU32::new(0)),
        });
    }

    /// The slots in use.
    pub(crate) fn as_slice(&self) -> &[Simplex<V>] {
        const { assert!(size_of::<Record<V>>() == size_of::<Simplex<V>>()) };
        // SAFETY: the same numbers at the same places, and nobody writes while they are borrowed: this module's callers write
        // in methods of a mesh that borrow it for themselves.
        unsafe { std::slice::from_raw_parts(self.all.as_ptr().cast(), self.used) }
    }

    /// The slots in use, in the same memory.
    pub(crate) fn into_simplices(mut self) -> Vec<Simplex<V>> {
        self.all.truncate(self.used);
        let simplex = |record: Record<V>| Simplex {
            vertices: record.vertices.map(AtomicU32::into_inner),
            neighbors: record.neighbors.map(AtomicU32::into_inner),
        };
        self.all.into_iter().map(simplex).collect()
    }
}
