//! The choice among candidates by inner folds of the training points.
//!
//! *Idea.* Each candidate is learned on all folds but one and scores the points of that one, in turn. The candidate with most points
//! right is chosen, the first of equal ones; or all that come near it form a committee.
//! *Guarantee.* Nothing but training points is looked at, so that the figures on test points stay honest. The figures of the inner folds
//! are not: the best of many is better by chance.

use serde::{Deserialize, Serialize};
use taut_points::parallel::IntoParallel;

use super::data::Labeled;
use super::method::Method;
use super::rule::{Effort, Learned};
use super::{Classifier, Score, best_of, stratified_folds};
use crate::Error;

/// A candidate and how well it did on the inner folds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Trial {
    /// The candidate.
    pub method: Method,
    /// Points that it got right while not trained on them.
    pub correct: u64,
    /// Points that it was tried on.
    pub points: u64,
}

/// What a candidate said of the points that it was not trained on.
pub(super) struct HeldOut {
    /// The points, by number.
    pub(super) places: Vec<usize>,
    /// Scores of all classes, point after point.
    pub(super) scores: Vec<Score>,
    pub(super) correct: u64,
}

impl HeldOut {
    pub(super) fn values(&self) -> Vec<f64> {
        self.scores.iter().map(|score| score.value).collect()
    }
}

/// Tries each candidate on each fold.
pub(super) fn held_out(
    data: &Labeled<'_>,
    candidates: &[Method],
    folds: usize,
    effort: &Effort<'_>,
) -> Result<Vec<HeldOut>, Error> {
    let fold_of = stratified_folds(data.labels(), folds, effort.seed);
    let parts: Vec<(Vec<usize>, Vec<usize>)> = (0..folds)
        .map(|fold| (0..fold_of.len()).partition(|&i| fold_of[i] != Some(fold)))
        .filter(|parts: &(Vec<usize>, Vec<usize>)| !parts.1.is_empty())
        .collect();
    let count = candidates.len() * parts.len();
    effort.monitor.pass(1, count as u64);
    let quiet = Effort {
        monitor: taut_points::Monitor { cancel: effort.monitor.cancel, ..Default::default() },
        ..*effort
    };
    let work = |task: usize| {
        let (train, test) = &parts[task % parts.len()];
        let found = scores_of(data, &candidates[task / parts.len()], (train, test), &quiet);
        effort.monitor.points(1);
        found
    };
    let found: Vec<Result<Vec<Score>, Error>> = (0..count).into_par_iter().map(work).collect();
    let mut found = found.into_iter();
    let mut all = vec![];
    for _ in candidates {
        let mut one = HeldOut { places: vec![], scores: vec![], correct: 0 };
        for (_, test) in &parts {
            let scores = found.next().into_iter().collect::<Result<Vec<_>, _>>()?.concat();
            one.correct += correct(data, test, &scores);
            one.places.extend(test);
            one.scores.extend(scores);
        }
        all.push(one);
    }
    Ok(all)
}

fn scores_of(
    data: &Labeled<'_>,
    method: &Method,
    (train, test): (&[usize], &[usize]),
    effort: &Effort<'_>,
) -> Result<Vec<Score>, Error> {
    effort.monitor.check().map_err(taut_points::InputError::from)?;
    let learned = Learned::of(&data.subset(train), method, effort)?;
    let classes = data.classes().len();
    let mut scores = vec![Score::default(); test.len() * classes];
    for (&i, out) in test.iter().zip(scores.chunks_exact_mut(classes)) {
        learned.scores(data.points().row(i), out);
    }
    Ok(scores)
}

fn correct(data: &Labeled<'_>, places: &[usize], scores: &[Score]) -> u64 {
    let guesses = scores.chunks_exact(data.classes().len()).map(|scores| best_of(scores).0);
    let hits = places.iter().zip(guesses).filter(|&(&i, guess)| data.labels()[i] as usize == guess);
    hits.count() as u64
}
