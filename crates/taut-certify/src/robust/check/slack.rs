//! The tolerances of the numbers of a robust answer.
//!
//! A solver works in `f64` from a center that is itself one: x − c is then right to one rounding, whatever c is, and
//! shapes lose a part κ·2⁻⁵³ of their digits, κ being how thin the points are. Places are off by the rounding of the center
//! besides, which far from the origin is much more. Both are found from the points kept.

use crate::arithmetic::U;
use crate::ellipsoid::check::frame::Frame;

/// The `f64` arithmetic of a solver may be off by this, relatively.
const SOLVER_TOLERANCE: f64 = 1e-9;
/// At most this is granted where coordinates have few digits left.
const TOLERANCE_MAX: f64 = 0.1;

/// Tolerances in the frame, where the border is at 1.
pub(super) struct Slack {
    /// Of scatters, determinants and what is made of them.
    pub(super) of_shapes: f64,
    /// Of the center, and of distances from centers.
    pub(super) of_places: f64,
}

impl Slack {
    /// For points that lie within these extents of the center along the axes.
    pub(super) fn of(frame: &Frame<'_>, extents: &[f64]) -> Self {
        let most = |size: &dyn Fn(usize) -> f64| -> f64 {
            let along = |a: usize| -> f64 {
                let row = frame.full_row(a).iter().enumerate();
                row.map(|(b, f)| f.abs() * (size(b) * frame.scale)).sum()
            };
            (0..frame.rank).map(along).fold(0.0, f64::max)
        };
        let thin = 16.0 * (frame.dim + 4) as f64 * U * most(&|b| extents[b]);
        let far = 8.0 * U * most(&|b| frame.center[b].abs());
        Slack {
            of_shapes: (SOLVER_TOLERANCE + thin).min(TOLERANCE_MAX),
            of_places: (SOLVER_TOLERANCE + thin + far).min(TOLERANCE_MAX),
        }
    }

    /// For a logarithm, or a sum of `terms` of them.
    pub(super) fn of_logarithms(&self, value: f64, terms: usize) -> f64 {
        SOLVER_TOLERANCE * (1.0 + value.abs()) + terms as f64 * self.of_shapes
    }

    /// For numbers that do not depend on the points.
    pub(super) fn of_factor(value: f64) -> f64 {
        SOLVER_TOLERANCE * value
    }
}
