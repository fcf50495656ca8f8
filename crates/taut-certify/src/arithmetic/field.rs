//! Numbers that can also be divided: one factorization serves plain and doubled precision.

use super::double_double::{U, two_product, two_sum};
use super::ring::{DoubleDouble, Ring};

/// The operations of linear algebra. Each operation is off by at most `ROUNDOFF` of its result, but for underflow.
pub(crate) trait Field: Ring + Copy {
    const ROUNDOFF: f64;
    fn of(value: f64) -> Self;
    /// a − b.
    fn difference(a: f64, b: f64) -> Self;
    fn over(&self, other: &Self) -> Self;
    /// The root of a number that is not negative.
    fn root(&self) -> Self;
    /// The product with a power of two, exactly.
    fn scaled(&self, power: f64) -> Self;
    /// The nearest `f64`, or a neighbor of it.
    fn rounded(&self) -> f64;
}

impl Field for f64 {
    const ROUNDOFF: f64 = U;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    #[inline(always)]
    fn difference(a: f64, b: f64) -> Self {
        a - b
    }

    #[inline(always)]
    fn over(&self, other: &Self) -> Self {
        self / other
    }

    #[inline(always)]
    fn root(&self) -> Self {
        self.sqrt()
    }

    #[inline(always)]
    fn scaled(&self, power: f64) -> Self {
        self * power
    }

    #[inline(always)]
    fn rounded(&self) -> f64 {
        *self
    }
}

/// With u = 2⁻⁵³, a quotient of high parts is off by less than 4u and a root by less than 3u; one step of correction
/// with a residual that is right to 8u² leaves less than 32u². The bound is twice that.
impl Field for DoubleDouble {
    const ROUNDOFF: f64 = 64.0 * U * U;

    #[inline(always)]
    fn of(value: f64) -> Self {
        DoubleDouble { high: value, low: 0.0 }
    }

    #[inline(always)]
    fn difference(a: f64, b: f64) -> Self {
        DoubleDouble::difference(a, b)
    }

    fn over(&self, other: &Self) -> Self {
        let first = self.high / other.high;
        let rest = self.minus(&other.times(&Self::of(first)));
        let (high, low) = two_sum(first, rest.high / other.high);
        DoubleDouble { high, low }
    }

    fn root(&self) -> Self {
        if self.high <= 0.0 {
            return Self::of(0.0);
        }
        let first = self.high.sqrt();
        let (square, error) = two_product(first, first);
        let rest = self.minus(&DoubleDouble { high: square, low: error });
        let (high, low) = two_sum(first, rest.high / (2.0 * first));
        DoubleDouble { high, low }
    }

    #[inline(always)]
    fn scaled(&self, power: f64) -> Self {
        DoubleDouble { high: self.high * power, low: self.low * power }
    }

    #[inline(always)]
    fn rounded(&self) -> f64 {
        self.high
    }
}

/// The pivots of M = L·D·Lᵀ for a symmetric matrix; `false` when one of them is not positive.
///
/// `lower` holds the lower triangle row by row; it becomes L below the diagonal and D on it. The factors are those of
/// a matrix whose entries differ from M by at most (n + 4)·2·`ROUNDOFF`·|L|·D·|Lᵀ|, which, where all pivots are
/// positive, has a norm of at most (n + 4)·4·`ROUNDOFF`·tr M (Higham, Accuracy and Stability of Numerical Algorithms,
/// section 10.1). Costs n³/3 operations.
pub(crate) fn factorize<N: Field>(lower: &mut [N], n: usize) -> bool {
    let start = |row: usize| row * (row + 1) / 2;
    let mut products = vec![N::of(0.0); n];
    for i in 0..n {
        let (above, row) = lower.split_at_mut(start(i));
        let mut pivot = row[i];
        for j in 0..i {
            let other = &above[start(j)..=start(j) + j];
            let mut value = row[j];
            for (product, entry) in products[..j].iter().zip(other) {
                value = value.minus(&product.times(entry));
            }
            products[j] = value;
            row[j] = value.over(&other[j]);
            pivot = pivot.minus(&value.times(&row[j]));
        }
        row[i] = pivot;
        let is_positive = pivot.rounded() > 0.0 && pivot.rounded().is_finite();
        if !is_positive {
            return false;
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use num_rational::BigRational;
    use num_traits::{Signed, ToPrimitive};
    use proptest::prelude::*;

    use super::*;

    fn exact(value: &DoubleDouble) -> BigRational {
        BigRational::from_float(value.high).unwrap() + BigRational::from_float(value.low).unwrap()
    }

    fn number() -> impl Strategy<Value = DoubleDouble> {
        (1e-9f64..1e9, -1.0f64..1.0).prop_map(|(high, part)| {
            let (high, low) = two_sum(high, high * part * U / 2.0);
            DoubleDouble { high, low }
        })
    }

    /// |found − true| / true.
    fn off(found: &BigRational, truth: &BigRational) -> f64 {
        ((found - truth) / truth).abs().to_f64().unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn quotients_and_roots_keep_their_bounds(a in number(), b in number()) {
            let quotient = exact(&a.over(&b));
            prop_assert!(off(&quotient, &(exact(&a) / exact(&b))) <= DoubleDouble::ROUNDOFF / 2.0);
            let root = exact(&a.root());
            prop_assert!(off(&(&root * &root), &exact(&a)) <= DoubleDouble::ROUNDOFF);
        }
    }

    #[test]
    fn a_matrix_is_factorized_and_an_indefinite_one_refused() {
        // The lower triangle of L·D·Lᵀ for L = [1; 2 1; 3 4 1] and D = (2, 3, 5).
        let mut matrix = [2.0, 4.0, 11.0, 6.0, 24.0, 71.0].map(DoubleDouble::of);
        assert!(factorize(&mut matrix, 3));
        assert_eq!(matrix.map(|value| value.rounded()), [2.0, 2.0, 3.0, 3.0, 4.0, 5.0]);
        assert!(!factorize(&mut [1.0, 2.0, 4.0], 2));
        assert!(!factorize(&mut [1.0, f64::NAN, 4.0], 2));
    }
}
