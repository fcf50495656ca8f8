//! The methods that find an ellipse, and their options.

use taut_points::{InputError, choice, shown_number};

/// Range of the number of samples: a hull in ℝ⁵ needs points to start from, and has about as many facets as the square of them.
const SAMPLE_COUNTS: std::ops::RangeInclusive<u64> = 12..=1000;

/// Least semi-axis, in spacings of the samples, at which no ellipse passes between two of them around its center.
const FATNESS_MIN: f64 = 0.5;

/// How the ellipse is found. The upper bound comes from the branch and bound in each case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum EllipseMethod {
    /// The largest ellipse, by branch and bound with local ascents.
    #[default]
    BranchAndBound,
    /// Algorithm 12 of the thesis, with its formulas corrected: ellipses through three samples of the rings and around none.
    Thesis(EllipseThesisOptions),
    /// The implementation of the thesis, section 8.4.2: ellipses through five samples of the rings and around none.
    FivePoint(EllipseThesisOptions),
}

choice! { "method", EllipseMethod {
    BranchAndBound = "branch-and-bound", "the largest ellipse, within the gap that is asked for";
    Thesis(EllipseThesisOptions::DEFAULT) = "thesis",
        "Algorithm 12, corrected: ellipses through three samples and around none";
    FivePoint(EllipseThesisOptions::DEFAULT) = "five-point",
        "ellipses through five samples and around none";
}}

/// Options of [`EllipseMethod::Thesis`] and [`EllipseMethod::FivePoint`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipseThesisOptions {
    /// Samples of the rings, evenly spaced along them, 12 to 1000. Memory grows with the square, time with the cube. Default 200.
    pub sample_count: u64,
    /// c: the least semi-axis, in spacings of the samples; at least ½, as thinner ellipses pass between samples. Default 1.
    pub fatness: f64,
    /// Largest angle between the normals of the ellipse and of the ring at a sample that the ellipse touches, in degrees, above 0 and
    /// below 90. Default 45.
    pub angle: f64,
    /// Seed of the order of insertion and of the perturbation of the samples. Default 1.
    pub seed: u64,
}

impl EllipseThesisOptions {
    /// The default options.
    pub const DEFAULT: Self =
        EllipseThesisOptions { sample_count: 200, fatness: 1.0, angle: 45.0, seed: 1 };

    pub(super) fn check(&self) -> Result<(), InputError> {
        let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
        if !SAMPLE_COUNTS.contains(&self.sample_count) {
            let value = self.sample_count.to_string();
            return wrong("sample_count", value, "a number from 12 to 1000");
        }
        if !(self.fatness >= FATNESS_MIN && self.fatness.is_finite()) {
            return wrong("fatness", shown_number(self.fatness), "a number of at least 0.5");
        }
        if !(self.angle > 0.0 && self.angle < 90.0) {
            return wrong("angle", shown_number(self.angle), "a number above 0 and below 90");
        }
        Ok(())
    }
}

impl Default for EllipseThesisOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}
