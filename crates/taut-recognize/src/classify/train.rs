//! From labeled points to a model.

use taut_points::parallel::ParallelSlice;
use taut_points::{Monitor, on_threads, shown_number};

use super::calibrate::{Calibration, threshold};
use super::committee::{Committee, Member, deviation};
use super::data::Labeled;
use super::method::{Method, Rule, Scaling};
use super::model::Model;
use super::prepare::Preparation;
use super::rule::{Effort, Fitted, Learned};
use super::select::{HeldOut, Trial, held_out};
use crate::Error;

/// How to train. Write `TrainOptions { candidates: vec![method], ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct TrainOptions<'a> {
    /// The methods to choose from, by inner folds where there are several; see [`Preset`](super::Preset). Default: one, the ball.
    pub candidates: Vec<Method>,
    /// Joins all candidates whose share of right points is less than the best one's by at most this; in [0, 1). Default `None`: the
    /// best one alone.
    pub committee: Option<f64>,
    /// Inner folds, at least 2. Default 5.
    pub folds: usize,
    /// Rejects points by a threshold below which at most this share of held-out points of the right class lies; in [0, 1). Default
    /// `None`: nothing is rejected, except by [`Rule::Svdd`] what is outside all balls.
    pub reject: Option<f64>,
    /// Fits probabilities to held-out scores; for two classes or more. Default false.
    pub calibrate: bool,
    /// Relative gap of the objective of balls and machines. Range (0, 1), default 1e-6.
    pub epsilon: f64,
    /// Draws folds and the first points of searches. Default 0.
    pub seed: u64,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The model does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for TrainOptions<'_> {
    fn default() -> Self {
        TrainOptions {
            candidates: vec![Method::default()],
            committee: None,
            folds: 5,
            reject: None,
            calibrate: false,
            epsilon: 1e-6,
            seed: 0,
            threads: None,
            monitor: Monitor::silent(),
        }
    }
}

/// Learns a classifier. All that is learned, scaling and thresholds included, comes from `data` alone.
///
/// # Errors
/// [`Error::ClassCount`] and [`Error::ClassPoints`] where the method needs more; [`Error::Overflow`], [`Error::TooLarge`], and
/// [`Error::Input`] for options.
pub fn train(data: Labeled<'_>, options: &TrainOptions<'_>) -> Result<Model, Error> {
    options.check(&data)?;
    on_threads(options.threads, || options.train(&data))
}

/// Learns a classifier for the classes of `data`, and what classes share from the classes of `background`.
///
/// Classes share the scaling, the whitening, widths of kernels, pooled covariances and the covariance between classes. So a class of
/// `data` may have a single point, and classes can be added without a change to what the others share. Support vector machines also
/// compare the classes of `data` with each other. The names of the classes of `background` do not matter.
///
/// # Errors
/// Those of [`train`]; [`Error::Dimension`] where the two have different dimensions, and [`Error::Input`] for several candidates,
/// [`TrainOptions::reject`] and [`TrainOptions::calibrate`], which would need a choice by `data`.
pub fn train_with_background(
    background: Labeled<'_>,
    data: Labeled<'_>,
    options: &TrainOptions<'_>,
) -> Result<Model, Error> {
    options.check(&data)?;
    let (found, expected) = (background.points().dim(), data.points().dim());
    if found != expected {
        return Err(Error::Dimension { found, expected });
    }
    if options.candidates.len() > 1 || options.reject.is_some() || options.calibrate {
        let count = options.candidates.len().to_string();
        let expected = "one, without rejection and probabilities, where there is a background";
        return Err(Error::option("candidates", count, expected));
    }
    let TrainOptions { epsilon, seed, monitor, .. } = *options;
    let effort = Effort { epsilon, seed, monitor };
    on_threads(options.threads, || {
        let (method, shared) = (&options.candidates[0], background.all());
        let learned = Learned::with_background(Some(&shared), &data.all(), method, &effort)?;
        Ok(options.model(&data, learned, None, vec![]))
    })
}

/// Inner folds, at most: each of them trains all candidates.
const FOLDS_MAX: usize = 1000;

impl TrainOptions<'_> {
    fn check(&self, data: &Labeled<'_>) -> Result<(), Error> {
        let is_share = |share: f64| (0.0..1.0).contains(&share);
        if self.candidates.is_empty() {
            return Err(Error::option("candidates", "empty".to_owned(), "one method at least"));
        }
        if self.folds < 2 || self.folds > FOLDS_MAX {
            return Err(Error::option("folds", self.folds.to_string(), "from 2 to 1000"));
        }
        for (name, share) in [("committee", self.committee), ("reject", self.reject)] {
            if let Some(share) = share.filter(|&share| !is_share(share)) {
                return Err(Error::option(name, shown_number(share), "a number from 0, below 1"));
            }
        }
        if !(self.epsilon > 0.0 && self.epsilon < 1.0) {
            let expected = "a number above 0 and below 1";
            return Err(Error::option("epsilon", shown_number(self.epsilon), expected));
        }
        if self.calibrate && data.classes().len() < 2 {
            return Err(Error::ClassCount { classes: 1, needs: "probabilities need two" });
        }
        Ok(())
    }

    fn train(&self, data: &Labeled<'_>) -> Result<Model, Error> {
        let effort = Effort { epsilon: self.epsilon, seed: self.seed, monitor: self.monitor };
        let has_choice = self.candidates.len() > 1;
        if !(has_choice || self.reject.is_some() || self.calibrate) {
            let learned = Learned::of(&data.all(), &self.candidates[0], &effort)?;
            return Ok(self.model(data, learned, None, vec![]));
        }
        let tried = held_out(data, &self.candidates, self.folds, &effort)?;
        if tried[0].places.is_empty() {
            let class = data.classes()[0].clone();
            let needs = "inner folds need a class of two points or more";
            return Err(Error::ClassPoints { class, points: 1, needs });
        }
        let chosen = self.choose(&tried);
        let learn = |&at: &usize| Learned::of(&data.all(), &self.candidates[at], &effort);
        let learned: Vec<Result<Learned, Error>> = chosen.par_iter().map(learn).collect();
        let mut learned = learned.into_iter().collect::<Result<Vec<_>, _>>()?;
        let classes = data.classes().len();
        let (learned, scores) = match (learned.len(), learned.pop()) {
            (1, Some(only)) => (only, tried[chosen[0]].values()),
            (_, last) => {
                learned.extend(last);
                self.committee_of(data, learned, chosen.iter().map(|&at| &tried[at]), classes)?
            }
        };
        let trial = |(&method, tried): (&Method, &HeldOut)| Trial {
            method,
            correct: tried.correct,
            points: tried.places.len() as u64,
        };
        let trials = match has_choice {
            true => self.candidates.iter().zip(&tried).map(trial).collect(),
            false => vec![],
        };
        let labels: Vec<usize> =
            tried[0].places.iter().map(|&i| data.labels()[i] as usize).collect();
        let mut model = self.model(data, learned, None, trials);
        if self.calibrate {
            model.calibration = Some(Calibration::learn(&scores, &labels, classes));
        }
        if let Some(reject) = self.reject {
            let own =
                scores.chunks_exact(classes).zip(&labels).map(|(scores, &label)| scores[label]);
            model.threshold = threshold(&own.collect::<Vec<_>>(), reject);
        }
        Ok(model)
    }

    /// The candidates to keep, in their order.
    fn choose(&self, tried: &[HeldOut]) -> Vec<usize> {
        let most = tried.iter().map(|tried| tried.correct).max().unwrap_or(0);
        match self.committee {
            None => tried.iter().position(|tried| tried.correct == most).into_iter().collect(),
            Some(within) => {
                let least = most as f64 - within * tried[0].places.len() as f64;
                (0..tried.len()).filter(|&at| tried[at].correct as f64 >= least).collect()
            }
        }
    }

    /// A committee, and what it would have said of the points held out.
    fn committee_of<'a>(
        &self,
        data: &Labeled<'_>,
        learned: Vec<Learned>,
        tried: impl Iterator<Item = &'a HeldOut>,
        classes: usize,
    ) -> Result<(Learned, Vec<f64>), Error> {
        let share = 1.0 / learned.len() as f64;
        let (mut members, mut sums) = (vec![], vec![]);
        for (learned, tried) in learned.into_iter().zip(tried) {
            let values = tried.values();
            let deviation = deviation(&values, classes);
            sums.resize(values.len(), 0.0);
            let points = values.chunks_exact(classes).zip(sums.chunks_exact_mut(classes));
            for (values, sums) in points {
                let mean = values.iter().sum::<f64>() / classes as f64;
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += share * (value - mean) / deviation;
                }
            }
            members.push(Member { learned, deviation });
        }
        let learned = Learned {
            method: None,
            preparation: Preparation::learn(&data.all(), Scaling::None, false)?,
            fitted: Fitted::Committee(Committee::of(members)),
            nearest_kernel: None,
        };
        Ok((learned, sums))
    }

    fn model(
        &self,
        data: &Labeled<'_>,
        learned: Learned,
        calibration: Option<Calibration>,
        trials: Vec<Trial>,
    ) -> Model {
        let is_svdd = learned.method.is_some_and(|m| matches!(m.rule, Rule::Svdd { .. }));
        Model {
            classes: data.classes().to_vec(),
            columns: vec![],
            learned,
            threshold: is_svdd.then_some(0.0),
            calibration,
            trials,
        }
    }
}
