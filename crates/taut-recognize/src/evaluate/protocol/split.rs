//! One split: who is enrolled with what, and the scores of all probes.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_chacha::ChaCha8Rng;
use taut_points::Points;
use taut_points::parallel::IntoParallel;

use super::{Contender, IMPOSTORS_MAX, ProtocolOptions, Samples};
use crate::Error;
use crate::classify::{
    Classifier, Labeled, Method, Model, Score, TrainOptions, best_of, train, train_with_background,
};
use crate::evaluate::person_disjoint_folds;

/// The splits for one number of training samples.
pub(super) struct Plan<'a> {
    training: usize,
    options: &'a ProtocolOptions<'a>,
    /// The samples of each enrolled person.
    samples: Vec<Vec<usize>>,
    /// The fold of each enrolled person.
    folds: Vec<usize>,
    /// Names of the classes, which nobody sees.
    names: Vec<String>,
    /// Of so many impostor scores in turn one is kept, of probes against all and against the own fold.
    strides: [usize; 2],
}

/// The scores of a split.
pub(super) struct Outcome {
    pub(super) seen: Scored,
    pub(super) unseen: Scored,
    pub(super) open: Open,
}

/// What was found for each probe.
#[derive(Default)]
pub(super) struct Scored {
    pub(super) probes: Vec<Probe>,
    /// Scores against other people.
    pub(super) impostors: Vec<f64>,
}

/// A probe of an enrolled person.
#[derive(Clone, Copy)]
pub(super) struct Probe {
    pub(super) sample: usize,
    /// Whether its person was the best.
    pub(super) is_right: bool,
    /// The score against its own person, for verification.
    pub(super) own: f64,
    /// The score against the best person, for verification.
    pub(super) best: f64,
}

/// Identification with people who are not enrolled.
#[derive(Default)]
pub(super) struct Open {
    /// Best scores of unknown people.
    pub(super) unknown: Vec<f64>,
    /// Best scores of enrolled people, and whether that was the right one.
    pub(super) enrolled: Vec<(f64, bool)>,
}

/// The rows of a split.
struct Gallery<'a> {
    dim: usize,
    /// The features of all samples.
    values: &'a [f64],
    /// The training samples of each enrolled person.
    training: Vec<&'a [usize]>,
    /// Probes with the place of their person among the enrolled ones.
    probes: Vec<(usize, usize)>,
}

/// The classifier that identifies, and the one that verifies if it is another.
struct Pair {
    model: Model,
    verifier: Option<Model>,
}

impl<'a> Plan<'a> {
    pub(super) fn of(
        samples: &Samples,
        training: usize,
        options: &'a ProtocolOptions<'a>,
    ) -> Result<Self, Error> {
        let mut of_person = vec![vec![]; samples.people];
        for (sample, &person) in samples.person.iter().enumerate() {
            of_person[person as usize].push(sample);
        }
        of_person.retain(|own| own.len() >= training);
        let (people, folds) = (of_person.len(), options.folds);
        if people / 2 < folds {
            let expected =
                "at most half as many as there are people with enough samples for training";
            return Err(Error::option("folds", folds.to_string(), expected));
        }
        let probes: usize = of_person.iter().map(|own| own.len() - training).sum();
        if probes == 0 {
            let expected = "fewer than the samples of one person at least";
            return Err(Error::option("training", training.to_string(), expected));
        }
        let comparisons = options.splits.saturating_mul(probes);
        let stride = |others: usize| comparisons.saturating_mul(others).div_ceil(IMPOSTORS_MAX);
        let numbers: Vec<u32> = (0..).take(people).collect();
        Ok(Plan {
            training,
            options,
            samples: of_person,
            folds: person_disjoint_folds(&numbers, folds, options.seed),
            names: numbers.iter().map(u32::to_string).collect(),
            strides: [stride(people), stride(people.div_ceil(folds))],
        })
    }

    /// The number of people that are enrolled.
    pub(super) fn people(&self) -> usize {
        self.samples.len()
    }

    /// Runs all splits, in their order.
    pub(super) fn run(
        &self,
        samples: &Samples,
        contender: &Contender,
    ) -> Result<Vec<Outcome>, Error> {
        let values = samples.columns(&contender.columns);
        let dim = contender.columns.len();
        let split = |split: usize| {
            self.options.monitor.check().map_err(taut_points::InputError::from)?;
            let drawn = self.drawn(split);
            let training = drawn.iter().map(|own| &own[..self.training]).collect();
            let rest = drawn.iter().enumerate();
            let probes =
                rest.flat_map(|(place, own)| own[self.training..].iter().map(move |&i| (i, place)));
            let gallery = Gallery { dim, values: &values, training, probes: probes.collect() };
            let outcome = self.outcome(&gallery, contender, split)?;
            self.options.monitor.points(1);
            Ok(outcome)
        };
        (0..self.options.splits).into_par_iter().map(split).collect()
    }

    /// The samples of each person in an order drawn for a split: the first ones are for training.
    fn drawn(&self, split: usize) -> Vec<Vec<usize>> {
        let mut rng = ChaCha8Rng::seed_from_u64(self.options.seed);
        // Each split has its own stream, whichever thread runs it.
        rng.set_stream(split as u64);
        let mut drawn = self.samples.clone();
        drawn.iter_mut().for_each(|own| own.shuffle(&mut rng));
        drawn
    }

    fn outcome(
        &self,
        gallery: &Gallery<'_>,
        contender: &Contender,
        split: usize,
    ) -> Result<Outcome, Error> {
        let everybody = |_: usize| true;
        let pair = self.learn(gallery, contender, None)?;
        let mut seen = Scored::default();
        let mut unseen = Scored::default();
        let mut open = Open::default();
        let mut counts = [split, split];
        for &(sample, place) in &gallery.probes {
            let scores = pair.scores(gallery, sample)?;
            seen.add(sample, place, &scores, everybody);
            let [stride, _] = self.strides;
            seen.impostors.extend(scores.others(place, everybody, &mut counts[0], stride));
        }
        for fold in 0..self.options.folds {
            let is_within = |place: usize| self.folds[place] == fold;
            let pair = self.learn(gallery, contender, Some(fold))?;
            let is_open = fold == split % self.options.folds;
            for &(sample, place) in gallery.probes.iter().filter(|p| is_open || is_within(p.1)) {
                let scores = pair.scores(gallery, sample)?;
                if is_within(place) {
                    unseen.add(sample, place, &scores, everybody);
                    let others = scores.others(place, is_within, &mut counts[1], self.strides[1]);
                    unseen.impostors.extend(others);
                }
                if is_open {
                    let (best, score) = scores.best(|place| !is_within(place));
                    match is_within(place) {
                        true => open.unknown.push(score),
                        false => open.enrolled.push((score, best == place)),
                    }
                }
            }
        }
        Ok(Outcome { seen, unseen, open })
    }

    /// Learns everybody, with what they share from the people of all folds but one.
    fn learn(
        &self,
        gallery: &Gallery<'_>,
        contender: &Contender,
        without: Option<usize>,
    ) -> Result<Pair, Error> {
        let of = |method: &Method| {
            let monitor = taut_points::Monitor {
                cancel: self.options.monitor.cancel,
                ..taut_points::Monitor::default()
            };
            let options = TrainOptions { candidates: vec![*method], monitor, ..Default::default() };
            let all = gallery.rows(|_| true);
            let data = all.labeled(&self.names)?;
            let Some(without) = without else { return train(data, &options) };
            let background = gallery.rows(|place| self.folds[place] != without);
            train_with_background(background.labeled(&self.names)?, data, &options)
        };
        Ok(Pair {
            model: of(&contender.method)?,
            verifier: contender.verifier.as_ref().map(of).transpose()?,
        })
    }
}

/// Training rows with the numbers of their classes.
struct Rows {
    values: Vec<f64>,
    dim: usize,
    labels: Vec<u32>,
}

impl Rows {
    fn labeled<'a>(&'a self, names: &'a [String]) -> Result<Labeled<'a>, Error> {
        let points = Points::new(&self.values, self.dim).map_err(taut_points::ReadError::from)?;
        let classes = self.labels.last().map_or(0, |&last| last as usize + 1);
        Labeled::new(points, &self.labels, &names[..classes])
    }
}

impl Gallery<'_> {
    /// The training rows of some people, who get numbers from 0.
    fn rows(&self, is_in: impl Fn(usize) -> bool) -> Rows {
        let mut rows = Rows { values: vec![], dim: self.dim, labels: vec![] };
        let chosen = self.training.iter().enumerate().filter(|(place, _)| is_in(*place));
        for (class, (_, own)) in (0..).zip(chosen) {
            for &sample in *own {
                rows.values.extend_from_slice(self.row(sample));
                rows.labels.push(class);
            }
        }
        rows
    }

    fn row(&self, sample: usize) -> &[f64] {
        &self.values[sample * self.dim..(sample + 1) * self.dim]
    }
}

/// The scores of a probe against everybody.
struct Scores {
    identity: Vec<Score>,
    verification: Vec<f64>,
}

impl Pair {
    fn scores(&self, gallery: &Gallery<'_>, sample: usize) -> Result<Scores, Error> {
        let row = gallery.row(sample);
        let of = |model: &Model| {
            let mut scores = vec![Score::default(); Classifier::classes(model)];
            Classifier::scores(model, row, &mut scores);
            match scores.iter().any(|score| score.value.is_nan() || score.tie.is_nan()) {
                true => Err(Error::Overflow),
                false => Ok(scores),
            }
        };
        let identity = of(&self.model)?;
        let values = |scores: &[Score]| scores.iter().map(|score| score.value).collect();
        let verification = match &self.verifier {
            Some(verifier) => values(&of(verifier)?),
            None => values(&identity),
        };
        Ok(Scores { identity, verification })
    }
}

impl Scores {
    /// The best of some people, and the score that verifies that it is her.
    fn best(&self, is_in: impl Fn(usize) -> bool) -> (usize, f64) {
        let places: Vec<usize> = (0..self.identity.len()).filter(|&place| is_in(place)).collect();
        let scores: Vec<Score> = places.iter().map(|&place| self.identity[place]).collect();
        let best = places.get(best_of(&scores).0).copied().unwrap_or_default();
        (best, self.verification[best])
    }

    /// Scores against other people, one of `stride` in turn.
    fn others<'a>(
        &'a self,
        own: usize,
        is_in: impl Fn(usize) -> bool + 'a,
        count: &'a mut usize,
        stride: usize,
    ) -> impl Iterator<Item = f64> + 'a {
        let others = self.verification.iter().enumerate();
        let others = others.filter(move |(place, _)| *place != own && is_in(*place));
        others.filter_map(move |(_, &score)| {
            *count += 1;
            count.is_multiple_of(stride).then_some(score)
        })
    }
}

impl Scored {
    fn add(&mut self, sample: usize, place: usize, scores: &Scores, is_in: impl Fn(usize) -> bool) {
        let (best, score) = scores.best(is_in);
        let own = scores.verification[place];
        self.probes.push(Probe { sample, is_right: best == place, own, best: score });
    }
}
