//! How far the items of an ellipsoid reach, which its shadows cannot tell.

use taut_certify::Items;

use super::Picture;
use crate::number::{count, counted, short};
use crate::survey::{BORDER_TOLERANCE, Measure};
use crate::{Axis, Bar, Error, Level, Plot, Scale, Series, SeriesLook, Tone};

impl Picture<'_> {
    /// d > 3: |F(x − c)| of every item.
    pub(super) fn reach(&self) -> Result<Plot, Error> {
        let bins = self.survey.bins(48);
        let tallest = bins.iter().map(|bin| bin.2).max().unwrap_or(0);
        // Few items near the border beside many inside would not be seen on a linear axis.
        let y_scale = if tallest >= 200 { Scale::Log } else { Scale::Linear };
        let bars = bins
            .iter()
            .map(|&(from, to, items)| Bar {
                span: [from, to],
                height: items as f64,
                tone: Tone::Point,
            })
            .collect();
        let certificate = self.certificate();
        let mut support = Vec::new();
        for &id in &certificate.support {
            let part = self.body.part(&self.row(id)?, certificate.items);
            support.push([part, if y_scale == Scale::Log { 1.0 } else { 0.0 }]);
        }
        let thing = self.thing();
        let (n, out) = (self.source.len(), certificate.left_out.len() as u64);
        let what = match certificate.items {
            Items::Points => "|F(x − c)|: 0 at the centre, 1 on the border",
            Items::Balls | Items::Ellipsoids => "largest |F(x − c)|: 1 on the border",
        };
        Ok(Plot {
            title: format!("How far the {thing}s reach"),
            caption: format!(
                "{} of {} come within {} % of the border. Each bar counts the {thing}s of one range{}{}.",
                count(self.survey.close),
                counted(n.saturating_sub(out), thing),
                short(100.0 * BORDER_TOLERANCE, 2),
                if y_scale == Scale::Log {
                    "; the count is logarithmic, so that few are seen beside many"
                } else {
                    ""
                },
                if out > 0 {
                    format!("; the {thing}s left out are not counted")
                } else {
                    String::new()
                },
            ),
            x: Axis::named(what),
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
            levels: vec![Level::AtX { x: 1.0, tone: Tone::Answer, label: "border".into() }],
            width: self.options.width,
            height: (self.options.height * 0.62).max(180.0),
        })
    }
}
