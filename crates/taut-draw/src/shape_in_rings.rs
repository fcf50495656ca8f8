//! The figure of a shape of largest area in a polygon.
//!
//! *Guarantee.* The rings are drawn as they are, but for vertices that are nearer to the one before than a pixel; edges that the
//! shape touches are drawn in full.

use taut_points::PointSource;

use crate::number::{counted, exact};
use crate::rings::Rings;
use crate::{Aspect, DrawOptions, Error, Figure, Layer2, LineStyle, Scene2, Shape2, Tone};

/// A shape in the polygon whose rings are the rows of a source.
pub(crate) struct ShapeInRings<'a> {
    /// The noun for the shape.
    pub(crate) name: &'static str,
    /// Its corners, or points along its border.
    pub(crate) outline: Vec<[f64; 2]>,
    pub(crate) area: f64,
    pub(crate) gap: f64,
    /// The rows at which edges begin that it touches; the source has all of them.
    pub(crate) touching: &'a [u64],
}

impl ShapeInRings<'_> {
    /// The picture of the shape, the polygon and the touching edges.
    ///
    /// # Errors
    /// As for reading the rings.
    pub(crate) fn figures(
        self,
        source: &dyn PointSource,
        options: &DrawOptions,
    ) -> Result<Vec<Figure>, Error> {
        let name = self.name;
        let rings = Rings::read(source)?;
        let lines = self.touching.iter().map(|&row| rings.edge(row as usize).to_vec()).collect();
        let layer = |name: &str, tone, shape| Layer2 {
            name: name.to_owned(),
            tone,
            line_style: LineStyle::Solid,
            shape,
        };
        let gap = options.gap_words("relative gap", self.gap);
        let outlines = Shape2::Polygons(rings.outlines(options));
        let scene = Scene2 {
            title: format!("Largest {name} in a polygon of {}", counted(source.len(), "point")),
            caption: format!(
                "Area {}; {gap}. It touches {}.",
                exact(self.area),
                counted(self.touching.len() as u64, "edge")
            ),
            x: options.axis(0, 2),
            y: options.axis(1, 2),
            aspect: Aspect::Equal,
            layers: vec![
                layer("polygon", Tone::Point, outlines),
                layer(
                    &format!("largest {name}"),
                    Tone::Answer,
                    Shape2::Polygons(vec![self.outline]),
                ),
                layer("touching edges", Tone::Support, Shape2::Polylines(lines)),
            ],
            width: options.width,
            height: options.height,
        };
        Ok(vec![Figure::Plane(scene)])
    }
}
