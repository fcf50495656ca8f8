//! Error rates over random splits: people are enrolled with a few of their samples, and tried with the others.
//!
//! *Idea.* This is the experiment of the thesis (7.7): k random samples of each person are for training, all others are probes; the
//! figures are means over many splits. Each probe is identified among all enrolled people, and compared with each of them.
//! *Unseen people.* What classes share (scaling, whitening, pooled covariances) is learned from the training samples of the same people
//! above, which a system in use cannot do for those who come later. So every figure is also measured with people in folds: what is
//! shared comes from the other folds, and the impostors are people of the probe's own fold, whom nothing was learned from either.
//! *Trap.* Splits of the same samples depend on each other: a hundred splits do not make a hundred times as many trials. Intervals draw
//! people, and a warning counts the different samples that were ever wrong.
//! *Reference.* ISO/IEC 19795-1 for the names of the rates.

mod rates;
mod split;

use std::collections::BTreeMap;

use taut_points::{Monitor, Points, shown_number};

use super::interval::{Interval, RateWarning, check_confidence};
use super::scores::DetPoint;
use super::transaction::TransactionRates;
use crate::Error;
use crate::classify::Method;
use rates::Tally;
use split::{Outcome, Plan};

/// Splits, at most.
const SPLITS_MAX: usize = 100_000;
/// Impostor scores of one figure, at most: beyond, evenly spaced ones are kept. At a rate of 1 % they hold 10⁴ errors.
const IMPOSTORS_MAX: usize = 1_000_000;

/// An attempt of a person to give features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attempt<'a> {
    /// The number of the person.
    pub person: u32,
    /// The features; `None` for a failure to acquire.
    pub features: Option<&'a [f64]>,
}

/// A way to recognize people.
#[derive(Clone, Debug, PartialEq)]
pub struct Contender {
    /// Its name in reports.
    pub name: String,
    /// The features it looks at, by number.
    pub columns: Vec<usize>,
    /// The classifier that identifies.
    pub method: Method,
    /// The classifier whose scores verify, where it is another one, as in the thesis.
    pub verifier: Option<Method>,
}

/// How to measure. Write `ProtocolOptions { splits: 20, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct ProtocolOptions<'a> {
    /// Numbers of training samples of each person, each at least 1. Default 3, 4 and 5, as in the thesis.
    pub training: Vec<usize>,
    /// Random splits, 1 to 100,000. Default 100.
    pub splits: usize,
    /// Folds of people, at least 2. Default 5.
    pub folds: usize,
    /// The rate of false acceptance at which the rate of false rejection is told, in [0, 1]. Default 0.01.
    pub far_max: f64,
    /// The confidence of intervals, in (0, 1). Default 0.95.
    pub confidence: f64,
    /// Draws of people for an interval, at least 2. Default 1000.
    pub replicates: usize,
    /// Draws splits, folds and people. Default 0.
    pub seed: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for ProtocolOptions<'_> {
    fn default() -> Self {
        ProtocolOptions {
            training: vec![3, 4, 5],
            splits: 100,
            folds: 5,
            far_max: 0.01,
            confidence: 0.95,
            replicates: 1000,
            seed: 0,
            monitor: Monitor::silent(),
        }
    }
}

/// The figures of all contenders.
#[derive(Clone, Debug, PartialEq)]
pub struct Protocol {
    /// Attempts to give features.
    pub attempts: usize,
    /// The failure to acquire: the share of attempts without features.
    pub fta: f64,
    /// For each number of training samples in turn, all contenders.
    pub rows: Vec<ProtocolRow>,
}

/// The figures of one contender with one number of training samples.
#[derive(Clone, Debug, PartialEq)]
pub struct ProtocolRow {
    /// The number of the contender.
    pub contender: usize,
    /// Training samples of each person.
    pub training: usize,
    /// People that are enrolled.
    pub people: usize,
    /// The failure to enroll: the share of people with fewer samples than training needs.
    pub fte: f64,
    /// Figures where everything was learned from the enrolled people.
    pub seen: ProtocolRates,
    /// Figures where what people share was learned from other people than those of probes and impostors.
    pub unseen: ProtocolRates,
    /// Identification among people of whom some are not enrolled; `None` where there are no such probes.
    pub open: Option<OpenSetFigures>,
}

/// Figures of closed-set identification and of verification.
#[derive(Clone, Debug, PartialEq)]
pub struct ProtocolRates {
    /// Probes over all splits.
    pub probes: u64,
    /// Probes whose person was not the best.
    pub errors: u64,
    /// The interval of their ratio, by draws of people; where there is no error, that of Clopper and Pearson for `samples` trials.
    pub interval: Interval,
    /// Different samples that were probes.
    pub samples: u64,
    /// Different samples that were not identified in one split or more.
    pub samples_wrong: u64,
    /// The doubt that these leave.
    pub warning: Option<RateWarning>,
    /// The equal error rate of verification.
    pub equal_error_rate: f64,
    /// The threshold and the rates of verification where the FMR is at most [`ProtocolOptions::far_max`].
    pub at: DetPoint,
    /// The interval of the FNMR there, by draws of people with the threshold fixed.
    pub fnmr_interval: Interval,
    /// The same as transactions, with failures to acquire and to enroll.
    pub transaction: TransactionRates,
    /// Impostor scores that the rates of verification come from.
    pub impostors: u64,
    /// A few hundred points of the trade-off of verification.
    pub det: Vec<DetPoint>,
    /// The same of identification as the thesis counts it: `fmr` is the share of probes that are accepted under a wrong name, and
    /// `fnmr` the share that is rejected.
    pub identification: Vec<DetPoint>,
    /// The share of probes that are rejected where at most [`ProtocolOptions::far_max`] are accepted under a wrong name.
    pub rejected: f64,
}

/// Figures of open-set identification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenSetFigures {
    /// Probes of people who are not enrolled.
    pub unknown: u64,
    /// Probes of people who are.
    pub enrolled: u64,
    /// The false positive identification rate: the share of unknown probes that are named; at most
    /// [`ProtocolOptions::far_max`] where the number of probes allows.
    pub fpir: f64,
    /// The false negative identification rate at the same threshold.
    pub fnir: f64,
}

impl ProtocolRates {
    /// The share of probes whose person was not the best.
    pub fn error_rate(&self) -> f64 {
        self.errors as f64 / self.probes as f64
    }
}

/// Measures all contenders on the same splits.
///
/// The figures depend on the seed and not on the number of threads.
///
/// # Errors
/// [`Error::Input`] for options, for samples that are not finite, and for too few people; [`Error::Dimension`] for samples of different
/// dimensions; what [`train`](crate::classify::train) says of a contender.
pub fn run_protocol(
    attempts: &[Attempt<'_>],
    contenders: &[Contender],
    options: &ProtocolOptions<'_>,
) -> Result<Protocol, Error> {
    options.check()?;
    let samples = Samples::of(attempts)?;
    for column in contenders.iter().flat_map(|contender| &contender.columns) {
        if *column >= samples.dim {
            let expected = "numbers of features that there are, from 0";
            return Err(Error::option("columns", column.to_string(), expected));
        }
    }
    let failed = attempts.len() - samples.person.len();
    let fta = failed as f64 / attempts.len() as f64;
    let mut rows = vec![];
    for &training in &options.training {
        let plan = Plan::of(&samples, training, options)?;
        let enrolled = plan.people();
        let fte = 1.0 - enrolled as f64 / samples.people as f64;
        for (place, contender) in contenders.iter().enumerate() {
            options.monitor.pass(rows.len() as u64 + 1, options.splits as u64);
            let outcomes = plan.run(&samples, contender)?;
            let tally = |of: fn(&Outcome) -> &split::Scored| {
                Tally::of(outcomes.iter().map(of), &samples.person)
            };
            rows.push(ProtocolRow {
                contender: place,
                training,
                people: enrolled,
                fte,
                seen: tally(|outcome| &outcome.seen).rates(options, fta, fte)?,
                unseen: tally(|outcome| &outcome.unseen).rates(options, fta, fte)?,
                open: rates::open_set(&outcomes, options.far_max),
            });
        }
    }
    Ok(Protocol { attempts: attempts.len(), fta, rows })
}

impl ProtocolOptions<'_> {
    fn check(&self) -> Result<(), Error> {
        check_confidence(self.confidence)?;
        if self.training.is_empty() || self.training.contains(&0) {
            let shown = format!("{:?}", self.training);
            return Err(Error::option("training", shown, "one number or more, each at least 1"));
        }
        if !(1..=SPLITS_MAX).contains(&self.splits) {
            return Err(Error::option("splits", self.splits.to_string(), "1 to 100000"));
        }
        if self.folds < 2 {
            return Err(Error::option("folds", self.folds.to_string(), "at least 2"));
        }
        if self.replicates < 2 {
            return Err(Error::option("replicates", self.replicates.to_string(), "at least 2"));
        }
        if !(0.0..=1.0).contains(&self.far_max) {
            let shown = shown_number(self.far_max);
            return Err(Error::option("far_max", shown, "a rate from 0 to 1"));
        }
        Ok(())
    }
}

/// The samples that have features.
struct Samples {
    dim: usize,
    /// Sample after sample.
    values: Vec<f64>,
    /// The person of each, from 0 without gaps.
    person: Vec<u32>,
    /// All people, with those that never gave features.
    people: usize,
}

impl Samples {
    fn of(attempts: &[Attempt<'_>]) -> Result<Self, Error> {
        let mut numbers = BTreeMap::new();
        attempts.iter().for_each(|attempt| {
            numbers.insert(attempt.person, 0u32);
        });
        numbers.values_mut().zip(0..).for_each(|(number, place)| *number = place);
        let dim = attempts.iter().find_map(|attempt| attempt.features).map_or(0, <[f64]>::len);
        let (mut values, mut person) = (vec![], vec![]);
        for attempt in attempts {
            let Some(features) = attempt.features else { continue };
            if features.len() != dim {
                return Err(Error::Dimension { found: features.len(), expected: dim });
            }
            values.extend_from_slice(features);
            person.push(numbers[&attempt.person]);
        }
        if person.is_empty() {
            return Err(Error::option("samples", "0".to_owned(), "one at least"));
        }
        let points = Points::new(&values, dim).map_err(taut_points::ReadError::from)?;
        crate::classify::check_finite(&points)?;
        Ok(Samples { dim, values, person, people: numbers.len() })
    }

    /// The features of a contender, sample after sample.
    fn columns(&self, columns: &[usize]) -> Vec<f64> {
        let rows = self.values.chunks_exact(self.dim);
        rows.flat_map(|row| columns.iter().map(|&column| row[column])).collect()
    }
}
