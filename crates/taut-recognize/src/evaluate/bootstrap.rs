//! Intervals by drawing people again.
//!
//! *Idea.* Comparisons of one person depend on each other, so people are what is drawn, with replacement, each with all her items. The
//! quantiles of the statistic over many such draws are an interval for it.
//! *Trap.* With few people the interval is too narrow, and none of a statistic that is 0 in the data is wider than 0: see
//! [`clopper_pearson`](super::clopper_pearson) there.
//! *Reference.* Efron and Tibshirani, An introduction to the bootstrap, 1993; Bolle, Ratha and Pankanti, CVIU 93, 2004.

use std::collections::BTreeMap;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use taut_points::parallel::IntoParallel;

use super::interval::{Interval, check_confidence};
use crate::Error;

/// How to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BootstrapOptions {
    /// Draws of as many people as there are, at least 2. Default 1000.
    pub replicates: usize,
    /// The share of draws within the interval, in (0, 1). Default 0.95.
    pub confidence: f64,
    /// Draws people. Default 0.
    pub seed: u64,
}

impl Default for BootstrapOptions {
    fn default() -> Self {
        BootstrapOptions { replicates: 1000, confidence: 0.95, seed: 0 }
    }
}

/// The interval of a statistic over draws of people; `people` has the person of each item.
///
/// The statistic gets the numbers of the items of all people drawn, with those of one drawn twice twice; where it gives NaN, as of no
/// items of a kind, the draw is left out. The interval depends on the seed and not on the number of threads.
///
/// # Errors
/// [`Error::Input`] for options, and for fewer than two people; [`Error::ScoreNan`] where no draw gives a number.
pub fn bootstrap_over_people(
    people: &[u32],
    options: &BootstrapOptions,
    statistic: impl Fn(&[usize]) -> f64 + Sync,
) -> Result<Interval, Error> {
    check_confidence(options.confidence)?;
    if options.replicates < 2 {
        return Err(Error::option("replicates", options.replicates.to_string(), "at least 2"));
    }
    let mut items: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
    people.iter().enumerate().for_each(|(i, &person)| items.entry(person).or_default().push(i));
    let items: Vec<Vec<usize>> = items.into_values().collect();
    if items.len() < 2 {
        return Err(Error::option("people", items.len().to_string(), "at least 2"));
    }
    let draw = |replicate: usize| {
        let mut rng = ChaCha8Rng::seed_from_u64(options.seed);
        // A stream of its own for each draw, whichever thread makes it.
        rng.set_stream(replicate as u64);
        let drawn: Vec<usize> = (0..items.len())
            .flat_map(|_| items[rng.random_range(0..items.len())].iter().copied())
            .collect();
        statistic(&drawn)
    };
    let mut values: Vec<f64> = (0..options.replicates).into_par_iter().map(draw).collect();
    values.retain(|value| !value.is_nan());
    if values.is_empty() {
        return Err(Error::ScoreNan { what: "bootstrap", index: 0 });
    }
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    let tail = (1.0 - options.confidence) / 2.0;
    Ok(Interval { low: at(tail), high: at(1.0 - tail) })
}
