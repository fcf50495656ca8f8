//! Defines how the thesis' method is asked to work.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use taut_points::{InputError, check_threads, choice, shown_number};

use crate::Error;
use crate::surface::filter::{AlphaFilter, Emptiness, Filter};

/// Options to grow the surface; [`Default`] is the thesis' choice. Write `ThesisOptions { epsilon: 1e-3, ..Default::default() }`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThesisOptions {
    /// By how much the equatorial sphere of a facet is shrunk before it has to be empty, relative to its radius. Range [0, 1), default
    /// 2e-5.
    pub epsilon: f64,
    /// Who has to be outside of it. Default [`Emptiness::Apexes`].
    pub emptiness: Emptiness,
    /// Which facets are small enough. Default all.
    pub alpha: AlphaFilter,
    /// Candidates at an edge with a smaller angle between them are slivers on each other, in radians. Range [0, π/2], default π/12.
    pub sliver_angle: f64,
    /// Two triangles do not make a smaller dihedral angle, in radians. Range [0, π/2], default π/4.
    pub forbidden_angle: f64,
    /// The candidates that the front prefers. Default [`Priority::CircumcenterDistance`].
    pub priority: Priority,
    /// The extent of the reconstruction. Default [`Extent::Front`].
    pub extent: Extent,
    /// The treatment of sites where parts of the surface meet in a point. Default [`Pinches::Keep`].
    pub pinches: Pinches,
    /// Moves the points a little before anything else is done with them, as the thesis did for Qhull: by a random number that this
    /// seeds. The answer is that of the moved points. Default none.
    pub joggle: Option<u64>,
    /// Threads to use, 1 to 1024; `None` takes those of the current rayon pool. The answer does not depend on it.
    pub threads: Option<usize>,
}

impl Default for ThesisOptions {
    fn default() -> Self {
        Self {
            epsilon: 2e-5,
            emptiness: Emptiness::default(),
            alpha: AlphaFilter::default(),
            sliver_angle: PI / 12.0,
            forbidden_angle: FRAC_PI_4,
            priority: Priority::default(),
            extent: Extent::default(),
            pinches: Pinches::default(),
            joggle: None,
            threads: None,
        }
    }
}

/// Which triangle the front adds first, and which of those at an edge it likes best: the one with the least.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Priority {
    /// Distance of its circumcenter from that of the triangle at the edge, as the thesis' program has it.
    #[default]
    CircumcenterDistance,
    /// Circumradius, as in the thesis' Lemma 4.4.1.
    Circumradius,
    /// Radius of the smallest empty ball that touches it: Cohen-Steiner and Da, The Visual Computer 20, 2004.
    EmptyBall,
}

choice! { "priority", Priority {
    CircumcenterDistance = "circumcenter-distance",
        "a circumcenter near that of the triangle before";
    Circumradius = "circumradius", "a small circle";
    EmptyBall = "empty-ball", "a small empty ball";
}}

/// When to stop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Extent {
    /// After the filter: all candidates are the answer, no surface as a rule.
    Candidates,
    /// After one front, from the highest candidate.
    #[default]
    Front,
    /// When no candidate is left whose three vertices are on no triangle: each starts another front.
    Restarts,
}

/// The treatment of *pinches*: sites whose triangles are not one fan, because parts of the surface met there in a point and were not
/// joined by an edge until the end.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Pinches {
    /// They stay, and are reported.
    #[default]
    Keep,
    /// Each fan gets a vertex of its own.
    Split,
    /// Only the largest fan of each stays, again and again until there is none.
    Peel,
}

impl ThesisOptions {
    /// The filter, if all options are within their ranges.
    pub(super) fn checked(&self) -> Result<Filter, Error> {
        let angles =
            [("sliver_angle", self.sliver_angle), ("forbidden_angle", self.forbidden_angle)];
        for (name, angle) in angles {
            if !(0.0..=FRAC_PI_2).contains(&angle) {
                let expected = "an angle from 0 to π/2 in radians";
                return Err(Error::Input(InputError::Option {
                    name,
                    value: shown_number(angle),
                    expected,
                }));
            }
        }
        if let Some(threads) = self.threads
            && let Err(refused) = check_threads(threads)
        {
            let (value, expected) = (threads.to_string(), refused.expected);
            return Err(Error::Input(InputError::Option { name: "threads", value, expected }));
        }
        Filter::new(self.epsilon, self.emptiness, self.alpha)
    }
}
