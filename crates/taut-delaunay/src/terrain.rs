//! Heights over a triangulation of the plane: contour lines and rasters.
//!
//! *Problem.* Points have a height beside x and y. The Delaunay triangulation of x and y carries the surface that is linear in
//! each triangle; the natural neighbors of a place carry a smoother one. Lines of equal height and values on a grid are wanted,
//! of triangulations that memory holds and of those that it does not.
//! *Idea.* One tile after the other, with what lies beside it in others read where it is needed ([`Mosaic`]).
//! *Guarantee.* The triangle that holds a place and the natural neighbors of a place are exact. Each number is computed from
//! corners in an order that coordinates decide, so it is the same, bit by bit, in memory and for every tiling, and from
//! either side of an edge.
//!
//! | module | what |
//! |---|---|
//! | `heights` | heights of sites, from values or from a column of the points |
//! | `linear` | the value in a triangle |
//! | `natural` | Sibson's interpolant |
//! | `raster` | values at the centers of the cells of a grid |
//! | `contours`, `chains` | lines of equal height, and lines from tile to tile |
//! | `wide` | numbers of some 100 bits |

mod chains;
mod contours;
mod heights;
mod linear;
mod natural;
mod raster;
#[cfg(test)]
mod tests;
mod wide;

pub use contours::{ContourOptions, Levels, Stroke, contours};
pub use heights::Heights;
pub use raster::{Interpolation, PutCells, RasterFrame, RasterOptions, raster};

use crate::Error;
use crate::outofcore::Mosaic;

/// A triangulation of the plane with a height for each site.
#[derive(Clone, Copy)]
pub struct Terrain<'a> {
    /// The triangulation of x and y.
    pub mosaic: &'a Mosaic<2>,
    /// The heights, by rows of the input. Of points with equal x and y the first counts.
    pub heights: Heights<'a>,
}

impl Terrain<'_> {
    /// The least and the largest height of the sites; `None` if there are none.
    ///
    /// # Errors
    /// Those of reading, and [`Error::Input`] for a height that is not finite.
    pub fn height_range(&self) -> Result<Option<[f64; 2]>, Error> {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for &number in self.mosaic.tiles() {
            for z in self.heights.of(&self.mosaic.tile(number)?.rows)? {
                range = [range[0].min(z), range[1].max(z)];
            }
        }
        Ok((range[0] <= range[1]).then_some(range))
    }
}
