//! Pictures of the plane: layers of marks in data coordinates.

use crate::{DrawOptions, LineStyle, Tone};

/// A picture in the plane, in data coordinates: axes and layers of marks, the first layer lowest.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene2 {
    /// The subject of the picture.
    pub title: String,
    /// A description in sentences, with every count named.
    pub caption: String,
    /// Horizontal axis.
    pub x: Axis,
    /// Vertical axis.
    pub y: Axis,
    /// States whether both axes share one scale.
    pub aspect: Aspect,
    /// The marks.
    pub layers: Vec<Layer2>,
    /// Width of the picture, pixels.
    pub width: f64,
    /// Height of the picture without caption, pixels.
    pub height: f64,
}

impl Scene2 {
    /// Layers in the coordinates of the plane, both axes in one scale.
    pub(crate) fn plane(
        title: String,
        caption: String,
        layers: Vec<Layer2>,
        options: &DrawOptions,
    ) -> Self {
        let [x, y] = [0, 1].map(|k| options.axis(k, 2));
        let DrawOptions { width, height, .. } = *options;
        Scene2 { title, caption, x, y, aspect: Aspect::Equal, layers, width, height }
    }

    /// Layers without axes in a square picture.
    pub(crate) fn square(
        title: String,
        caption: String,
        layers: Vec<Layer2>,
        options: &DrawOptions,
    ) -> Self {
        let side = options.width.max(options.height);
        let [x, y] = [Axis::default(), Axis::default()];
        Scene2 { title, caption, x, y, aspect: Aspect::Equal, layers, width: side, height: side }
    }
}

/// The quantity that an axis measures.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Axis {
    /// The name of the quantity; an empty name hides the axis.
    pub name: String,
    /// The unit, shown in brackets; may be empty.
    pub unit: String,
}

impl Axis {
    /// An axis without a unit.
    pub fn named(name: impl Into<String>) -> Self {
        Axis { name: name.into(), unit: String::new() }
    }
}

/// States whether one unit is as long on the vertical axis as on the horizontal one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Aspect {
    /// Circles are round.
    #[default]
    Equal,
    /// Each axis fills the picture.
    Free,
}

/// Marks of one meaning.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer2 {
    /// The entry in the legend; an empty name makes none.
    pub name: String,
    /// The role of the marks.
    pub tone: Tone,
    /// The way in which lines and areas are drawn; points and text ignore it.
    pub line_style: LineStyle,
    /// The marks.
    pub shape: Shape2,
}

/// The marks a layer can have; all coordinates are data coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape2 {
    /// Discs of a size in pixels.
    Points(Vec<Point2>),
    /// Crosses of a fixed size in pixels.
    Crosses(Vec<[f64; 2]>),
    /// Circles of a radius in data units.
    Circles(Vec<Circle2>),
    /// Open chains of segments.
    Polylines(Vec<Vec<[f64; 2]>>),
    /// Closed chains of segments.
    Polygons(Vec<Vec<[f64; 2]>>),
    /// Words at places.
    Texts(Vec<Text2>),
}

/// A point as a disc.
#[derive(Clone, Debug, PartialEq)]
pub struct Point2 {
    /// Its number in the input, from 0, shown on hovering.
    pub id: Option<u64>,
    /// Where it is.
    pub at: [f64; 2],
    /// Radius of the disc, pixels.
    pub size: f64,
    /// Further text on hovering; may be empty.
    pub label: String,
}

/// A circle.
#[derive(Clone, Debug, PartialEq)]
pub struct Circle2 {
    /// Its number in the input, from 0, shown on hovering.
    pub id: Option<u64>,
    /// Its center.
    pub center: [f64; 2],
    /// Its radius, at least 0, in data units.
    pub radius: f64,
}

/// A word at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct Text2 {
    /// The middle of its baseline.
    pub at: [f64; 2],
    /// The word.
    pub text: String,
}
