//! Alpha shapes of points of space, and the hull that the filter of the thesis leaves.
//!
//! | you want | call |
//! |---|---|
//! | the shape at a radius, each facet with its class | [`alpha_shape`] |
//! | the least radius at which all points are on one solid or in it | [`optimal_alpha`] |
//! | all facets that could be part of a surface, without choosing | [`filtered_hull`] |
//!
//! All signs are exact: a facet or a cell whose radius is the given number belongs to the shape, and one whose radius is larger by
//! whatever little does not.

mod hull;
mod optimal;
mod shape;

pub use super::filter::{AlphaFilter, Emptiness};
pub(super) use hull::passing;
pub use hull::{FilteredHull, filtered_hull};
pub(super) use optimal::least;
pub use optimal::optimal_alpha;
pub use shape::{AlphaShape, FacetClass, alpha_shape};

use taut_points::{InputError, shown_number};

use crate::Error;

/// The radius, unless it is none.
fn checked(alpha: f64) -> Result<f64, Error> {
    if alpha >= 0.0 {
        return Ok(alpha);
    }
    let (value, expected) = (shown_number(alpha), "a radius of at least 0");
    Err(Error::Input(InputError::Option { name: "alpha", value, expected }))
}
