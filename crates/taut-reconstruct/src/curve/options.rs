//! How a curve is sought.

/// How to seek a curve; [`Default`] is what most people want.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveOptions {
    /// Which method; default [`CurveMethod::Auto`].
    pub method: CurveMethod,
    /// Whether curves may have ends; default [`Ends::Auto`].
    pub ends: Ends,
    /// Of the methods of the thesis, ρ: how much longer than wide the coarse disk of a sample must be. At least 1, default 4.
    pub rho: f64,
    /// Of the methods of the thesis, ω: the first disk of a sample holds (ln n)^(1 + ω) points. More than 0, default 0.1.
    pub omega: f64,
    /// Of the methods of the thesis, the least local feature size: the least distance of the curves from their medial axis, in the
    /// units of the coordinates. More than 0; default `None`, which estimates it.
    pub feature: Option<f64>,
    /// Whether the answer tells the place of each row on the curves; default false.
    pub places: bool,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
}

impl Default for CurveOptions {
    fn default() -> Self {
        Self {
            method: CurveMethod::Auto,
            ends: Ends::Auto,
            rho: 4.0,
            omega: 0.1,
            feature: None,
            places: false,
            threads: None,
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
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum CurveMethod {
    /// [`Fit`](Self::Fit) where most points are noisy; else [`NnCrust`](Self::NnCrust) or [`Fit`](Self::Fit) where what it finds is
    /// certified; else [`Corners`](Self::Corners).
    #[default]
    Auto,
    /// For noisy points: which neighbours belong together is decided first, and then the curve is fitted along the order they have.
    Fit,
    /// For noisy points, the algorithm of section 4.1 of the thesis, step by step.
    Thesis,
    /// For noisy points, its crude form of section 4.1.2: centres along eigenvectors, and a tour through them.
    ThesisCrude,
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

impl CurveMethod {
    /// All methods with their names on the command line.
    pub const NAMES: [(&'static str, Self); 11] = [
        ("auto", Self::Auto),
        ("fit", Self::Fit),
        ("thesis", Self::Thesis),
        ("thesis-crude", Self::ThesisCrude),
        ("crust", Self::Crust),
        ("one-step-crust", Self::OneStepCrust),
        ("nn-crust", Self::NnCrust),
        ("conservative-crust", Self::ConservativeCrust),
        ("hnn-crust", Self::HnnCrust),
        ("corners", Self::Corners),
        ("tour", Self::Tour),
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, method)| *method == self).map_or("", |(name, _)| name)
    }
}
