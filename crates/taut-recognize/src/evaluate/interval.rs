//! Intervals for rates of independent trials, and warnings where there are too few.
//!
//! *Idea.* The interval of Clopper and Pearson holds all rates under which neither so many errors nor so few would be a rare event. Its
//! ends are quantiles of beta distributions, found by halving on the incomplete beta function.
//! *Reference.* Clopper and Pearson, Biometrika 26, 1934; the continued fraction: Press et al., Numerical Recipes, 6.4.

use std::fmt;

use taut_points::shown_number;

use crate::Error;

/// Terms of the continued fraction, which ends long before for any counts of a 64-bit machine's memory.
const TERMS_MAX: usize = 100_000;
/// Halvings after which an interval in [0, 1] has no more digits to give.
const HALVINGS: usize = 1100;
/// Errors that the rule of 30 asks for (Doddington et al., 2000).
const ERRORS_FOR_30_PERCENT: u64 = 30;

/// An interval of rates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

/// Why a rate is not to be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum RateWarning {
    /// No error in all trials: the rule of 3.
    NoError {
        /// Trials.
        trials: u64,
        /// The rate may be up to this, with a confidence of 95 %: 3 divided by the trials.
        rate_max: f64,
    },
    /// Fewer than 30 errors: the rule of 30.
    FewErrors {
        /// Errors.
        errors: u64,
    },
    /// No trial at all.
    NoTrial,
}

impl fmt::Display for RateWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            RateWarning::NoError { trials, rate_max } => write!(
                f,
                "no error in {trials} trials: the rate may be up to {} (rule of 3, confidence 95 %)",
                shown_number((rate_max * 1e4).round() / 1e4)
            ),
            RateWarning::FewErrors { errors } => write!(
                f,
                "{errors} errors: 30 are needed to know the rate to within 30 % of itself (rule of 30, confidence 90 %)"
            ),
            RateWarning::NoTrial => f.write_str("no trial: there is no rate"),
        }
    }
}

/// Says what is doubtful about a rate of `errors` among `trials` that do not depend on each other.
pub fn warnings(errors: u64, trials: u64) -> Option<RateWarning> {
    match (errors, trials) {
        (_, 0) => Some(RateWarning::NoTrial),
        (0, trials) => {
            let rate_max = (3.0 / trials as f64).min(1.0);
            Some(RateWarning::NoError { trials, rate_max })
        }
        (errors, _) if errors < ERRORS_FOR_30_PERCENT => Some(RateWarning::FewErrors { errors }),
        _ => None,
    }
}

/// The interval of Clopper and Pearson for a rate of `errors` among `trials` that do not depend on each other.
///
/// ```
/// let found = taut_recognize::evaluate::clopper_pearson(0, 100, 0.95)?;
/// assert!(found.low == 0.0 && (found.high - 0.036216).abs() < 1e-6);
/// # Ok::<(), taut_recognize::Error>(())
/// ```
///
/// # Errors
/// [`taut_points::InputError::Option`] for more errors than trials, no trial, or a confidence that is not between 0 and 1.
pub fn clopper_pearson(errors: u64, trials: u64, confidence: f64) -> Result<Interval, Error> {
    if errors > trials || trials == 0 {
        return Err(Error::option(
            "errors",
            errors.to_string(),
            "at most the trials, of which there is one",
        ));
    }
    check_confidence(confidence)?;
    let tail = (1.0 - confidence) / 2.0;
    let (k, n) = (errors as f64, trials as f64);
    let low = if errors == 0 { 0.0 } else { beta_quantile(tail, k, n - k + 1.0) };
    let high = if errors == trials { 1.0 } else { beta_quantile(1.0 - tail, k + 1.0, n - k) };
    Ok(Interval { low, high })
}

pub(super) fn check_confidence(confidence: f64) -> Result<(), Error> {
    match confidence > 0.0 && confidence < 1.0 {
        true => Ok(()),
        false => {
            let expected = "a number above 0 and below 1";
            Err(Error::option("confidence", shown_number(confidence), expected))
        }
    }
}

/// The x with I_x(a, b) = p.
fn beta_quantile(p: f64, a: f64, b: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = low + (high - low) / 2.0;
        if middle <= low || middle >= high {
            break;
        }
        if incomplete_beta(middle, a, b) < p { low = middle } else { high = middle }
    }
    low + (high - low) / 2.0
}

/// The regularized incomplete beta function I_x(a, b).
fn incomplete_beta(x: f64, a: f64, b: f64) -> f64 {
    let front = |x: f64, a: f64, b: f64| {
        (log_gamma(a + b) - log_gamma(a) - log_gamma(b) + a * x.ln() + b * (-x).ln_1p()).exp() / a
    };
    // The fraction is the quicker on this side, and the function symmetric.
    if x <= (a + 1.0) / (a + b + 2.0) {
        front(x, a, b) * fraction(x, a, b)
    } else {
        1.0 - front(1.0 - x, b, a) * fraction(1.0 - x, b, a)
    }
}

/// The continued fraction of the incomplete beta function, by the method of Lentz.
fn fraction(x: f64, a: f64, b: f64) -> f64 {
    let bounded =
        |value: f64| if value.abs() < f64::MIN_POSITIVE { f64::MIN_POSITIVE } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / bounded(1.0 - (a + b) * x / (a + 1.0));
    let mut value = d;
    for m in 1..TERMS_MAX {
        let m = m as f64;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / bounded(1.0 + even * d);
        c = bounded(1.0 + even / c);
        value *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / bounded(1.0 + odd * d);
        c = bounded(1.0 + odd / c);
        let factor = d * c;
        value *= factor;
        if (factor - 1.0).abs() <= f64::EPSILON {
            break;
        }
    }
    value
}

/// The logarithm of the gamma function for x ≥ 1, by Stirling's series after shifting x above 15.
fn log_gamma(x: f64) -> f64 {
    let (mut x, mut shift) = (x, 0.0);
    while x < 15.0 {
        shift += x.ln();
        x += 1.0;
    }
    let inverse = 1.0 / (x * x);
    // Bernoulli numbers over 2k(2k − 1); the term after is below 1e-16.
    let series = 1.0 / 12.0
        - inverse
            * (1.0 / 360.0
                - inverse * (1.0 / 1260.0 - inverse * (1.0 / 1680.0 - inverse / 1188.0)));
    (x - 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + series / x - shift
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_incomplete_beta_function_is_a_binomial_tail() {
        // I_x(k, n − k + 1) = Σ_{j ≥ k} C(n, j) xʲ(1 − x)ⁿ⁻ʲ.
        for n in [1u32, 2, 7, 30] {
            for x in [0.01f64, 0.3, 0.5, 0.97] {
                let term = |j: u32| {
                    let choose: f64 = (0..j).map(|i| f64::from(n - i) / f64::from(i + 1)).product();
                    choose * x.powi(j as i32) * (1.0 - x).powi((n - j) as i32)
                };
                for k in 1..=n {
                    let tail: f64 = (k..=n).map(term).sum();
                    let found = incomplete_beta(x, f64::from(k), f64::from(n - k + 1));
                    assert!((found - tail).abs() < 1e-13, "{n} {k} {x}: {found} {tail}");
                }
            }
        }
    }

    #[test]
    fn the_gamma_function_is_the_factorial() {
        let mut factorial = 0.0;
        for n in 1..60 {
            assert!((log_gamma(f64::from(n)) - factorial).abs() < 1e-13 * (1.0 + factorial), "{n}");
            factorial += f64::from(n).ln();
        }
    }
}
