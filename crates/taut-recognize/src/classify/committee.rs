//! A committee: the mean of the scores of several classifiers, each divided by its spread.
//!
//! *Idea.* Inner folds tell few methods apart. All that come near the best one vote by score, after the scores of a point are centered
//! over the classes and divided by the standard deviation that this had on points not trained on.

use serde::{Deserialize, Serialize};

use super::rule::Learned;
use super::{Classifier, Score};

/// The members.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Committee {
    members: Vec<Member>,
}

/// A classifier and the spread of its scores.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Member {
    pub(super) learned: Learned,
    pub(super) deviation: f64,
}

impl Committee {
    pub(super) fn of(members: Vec<Member>) -> Self {
        Committee { members }
    }

    pub(super) fn members(&self) -> impl Iterator<Item = &Learned> {
        self.members.iter().map(|member| &member.learned)
    }

    pub(super) fn is_sound(&self, dim: usize, classes: usize) -> bool {
        !self.members.is_empty()
            && self.members.iter().all(|member| {
                // A committee of committees could be nested without end in a file.
                !member.learned.is_committee()
                    && member.deviation > 0.0
                    && member.learned.is_sound(dim, classes)
            })
    }
}

/// The standard deviation of scores of points, class after class, centered over the classes; 1 where there is none.
pub(super) fn deviation(scores: &[f64], classes: usize) -> f64 {
    let squares: f64 = scores
        .chunks_exact(classes)
        .map(|scores| {
            let mean = scores.iter().sum::<f64>() / classes as f64;
            scores.iter().map(|score| (score - mean) * (score - mean)).sum::<f64>()
        })
        .sum();
    let deviation = (squares / scores.len() as f64).sqrt();
    if deviation > 0.0 && deviation.is_finite() { deviation } else { 1.0 }
}

impl Classifier for Committee {
    fn dim(&self) -> usize {
        self.members[0].learned.dim()
    }

    fn classes(&self) -> usize {
        self.members[0].learned.classes()
    }

    fn scores(&self, x: &[f64], out: &mut [Score]) {
        let mut own = vec![Score::default(); out.len()];
        out.fill(Score::default());
        let share = 1.0 / self.members.len() as f64;
        for member in &self.members {
            member.learned.scores(x, &mut own);
            let mean = own.iter().map(|score| score.value).sum::<f64>() / own.len() as f64;
            for (out, own) in out.iter_mut().zip(&own) {
                out.value += share * (own.value - mean) / member.deviation;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn the_deviation_is_over_points_and_classes() {
        assert_eq!(super::deviation(&[-1.0, 1.0, 3.0, 9.0], 2), (20f64 / 4.0).sqrt());
        assert_eq!(super::deviation(&[2.0, 2.0], 2), 1.0);
    }
}
