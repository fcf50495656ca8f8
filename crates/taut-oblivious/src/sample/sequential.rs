//! k of n without replacement, in order, one by one.
//!
//! *Idea.* The distance to the next number is drawn by itself. Its distribution is nearly that of a power of a uniform
//! number; draw from this one and reject some (method D). Where k is not small against n, walk instead (method A).
//! *Guarantee.* O(k) expected time in all, O(1) room. Exact up to the rounding of `ln` and `exp`, and so the same on all
//! machines only where these are.
//! *Trap.* The power that a rejection leaves over must be used for the next draw, and no other: else the numbers are not
//! independent of the rejection.
//! *Reference.* J. S. Vitter, *An efficient algorithm for sequential random sampling*, TOMS 13(1), 1987 (algorithm D with
//! method A where n < 13 k).

use super::random::Random;
use crate::error::Error;

/// Below this many numbers for each that is to be drawn, walking is faster than drawing distances.
const WALK_BELOW: u64 = 13;

/// An iterator over `k` different numbers below `n`, in order.
#[derive(Clone, Debug)]
pub struct Sequential {
    random: Random,
    /// The first number that is still free.
    next: u64,
    /// Free numbers.
    n: u64,
    /// Numbers still to be drawn.
    k: u64,
    /// U^(1/k), left over or drawn ahead.
    power: Option<f64>,
}

impl Sequential {
    /// Starts a sample.
    ///
    /// # Errors
    /// [`Error::Option`] if `k` is more than `n`, or `n` more than 2⁵³, which double precision cannot count.
    pub fn new(seed: u64, n: u64, k: u64) -> Result<Self, Error> {
        let wrong = |name, value: u64, expected| {
            Err(Error::Option { name, value: value.to_string(), expected })
        };
        if n > 1 << 53 {
            return wrong("n", n, "at most 2^53");
        }
        if k > n {
            return wrong("k", k, "at most the number of those to choose from");
        }
        Ok(Self { random: Random::new(seed, 0), next: 0, n, k, power: None })
    }

    /// U^(1/k) for a fresh U.
    fn power(&mut self, k: f64) -> f64 {
        (self.random.unit().ln() / k).exp()
    }

    /// Returns how many numbers to leave out, by method A: P(S ≥ s) = Π (n − k − i) / (n − i) over i < s.
    fn walk(&mut self) -> u64 {
        let (mut rest, mut top) = (self.n as f64, (self.n - self.k) as f64);
        let lot = self.random.unit();
        let mut left_out = 0;
        let mut quotient = top / rest;
        while quotient >= lot {
            left_out += 1;
            top -= 1.0;
            rest -= 1.0;
            quotient *= top / rest;
        }
        left_out
    }

    /// Returns how many numbers to leave out, by method D.
    fn leap(&mut self) -> u64 {
        let (n, k) = (self.n as f64, self.k as f64);
        let free = n - k + 1.0;
        let mut power = match self.power.take() {
            Some(power) => power,
            None => self.power(k),
        };
        loop {
            let (x, s) = loop {
                let x = n * (1.0 - power);
                let s = x.floor();
                if s < free {
                    break (x, s);
                }
                power = self.power(k);
            };
            // The quick test. Where it holds, what it leaves over is a power for the next draw.
            let y = ((self.random.unit() * n / free).ln() / (k - 1.0)).exp();
            let rest = y * (1.0 - x / n) * (free / (free - s));
            if rest <= 1.0 {
                self.power = Some(rest);
                return s as u64;
            }
            // The exact one, for min(s, k − 1) factors.
            let (mut top, mut product) = (n - 1.0, 1.0);
            let (mut bottom, limit) =
                if k - 1.0 > s { (n - k, n - s) } else { (n - s - 1.0, free) };
            while top >= limit {
                product *= top / bottom;
                top -= 1.0;
                bottom -= 1.0;
            }
            if n / (n - x) >= y * (product.ln() / (k - 1.0)).exp() {
                return s as u64;
            }
            power = self.power(k);
        }
    }
}

impl Iterator for Sequential {
    type Item = u64;

    fn next(&mut self) -> Option<u64> {
        let left_out = match self.k {
            0 => return None,
            1 => self.random.below(self.n),
            k if self.n / WALK_BELOW < k => self.walk(),
            _ => self.leap(),
        };
        let found = self.next + left_out;
        self.next = found + 1;
        self.n -= left_out + 1;
        self.k -= 1;
        Some(found)
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        match usize::try_from(self.k) {
            Ok(k) => (k, Some(k)),
            Err(_) => (usize::MAX, None),
        }
    }
}
