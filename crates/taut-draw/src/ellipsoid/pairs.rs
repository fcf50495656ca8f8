//! An ellipsoid of more than three dimensions: its shadows on pairs of coordinates, all in one picture.
//!
//! *Idea.* Below the diagonal of a square of panels stands, for each pair of coordinates, the shadow of the ellipsoid with
//! those of the items; on the diagonal the name and the range of the coordinate. Every panel is scaled so that the
//! ellipse fills it: what is seen of an ellipse is how its two coordinates go together.
//! *Limits.* Of more than seven coordinates the six are drawn whose shadows are tilted most: others say little.

use taut_certify::Items;

use super::Picture;
use super::body::{Body, Shadow};
use super::plane::{LARGE_CORNERS, LEFT_OUT_SCALE, Place, SMALL_CORNERS, compared};
use crate::number::{count, short};
use crate::survey::Measure;
use crate::{Aspect, Axis, DrawOptions, Error, Layer2, Look, Point2, Scene2, Shape2, Text2, Tone};

/// Up to this many coordinates are all drawn; of more, one less.
const PAIRED_DIM_MAX: usize = 7;

/// A panel reaches this far, in half-widths of the ellipsoid.
const PANEL_REACH: f64 = 1.12;

/// Where items are left out, panels reach at most this far to hold them as well.
const PANEL_REACH_MAX: f64 = 3.0;

/// Half the width of a panel, where panels stand one unit apart.
pub(crate) const PANEL_HALF_WIDTH: f64 = 0.46;

/// Coordinates that are drawn of `dim`.
pub(crate) fn drawn(dim: usize) -> usize {
    if dim <= PAIRED_DIM_MAX { dim } else { PAIRED_DIM_MAX - 1 }
}

/// Most items to draw in each panel for a picture of `max_points` marks.
pub(super) fn most(max_points: usize, dim: usize) -> usize {
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
    tilted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    let mut chosen: Vec<usize> = tilted.into_iter().take(drawn(dim)).map(|(_, j)| j).collect();
    chosen.sort_unstable();
    chosen
}

/// What the diagonal says: the names of coordinates and their ranges over the ellipsoid.
pub(crate) fn diagonal(body: &Body, chosen: &[usize], options: &DrawOptions) -> Vec<Text2> {
    let words = |(i, &j): (usize, &usize)| {
        let (c, w) = (body.center[j], body.half_width(j));
        let at = [i as f64, -(i as f64)];
        let text = format!("{} to {}", short(c - w, 3), short(c + w, 3));
        [
            Text2 { at: [at[0], at[1] + 0.08], text: options.axis(j, body.dim()).name },
            Text2 { at: [at[0], at[1] - 0.12], text },
        ]
    };
    chosen.iter().enumerate().flat_map(words).collect()
}

impl Picture<'_> {
    /// d > 3.
    pub(super) fn pairs(&self) -> Result<Scene2, Error> {
        let chosen = coordinates(&self.body);
        let panels = panels(&chosen);
        let (inside, out) = self.others();
        let scales = self.scales(&out)?;
        let frames = panels.iter().map(|panel| square(panel.middle)).collect();
        let chains = |body: &Body| {
            let chain = |panel: &Panel| {
                let part = |j: usize| PANEL_HALF_WIDTH / scales[j];
                let Shadow([[a, _], [b, c]]) = body.shadow(panel.j, panel.k);
                let scaled =
                    Shadow([[a * part(panel.j), 0.0], [b * part(panel.k), c * part(panel.k)]]);
                scaled.chain(self.place(&body.center, panel, &scales), 1.0, LARGE_CORNERS)
            };
            Shape2::Polygons(panels.iter().map(chain).collect())
        };
        let line = |name: String, tone, look, shape| Layer2 { name, tone, look, shape };
        let mut layers = vec![
            line(String::new(), Tone::Muted, Look::Thin, Shape2::Polygons(frames)),
            line(
                format!("shadow of the {}", self.name()),
                Tone::Answer,
                Look::Filled,
                chains(&self.body),
            ),
        ];
        layers.extend(self.second().map(|second| compared(chains(second))));
        let mut beyond = 0;
        let size = (0.6 * self.dot_size()).max(1.0);
        for (ids, name, tone, size) in [
            (inside, self.others_name(), Tone::Point, size),
            (out, self.left_out_name(), Tone::Third, LEFT_OUT_SCALE * size),
        ] {
            let layer = Layer2 { name, tone, look: Look::Filled, shape: Shape2::Points(vec![]) };
            layers.extend(self.spread(&ids, layer, size, &panels, &scales, &mut beyond)?);
        }
        let support = self.support()?;
        // A panel is small: many marks of full size would hide it.
        let part = if support.len() <= 30 { 0.5 } else { 0.3 };
        let mut marks = Vec::new();
        for mark in &support {
            for panel in &panels {
                let at = self.place(&mark.at, panel, &scales);
                let (size, label) = (part * mark.size, mark.label.clone());
                marks.push(Point2 { id: Some(mark.id), at, size, label });
            }
        }
        layers.extend(
            (!marks.is_empty()).then(|| {
                line(self.support_name(), Tone::Support, Look::Solid, Shape2::Points(marks))
            }),
        );
        layers.push(line(
            String::new(),
            Tone::Ink,
            Look::Solid,
            Shape2::Texts(diagonal(&self.body, &chosen, self.options)),
        ));
        let side = self.options.width.max(self.options.height);
        Ok(Scene2 {
            title: self.title(),
            caption: format!(
                "{} Shadows on pairs of coordinates, each scaled {}; on the diagonal, the range of the \
                 coordinate over the ellipsoid.{}{}{}",
                self.facts(),
                match self.certificate().left_out.is_empty() {
                    true => "to fill its panel",
                    false => "to show what is outside as far as three half-widths out",
                },
                self.choice(&chosen),
                self.counts(),
                match beyond {
                    0 => String::new(),
                    k => format!(
                        " {} marks fall outside their panels and {}.",
                        count(k),
                        match self.certificate().items {
                            Items::Points => "stand on the border",
                            Items::Balls | Items::Ellipsoids => "are not drawn",
                        }
                    ),
                },
            ),
            x: Axis::default(),
            y: Axis::default(),
            aspect: Aspect::Equal,
            layers,
            width: side,
            height: side,
        })
    }

    fn choice(&self, chosen: &[usize]) -> String {
        if chosen.len() == self.dim() {
            return String::new();
        }
        format!(
            " {} of {} coordinates are drawn, those whose shadows are tilted most.",
            chosen.len(),
            self.dim()
        )
    }

    /// How far the panels of each coordinate reach: as far as the ellipsoid, and so far as they can as what is left out. A
    /// coordinate that is constant has panels of its rounding.
    fn scales(&self, out: &[u64]) -> Result<Vec<f64>, Error> {
        let width = |j: usize| {
            let least = f64::EPSILON * self.body.center[j].abs();
            let width = self.body.half_width(j).max(least);
            if width > 0.0 { width } else { 1.0 }
        };
        let widths: Vec<f64> = (0..self.dim()).map(width).collect();
        let mut reach = vec![1.0f64; widths.len()];
        for &id in out {
            let row = self.row(id)?;
            for (j, reach) in reach.iter_mut().enumerate() {
                *reach = reach
                    .max((row[j] - self.body.center[j]).abs() / widths[j])
                    .min(PANEL_REACH_MAX);
            }
        }
        Ok(widths.iter().zip(reach).map(|(width, reach)| PANEL_REACH * width * reach).collect())
    }

    fn place(&self, point: &[f64], panel: &Panel, scales: &[f64]) -> Place {
        let along = |j: usize| (point[j] - self.body.center[j]) / scales[j] * PANEL_HALF_WIDTH;
        [panel.middle[0] + along(panel.j), panel.middle[1] + along(panel.k)]
    }

    /// Items in all panels, as a layer like the one given; counts what falls outside.
    fn spread(
        &self,
        ids: &[u64],
        layer: Layer2,
        size: f64,
        panels: &[Panel],
        scales: &[f64],
        beyond: &mut u64,
    ) -> Result<Option<Layer2>, Error> {
        let (dim, items) = (self.dim(), self.certificate().items);
        let (mut points, mut chains) = (Vec::new(), Vec::new());
        for &id in ids {
            let row = self.row(id)?;
            for panel in panels {
                let at = self.place(&row, panel, scales);
                let is_inside = (0..2).all(|i| (at[i] - panel.middle[i]).abs() <= PANEL_HALF_WIDTH);
                *beyond += u64::from(!is_inside);
                match Shadow::of_item(items, dim, &row, panel.j, panel.k) {
                    None => {
                        let at = [0, 1].map(|i| {
                            at[i].clamp(
                                panel.middle[i] - PANEL_HALF_WIDTH,
                                panel.middle[i] + PANEL_HALF_WIDTH,
                            )
                        });
                        points.push(Point2 { id: Some(id), at, size, label: String::new() });
                    }
                    Some(_) if !is_inside => {}
                    Some(Shadow([[a, _], [b, c]])) => {
                        let part = |j: usize| PANEL_HALF_WIDTH / scales[j];
                        let (x, y) = (part(panel.j), part(panel.k));
                        chains.push(Shadow([[a * x, 0.0], [b * y, c * y]]).chain(
                            at,
                            1.0,
                            SMALL_CORNERS,
                        ));
                    }
                }
            }
        }
        if points.is_empty() && chains.is_empty() {
            return Ok(None);
        }
        let (look, shape) = match items {
            Items::Points => (Look::Filled, Shape2::Points(points)),
            Items::Balls | Items::Ellipsoids => (Look::Thin, Shape2::Polygons(chains)),
        };
        Ok(Some(Layer2 { look, shape, ..layer }))
    }
}

pub(crate) fn square([x, y]: Place) -> Vec<Place> {
    vec![
        [x - PANEL_HALF_WIDTH, y - PANEL_HALF_WIDTH],
        [x + PANEL_HALF_WIDTH, y - PANEL_HALF_WIDTH],
        [x + PANEL_HALF_WIDTH, y + PANEL_HALF_WIDTH],
        [x - PANEL_HALF_WIDTH, y + PANEL_HALF_WIDTH],
    ]
}
