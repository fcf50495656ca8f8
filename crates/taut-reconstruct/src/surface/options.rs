//! Defines how a surface is sought.

use taut_certify::SurfaceMethod as Kind;
use taut_points::{InputError, Monitor, choice};

use super::filter::{AlphaFilter, Emptiness};
use super::thesis::ThesisOptions;
use crate::Error;

/// Options to seek a surface; [`Default`] is what most people want.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceOptions<'a> {
    /// The way to find it; default [`SurfaceMethod::Tree`] with everything closed.
    pub method: SurfaceMethod,
    /// States whether noise is taken out of the points first, and how; default `None`, which leaves them as they are.
    pub denoise: Option<Denoise>,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

/// The methods, each with its own options. [`SurfaceMethod::kind`] is what the certificate calls it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum SurfaceMethod {
    /// Cells labeled inside or outside by a signed spanning tree.
    Tree(SurfaceMode),
    /// The advancing front of the thesis. Joggled points are others than those given, and refused: for them there is
    /// [`thesis_surface_of_points`](crate::thesis::thesis_surface_of_points).
    Thesis(ThesisOptions),
    /// The alpha shape of this radius, in the unit of the coordinates, at least 0; `None` takes the least one at which all
    /// points are on one solid or in it.
    Alpha(Option<f64>),
    /// The filtered facets of the triangulation, as they are.
    Hull(HullOptions),
}

impl Default for SurfaceMethod {
    fn default() -> Self {
        SurfaceMethod::Tree(SurfaceMode::Closed)
    }
}

impl SurfaceMethod {
    /// Which method it is, without its options.
    pub const fn kind(self) -> Kind {
        match self {
            SurfaceMethod::Tree(_) => Kind::Tree,
            SurfaceMethod::Thesis(_) => Kind::Thesis,
            SurfaceMethod::Alpha(_) => Kind::Alpha,
            SurfaceMethod::Hull(_) => Kind::Hull,
        }
    }
}

/// The method with its default options.
impl From<Kind> for SurfaceMethod {
    fn from(kind: Kind) -> Self {
        match kind {
            Kind::Tree => SurfaceMethod::Tree(SurfaceMode::default()),
            Kind::Thesis => SurfaceMethod::Thesis(ThesisOptions::default()),
            Kind::Alpha => SurfaceMethod::Alpha(None),
            Kind::Hull => SurfaceMethod::Hull(HullOptions::default()),
        }
    }
}

/// Which facets [`SurfaceMethod::Hull`] keeps; as [`ThesisOptions`] says of candidates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HullOptions {
    /// By how much the equatorial sphere of a facet is shrunk before it has to be empty, relative to its radius. Range
    /// [0, 1), default 2e-5.
    pub epsilon: f64,
    /// Who has to be outside of it. Default [`Emptiness::Apexes`].
    pub emptiness: Emptiness,
    /// Which facets are small enough. Default all.
    pub alpha: AlphaFilter,
}

impl Default for HullOptions {
    fn default() -> Self {
        let ThesisOptions { epsilon, emptiness, alpha, .. } = ThesisOptions::default();
        Self { epsilon, emptiness, alpha }
    }
}

impl SurfaceOptions<'_> {
    /// The methods that heed an option, by the name that it has on the command line (`sliver-angle`) or in Python (`sliver_angle`); all
    /// of them, where it is not of some alone.
    pub fn methods_of(option: &str) -> &'static [Kind] {
        use Kind::{Alpha, Hull, Thesis, Tree};
        match option.replace('_', "-").as_str() {
            "open" | "closed" => &[Tree],
            "alpha" => &[Alpha, Thesis, Hull],
            "epsilon" => &[Thesis, Hull],
            "sliver-angle" | "forbidden-angle" | "priority" | "restarts" => &[Thesis],
            _ => &Kind::ALL,
        }
    }
}

/// States whether a surface may have boundaries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceMode {
    /// The boundary of bodies: every component is closed, gaps in the samples are spanned.
    #[default]
    Closed,
    /// Sheets may end where their samples end: triangles much larger than those around them are left out.
    Open,
}

choice! { "mode", SurfaceMode {
    Closed = "closed", "the boundary of bodies: everything is closed";
    Open = "open", "sheets may end where their samples end";
}}

/// The way in which noise is taken out of points before a surface is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct Denoise {
    /// The number of nearest points, itself among them, that determine the sheet of a point. From 4 to 1000; default `None`, which takes 24
    /// where there is little noise, and up to 272 where there is more.
    pub neighbors: Option<usize>,
    /// The number of times that each point is moved onto the paraboloid that fits its neighbors best; 0 moves none and leaves out outliers
    /// alone. At most 100, default 2.
    pub iterations: u32,
    /// Where the vertices of the surface are; default [`Positions::Projected`].
    pub positions: Positions,
}

impl Denoise {
    /// Refuses values outside their ranges.
    pub(super) fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| {
            Err(Error::Input(InputError::Option { name, value, expected }))
        };
        if let Some(neighbors) = self.neighbors.filter(|count| !(4..=1000).contains(count)) {
            return wrong("neighbors", neighbors.to_string(), "a number from 4 to 1000");
        }
        if self.iterations > 100 {
            return wrong("iterations", self.iterations.to_string(), "a number from 0 to 100");
        }
        Ok(())
    }
}

impl Default for Denoise {
    fn default() -> Self {
        Self { neighbors: None, iterations: 2, positions: Positions::Projected }
    }
}

/// Where the vertices of a surface through points with noise are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Positions {
    /// Where the points were moved to.
    #[default]
    Projected,
    /// Where the points were given. The triangles are those of the moved points, so they can meet each other. The certificate is about
    /// the given positions: closed components face outwards there if no triangles meet, and the radius that it names for an alpha
    /// shape is larger than that of the shape if the circle of a triangle is; it names none if a triangle is flat.
    Original,
}
