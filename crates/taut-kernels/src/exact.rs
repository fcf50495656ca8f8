//! Squared distances in double-double arithmetic, for the few rows that decide an answer.
//!
//! *Idea.* A value is an unevaluated sum of two `f64`, about 106 bits (Dekker 1971; error-free sums after Knuth,
//! error-free products by fused multiply-add). Eight independent accumulators let the compiler use full registers.
//! *Guarantee.* The relative error of a squared distance is below (d + 8)·2⁻¹⁰⁰: nothing, beside the 2⁻⁵³ of what
//! is printed.

use std::ops::{Add, Div, Mul, Sub};

#[cfg(target_arch = "x86_64")]
use taut_points::{InstructionSet, instruction_set, two_to};

use crate::Center;

/// An unevaluated sum `high + low` with |low| ≤ ulp(high)/2.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DoubleDouble {
    /// The nearest `f64`.
    pub high: f64,
    /// The part that it leaves out.
    pub low: f64,
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
    pub const ZERO: DoubleDouble = DoubleDouble { high: 0.0, low: 0.0 };

    /// a + b, exactly.
    #[inline(always)]
    pub fn sum(a: f64, b: f64) -> Self {
        let (high, low) = two_sum(a, b);
        DoubleDouble { high, low }
    }

    /// a·b, exactly.
    #[inline(always)]
    pub fn product(a: f64, b: f64) -> Self {
        let (high, low) = two_product(a, b);
        DoubleDouble { high, low }
    }

    /// self².
    #[inline(always)]
    pub fn square(self) -> Self {
        self * self
    }

    /// √self, one Newton step from the root of the high part; 0 for what is not positive.
    pub fn sqrt(self) -> Self {
        if self.high <= 0.0 {
            return Self::ZERO;
        }
        let root = self.high.sqrt();
        Self::sum(root, (self - Self::product(root, root)).high / (2.0 * root))
    }

    /// The smallest `f64` that is not below this.
    pub fn round_up(self) -> f64 {
        if self.low > 0.0 { self.high.next_up() } else { self.high }
    }
}

impl Add for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (s, e) = two_sum(self.high, other.high);
        let (t, f) = two_sum(self.low, other.low);
        let (s, e) = two_sum(s, e + t);
        Self::sum(s, e + f)
    }
}

impl Sub for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + DoubleDouble { high: -other.high, low: -other.low }
    }
}

impl Mul for DoubleDouble {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let (p, e) = two_product(self.high, other.high);
        Self::sum(p, e + (self.high * other.low + self.low * other.high))
    }
}

/// The divisor must not be 0.
impl Div for DoubleDouble {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        Self::sum(first, second) + (rest.high / other.high).into()
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

/// Returns true if a number is not 0, but so small that the error of its square is no `f64` any more.
#[inline(always)]
pub fn vanishes(value: f64) -> bool {
    /// 2⁻⁴⁵⁰.
    const BOUND: f64 = two_to(-450);
    (value != 0.0) & (value.abs() < BOUND)
}

/// x − c, coordinate by coordinate, each as an exact sum of three `f64`, times a power of two.
#[derive(Clone, Debug, Default)]
pub struct Difference {
    high: Vec<f64>,
    low: Vec<f64>,
    tail: Vec<f64>,
    /// True if scaling or squaring loses digits at the lower end of the range of `f64`. What is lost is far less than
    /// one unit of the last place of anything near 1.
    pub vanishes: bool,
}

impl Difference {
    /// (x − c)·scale. A scale below 1 belongs to points so far apart that differences would overflow: it comes first.
    pub fn new(x: &[f64], center: &Center, scale: f64) -> Self {
        let mut difference = Difference {
            high: vec![0.0; x.len()],
            low: vec![0.0; x.len()],
            tail: center.low.iter().map(|tail| -tail * scale).collect(),
            vanishes: false,
        };
        difference.tail.resize(x.len(), -0.0);
        #[cfg(target_arch = "x86_64")]
        if instruction_set() >= InstructionSet::Avx2 {
            // SAFETY: the processor has both features.
            #[allow(unsafe_code)]
            unsafe {
                fill_with_fma(&mut difference, x, &center.high, scale)
            };
            return difference;
        }
        fill(&mut difference, x, &center.high, scale);
        difference
    }

    /// The number of coordinates.
    pub fn dim(&self) -> usize {
        self.high.len()
    }

    /// Coordinate j in double-double.
    #[inline(always)]
    pub fn coordinate(&self, j: usize) -> DoubleDouble {
        DoubleDouble { high: self.high[j], low: self.low[j] } + self.tail[j].into()
    }

    /// The squared length in double-double.
    pub fn squared(&self) -> DoubleDouble {
        #[cfg(target_arch = "x86_64")]
        if instruction_set() >= InstructionSet::Avx2 {
            // SAFETY: the processor has both features.
            #[allow(unsafe_code)]
            return unsafe { squared_with_fma(self) };
        }
        squared(self)
    }

    /// sumⱼ ← sumⱼ + weight·(x − c)ⱼ in double-double, for the first coordinates, as many as there are sums. O(d).
    ///
    /// # Panics
    /// If there are more sums than coordinates.
    pub fn add_times(&self, weight: DoubleDouble, sums: &mut [DoubleDouble]) {
        #[cfg(target_arch = "x86_64")]
        if instruction_set() >= InstructionSet::Avx2 {
            // SAFETY: the processor has both features.
            #[allow(unsafe_code)]
            unsafe {
                add_times_with_fma(self, weight, sums)
            };
            return;
        }
        add_times(self, weight, sums);
    }

    /// Returns true if its length is at most reach − r ≥ 0, decided exactly, for the ties that double-double cannot tell.
    ///
    /// Both squares are written out as sums of products, each product as two `f64` without error, and the sum of all
    /// is kept as an expansion whose last component has its sign (Shewchuk 1997, theorem 10). Exact unless it
    /// [`vanishes`](Self::vanishes).
    pub fn is_within(&self, reach: f64, r: f64) -> bool {
        let mut expansion = Vec::new();
        let mut add_square = |terms: &[f64], sign: f64| {
            for (i, &a) in terms.iter().enumerate() {
                for (k, &b) in terms.iter().enumerate().skip(i) {
                    let (product, error) = two_product(a, b);
                    let times = if i == k { sign } else { 2.0 * sign };
                    grow(&mut expansion, times * product);
                    grow(&mut expansion, times * error);
                }
            }
        };
        let (high, low) = two_sum(reach, -r);
        add_square(&[high, low], 1.0);
        for j in 0..self.high.len() {
            add_square(&[self.high[j], self.low[j], self.tail[j]], -1.0);
        }
        expansion.last().is_none_or(|&sign| sign > 0.0)
    }
}

/// Does what [`fill`] does, in wider vectors.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn fill_with_fma(difference: &mut Difference, x: &[f64], center: &[f64], scale: f64) {
    fill(difference, x, center, scale);
}

/// Sets all but the tails.
#[inline(always)]
fn fill(difference: &mut Difference, x: &[f64], center: &[f64], scale: f64) {
    let (before, after) = if scale < 1.0 { (scale, 1.0) } else { (1.0, scale) };
    let mut lost = false;
    let terms = difference.high.iter_mut().zip(&mut difference.low).zip(&difference.tail);
    for ((&x, &c), ((high, low), &tail)) in x.iter().zip(center).zip(terms) {
        let (sum, error) = two_sum(x * before, -c * before);
        (*high, *low) = (sum * after, error * after);
        lost |= vanishes(*high) | vanishes(*low) | vanishes(tail);
    }
    // Times 1 nothing is flushed.
    if before != 1.0 {
        let is_flushed = |value: f64| value * before / before != value;
        lost |= x.iter().zip(center).any(|(&x, &c)| is_flushed(x) || is_flushed(c));
    }
    difference.vanishes = lost;
}

/// The same with the multiply-add as an instruction rather than a function call.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn add_times_with_fma(difference: &Difference, weight: DoubleDouble, sums: &mut [DoubleDouble]) {
    add_times(difference, weight, sums);
}

#[inline(always)]
fn add_times(difference: &Difference, weight: DoubleDouble, sums: &mut [DoubleDouble]) {
    for (j, sum) in sums.iter_mut().enumerate() {
        *sum = *sum + weight * difference.coordinate(j);
    }
}

/// The same with the multiply-add as an instruction rather than a function call.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn squared_with_fma(difference: &Difference) -> DoubleDouble {
    squared(difference)
}

#[inline(always)]
fn squared(difference: &Difference) -> DoubleDouble {
    // Sums are kept apart from what they lack: then eight of them fill two registers, where eight pairs would be taken one by one.
    let (mut high, mut low) = ([0.0; 8], [0.0; 8]);
    let parts = difference.high.as_chunks::<8>();
    let lows = difference.low.as_chunks::<8>();
    let tails = difference.tail.as_chunks::<8>();
    for ((h, l), t) in parts.0.iter().zip(lows.0).zip(tails.0) {
        for k in 0..8 {
            let coordinate = DoubleDouble { high: h[k], low: l[k] } + t[k].into();
            let sum = DoubleDouble { high: high[k], low: low[k] } + coordinate.square();
            (high[k], low[k]) = (sum.high, sum.low);
        }
    }
    for (k, ((&h, &l), &t)) in parts.1.iter().zip(lows.1).zip(tails.1).enumerate() {
        let coordinate = DoubleDouble { high: h, low: l } + t.into();
        let sum = DoubleDouble { high: high[k], low: low[k] } + coordinate.square();
        (high[k], low[k]) = (sum.high, sum.low);
    }
    let sums = high.into_iter().zip(low).map(|(high, low)| DoubleDouble { high, low });
    sums.fold(DoubleDouble::ZERO, DoubleDouble::add)
}

/// Adds b to an expansion of components that do not overlap, smallest first; no component is 0.
fn grow(expansion: &mut Vec<f64>, b: f64) {
    let mut carry = b;
    expansion.retain_mut(|component| {
        let (sum, error) = two_sum(carry, *component);
        carry = sum;
        *component = error;
        error != 0.0
    });
    if carry != 0.0 {
        expansion.push(carry);
    }
}
