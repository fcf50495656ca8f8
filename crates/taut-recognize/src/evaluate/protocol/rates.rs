//! From the scores of all splits to rates.

use std::collections::BTreeMap;

use taut_points::OrderBy;

use super::split::{Outcome, Probe, Scored};
use super::{OpenSetFigures, ProtocolOptions, ProtocolRates};
use crate::Error;
use crate::evaluate::interval::{Interval, clopper_pearson, warnings};
use crate::evaluate::scores::{DetPoint, ScoreSet, at_fmr, equal_error_rate, thinned};
use crate::evaluate::transaction::TransactionRates;
use crate::evaluate::{BootstrapOptions, bootstrap_over_people};

/// Points of a curve in a report, at most.
const CURVE_POINTS_MAX: usize = 400;

/// What was found over all splits.
pub(super) struct Tally<'a> {
    /// The person of each sample.
    person: &'a [u32],
    probes: Vec<Probe>,
    impostors: Vec<f64>,
}

impl<'a> Tally<'a> {
    pub(super) fn of<'s>(splits: impl Iterator<Item = &'s Scored>, person: &'a [u32]) -> Self {
        let mut tally = Tally { person, probes: vec![], impostors: vec![] };
        for split in splits {
            tally.probes.extend_from_slice(&split.probes);
            tally.impostors.extend_from_slice(&split.impostors);
        }
        tally
    }

    pub(super) fn rates(
        self,
        options: &ProtocolOptions<'_>,
        fta: f64,
        fte: f64,
    ) -> Result<ProtocolRates, Error> {
        let errors = self.probes.iter().filter(|probe| !probe.is_right).count() as u64;
        let mut samples = BTreeMap::new();
        for probe in &self.probes {
            *samples.entry(probe.sample).or_insert(false) |= !probe.is_right;
        }
        let samples_wrong = samples.values().filter(|&&wrong| wrong).count() as u64;
        let identification = identification(&self.probes);
        let rejected = at_fmr(&identification, options.far_max).fnmr;
        let own: Vec<f64> = self.probes.iter().map(|probe| probe.own).collect();
        let impostors = self.impostors.len() as u64;
        let det = ScoreSet::new(own, self.impostors)?.det();
        let at = at_fmr(&det, options.far_max);
        let count = samples.len() as u64;
        let interval = |is_error: &dyn Fn(&Probe) -> bool| {
            over_people(&self.probes, self.person, is_error, count, options)
        };
        Ok(ProtocolRates {
            probes: self.probes.len() as u64,
            errors,
            interval: interval(&|probe| !probe.is_right)?,
            samples: count,
            samples_wrong,
            warning: warnings(samples_wrong, count),
            equal_error_rate: equal_error_rate(&det),
            at,
            fnmr_interval: interval(&|probe| probe.own < at.threshold)?,
            transaction: TransactionRates::new(at.fmr, at.fnmr, fta, fte)?,
            impostors,
            det: thinned(&det, CURVE_POINTS_MAX),
            identification: thinned(&identification, CURVE_POINTS_MAX),
            rejected,
        })
    }
}

/// The interval of the share of probes that are errors, by draws of people. Where few people have errors, draws of them know little of
/// the others: the upper end is not below that of as many trials as there are different samples, with the same share of errors.
fn over_people(
    probes: &[Probe],
    person: &[u32],
    is_error: &dyn Fn(&Probe) -> bool,
    samples: u64,
    options: &ProtocolOptions<'_>,
) -> Result<Interval, Error> {
    let mut counts: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
    for probe in probes {
        let [errors, trials] = counts.entry(person[probe.sample]).or_default();
        *errors += f64::from(u8::from(is_error(probe)));
        *trials += 1.0;
    }
    let sum = |which: usize| counts.values().map(|of_person| of_person[which]).sum::<f64>();
    let errors = (sum(0) / sum(1) * samples as f64).ceil() as u64;
    let exact = clopper_pearson(errors.min(samples), samples, options.confidence)?;
    if errors == 0 {
        return Ok(exact);
    }
    let (people, counts): (Vec<u32>, Vec<[f64; 2]>) = counts.into_iter().unzip();
    let ratio = |drawn: &[usize]| {
        let sum = |which: usize| drawn.iter().map(|&i| counts[i][which]).sum::<f64>();
        sum(0) / sum(1)
    };
    let ProtocolOptions { replicates, confidence, seed, .. } = *options;
    let options = BootstrapOptions { replicates, confidence, seed };
    let drawn = bootstrap_over_people(&people, &options, ratio)?;
    Ok(Interval { high: drawn.high.max(exact.high), ..drawn })
}

/// The trade-off of identification: shares of probes accepted under a wrong name, and rejected.
fn identification(probes: &[Probe]) -> Vec<DetPoint> {
    let mut sorted: Vec<(f64, bool)> = probes.iter().map(|p| (p.best, p.is_right)).collect();
    sorted.order_by(&|a, b| a.0.total_cmp(&b.0));
    let all = sorted.len() as f64;
    let mut wrong = sorted.iter().filter(|probe| !probe.1).count();
    let mut points: Vec<DetPoint> = vec![];
    for (rejected, &(threshold, is_right)) in sorted.iter().enumerate() {
        // Equal scores are rejected together.
        if points.last().is_none_or(|last| last.threshold < threshold) {
            points.push(DetPoint {
                threshold,
                fmr: wrong as f64 / all,
                fnmr: rejected as f64 / all,
            });
        }
        wrong -= usize::from(!is_right);
    }
    points.push(DetPoint { threshold: f64::INFINITY, fmr: 0.0, fnmr: 1.0 });
    points
}

/// The rates where the share of unknown probes that are named is at most `fpir_max`.
pub(super) fn open_set(outcomes: &[Outcome], fpir_max: f64) -> Option<OpenSetFigures> {
    let opened = || outcomes.iter().map(|outcome| &outcome.open);
    let mut unknown: Vec<f64> = opened().flat_map(|open| &open.unknown).copied().collect();
    let enrolled: Vec<(f64, bool)> = opened().flat_map(|open| &open.enrolled).copied().collect();
    if unknown.is_empty() || enrolled.is_empty() {
        return None;
    }
    unknown.sort_by(f64::total_cmp);
    let count = unknown.len();
    let named = |threshold: f64| count - unknown.partition_point(|&score| score < threshold);
    let is_allowed = |&threshold: &f64| named(threshold) as f64 <= fpir_max * count as f64;
    // Just above the largest one nobody unknown is named.
    let above = unknown[count - 1].next_up();
    let threshold = unknown.iter().copied().find(is_allowed).unwrap_or(above);
    let is_named = |probe: &&(f64, bool)| probe.1 && probe.0 >= threshold;
    let right = enrolled.iter().filter(is_named).count();
    Some(OpenSetFigures {
        unknown: count as u64,
        enrolled: enrolled.len() as u64,
        fpir: named(threshold) as f64 / count as f64,
        fnir: 1.0 - right as f64 / enrolled.len() as f64,
    })
}
