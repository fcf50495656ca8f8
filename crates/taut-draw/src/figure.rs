//! The kinds of picture, so that renderers are written once.

use crate::{Plot, Scene2, Scene3, Views};

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

    /// What the picture shows, in sentences, without markup.
    pub fn caption(&self) -> &str {
        match self {
            Figure::Plane(scene) => &scene.caption,
            Figure::Space(scene) => &scene.caption,
            Figure::Views(views) => &views.scene.caption,
            Figure::Plot(plot) => &plot.caption,
        }
    }
}
