//! The matcher: a whitening, a threshold, and the error rates that were measured for it.
//!
//! *Idea.* People of a training set are split in four parts. Half of them teach the whitening. A quarter sets the threshold: at most
//! a given share of its impostor comparisons may be accepted. On the last quarter the error rates are measured.
//! *Trap.* The rates hold for people, scanners and poses like those of the training set; for a synthetic set they say nothing of people.

use serde::{Deserialize, Serialize};
use taut_points::Points;

use super::Template;
use crate::Error;
use crate::classify::{Labeled, Whitener};
use crate::evaluate::{ScoreSet, clopper_pearson, person_disjoint_folds};

/// What the JSON of a matcher calls its format.
const FORMAT: &str = "taut-matcher";
/// The version that is written, and the only one that is read.
const VERSION: u64 = 1;

/// Parts of the people: two for the whitening, one for the threshold, one for the rates.
const PARTS: usize = 4;
/// The part that sets the threshold.
const THRESHOLD_PART: usize = 2;
/// The part on which rates are measured.
const RATES_PART: usize = 3;

/// How a matcher is learned.
#[derive(Clone, Debug, PartialEq)]
pub struct MatcherOptions {
    /// The share of impostor comparisons that may be accepted. In [0, 1), default 0.0001.
    pub fmr_max: f64,
    /// Scans that each template is made of where threshold and rates are measured; the others are probes. At least 1, default 3.
    pub enrolled: usize,
    /// Where the training set is from, in words.
    pub source: String,
    /// The seed of the split of people. Default 0.
    pub seed: u64,
}

impl Default for MatcherOptions {
    fn default() -> Self {
        MatcherOptions { fmr_max: 1e-4, enrolled: 3, source: String::new(), seed: 0 }
    }
}

/// Error rates of comparisons, measured on people that neither whitening nor threshold was learned from.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rates {
    /// Comparisons of people with themselves.
    pub genuine: u64,
    /// Those that were rejected.
    pub false_non_matches: u64,
    /// Comparisons of different people.
    pub impostor: u64,
    /// Those that were accepted.
    pub false_matches: u64,
    /// Scans of each template.
    pub enrolled: u64,
}

impl Rates {
    /// The false match rate.
    pub fn fmr(&self) -> f64 {
        self.false_matches as f64 / self.impostor as f64
    }

    /// The false non-match rate.
    pub fn fnmr(&self) -> f64 {
        self.false_non_matches as f64 / self.genuine as f64
    }

    /// The probability that somebody unknown is within the threshold of one of `people` templates, if these are independent.
    ///
    /// The rate is taken at the upper end of its 95 % interval (Clopper and Pearson), which takes comparisons as independent.
    pub fn chance_among(&self, people: u64) -> f64 {
        let interval = clopper_pearson(self.false_matches, self.impostor, 0.95);
        let rate = interval.map_or(1.0, |interval| interval.high);
        -(people as f64 * (-rate).ln_1p()).exp_m1()
    }
}

/// Maps features, and decides by a threshold for distances.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Matcher {
    format: String,
    version: u64,
    source: String,
    threshold: f64,
    rates: Rates,
    whitener: Whitener,
}

/// What a JSON begins with, before it is known to be a matcher.
#[derive(Deserialize)]
struct Head {
    format: Option<String>,
    version: Option<u64>,
}

impl Matcher {
    /// Learns a matcher; the classes of `data` are people.
    ///
    /// # Errors
    /// [`Error::ClassCount`] where there are too few people with enough scans for the four parts, those of [`Whitener::learn`], and
    /// [`Error::Input`] for options.
    pub fn train(data: Labeled<'_>, options: &MatcherOptions) -> Result<Self, Error> {
        if !(0.0..1.0).contains(&options.fmr_max) {
            let value = taut_points::shown_number(options.fmr_max);
            return Err(Error::option("fmr_max", value, "a number from 0, below 1"));
        }
        if options.enrolled == 0 || options.enrolled >= super::SCANS_MAX as usize {
            let value = options.enrolled.to_string();
            return Err(Error::option("enrolled", value, "from 1 to 999"));
        }
        let folds = person_disjoint_folds(data.labels(), PARTS, options.seed);
        let in_part = |wanted: &dyn Fn(usize) -> bool| -> Vec<usize> {
            (0..folds.len()).filter(|&i| wanted(folds[i])).collect()
        };
        let whitener = learn_from(&data, &in_part(&|part| part < THRESHOLD_PART))?;
        let compare = |part| compare(&data, &in_part(&|own| own == part), &whitener, options);
        let to_set = compare(THRESHOLD_PART)?;
        let threshold = threshold(&to_set, options.fmr_max);
        let measured = compare(RATES_PART)?;
        let (genuine, impostor) = (measured.genuine(), measured.impostor());
        let count_accepted =
            |scores: &[f64]| scores.iter().filter(|&&score| -score <= threshold).count() as u64;
        let rates = Rates {
            genuine: genuine.len() as u64,
            false_non_matches: genuine.len() as u64 - count_accepted(genuine),
            impostor: impostor.len() as u64,
            false_matches: count_accepted(impostor),
            enrolled: options.enrolled as u64,
        };
        Ok(Matcher {
            format: FORMAT.to_owned(),
            version: VERSION,
            source: options.source.clone(),
            threshold,
            rates,
            whitener,
        })
    }

    /// The number of features of a scan.
    pub fn dim(&self) -> usize {
        self.whitener.dim()
    }

    /// Where the training set is from, in words.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// The largest distance that is accepted.
    pub fn threshold(&self) -> f64 {
        self.threshold
    }

    /// The error rates that were measured at the threshold.
    pub fn rates(&self) -> Rates {
        self.rates
    }

    /// Maps the features of a scan.
    ///
    /// # Errors
    /// Those of [`Whitener::apply`].
    pub fn map(&self, features: &[f64]) -> Result<Vec<f64>, Error> {
        self.whitener.apply(features)
    }

    /// Makes a template of the features of some scans.
    ///
    /// # Errors
    /// Those of [`Matcher::map`] and of [`Template::of_mapped`].
    pub fn template(&self, scans: &[&[f64]]) -> Result<Template, Error> {
        let mapped = scans.iter().map(|scan| self.map(scan)).collect::<Result<Vec<_>, _>>()?;
        Template::of_mapped(&mapped)
    }

    /// The matcher as JSON.
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers, names and lists can be written")
    }

    /// The matcher that a JSON holds: distances have the same bits.
    ///
    /// # Errors
    /// [`Error::NoModel`] and [`Error::Version`].
    pub fn from_json(json: &str) -> Result<Self, Error> {
        let no_model = |problem: String| Error::NoModel { problem };
        let head: Head = serde_json::from_str(json).map_err(|error| no_model(error.to_string()))?;
        match (head.format.as_deref(), head.version) {
            (Some(FORMAT), Some(VERSION)) => {}
            (Some(FORMAT), Some(found)) => return Err(Error::Version { found, known: VERSION }),
            _ => return Err(no_model(format!("its `format` is not \"{FORMAT}\""))),
        }
        let found: Matcher =
            serde_json::from_str(json).map_err(|error| no_model(error.to_string()))?;
        let rates = &found.rates;
        let is_sound = found.whitener.is_sound()
            && found.dim() <= super::DIM_MAX
            && found.threshold.is_finite()
            && found.threshold >= 0.0
            && rates.genuine > 0
            && rates.impostor > 0
            && rates.false_non_matches <= rates.genuine
            && rates.false_matches <= rates.impostor;
        match is_sound {
            true => Ok(found),
            false => Err(no_model("its parts contradict each other".to_owned())),
        }
    }
}

/// Learns the whitening from some rows.
fn learn_from(data: &Labeled<'_>, rows: &[usize]) -> Result<Whitener, Error> {
    let dim = data.points().dim();
    let values: Vec<f64> = rows.iter().flat_map(|&i| data.points().row(i)).copied().collect();
    let mut people: Vec<u32> = rows.iter().map(|&i| data.labels()[i]).collect();
    people.sort_unstable();
    people.dedup();
    let place = |i: &usize| people.partition_point(|&person| person < data.labels()[*i]) as u32;
    let labels: Vec<u32> = rows.iter().map(place).collect();
    let points = Points::new(&values, dim).expect("rows of one dimension");
    let names: Vec<String> = people.iter().map(|&p| data.classes()[p as usize].clone()).collect();
    Whitener::learn(Labeled::new(points, &labels, &names)?)
}

/// The threshold for a share of impostor comparisons that may be accepted.
///
/// The first impostor who must be rejected bounds it from above. Where all genuine comparisons are nearer, it is the geometric mean of that
/// bound and of the farthest genuine one, so that either side has the same factor to spare.
fn threshold(scores: &ScoreSet, fmr_max: f64) -> f64 {
    let (genuine, impostor) = (scores.genuine(), scores.impostor());
    let accepted = (fmr_max * impostor.len() as f64) as usize;
    let bound = -impostor[impostor.len() - 1 - accepted.min(impostor.len() - 1)];
    let farthest = -genuine[0];
    match farthest < bound {
        true => (farthest.sqrt() * bound.sqrt()).clamp(farthest, bound.next_down()),
        // No distance is below 0.
        false => bound.next_down().max(0.0),
    }
}

/// The comparisons of all probes of a part with all templates of it; scores are negative distances.
fn compare(
    data: &Labeled<'_>,
    rows: &[usize],
    whitener: &Whitener,
    options: &MatcherOptions,
) -> Result<ScoreSet, Error> {
    let map = |&i: &usize| Ok((data.labels()[i], whitener.apply(data.points().row(i))?));
    let mapped = rows.iter().map(map).collect::<Result<Vec<(u32, Vec<f64>)>, Error>>()?;
    let mut people: Vec<u32> = mapped.iter().map(|scan| scan.0).collect();
    people.sort_unstable();
    people.dedup();
    let (mut templates, mut probes) = (vec![], vec![]);
    for person in people {
        let mut own: Vec<Vec<f64>> =
            mapped.iter().filter(|scan| scan.0 == person).map(|scan| scan.1.clone()).collect();
        if own.len() > options.enrolled {
            let rest = own.split_off(options.enrolled);
            templates.push((person, Template::of_mapped(&own)?));
            probes.extend(rest.into_iter().map(|probe| (person, probe)));
        }
    }
    if templates.len() < 2 {
        let needs = "a matcher needs eight people or more, most of them with more scans than a template has";
        return Err(Error::ClassCount { classes: data.classes().len(), needs });
    }
    let (mut genuine, mut impostor) = (vec![], vec![]);
    for (person, probe) in &probes {
        for (other, template) in &templates {
            let scores = if person == other { &mut genuine } else { &mut impostor };
            scores.push(-template.distance(probe)?);
        }
    }
    ScoreSet::new(genuine, impostor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_threshold_leaves_the_same_factor_to_both_sides() {
        let of = |genuine: &[f64], impostor: &[f64], fmr_max| {
            let negative = |distances: &[f64]| distances.iter().map(|x| -x).collect();
            threshold(&ScoreSet::new(negative(genuine), negative(impostor)).unwrap(), fmr_max)
        };
        let impostor = [100.0, 400.0, 900.0, 1600.0];
        assert!((of(&[1.0, 4.0], &impostor, 0.0) - 20.0).abs() < 1e-12);
        assert!((of(&[1.0, 4.0], &impostor, 0.25) - 40.0).abs() < 1e-12);
        assert!((of(&[1.0, 4.0], &impostor, 0.49) - 40.0).abs() < 1e-12);
        // Where both overlap, no more impostors are accepted than allowed.
        assert_eq!(of(&[1.0, 500.0], &impostor, 0.0), 100f64.next_down());
        assert_eq!(of(&[1.0, 400.0], &impostor, 0.25), 400f64.next_down());
        assert_eq!(of(&[3.0], &[0.0], 0.9), 0.0);
        assert_eq!(of(&[0.0], &[1.0], 0.5), 0.0);
    }
}
