//! The errors of classifiers and of their evaluation.

use taut_points::{InputError, ReadError};

/// Why there is no model, prediction or figure.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The numbers of points and of labels differ.
    #[error("{labels} labels for {points} points: each point needs one")]
    LabelCount {
        /// Labels there are.
        labels: usize,
        /// Points there are.
        points: usize,
    },
    /// A label is not the number of a class.
    #[error(
        "the label of point {row} is {label}, but the {classes} classes have the numbers from 0"
    )]
    Label {
        /// Point, from 0.
        row: usize,
        /// Its label.
        label: u32,
        /// Classes there are.
        classes: usize,
    },
    /// A class has too few points.
    #[error("class `{class}` has {points} points: {needs}")]
    ClassPoints {
        /// Its name.
        class: String,
        /// Points it has.
        points: usize,
        /// What needs more of them.
        needs: &'static str,
    },
    /// There are too few classes for the method.
    #[error(
        "there {} {classes} {}: {needs}",
        if *classes == 1 { "is" } else { "are" },
        if *classes == 1 { "class" } else { "classes" }
    )]
    ClassCount {
        /// Classes there are.
        classes: usize,
        /// What needs more of them.
        needs: &'static str,
    },
    /// A name stands for two classes.
    #[error("two classes have the name `{name}`")]
    ClassName {
        /// The name.
        name: String,
    },
    /// Points have another dimension than those of the training.
    #[error("points have {found} coordinates, but the model was trained on {expected}")]
    Dimension {
        /// Coordinates of a point.
        found: usize,
        /// Coordinates of the training points.
        expected: usize,
    },
    /// The number is beyond what the method can calculate with.
    #[error(
        "the sizes of the coordinates are beyond what double precision can hold: scale them towards 1"
    )]
    Overflow,
    /// A matrix of all pairs of points does not fit into memory.
    #[error(
        "{points} points: the kernel matrix of all pairs does not fit into memory; use fewer points or another method"
    )]
    TooLarge {
        /// Points of the training.
        points: usize,
    },
    /// The text is no model.
    #[error("this is no model of taut: {problem}")]
    NoModel {
        /// What is wrong with it.
        problem: String,
    },
    /// The model has a version that this release does not know.
    #[error(
        "the model has version {found}, and this release reads version {known}: train it again, or use the release that wrote it"
    )]
    Version {
        /// Version of the model.
        found: u64,
        /// The version that can be read.
        known: u64,
    },
    /// An evaluation has no scores to work on.
    #[error("there are no {what} scores: error rates need both genuine and impostor ones")]
    NoScores {
        /// Which are missing.
        what: &'static str,
    },
    /// A score is NaN.
    #[error("{what} score {index} is NaN: scores must be ordered")]
    ScoreNan {
        /// Which kind of score.
        what: &'static str,
        /// Its number, from 0.
        index: usize,
    },
    /// A ball could not be found.
    #[error(transparent)]
    Enclose(taut_enclose::Error),
    /// Invalid points or options, or cancellation by the caller.
    #[error(transparent)]
    Input(#[from] InputError),
}

impl Error {
    /// An option that is out of its range.
    pub(crate) fn option(name: &'static str, value: String, expected: &'static str) -> Self {
        Error::Input(InputError::Option { name, value, expected })
    }
}

impl From<taut_enclose::Error> for Error {
    fn from(error: taut_enclose::Error) -> Self {
        match error {
            taut_enclose::Error::Input(error) => Error::Input(error),
            taut_enclose::Error::Overflow => Error::Overflow,
            other => Error::Enclose(other),
        }
    }
}

impl From<ReadError> for Error {
    fn from(error: ReadError) -> Self {
        Error::Input(error.into())
    }
}
