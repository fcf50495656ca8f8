//! Scenes whose steps all show the same part of the plane.

use taut_draw::{Aspect, Axis, Circle2, Figure, Layer2, LineStyle, Point2, Scene2, Shape2, Tone};

use super::Table;

/// Most points in a picture; of more, each so-manieth is drawn.
const DRAWN_MAX: usize = 3000;

/// A box that holds all that any step shows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    low: [f64; 2],
    high: [f64; 2],
}

impl Frame {
    /// The box around all points.
    pub(super) fn of(table: &Table) -> Self {
        let mut frame = Frame { low: [f64::INFINITY; 2], high: [f64::NEG_INFINITY; 2] };
        (0..table.len()).for_each(|row| frame.hold(table.place(row), 0.0));
        frame
    }

    /// Grows so that a disc is held.
    pub(super) fn hold(&mut self, center: [f64; 2], radius: f64) {
        for k in 0..2 {
            self.low[k] = self.low[k].min(center[k] - radius);
            self.high[k] = self.high[k].max(center[k] + radius);
        }
    }

    /// Grows by a part of its sides.
    pub(super) fn padded(mut self, part: f64) -> Self {
        for k in 0..2 {
            let more = part * (self.high[k] - self.low[k]);
            (self.low[k], self.high[k]) = (self.low[k] - more, self.high[k] + more);
        }
        self
    }

    /// Tests whether a disc lies in it.
    pub(super) fn holds(&self, center: [f64; 2], radius: f64) -> bool {
        (0..2).all(|k| center[k] - radius >= self.low[k] && center[k] + radius <= self.high[k])
    }

    /// A figure that shows all of this box, whatever its layers hold.
    pub(super) fn figure(
        &self,
        table: &Table,
        title: String,
        caption: String,
        layers: Vec<Layer2>,
    ) -> Figure {
        let corner = |at| Point2 { id: None, at, size: 0.0, label: String::new() };
        let corners = Shape2::Points(vec![corner(self.low), corner(self.high)]);
        let layers = layers.into_iter().filter(|layer| !is_empty(&layer.shape));
        let name = |k: usize| {
            let usual = ["x", "y"][k].to_owned();
            Axis::named(table.names.get(k).cloned().unwrap_or(usual))
        };
        Figure::Plane(Scene2 {
            title,
            caption,
            x: name(0),
            y: name(1),
            aspect: Aspect::Equal,
            layers: layers.chain([layer("", Tone::Muted, LineStyle::Solid, corners)]).collect(),
            width: 720.0,
            height: 560.0,
        })
    }
}

fn is_empty(shape: &Shape2) -> bool {
    match shape {
        Shape2::Points(marks) => marks.is_empty(),
        Shape2::Crosses(marks) => marks.is_empty(),
        Shape2::Circles(marks) => marks.is_empty(),
        Shape2::Polylines(marks) | Shape2::Polygons(marks) => marks.is_empty(),
        Shape2::Texts(marks) => marks.is_empty(),
    }
}

pub(super) fn layer(name: &str, tone: Tone, line_style: LineStyle, shape: Shape2) -> Layer2 {
    Layer2 { name: name.to_owned(), tone, line_style, shape }
}

/// All points, or each so-manieth of many.
pub(super) fn cloud(table: &Table, name: &str) -> Layer2 {
    let rows: Vec<usize> =
        (0..table.len()).step_by(table.len().div_ceil(DRAWN_MAX).max(1)).collect();
    marked(table, &rows, name, Tone::Point, if rows.len() > 500 { 1.3 } else { 2.2 })
}

/// Some rows as discs of a size.
pub(super) fn marked(table: &Table, rows: &[usize], name: &str, tone: Tone, size: f64) -> Layer2 {
    let mark = |&row: &usize| Point2 {
        id: Some(row as u64),
        at: table.place(row),
        size,
        label: String::new(),
    };
    layer(name, tone, LineStyle::Solid, Shape2::Points(rows.iter().map(mark).collect()))
}

/// Circles of one meaning.
pub(super) fn circles(
    name: &str,
    tone: Tone,
    style: LineStyle,
    of: impl IntoIterator<Item = ([f64; 2], f64)>,
) -> Layer2 {
    let circle = |(center, radius)| Circle2 { id: None, center, radius };
    layer(name, tone, style, Shape2::Circles(of.into_iter().map(circle).collect()))
}
