//! Sums and products to twice the precision of `f64`, each with a bound on what it is off by.
//!
//! *Idea.* The rounding error of a sum and of a product of two `f64` is itself an `f64` and can be computed. A
//! compensated sum adds the large parts exactly, that is with their errors caught, and adds the caught errors and
//! all other small terms in plain arithmetic.
//! *Guarantee.* With u = 2⁻⁵³, plain summation of k numbers, each formed with at most 8 roundings, is off by at most
//! γₖ₊₈ = (k + 8)u / (1 − (k + 8)u) times the sum of their sizes (Higham, Accuracy and Stability of Numerical
//! Algorithms, section 4.2). [`Compensated`] keeps that sum of sizes beside the sum and uses (k + 16)u times it:
//! the surplus 8u covers the denominator of γ for k < 10⁸, the roundings in the sum of sizes, and the rounding of the
//! bound itself. When no small term occurred, the sum is exact and the bound is 0.
//! *Trap.* The error of a product is an `f64` only while it does not underflow. Callers keep factors at 0 or at
//! 2⁻⁴⁸⁰ and above, or widen the bound. Overflow ends in infinities or NaN, which satisfy no comparison.
//! *Reference.* Dekker, Numer. Math. 18 (1971); Knuth, TAOCP 2, 4.2.2; Ogita, Rump, Oishi, SIAM J. Sci. Comput. 26(6),
//! 2005.

/// Unit roundoff: |fl(x) − x| ≤ U·|x| for every operation without underflow.
pub(crate) const U: f64 = f64::EPSILON / 2.0;

/// a + b = sum + error, exactly; also when the sum is subnormal.
#[inline(always)]
pub(crate) fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// Two parts of at most 26 bits, so that products of parts are exact.
#[inline(always)]
fn split(a: f64) -> (f64, f64) {
    const SPLITTER: f64 = ((1u64 << 27) + 1) as f64;
    let wide = SPLITTER * a;
    let high = wide - (wide - a);
    (high, a - high)
}

/// a·b = product + error, exactly unless something under- or overflows.
///
/// The processor's fused multiply-add would be shorter, but where it is missing it is emulated at many times the cost.
#[inline(always)]
pub(crate) fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

/// a² = square + error, exactly unless something under- or overflows.
#[inline(always)]
pub(crate) fn square(a: f64) -> (f64, f64) {
    let square = a * a;
    let (high, low) = split(a);
    (square, ((high * high - square) + 2.0 * high * low) + low * low)
}

/// A number known to lie within `error` of `high + low`, with |low| ≤ U·|high|.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) high: f64,
    pub(crate) low: f64,
    pub(crate) error: f64,
}

impl Known {
    /// A number that is not smaller than |self|.
    pub(crate) fn size(self) -> f64 {
        (self.high.abs() + self.error) * (1.0 + 8.0 * U)
    }
}

/// A sum in the making.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Compensated {
    /// The large terms, added in `f64`.
    pub(crate) sum: f64,
    /// The errors of that, and the small terms, added in `f64`.
    pub(crate) low: f64,
    /// Sum of the sizes of all that was added to `low`.
    pub(crate) size: f64,
    /// The number of numbers that were added to `low`, or more.
    pub(crate) steps: usize,
}

impl Compensated {
    /// Adds a number that is exact.
    #[inline(always)]
    pub(crate) fn add(&mut self, term: f64) {
        let (sum, error) = two_sum(self.sum, term);
        self.sum = sum;
        self.add_small(error, error.abs());
    }

    /// Adds a number that was formed with at most 8 roundings from terms whose sizes sum to `size`.
    #[inline(always)]
    pub(crate) fn add_small(&mut self, term: f64, size: f64) {
        self.low += term;
        self.size += size;
        self.steps += 1;
    }

    /// Adds a·b.
    #[inline(always)]
    pub(crate) fn add_product(&mut self, a: f64, b: f64) {
        let (product, error) = two_product(a, b);
        self.add(product);
        self.add_small(error, error.abs());
    }

    /// Adds sign·(high + low)², for a sign of 1 or −1.
    #[inline(always)]
    pub(crate) fn add_square(&mut self, sign: f64, high: f64, low: f64) {
        let (product, error) = square(high);
        self.add(sign * product);
        self.add_small(sign * error, error.abs());
        self.add_small(
            sign * (low * (2.0 * high + low)),
            low.abs() * (2.0 * high.abs() + low.abs()),
        );
    }

    /// Adds another sum.
    #[inline(always)]
    pub(crate) fn merge(&mut self, other: Compensated) {
        self.add(other.sum);
        self.add_small(other.low, other.size);
        self.steps += other.steps;
    }

    /// The sum of the negative terms.
    pub(crate) fn negated(self) -> Self {
        Compensated { sum: -self.sum, low: -self.low, ..self }
    }

    /// Returns what was summed up.
    pub(crate) fn known(self) -> Known {
        let (high, low) = two_sum(self.sum, self.low);
        // The least normal number makes up for a bound that underflows.
        let least = if self.size == 0.0 { 0.0 } else { f64::MIN_POSITIVE };
        Known { high, low, error: (self.steps + 16) as f64 * U * self.size + least }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_of_sums_and_products_are_caught() {
        assert_eq!(two_sum(1.0, 1e-30), (1.0, 1e-30));
        assert_eq!(two_sum(1e-30, 1.0), (1.0, 1e-30));
        let a = 1.0 + f64::EPSILON;
        // (1 + ε)² = 1 + 2ε + ε², of which ε² does not fit.
        assert_eq!(square(a), (1.0 + 2.0 * f64::EPSILON, f64::EPSILON * f64::EPSILON));
        assert_eq!(two_product(a, a), square(a));
        assert_eq!(two_product(a, 1.0 - f64::EPSILON), (1.0, -f64::EPSILON * f64::EPSILON));
    }

    #[test]
    fn cancellation_leaves_the_small_part() {
        let mut sum = Compensated::default();
        for term in [1e16, 1.0, -1e16, 1e-20] {
            sum.add(term);
        }
        let known = sum.known();
        assert_eq!(known.high, 1.0);
        assert!((known.low - 1e-20).abs() <= known.error && known.error < 1e-14);
    }

    #[test]
    fn a_sum_without_rounding_is_known_exactly() {
        let mut sum = Compensated::default();
        sum.add_square(1.0, 3.0, 0.0);
        sum.add_square(-1.0, 5.0, 0.0);
        sum.add_product(4.0, 4.0);
        let known = sum.known();
        assert_eq!((known.high, known.low, known.error), (0.0, 0.0, 0.0));
    }
}
