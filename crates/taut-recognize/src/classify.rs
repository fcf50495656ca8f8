//! Classifiers behind one trait: learn from labeled points, then find the classes of new ones.
//!
//! | method | a class is | for |
//! |---|---|---|
//! | [`Rule::NearestBox`] | a box in each coordinate | few points, features of equal weight (thesis, 7.5) |
//! | [`Rule::Ball`] | the smallest ball of a Gaussian kernel | the classifier of the thesis (7.6) |
//! | [`Rule::Ball`] with [`Method::whitening`] | a ball after whitening within classes | many classes of few points |
//! | [`Rule::Svdd`] | a soft ball, which also rejects | outliers, one class or several |
//! | [`Rule::Svm`] | one side of a largest margin | most data; the best single method here |
//! | [`Rule::Mahalanobis`] | a mean and a covariance | verification, nearly normal data |
//! | [`Rule::Plda`] | a mean, drawn like those of the other classes | people, with posterior probabilities |
//!
//! Scaling, whitening, widths, thresholds and the choice among candidates are learned from the training points alone.

mod ball;
mod boxes;
mod calibrate;
mod cluster;
mod committee;
mod covariance;
mod data;
mod dense;
mod folds;
mod mahalanobis;
mod method;
mod model;
mod plda;
mod prepare;
mod presets;
mod rule;
mod select;
mod svm;
mod train;
mod whitener;
mod width;

pub use cluster::{ClusterOptions, Clustering, cluster};
pub use data::Labeled;
pub(crate) use data::check_finite;
pub use folds::stratified_folds;
pub use method::{Cells, Covariance, Method, Rule, Scaling};
pub use model::{Model, Prediction};
pub use presets::{Preset, PresetOptions};
pub use select::Trial;
pub use train::{TrainOptions, train, train_with_background};
pub use whitener::Whitener;
pub use width::Width;

/// How well a class fits a point.
///
/// Scores are compared by value, then by what breaks ties: where all values of kernels vanish in double precision their logarithms
/// still differ, and a point in several boxes is nearer to the center of one.
#[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd)]
pub struct Score {
    /// The larger, the better. Its meaning depends on the method.
    pub value: f64,
    /// Decides between equal values.
    pub tie: f64,
}

/// Something that scores classes.
pub trait Classifier: Send + Sync {
    /// Coordinates of a point.
    fn dim(&self) -> usize;

    /// The number of classes.
    fn classes(&self) -> usize;

    /// Writes the score of each class for the point `x` of `dim` coordinates; `out` has a place for each class.
    fn scores(&self, x: &[f64], out: &mut [Score]);

    /// The class with the best score, the first of equal ones, and that score.
    fn best(&self, x: &[f64]) -> (usize, Score) {
        let mut scores = vec![Score::default(); self.classes()];
        self.scores(x, &mut scores);
        best_of(&scores)
    }
}

/// The place of the best score, the first of equal ones.
pub(crate) fn best_of(scores: &[Score]) -> (usize, Score) {
    let mut best = (0, scores.first().copied().unwrap_or_default());
    for (class, &score) in scores.iter().enumerate().skip(1) {
        if score > best.1 {
            best = (class, score);
        }
    }
    best
}
