//! Sequences that grow side by side in one array, in pieces of equal length.

use super::{get, set};
use crate::Probe;

/// The result of a [`Distributor`](super::Distributor): the elements of each bucket, in the order of the input.
#[derive(Clone, Debug)]
pub struct Buckets<T> {
    /// Pieces of `piece` elements.
    elements: Vec<T>,
    piece: usize,
    /// The piece that goes on where a piece ends.
    behind: Vec<u32>,
    ends: Vec<End>,
    /// Pieces in use.
    used: usize,
}

#[derive(Clone, Copy, Debug, Default)]
struct End {
    first: u32,
    last: u32,
    count: usize,
}

impl<T: Copy> Buckets<T> {
    /// Room for the elements of `input` in `buckets` buckets, which are all empty.
    pub(super) fn new(input: &[T], buckets: usize) -> Self {
        let piece = input.len().div_ceil(buckets).max(1);
        let pieces = input.len() / piece + buckets;
        let elements = input.first().map_or_else(Vec::new, |&x| vec![x; piece * pieces]);
        Self {
            elements,
            piece,
            behind: vec![0; pieces],
            ends: vec![End::default(); buckets],
            used: 0,
        }
    }

    pub(super) fn place<P: Probe>(&self, probe: &mut P) {
        probe.place(&self.elements);
        probe.place(&self.behind);
        probe.place(&self.ends);
    }

    /// Tells that nobody will read them any more.
    pub fn lift<P: Probe>(&self, probe: &mut P) {
        probe.lift(&self.ends);
        probe.lift(&self.behind);
        probe.lift(&self.elements);
    }

    pub(super) fn push<P: Probe>(&mut self, bucket: usize, x: T, probe: &mut P) {
        let mut end = get(&self.ends, bucket, probe);
        let offset = end.count % self.piece;
        if offset == 0 {
            let fresh = self.used as u32;
            self.used += 1;
            if end.count == 0 {
                end.first = fresh;
            } else {
                set(&mut self.behind, end.last as usize, fresh, probe);
            }
            end.last = fresh;
        }
        set(&mut self.elements, end.last as usize * self.piece + offset, x, probe);
        end.count += 1;
        set(&mut self.ends, bucket, end, probe);
    }

    pub(super) fn truncate(&mut self, buckets: usize) {
        self.ends.truncate(buckets);
    }

    /// Returns how many buckets there are.
    #[allow(clippy::len_without_is_empty, reason = "there is always one bucket at least")]
    pub fn len(&self) -> usize {
        self.ends.len()
    }

    /// Returns how many elements a bucket has.
    ///
    /// # Panics
    /// If there is no such bucket.
    pub fn count(&self, bucket: usize) -> usize {
        self.ends[bucket].count
    }

    /// The elements of a bucket.
    ///
    /// # Panics
    /// If there is no such bucket.
    pub fn bucket(&self, bucket: usize) -> Vec<T> {
        let mut elements = Vec::with_capacity(self.count(bucket));
        self.visit(bucket, |x, _| elements.push(x), &mut crate::NoProbe);
        elements
    }

    /// Calls `visit` for the elements of a bucket in order.
    pub(super) fn visit<P: Probe>(
        &self,
        bucket: usize,
        mut visit: impl FnMut(T, &mut P),
        probe: &mut P,
    ) {
        let end = get(&self.ends, bucket, probe);
        let mut piece = end.first;
        for i in 0..end.count {
            if i > 0 && i % self.piece == 0 {
                piece = get(&self.behind, piece as usize, probe);
            }
            let x = get(&self.elements, piece as usize * self.piece + i % self.piece, probe);
            visit(x, probe);
        }
    }
}
