//! Squared distances in double-double arithmetic, for the few rows that decide an answer.
//!
//! *Idea.* A value is an unevaluated sum of two `f64`, about 106 bits (Dekker 1971; error-free sums after Knuth,
//! error-free products by fused multiply-add). Eight independent accumulators let the compiler use full registers.
//! *Guarantee.* The relative error of a squared distance is below (d + 8)·2⁻¹⁰⁰: nothing, beside the 2⁻⁵³ of what
//! is printed.

use super::Center;

/// An unevaluated sum `high + low` with |low| ≤ ulp(high)/2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct DoubleDouble {
    /// The nearest `f64`.
    pub(crate) high: f64,
    /// What it leaves out.
    pub(crate) low: f64,
}

/// a + b = sum + error exactly (Knuth).
#[inline(always)]
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// a·b = product + error exactly.
#[inline(always)]
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    (product, a.mul_add(b, -product))
}

impl DoubleDouble {
    /// Zero.
    pub(crate) const ZERO: DoubleDouble = DoubleDouble { high: 0.0, low: 0.0 };

    /// a + b, exactly.
    #[inline(always)]
    pub(crate) fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        DoubleDouble { high, low }
    }

    /// a·b, exactly.
    #[inline(always)]
    pub(crate) fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product(a, b);
        DoubleDouble { high, low }
    }

    #[inline(always)]
    pub(crate) fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let (s, e) = two_sum(s, e + t);
        Self::sum(s, e + f)
    }

    #[inline(always)]
    pub(crate) fn sub(self, other: Self) -> Self {
        self.add(DoubleDouble { high: -other.high, low: -other.low })
    }

    #[inline(always)]
    pub(crate) fn mul(self, other: Self) -> Self {
        let (p, e) = two_product(self.high, other.high);
        Self::sum(p, e + (self.high * other.low + self.low * other.high))
    }

    #[inline(always)]
    pub(crate) fn square(self) -> Self {
        self.mul(self)
    }

    /// self / other; other must not be 0.
    pub(crate) fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self.sub(other.mul(first.into()));
        let second = rest.high / other.high;
        let rest = rest.sub(other.mul(second.into()));
        Self::sum(first, second).add((rest.high / other.high).into())
    }

    /// √self, one Newton step from the root of the high part; 0 for what is not positive.
    pub(crate) fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        let root = self.high.sqrt();
        Self::sum(root, self.sub(Self::product(root, root)).high / (2.0 * root))
    }

    /// The smallest `f64` that is not below this.
    pub(crate) fn round_up(self) -> f64 {
        if self.low > 0.0 { self.high.next_up() } else { self.high }
    }
}

impl From<f64> for DoubleDouble {
    #[inline(always)]
    fn from(value: f64) -> Self {
        DoubleDouble { high: value, low: 0.0 }
    }
}

impl PartialOrd for DoubleDouble {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(std::cmp::Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

/// |x − c|² in double-double.
pub(crate) fn exact_squared_distance(x: &[f64], center: &Center) -> DoubleDouble {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        // SAFETY: the processor has just been asked for both features.
        #[allow(unsafe_code)]
        return unsafe { with_fma(x, center) };
    }
    squared_distance(x, center)
}

/// The same with the multiply-add as an instruction rather than a function call.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn with_fma(x: &[f64], center: &Center) -> DoubleDouble {
    squared_distance(x, center)
}

#[inline(always)]
fn squared_distance(x: &[f64], center: &Center) -> DoubleDouble {
    let term = |j: usize| {
        let low = if center.low.is_empty() { 0.0 } else { center.low[j] };
        DoubleDouble::sum(x[j], -center.high[j]).sub(low.into()).square()
    };
    let mut sums = [DoubleDouble::ZERO; 8];
    let whole = x.len() / 8 * 8;
    for j in (0..whole).step_by(8) {
        for (k, sum) in sums.iter_mut().enumerate() {
            *sum = sum.add(term(j + k));
        }
    }
    for j in whole..x.len() {
        sums[j - whole] = sums[j - whole].add(term(j));
    }
    sums.into_iter().fold(DoubleDouble::ZERO, DoubleDouble::add)
}
