//! The stages for the predicates that are asked less often, from the filter on, for any polynomial.
//!
//! *Idea.* First by the value alone: no permanent exceeds the one of ones times the largest difference, as rounded, to the degree. Then
//! the permanent rides along with the value. In `f64` it bounds the error; where all differences are whole
//! multiples of one unit it bounds every intermediate number, so that `i128` is exact if it is below 2¹²⁶: ties of
//! gridded data are cheap here, too. Then double-double, and integers of any length.
//! *Guarantee.* The error of the `f64` value is below [`Polynomial::ROUNDINGS`]·u·permanent, as proved at the filter of
//! the plane; underflow stays below 2⁻⁶⁵⁰, as shown for double-double.

use crate::number::{Difference, Measured, Polynomial};
use crate::sign::Sign;
use crate::{double_double, unbounded, wide};

/// The exact sign of the polynomial at these differences.
#[inline]
pub(crate) fn sign<P: Polynomial<K>, const K: usize>(differences: &[Difference; K]) -> Sign {
    coarse::<P, K>(differences)
        .or_else(|| filtered::<P, K>(differences))
        .unwrap_or_else(|| exact::<P, K>(differences))
}

/// By the `f64` value and the largest difference: half the work, and enough where points are in no special position.
#[inline(always)]
fn coarse<P: Polynomial<K>, const K: usize>(differences: &[Difference; K]) -> Option<Sign> {
    let d = differences.map(|[from, less]| from - less);
    coarse_sign::<P, K>(P::evaluate(&d), largest(&d))
}

/// The largest magnitude.
#[inline(always)]
pub(crate) fn largest(differences: &[f64]) -> f64 {
    differences.iter().fold(0.0, |most: f64, d| if d.abs() > most { d.abs() } else { most })
}

/// The sign of the polynomial, if its `f64` value at differences of no more than this magnitude is beyond doubt.
#[inline(always)]
pub(crate) fn coarse_sign<P: Polynomial<K>, const K: usize>(
    value: f64,
    largest: f64,
) -> Option<Sign> {
    let ones = P::evaluate(&[Measured { value: 1.0, permanent: 1.0 }; K]).permanent;
    let power = (1..P::DEGREE).fold(largest, |power, _| power * largest);
    // The product of at most eight equal factors is less than 8u too small, which the 1 more than the roundings makes up for many times.
    let bound = (f64::from(P::ROUNDINGS) + 1.0) * (f64::EPSILON / 2.0) * ones * power;
    let is_within = largest <= double_double::DIFFERENCE_MAX;
    (is_within && value.abs() > bound + double_double::UNDERFLOW_ERROR).then(|| Sign::from(value))
}

/// By the `f64` value and its permanent.
#[inline(always)]
fn filtered<P: Polynomial<K>, const K: usize>(differences: &[Difference; K]) -> Option<Sign> {
    let d = differences.map(|[from, less]| from - less);
    if !d.iter().fold(true, |within, d| within & (d.abs() <= double_double::DIFFERENCE_MAX)) {
        return None;
    }
    let leaves = d.map(|d| Measured { value: d, permanent: d.abs() });
    let Measured { value, permanent } = P::evaluate(&leaves);
    let bound =
        f64::from(P::ROUNDINGS) * (f64::EPSILON / 2.0) * permanent + double_double::UNDERFLOW_ERROR;
    (value.abs() > bound).then(|| Sign::from(value))
}

#[cold]
#[inline(never)]
fn exact<P: Polynomial<K>, const K: usize>(differences: &[Difference; K]) -> Sign {
    in_128_bits::<P, K>(differences)
        .or_else(|| double_double::sign::<P, K>(differences))
        .unwrap_or_else(|| unbounded::sign::<P, K>(differences))
}

/// In `i128`, if that has room for the permanent, where no difference counts for less than 1: so no factor of zero hides
/// how large the other one is. Its relative error is far below the one bit to spare.
#[inline(always)]
fn in_128_bits<P: Polynomial<K>, const K: usize>(differences: &[Difference; K]) -> Option<Sign> {
    const PERMANENT_MAX: f64 = (1u128 << 126) as f64;
    let integers = wide::integers(differences)?;
    let unit = integers.iter().fold(0, |all, d| all | d).trailing_zeros();
    let integers = integers.map(|d| d >> unit);
    let Measured { permanent, .. } = P::evaluate(
        &integers.map(|d| Measured { value: 0.0, permanent: (d as f64).abs().max(1.0) }),
    );
    (permanent < PERMANENT_MAX).then(|| Sign::from(P::evaluate(&integers.map(i128::from))))
}
