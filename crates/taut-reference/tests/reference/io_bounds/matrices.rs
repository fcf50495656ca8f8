//! Transposition, products, and the exponent of Strassen's.

use taut_oblivious::Probe;
use taut_reference::algorithms::{
    Direction, MatrixSizes, fft_instrumented, lu_instrumented, multiply_instrumented,
    strassen_instrumented, transpose_instrumented,
};
use taut_reference::simulate::StackDistances;

use super::{Shape, WORD, largest, log, misses, numbers, row};

pub(crate) fn transposition(n: usize, base: usize, probe: &mut impl Probe) {
    let (from, mut to) = (vec![1.0f64; n * n], vec![0.0; n * n]);
    transpose_instrumented(&from, &mut to, n, n, base, probe).expect("square");
}

pub(crate) fn product(n: usize, base: usize, probe: &mut impl Probe) {
    let (a, b, mut c) = (vec![1.0; n * n], vec![2.0; n * n], vec![0.0; n * n]);
    multiply_instrumented(&a, &b, &mut c, MatrixSizes::square(n), base, probe).expect("square");
    assert_eq!(c[n * n - 1], 2.0 * n as f64);
}

#[test]
fn transposition_is_two_scans() {
    let grid = [(4096, 8), (4096, 32), (32768, 64)];
    let ratios = |n: usize, base| -> Vec<f64> {
        let found = misses(&grid, |probe| transposition(n, base, probe));
        found.iter().zip(grid).map(|(q, (_, b))| q * b as f64 / (2 * n * n) as f64).collect()
    };
    for base in [1, 16] {
        let ratios = ratios(1024, base);
        row(
            &format!("transposition, n = 1024, base {base}"),
            "2n²/B",
            largest(ratios.clone()),
            1.001,
        );
        assert!(ratios.iter().all(|&r| r >= 0.999), "{ratios:?}");
    }
    row("transposition, n = 1000, rows off borders", "2n²/B", largest(ratios(1000, 1)), 2.0);
}

fn product_ratios(n: usize, base: usize, grid: &[Shape]) -> Vec<f64> {
    let found = misses(grid, |probe| product(n, base, probe));
    let cube = (n as f64).powi(3);
    found.iter().zip(grid).map(|(q, &(m, b))| q * b as f64 * (m as f64).sqrt() / cube).collect()
}

#[test]
fn products_keep_the_bound() {
    let ratios = product_ratios(128, 1, &[(1024, 8), (4096, 32)]);
    row("product, n = 128, base 1", "n³/(B√M)", largest(ratios), 5.5);
}

#[test]
#[ignore = "seconds even when optimized"]
fn products_keep_the_bound_at_full_size() {
    let grid = [(1024, 8), (4096, 8), (4096, 32), (16384, 32)];
    for base in [1, 16] {
        let ratios = product_ratios(256, base, &grid);
        row(&format!("product, n = 256, base {base}"), "n³/(B√M)", largest(ratios.clone()), 5.5);
        if base == 1 {
            assert!(ratios.iter().all(|r| (r - 5.0).abs() < 0.01), "{ratios:?}");
        }
    }
    let ratios = product_ratios(200, 1, &grid);
    row("product, n = 200, rows off borders", "n³/(B√M)", largest(ratios), 16.0);
}

/// Slope of log misses over log M by least squares.
fn exponent(b: usize, memories: &[usize], run: impl FnOnce(&mut StackDistances)) -> f64 {
    let mut distances = StackDistances::new(b * WORD).expect("a power of two");
    run(&mut distances);
    assert_eq!(distances.unannounced(), 0);
    let points: Vec<(f64, f64)> = memories
        .iter()
        .map(|&m| ((m as f64).log2(), (distances.misses(m * WORD) as f64).log2()))
        .collect();
    let mean =
        |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x) * (p.0 - x))
}

fn strassen_exponent(n: usize, b: usize, memories: &[usize]) -> f64 {
    let slope = exponent(b, memories, |probe| {
        let (a, c) = (vec![1.0; n * n], &mut vec![0.0; n * n]);
        strassen_instrumented(&a, &a, c, n, 1, probe).expect("square");
    });
    let name = format!("Strassen, n = {n}, B = {b}, exponent");
    let formula = format!("-0.404 ± 0.046, M = {}..{}", memories[0], memories[memories.len() - 1]);
    row(&name, &formula, -slope, 0.45);
    assert!(-slope >= 0.36, "{slope}");
    slope
}

/// The exponent of M is −(lg 7/2 − 1) = −0.404 and not −1/2; the sums of n² terms, which fall away for M near n², make
/// the slope of finite sizes a little steeper. The classic product has −1/2 by the same fit.
#[test]
fn strassen_has_the_exponent_of_the_lower_bound() {
    let memories = [16, 32, 64, 128, 256];
    let slope = strassen_exponent(64, 1, &memories);
    let classic = exponent(1, &memories, |probe| product(64, 1, probe));
    row("product, n = 64, B = 1, exponent", "-0.5 ± 0.03", -classic, 0.53);
    assert!(classic < -0.47 && classic < slope, "{classic}, {slope}");
}

#[test]
#[ignore = "seconds even when optimized"]
fn strassen_comes_closer_to_it_with_n() {
    let slopes = [128, 256].map(|n| strassen_exponent(n, 1, &[32, 64, 128, 256, 512]));
    assert!(slopes.is_sorted(), "{slopes:?}");
    strassen_exponent(256, 4, &[256, 512, 1024]);
}

/// The last term is that of the columns of pivots, in a memory that holds a line of each row.
#[test]
fn lu_keeps_the_bound() {
    let (n, grid) = (128, [(1024, 4), (1024, 8), (4096, 8)]);
    let found = misses(&grid, |probe| {
        let words = numbers(n * n, 3);
        let mut a: Vec<f64> = words.into_iter().map(|word| (word >> 11) as f64).collect();
        lu_instrumented(&mut a, n, n, probe).expect("square");
    });
    let ratios = found.iter().zip(grid).map(|(q, (m, b))| {
        let (n, m, b) = (n as f64, m as f64, b as f64);
        q / (n.powi(3) / (b * m.sqrt()) + n * n / b * n.log2())
    });
    row("LU factors, n = 128", "n³/(B√M) + (n²/B)·lg n", largest(ratios), 1.0);
}

/// Points have two words.
#[test]
fn transforms_keep_the_bound() {
    let (n, grid) = (1 << 14, [(1024, 8), (4096, 8), (4096, 32), (16_384, 32)]);
    let found = misses(&grid, |probe| {
        let mut signal: Vec<[f64; 2]> =
            numbers(n, 5).into_iter().map(|word| [(word >> 11) as f64, 1.0]).collect();
        fft_instrumented(&mut signal, Direction::Forward, probe).expect("a power of two");
    });
    let words = 2.0 * n as f64;
    let ratios = found
        .iter()
        .zip(grid)
        .map(|(q, (m, b))| q / (words / b as f64 * (1.0 + log(m as f64, words))));
    row("Fourier transform, n = 16384", "(2n/B)(1 + log_M 2n)", largest(ratios), 6.0);
}
