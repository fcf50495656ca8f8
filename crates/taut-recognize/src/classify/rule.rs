//! What was learned: the map of points and the rule, whichever it is.

use serde::{Deserialize, Serialize};
use taut_points::Monitor;

use super::ball::{BallParameters, Balls, check_nu};
use super::boxes::Boxes;
use super::committee::Committee;
use super::data::Rows;
use super::mahalanobis::Mahalanobis;
use super::method::{Cells, Method, Rule};
use super::plda::Plda;
use super::prepare::Preparation;
use super::svm::Svm;
use super::width::nearest_kernel;
use super::{Classifier, Score};
use crate::Error;

/// A rule with its numbers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum Fitted {
    Boxes(Boxes),
    Balls(Balls),
    Svm(Svm),
    Mahalanobis(Mahalanobis),
    Plda(Plda),
    Committee(Committee),
}

impl Fitted {
    fn classifier(&self) -> &dyn Classifier {
        match self {
            Fitted::Boxes(rule) => rule,
            Fitted::Balls(rule) => rule,
            Fitted::Svm(rule) => rule,
            Fitted::Mahalanobis(rule) => rule,
            Fitted::Plda(rule) => rule,
            Fitted::Committee(rule) => rule,
        }
    }

    fn is_sound(&self, dim: usize, classes: usize) -> bool {
        match self {
            Fitted::Boxes(rule) => rule.is_sound(dim, classes),
            Fitted::Balls(rule) => rule.is_sound(dim, classes),
            Fitted::Svm(rule) => rule.is_sound(dim, classes),
            Fitted::Mahalanobis(rule) => rule.is_sound(dim, classes),
            Fitted::Plda(rule) => rule.is_sound(dim, classes),
            Fitted::Committee(rule) => rule.is_sound(dim, classes),
        }
    }
}

/// A map of points, a rule, and the method that they were learned by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Learned {
    /// None for a committee.
    pub(super) method: Option<Method>,
    pub(super) preparation: Preparation,
    pub(super) fitted: Fitted,
    /// The median kernel value between a training point and its nearest neighbor, where there is a kernel.
    pub(super) nearest_kernel: Option<f64>,
}

/// What the search for optima takes.
#[derive(Clone, Copy)]
pub(super) struct Effort<'a> {
    pub(super) epsilon: f64,
    pub(super) seed: u64,
    pub(super) monitor: Monitor<'a>,
}

impl Learned {
    pub(super) fn of(rows: &Rows, method: &Method, effort: &Effort<'_>) -> Result<Self, Error> {
        Learned::with_background(None, rows, method, effort)
    }

    /// Learns what all classes share from the rows of `background` if there are some, and the classes from `rows`.
    pub(super) fn with_background(
        background: Option<&Rows>,
        rows: &Rows,
        method: &Method,
        effort: &Effort<'_>,
    ) -> Result<Self, Error> {
        let Effort { epsilon, seed, ref monitor } = *effort;
        let learned_from = background.unwrap_or(rows);
        let preparation = Preparation::learn(learned_from, method.scaling, method.whitening)?;
        let prepared = background.map(|rows| preparation.rows(rows)).transpose()?;
        let rows = preparation.rows(rows)?;
        let background = prepared.as_ref().unwrap_or(&rows);
        let balls = |gamma, cells, nu, steps| {
            check_nu(nu)?;
            let parameters = BallParameters { gamma, cells, nu, steps, epsilon, seed };
            Ok::<_, Error>(Fitted::Balls(Balls::learn(&rows, &parameters, monitor)?))
        };
        let (fitted, gamma) = match method.rule {
            Rule::NearestBox => (Fitted::Boxes(Boxes::learn(background, &rows)), None),
            Rule::Ball { width, cells, nu, steps } => {
                let gamma = width.gamma(background)?;
                (balls(gamma, cells, nu, steps)?, Some(gamma))
            }
            Rule::Svdd { width, nu } => {
                let gamma = width.gamma(background)?;
                (balls(gamma, Cells::Power, Some(nu), None)?, Some(gamma))
            }
            Rule::Svm { width, cost } => {
                let gamma = width.gamma(background)?;
                (Fitted::Svm(Svm::learn(&rows, gamma, cost, epsilon, monitor)?), Some(gamma))
            }
            Rule::Mahalanobis { covariance } => {
                (Fitted::Mahalanobis(Mahalanobis::learn(background, &rows, covariance)?), None)
            }
            Rule::Plda => (Fitted::Plda(Plda::learn(background, &rows)?), None),
        };
        let nearest_kernel = gamma.and_then(|gamma| nearest_kernel(&rows, gamma));
        Ok(Learned { method: Some(*method), preparation, fitted, nearest_kernel })
    }

    pub(super) fn is_committee(&self) -> bool {
        matches!(self.fitted, Fitted::Committee(_))
    }

    pub(super) fn is_sound(&self, dim: usize, classes: usize) -> bool {
        self.preparation.is_sound(dim) && self.fitted.is_sound(dim, classes)
    }
}

impl Classifier for Learned {
    fn dim(&self) -> usize {
        self.preparation.dim()
    }

    fn classes(&self) -> usize {
        self.fitted.classifier().classes()
    }

    fn scores(&self, x: &[f64], out: &mut [Score]) {
        self.fitted.classifier().scores(&self.preparation.point(x), out);
    }
}
