//! The parts that are particular to robust ellipsoids: outliers, the ellipsoid around the points kept, distances, a close-up.

use taut_certify::{
    Ellipsoid, EllipsoidCertificate, Items, RobustCertificate, RobustEllipsoid, RobustMethod,
    Solution,
};
use taut_points::PointSource;

use super::{Picture, check};
use crate::body::Body;
use crate::item_pass::Measure;
use crate::number::{count, counted, digits};
use crate::scene::{Layer, Marks};
use crate::{Axis, Error, Figure, Level, LineStyle, Plot, Scale, Series, Tone};

/// The name of the ellipsoid around the points kept, where it is not the answer.
const KEPT_LABEL: &str = "smallest around the points kept";

/// An outlier this far out makes a close-up worth while, in half-widths of the ellipsoid.
const OUTLIER_REACH_MIN: f64 = 4.0;
/// A close-up reaches this far, in half-widths of the ellipsoid.
const CLOSE_UP_REACH: f64 = 2.5;

/// The answer as an ellipsoid around the points that are no outliers. Only by `trim` some of them decide it.
pub(super) fn as_left_out(
    solution: &Solution<RobustEllipsoid>,
) -> (Ellipsoid, EllipsoidCertificate) {
    let certificate = &solution.certificate;
    let (support, multipliers) = match (&certificate.enclosure, certificate.method) {
        (Some(enclosure), RobustMethod::Trim) => {
            let EllipsoidCertificate { support, multipliers, .. } = enclosure.certificate.clone();
            (support, multipliers)
        }
        _ => (vec![], vec![]),
    };
    let certificate = EllipsoidCertificate {
        items: Items::Points,
        support,
        multipliers,
        directions: vec![],
        left_out: solution.answer.outliers.clone(),
        gap: 0.0,
        points_hash: certificate.points_hash,
    };
    (solution.answer.ellipsoid(), certificate)
}

/// The data of a robust ellipsoid.
pub(super) struct Robust<'a> {
    answer: &'a RobustEllipsoid,
    certificate: &'a RobustCertificate,
    /// By `mve`, the smallest ellipsoid around the points kept.
    kept: Option<Body>,
    /// Outliers that a close-up does not show.
    pub(super) beyond: u64,
}

impl<'a> Robust<'a> {
    pub(super) fn of(
        solution: &'a Solution<RobustEllipsoid>,
        source: &dyn PointSource,
    ) -> Result<Self, Error> {
        let (answer, certificate) = (&solution.answer, &solution.certificate);
        let enclosure = certificate.enclosure.as_ref();
        let kept = match enclosure.filter(|_| certificate.method != RobustMethod::Trim) {
            None => None,
            Some(enclosure) => {
                check(&enclosure.ellipsoid, &enclosure.certificate, source)?;
                // Within a flat, two ellipses in one another's place would tell nothing.
                (enclosure.ellipsoid.hull.is_none()).then(|| Body::of(&enclosure.ellipsoid))
            }
        };
        Ok(Robust { answer, certificate, kept, beyond: 0 })
    }

    /// The ellipsoid around the points kept, to compare with.
    pub(super) fn kept_layer(&self) -> Option<Layer<'_>> {
        let marks = Marks::Ellipsoid { body: self.kept.as_ref()?, part: 1.0 };
        Some(Layer::new(KEPT_LABEL, Tone::Second, LineStyle::Dashed, marks))
    }

    pub(super) fn title(&self, points: u64, dim: usize) -> String {
        let close = if self.beyond > 0 { ", from near by" } else { "" };
        format!("Robust ellipsoid of {}, d = {dim}{close}", counted(points, "point"))
    }

    pub(super) fn name(&self) -> String {
        match self.certificate.method {
            RobustMethod::Trim => "smallest ellipsoid around the points kept".into(),
            _ => format!("tolerance ellipsoid, {} %", digits(100.0 * self.certificate.level, 4)),
        }
    }

    pub(super) fn facts(&self) -> String {
        let RobustCertificate { method, kept, level, .. } = self.certificate;
        let meaning = match method {
            RobustMethod::Trim => "Its border is that of the points kept.".to_owned(),
            _ => format!(
                "Were all points normal, it would hold {} % of them.",
                digits(100.0 * level, 4)
            ),
        };
        let flat = match self.answer.hull {
            None => String::new(),
            Some(_) => format!(
                " Most points lie in a flat of dimension {}, and every point off it is an outlier.",
                self.answer.factor.len()
            ),
        };
        format!(
            "By {method}, {} kept; {}. {meaning}{flat}",
            counted(*kept, "point"),
            counted(self.answer.outliers.len() as u64, "outlier"),
        )
    }
}

impl<'a> Picture<'a> {
    /// The same without the outliers far out, where there are some in a picture that shows coordinates.
    pub(super) fn closer(self) -> Result<Option<Self>, Error> {
        if self.dim() > 3 {
            return Ok(None);
        }
        let widths: Vec<f64> = (0..self.dim()).map(|j| self.body.half_width(j)).collect();
        let lies_within = |row: &[f64], reach: f64| {
            let offsets = row.iter().zip(&self.body.center).map(|(x, c)| (x - c).abs());
            offsets.zip(&widths).all(|(offset, width)| offset <= reach * width)
        };
        let out = &self.certificate.left_out;
        let (mut ids, mut is_far) = (Vec::new(), false);
        for &id in &self.input.item_pass.ids {
            if out.binary_search(&id).is_ok() {
                let row = self.input.row(id)?;
                is_far |= !lies_within(&row, OUTLIER_REACH_MIN);
                if !lies_within(&row, CLOSE_UP_REACH) {
                    continue;
                }
            }
            ids.push(id);
        }
        if !is_far {
            return Ok(None);
        }
        let drawn = ids.iter().filter(|id| out.binary_search(id).is_ok()).count();
        let mut closer = self;
        closer.input.item_pass.ids = ids;
        if let Some(robust) = &mut closer.robust {
            robust.beyond = out.len().saturating_sub(drawn) as u64;
        }
        Ok(Some(closer))
    }

    /// |F(x − c)| of the points that are drawn, by row; nothing for a single place, which has no metric.
    pub(super) fn distances(&self) -> Result<Option<Figure>, Error> {
        if self.rank() == 0 {
            return Ok(None);
        }
        let out = &self.certificate.left_out;
        let (mut inside, mut outside) = (Vec::new(), Vec::new());
        for &id in &self.input.item_pass.ids {
            let part = self.body.part(&self.input.row(id)?, Items::Points);
            let is_out = out.binary_search(&id).is_ok();
            let list = if is_out { &mut outside } else { &mut inside };
            list.push([(id + 1) as f64, part]);
        }
        let (n, drawn) = (self.input.source.len(), self.input.item_pass.ids.len() as u64);
        let flat = match self.ellipsoid.hull {
            Some(_) => " Points off the flat are outliers at any distance within it.",
            None => "",
        };
        let shown = match drawn == n {
            true => String::new(),
            false => format!(" {} of {} are drawn.", count(drawn), counted(n, "point")),
        };
        let title = "Distances in the metric of the ellipsoid".into();
        let caption = format!("Outliers lie beyond the border, at 1.{flat}{shown}");
        let axes = ["row", "|F(x − c)|"].map(Axis::named);
        Ok(Some(Figure::Plot(Plot {
            y_scale: Scale::Log,
            series: vec![
                Series::dots("points".into(), Tone::Point, inside),
                Series::dots(self.left_out_name(), Tone::Third, outside),
            ],
            levels: vec![Level::AtY { y: 1.0, tone: Tone::Answer, label: "border".into() }],
            ..Plot::empty(title, caption, axes, self.input.options)
        })))
    }
}
