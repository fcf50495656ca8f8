//! Strassen's multiplication: seven products of half the size for eight.
//!
//! *Problem.* C = A·B for square matrices, in rows.
//! *Idea.* M₁ = (A₁₁ + A₂₂)(B₁₁ + B₂₂), M₂ = (A₂₁ + A₂₂)B₁₁, M₃ = A₁₁(B₁₂ − B₂₂), M₄ = A₂₂(B₂₁ − B₁₁),
//! M₅ = (A₁₁ + A₁₂)B₂₂, M₆ = (A₂₁ − A₁₁)(B₁₁ + B₁₂), M₇ = (A₁₂ − A₂₂)(B₂₁ + B₂₂), and C₁₁ = M₁ + M₄ − M₅ + M₇,
//! C₁₂ = M₃ + M₅, C₂₁ = M₂ + M₄, C₂₂ = M₁ − M₂ + M₃ + M₆.
//! *Guarantee.* O(1 + n²/B + n^lg 7/(B·M^(lg 7/2 − 1))) misses in a tall cache. The error is bounded by the product of
//! the norms of A and B, not element by element as that of [`multiply()`](super::multiply()).
//! *Trap.* The thesis prints n^lg 7/(B√M): the exponent of M is lg 7/2 − 1 = 0.404, which the lower bound confirms.
//! *Trap.* Sizes that are no power of two times `base` are filled up with zeros, here once and for all.
//! *Reference.* Strassen, Numerische Mathematik 13, 1969; Ballard, Demmel, Holtz, Schwartz, J. ACM 59(6), 2012 (the bound).

use super::{check_base, check_length, get, set};
use crate::{Error, NoProbe, Probe};

/// Writes A·B into C, all n × n; pieces of `base` × `base` or smaller are multiplied by the definition.
///
/// # Errors
/// [`Error::Option`] if an array has another length or `base` is 0.
pub fn strassen(a: &[f64], b: &[f64], c: &mut [f64], n: usize, base: usize) -> Result<(), Error> {
    strassen_instrumented(a, b, c, n, base, &mut NoProbe)
}

/// [`strassen()`] under a probe.
///
/// # Errors
/// As there.
pub fn strassen_instrumented<P: Probe>(
    a: &[f64],
    b: &[f64],
    c: &mut [f64],
    n: usize,
    base: usize,
    probe: &mut P,
) -> Result<(), Error> {
    check_length("a", a.len(), n, n)?;
    check_length("b", b.len(), n, n)?;
    check_length("c", c.len(), n, n)?;
    check_base(base)?;
    probe.place(a);
    probe.place(b);
    probe.place(c);
    let mut levels = 0;
    while n.div_ceil(1 << levels) > base {
        levels += 1;
    }
    let full = n.div_ceil(1 << levels) << levels;
    if full == n {
        product(View::of(a, n), View::of(b, n), c, n, n, levels, probe);
        return Ok(());
    }
    let (a, b) = (widened(a, n, full, probe), widened(b, n, full, probe));
    let mut wide = vec![0.0; full * full];
    probe.place(&wide);
    product(View::of(&a, full), View::of(&b, full), &mut wide, full, full, levels, probe);
    for i in 0..n {
        for j in 0..n {
            let element = get(&wide, i * full + j, probe);
            set(c, i * n + j, element, probe);
        }
    }
    for array in [&a, &b, &wide] {
        probe.lift(array);
    }
    Ok(())
}

/// A matrix with zeros to its right and below.
fn widened<P: Probe>(matrix: &[f64], n: usize, full: usize, probe: &mut P) -> Vec<f64> {
    let mut wide = vec![0.0; full * full];
    probe.place(&wide);
    probe.write(&wide);
    for i in 0..n {
        for j in 0..n {
            let element = get(matrix, i * n + j, probe);
            set(&mut wide, i * full + j, element, probe);
        }
    }
    wide
}

/// A square piece of a matrix.
#[derive(Clone, Copy)]
struct View<'a> {
    elements: &'a [f64],
    stride: usize,
}

impl<'a> View<'a> {
    fn of(elements: &'a [f64], stride: usize) -> Self {
        Self { elements, stride }
    }

    /// Quadrant 0 (left, above), 1 (right, above), 2 (left, below) or 3, of h × h.
    fn quadrant(self, number: usize, h: usize) -> Self {
        Self { elements: &self.elements[corner(number, h, self.stride)..], stride: self.stride }
    }
}

/// Where a quadrant of h × h begins.
fn corner(number: usize, h: usize, stride: usize) -> usize {
    (number / 2) * h * stride + (number % 2) * h
}

/// A quadrant with its sign.
type Term = (usize, f64);

/// The seven products: quadrants of A, of B, and where the product goes in C. M₁ comes first for C₁₁ and C₂₂, M₂ for
/// C₂₁, M₃ for C₁₂.
const PRODUCTS: [(&[Term], &[Term], &[Term]); 7] = [
    (&[(0, 1.0), (3, 1.0)], &[(0, 1.0), (3, 1.0)], &[(0, 1.0), (3, 1.0)]),
    (&[(2, 1.0), (3, 1.0)], &[(0, 1.0)], &[(2, 1.0), (3, -1.0)]),
    (&[(0, 1.0)], &[(1, 1.0), (3, -1.0)], &[(1, 1.0), (3, 1.0)]),
    (&[(3, 1.0)], &[(2, 1.0), (0, -1.0)], &[(0, 1.0), (2, 1.0)]),
    (&[(0, 1.0), (1, 1.0)], &[(3, 1.0)], &[(0, -1.0), (1, 1.0)]),
    (&[(2, 1.0), (0, -1.0)], &[(0, 1.0), (1, 1.0)], &[(3, 1.0)]),
    (&[(1, 1.0), (3, -1.0)], &[(2, 1.0), (3, 1.0)], &[(0, 1.0)]),
];

/// c = a·b, all n × n with n = 2^levels times the size of a leaf.
fn product<P: Probe>(
    a: View<'_>,
    b: View<'_>,
    c: &mut [f64],
    c_stride: usize,
    n: usize,
    levels: usize,
    probe: &mut P,
) {
    if levels == 0 {
        for i in 0..n {
            for j in 0..n {
                let sum = (0..n).fold(0.0, |sum, k| {
                    let x = get(a.elements, i * a.stride + k, probe);
                    sum + x * get(b.elements, k * b.stride + j, probe)
                });
                set(c, i * c_stride + j, sum, probe);
            }
        }
        return;
    }
    let h = n / 2;
    let mut scratch = [(); 3].map(|()| vec![0.0; h * h]);
    for array in &scratch {
        probe.place(array);
    }
    let [s, t, m] = &mut scratch;
    let mut begun = [false; 4];
    for (left, right, targets) in PRODUCTS {
        let left = combined(a, left, s, h, probe);
        let right = combined(b, right, t, h, probe);
        product(left, right, m, h, h, levels - 1, probe);
        for &(quadrant, sign) in targets {
            let first = !std::mem::replace(&mut begun[quadrant], true);
            let at = corner(quadrant, h, c_stride);
            for i in 0..h {
                for j in 0..h {
                    let place = at + i * c_stride + j;
                    let before = if first { 0.0 } else { get(c, place, probe) };
                    let value = before + sign * get(m, i * h + j, probe);
                    set(c, place, value, probe);
                }
            }
        }
    }
    for array in &scratch {
        probe.lift(array);
    }
}

/// The sum or difference of two quadrants, put into `sum`; a single quadrant is taken where it lies.
fn combined<'a, P: Probe>(
    matrix: View<'a>,
    terms: &[Term],
    sum: &'a mut [f64],
    h: usize,
    probe: &mut P,
) -> View<'a> {
    let [(first, _), (second, sign)] = *terms else { return matrix.quadrant(terms[0].0, h) };
    let (x, y) = (matrix.quadrant(first, h), matrix.quadrant(second, h));
    for i in 0..h {
        for j in 0..h {
            let value = get(x.elements, i * x.stride + j, probe)
                + sign * get(y.elements, i * y.stride + j, probe);
            set(sum, i * h + j, value, probe);
        }
    }
    View::of(sum, h)
}
