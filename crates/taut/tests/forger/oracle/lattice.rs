//! Coordinates as whole numbers of one power of two, so that every sign and every comparison is exact.

use num_bigint::BigInt;
use num_traits::Zero;

/// The points of an input, in units of 2^`exponent`.
pub(super) struct Lattice {
    pub(super) points: Vec<Vec<BigInt>>,
    /// Every coordinate is a whole number of 2^`exponent`.
    pub(super) exponent: i32,
}

impl Lattice {
    /// The rows of `values`, all of which must be finite.
    pub(super) fn of(values: &[f64], columns: usize) -> Self {
        let parts: Vec<(BigInt, i32)> = values.iter().map(|&x| parts(x)).collect();
        let exponents = parts.iter().filter(|(m, _)| !m.is_zero()).map(|&(_, e)| e);
        let exponent = exponents.min().unwrap_or(0);
        let whole = |(m, e): &(BigInt, i32)| match m.is_zero() {
            true => BigInt::zero(),
            false => m << (e - exponent) as u32,
        };
        let points = parts.chunks(columns).map(|row| row.iter().map(whole).collect()).collect();
        Lattice { points, exponent }
    }
}

/// A finite number as mantissa · 2^exponent.
pub(super) fn parts(x: f64) -> (BigInt, i32) {
    let bits = x.to_bits();
    let field = (bits >> 52 & 0x7ff) as i32;
    let fraction = (bits & ((1 << 52) - 1)) as i64;
    let mantissa = if field == 0 { fraction } else { fraction | 1 << 52 };
    // Trailing zeros would only make the whole numbers longer.
    let zeros = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
    let signed = if x.is_sign_negative() { -(mantissa >> zeros) } else { mantissa >> zeros };
    (BigInt::from(signed), field.max(1) - 1075 + zeros as i32)
}

/// b − a, coordinate by coordinate.
pub(super) fn difference(b: &[BigInt], a: &[BigInt]) -> Vec<BigInt> {
    b.iter().zip(a).map(|(b, a)| b - a).collect()
}

/// The scalar product.
pub(super) fn dot(a: &[BigInt], b: &[BigInt]) -> BigInt {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The determinant of a square matrix of one to three rows, by expansion along the first.
pub(super) fn determinant(rows: &[Vec<BigInt>]) -> BigInt {
    match rows {
        [] => BigInt::from(1),
        [a] => a[0].clone(),
        [a, b] => &a[0] * &b[1] - &a[1] * &b[0],
        [a, rest @ ..] => (0..rows.len())
            .map(|k| {
                let minor: Vec<Vec<BigInt>> = rest
                    .iter()
                    .map(|row| {
                        let others = row.iter().enumerate().filter(|&(column, _)| column != k);
                        others.map(|(_, x)| x.clone()).collect()
                    })
                    .collect();
                let term = &a[k] * determinant(&minor);
                if k.is_multiple_of(2) { term } else { -term }
            })
            .sum(),
    }
}
