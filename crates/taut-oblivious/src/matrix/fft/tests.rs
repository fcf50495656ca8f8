use super::*;
use proptest::prelude::*;

fn points(n: usize, seed: u64) -> Vec<Complex64> {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    };
    (0..n).map(|_| Complex64::new(random(), random())).collect()
}

fn norm(a: impl Iterator<Item = Complex64>) -> f64 {
    a.map(|z| z.norm_sqr()).sum::<f64>().sqrt()
}

fn difference(a: &[Complex64], b: &[Complex64]) -> f64 {
    norm(a.iter().zip(b).map(|(x, y)| x - y)) / norm(b.iter().copied())
}

/// The definition, with every angle computed.
fn plain(signal: &[Complex64], direction: Direction) -> Vec<Complex64> {
    let n = signal.len();
    let sign = if direction == Direction::Forward { -1.0 } else { 1.0 };
    let turns: Vec<Complex64> = (0..n)
        .map(|e| Complex64::cis(sign * std::f64::consts::TAU * (e as f64 / n as f64)))
        .collect();
    (0..n).map(|k| (0..n).map(|j| signal[j] * turns[j * k % n]).sum()).collect()
}

fn two_passes(
    signal: &[Complex64],
    factors: (usize, usize),
    direction: Direction,
) -> Vec<Complex64> {
    let mut spectrum = vec![Complex64::default(); signal.len()];
    passes(&mut signal.to_vec(), &mut spectrum, factors, direction, &mut NoProbe);
    spectrum
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 30 }))]
    #[test]
    fn two_passes_equal_the_definition(n1 in 1..if cfg!(miri) { 6 } else { 40usize }, more in 0..if cfg!(miri) { 4 } else { 30usize }, seed: u64, forward: bool) {
        let direction = if forward { Direction::Forward } else { Direction::Inverse };
        let signal = points(n1 * (n1 + more), seed);
        let found = two_passes(&signal, (n1, n1 + more), direction);
        let expected = plain(&signal, direction);
        prop_assert!(difference(&found, &expected) <= 1e-13);
    }
}

/// Wherever in a line of the cache a matrix begins, its columns are taken once.
#[test]
fn blocks_cut_the_columns() {
    let matrix = points(40, 3);
    for skip in 0..5 {
        for columns in (1..35).step_by(if cfg!(miri) { 11 } else { 1 }) {
            let taken: Vec<usize> = blocks(&matrix[skip..], columns).flatten().collect();
            assert_eq!(taken, (0..columns).collect::<Vec<_>>());
        }
    }
}

#[test]
fn any_length() {
    for n in [0, 1, 2, 3, 7, 8, 9, 64, 97].into_iter().filter(|&n| !cfg!(miri) || n < 10) {
        let signal = points(n, 5);
        let mut spectrum = vec![Complex64::default(); n];
        fft(&mut signal.clone(), &mut spectrum, Direction::Forward).unwrap();
        assert!(n == 0 || difference(&spectrum, &plain(&signal, Direction::Forward)) <= 1e-14);
    }
    assert!(fft(&mut points(4, 1), &mut points(5, 1), Direction::Forward).is_err());
    assert_eq!(factors(1 << 20), Some((1 << 10, 1 << 10)));
    assert_eq!(factors(1_000_003), None);
}

/// Forward and back gives n·x, and a wave has one line, both within the stated error.
#[test]
#[cfg_attr(miri, ignore = "large")]
fn long_signals_within_the_stated_error() {
    for n in [1 << 17, 3 * 65_536] {
        let signal = points(n, 11);
        let (mut spectrum, mut back) = (signal.clone(), signal.clone());
        fft(&mut signal.clone(), &mut spectrum, Direction::Forward).unwrap();
        fft(&mut spectrum, &mut back, Direction::Inverse).unwrap();
        back.iter_mut().for_each(|z| *z /= n as f64);
        let bound = 1e-15 * (n as f64).log2();
        assert!(difference(&back, &signal) <= 2.0 * bound, "{n}: {:e}", difference(&back, &signal));

        let line = n / 3 + 5;
        let turn = |j: usize| (j as u128 * line as u128 % n as u128) as f64 / n as f64;
        let mut wave: Vec<Complex64> =
            (0..n).map(|j| Complex64::cis(std::f64::consts::TAU * turn(j))).collect();
        fft(&mut wave, &mut spectrum, Direction::Forward).unwrap();
        let mut expected = vec![Complex64::default(); n];
        expected[line] = Complex64::from(n as f64);
        // The wave itself is rounded, by half a unit in each part.
        assert!(difference(&spectrum, &expected) <= bound + f64::EPSILON, "{n}");
    }
}
