//! Columnsort: a sort that accesses the same places in the same order whatever the data.
//!
//! *Problem.* Sort with a pattern of access that tells nothing of the data and can be planned ahead.
//! *Idea.* Write the elements as s columns of r. Sort the columns; take them up column by column and lay them down row by
//! row; sort; the way back; sort; and sort once more across the borders of columns, from the middle of each to the middle
//! of the next. Columns are sorted in the same way, few elements by a network.
//! *Guarantee.* Sorted if s divides r and r ≥ 2(s − 1)². The trace depends on n alone. Q(n) = 4s·Q(n/s) + O(1 + n/B):
//! not optimal.
//! *Trap.* The shift by half a column needs no elements of −∞ and +∞: the first and the last half are sorted already.
//! *Trap.* The thesis counts eight sorts, as there are eight steps, four of which move only; and it takes s = n^(1/4),
//! where (n/2)^(1/3) is allowed and means fewer levels.
//! *Reference.* Leighton, *Tight bounds on the complexity of parallel sorting*, IEEE Trans. Computers C-34(4), 1985;
//! Knuth, *The Art of Computer Programming* 3, 5.2.2, algorithm M (the network, by Batcher).

use super::transpose::transpose_within;
use super::{get, set};
use crate::{NoProbe, Probe};

/// Up to this many elements are sorted by the network.
const NETWORK_SORT_MAX: usize = 32;

/// Sorts; the order of equal elements is not kept.
pub fn columnsort<T: Copy + Ord>(array: &mut [T]) {
    columnsort_instrumented(array, &mut NoProbe);
}

/// [`columnsort()`] under a probe, to which all arrays of that length look alike.
pub fn columnsort_instrumented<T: Copy + Ord, P: Probe>(array: &mut [T], probe: &mut P) {
    probe.place(array);
    sort(array, probe);
}

fn sort<T: Copy + Ord, P: Probe>(array: &mut [T], probe: &mut P) {
    let n = array.len();
    if n <= NETWORK_SORT_MAX {
        network(array, probe);
        return;
    }
    let (r, s) = shape(n);
    // What fills up the last column is as large as the largest, and goes to the end.
    let mut largest = get(array, 0, probe);
    for i in 1..n {
        largest = largest.max(get(array, i, probe));
    }
    let mut columns = vec![largest; r * s];
    let mut moved = vec![largest; r * s];
    probe.place(&columns);
    probe.place(&moved);
    for i in 0..r * s {
        let x = if i < n { get(array, i, probe) } else { largest };
        set(&mut columns, i, x, probe);
    }
    sort_each(&mut columns, r, probe);
    // In memory columns lie one behind the other: laying them down row by row transposes r rows of s.
    transpose_within(&columns, &mut moved, r, s, probe);
    sort_each(&mut moved, r, probe);
    transpose_within(&moved, &mut columns, s, r, probe);
    sort_each(&mut columns, r, probe);
    sort_each(&mut columns[r / 2..r * s - r / 2], r, probe);
    for i in 0..n {
        let x = get(&columns, i, probe);
        set(array, i, x, probe);
    }
    probe.lift(&moved);
    probe.lift(&columns);
}

/// r and s for n elements: the most columns that r ≥ 2(s − 1)² allows; r is even and a multiple of s.
fn shape(n: usize) -> (usize, usize) {
    let rows =
        |s: usize| n.div_ceil(s).next_multiple_of(if s.is_multiple_of(2) { s } else { 2 * s });
    let mut s = 2;
    while rows(s + 1) >= 2 * s * s {
        s += 1;
    }
    (rows(s), s)
}

fn sort_each<T: Copy + Ord, P: Probe>(columns: &mut [T], r: usize, probe: &mut P) {
    for column in columns.chunks_exact_mut(r) {
        sort(column, probe);
    }
}

/// Merge exchange: a sorting network for any number of elements.
fn network<T: Copy + Ord, P: Probe>(array: &mut [T], probe: &mut P) {
    let n = array.len();
    if n < 2 {
        return;
    }
    let top = 1 << (n - 1).ilog2();
    let mut p = top;
    while p > 0 {
        let (mut q, mut r, mut d) = (top, 0, p);
        loop {
            for i in 0..n - d {
                if i & p == r {
                    let (x, y) = (get(array, i, probe), get(array, i + d, probe));
                    set(array, i, x.min(y), probe);
                    set(array, i + d, x.max(y), probe);
                }
            }
            if q == p {
                break;
            }
            (d, q, r) = (q - p, q / 2, p);
        }
        p /= 2;
    }
}
