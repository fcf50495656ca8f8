//! Classifiers built on enclosing balls, how they are evaluated, and recognition of people by the outlines of their hands.
//!
//! | you want | call | promise |
//! |---|---|---|
//! | a classifier from labeled points | [`classify::train`] | everything is learned from the training points alone |
//! | the classes of new points | [`classify::Model::predict`] | the same bits for any number of threads, and after saving and loading |
//! | the best of several methods | [`classify::TrainOptions::candidates`] | chosen by inner folds with a fixed seed |
//! | clusters from the ball of a kernel | [`classify::cluster`] | no number of clusters to choose |
//! | the nearest of a million enrolled people | [`template::Index`] | that of all distances, exactly |
//! | error rates with intervals | [`evaluate`] | the definitions of ISO/IEC 19795-1 |
//!
//! ```
//! use taut_recognize::classify::{Labeled, TrainOptions, train};
//!
//! let values = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 8.0, 8.0, 9.0, 8.0, 8.0, 9.0];
//! let points = taut_points::Points::new(&values, 2)?;
//! let classes = ["near".to_owned(), "far".to_owned()];
//! let data = Labeled::new(points, &[0, 0, 0, 1, 1, 1], &classes)?;
//! let model = train(data, &TrainOptions::default())?;
//! let found = model.predict(taut_points::Points::new(&[8.5, 8.5], 2)?)?;
//! assert_eq!(found[0].class, Some(1));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Not for: training sets that memory does not hold, missing values, or a proof that a class is right.
#![forbid(unsafe_code)]

pub mod classify;
mod error;
pub mod evaluate;
#[cfg(feature = "hand")]
pub mod hand;
#[cfg(feature = "store")]
pub mod store;
pub mod template;

pub use error::Error;
