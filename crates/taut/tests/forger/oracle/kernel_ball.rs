//! Balls in the feature space of a kernel, in fractions.
//!
//! *Decided.* Squared distances of all rows from the center, the objective of the answer, and the lower bound D/s of its multipliers,
//! exactly but for the exponential function, which is found to 2⁻²⁰⁰ of 1 − e^{−z}. What differs by less than 2⁻¹⁵⁰ is taken as equal: no
//! margin of the checker is so narrow. That D/s is a lower bound, is a theorem.

use std::collections::BTreeMap;

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::Solution;
use taut::certify::{Kernel, KernelBall, KernelBallVerdict};

use super::Truth;

/// Bits to which fractions are cut.
const BITS: i64 = 320;

/// Knows the truth about the balls of kernels of one input.
pub struct KernelBallOracle {
    rows: Vec<Vec<BigRational>>,
    /// ρ between all rows, by kernel.
    distances: BTreeMap<String, Vec<Vec<BigRational>>>,
}

fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).unwrap_or_else(BigRational::zero)
}

fn whole(x: u64) -> BigRational {
    BigRational::from_integer(BigInt::from(x))
}

fn power_of_two(exponent: i64) -> BigRational {
    let power = BigRational::from_integer(BigInt::one() << exponent.unsigned_abs());
    if exponent < 0 { power.recip() } else { power }
}

/// The number to [`BITS`] bits.
fn cut(x: &BigRational) -> BigRational {
    if x.is_zero() {
        return BigRational::zero();
    }
    let bits = x.numer().bits() as i64 - x.denom().bits() as i64;
    let scale = power_of_two(BITS - bits);
    (x * &scale).round() / scale
}

/// 1 − e^{−z}.
fn decay(z: &BigRational) -> BigRational {
    if z > &whole(2000) {
        return BigRational::one();
    }
    let z = cut(z);
    // (1 − e^{−y})/y by the series for y = z/2²⁴; the square of e^{−y} doubles y.
    let y = &z / power_of_two(24);
    let (mut term, mut sum) = (BigRational::one(), BigRational::zero());
    for k in 1..40u64 {
        sum += &term;
        term = cut(&(-term * &y / whole(k + 1)));
    }
    let mut less = cut(&(sum * y));
    for _ in 0..24 {
        less = cut(&(&less * (whole(2) - &less)));
    }
    less
}

impl KernelBallOracle {
    /// Holds rows of any length.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let rows = values.chunks_exact(columns).map(|row| row.iter().copied().map(exact).collect());
        KernelBallOracle { rows: rows.collect(), distances: BTreeMap::new() }
    }

    fn product(&self, kernel: Kernel, i: usize, j: usize) -> BigRational {
        let dot =
            || self.rows[i].iter().zip(&self.rows[j]).map(|(a, b)| a * b).sum::<BigRational>();
        match kernel {
            Kernel::Polynomial { gamma, offset, degree } => {
                let base = exact(gamma) * dot() + exact(offset);
                (1..degree).fold(base.clone(), |power, _| power * &base)
            }
            Kernel::Precomputed => self.rows[i][j].clone(),
            _ => dot(),
        }
    }

    fn distance(&self, kernel: Kernel, i: usize, j: usize) -> BigRational {
        if let Kernel::Gaussian { gamma } = kernel {
            let pairs = self.rows[i].iter().zip(&self.rows[j]);
            let square: BigRational = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
            return whole(2) * decay(&(exact(gamma) * square));
        }
        self.product(kernel, i, i) + self.product(kernel, j, j)
            - whole(2) * self.product(kernel, i, j)
    }

    /// Judges every claim of an accepted answer.
    pub fn judge(&mut self, found: &Solution<KernelBall>, verdict: &KernelBallVerdict) -> Truth {
        let ball = &found.answer;
        let n = self.rows.len();
        let wrong = |what: &str| Truth::False(what.to_owned());
        let support: Vec<usize> = ball.support.iter().map(|&id| id as usize).collect();
        if support.is_empty() || support.len() != ball.multipliers.len() {
            return wrong("the lists have no length, or different ones");
        }
        if support.iter().any(|&id| id >= n) || support.windows(2).any(|pair| pair[0] >= pair[1]) {
            return wrong("the support is no ascending list of rows");
        }
        if ball.multipliers.iter().any(|l| l.is_nan() || *l <= 0.0) {
            return wrong("a multiplier is not positive");
        }
        let key = format!("{:?}", ball.kernel);
        if !self.distances.contains_key(&key) {
            let row = |i: usize| (0..n).map(|j| self.distance(ball.kernel, i, j)).collect();
            let all = (0..n).map(row).collect();
            self.distances.insert(key.clone(), all);
        }
        let distances = &self.distances[&key];
        let lambda: Vec<BigRational> = ball.multipliers.iter().copied().map(exact).collect();
        let sum: BigRational = lambda.iter().sum();
        let mean = |k: usize| {
            let terms = support.iter().zip(&lambda).map(|(&i, l)| l * &distances[k][i]);
            terms.sum::<BigRational>() / &sum
        };
        let means: Vec<BigRational> = (0..n).map(mean).collect();
        let spread = support.iter().zip(&lambda).map(|(&i, l)| l * &means[i]).sum::<BigRational>()
            / (whole(2) * &sum);
        let squares: Vec<BigRational> = means.iter().map(|a| a - &spread).collect();
        let slightly = power_of_two(-150);
        let (more, less) = (BigRational::one() + &slightly, BigRational::one() - &slightly);
        let radius = exact(ball.squared_radius);
        let beyond = squares.iter().map(|square| square - &radius).filter(Signed::is_positive);
        let beyond: Vec<BigRational> = beyond.collect();
        let points = whole(n as u64);
        let (objective, excess) = match ball.nu {
            None if beyond.iter().any(|x| x > &(&slightly * &radius)) => {
                return wrong("a point is outside");
            }
            None => (radius.clone(), BigRational::one()),
            Some(nu) if !(nu > 0.0 && nu <= 1.0) => return wrong("ν is out of its range"),
            Some(nu) => {
                let most = exact(nu) * &points;
                let largest = lambda.iter().max().cloned().unwrap_or_else(BigRational::zero);
                let excess = (largest / &sum * &most).max(BigRational::one());
                (&radius + beyond.iter().sum::<BigRational>() / most, excess)
            }
        };
        let [lower, upper] = [verdict.lower, verdict.upper].map(exact);
        let gap = exact(verdict.gap);
        let count = squares.iter().filter(|&square| square > &(&radius * &less)).count();
        let claims = [
            (lower <= spread.max(BigRational::zero()) / excess * &more, "the lower bound is none"),
            (objective * &less <= upper, "the objective is larger"),
            (&upper * &less <= (&gap + BigRational::one()) * &lower, "the gap is larger"),
            (verdict.outside as usize <= count, "fewer points are outside"),
            (
                verdict.gap <= found.certificate.gap * 1.000_000_1 + 1e-15,
                "the gap claimed is smaller",
            ),
        ];
        let lie = claims.iter().find(|(holds, _)| !holds);
        Truth::claim(lie.is_none(), || lie.map_or(String::new(), |(_, lie)| (*lie).into()))
    }
}
