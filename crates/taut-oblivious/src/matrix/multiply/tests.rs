use super::*;
use proptest::prelude::*;

/// Numbers in (−1, 1) with full mantissas.
fn numbers(n: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    (0..n)
        .map(|_| {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        })
        .collect()
}

fn at(a: MatrixView<'_>, i: usize, j: usize) -> f64 {
    a.data[i * a.row_stride + j * a.column_stride]
}

/// The sums in twice the precision, and the sums of magnitudes.
fn accurate(a: MatrixView<'_>, b: MatrixView<'_>) -> Vec<(f64, f64, f64)> {
    let mut all = Vec::new();
    for i in 0..a.rows {
        for j in 0..b.columns {
            let (mut high, mut low, mut magnitude) = (0.0f64, 0.0f64, 0.0f64);
            for k in 0..a.columns {
                let (x, y) = (at(a, i, k), at(b, k, j));
                let product = x * y;
                let sum = high + product;
                let bent = sum - high;
                low += x.mul_add(y, -product) + ((high - (sum - bent)) + (product - bent));
                high = sum;
                magnitude += product.abs();
            }
            all.push((high, low, magnitude));
        }
    }
    all
}

/// The order of additions that is promised.
fn by_the_book(a: MatrixView<'_>, b: MatrixView<'_>) -> Vec<f64> {
    let mut all = Vec::new();
    for i in 0..a.rows {
        for j in 0..b.columns {
            let stretches = (0..a.columns).step_by(PANEL_DEPTH).map(|first| {
                (first..a.columns.min(first + PANEL_DEPTH))
                    .fold(0.0f64, |sum, k| at(a, i, k).mul_add(at(b, k, j), sum))
            });
            all.push(stretches.reduce(|x, y| x + y).unwrap_or(0.0));
        }
    }
    all
}

fn largest() -> usize {
    if cfg!(miri) { 6 } else { 90 }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 2 } else { 16 }))]
    #[test]
    fn all_levels_give_the_promised_bits(
        m in 0..largest(), k in 0..4 * largest(), n in 0..largest(), gap in 0usize..3,
        turned_a: bool, turned_b: bool, seed: u64,
    ) {
        let (data_a, data_b) = (numbers(m * (k + gap) + k * gap, seed), numbers(2 * k * n, !seed));
        let a = if turned_a {
            MatrixView::strided(&data_a, (m, k), (1, m + if k > 0 { gap * m / k.max(1) } else { 0 }))
        } else {
            MatrixView::strided(&data_a, (m, k), (k + gap, 1))
        };
        let a = a.unwrap_or(MatrixView::strided(&data_a, (m, k), (k, 1)).unwrap());
        // Neither rows nor columns adjacent, or columns.
        let b = if turned_b {
            MatrixView::strided(&data_b, (k, n), (2, 2 * k)).unwrap()
        } else {
            MatrixView::strided(&data_b, (k, n), (n, 1)).unwrap()
        };
        let expected = by_the_book(a, b);
        for level in Level::all() {
            let stride = n + gap;
            let mut c = vec![f64::NAN; m * stride];
            let target = MatrixViewMut::strided(&mut c, (m, n), stride).unwrap();
            recurse(level, a, b, target, Update::Set, &mut NoProbe);
            for (i, row) in c.chunks(stride.max(1)).enumerate().take(m) {
                prop_assert!(row[..n] == expected[i * n..][..n], "{level:?} row {i}");
                prop_assert!(row[n..].iter().all(|x| x.is_nan()), "the gap was written");
            }
            let mut c = vec![1.0; m * n];
            for update in [Update::Add, Update::Subtract] {
                let target = MatrixViewMut::new(&mut c, m, n).unwrap();
                recurse(level, a, b, target, update, &mut NoProbe);
            }
            let plain: Vec<f64> = if k <= PANEL_DEPTH {
                expected.iter().map(|&x| (1.0 + x) - x).collect()
            } else {
                c.clone()
            };
            prop_assert!(c == plain);
        }
    }

    #[test]
    fn errors_stay_below_the_bounds(
        m in 1..largest(), k in 1..largest(), n in 1..largest(), seed: u64,
    ) {
        let (data_a, data_b) = (numbers(m * k, seed), numbers(k * n, !seed));
        let (a, b) =
            (MatrixView::new(&data_a, m, k).unwrap(), MatrixView::new(&data_b, k, n).unwrap());
        let u = f64::EPSILON / 2.0;
        let largest_of = |data: &[f64]| data.iter().fold(0.0f64, |l, x| l.max(x.abs()));
        for above in [None, Some(16), Some(40)] {
            let mut c = vec![0.0; m * n];
            let options = MultiplyOptions { strassen_above: above };
            multiply(a, b, MatrixViewMut::new(&mut c, m, n).unwrap(), &options).unwrap();
            let shortest = m.min(k).min(n);
            let levels = (0..8).take_while(|l| shortest >> l > above.unwrap_or(usize::MAX)).count();
            let p = m.max(k).max(n) as f64;
            let q = (p / 2f64.powi(levels as i32)).ceil();
            let norm_bound = (18f64.powi(levels as i32) * (q * q + 6.0 * q) - 6.0 * p).max(p)
                * u * largest_of(&data_a) * largest_of(&data_b) * 1.001;
            for (&x, (high, low, magnitude)) in c.iter().zip(accurate(a, b)) {
                let error = ((x - high) - low).abs();
                let ku = k as f64 * u;
                let bound = if levels == 0 { 1.001 * ku / (1.0 - ku) * magnitude } else { norm_bound };
                prop_assert!(error <= bound, "{error} > {bound} with {levels} levels");
            }
        }
    }
}

/// Integers are exact, with Strassen's method as well.
#[test]
fn strassen_of_integers_is_exact_for_odd_sizes_and_any_strides() {
    let shapes = [(17, 18, 19), (33, 34, 35), (64, 64, 64), (17, 40, 63), (71, 19, 18)];
    for (m, k, n) in shapes.into_iter().take(if cfg!(miri) { 1 } else { 5 }) {
        let integers =
            |data: Vec<f64>| data.iter().map(|x| (x * 1000.0).round()).collect::<Vec<_>>();
        let (data_a, data_b) = (integers(numbers(m * k, 1)), integers(numbers(k * n, 2)));
        let a = MatrixView::new(&data_a, m, k).unwrap();
        let b = MatrixView::new(&data_b, n, k).unwrap().transposed();
        let expected = by_the_book(a, b);
        let mut c = vec![0.0; m * n];
        let options = MultiplyOptions { strassen_above: Some(16) };
        multiply(a, b, MatrixViewMut::new(&mut c, m, n).unwrap(), &options).unwrap();
        assert!(c == expected, "{m} {k} {n}");
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn threads_and_recursion_change_no_bit() {
    let (m, k, n) = (130, 4400, 70);
    let (data_a, data_b) = (numbers(m * k, 3), numbers(k * n, 4));
    let (a, b) = (MatrixView::new(&data_a, m, k).unwrap(), MatrixView::new(&data_b, k, n).unwrap());
    let expected = by_the_book(a, b);
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut c = vec![0.0; m * n];
        let target = MatrixViewMut::new(&mut c, m, n).unwrap();
        pool.install(|| multiply(a, b, target, &Default::default())).unwrap();
        assert!(c == expected, "{threads} threads");
    }
    // A long side of rows and of columns.
    let (tall, wide) = (numbers(4500 * 5, 5), numbers(5 * 4300, 6));
    let (a, b) =
        (MatrixView::new(&tall, 4500, 5).unwrap(), MatrixView::new(&wide, 5, 4300).unwrap());
    let (a_part, b_part) = (a.part(4400..4410, 0..5), b.part(0..5, 4250..4300));
    let mut c = vec![0.0; 4500 * 4300];
    multiply(a, b, MatrixViewMut::new(&mut c, 4500, 4300).unwrap(), &Default::default()).unwrap();
    let part: Vec<f64> = (4400..4410).flat_map(|i| c[i * 4300 + 4250..][..50].to_vec()).collect();
    assert!(part == by_the_book(a_part, b_part));
}

#[test]
fn shapes_strides_and_cut_offs_are_checked() {
    let (data, mut to) = ([0.0; 12], [0.0; 12]);
    let refused = |refused: bool| assert!(refused);
    refused(MatrixView::new(&data, 3, 5).is_err());
    refused(MatrixView::strided(&data, (3, 4), (5, 1)).is_err());
    refused(MatrixView::strided(&data, (usize::MAX, 2), (usize::MAX, 1)).is_err());
    refused(MatrixViewMut::strided(&mut to, (3, 4), 3).is_err());
    MatrixView::strided(&data, (0, 4), (100, 100)).unwrap();
    let (a, b) = (MatrixView::new(&data, 3, 4).unwrap(), MatrixView::new(&data, 4, 3).unwrap());
    refused(
        multiply(a, a, MatrixViewMut::new(&mut to, 3, 4).unwrap(), &Default::default()).is_err(),
    );
    let options = MultiplyOptions { strassen_above: Some(15) };
    let target = MatrixViewMut::strided(&mut to, (3, 3), 3).unwrap();
    refused(multiply(a, b, target, &options).is_err());
}

#[test]
fn nothing_times_nothing_is_zero() {
    let mut c = [1.0; 6];
    let (a, b) = (MatrixView::new(&[], 2, 0).unwrap(), MatrixView::new(&[], 0, 3).unwrap());
    multiply(a, b, MatrixViewMut::new(&mut c, 2, 3).unwrap(), &Default::default()).unwrap();
    assert_eq!(c, [0.0; 6]);
    let (a, b) = (MatrixView::new(&[], 0, 2).unwrap(), MatrixView::new(&c, 2, 3).unwrap());
    multiply(a, b, MatrixViewMut::new(&mut [], 0, 3).unwrap(), &Default::default()).unwrap();
}

#[test]
fn a_stride_that_nothing_follows_may_be_of_any_size() {
    let (k, n) = if cfg!(miri) { (20, 11) } else { (2048, 1100) };
    let (a, b) = (vec![1.0; k], vec![0.5; k * n]);
    let (a, b) = (MatrixView::new(&a, 1, k).unwrap(), MatrixView::new(&b, k, n).unwrap());
    let mut expected = vec![0.0; n];
    multiply(a, b, MatrixViewMut::new(&mut expected, 1, n).unwrap(), &Default::default()).unwrap();
    for stride in [n, 1 << 60, 1 << 61, usize::MAX] {
        for threads in [1, 2, 8] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut c = vec![0.0; n];
            let target = MatrixViewMut::strided(&mut c, (1, n), stride).unwrap();
            pool.install(|| multiply(a, b, target, &Default::default())).unwrap();
            assert_eq!(c, expected, "{stride} {threads}");
        }
    }
    let column = MatrixView::strided(a.data, (k, 1), (1, usize::MAX)).unwrap();
    let mut c = [0.0];
    multiply(a, column, MatrixViewMut::new(&mut c, 1, 1).unwrap(), &Default::default()).unwrap();
    assert_eq!(c, [k as f64]);
}
