//! Options of the search for an ellipse.

use taut_points::{InputError, Monitor, choice, shown_number};

/// How to look for the ellipse. Write `EllipseOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone)]
pub struct EllipseOptions<'a> {
    /// The way to find it. Default [`EllipseMethod::BranchAndBound`].
    pub method: EllipseMethod,
    /// Proved relative gap of the area to reach, in (0, 1): largest area ≤ (1 + ε)·area. Default 1e-3. With
    /// [`EllipseMethod::FivePoint`] the gap between the bound and the best ellipse that the branch and bound knows.
    pub epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved. At least 1, by default a million.
    pub max_cells: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for EllipseOptions<'_> {
    fn default() -> Self {
        EllipseOptions {
            method: EllipseMethod::default(),
            epsilon: 1e-3,
            max_cells: 1_000_000,
            monitor: Monitor::silent(),
        }
    }
}

/// The methods.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum EllipseMethod {
    /// Branch and bound, which finds the largest ellipse within the gap.
    #[default]
    BranchAndBound,
    /// The largest ellipse through five samples of the boundary without a sample in it, by section 8.4.2 of the thesis, shrunk
    /// until no edge enters. The bound of the branch and bound says how far that is from the largest one.
    FivePoint(EllipseFivePointOptions),
}

choice! { "method", EllipseMethod {
    BranchAndBound = "branch-and-bound", "the largest ellipse within the gap";
    FivePoint(EllipseFivePointOptions::DEFAULT) = "five-point", "the largest one through five samples of the boundary";
}}

/// Options of [`EllipseMethod::FivePoint`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipseFivePointOptions {
    /// Samples at even distances along the boundary, from 6 to 400. Default 120.
    pub samples: u64,
    /// The least cosine of the angle between the normals of ellipse and boundary, in (−1, 1). Default 0.7.
    pub normal: f64,
    /// The least small radius, in distances of samples; at least 0. Default 1.
    pub fatness: f64,
}

impl EllipseFivePointOptions {
    /// What [`Default`] says.
    pub const DEFAULT: Self = Self { samples: 120, normal: 0.7, fatness: 1.0 };
}

impl Default for EllipseFivePointOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// Most samples: facets take memory that grows with the square of them.
const SAMPLES_MAX: u64 = 400;

pub(crate) fn check(options: &EllipseOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number above 0 and below 1");
    }
    if options.max_cells == 0 {
        return wrong("max_cells", "0".to_owned(), "at least 1");
    }
    let EllipseMethod::FivePoint(five) = options.method else { return Ok(()) };
    if !(6..=SAMPLES_MAX).contains(&five.samples) {
        return wrong("samples", five.samples.to_string(), "from 6 to 400");
    }
    if !(five.normal > -1.0 && five.normal < 1.0) {
        return wrong("normal", shown_number(five.normal), "a number above -1 and below 1");
    }
    if !(five.fatness >= 0.0 && five.fatness.is_finite()) {
        return wrong("fatness", shown_number(five.fatness), "a number that is at least 0");
    }
    Ok(())
}

/// The error for samples without an ellipse.
pub(super) fn too_few(samples: u64) -> InputError {
    let expected = "more of them, or other tests: no ellipse through five of them passes";
    InputError::Option { name: "samples", value: samples.to_string(), expected }
}
