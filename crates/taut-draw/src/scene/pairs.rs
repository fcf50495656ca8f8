//! An ellipsoid of more than three dimensions: its shadows on pairs of coordinates, all in one picture.
//!
//! *Idea.* Below the diagonal of a square of panels stands, for each pair of coordinates, the shadow of the ellipsoid with
//! those of the items; on the diagonal the name and the range of the coordinate. Every panel is scaled so that the
//! ellipse fills it: what is seen of an ellipse is how its two coordinates go together.
//! *Limits.* Of more than seven coordinates the six are drawn whose shadows are tilted most: others say little.

use taut_certify::Items;
use taut_points::OrderBy;

use super::plane::{LARGE_CORNERS, Place, SMALL_CORNERS};
use super::{Group, Layer, Mark, Marks, Scene};
use crate::body::{Body, Shadow};
use crate::item_pass::Measure;
use crate::number::{count, digits};
use crate::{DrawOptions, Figure, Layer2, LineStyle, Point2, Scene2, Shape2, Text2, Tone};

/// Up to this many coordinates are all drawn; of more, one less.
const PAIRED_DIM_MAX: usize = 7;

/// A panel reaches this far, in half-widths of the ellipsoid.
const PANEL_REACH: f64 = 1.12;

/// Where items are left out, panels reach at most this far to hold them as well.
const PANEL_REACH_MAX: f64 = 3.0;

/// Discs of items are this much smaller than in a picture of their own.
const PANEL_DISC_SCALE: f64 = 0.6;

/// Up to this many marks of the support are drawn at half their size; more are drawn smaller.
const PANEL_MARKS_MAX: usize = 30;

/// Half the width of a panel, where panels stand one unit apart.
pub(crate) const PANEL_HALF_WIDTH: f64 = 0.46;

/// Coordinates that are drawn of `dim`.
pub(crate) fn drawn(dim: usize) -> usize {
    if dim <= PAIRED_DIM_MAX { dim } else { PAIRED_DIM_MAX - 1 }
}

/// Most items to draw in each panel for a picture of `max_points` marks.
pub(crate) fn most(max_points: usize, dim: usize) -> usize {
    let panels = drawn(dim) * (drawn(dim) - 1) / 2;
    (max_points / panels).max(1)
}

/// One panel: two coordinates and where it stands.
pub(crate) struct Panel {
    pub(crate) j: usize,
    pub(crate) k: usize,
    pub(crate) middle: Place,
}

/// A panel for each pair of coordinates, below the diagonal.
pub(crate) fn panels(chosen: &[usize]) -> Vec<Panel> {
    let pairs = (0..chosen.len()).flat_map(|row| (0..row).map(move |column| (row, column)));
    pairs
        .map(|(row, column)| Panel {
            j: chosen[column],
            k: chosen[row],
            middle: [column as f64, -(row as f64)],
        })
        .collect()
}

/// The coordinates that are drawn, ascending: of many, those with the largest correlations.
pub(crate) fn coordinates(body: &Body) -> Vec<usize> {
    let dim = body.dim();
    let mut tilted: Vec<(f64, usize)> = (0..dim)
        .map(|j| {
            let others = (0..dim).filter(|&k| k != j);
            (others.map(|k| body.correlation(j, k).abs()).fold(0.0, f64::max), j)
        })
        .collect();
    tilted.order_by(&|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut chosen: Vec<usize> = tilted.into_iter().take(drawn(dim)).map(|(_, j)| j).collect();
    chosen.sort_unstable();
    chosen
}

/// Returns how many coordinates are drawn, and which, where some are not.
pub(crate) fn choice(chosen: &[usize], dim: usize, which: &str) -> String {
    match chosen.len() {
        all if all == dim => String::new(),
        some => format!(" {some} of {dim} coordinates are drawn, those {which}."),
    }
}

/// Panels with their frames below and their diagonal above.
pub(crate) fn framed(
    body: &Body,
    chosen: &[usize],
    options: &DrawOptions,
    layers: impl IntoIterator<Item = Layer2>,
) -> Vec<Layer2> {
    let layer = |tone, line_style, shape| Layer2 { name: String::new(), tone, line_style, shape };
    let frames = panels(chosen).iter().map(|panel| square(panel.middle)).collect();
    let frames = layer(Tone::Muted, LineStyle::Thin, Shape2::Polygons(frames));
    let words = Shape2::Texts(diagonal(body, chosen, options));
    let words = layer(Tone::Ink, LineStyle::Solid, words);
    [frames].into_iter().chain(layers).chain([words]).collect()
}

/// Returns what the diagonal says: the names of coordinates and their ranges over the ellipsoid.
fn diagonal(body: &Body, chosen: &[usize], options: &DrawOptions) -> Vec<Text2> {
    let words = |(i, &j): (usize, &usize)| {
        let (c, w) = (body.center[j], body.half_width(j));
        let at = [i as f64, -(i as f64)];
        let text = format!("{} to {}", digits(c - w, 3), digits(c + w, 3));
        [
            Text2 { at: [at[0], at[1] + 0.08], text: options.axis(j, body.dim()).name },
            Text2 { at: [at[0], at[1] - 0.12], text },
        ]
    };
    chosen.iter().enumerate().flat_map(words).collect()
}

/// The panels of an ellipsoid.
pub(crate) struct Pairs<'a> {
    pub(crate) body: &'a Body,
    chosen: Vec<usize>,
    panels: Vec<Panel>,
    /// The half-width of the panels of each coordinate.
    scales: Vec<f64>,
    /// True if they reach farther than the ellipsoid.
    is_wider: bool,
}

impl<'a> Pairs<'a> {
    /// Panels that reach as far as the ellipsoid, and as far as they can as the rows left out. A coordinate that is constant
    /// has panels of its rounding.
    pub(crate) fn new(body: &'a Body, left_out: &[f64], columns: usize) -> Self {
        let dim = body.dim();
        let width = |j: usize| {
            let least = f64::EPSILON * body.center[j].abs();
            let width = body.half_width(j).max(least);
            if width > 0.0 { width } else { 1.0 }
        };
        let scale = |j: usize| {
            let width = width(j);
            let offsets = left_out.chunks_exact(columns).map(|row| (row[j] - body.center[j]).abs());
            let reach = offsets.map(|offset| offset / width).fold(1.0, f64::max);
            PANEL_REACH * width * reach.min(PANEL_REACH_MAX)
        };
        let chosen = coordinates(body);
        let panels = panels(&chosen);
        let scales = (0..dim).map(scale).collect();
        Pairs { body, chosen, panels, scales, is_wider: !left_out.is_empty() }
    }

    fn place(&self, point: &[f64], panel: &Panel) -> Place {
        let along = |j: usize| (point[j] - self.body.center[j]) / self.scales[j] * PANEL_HALF_WIDTH;
        [panel.middle[0] + along(panel.j), panel.middle[1] + along(panel.k)]
    }

    /// An ellipse in the scales of a panel.
    fn scaled(&self, Shadow([[a, _], [b, c]]): Shadow, panel: &Panel) -> Shadow {
        let [x, y] = [panel.j, panel.k].map(|j| PANEL_HALF_WIDTH / self.scales[j]);
        Shadow([[a * x, 0.0], [b * y, c * y]])
    }

    fn ellipses(&self, body: &Body) -> Shape2 {
        let chain = |panel: &Panel| {
            let shadow = self.scaled(body.shadow(panel.j, panel.k), panel);
            shadow.chain(self.place(&body.center, panel), 1.0, LARGE_CORNERS)
        };
        Shape2::Polygons(self.panels.iter().map(chain).collect())
    }

    fn marks(&self, marks: &[Mark]) -> Shape2 {
        // A panel is small: many marks of full size would hide it.
        let part = if marks.len() <= PANEL_MARKS_MAX { 0.5 } else { 0.3 };
        let in_panels = |mark: &Mark| {
            let point = |panel: &Panel| {
                let at = self.place(&mark.at, panel);
                Point2 { id: Some(mark.id), at, size: part * mark.size, label: mark.label.clone() }
            };
            self.panels.iter().map(point).collect::<Vec<_>>()
        };
        Shape2::Points(marks.iter().flat_map(in_panels).collect())
    }

    /// Items in all panels; counts what falls outside.
    fn items(&self, group: &Group, beyond: &mut u64) -> Shape2 {
        let size = group.scale * (PANEL_DISC_SCALE * group.size).max(1.0);
        let (mut points, mut chains) = (Vec::new(), Vec::new());
        for (id, row) in group.each() {
            for panel in &self.panels {
                let at = self.place(row, panel);
                let [x, y] = panel.middle;
                let clamped = [(at[0], x), (at[1], y)].map(|(v, middle)| {
                    v.clamp(middle - PANEL_HALF_WIDTH, middle + PANEL_HALF_WIDTH)
                });
                let is_inside = (0..2).all(|i| (at[i] - panel.middle[i]).abs() <= PANEL_HALF_WIDTH);
                *beyond += u64::from(!is_inside);
                match Shadow::of_item(group.items, self.body.dim(), row, panel.j, panel.k) {
                    None => {
                        let label = group.label.into();
                        points.push(Point2 { id: Some(id), at: clamped, size, label });
                    }
                    Some(shadow) if is_inside => {
                        chains.push(self.scaled(shadow, panel).chain(at, 1.0, SMALL_CORNERS));
                    }
                    Some(_) => {}
                }
            }
        }
        if group.items == Items::Points { Shape2::Points(points) } else { Shape2::Polygons(chains) }
    }

    fn layer(&self, layer: &Layer<'_>, beyond: &mut u64) -> Option<Layer2> {
        let (mut name, tone, mut line_style) = (layer.name.clone(), layer.tone, layer.line_style);
        let shape = match &layer.marks {
            // A copy as large as the lower bound would fill each panel almost as the ellipsoid does.
            Marks::Ellipsoid { .. } if tone == Tone::Bound => return None,
            Marks::Ellipsoid { body, .. } => {
                if tone == Tone::Answer {
                    name = format!("shadow of the {name}");
                }
                self.ellipses(body)
            }
            Marks::Items(group) => {
                if group.items != Items::Points {
                    line_style = LineStyle::Thin;
                }
                self.items(group, beyond)
            }
            Marks::Points(marks) => self.marks(marks),
            _ => return None,
        };
        let is_empty = matches!(&shape, Shape2::Polygons(chains) if chains.is_empty());
        (!is_empty).then_some(Layer2 { name, tone, line_style, shape })
    }
}

impl Scene<'_> {
    /// The panels of more than three dimensions.
    pub(crate) fn pairs(mut self, pairs: &Pairs<'_>) -> Figure {
        self.layers.retain(|layer| !layer.is_empty());
        let mut beyond = 0;
        let layers: Vec<Layer2> =
            self.layers.iter().filter_map(|layer| pairs.layer(layer, &mut beyond)).collect();
        let has_points = |layer: &Layer<'_>| matches!(&layer.marks, Marks::Items(group) if group.items == Items::Points);
        let [facts, counts] = self.caption;
        let caption = format!(
            "{facts} Shadows on pairs of coordinates, each scaled {}; on the diagonal, the range of the coordinate over \
             the ellipsoid.{}{counts}{}",
            match pairs.is_wider {
                false => "to fill its panel",
                true => "to show what is outside as far as three half-widths out",
            },
            choice(&pairs.chosen, self.dim, "whose shadows are tilted most"),
            match beyond {
                0 => String::new(),
                k => format!(
                    " {} marks fall outside their panels and {}.",
                    count(k),
                    match self.layers.iter().any(has_points) {
                        true => "stand on the border",
                        false => "are not drawn",
                    }
                ),
            },
        );
        let layers = framed(pairs.body, &pairs.chosen, self.options, layers);
        Figure::Plane(Scene2::square(self.title, caption, layers, self.options))
    }
}

fn square([x, y]: Place) -> Vec<Place> {
    vec![
        [x - PANEL_HALF_WIDTH, y - PANEL_HALF_WIDTH],
        [x + PANEL_HALF_WIDTH, y - PANEL_HALF_WIDTH],
        [x + PANEL_HALF_WIDTH, y + PANEL_HALF_WIDTH],
        [x - PANEL_HALF_WIDTH, y + PANEL_HALF_WIDTH],
    ]
}
