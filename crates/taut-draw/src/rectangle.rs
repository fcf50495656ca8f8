//! The figures of the largest rectangles in a polygon, along the axes and of any direction.
//!
//! *Guarantee.* The rings are drawn as they are, but for vertices that are nearer to the one before than a pixel.

use taut_certify::{InscribedOrientedRectangle, InscribedRectangle, Solution};
use taut_points::PointSource;

use crate::marks::all_finite;
use crate::number::{counted, exact};
use crate::rings::Rings;
use crate::{Aspect, DrawOptions, Error, Figure, Layer2, LineStyle, Scene2, Shape2, Tone};

/// The picture of a rectangle along the axes in the polygon whose rings are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` has rows of more than three numbers, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn rectangle_figures(
    solution: &Solution<InscribedRectangle>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    let answer = &solution.answer;
    let (low, high) = (answer.low, answer.high);
    let picture = Picture {
        name: "rectangle along the axes",
        corners: [low, [high[0], low[1]], high, [low[0], high[1]]],
        area: answer.area,
        sides: [high[0] - low[0], high[1] - low[1]],
        gap: solution.certificate.gap,
    };
    picture.figures(source, options)
}

/// The picture of a rectangle of any direction in the polygon whose rings are the rows of `source`.
///
/// # Errors
/// As for [`rectangle_figures`].
pub fn oriented_rectangle_figures(
    solution: &Solution<InscribedOrientedRectangle>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    let answer = &solution.answer;
    let long = 2.0 * answer.axis[0].hypot(answer.axis[1]);
    let picture = Picture {
        name: "rectangle",
        corners: answer.corners(),
        area: answer.area,
        sides: [long, answer.ratio * long],
        gap: solution.certificate.gap,
    };
    picture.figures(source, options)
}

/// A rectangle and what is said of it.
struct Picture {
    name: &'static str,
    corners: [[f64; 2]; 4],
    area: f64,
    sides: [f64; 2],
    gap: f64,
}

impl Picture {
    fn figures(
        &self,
        source: &dyn PointSource,
        options: &DrawOptions,
    ) -> Result<Vec<Figure>, Error> {
        options.check()?;
        let coordinates = self.corners.as_flattened().iter();
        all_finite(coordinates.map(|x| ("a coordinate of a corner", x)))?;
        let rings = Rings::read(source)?;
        let layer = |name: &str, tone, shape| Layer2 {
            name: name.to_owned(),
            tone,
            line_style: LineStyle::Solid,
            shape,
        };
        let gap = options.gap_words("relative gap", self.gap);
        let [one, other] = self.sides.map(exact);
        let points = counted(source.len(), "point");
        let scene = Scene2 {
            title: format!("Largest {} in a polygon of {points}", self.name),
            caption: format!("Area {}, {one} by {other}; {gap}.", exact(self.area)),
            x: options.axis(0, 2),
            y: options.axis(1, 2),
            aspect: Aspect::Equal,
            layers: vec![
                layer("polygon", Tone::Point, Shape2::Polygons(rings.outlines(options))),
                layer(
                    "largest rectangle",
                    Tone::Answer,
                    Shape2::Polygons(vec![self.corners.to_vec()]),
                ),
            ],
            width: options.width,
            height: options.height,
        };
        Ok(vec![Figure::Plane(scene)])
    }
}
