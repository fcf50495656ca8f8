//! The discrete Fourier transform of a signal whose length is a power of two, by recursion on the square root.
//!
//! *Problem.* A transform of n points that goes through them log₂ n times misses n·log₂ n / B times once they do not fit.
//! *Idea.* n = n₁·n₂, both near √n: the signal is a matrix of n₁ rows. Transpose it, transform its n₂ rows of length n₁ in the same
//! way, multiply by the twiddle factors e^(∓2πi·j₂·k₁/n), transpose, transform n₁ rows of length n₂, transpose.
//! *Guarantee.* O((n/B)(1 + log_M n)) misses in a tall cache. Relative error in the Euclidean norm at most 10⁻¹⁵·log₂ n.
//! *Trap.* Twiddle factors by repeated multiplication lose digits: each is computed on its own, which is slow.
//! *Reference.* Frigo, Leiserson, Prokop, Ramachandran, *Cache-oblivious algorithms*, FOCS 1999; Bailey, *FFTs in external or
//! hierarchical memory*, 1990; thesis, table of section 5.8.

use std::f64::consts::TAU;

use super::transpose::transpose_within;
use super::{get, set};
use crate::{Error, NoProbe, Probe};

/// Real and imaginary part.
type Complex = [f64; 2];

/// The sign of the exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// Σ xⱼ·e^(−2πijk/n).
    Forward,
    /// Σ xⱼ·e^(2πijk/n): forward and back gives n·x.
    Inverse,
}

/// Replaces a signal of complex numbers, real and imaginary part, by its transform. O(n log n), memory for n numbers.
///
/// ```
/// use taut_reference::algorithms::{Direction, fft};
///
/// let mut signal = [1.0, 0.0, -1.0, 0.0].map(|x| [x, 0.0]);
/// fft(&mut signal, Direction::Forward)?;
/// assert_eq!(signal.map(|[re, _]| re.round()), [0.0, 2.0, 0.0, 2.0]);
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
///
/// # Errors
/// [`Error::Option`] if the length is no power of two.
pub fn fft(signal: &mut [Complex], direction: Direction) -> Result<(), Error> {
    fft_instrumented(signal, direction, &mut NoProbe)
}

/// [`fft()`] under a probe.
///
/// # Errors
/// As there.
pub fn fft_instrumented<P: Probe>(
    signal: &mut [Complex],
    direction: Direction,
    probe: &mut P,
) -> Result<(), Error> {
    if !signal.len().is_power_of_two() {
        let value = format!("{} points", signal.len());
        return Err(Error::Option { name: "signal", value, expected: "a power of two of points" });
    }
    let turn = if direction == Direction::Forward { -TAU } else { TAU };
    let mut scratch = vec![[0.0; 2]; signal.len()];
    probe.place(signal);
    probe.place(&scratch);
    transform(signal, &mut scratch, turn, probe);
    probe.lift(&scratch);
    Ok(())
}

/// Transforms x; `scratch` has the same length, and `turn` is ∓2π.
fn transform<P: Probe>(x: &mut [Complex], scratch: &mut [Complex], turn: f64, probe: &mut P) {
    let n = x.len();
    if n <= 2 {
        if n == 2 {
            let ([a, b], [c, d]) = (get(x, 0, probe), get(x, 1, probe));
            set(x, 0, [a + c, b + d], probe);
            set(x, 1, [a - c, b - d], probe);
        }
        return;
    }
    let n1 = 1 << n.ilog2().div_ceil(2);
    let n2 = n / n1;
    transpose_within(x, scratch, n1, n2, probe);
    for (j2, (row, free)) in scratch.chunks_mut(n1).zip(x.chunks_mut(n1)).enumerate() {
        transform(row, free, turn, probe);
        for k1 in 0..n1 {
            let (sin, cos) = (turn * (j2 * k1) as f64 / n as f64).sin_cos();
            let [a, b] = get(row, k1, probe);
            set(row, k1, [a * cos - b * sin, a * sin + b * cos], probe);
        }
    }
    transpose_within(scratch, x, n2, n1, probe);
    for (row, free) in x.chunks_mut(n2).zip(scratch.chunks_mut(n2)) {
        transform(row, free, turn, probe);
    }
    transpose_within(x, scratch, n1, n2, probe);
    for k in 0..n {
        let element = get(scratch, k, probe);
        set(x, k, element, probe);
    }
}
