//! Centres in more than three dimensions: a projection of them, and the distances from the nearest.

use super::Picture;
use crate::number::{count, counted, short};
use crate::project::{dot, plane};
use crate::survey::{BORDER_TOLERANCE, Measure};
use crate::{Aspect, Axis, Bar, Error, Level, Plot, Scale, Scene2, Tone};

/// How lightly items weigh beside centres, where these leave a direction open.
const ITEM_WEIGHT: f64 = 1e-4;
/// Items that are looked at for that; more would take long in high dimensions and change little.
const ITEMS: usize = 64;

impl Picture<'_> {
    /// d > 3: where the centres spread most.
    pub(super) fn projection(&self) -> Result<Scene2, Error> {
        let directions = self.directions()?;
        let place = |at: &[f64]| {
            let offset = self.nearest.offset(at);
            [0, 1].map(|k| dot(&offset, &directions[k]) * self.nearest.unit)
        };
        let layers = self.layers(place, "shadows of the balls".to_owned())?;
        Ok(Scene2 {
            title: self.title(),
            caption: format!(
                "{} A shadow on the two directions in which the centres spread most, from the middle of them. Shadows \
                 of balls may lie over one another where the balls are far apart, and an item that touches a ball \
                 usually falls well inside.{}",
                self.facts(),
                self.counts(),
            ),
            x: Axis::named("first direction of the centres"),
            y: Axis::named("second direction"),
            aspect: Aspect::Equal,
            layers,
            width: self.options.width,
            height: self.options.height,
        })
    }

    /// Two directions: those of the centres, and of a few items where the centres do not span a plane.
    fn directions(&self) -> Result<[Vec<f64>; 2], Error> {
        let mut vectors: Vec<f64> = self.nearest.offsets().flatten().collect();
        let mut weights = vec![1.0; self.answer.centers.len()];
        let [others, core_set, _] = self.groups()?;
        for group in [core_set, others] {
            let rows = group.rows.chunks_exact(self.source.dim());
            for row in rows.step_by((group.ids.len() / ITEMS).max(1)) {
                vectors.extend(self.nearest.offset(&row[..self.dim]));
                weights.push(ITEM_WEIGHT);
            }
        }
        // Lengths of order one, whatever the unit was.
        let reach = vectors.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        if reach > 0.0 {
            vectors.iter_mut().for_each(|v| *v /= reach);
        }
        Ok(plane(&vectors, &weights, self.dim))
    }

    /// d > 3: how far every item reaches from the centre next to it.
    pub(super) fn distances(&self) -> Result<Option<Plot>, Error> {
        let radius = self.answer.radius;
        if radius == 0.0 {
            return Ok(None);
        }
        let bins = self.survey.bins(48);
        let tallest = bins.iter().map(|bin| bin.2).max().unwrap_or(0);
        // Few items near the border beside many inside would not be seen on a linear axis.
        let y_scale = if tallest >= 200 { Scale::Log } else { Scale::Linear };
        let bar = |(from, to, items): (f64, f64, u64)| Bar {
            span: [from * radius, to * radius],
            height: items as f64,
            tone: Tone::Point,
        };
        let thing = self.thing();
        Ok(Some(Plot {
            title: format!("How far the {thing}s reach from the centre next to them"),
            caption: format!(
                "{} of {} come within {} % of the radius; what is left out is not counted.{}",
                count(self.survey.close),
                counted(self.source.len(), thing),
                short(100.0 * BORDER_TOLERANCE, 2),
                if y_scale == Scale::Log {
                    " The count is logarithmic, so that few are seen beside many."
                } else {
                    ""
                },
            ),
            x: Axis::named("distance from the nearest centre"),
            y: Axis::named(format!("{thing}s")),
            x_scale: Scale::Linear,
            y_scale,
            series: vec![],
            bars: bins.into_iter().map(bar).collect(),
            levels: vec![Level::AtX {
                x: radius,
                tone: Tone::Answer,
                label: format!("radius {}", short(radius, 6)),
            }],
            width: self.options.width,
            height: (self.options.height * 0.62).max(180.0),
        }))
    }
}
