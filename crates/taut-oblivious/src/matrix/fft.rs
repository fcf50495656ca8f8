//! The discrete Fourier transform of long signals in two passes over memory.
//!
//! *Problem.* A transform of n points that does not fit a cache goes over memory log n / log M times, or with strides of
//! powers of two, if nothing is done about it.
//! *Idea.* n = n₁·n₂: the signal is a matrix of n₁ rows. First pass: columns, a few at a time, are brought together, get
//! transforms of length n₁, are turned by e^(∓2πi·j₂·k₁/n) and go back. Second pass: rows get transforms of length n₂ and go
//! to the columns of the answer. Both lengths fit the second cache, where a library transforms them.
//! *Guarantee.* Relative error in the Euclidean norm at most 10⁻¹⁵·log₂ n. Two reads and two writes of the signal; one miss
//! for each line as long as √n lines fit the cache.
//! *Trap.* Columns that lie a power of two apart share sets of the cache: those that were brought together lie a little
//! farther apart than they are long.
//! *Trap.* Angles: a table of n would be as long as the signal, and repeated multiplication loses digits. Two tables of √n,
//! each entry computed, give every angle with one product.
//! *Reference.* Frigo, Leiserson, Prokop, Ramachandran, *Cache-oblivious algorithms*, FOCS 1999; Bailey, *FFTs in external or
//! hierarchical memory*, 1990; thesis, table of section 5.8.

use std::ops::Range;
use std::sync::Arc;

use num_complex::Complex64;
use rustfft::{Fft, FftPlanner};

use super::transpose::tiles;
use crate::level::Level;
use crate::{Error, NoProbe, Probe};

#[cfg(test)]
mod tests;

/// The sign of the exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Σ xⱼ·e^(−2πijk/n).
    Forward,
    /// Σ xⱼ·e^(2πijk/n): forward and back gives n·x.
    Inverse,
}

/// Transforms of up to this many points fit the second cache: one transform of the library.
const DIRECT_POINTS_MAX: usize = 1 << 16;
/// This many columns, or rows, are brought together: two lines of the cache.
const GATHERED_COLUMNS: usize = 8;
/// Two columns that were brought together are this many points apart, beyond their length.
const COLUMN_PADDING: usize = 4;
/// Rows are fetched this many rows ahead.
const PREFETCH_ROWS: usize = 24;

/// Writes the transform of `signal` to `spectrum`; `signal` is used up.
///
/// Any length; those without two factors of similar size are left to the library at once. O(n log n), O(√n) memory beside
/// the two arrays.
///
/// # Errors
/// [`Error::Option`] if the lengths differ.
///
/// ```
/// use taut_oblivious::{Complex64, Direction, fft};
///
/// let mut signal = [1.0, 0.0, -1.0, 0.0].map(Complex64::from);
/// let mut spectrum = [Complex64::default(); 4];
/// fft(&mut signal, &mut spectrum, Direction::Forward)?;
/// assert_eq!(spectrum.map(|z| z.re), [0.0, 2.0, 0.0, 2.0]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
pub fn fft(
    signal: &mut [Complex64],
    spectrum: &mut [Complex64],
    direction: Direction,
) -> Result<(), Error> {
    fft_probed(signal, spectrum, direction, &mut NoProbe)
}

/// As [`fft`], and tells `probe` of rows, columns and what was brought together; a transform in the cache counts as one
/// read and one write of its points.
///
/// # Errors
/// As [`fft`].
pub fn fft_probed<P: Probe>(
    signal: &mut [Complex64],
    spectrum: &mut [Complex64],
    direction: Direction,
    probe: &mut P,
) -> Result<(), Error> {
    let n = signal.len();
    if spectrum.len() != n {
        let value = format!("{} for {n} points", spectrum.len());
        return Err(Error::Option { name: "spectrum", value, expected: "as many as the signal" });
    }
    probe.place(signal);
    probe.place(spectrum);
    match factors(n) {
        Some((n1, n2)) if n > DIRECT_POINTS_MAX => {
            passes(signal, spectrum, (n1, n2), direction, probe)
        }
        _ if n == 0 => {}
        _ => {
            let transform = plan(n, direction);
            probe.read(signal);
            let mut scratch = vec![Complex64::default(); transform.get_outofplace_scratch_len()];
            transform.process_outofplace_with_scratch(signal, spectrum, &mut scratch);
            probe.write(spectrum);
        }
    }
    probe.lift(spectrum);
    probe.lift(signal);
    Ok(())
}

/// The two factors closest to each other, if both are large.
fn factors(n: usize) -> Option<(usize, usize)> {
    let least = GATHERED_COLUMNS.max(n.isqrt() / 32);
    (least..=n.isqrt()).rev().find(|n1| n.is_multiple_of(*n1)).map(|n1| (n1, n / n1))
}

fn plan(n: usize, direction: Direction) -> Arc<dyn Fft<f64>> {
    let mut planner = FftPlanner::new();
    match direction {
        Direction::Forward => planner.plan_fft_forward(n),
        Direction::Inverse => planner.plan_fft_inverse(n),
    }
}

/// The two passes.
fn passes<P: Probe>(
    signal: &mut [Complex64],
    spectrum: &mut [Complex64],
    (n1, n2): (usize, usize),
    direction: Direction,
    probe: &mut P,
) {
    let turns = Turns::new(n1 * n2, direction);
    let (columns, rows) = (plan(n1, direction), plan(n2, direction));
    let scratch = columns.get_inplace_scratch_len().max(rows.get_inplace_scratch_len());
    let mut scratch = vec![Complex64::default(); scratch];
    let mut together = vec![Complex64::default(); GATHERED_COLUMNS * (n2 + COLUMN_PADDING)];
    probe.place(&together);

    let stride = n1 + COLUMN_PADDING;
    for block in blocks(signal, n2) {
        bring(signal, n2, block.clone(), (&mut together, stride), probe);
        for (j2, column) in block.clone().zip(together.chunks_mut(stride)) {
            columns.process_with_scratch(&mut column[..n1], &mut scratch);
            turns.turn(&mut column[..n1], j2);
            probe.read(&column[..n1]);
            probe.write(&column[..n1]);
        }
        back((&together, stride), signal, n2, block, probe);
    }
    let stride = n2 + COLUMN_PADDING;
    for block in blocks(spectrum, n1) {
        for (k1, row) in block.clone().zip(together.chunks_mut(stride)) {
            probe.read(&signal[k1 * n2..(k1 + 1) * n2]);
            row[..n2].copy_from_slice(&signal[k1 * n2..(k1 + 1) * n2]);
            rows.process_with_scratch(&mut row[..n2], &mut scratch);
            probe.write(&row[..n2]);
        }
        back((&together, stride), spectrum, n1, block, probe);
    }
    probe.lift(&together);
}

/// The columns of a matrix in groups that begin, where they can, with a line of the cache.
fn blocks(matrix: &[Complex64], columns: usize) -> impl Iterator<Item = Range<usize>> + use<> {
    let lead = (matrix.as_ptr().align_offset(64) % GATHERED_COLUMNS).min(columns);
    let rest = (lead..columns).step_by(GATHERED_COLUMNS);
    std::iter::once(0..lead)
        .chain(rest.map(move |begin| begin..columns.min(begin + GATHERED_COLUMNS)))
        .filter(|block| !block.is_empty())
}

/// Columns of a matrix become rows that lie together.
fn bring<P: Probe>(
    from: &[Complex64],
    columns: usize,
    block: Range<usize>,
    (to, stride): (&mut [Complex64], usize),
    probe: &mut P,
) {
    let level = Level::best();
    for (i, row) in from.chunks_exact(columns).enumerate() {
        if let Some(ahead) = from.get((i + PREFETCH_ROWS) * columns + block.start..) {
            tiles::fetch(level, &ahead[..block.len().min(ahead.len())]);
        }
        let part = &row[block.clone()];
        probe.read(part);
        for (c, &x) in part.iter().enumerate() {
            to[c * stride + i] = x;
            probe.write(&to[c * stride + i..=c * stride + i]);
        }
    }
}

/// Rows that lie together become columns of a matrix.
fn back<P: Probe>(
    (from, stride): (&[Complex64], usize),
    to: &mut [Complex64],
    columns: usize,
    block: Range<usize>,
    probe: &mut P,
) {
    let level = Level::best();
    let mut line = [Complex64::default(); GATHERED_COLUMNS];
    for (i, row) in to.chunks_exact_mut(columns).enumerate() {
        for (c, x) in line[..block.len()].iter_mut().enumerate() {
            *x = from[c * stride + i];
            probe.read(&from[c * stride + i..=c * stride + i]);
        }
        tiles::stream(level, &line[..block.len()], &mut row[block.clone()]);
        probe.write(&row[block.clone()]);
    }
    tiles::fence(level);
}

/// All angles ∓2π·e/n for e in 0..n as products of two table entries.
struct Turns {
    fine: Vec<Complex64>,
    coarse: Vec<Complex64>,
    bits: u32,
}

impl Turns {
    fn new(n: usize, direction: Direction) -> Self {
        let bits = n.isqrt().next_power_of_two().trailing_zeros();
        let full = match direction {
            Direction::Forward => -std::f64::consts::TAU,
            Direction::Inverse => std::f64::consts::TAU,
        };
        let at = |e: usize| Complex64::cis(full * (e as f64 / n as f64));
        let fine = (0..1 << bits).map(at).collect();
        let coarse = (0..=n >> bits).map(|k| at(k << bits)).collect();
        Self { fine, coarse, bits }
    }

    /// Multiplies point k by the angle of k·`step`.
    fn turn(&self, points: &mut [Complex64], step: usize) {
        let mask = (1 << self.bits) - 1;
        for (k, x) in points.iter_mut().enumerate() {
            let e = k * step;
            *x *= self.coarse[e >> self.bits] * self.fine[e & mask];
        }
    }
}
