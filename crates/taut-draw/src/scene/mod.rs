//! One builder of scenes for every answer that is made of bodies, around items or inside half-spaces.
//!
//! *Idea.* An answer names its layers once, in the coordinates of its points: bodies (balls of one radius, or an ellipsoid),
//! items, marks and centers. A view turns each layer into shapes of the plane or of space: an interval, the plane, space, a
//! projection on two directions, or a panel for each pair of coordinates.

mod histogram;
mod input;
pub(crate) mod pairs;
mod plane;
mod space;

use taut_certify::Items;

pub(crate) use self::histogram::{Histogram, histogram};
pub(crate) use self::input::Input;
pub(crate) use self::pairs::Pairs;
use self::plane::View;
pub(crate) use self::plane::{LARGE_CORNERS, Projected};
pub(crate) use self::space::at;
use crate::body::Body;
use crate::{
    Aspect, Axis, DrawOptions, Figure, Layer3, LineStyle, Scene2, Scene3, Shape2, Shape3, Tone,
};

/// Marks of items left out are this many times as large: their tone is not all that tells them.
pub(crate) const LEFT_OUT_SCALE: f64 = 1.6;

/// The height of the band of an interval, as a part of its length.
pub(crate) const BAND_HEIGHT: f64 = 0.3;

/// Bodies other than the answer have bands of this part of its height.
const INNER_BAND_HEIGHT: f64 = 0.8;

/// An answer as layers, the first lowest, and its words.
pub(crate) struct Scene<'a> {
    pub(crate) title: String,
    /// The caption: what is said first, and what after the words of the view.
    pub(crate) caption: [String; 2],
    pub(crate) dim: usize,
    pub(crate) options: &'a DrawOptions,
    pub(crate) layers: Vec<Layer<'a>>,
    /// In space, the direction to show from its side.
    pub(crate) facing: Option<Vec<f64>>,
}

/// Marks of one meaning.
pub(crate) struct Layer<'a> {
    pub(crate) name: String,
    pub(crate) tone: Tone,
    pub(crate) line_style: LineStyle,
    pub(crate) marks: Marks<'a>,
}

/// The marks of a layer, in the coordinates of the points.
pub(crate) enum Marks<'a> {
    /// Balls of one radius.
    Balls { centers: &'a [Vec<f64>], radius: f64 },
    /// An ellipsoid, all its axes scaled by `part`.
    Ellipsoid { body: &'a Body, part: f64 },
    /// Rows of the input.
    Items(Group),
    /// Points that decide the answer.
    Points(Vec<Mark>),
    /// Centers.
    Crosses(&'a [Vec<f64>]),
    /// Shapes of a picture of the plane, drawn as they are.
    Plane(Shape2),
    /// Shapes of a picture of space, drawn as they are.
    Space(Shape3),
}

/// Rows that are drawn alike.
pub(crate) struct Group {
    pub(crate) items: Items,
    pub(crate) ids: Vec<u64>,
    /// n × columns.
    pub(crate) rows: Vec<f64>,
    pub(crate) columns: usize,
    /// Radius of a disc, pixels, before it is scaled.
    pub(crate) size: f64,
    pub(crate) scale: f64,
    /// Further text of each on hovering.
    pub(crate) label: &'static str,
}

/// A mark where an item decides the answer.
pub(crate) struct Mark {
    pub(crate) id: u64,
    pub(crate) at: Vec<f64>,
    pub(crate) size: f64,
    pub(crate) label: String,
}

impl Group {
    fn each(&self) -> impl Iterator<Item = (u64, &[f64])> {
        self.ids.iter().copied().zip(self.rows.chunks_exact(self.columns))
    }
}

impl<'a> Layer<'a> {
    pub(crate) fn new(
        name: impl Into<String>,
        tone: Tone,
        line_style: LineStyle,
        marks: Marks<'a>,
    ) -> Self {
        Layer { name: name.into(), tone, line_style, marks }
    }

    pub(crate) fn answer(name: impl Into<String>, marks: Marks<'a>) -> Self {
        Layer::new(name, Tone::Answer, LineStyle::Filled, marks)
    }

    pub(crate) fn lower_bound(marks: Marks<'a>) -> Self {
        Layer::new("lower bound", Tone::Bound, LineStyle::Dashed, marks)
    }

    pub(crate) fn support(name: String, marks: Vec<Mark>) -> Self {
        Layer::new(name, Tone::Support, LineStyle::Solid, Marks::Points(marks))
    }

    pub(crate) fn centers(centers: &'a [Vec<f64>]) -> Self {
        let name = if centers.len() == 1 { "center" } else { "centers" };
        Layer::new(name, Tone::Ink, LineStyle::Solid, Marks::Crosses(centers))
    }

    /// Returns true if there is nothing to draw.
    fn is_empty(&self) -> bool {
        match &self.marks {
            Marks::Items(group) => group.ids.is_empty(),
            Marks::Points(marks) => marks.is_empty(),
            _ => false,
        }
    }
}

impl Scene<'_> {
    /// The picture in one, two or three dimensions.
    pub(crate) fn figure(mut self) -> Figure {
        self.layers.retain(|layer| !layer.is_empty());
        match self.dim {
            1 => Figure::Plane(self.line()),
            2 => {
                let layers = self.drawn_in(&View::coordinates(2, None));
                let [facts, counts] = self.caption;
                Figure::Plane(Scene2::plane(self.title, facts + &counts, layers, self.options))
            }
            _ => Figure::Space(self.space()),
        }
    }

    /// The projection on two directions, in more dimensions.
    pub(crate) fn projection(mut self, projected: Projected<'_>) -> Figure {
        self.layers.retain(|layer| !layer.is_empty());
        let Projected { measure, unit, directions, words, axes } = projected;
        let view = View { directions, origin: Some((measure, unit)), height: None };
        let layers = self.drawn_in(&view);
        let [facts, counts] = self.caption;
        let caption = format!("{facts} {words}{counts}");
        let [x, y] = axes.map(Axis::named);
        Figure::Plane(Scene2 { x, y, ..Scene2::plane(self.title, caption, layers, self.options) })
    }

    /// The picture of one dimension: bodies are bands.
    fn line(mut self) -> Scene2 {
        let half = |layer: &Layer<'_>| match (&layer.marks, layer.tone) {
            (Marks::Balls { radius, .. }, Tone::Answer) => *radius,
            (Marks::Ellipsoid { body, .. }, Tone::Answer) => body.half_width(0),
            _ => 0.0,
        };
        let half = self.layers.iter().map(half).fold(0.0, f64::max);
        let layers = self.drawn_in(&View::coordinates(1, Some(BAND_HEIGHT * half)));
        let [facts, counts] = self.caption;
        let caption = format!("{facts}{counts} The vertical direction has no meaning.");
        Scene2 {
            x: self.options.axis(0, 1),
            y: Axis::default(),
            aspect: Aspect::Free,
            height: self.options.height.min(260.0),
            ..Scene2::plane(self.title, caption, layers, self.options)
        }
    }

    fn drawn_in(&mut self, view: &View<'_>) -> Vec<crate::Layer2> {
        std::mem::take(&mut self.layers).into_iter().map(|layer| view.layer(layer)).collect()
    }

    /// The picture of three dimensions, to be turned.
    fn space(self) -> Scene3 {
        let [facts, counts] = self.caption;
        let layers: Vec<Layer3> = self.layers.into_iter().map(space::layer).collect();
        Scene3 {
            azimuth: space::azimuth(self.facing.as_deref()),
            ..Scene3::space(self.title, facts + &counts, layers, self.options)
        }
    }
}
