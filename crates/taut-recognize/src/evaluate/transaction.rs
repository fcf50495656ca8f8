//! Rates of transactions, in which an attempt may give no features at all.

use taut_points::shown_number;

use crate::Error;

/// Rates of attempts by people at a system.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TransactionRates {
    /// FAR = FMR·(1 − FTA).
    pub far: f64,
    /// FRR = FTA + FNMR·(1 − FTA).
    pub frr: f64,
    /// GFAR = FAR·(1 − FTE), with the people who could not be enrolled.
    pub generalized_far: f64,
    /// GFRR = FTE + (1 − FTE)·FRR.
    pub generalized_frr: f64,
}

impl TransactionRates {
    /// From rates of comparisons, the failure to acquire, and the failure to enroll.
    ///
    /// # Errors
    /// [`taut_points::InputError::Option`] for a rate out of [0, 1].
    pub fn new(fmr: f64, fnmr: f64, fta: f64, fte: f64) -> Result<Self, Error> {
        for (name, rate) in [("fmr", fmr), ("fnmr", fnmr), ("fta", fta), ("fte", fte)] {
            if !(0.0..=1.0).contains(&rate) {
                return Err(Error::option(name, shown_number(rate), "a rate from 0 to 1"));
            }
        }
        let (far, frr) = (fmr * (1.0 - fta), fta + fnmr * (1.0 - fta));
        let generalized_far = far * (1.0 - fte);
        let generalized_frr = fte + (1.0 - fte) * frr;
        Ok(TransactionRates { far, frr, generalized_far, generalized_frr })
    }
}
