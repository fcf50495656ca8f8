//! The kinds of picture, so that renderers are written once, and the answers that have some.

use taut_certify::{
    Answer, Ball, BoundingDop, Centers, ConvexPolygon, Curve, Ellipsoid, InscribedBodies,
    InscribedCircle, InscribedEllipse, InscribedEllipsoid, InscribedOrientedRectangle,
    InscribedRectangle, InscribedTriangle, KernelBall, Order, RobustEllipsoid, Solution, Surface,
    Triangulation,
};
use taut_points::PointSource;

use crate::{DrawOptions, Error, Plot, Scene2, Scene3, Views};

/// An answer that can be drawn. Code that is generic over answers calls this; the functions of this crate do the same by name.
pub trait Figures: Answer + Sized {
    /// Returns the pictures of an answer and its points, the most telling first; none for kinds that have no picture.
    ///
    /// # Errors
    /// [`Error`], as the function for this kind says.
    fn figures(
        found: &Solution<Self>,
        source: &dyn PointSource,
        options: &DrawOptions,
    ) -> Result<Vec<Figure>, Error>;

    /// Returns how many simplices a picture holds: unlike points they are never thinned.
    fn simplices(&self) -> usize {
        0
    }
}

/// Implements [`Figures`] by the function for a kind, and by the number of its simplices where it has some.
macro_rules! drawn_by {
    ($($answer:ty: $figures:path $(, $simplices:expr)?;)*) => {
        $(impl Figures for $answer {
            fn figures(
                found: &Solution<Self>,
                source: &dyn PointSource,
                options: &DrawOptions,
            ) -> Result<Vec<Figure>, Error> {
                $figures(found, source, options)
            }

            $(fn simplices(&self) -> usize {
                $simplices(self)
            })?
        })*
    };
}

drawn_by! {
    Ball: crate::ball_figures;
    KernelBall: crate::kernel_ball_figures;
    Ellipsoid: crate::ellipsoid_figures;
    InscribedEllipsoid: crate::inscribed_figures;
    InscribedCircle: crate::circle_figures;
    InscribedEllipse: crate::ellipse_figures;
    ConvexPolygon: crate::convex_figures;
    InscribedOrientedRectangle: crate::oriented_rectangle_figures;
    InscribedRectangle: crate::rectangle_figures;
    InscribedTriangle: crate::triangle_figures;
    InscribedBodies: crate::bodies_figures;
    BoundingDop: crate::dop_figures;
    RobustEllipsoid: crate::robust_figures;
    Centers: crate::centers_figures;
    Curve: crate::curve_figures;
    Surface: crate::surface_figures, |surface: &Surface| surface.triangles.len();
    Triangulation: crate::delaunay_figures, Triangulation::len;
    Order: no_figures;
}

/// An order of points has no picture.
fn no_figures(
    _: &Solution<Order>,
    _: &dyn PointSource,
    _: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    Ok(Vec::new())
}

/// A picture as data; [`to_svg`](crate::to_svg) and its siblings draw it.
#[derive(Clone, Debug, PartialEq)]
pub enum Figure {
    /// The plane.
    Plane(Scene2),
    /// Space: a fixed view in SVG and PNG, to be turned by hand in HTML.
    Space(Scene3),
    /// Space from several fixed directions, for paper.
    Views(Views),
    /// A line chart or histogram.
    Plot(Plot),
}

impl Figure {
    /// The title, without markup.
    pub fn title(&self) -> &str {
        match self {
            Figure::Plane(scene) => &scene.title,
            Figure::Space(scene) => &scene.title,
            Figure::Views(views) => &views.scene.title,
            Figure::Plot(plot) => &plot.title,
        }
    }

    /// Returns what the picture shows, in sentences, without markup.
    pub fn caption(&self) -> &str {
        match self {
            Figure::Plane(scene) => &scene.caption,
            Figure::Space(scene) => &scene.caption,
            Figure::Views(views) => &views.scene.caption,
            Figure::Plot(plot) => &plot.caption,
        }
    }
}
