//! Numbers that can be added and multiplied: one formula for a determinant serves every precision.

use super::double_double::two_sum;

/// What a determinant is made of.
pub(crate) trait Ring: Clone {
    fn plus(&self, other: &Self) -> Self;
    fn minus(&self, other: &Self) -> Self;
    fn times(&self, other: &Self) -> Self;
}

impl Ring for f64 {
    #[inline(always)]
    fn plus(&self, other: &f64) -> f64 {
        self + other
    }

    #[inline(always)]
    fn minus(&self, other: &f64) -> f64 {
        self - other
    }

    #[inline(always)]
    fn times(&self, other: &f64) -> f64 {
        self * other
    }
}

/// Callers see to it that nothing overflows.
impl Ring for i128 {
    #[inline(always)]
    fn plus(&self, other: &i128) -> i128 {
        self + other
    }

    #[inline(always)]
    fn minus(&self, other: &i128) -> i128 {
        self - other
    }

    #[inline(always)]
    fn times(&self, other: &i128) -> i128 {
        self * other
    }
}

/// high + low with |low| ≤ u·|high|: a number of about 106 bits.
///
/// Sums are off by at most 4u² of the result and products by at most 5u², with u = 2⁻⁵³ (Joldes, Muller, Popescu, ACM
/// Trans. Math. Softw. 44(2), 2017: AccurateDWPlusDW and DWTimesDW1), but for what underflows: less than 2⁻¹⁰⁷⁰.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleDouble {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

/// a + b = sum + error exactly, where |a| ≥ |b| or a = 0.
#[inline(always)]
fn fast_two_sum(a: f64, b: f64) -> DoubleDouble {
    let high = a + b;
    DoubleDouble { high, low: b - (high - a) }
}

/// The error of the product where the processor has a fused multiply-add, and where it has none.
#[inline(always)]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    if cfg!(target_feature = "fma") {
        let product = a * b;
        return (product, a.mul_add(b, -product));
    }
    super::double_double::two_product(a, b)
}

impl DoubleDouble {
    /// a − b, exactly.
    #[inline(always)]
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, -b);
        DoubleDouble { high, low }
    }
}

impl Ring for DoubleDouble {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let (sum, error) = two_sum(self.high, other.high);
        let (low, rest) = two_sum(self.low, other.low);
        let sum = fast_two_sum(sum, error + low);
        fast_two_sum(sum.high, sum.low + rest)
    }

    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        self.plus(&DoubleDouble { high: -other.high, low: -other.low })
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let (product, error) = two_product(self.high, other.high);
        let cross = self.high * other.low + self.low * other.high;
        fast_two_sum(product, error + cross)
    }
}
