//! Options of the search for a triangle.

use taut_points::{InputError, Monitor, choice, shown_number};

/// How to look for the triangle. Write `TriangleOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone)]
pub struct TriangleOptions<'a> {
    /// The way to find it. Default [`TriangleMethod::BranchAndBound`].
    pub method: TriangleMethod,
    /// Proved relative gap of the area to reach, in (0, 1): largest area ≤ (1 + ε)·area. Default 1e-3. With
    /// [`TriangleMethod::Thesis`] the gap between the bound and the best triangle that the branch and bound knows.
    pub epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved. At least 1, by default a million.
    pub max_cells: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for TriangleOptions<'_> {
    fn default() -> Self {
        TriangleOptions {
            method: TriangleMethod::default(),
            epsilon: 1e-3,
            max_cells: 1_000_000,
            monitor: Monitor::silent(),
        }
    }
}

/// The methods.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum TriangleMethod {
    /// Branch and bound, which finds the largest triangle within the gap.
    #[default]
    BranchAndBound,
    /// The largest triangle between random points that see each other, by section 8.3 of the thesis. The bound of the branch and
    /// bound says how far that is from the largest one.
    Thesis(TriangleThesisOptions),
}

choice! { "method", TriangleMethod {
    BranchAndBound = "branch-and-bound", "the largest triangle within the gap";
    Thesis(TriangleThesisOptions::DEFAULT) = "thesis", "the largest one between random points that see each other";
}}

/// Options of [`TriangleMethod::Thesis`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TriangleThesisOptions {
    /// Random points, from 3 to 4096. Default 300.
    pub sample_count: u64,
    /// Seed of the points. Default 1.
    pub seed: u64,
}

impl TriangleThesisOptions {
    /// What [`Default`] says.
    pub const DEFAULT: Self = Self { sample_count: 300, seed: 1 };
}

impl Default for TriangleThesisOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Most random points: triples take time that grows with the cube of them.
const SAMPLES_MAX: u64 = 4096;

pub(super) fn check(options: &TriangleOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number above 0 and below 1");
    }
    if options.max_cells == 0 {
        return wrong("max_cells", "0".to_owned(), "at least 1");
    }
    match options.method {
        TriangleMethod::Thesis(TriangleThesisOptions { sample_count, .. })
            if !(3..=SAMPLES_MAX).contains(&sample_count) =>
        {
            wrong("sample_count", sample_count.to_string(), "a number from 3 to 4096")
        }
        _ => Ok(()),
    }
}
