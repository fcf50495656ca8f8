use super::*;
use crate::test_length::long_or;
use proptest::prelude::*;

/// Different elements, as far as their width allows.
fn numbered<T: Pod>(n: usize) -> Vec<T> {
    let width = size_of::<T>();
    let mut state = 1u64;
    let bytes: Vec<u8> = (0..n * width)
        .map(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 56) as u8
        })
        .collect();
    bytes.chunks_exact(width).map(bytemuck::pod_read_unaligned).collect()
}

fn plain<T: Copy>(from: &[T], rows: usize, columns: usize) -> Vec<T> {
    (0..columns).flat_map(|j| (0..rows).map(move |i| from[i * columns + j])).collect()
}

/// Every level, past the caches or not, source and target `shift` elements into their allocations.
fn check<T: Pod + Send + Sync + PartialEq>(rows: usize, columns: usize, shift: usize) {
    let n = rows * columns;
    let room = numbered::<T>(n + shift);
    let from = &room[shift..];
    let expected = plain(from, rows, columns);
    let guard = numbered::<T>(2 * shift + 1);
    for level in Level::all() {
        for past in [false, true] {
            let mut shape = Shape::new::<T>(level, rows, columns, 1);
            shape.past = past;
            if past && rows >= 2 * BAND_ROWS && shape.strip_columns < columns {
                shape.task_columns = TASK * WALK_COLUMNS;
            }
            let mut to = [&guard[..shift], &vec![T::zeroed(); n], &guard[shift..]].concat();
            for (k, strip) in to[shift..shift + n].chunks_mut(shape.task_columns * rows).enumerate()
            {
                shape.task(from, k * shape.task_columns, strip, &mut NoProbe);
            }
            assert!(to[shift..shift + n] == expected, "{level:?} {past} {rows} × {columns}");
            assert!(to[..shift] == guard[..shift] && to[shift + n..] == guard[shift..]);
        }
        if rows == columns {
            let mut matrix = from.to_vec();
            in_place::square(level, &mut matrix, rows, &mut NoProbe);
            assert!(matrix == expected, "{level:?} {rows} in place");
        }
    }
    let mut matrix = from.to_vec();
    in_place::transpose_in_place(&mut matrix, rows, columns).unwrap();
    assert!(matrix == expected, "{rows} × {columns} in place");
}

fn check_widths(rows: usize, columns: usize, shift: usize) {
    check::<u8>(rows, columns, shift);
    check::<u16>(rows, columns, shift);
    check::<[u8; 3]>(rows, columns, shift);
    check::<u32>(rows, columns, shift);
    check::<u64>(rows, columns, shift);
    check::<[u8; 8]>(rows, columns, shift);
    check::<u128>(rows, columns, shift);
    check::<[u64; 5]>(rows, columns, shift);
}

/// Returns what a Miri run can afford.
fn largest() -> usize {
    if cfg!(miri) { 8 } else { 200 }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 24 }))]
    #[test]
    fn equals_the_definition(rows in 1..largest(), columns in 1..largest(), shift in 0usize..9) {
        check_widths(rows, columns, shift);
    }

    #[test]
    fn narrow_ones_too(d in 1usize..12, n in 1..8 * largest(), shift in 0usize..9) {
        check_widths(d, n, shift);
        check_widths(n, d, shift);
    }
}

#[test]
fn sizes_around_powers_of_two() {
    let sizes: &[usize] =
        if cfg!(miri) { &[1, 8, 9] } else { &[1, 2, 63, 64, 65, 127, 128, 129, 256, 257] };
    for &rows in sizes {
        for &columns in sizes {
            check::<u64>(rows, columns, 3);
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn large_targets_go_past_the_caches_on_any_number_of_threads() {
    let (rows, columns) = (2100, 2049);
    let from: Vec<u64> = (0..rows as u64 * columns as u64).collect();
    let expected = plain(&from, rows, columns);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut to = vec![0; from.len()];
        pool.install(|| transpose(&from, rows, columns, &mut to)).unwrap();
        assert!(to == expected);
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn bands_of_rows_meet() {
    for (rows, columns) in [
        (2 * BAND_ROWS, 130),
        (2 * BAND_ROWS, 11 * 48 + 64),
        (2 * BAND_ROWS + 7, 11 * 48 + 5),
        (3 * BAND_ROWS + 9, 131),
    ]
    .into_iter()
    .step_by(long_or(1, 2))
    {
        for shift in [0, 3] {
            check::<u64>(rows, columns, shift);
            check::<u32>(rows, columns, shift);
        }
    }
}

#[test]
fn nothing_in_nothing_out() {
    transpose::<f64>(&[], 0, 5, &mut []).unwrap();
    transpose::<f64>(&[], 5, 0, &mut []).unwrap();
    transpose(&[(); 6], 2, 3, &mut [(); 6]).unwrap();
    in_place::transpose_in_place::<f64>(&mut [], 0, 5).unwrap();
    // Nothing is asked for and nothing is accessed; something is not nothing.
    let mut counts = Counts::default();
    transpose_instrumented::<f64, _>(&[], usize::MAX, 0, &mut [], &mut counts).unwrap();
    in_place::transpose_in_place_instrumented::<f64, _>(&mut [], 0, usize::MAX, &mut counts)
        .unwrap();
    assert_eq!((counts.placed, counts.read, counts.written), (0, 0, 0));
    assert!(transpose(&[1u8], 0, 5, &mut [0]).is_err());
    assert!(in_place::transpose_in_place(&mut [1u8], 5, 0).is_err());
}

#[test]
fn wrong_lengths_are_refused() {
    let refused = |result: Result<(), Error>| {
        matches!(result, Err(Error::Option { .. })).then_some(()).expect("refused");
    };
    refused(transpose(&[1u8; 6], 2, 4, &mut [0; 6]));
    refused(transpose(&[1u8; 6], 2, 3, &mut [0; 5]));
    refused(transpose(&[1u8; 6], usize::MAX, usize::MAX, &mut [0; 6]));
    refused(in_place::transpose_in_place(&mut [1u8; 6], 7, 1));
}

/// Counts what it is told.
#[derive(Default)]
struct Counts {
    placed: usize,
    read: usize,
    written: usize,
}

impl Probe for Counts {
    const IS_RECORDING: bool = true;
    fn place_at(&mut self, _: usize, _: usize) {
        self.placed += 1;
    }
    fn lift_from(&mut self, _: usize) {
        self.placed -= 1;
    }
    fn record(&mut self, _: usize, bytes: usize, access: crate::Access) {
        *match access {
            crate::Access::Read => &mut self.read,
            crate::Access::Write => &mut self.written,
        } += bytes;
    }
}

#[test]
fn the_probe_records_every_element_in_and_out_of_the_scratch() {
    let (rows, columns) = if cfg!(miri) { (24, 16) } else { (96, 80) };
    let from = numbered::<u64>(rows * columns);
    let mut to = vec![0; from.len()];
    let mut counts = Counts::default();
    transpose_instrumented(&from, rows, columns, &mut to, &mut counts).unwrap();
    assert_eq!(to, plain(&from, rows, columns));
    assert_eq!(counts.placed, 0);
    assert!(counts.read >= 2 * 8 * from.len() && counts.read <= 2 * 9 * from.len());
    assert!(counts.written >= 2 * 8 * from.len() && counts.written <= 2 * 9 * from.len());
    let mut counts = Counts::default();
    in_place::transpose_in_place_instrumented(&mut to, columns, rows, &mut counts).unwrap();
    assert_eq!((to, counts.placed), (from, 0));
}
