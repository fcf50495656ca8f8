//! Randomized distribution sort: runs of √n, boundaries from a sample, buckets of about √n.
//!
//! *Problem.* Sort with O((n/B)(1 + log_{M/B}(n/B))) misses without knowing M and B, by distributing instead of merging.
//! *Idea.* Sort runs of √n elements; draw boundaries; count; move each element to its bucket; sort the buckets. Moving
//! run by run would access all buckets for each run: the square of runs × buckets is quartered until one run meets one
//! bucket, so that a quarter whose runs and buckets fit is moved with few misses.
//! *Guarantee.* Q(n) ≤ 2√n Q(√n) + Q(√n log n) + O(1 + n/B) expected, which is optimal for M ≥ B²; a bucket that holds
//! more than three quarters by bad luck is merge sorted, so O(n log n) time is never exceeded by much.
//! *Trap.* A run has its elements for bucket j before those for bucket j + 1, so the left quarters come first: the order
//! of the four calls is not free. The number of runs is no power of two in general: the longer side is halved.
//! *Trap.* There are √n buckets and √n − 1 boundaries; printed are boundaries r₀ … r_√n and buckets B₀ … B_(1+√n). Equal
//! elements need parts of their own, see [`super::sample`].
//! *Trap.* A memory of few blocks has a block of each run and of each bucket it deals with, and what is beside them counts:
//! bounds of buckets and their cursors lie in one array; runs are counted in strips, as counting asks for bounds and no
//! buckets; and each pass begins where the one before ended.
//! *Reference.* The thesis, 5.6.1, algorithms 8 and 9, repaired; Frigo et al., ACM TALG 8(1), 2012 (deterministic).

use std::slice::from_ref;

use super::median::insertion_sort;
use super::mergesort::mergesort_instrumented;
use super::sample::{bounds, draw, oversampling};
use super::{Random, get, set};
use crate::{NoProbe, Probe};

/// Up to this many elements are sorted by insertion.
const INSERTION_SORT_MAX: usize = 64;
/// Counting has strips of this many times as many buckets as runs: a bucket's bound and cursor are two words, a run has a
/// block.
const STRIP_BUCKETS_FACTOR: usize = 8;

/// Sorts; the order of equal elements is not kept. `seed` chooses the samples, and changes nothing but the cost.
pub fn distribution_sort<T: Copy + Ord>(array: &mut [T], seed: u64) {
    distribution_sort_instrumented(array, seed, &mut NoProbe);
}

/// [`distribution_sort()`] whose recursion ends after `levels`, where the standard library sorts: the form that the thesis timed, with
/// one level in figure 49 and with two in figure 50. With 0 it is the library's sort.
pub fn distribution_sort_over_library<T: Copy + Ord>(array: &mut [T], seed: u64, levels: u32) {
    sort_alone(array, Depth::Levels(levels), &mut Random::new(seed), &mut NoProbe);
}

/// [`distribution_sort()`] under a probe.
pub fn distribution_sort_instrumented<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    seed: u64,
    probe: &mut P,
) {
    probe.place(array);
    sort_alone(array, Depth::Bottom, &mut Random::new(seed), probe);
}

/// How far the recursion goes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Depth {
    /// To arrays that insertion sorts.
    Bottom,
    /// So many levels more; below them the standard library sorts.
    Levels(u32),
}

impl Depth {
    /// One level further down.
    fn below(self) -> Self {
        match self {
            Depth::Bottom => Depth::Bottom,
            Depth::Levels(levels) => Depth::Levels(levels.saturating_sub(1)),
        }
    }
}

fn sort_alone<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    depth: Depth,
    random: &mut Random,
    probe: &mut P,
) {
    if depth == Depth::Levels(0) {
        array.sort_unstable();
        return;
    }
    let mut scratch = array.to_vec();
    probe.place(&scratch);
    sort(array, &mut scratch, true, depth, random, probe);
    probe.lift(&scratch);
}

/// Sorts what is in `array`, into `array` itself (`stay`) or into `other`; either way both are written to.
fn sort<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    other: &mut [T],
    stay: bool,
    depth: Depth,
    random: &mut Random,
    probe: &mut P,
) {
    let n = array.len();
    let is_end = depth == Depth::Levels(0);
    if is_end || n <= INSERTION_SORT_MAX {
        if is_end {
            array.sort_unstable();
        } else {
            insertion_sort(array, probe);
        }
        if !stay {
            copy(array, other, probe);
        }
        return;
    }
    let run = n.isqrt();
    let beta = oversampling(n);
    let mut sample = vec![array[0]; beta * (n / run)];
    probe.place(&sample);
    let mut drawn = sample.chunks_mut(beta);
    for (part, other) in array.chunks_mut(run).zip(other.chunks_mut(run)) {
        sort(part, other, true, depth.below(), random, probe);
        // A last run that is shorter is left out: it has less than 1/√n of the elements.
        if part.len() == run
            && let Some(drawn) = drawn.next()
        {
            draw(part, drawn, random, probe);
        }
    }
    sort_alone(&mut sample, depth.below(), random, probe);
    let mut buckets: Vec<Bucket<T>> = bounds(&sample, run, probe)
        .into_iter()
        .chain([array[0]]) // Of the last bucket, where nobody asks.
        .map(|bound| Bucket { bound, next: 0 })
        .collect();
    probe.lift(&sample);
    distribute(array, other, run, &mut buckets, probe);
    // The last ones were written last.
    for j in (0..buckets.len()).rev() {
        let start = if j > 0 { buckets[j - 1].next } else { 0 };
        let range = start..buckets[j].next;
        let (bucket, home) = (&mut other[range.clone()], &mut array[range]);
        let one_value = 0 < j && j + 1 < buckets.len() && buckets[j - 1].bound == buckets[j].bound;
        if one_value {
            if stay {
                copy(bucket, home, probe);
            }
        } else if bucket.len() > n - n / 4 {
            mergesort_instrumented(bucket, probe);
            if stay {
                copy(bucket, home, probe);
            }
        } else {
            sort(bucket, home, !stay, depth.below(), random, probe);
        }
    }
}

fn copy<T: Copy, P: Probe>(from: &[T], to: &mut [T], probe: &mut P) {
    for i in 0..from.len() {
        let x = get(from, i, probe);
        set(to, i, x, probe);
    }
}

/// Where a bucket ends among the values, and in memory.
struct Bucket<T> {
    /// Smaller elements belong to it or to buckets before. Equal ones too, if the bucket before has the same bound: then it
    /// is the bucket of that value. The last bucket takes all.
    bound: T,
    /// The number of elements that were counted, or where the next one goes.
    next: usize,
}

/// Moves the elements of the runs in `from` to their buckets in `to`, whose ends are `next` then.
fn distribute<T: Copy + Ord, P: Probe>(
    from: &[T],
    to: &mut [T],
    run: usize,
    buckets: &mut [Bucket<T>],
    probe: &mut P,
) {
    let (runs, width) = (from.len().div_ceil(run), buckets.len());
    let next = (0..runs).map(|i| i * run).collect();
    let mut work = Distribution { from, run, next, buckets };
    probe.place(&work.next);
    probe.place(work.buckets);
    // The last run was sorted last.
    work.quarter((0, runs), (0, width), true, &mut None, probe);
    let mut start = 0;
    for bucket in &mut *work.buckets {
        probe.read(from_ref(&bucket.next));
        (bucket.next, start) = (start, start + bucket.next);
        probe.write(from_ref(&bucket.next));
    }
    for i in 0..runs {
        set(&mut work.next, i, i * run, probe);
    }
    work.quarter((0, runs), (0, width), false, &mut Some(to), probe);
    probe.lift(work.buckets);
    probe.lift(&work.next);
}

struct Distribution<'a, T> {
    from: &'a [T],
    run: usize,
    /// The first element of each run that was not moved yet.
    next: Vec<usize>,
    buckets: &'a mut [Bucket<T>],
}

impl<T: Copy + Ord> Distribution<'_, T> {
    /// `Distribute(i, j, m)` of the paper for `di` runs and `dj` buckets; without `to` elements are counted only. Every
    /// second time it comes by the later runs go first (`back`), which are still in memory.
    fn quarter<P: Probe>(
        &mut self,
        (i, di): (usize, usize),
        (j, dj): (usize, usize),
        back: bool,
        to: &mut Option<&mut [T]>,
        probe: &mut P,
    ) {
        let strip = if to.is_some() { 1 } else { STRIP_BUCKETS_FACTOR };
        if di == 1 && dj == 1 {
            self.one(i, j, to, probe);
        } else if di == 1 || dj > 1 && dj >= strip * di {
            let half = dj / 2;
            self.quarter((i, di), (j, half), back, to, probe);
            self.quarter((i, di), (j + half, dj - half), !back, to, probe);
        } else {
            let half = di / 2;
            let (mut first, mut second) = ((i, half), (i + half, di - half));
            if back {
                (first, second) = (second, first);
            }
            self.quarter(first, (j, dj), back, to, probe);
            self.quarter(second, (j, dj), back, to, probe);
        }
    }

    /// `CopyElements(i, j)` or `CountElements(i, j)`: what is left of run i and belongs to bucket j.
    fn one<P: Probe>(&mut self, i: usize, j: usize, to: &mut Option<&mut [T]>, probe: &mut P) {
        let end = ((i + 1) * self.run).min(self.from.len());
        let mut next = get(&self.next, i, probe);
        let (before, bucket) = self.buckets.split_at_mut(j);
        let [bucket, behind @ ..] = bucket else { return };
        let is_last = behind.is_empty();
        if !is_last {
            probe.read(from_ref(&bucket.bound));
        }
        let start = next;
        let mut place = None;
        while next < end {
            let x = get(self.from, next, probe);
            if !is_last && x >= bucket.bound {
                let is_of_its_value = x == bucket.bound
                    && before.last().is_some_and(|before| {
                        probe.read(from_ref(&before.bound));
                        before.bound == x
                    });
                if !is_of_its_value {
                    break;
                }
            }
            next += 1;
            let place = place.get_or_insert_with(|| {
                probe.read(from_ref(&bucket.next));
                bucket.next
            });
            if let Some(to) = to {
                set(to, *place, x, probe);
            }
            *place += 1;
        }
        if let Some(place) = place {
            bucket.next = place;
            probe.write(from_ref(&bucket.next));
        }
        if next > start {
            set(&mut self.next, i, next, probe);
        }
    }
}
