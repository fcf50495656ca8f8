//! What searches keep: the nearest row, the k nearest, all within a distance, the farthest.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::measure::Measure;
use super::nodes::{BLOCK_SIZE, NO_ROW};
use super::traverse::{Collector, lanes_where};

/// The nearest row so far.
#[derive(Clone, Copy)]
pub(super) struct Nearest<K> {
    pub(super) key: K,
    pub(super) row: u32,
}

impl<K: Copy + PartialOrd> Collector<K> for Nearest<K> {
    #[inline(always)]
    fn may_admit(&self, bound: K) -> bool {
        bound <= self.key
    }

    #[inline(always)]
    fn admits(&self, bound: K, lowest_row: u32) -> bool {
        bound < self.key || bound == self.key && lowest_row < self.row
    }

    #[inline(always)]
    fn offer(&mut self, keys: &[K; BLOCK_SIZE], rows: &[u32; BLOCK_SIZE]) {
        // Of most blocks after the first no row is nearer.
        if lanes_where(keys, |key| key <= self.key) == 0 {
            return;
        }
        let mut least = *keys;
        for half in [BLOCK_SIZE / 2, BLOCK_SIZE / 4, BLOCK_SIZE / 8, BLOCK_SIZE / 16] {
            for i in 0..half {
                least[i] = if least[i + half] < least[i] { least[i + half] } else { least[i] };
            }
        }
        let least = least[0];
        // The first lane has the lowest row.
        let lane = lanes_where(keys, |key| key == least).trailing_zeros() as usize;
        let row = rows[lane % BLOCK_SIZE];
        if self.admits(least, row) {
            *self = Nearest { key: least, row };
        }
    }
}

/// The farthest row so far, and the largest bound that `factor` left out.
#[derive(Clone, Copy)]
pub(super) struct Farthest<K> {
    pub(super) key: K,
    pub(super) row: u32,
    /// Rows have to be farther than this times the farthest so far: 1 or more.
    pub(super) factor: f64,
    pub(super) distance: fn(K) -> f64,
}

impl<K: Copy + PartialOrd> Collector<K> for Farthest<K> {
    #[inline(always)]
    fn may_admit(&self, bound: K) -> bool {
        bound >= self.key
    }

    #[inline(always)]
    fn admits(&self, bound: K, lowest_row: u32) -> bool {
        let is_farther = bound > self.key || bound == self.key && lowest_row < self.row;
        let is_exact = self.factor == 1.0 || self.row == NO_ROW;
        is_farther && (is_exact || (self.distance)(bound) > self.factor * (self.distance)(self.key))
    }

    #[inline(always)]
    fn offer(&mut self, keys: &[K; BLOCK_SIZE], rows: &[u32; BLOCK_SIZE]) {
        for (&key, &row) in keys.iter().zip(rows) {
            if key > self.key || key == self.key && row < self.row {
                (self.key, self.row) = (key, row);
            }
        }
    }
}

/// A row with its key, ordered by both.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Candidate<K> {
    pub(super) key: K,
    pub(super) row: u32,
}

impl<K: PartialOrd> Eq for Candidate<K> {}

impl<K: PartialOrd> Ord for Candidate<K> {
    fn cmp(&self, other: &Self) -> Ordering {
        // Keys are numbers, never NaN.
        let by_key = self.key.partial_cmp(&other.key).unwrap_or(Ordering::Equal);
        by_key.then(self.row.cmp(&other.row))
    }
}

impl<K: PartialOrd> PartialOrd for Candidate<K> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// The k nearest rows so far, the farthest on top.
pub(super) struct NearestHeap<K> {
    pub(super) heap: BinaryHeap<Candidate<K>>,
    pub(super) k: usize,
}

impl<K: Copy + PartialOrd> Collector<K> for NearestHeap<K> {
    #[inline(always)]
    fn may_admit(&self, bound: K) -> bool {
        self.heap.len() < self.k || self.heap.peek().is_some_and(|top| bound <= top.key)
    }

    #[inline(always)]
    fn admits(&self, bound: K, lowest_row: u32) -> bool {
        let nearest = Candidate { key: bound, row: lowest_row };
        self.heap.len() < self.k || self.heap.peek().is_some_and(|top| nearest < *top)
    }

    #[inline(always)]
    fn offer(&mut self, keys: &[K; BLOCK_SIZE], rows: &[u32; BLOCK_SIZE]) {
        let mut left = lanes_where(keys, |key| self.may_admit(key));
        while left != 0 {
            let lane = left.trailing_zeros() as usize % BLOCK_SIZE;
            left &= left - 1;
            let (key, row) = (keys[lane], rows[lane]);
            if row != NO_ROW && self.admits(key, row) {
                if self.heap.len() == self.k {
                    self.heap.pop();
                }
                self.heap.push(Candidate { key, row });
            }
        }
    }
}

/// All rows within a distance.
pub(super) struct Within<M: Measure> {
    pub(super) limit: f64,
    pub(super) found: Vec<Candidate<M::Key>>,
}

impl<M: Measure> Collector<M::Key> for Within<M> {
    #[inline(always)]
    fn may_admit(&self, bound: M::Key) -> bool {
        M::is_within(bound, self.limit)
    }

    #[inline(always)]
    fn admits(&self, bound: M::Key, _: u32) -> bool {
        M::is_within(bound, self.limit)
    }

    #[inline(always)]
    fn offer(&mut self, keys: &[M::Key; BLOCK_SIZE], rows: &[u32; BLOCK_SIZE]) {
        let mut left = lanes_where(keys, |key| M::is_within(key, self.limit));
        while left != 0 {
            let lane = left.trailing_zeros() as usize % BLOCK_SIZE;
            left &= left - 1;
            if rows[lane] != NO_ROW {
                self.found.push(Candidate { key: keys[lane], row: rows[lane] });
            }
        }
    }
}
