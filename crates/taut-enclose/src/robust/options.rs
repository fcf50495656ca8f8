//! The options of robust ellipsoids.

use taut_certify::{RobustMethod, RobustScale};
use taut_points::{InputError, Monitor, check_threads, shown_number};

use crate::Error;

/// Options to estimate. Write `RobustOptions { method: RobustMethod::Mve, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct RobustOptions<'a> {
    /// The quantity to minimize. Default [`RobustMethod::Mcd`].
    pub method: RobustMethod,
    /// About which part α of the points is kept; the answer bears that the others are anything. `None`, the default, is
    /// 0.5 for `mcd` and `mve`, 0.9 for `trim`.
    ///
    /// By `mcd` and `mve`, in [0.5, 1]: h = ⌊2k − n + 2(n − k)α⌋ with k = ⌊(n + d + 1)/2⌋, which is k at 0.5, where most
    /// outliers are borne, and n at 1, where nothing is robust: the classical mean and covariance, the smallest
    /// ellipsoid around all points. By `trim`, in (0, 1]: h = ⌈αn⌉.
    pub coverage: Option<f64>,
    /// The part of normal points that the tolerance ellipsoid is to hold. Range [0.5, 1), default 0.975. Not looked at
    /// by `trim`.
    pub level: f64,
    /// The part of normal points from whose covariance that of all is concluded after outliers were weighed out. Default
    /// [`RobustScale::Share`]. Not looked at by `trim`.
    pub scale: RobustScale,
    /// Wanted gap of the smallest ellipsoids of `mve` and `trim`, as in
    /// [`EllipsoidOptions::epsilon`](crate::EllipsoidOptions::epsilon). Range (0, 0.01], default 1e-9: around a
    /// looser ellipsoid a local optimum cannot be told.
    pub epsilon: f64,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

/// Largest gap of the smallest ellipsoids for which a local optimum can be told; the checker refuses a larger one.
const EPSILON_MAX: f64 = 0.01;

impl Default for RobustOptions<'_> {
    fn default() -> Self {
        RobustOptions {
            method: RobustMethod::default(),
            coverage: None,
            level: 0.975,
            scale: RobustScale::default(),
            epsilon: 1e-9,
            threads: None,
            monitor: Monitor::silent(),
        }
    }
}

impl RobustOptions<'_> {
    pub(crate) fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| {
            Err(Error::Input(InputError::Option { name, value, expected }))
        };
        let (inside, expected) = match (self.method, self.coverage) {
            (_, None) => (true, ""),
            (RobustMethod::Trim, Some(part)) => (part > 0.0 && part <= 1.0, "a number in (0, 1]"),
            (_, Some(part)) => ((0.5..=1.0).contains(&part), "a number in [0.5, 1]"),
        };
        if !inside {
            return wrong("coverage", shown_number(self.coverage.unwrap_or(0.0)), expected);
        }
        if !(0.5..1.0).contains(&self.level) {
            return wrong("level", shown_number(self.level), "a number in [0.5, 1)");
        }
        if !(self.epsilon > 0.0 && self.epsilon <= EPSILON_MAX) {
            return wrong("epsilon", shown_number(self.epsilon), "a number in (0, 0.01]");
        }
        if let Some(threads) = self.threads
            && let Err(refused) = check_threads(threads)
        {
            return wrong("threads", threads.to_string(), refused.expected);
        }
        Ok(())
    }

    /// h for n points in dimension d.
    pub(super) fn kept(&self, n: usize, dim: usize) -> usize {
        let wanted = match (self.method, self.coverage) {
            (RobustMethod::Trim, part) => (part.unwrap_or(0.9) * n as f64).ceil() as usize,
            (_, part) => {
                let half = least(n, dim);
                let more = 2.0 * (n - half) as f64 * part.unwrap_or(0.5);
                (2.0 * half as f64 - n as f64 + more).floor() as usize
            }
        };
        wanted.clamp(1, n)
    }
}

/// ⌊(n + d + 1)/2⌋, but no more than n: the h that bears most outliers.
pub(super) fn least(n: usize, dim: usize) -> usize {
    (n + dim).div_ceil(2).min(n)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_points_kept_are_between_half_and_all() {
        let kept = |method, coverage, n, dim| {
            RobustOptions { method, coverage, ..Default::default() }.kept(n, dim)
        };
        assert_eq!(kept(RobustMethod::Mcd, None, 75, 3), 39);
        assert_eq!(kept(RobustMethod::Mcd, Some(0.75), 75, 3), 57);
        assert_eq!(kept(RobustMethod::Mve, Some(1.0), 75, 3), 75);
        assert_eq!(kept(RobustMethod::Mcd, None, 3, 10), 3);
        assert_eq!(kept(RobustMethod::Trim, None, 101, 3), 91);
        assert_eq!(kept(RobustMethod::Trim, Some(1e-9), 101, 3), 1);
    }
}
