//! The methods that find a triangle, and their options.

use taut_points::{InputError, choice};

/// Range of the number of random points: three are a triangle, and the triples of more take minutes.
const SAMPLE_COUNTS: std::ops::RangeInclusive<u64> = 3..=4096;

/// How the triangle is found. The upper bound comes from the branch and bound in either case.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum TriangleMethod {
    /// The largest triangle, by branch and bound with local ascents.
    #[default]
    BranchAndBound,
    /// The largest triangle whose corners are random points inside that see each other, as in section 8.3 of the thesis.
    Thesis(TriangleThesisOptions),
}

choice! { "method", TriangleMethod {
    BranchAndBound = "branch-and-bound", "the largest triangle, within the gap that is asked for";
    Thesis(TriangleThesisOptions::DEFAULT) = "thesis",
        "the largest triangle among random points that see each other";
}}

/// Options of [`TriangleMethod::Thesis`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleThesisOptions {
    /// Random points, uniform in the polygon, 3 to 4096. Default 300.
    pub sample_count: u64,
    /// Seed of the random points. Default 1.
    pub seed: u64,
}

impl TriangleThesisOptions {
    /// The default options.
    pub const DEFAULT: Self = TriangleThesisOptions { sample_count: 300, seed: 1 };

    pub(super) fn check(&self) -> Result<(), InputError> {
        match SAMPLE_COUNTS.contains(&self.sample_count) {
            true => Ok(()),
            false => Err(InputError::Option {
                name: "sample_count",
                value: self.sample_count.to_string(),
                expected: "a number from 3 to 4096",
            }),
        }
    }
}

impl Default for TriangleThesisOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}
