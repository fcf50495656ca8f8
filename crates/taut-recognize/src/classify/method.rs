//! What is learned: scaling, whitening, and the rule that scores classes.

use serde::{Deserialize, Serialize};
use taut_points::choice;

use super::width::Width;

/// How coordinates are scaled, by numbers of the training points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Scaling {
    /// To mean 0 and variance 1.
    #[default]
    ZScore,
    /// So that they range from 0 to 100, as in the thesis, where a z-score comes first and changes nothing.
    Percent,
    /// Not at all.
    None,
}

choice! { "scaling", Scaling {
    ZScore = "z-score", "each feature to mean 0 and variance 1";
    Percent = "percent", "each feature from 0 to 100, as in the thesis";
    None = "none", "as they are";
}}

/// How balls divide the feature space.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Cells {
    /// By |φ(x) − c|² − R²: the power diagram.
    #[default]
    Power,
    /// By |φ(x) − c|: the Voronoi diagram of the centers, as in the thesis.
    Voronoi,
}

choice! { "cells", Cells {
    Power = "power", "distances from centers less radii, both squared";
    Voronoi = "voronoi", "distances from centers, as in the thesis";
}}

/// The covariance of [`Rule::Mahalanobis`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Covariance {
    /// One for all classes, pooled within them, with the shrinkage of Ledoit and Wolf.
    #[default]
    Pooled,
    /// ½(Σ of the class + Σ pooled), the verifier of the thesis.
    Thesis,
}

/// What scores a class.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "name", deny_unknown_fields)]
#[non_exhaustive]
pub enum Rule {
    /// The largest distance beyond the box of the class along any coordinate, relative to the largest box (thesis, 7.5).
    NearestBox,
    /// The minimum enclosing ball of the class in the feature space of a Gaussian kernel (thesis, 7.6).
    Ball {
        /// The width of the kernel.
        width: Width,
        /// How the balls divide the space.
        cells: Cells,
        /// ν in (0, 1] of soft balls; None for hard ones.
        nu: Option<f64>,
        /// Steps of Algorithm 11 of the thesis instead of the optimum; at least 2.
        steps: Option<u64>,
    },
    /// Soft balls by their power; a point outside all of them is rejected (support vector data description).
    Svdd {
        /// The width of the kernel.
        width: Width,
        /// ν in (0, 1]: at most this share of a class is outside its ball.
        nu: f64,
    },
    /// A support vector machine with squared slacks, which is a minimum enclosing ball (core vector machine); for more than two
    /// classes, each against the others.
    Svm {
        /// The width of the kernel.
        width: Width,
        /// C > 0 in ½|w|² + ½b² + ½C·Σξ²: the larger, the closer to the training points.
        cost: f64,
    },
    /// The Mahalanobis distance from the mean of the class.
    Mahalanobis {
        /// Of which covariance.
        covariance: Covariance,
    },
    /// The log-likelihood ratio of one class against any other, with normal classes whose means are normal (two-covariance PLDA).
    Plda,
}

/// A way to learn a classifier.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Method {
    /// How coordinates are scaled. Default [`Scaling::ZScore`].
    pub scaling: Scaling,
    /// Whether classes are made round by the inverse of their pooled covariance. Default false.
    pub whitening: bool,
    /// What scores a class. Default: the ball with [`Width::Auto`] and [`Cells::Power`].
    pub rule: Rule,
}

impl Default for Method {
    fn default() -> Self {
        let rule = Rule::Ball { width: Width::Auto, cells: Cells::Power, nu: None, steps: None };
        Method { scaling: Scaling::ZScore, whitening: false, rule }
    }
}
