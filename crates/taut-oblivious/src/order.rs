//! Points in the order of a curve through them.
//!
//! Idea: cells of a grid over the bounding box, their places on the curve, a sort of words that hold the place and the
//! number of the point; where many points share a cell, the same again inside their own box, until few are left, which
//! are sorted by coordinates.
//! Guarantee: the order is a function of the set of points: shuffling the input changes nothing but who of several equal
//! points comes first, which is the one with the smallest number. Equal points are side by side.
//! Trap: a single grid is not enough. Of a million points with a heavy tail (Kuzmin), nearly all share one cell of
//! 2¹⁶ × 2¹⁶, and walks through a triangulation built in that order take hundreds of steps instead of three.
//! Trap: quantizing must be monotone and must separate the ends of a box, down to subnormal and up to the largest
//! extent, or the descent does not end.

use std::cmp::Ordering;
use std::ops::Range;

use taut_points::parallel::{IntoParallel, ParallelSlice};
use taut_points::two_to;

use crate::hilbert::{self, bits_max};
use crate::morton;
use crate::sort::sort;

/// Up to this many points in one cell are sorted by comparing their coordinates.
const COMPARISON_SORT_MAX: usize = 6;
/// Points that one task of a pass handles.
const TASK: usize = 1 << 14;
/// 2⁶⁰⁰, from its bits: what a library makes of a power may differ between machines, and orders with it.
const LIFT_FACTOR: f64 = two_to(600);

/// Maps points of a box to cells of the grid that a curve numbers; the same scale on all axes.
struct Grid<const D: usize> {
    low: [f64; D],
    /// ½ where the extent overflows, else 1.
    shrink: f64,
    /// 2⁶⁰⁰ where the reciprocal of the extent would overflow, else 1.
    lift: f64,
    /// Cells per unit.
    scale: f64,
}

impl<const D: usize> Grid<D> {
    /// The grid over a box; none if the box is a point.
    fn over(low: [f64; D], high: [f64; D]) -> Option<Self> {
        // Cells of a grid without end are all one, however often they are divided.
        if !low.iter().chain(&high).all(|x| x.is_finite()) {
            return None;
        }
        let widest =
            |shrink: f64| (0..D).fold(0.0, |w: f64, i| w.max(high[i] * shrink - low[i] * shrink));
        let shrink = if widest(1.0).is_finite() { 1.0 } else { 0.5 };
        let extent = widest(shrink);
        if extent == 0.0 {
            return None;
        }
        let lift = if extent < 1e-290 { LIFT_FACTOR } else { 1.0 };
        let scale = f64::from(1u32 << bits_max(D)) / (extent * lift);
        Some(Self { low: low.map(|x| x * shrink), shrink, lift, scale })
    }

    #[inline(always)]
    fn cell(&self, point: [f64; D]) -> [u32; D] {
        let last = const { (1u32 << bits_max(D)) - 1 };
        let mut cell = [0; D];
        for i in 0..D {
            let place = (point[i] * self.shrink - self.low[i]) * self.lift * self.scale;
            cell[i] = (place as u32).min(last);
        }
        cell
    }
}

/// Lexicographic order of points.
fn compare<const D: usize>(a: [f64; D], b: [f64; D]) -> Ordering {
    a.partial_cmp(&b).unwrap_or(Ordering::Equal)
}

/// The smallest box of points.
fn bounds<const D: usize>(points: impl Iterator<Item = [f64; D]>) -> ([f64; D], [f64; D]) {
    points.fold(([f64::INFINITY; D], [f64::NEG_INFINITY; D]), |(mut low, mut high), p| {
        for i in 0..D {
            low[i] = if p[i] < low[i] { p[i] } else { low[i] };
            high[i] = if p[i] > high[i] { p[i] } else { high[i] };
        }
        (low, high)
    })
}

/// The numbers of `len` points of the plane or of space in the order of a Hilbert curve through them.
///
/// `at(i)` is point i. The order depends on the set of points alone; equal points (−0 equals 0) are side by side, the
/// smallest number first. Runs on the current rayon pool; any number of threads gives the same order. O(n log n), and one
/// more pass over the points of a cluster for each factor 2¹⁰ (space) or 2¹⁶ (plane) by which it is smaller than the
/// whole; 12 bytes a point while it runs.
///
/// # Panics
/// If there are more than 2³² − 1 points. Coordinates that are not finite give some order.
pub fn hilbert_order<const D: usize>(
    len: usize,
    at: impl Fn(usize) -> [f64; D] + Sync,
) -> Vec<u32> {
    order(len, at, hilbert::key)
}

/// The numbers of `len` points of the plane or of space in Z-order, that of the interleaved bits of their coordinates.
///
/// With all that holds for [`hilbert_order`] except its short steps; keys are cheaper, and a cell of the grid at any
/// level is one run of the order within the box of the points.
///
/// # Panics
/// If there are more than 2³² − 1 points. Coordinates that are not finite give some order.
pub fn morton_order<const D: usize>(len: usize, at: impl Fn(usize) -> [f64; D] + Sync) -> Vec<u32> {
    order(len, at, morton::key)
}

/// What an ordering asks of points and of the curve: whole ranges at a time, so that all kinds of points share the machine code of the
/// parallel passes. (As a generic function these were 1.3 MB of the Python module.)
trait Keyed<const D: usize>: Sync {
    /// The smallest box of the points of a range.
    fn bounds(&self, range: Range<usize>) -> ([f64; D], [f64; D]);

    /// Writes keys and numbers of points from `first` on.
    fn write(&self, grid: &Grid<D>, first: usize, records: &mut [u64]);

    /// Puts records that share a key in order, given records sorted by key.
    fn settle(&self, records: &mut [u64]);
}

/// Points by number, and the key of a cell.
struct Of<At, Key> {
    at: At,
    key: Key,
}

impl<const D: usize, At, Key> Keyed<D> for Of<At, Key>
where
    At: Fn(usize) -> [f64; D] + Sync,
    Key: Fn([u32; D]) -> u32 + Sync,
{
    fn bounds(&self, range: Range<usize>) -> ([f64; D], [f64; D]) {
        bounds(range.map(&self.at))
    }

    fn write(&self, grid: &Grid<D>, first: usize, records: &mut [u64]) {
        for (i, record) in (first..).zip(records) {
            *record = u64::from((self.key)(grid.cell((self.at)(i)))) << 32 | i as u64;
        }
    }

    fn settle(&self, records: &mut [u64]) {
        settle(records, &self.at, &self.key);
    }
}

/// The order of points along the curve of `key`.
fn order<const D: usize>(
    len: usize,
    at: impl Fn(usize) -> [f64; D] + Sync,
    key: impl Fn([u32; D]) -> u32 + Sync,
) -> Vec<u32> {
    order_keyed(len, &Of { at, key })
}

/// The order of points along a curve.
fn order_keyed<const D: usize>(len: usize, keyed: &dyn Keyed<D>) -> Vec<u32> {
    assert!(u32::try_from(len).is_ok(), "{len} points are more than 32 bits can number");
    let tasks =
        || (0..len.div_ceil(TASK)).into_par_iter().map(|t| t * TASK..len.min((t + 1) * TASK));
    let (low, high) = tasks().map(|range| keyed.bounds(range)).reduce(
        || bounds(std::iter::empty()),
        |a, b| bounds([a.0, a.1, b.0, b.1].into_iter().filter(|p| p[0].is_finite())),
    );
    let Some(grid) = Grid::over(low, high) else { return (0..len as u32).collect() };
    let mut records = vec![0u64; len];
    records
        .par_chunks_mut(TASK)
        .enumerate()
        .for_each(|(task, chunk)| keyed.write(&grid, task * TASK, chunk));
    sort(&mut records);
    segments(&mut records).into_par_iter().for_each(|records| keyed.settle(records));
    numbers(records)
}

/// The numbers of points in records.
fn numbers(records: Vec<u64>) -> Vec<u32> {
    let mut numbers = vec![0; records.len()];
    let parts = numbers.par_chunks_mut(TASK).zip(records.par_chunks(TASK));
    parts.for_each(|(numbers, records)| {
        for (number, record) in numbers.iter_mut().zip(records) {
            *number = *record as u32;
        }
    });
    numbers
}

/// Sorts records of equal points by their numbers.
fn sort_by_number(records: &mut [u64]) {
    records.sort_unstable_by_key(|&r| r as u32);
}

/// Cuts sorted records into segments of about [`TASK`] records, never between equal keys.
fn segments(mut records: &mut [u64]) -> Vec<&mut [u64]> {
    let mut cut = Vec::new();
    while !records.is_empty() {
        let mut end = TASK.min(records.len());
        while end < records.len() && records[end] >> 32 == records[end - 1] >> 32 {
            end += 1;
        }
        let head;
        (head, records) = records.split_at_mut(end);
        cut.push(head);
    }
    cut
}

/// Sorts a few records.
fn insertion_sort(records: &mut [u64], compare: impl Fn(u64, u64) -> Ordering) {
    for sorted in 1..records.len() {
        let record = records[sorted];
        let mut place = sorted;
        while place > 0 && compare(record, records[place - 1]).is_lt() {
            records[place] = records[place - 1];
            place -= 1;
        }
        records[place] = record;
    }
}

/// Gives many records of one cell keys within the box of their points, and sorts them by these; without any extent they are
/// sorted by their numbers, and false is returned. Compiled once for each number of dimensions, as there are many kinds of points.
fn refine<const D: usize>(
    run: &mut [u64],
    at: &dyn Fn(usize) -> [f64; D],
    key: &dyn Fn([u32; D]) -> u32,
) -> bool {
    let point = |record: u64| at(record as u32 as usize);
    let (low, high) = bounds(run.iter().map(|&r| point(r)));
    let Some(grid) = Grid::over(low, high) else {
        sort_by_number(run);
        return false;
    };
    for record in run.iter_mut() {
        let cell = grid.cell(point(*record));
        *record = u64::from(key(cell)) << 32 | u64::from(*record as u32);
    }
    sort(run);
    true
}

/// Puts records that share a key in order, given records sorted by key.
fn settle<const D: usize>(
    records: &mut [u64],
    at: &impl Fn(usize) -> [f64; D],
    key: &impl Fn([u32; D]) -> u32,
) {
    let point = |record: u64| at(record as u32 as usize);
    // An explicit stack: points at 2⁻¹, 2⁻², 2⁻³, … nest some two hundred boxes deep.
    let mut open = vec![(0, records.len())];
    while let Some((start, end)) = open.pop() {
        let mut first = start;
        while first < end {
            let mut last = first + 1;
            while last < end && records[last] >> 32 == records[first] >> 32 {
                last += 1;
            }
            if last - first > 1 && last - first <= COMPARISON_SORT_MAX {
                insertion_sort(&mut records[first..last], |a, b| {
                    compare(point(a), point(b)).then((a as u32).cmp(&(b as u32)))
                });
            } else if last - first > COMPARISON_SORT_MAX {
                let is_refined = refine(&mut records[first..last], at, key);
                open.extend(is_refined.then_some((first, last)));
            }
            first = last;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points_in_order<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
        hilbert_order(points.len(), |i| points[i]).into_iter().map(|i| points[i as usize]).collect()
    }

    fn points_in_z_order<const D: usize>(points: &[[f64; D]]) -> Vec<[f64; D]> {
        morton_order(points.len(), |i| points[i]).into_iter().map(|i| points[i as usize]).collect()
    }

    fn shuffled<T: Copy>(items: &[T], seed: u64) -> Vec<T> {
        let mut state = seed | 1;
        let mut keyed: Vec<(u64, T)> = items
            .iter()
            .map(|&item| {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 20, item)
            })
            .collect();
        keyed.sort_by_key(|k| k.0);
        keyed.into_iter().map(|k| k.1).collect()
    }

    /// A set has fewer points than this, as many as an interpreter has time for.
    const POINTS_MAX: usize = if cfg!(miri) { 12 } else { 400 };

    fn coordinate() -> impl Strategy<Value = f64> {
        prop_oneof![
            -1.0..1.0f64,
            (-3..3i32).prop_map(f64::from),
            (-1074..1023i32).prop_map(
                |e| 2f64.powi(e.max(-1022)) * if e < -1022 { 2f64.powi(e + 1022) } else { 1.0 }
            ),
            Just(f64::MAX),
            Just(f64::MIN),
            Just(5e-324),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 256 }))]
        #[test]
        fn the_order_is_a_function_of_the_set(
            points in prop::collection::vec([coordinate(), coordinate()], 0..POINTS_MAX),
            seed in any::<u64>(),
        ) {
            prop_assert_eq!(points_in_order(&points), points_in_order(&shuffled(&points, seed)));
            prop_assert_eq!(points_in_z_order(&points), points_in_z_order(&shuffled(&points, seed)));
        }

        #[test]
        fn each_point_comes_once_and_equal_ones_together_by_number(
            points in prop::collection::vec([coordinate(), coordinate(), coordinate()], 0..POINTS_MAX),
        ) {
            let at = |i: usize| points[i];
            for order in [hilbert_order(points.len(), at), morton_order(points.len(), at)] {
                let mut seen = order.clone();
                seen.sort_unstable();
                prop_assert!(seen.iter().enumerate().all(|(i, &s)| i == s as usize));
                let mut places = std::collections::HashMap::<[u64; 3], Vec<usize>>::new();
                for (place, &i) in order.iter().enumerate() {
                    places.entry(points[i as usize].map(f64::to_bits)).or_default().push(place);
                }
                for run in places.values() {
                    for pair in run.windows(2) {
                        prop_assert_eq!(pair[0] + 1, pair[1]);
                        prop_assert!(order[pair[0]] < order[pair[1]]);
                    }
                }
            }
        }
    }

    /// Neighbors in a grid are neighbors in the order: the mean step is hardly longer than a cell.
    #[test]
    fn steps_are_short_even_in_a_cluster_far_from_the_rest() {
        let side = if cfg!(miri) { 8 } else { 100 };
        let mut points: Vec<[f64; 2]> = (0..side * side)
            .map(|i| [f64::from(i % side) * 1e-12, f64::from(i / side) * 1e-12])
            .collect();
        points.push([1e9, 1e9]);
        let points = points_in_order(&shuffled(&points, 7));
        let length: f64 = points
            .windows(2)
            .map(|p| (p[0][0] - p[1][0]).abs() + (p[0][1] - p[1][1]).abs())
            .filter(|&step| step < 1.0)
            .sum();
        assert!(length < 1.3 * f64::from(side * side) * 1e-12, "{length}");
    }

    /// The corners of a square, of which Z-order takes the two lower ones first; and the hash of the Hilbert order of
    /// many points, which may not change: triangulations are built along it.
    #[test]
    fn orders_do_not_change() {
        let square = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
        assert_eq!(morton_order(4, |i| square[i]), [0, 2, 1, 3]);
        assert_eq!(hilbert_order(4, |i| square[i]), GOLDEN_SQUARE);
        let word = |i: u64| i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 11;
        let at = |i: usize| [word(2 * i as u64) as f64, (word(3 * i as u64) as f64).powi(9)];
        let hash = |order: Vec<u32>| {
            order.iter().fold(0u64, |h, &i| h.wrapping_mul(0x100_0000_01B3) ^ u64::from(i))
        };
        if cfg!(miri) {
            return; // Sorts of five thousand keys take an interpreter too long.
        }
        assert_eq!(hash(hilbert_order(5000, at)), GOLDEN_PLANE);
        let at = |i: usize| [word(i as u64) as f64, at(i)[0], at(i)[1]];
        assert_eq!(hash(hilbert_order(5000, at)), GOLDEN_SPACE);
    }

    const GOLDEN_SQUARE: [u32; 4] = [0, 1, 3, 2];
    const GOLDEN_PLANE: u64 = 6_090_128_390_992_575_286;
    const GOLDEN_SPACE: u64 = 9_155_120_178_865_588_620;

    #[test]
    fn nothing_one_point_and_all_equal() {
        assert!(hilbert_order::<2>(0, |_| unreachable!("no point")).is_empty());
        assert_eq!(hilbert_order(1, |_| [3.0, 4.0]), [0]);
        assert_eq!(hilbert_order(9, |_| [3.0, 4.0, 5.0]), (0..9).collect::<Vec<u32>>());
        assert_eq!(
            hilbert_order(9, |i| [if i % 2 == 0 { 0.0 } else { -0.0 }, 1.0]),
            (0..9).collect::<Vec<u32>>()
        );
    }

    #[test]
    fn threads_do_not_change_the_order() {
        let points: Vec<[f64; 3]> = (0..if cfg!(miri) { 100 } else { 200_000u64 })
            .map(|i| {
                let x = |k: u64| {
                    (i.wrapping_mul(2 * k + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 44) as f64
                };
                [x(0), x(1) * x(1), x(2)]
            })
            .collect();
        let on = |threads| {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            pool.install(|| hilbert_order(points.len(), |i| points[i]))
        };
        assert_eq!(on(1), on(3));
    }

    #[test]
    fn coordinates_without_end_give_some_order() {
        for wrong in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            for axis in 0..2 {
                let point = |i: usize| {
                    let mut point = [i as f64, (i % 3) as f64];
                    point[axis] = if i.is_multiple_of(2) { wrong } else { point[axis] };
                    point
                };
                let mut order = hilbert_order(40, point);
                order.sort_unstable();
                assert!(order.into_iter().eq(0..40), "{wrong}");
                assert_eq!(morton_order(40, point).len(), 40);
            }
        }
    }
}
