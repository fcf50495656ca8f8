//! Tight shapes around, through and inside point sets, with proof.
//!
//! ```
//! let points = taut::Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;
//! let found = taut::ball(&points, &taut::BallOptions::default())?;
//! assert!(found.check(&points)?.gap <= 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

pub use taut_certify as certify;
pub use taut_certify::{
    Answer, AnySolution, Ball, BallCertificate, Items, Solution, Trace, Verdict, Violation,
};
pub use taut_enclose as enclose;
pub use taut_enclose::{BallMethod, BallOptions, ball, ball_of_balls, ball_of_source};
pub use taut_points as points;
pub use taut_points::{Distribution, Monitor, PointSource, Points, generate};

/// The Rust in the pages for people, compiled and run with the tests.
#[cfg(doctest)]
mod pages {
    #[doc = include_str!("../../../README.md")]
    struct Readme;
    #[doc = include_str!("../../../docs/ball.md")]
    struct Ball;
}
