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
fn a_row_does_not_depend_on_its_neighbours() {
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
    assert_eq!(sum.sub(1.0.into()).high, tiny);
    let third = DoubleDouble::from(1.0).div(3.0.into());
    assert!(third.mul(3.0.into()).sub(1.0.into()).high.abs() < 1e-31);
    let root = DoubleDouble::from(2.0).sqrt();
    assert!(root.square().sub(2.0.into()).high.abs() < 1e-31);
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
    // What double-double cannot hold decides: a tail of 2⁻²⁰⁰ in the centre, or a second coordinate of that size.
    let tiny = 2f64.powi(-200);
    assert!(within(&[1.0, 0.0], 0.0, tiny, 1.0, 0.0));
    assert!(!within(&[1.0, 0.0], 0.0, -tiny, 1.0, 0.0));
    assert!(!within(&[1.0, tiny], 0.0, 0.0, 1.0, 0.0));
    // |x − c| + r with r = 1/3: the difference of reach and r has two terms.
    let r = 1.0 / 3.0;
    assert!(within(&[3.0, 4.0], 0.0, 0.0, 6.0, 1.0));
    assert!(!within(&[3.0, 4.0], 0.0, 0.0, 5.0 + r - 1e-15, r));
}
