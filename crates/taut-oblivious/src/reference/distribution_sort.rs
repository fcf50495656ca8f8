//! Randomized distribution sort: runs of √n, boundaries from a sample, buckets of about √n.
//!
//! *Problem.* Sort with O((n/B)(1 + log_{M/B}(n/B))) misses without knowing M and B, by distributing instead of merging.
//! *Idea.* Sort runs of √n elements; draw boundaries; count; move each element to its bucket; sort the buckets. Moving
//! run by run would touch all buckets for each run: the square of runs × buckets is quartered until one run meets one
//! bucket, so that a quarter whose runs and buckets fit is moved with few misses.
//! *Guarantee.* Q(n) ≤ 2√n Q(√n) + Q(√n log n) + O(1 + n/B) expected, which is optimal for M ≥ B²; a bucket that holds
//! more than three quarters by bad luck is merge sorted, so O(n log n) time is never exceeded by much.
//! *Trap.* A run has its elements for bucket j before those for bucket j + 1, so the left quarters come first: the order
//! of the four calls is not free. The number of runs is no power of two in general: the longer side is halved.
//! *Trap.* There are √n buckets and √n − 1 boundaries, not 1 + √n and √n as printed; and equal elements need parts of
//! their own, see [`super::sample`].
//! *Reference.* The thesis, 5.6.1, algorithms 8 and 9, repaired; Frigo et al., ACM TALG 8(1), 2012 (deterministic).

use super::median::insertion_sort;
use super::mergesort::mergesort_probed;
use super::sample::{Boundary, boundaries, draw, oversampling};
use super::{Random, get, set};
use crate::{NoProbe, Probe};

/// Up to this many elements are sorted by insertion.
const FEW: usize = 32;

/// Sorts; the order of equal elements is not kept. `seed` chooses the samples, and changes nothing but the cost.
pub fn distribution_sort<T: Copy + Ord>(array: &mut [T], seed: u64) {
    distribution_sort_probed(array, seed, &mut NoProbe);
}

/// [`distribution_sort()`] under a probe.
pub fn distribution_sort_probed<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    seed: u64,
    probe: &mut P,
) {
    probe.place(array);
    sort_alone(array, &mut Random::new(seed), probe);
}

fn sort_alone<T: Copy + Ord, P: Probe>(array: &mut [T], random: &mut Random, probe: &mut P) {
    let mut scratch = array.to_vec();
    probe.place(&scratch);
    sort(array, &mut scratch, true, random, probe);
    probe.lift(&scratch);
}

/// Sorts what is in `array`, into `array` itself (`stay`) or into `other`; either way both are written to.
fn sort<T: Copy + Ord, P: Probe>(
    array: &mut [T],
    other: &mut [T],
    stay: bool,
    random: &mut Random,
    probe: &mut P,
) {
    let n = array.len();
    if n <= FEW {
        insertion_sort(array, probe);
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
        sort(part, other, true, random, probe);
        // A last run that is shorter is left out: it has less than 1/√n of the elements.
        if part.len() == run
            && let Some(drawn) = drawn.next()
        {
            draw(part, drawn, random, probe);
        }
    }
    sort_alone(&mut sample, random, probe);
    let found = boundaries(&sample, run, probe);
    probe.lift(&sample);
    let ends = distribute(array, other, run, &found, probe);
    let mut start = 0;
    for (j, end) in ends.into_iter().enumerate() {
        let (bucket, home) = (&mut other[start..end], &mut array[start..end]);
        start = end;
        if j > 0 && j < found.len() && Boundary::one_value(found[j - 1], found[j]) {
            if stay {
                copy(bucket, home, probe);
            }
        } else if bucket.len() > n - n / 4 {
            mergesort_probed(bucket, probe);
            if stay {
                copy(bucket, home, probe);
            }
        } else {
            sort(bucket, home, !stay, random, probe);
        }
    }
}

fn copy<T: Copy, P: Probe>(from: &[T], to: &mut [T], probe: &mut P) {
    for i in 0..from.len() {
        let x = get(from, i, probe);
        set(to, i, x, probe);
    }
}

/// Moves the elements of the runs in `from` to their buckets in `to`; returns where each bucket ends.
fn distribute<T: Copy + Ord, P: Probe>(
    from: &[T],
    to: &mut [T],
    run: usize,
    found: &[Boundary<T>],
    probe: &mut P,
) -> Vec<usize> {
    let (runs, buckets) = (from.len().div_ceil(run), found.len() + 1);
    let next = (0..runs).map(|i| i * run).collect();
    let mut work = Distribution { from, run, boundaries: found, next, fill: vec![0; buckets] };
    probe.place(work.boundaries);
    probe.place(&work.next);
    probe.place(&work.fill);
    work.quarter((0, runs), (0, buckets), false, &mut None, probe);
    let mut start = 0;
    for j in 0..buckets {
        let count = get(&work.fill, j, probe);
        set(&mut work.fill, j, start, probe);
        start += count;
    }
    for i in 0..runs {
        set(&mut work.next, i, i * run, probe);
    }
    work.quarter((0, runs), (0, buckets), false, &mut Some(to), probe);
    probe.lift(&work.fill);
    probe.lift(&work.next);
    probe.lift(work.boundaries);
    work.fill
}

struct Distribution<'a, T> {
    from: &'a [T],
    run: usize,
    boundaries: &'a [Boundary<T>],
    /// The first element of each run that was not moved yet.
    next: Vec<usize>,
    /// Elements counted, or where the next one goes, of each bucket.
    fill: Vec<usize>,
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
        if di == 1 && dj == 1 {
            self.one(i, j, to, probe);
        } else if dj >= di {
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
        let boundary =
            if j < self.boundaries.len() { get(self.boundaries, j, probe) } else { Boundary::All };
        let start = next;
        let mut fill = None;
        while next < end {
            let x = get(self.from, next, probe);
            if !boundary.is_after(x) {
                break;
            }
            next += 1;
            let place = fill.get_or_insert_with(|| get(&self.fill, j, probe));
            if let Some(to) = to {
                set(to, *place, x, probe);
            }
            *place += 1;
        }
        if let Some(fill) = fill {
            set(&mut self.fill, j, fill, probe);
        }
        if next > start {
            set(&mut self.next, i, next, probe);
        }
    }
}
