//! How a curve is sought.

use taut_points::{InputError, Monitor, choice, shown_number};

use crate::Error;

/// How to seek a curve; [`Default`] is what most people want.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveOptions<'a> {
    /// Which method; default [`CurveMethod::Auto`].
    pub method: CurveMethod,
    /// Whether curves may have ends; default [`Ends::Auto`].
    pub ends: Ends,
    /// Whether the answer tells the place of each row on the curves; default false.
    pub places: bool,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for CurveOptions<'_> {
    fn default() -> Self {
        Self {
            method: CurveMethod::Auto,
            ends: Ends::Auto,
            places: false,
            threads: None,
            monitor: Monitor::silent(),
        }
    }
}

/// What the methods of the thesis can be told; [`Default`] is its choice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveThesisOptions {
    /// ρ: how much longer than wide the coarse disk of a sample must be. At least 1, default 4.
    pub rho: f64,
    /// ω: the first disk of a sample holds (ln n)^(1 + ω) points. More than 0, default 0.1.
    pub omega: f64,
    /// The least local feature size: the least distance of the curves from their medial axis, in the units of the
    /// coordinates. More than 0; default `None`, which estimates it.
    pub feature: Option<f64>,
}

impl Default for CurveThesisOptions {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl CurveThesisOptions {
    /// What [`Default`] says.
    pub const DEFAULT: Self = Self { rho: 4.0, omega: 0.1, feature: None };

    /// Refuses numbers that are out of range.
    ///
    /// # Errors
    /// [`Error::Input`] with the name of the option.
    pub fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: f64, expected| {
            Err(Error::Input(InputError::Option { name, value: shown_number(value), expected }))
        };
        if !(self.rho >= 1.0 && self.rho.is_finite()) {
            return wrong("rho", self.rho, "a number of at least 1");
        }
        if !(self.omega > 0.0 && self.omega.is_finite()) {
            return wrong("omega", self.omega, "a number above 0");
        }
        match self.feature {
            Some(feature) if !(feature > 0.0 && feature.is_finite()) => {
                wrong("feature", feature, "a number above 0")
            }
            _ => Ok(()),
        }
    }
}

/// Whether curves may have ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ends {
    /// Ends that face each other across a gap in the samples are joined; others stay.
    #[default]
    Auto,
    /// A curve ends where its samples end: nothing is joined across a gap. A tour becomes a path.
    Open,
}

/// The methods.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum CurveMethod {
    /// [`Fit`](Self::Fit) where points are noisy, region by region; else [`NnCrust`](Self::NnCrust) where what it finds is certified, and
    /// on lattices; else [`HnnCrust`](Self::HnnCrust) where it leaves no ends or lines are rugged; else [`Corners`](Self::Corners).
    #[default]
    Auto,
    /// For noisy points: which neighbors belong together is decided first, and then the curve is fitted along the order they have.
    Fit,
    /// For noisy points, the algorithm of section 4.1 of the thesis, step by step.
    Thesis(CurveThesisOptions),
    /// For noisy points, its crude form of section 4.1.2: centers along eigenvectors, and a tour through them.
    ThesisCrude(CurveThesisOptions),
    /// Crust of Amenta, Bern and Eppstein (1998), for samples without noise at ε < 0.252.
    Crust,
    /// One-step crust of Gold and Snoeyink (2001), for samples without noise at ε < 0.42.
    OneStepCrust,
    /// NN-Crust of Dey and Kumar (1999), for samples without noise at ε < 1/3.
    NnCrust,
    /// Conservative crust of Dey, Mehlhorn and Ramos (2000), for samples of curves with ends.
    ConservativeCrust,
    /// HNN-Crust of Ohrhallinger, Mitchell and Wimmer (2016), for samples without noise at ε < 0.47.
    HnnCrust,
    /// Samples without noise of curves with corners, the aim of Dey and Wenger (2001): loops of Delaunay edges that are likely
    /// where short ones with few turns are.
    Corners,
    /// A short tour through all points.
    Tour,
}

choice! { "method", CurveMethod {
    Auto = "auto",
        "fit where the points are noisy, else nn-crust where that is certified, else hnn-crust or corners";
    Fit = "fit", "for noise: neighbors first, then a fit along the order they have";
    Thesis(CurveThesisOptions::DEFAULT) = "thesis", "for noise: slabs and center points, step by step";
    ThesisCrude(CurveThesisOptions::DEFAULT) = "thesis-crude",
        "for noise: centers along eigenvectors, and a tour";
    Crust = "crust", "no noise, samples at ε < 0.252: Amenta, Bern and Eppstein";
    OneStepCrust = "one-step-crust", "no noise, ε < 0.42: Gold and Snoeyink";
    NnCrust = "nn-crust", "no noise, ε < 1/3: Dey and Kumar";
    ConservativeCrust = "conservative-crust",
        "no noise, curves with ends: Dey, Mehlhorn and Ramos";
    HnnCrust = "hnn-crust", "no noise, ε < 0.47: Ohrhallinger, Mitchell and Wimmer";
    Corners = "corners", "no noise, curves with corners";
    Tour = "tour", "a short tour through all points, with a bound";
}}
