//! How a surface is sought.

use taut_certify::SurfaceMethod;
use taut_points::InputError;

use super::thesis::ThesisOptions;
use crate::Error;

/// How to seek a surface; [`Default`] is what most people want.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceOptions {
    /// The way to find it; default [`SurfaceMethod::Tree`].
    pub method: SurfaceMethod,
    /// Whether the surface may have boundaries; default [`SurfaceMode::Closed`]. Of [`SurfaceMethod::Tree`] alone: the other
    /// methods leave boundaries where they end.
    pub mode: SurfaceMode,
    /// Of [`SurfaceMethod::Alpha`], the radius in the unit of the coordinates, at least 0; `None` takes the least one at which all points
    /// are on one solid or in it.
    pub alpha: Option<f64>,
    /// Of [`SurfaceMethod::Thesis`] all, and of [`SurfaceMethod::Hull`] what is said of candidates. Joggled points are others than those
    /// given: for them there is [`thesis_surface_of_points`](crate::thesis::thesis_surface_of_points).
    pub thesis: ThesisOptions,
    /// Whether noise is taken out of the points first, and how; default `None`, which leaves them as they are.
    pub denoise: Option<Denoise>,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
}

impl SurfaceOptions {
    /// The methods that heed an option, by the name that it has on the command line (`sliver-angle`) or in Python (`sliver_angle`); all
    /// of them, where it is not of some alone.
    pub fn methods_of(option: &str) -> &'static [SurfaceMethod] {
        use SurfaceMethod::{Alpha, Hull, Thesis, Tree};
        match option.replace('_', "-").as_str() {
            "open" | "closed" => &[Tree],
            "alpha" => &[Alpha, Thesis, Hull],
            "epsilon" => &[Thesis, Hull],
            "sliver-angle" | "forbidden-angle" | "priority" | "restarts" => &[Thesis],
            _ => &SurfaceMethod::ALL,
        }
    }
}

/// Whether a surface may have boundaries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SurfaceMode {
    /// The boundary of bodies: every component is closed, gaps in the samples are spanned.
    #[default]
    Closed,
    /// Sheets may end where their samples end: triangles much larger than those around them are left out.
    Open,
}

impl SurfaceMode {
    /// All modes with their names on the command line.
    pub const NAMES: [(&'static str, Self); 2] = [("closed", Self::Closed), ("open", Self::Open)];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, mode)| *mode == self).map_or("", |(name, _)| name)
    }
}

/// How noise is taken out of points before a surface is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct Denoise {
    /// How many nearest points, itself among them, say where the sheet of a point is. From 4 to 1000, default 24.
    pub neighbors: usize,
    /// How many times each point is moved onto the paraboloid that fits its neighbours best; 0 moves none and leaves out outliers
    /// alone. At most 100, default 2.
    pub iterations: u32,
    /// Where the vertices of the surface are; default [`Positions::Projected`].
    pub positions: Positions,
}

impl Denoise {
    /// What is outside its range.
    pub(super) fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| {
            Err(Error::Input(InputError::Option { name, value, expected }))
        };
        if !(4..=1000).contains(&self.neighbors) {
            return wrong("neighbors", self.neighbors.to_string(), "a number from 4 to 1000");
        }
        if self.iterations > 100 {
            return wrong("iterations", self.iterations.to_string(), "a number from 0 to 100");
        }
        Ok(())
    }
}

impl Default for Denoise {
    fn default() -> Self {
        Self { neighbors: 24, iterations: 2, positions: Positions::Projected }
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
