//! The kernel against double-double, on every instruction set the machine has.

use taut_points::{Distribution, GeneratedSource, Scalar, ScalarKind, gather};

use super::*;

/// Normal rows, drawn without threads, which Miri does not approve of.
fn normal(rows: usize, dim: usize) -> Vec<f64> {
    let n = rows as u64;
    let source = GeneratedSource::new(Distribution::Normal, n, dim, 3, ScalarKind::F64).unwrap();
    gather(&source, &(0..n).collect::<Vec<_>>()).unwrap()
}

fn each<T: Scalar>(values: &[T], stride: usize, center: &Center, rows: usize) -> Vec<Vec<f64>> {
    let mut results = vec![vec![0.0; rows]];
    // SAFETY: the portable lanes need no feature; lengths match.
    #[allow(unsafe_code)]
    unsafe {
        all_rows::<portable::Portable, T>(values, stride, center, &mut results[0])
    };
    #[cfg(target_arch = "x86_64")]
    results.extend(x86::each_instruction_set(values, stride, center, rows));
    let mut chosen = vec![0.0; rows];
    squared_distances(values, stride, center, &mut chosen);
    results.push(chosen);
    results
}

fn check<T: Scalar>(dim: usize, stride: usize, rows: usize, offset: f64, two_terms: bool) {
    let values: Vec<T> =
        normal(rows, stride).into_iter().map(|v| T::from_f64(v + offset)).collect();
    let low =
        if two_terms { (0..dim).map(|j| offset * 1e-17 * j as f64).collect() } else { vec![] };
    let center = Center { high: (0..dim).map(|j| offset + 0.1 * (j as f64).sin()).collect(), low };
    for found in each(&values, stride, &center, rows) {
        for (i, &value) in found.iter().enumerate() {
            let row: Vec<f64> = values[i * stride..][..dim].iter().map(|&v| v.into()).collect();
            let exact = Difference::new(&row, &center, 1.0).squared().high;
            let bound = relative_error(dim) * exact;
            assert!((value - exact).abs() <= bound, "d {dim}, row {i}: {value} against {exact}");
        }
    }
}

#[test]
fn squared_distances_agree_with_double_double() {
    // Under Miri, which is ten thousand times slower, one of each kind of row.
    let dims: Vec<usize> = match cfg!(miri) {
        true => vec![1, 3, 8, 13, 97, 131],
        false => (1..40).chain([63, 64, 65, 95, 96, 97, 100, 127, 129, 1000]).collect(),
    };
    let counts: &[usize] = if cfg!(miri) { &[1, 9] } else { &[1, 7, 8, 9, 16] };
    for dim in dims {
        for &rows in counts {
            check::<f64>(dim, dim, rows, 0.0, false);
            check::<f32>(dim, dim, rows, 0.0, false);
            check::<f64>(dim, dim + 1, rows, 0.0, false);
            check::<f64>(dim, dim, rows, 1e9, true);
        }
    }
}

#[test]
fn a_row_does_not_depend_on_its_neighbors() {
    for dim in [2, 5, 17, 200] {
        let values = normal(40, dim);
        let center = Center { high: vec![0.25; dim], low: vec![] };
        let mut all = vec![0.0; 40];
        squared_distances(&values, dim, &center, &mut all);
        for i in 0..40 {
            let mut one = [0.0];
            squared_distances(&values[i * dim..][..dim], dim, &center, &mut one);
            assert_eq!(one[0], all[i], "d {dim}, row {i}");
        }
    }
}

#[test]
fn double_double_keeps_what_double_loses() {
    let tiny = 2f64.powi(-70);
    let sum = DoubleDouble::sum(1.0, tiny);
    assert_eq!((sum - 1.0.into()).high, tiny);
    let third = DoubleDouble::from(1.0) / 3.0.into();
    assert!((third * 3.0.into() - 1.0.into()).high.abs() < 1e-31);
    let root = DoubleDouble::from(2.0).sqrt();
    assert!((root.square() - 2.0.into()).high.abs() < 1e-31);
    assert_eq!(sum.round_up(), 1f64.next_up());
    assert_eq!(DoubleDouble::from(1.0).round_up(), 1.0);
}

#[test]
fn ties_are_told_exactly() {
    let within = |x: &[f64], high: f64, low: f64, reach: f64, r: f64| {
        let center = Center { high: vec![high, 0.0], low: vec![low, 0.0] };
        Difference::new(x, &center, 1.0).is_within(reach, r)
    };
    // 0.1² + 0² against 0.1²: a tie whose squares do not fit into one f64.
    assert!(within(&[0.1, 0.0], 0.0, 0.0, 0.1, 0.0));
    assert!(!within(&[0.1, 0.0], 0.0, 0.0, 0.1f64.next_down(), 0.0));
    // What double-double cannot hold decides: a tail of 2⁻²⁰⁰ in the center, or a second coordinate of that size.
    let tiny = 2f64.powi(-200);
    assert!(within(&[1.0, 0.0], 0.0, tiny, 1.0, 0.0));
    assert!(!within(&[1.0, 0.0], 0.0, -tiny, 1.0, 0.0));
    assert!(!within(&[1.0, tiny], 0.0, 0.0, 1.0, 0.0));
    // |x − c| + r with r = 1/3: the difference of reach and r has two terms.
    let r = 1.0 / 3.0;
    assert!(within(&[3.0, 4.0], 0.0, 0.0, 6.0, 1.0));
    assert!(!within(&[3.0, 4.0], 0.0, 0.0, 5.0 + r - 1e-15, r));
}

/// T(x − c), as [`triangle`] should have it.
fn image(matrix: &[f64], x: &[f64], center: &Center, shift: &[f64]) -> Vec<f64> {
    let dim = center.dim();
    let difference = |j: usize| {
        let low = center.low.get(j).copied().unwrap_or(0.0);
        DoubleDouble::sum(x[j], -center.high[j]) - low.into()
    };
    let row = |a: usize| {
        (0..=a).fold(DoubleDouble::from(-shift[a]), |sum, b| {
            sum + difference(b) * matrix[a * dim + b].into()
        })
    };
    (0..dim).map(|a| row(a).high).collect()
}

/// A lower triangular matrix whose entries above the diagonal would spoil everything.
fn lower(dim: usize) -> Vec<f64> {
    let entry = |a: usize, b: usize| if b > a { f64::NAN } else { ((a * 7 + b * 3) as f64).sin() };
    (0..dim * dim).map(|at| entry(at / dim, at % dim)).collect()
}

/// The same by every kind of lanes.
fn leverages_of_each(
    values: &[f64],
    matrix: &[f64],
    center: &Center,
    rows: usize,
) -> Vec<Vec<f64>> {
    let mut scratch = vec![0.0; center.dim() * (triangle::POINTS + 1)];
    let mut results = vec![vec![0.0; rows]];
    let work =
        triangle::Leverages { values, matrix, center, scratch: &mut scratch, out: &mut results[0] };
    // SAFETY: the portable lanes need no feature; lengths match.
    #[allow(unsafe_code)]
    unsafe {
        triangle::Work::run::<portable::Portable>(work)
    };
    #[cfg(target_arch = "x86_64")]
    for set in [x86::Set::Avx512, x86::Set::Avx2] {
        let mut out = vec![0.0; rows];
        let scratch = &mut scratch;
        let work = triangle::Leverages { values, matrix, center, scratch, out: &mut out };
        if x86::run_as(set, work).is_none() {
            results.push(out);
        }
    }
    results
}

fn check_leverages<T: Scalar>(dim: usize, rows: usize, offset: f64, two_terms: bool) {
    let values: Vec<T> = normal(rows, dim).into_iter().map(|v| T::from_f64(v + offset)).collect();
    let low =
        if two_terms { (0..dim).map(|j| offset * 1e-17 * j as f64).collect() } else { vec![] };
    let center = Center { high: vec![offset + 0.25; dim], low };
    let matrix = lower(dim);
    let mut found = vec![0.0; rows];
    triangle::leverages(&values, &matrix, &center, &mut vec![1.0; 3], &mut found);
    let wide: Vec<f64> = values.iter().map(|&value| value.into()).collect();
    let others = leverages_of_each(&wide, &matrix, &center, rows);
    for (i, &value) in found.iter().enumerate() {
        let row: Vec<f64> = values[i * dim..][..dim].iter().map(|&v| v.into()).collect();
        let exact = image(&matrix, &row, &center, &vec![0.0; dim]);
        let exact: f64 = exact.iter().map(|y| y * y).sum();
        let terms = dim as f64 * row.iter().map(|x| (x - offset).abs() + 1.0).sum::<f64>().powi(2);
        assert!((value - exact).abs() <= 1e-15 * terms, "d {dim}, row {i}: {value}, {exact}");
        // Each instruction set, with roundings of its own.
        for other in &others {
            assert!((other[i] - exact).abs() <= 1e-15 * terms, "d {dim}, row {i}: {}", other[i]);
        }
        // A row does not depend on its neighbors, nor on where it stands.
        let mut alone = [0.0];
        let one = &values[i * dim..][..dim];
        triangle::leverages(one, &matrix, &center, &mut vec![], &mut alone);
        assert_eq!(alone[0], value, "d {dim}, row {i}");
    }
}

#[test]
fn leverages_agree_with_double_double() {
    let dims: Vec<usize> =
        if cfg!(miri) { vec![1, 2, 9] } else { (1..20).chain([31, 64, 65]).collect() };
    let counts: &[usize] = if cfg!(miri) { &[1, 33] } else { &[1, 7, 31, 32, 33, 100, 300] };
    for dim in dims {
        for &rows in counts {
            check_leverages::<f64>(dim, rows, 0.0, false);
            check_leverages::<f32>(dim, rows, 0.0, false);
            check_leverages::<f64>(dim, rows, 1e9, true);
        }
    }
}

/// Images, their squares and the forms of a block.
type Block = (Vec<f64>, [f64; triangle::POINTS], [f64; triangle::POINTS]);

/// Those by the best kind of lanes, and by every kind.
fn blocks_of_each(triangle: triangle::Triangle<'_>, x: &[f64]) -> Vec<Block> {
    let empty = || (vec![0.0; x.len()], [0.0; triangle::POINTS], [0.0; triangle::POINTS]);
    let mut chosen = empty();
    triangle::images(triangle, x, &mut chosen.0, &mut chosen.1);
    triangle::forms(triangle, x, &mut chosen.2);
    let mut results = vec![chosen];
    let images = |(z, out, _): &mut Block, run: &dyn Fn(triangle::Images<'_>) -> bool| {
        run(triangle::Images { triangle, x: x.as_ptr(), z: z.as_mut_ptr(), out })
    };
    let forms = |(_, _, out): &mut Block, run: &dyn Fn(triangle::Forms<'_>) -> bool| {
        run(triangle::Forms { triangle, x: x.as_ptr(), out })
    };
    let mut portable = empty();
    // SAFETY: the portable lanes need no feature; lengths match.
    #[allow(unsafe_code)]
    unsafe {
        images(&mut portable, &|work| {
            triangle::Work::run::<portable::Portable>(work);
            true
        });
        forms(&mut portable, &|work| {
            triangle::Work::run::<portable::Portable>(work);
            true
        });
    }
    results.push(portable);
    #[cfg(target_arch = "x86_64")]
    for set in [x86::Set::Avx512, x86::Set::Avx2] {
        let mut block = empty();
        if images(&mut block, &|work| x86::run_as(set, work).is_none())
            && forms(&mut block, &|work| x86::run_as(set, work).is_none())
        {
            results.push(block);
        }
    }
    results
}

#[test]
fn images_forms_and_moments_agree_with_plain_loops() {
    for dim in [1, 2, 3, 8, 9, 20] {
        let points = 2 * triangle::POINTS;
        let rows = normal(points, dim);
        let mut blocks = vec![0.0; points * dim];
        for (i, row) in rows.chunks_exact(dim).enumerate() {
            for (j, &x) in row.iter().enumerate() {
                blocks[i / 32 * 32 * dim + 32 * j + i % 32] = x;
            }
        }
        let (matrix, shift) = (lower(dim), normal(1, dim));
        let center = Center { high: vec![0.0; dim], low: vec![] };
        let weights: Vec<f64> = (0..points).map(|i| (i % 5) as f64).collect();
        let triangle = triangle::Triangle { matrix: &matrix, shift: &shift };
        let each = blocks.chunks_exact(32 * dim).enumerate();
        for (k, (z, out, forms)) in each.flat_map(|(k, block)| {
            blocks_of_each(triangle, block).into_iter().map(move |found| (k, found))
        }) {
            for i in 0..32 {
                let row = &rows[(32 * k + i) * dim..][..dim];
                let wanted = image(&matrix, row, &center, &shift);
                let square: f64 = wanted.iter().map(|y| y * y).sum();
                let form: f64 = wanted.iter().zip(row).map(|(y, x)| y * x).sum();
                assert!((out[i] - square).abs() < 1e-12 * (1.0 + square));
                assert!((forms[i] - form).abs() < 1e-12 * (1.0 + square));
                for (j, wanted) in wanted.iter().enumerate() {
                    assert!((z[32 * j + i] - wanted).abs() < 1e-12 * (1.0 + wanted.abs()));
                }
            }
        }
        let moments = triangle::moments(dim, &blocks, &weights);
        let m = dim + 1;
        let coordinate = |i: usize, a: usize| if a == dim { 1.0 } else { rows[i * dim + a] };
        for a in 0..m {
            for b in 0..=a {
                let wanted: f64 =
                    (0..points).map(|i| weights[i] * coordinate(i, a) * coordinate(i, b)).sum();
                assert!((moments[a * m + b] - wanted).abs() < 1e-11);
            }
        }
    }
}

/// All instruction sets tell alike which values are above a bound, and NaN is above nothing.
#[test]
fn bits_say_what_is_above() {
    let mut values: Vec<f64> = (0..77).map(|i| f64::from(i * 37 % 64)).collect();
    values[5] = f64::NAN;
    values[40] = f64::INFINITY;
    for n in [0, 1, 8, 31, 32, 33, 64, 77] {
        let mut wanted = vec![0u32; usize::div_ceil(n, 32)];
        for i in 0..n {
            wanted[i / 32] |= u32::from(values[i] > 40.0) << (i % 32);
        }
        let mut chosen = vec![0; wanted.len()];
        triangle::above(&values[..n], 40.0, &mut chosen);
        assert_eq!(chosen, wanted);
        let mut bits = vec![0; wanted.len()];
        // SAFETY: the portable lanes need no feature.
        #[allow(unsafe_code)]
        unsafe {
            let work = triangle::Above { values: &values[..n], bound: 40.0, bits: &mut bits };
            triangle::Work::run::<portable::Portable>(work)
        };
        assert_eq!(bits, wanted);
        #[cfg(target_arch = "x86_64")]
        for set in [x86::Set::Avx512, x86::Set::Avx2] {
            let mut bits = vec![0; wanted.len()];
            let work = triangle::Above { values: &values[..n], bound: 40.0, bits: &mut bits };
            if x86::run_as(set, work).is_none() {
                assert_eq!(bits, wanted, "{set:?}");
            }
        }
    }
}

/// All instruction sets split and transpose alike.
#[test]
fn lanes_move_values_alike_everywhere() {
    struct Moved<'a>(&'a mut Vec<f64>);
    impl triangle::Work for Moved<'_> {
        #[allow(unsafe_code)]
        unsafe fn run<L: Lanes>(self) {
            let values: Vec<f64> = (0..64).map(f64::from).collect();
            // SAFETY: features are the caller's promise; each load and store stays within 64 values.
            unsafe {
                let rows: [L; 8] = std::array::from_fn(|i| L::load(values.as_ptr().add(8 * i)));
                let (even, odd) = L::split(rows[0], rows[1]);
                let columns = L::transpose(rows);
                let mut eight = [0.0; 8];
                for lanes in [even, odd].iter().chain(&columns) {
                    lanes.store(eight.as_mut_ptr());
                    self.0.extend(eight);
                }
            }
        }
    }
    let mut wanted: Vec<f64> = (0..8).map(|i| f64::from(2 * i)).collect();
    wanted.extend((0..8).map(|i| f64::from(2 * i + 1)));
    wanted.extend((0..64).map(|at| f64::from(at % 8 * 8 + at / 8)));
    let mut found = vec![];
    // SAFETY: the portable lanes need no feature.
    #[allow(unsafe_code)]
    unsafe {
        triangle::Work::run::<portable::Portable>(Moved(&mut found))
    };
    assert_eq!(found, wanted);
    #[cfg(target_arch = "x86_64")]
    for set in [x86::Set::Avx512, x86::Set::Avx2] {
        let mut found = vec![];
        if x86::run_as(set, Moved(&mut found)).is_none() {
            assert_eq!(found, wanted, "{set:?}");
        }
    }
}

/// Products of lengths that leave the range of `usize` are no lengths of slices.
#[test]
fn lengths_that_wrap_around_are_refused() {
    let center = Center { high: vec![0.0], low: vec![] };
    let stride = 1 << (usize::BITS - 1);
    let refused =
        |call: fn(&Center, usize)| std::panic::catch_unwind(|| call(&center, stride)).is_err();
    assert!(refused(|center, stride| squared_distances::<f64>(&[], stride, center, &mut [0.0; 2])));
    assert!(refused(|_, stride| {
        triangle::moments(stride / 16 + 1, &[0.0; 32], &[1.0; 32]);
    }));
    assert!(refused(|_, _| {
        let empty = Center { high: vec![], low: vec![] };
        triangle::leverages::<f64>(&[], &[], &empty, &mut vec![], &mut []);
    }));
    let none = triangle::Triangle { matrix: &[], shift: &[] };
    assert!(
        std::panic::catch_unwind(|| triangle::images(none, &[], &mut [], &mut [0.0; 32])).is_err()
    );
    assert!(std::panic::catch_unwind(|| triangle::forms(none, &[], &mut [0.0; 32])).is_err());
}
