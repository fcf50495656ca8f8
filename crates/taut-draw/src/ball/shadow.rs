//! A ball of more than three dimensions: a projection of it, and the distances from its centre.

use taut_certify::Items;
use taut_points::Scratch;

use super::Picture;
use crate::number::{count, counted, short};
use crate::project::{dot, plane};
use crate::survey::{BORDER_TOLERANCE, Measure};
use crate::{Aspect, Axis, Bar, Error, Level, Plot, Scale, Scene2, Series, SeriesLook, Tone};

/// A plane to project on.
struct Shadow {
    /// Two orthonormal directions.
    directions: [Vec<f64>; 2],
    /// Part of the squared radius that lies along each, where the multipliers tell.
    shares: Option<[f64; 2]>,
}

impl Picture<'_> {
    /// d > 3: where the support spreads most.
    pub(super) fn projection(&self) -> Result<Scene2, Error> {
        let dim = self.dim();
        let Shadow { directions, shares } = self.directions()?;
        let place = |id| {
            let row = self.row(id)?;
            let offset = self.scaled.offset(&row);
            let at = [0, 1].map(|k| dot(&offset, &directions[k]) * self.scaled.unit);
            Ok((at, row.get(dim).copied().unwrap_or(0.0)))
        };
        let layers = self.layers(place, [0.0; 2], "shadow of the smallest ball")?;
        let thing = self.thing();
        let shares = match shares {
            Some([a, b]) => format!(
                " Along them lie {} % and {} % of the squared radius; the other {} directions hold the rest.",
                short(100.0 * a, 2),
                short(100.0 * b, 2),
                count(dim as u64 - 2),
            ),
            None => String::new(),
        };
        Ok(Scene2 {
            title: self.title(),
            caption: format!(
                "{} A shadow on the two directions in which the support spreads most.{shares} The circle is the \
                 shadow of the ball: every {thing} falls inside it, and even one that touches the ball usually \
                 falls well inside; the distances from the centre tell which do.{}",
                self.facts(),
                self.counts(),
            ),
            x: Axis::named("first direction of the support, from the centre"),
            y: Axis::named("second direction, from the centre"),
            aspect: Aspect::Equal,
            layers,
            width: self.options.width,
            height: self.options.height,
        })
    }

    /// Two directions, and the part of the squared radius that lies along each.
    fn directions(&self) -> Result<Shadow, Error> {
        let certificate = self.certificate();
        let dim = self.dim();
        // The heaviest multipliers decide; more than this many rows of a high dimension would fill the memory.
        let mut heavy: Vec<usize> = (0..certificate.support.len()).collect();
        heavy.sort_by(|&a, &b| {
            certificate.multipliers[b].total_cmp(&certificate.multipliers[a]).then(a.cmp(&b))
        });
        heavy.truncate(256);
        let mut vectors = Vec::with_capacity(heavy.len() * dim);
        let mut weights = Vec::new();
        for &k in &heavy {
            let row = self.row(certificate.support[k])?;
            vectors.extend(self.scaled.offset(&row));
            weights.push(certificate.multipliers[k].max(0.0));
        }
        // Two support points span a line: a sample of the others, lightly weighed, gives the second direction.
        if heavy.len() < 3 {
            let others = self.others();
            for id in others.iter().step_by((others.len() / 64).max(1)) {
                let row = self.row(*id)?;
                vectors.extend(self.scaled.offset(&row));
                weights.push(1e-4);
            }
        }
        // Lengths of order one, whatever the unit was.
        let reach = vectors.iter().fold(0.0_f64, |a, v| a.max(v.abs()));
        if reach > 0.0 {
            vectors.iter_mut().for_each(|v| *v /= reach);
        }
        let directions = plane(&vectors, &weights, dim);
        let total: f64 = heavy
            .iter()
            .zip(vectors.chunks_exact(dim))
            .map(|(&k, v)| certificate.multipliers[k] * dot(v, v))
            .sum();
        let share = |u: &[f64]| -> f64 {
            let along = heavy.iter().zip(vectors.chunks_exact(dim));
            along.map(|(&k, v)| certificate.multipliers[k] * dot(v, u).powi(2)).sum::<f64>() / total
        };
        let whole = certificate.items == Items::Points && heavy.len() == certificate.support.len();
        let shares = (whole && total > 0.0).then(|| [share(&directions[0]), share(&directions[1])]);
        Ok(Shadow { directions, shares })
    }

    /// d > 3: how far every item reaches from the centre.
    pub(super) fn distances(&self) -> Result<Option<Plot>, Error> {
        let radius = self.ball().radius;
        if radius == 0.0 {
            return Ok(None);
        }
        let bins = self.survey.bins(48);
        let tallest = bins.iter().map(|bin| bin.2).max().unwrap_or(0);
        // Few items near the boundary beside many inside would not be seen on a linear axis.
        let y_scale = if tallest >= 200 { Scale::Log } else { Scale::Linear };
        let bars = bins
            .iter()
            .map(|&(from, to, items)| Bar {
                span: [from * radius, to * radius],
                height: items as f64,
                tone: Tone::Point,
            })
            .collect();
        let mut row = vec![0.0; self.source.dim()];
        let mut scratch = Scratch::new();
        let mut support = Vec::new();
        for &id in &self.certificate().support {
            self.source.read(id..id + 1, &mut scratch)?.copy_row(0, &mut row);
            let reach = self.scaled.reach(&row, self.certificate().items) * self.scaled.unit;
            support.push([reach, if y_scale == Scale::Log { 1.0 } else { 0.0 }]);
        }
        let thing = self.thing();
        let farthest = match self.certificate().items {
            Items::Points => "distance from the centre",
            Items::Balls | Items::Ellipsoids => "distance from the centre to the far side",
        };
        Ok(Some(Plot {
            title: format!("How far the {thing}s reach"),
            caption: format!(
                "{} of {} come within {} % of the radius. Each bar counts the {thing}s of one range of distances{}.",
                count(self.survey.close),
                counted(self.source.len(), thing),
                short(100.0 * BORDER_TOLERANCE, 2),
                if y_scale == Scale::Log {
                    "; the count is logarithmic, so that few are seen beside many"
                } else {
                    ""
                },
            ),
            x: Axis::named(farthest),
            y: Axis::named(format!("{thing}s")),
            x_scale: Scale::Linear,
            y_scale,
            series: vec![Series {
                name: self.support_name(),
                tone: Tone::Support,
                look: SeriesLook::Dots,
                points: support,
            }],
            bars,
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
