//! Figures of a minimum enclosing ball.
//!
//! *Idea.* In the plane and in space the ball is drawn as it is. Beyond, a projection of it hides what matters: almost
//! all points seem to lie deep inside, though many may touch the boundary. So there are two pictures: a projection
//! along the two directions in which the support spreads most, and the distances of all points from the centre.
//! *Guarantee.* The items are read twice at most (once for all, once more for those drawn); what is left out is counted
//! in the caption.

use taut_certify::{Ball, BallCertificate, Items, Solution};
use taut_points::{PointSource, Scratch, gather};

use crate::number::{count, counted, short};
use crate::project::{dot, plane};
use crate::survey::{CLOSE, Scaled, Survey, survey};
use crate::{
    Aspect, Axis, Bar, Circle2, Error, Figure, Layer2, Layer3, Level, Look, Plot, Point2, Point3,
    Projection, Scale, Scene2, Scene3, Series, SeriesLook, Shape2, Shape3, Sphere3, Tone,
};

/// How to draw. Write `DrawOptions { max_points: 5_000, ..Default::default() }`.
#[derive(Clone, Debug, PartialEq)]
pub struct DrawOptions {
    /// Most items drawn, at least 1, default 20,000; the support is always drawn, and the caption names both counts.
    pub max_points: usize,
    /// Width of a figure, pixels, from 240 to 10,000, default 720.
    pub width: f64,
    /// Height of a figure without its caption, pixels, from 180 to 10,000, default 560; plots are lower.
    pub height: f64,
    /// Names of the columns, for the axes; where one is missing, x, y, z or the number of the column stands in.
    pub columns: Vec<String>,
}

impl Default for DrawOptions {
    fn default() -> Self {
        DrawOptions { max_points: 20_000, width: 720.0, height: 560.0, columns: Vec::new() }
    }
}

impl DrawOptions {
    fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| Err(Error::Option { name, value, expected });
        if self.max_points == 0 {
            return wrong("max_points", "0".into(), "at least 1");
        }
        if !(240.0..=10_000.0).contains(&self.width) {
            return wrong("width", self.width.to_string(), "240 to 10,000");
        }
        if !(180.0..=10_000.0).contains(&self.height) {
            return wrong("height", self.height.to_string(), "180 to 10,000");
        }
        Ok(())
    }

    /// The axis of a column in a space of `dim` dimensions.
    fn axis(&self, column: usize, dim: usize) -> Axis {
        match self.columns.get(column) {
            Some(name) if !name.trim().is_empty() => Axis::named(name.trim()),
            _ if dim <= 3 => Axis::named(["x", "y", "z"][column]),
            _ => Axis::named(format!("column {column}")),
        }
    }
}

/// Pictures of a ball and its points: the plane for d ≤ 2, space for d = 3, a projection and the distances from the
/// centre beyond; then the bounds and the gap by pass, where the trace has them.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the ball was made for, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn ball_figures(
    solution: &Solution<Ball>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    check(solution, source)?;
    let scaled = Scaled::new(&solution.answer);
    let survey = survey(&scaled, &solution.certificate, source, options.max_points)?;
    let picture = Picture { solution, source, options, scaled, survey };
    let mut figures = match solution.answer.center.len() {
        1 => vec![Figure::Plane(picture.line()?)],
        2 => vec![Figure::Plane(picture.plane()?)],
        3 => vec![Figure::Space(picture.space()?)],
        _ => {
            let mut figures = vec![Figure::Plane(picture.projection()?)];
            figures.extend(picture.distances()?.map(Figure::Plot));
            figures
        }
    };
    figures.extend(picture.passes().into_iter().map(Figure::Plot));
    Ok(figures)
}

/// What the answer and its points must agree in before anything is drawn.
fn check(solution: &Solution<Ball>, source: &dyn PointSource) -> Result<(), Error> {
    let (ball, certificate) = (&solution.answer, &solution.certificate);
    let agree = |what, expected: usize, found: u64| match expected as u64 == found {
        true => Ok(()),
        false => Err(Error::Mismatch { what, expected: expected as u64, found }),
    };
    let dim = certificate.items.dim(source.dim());
    agree("number of coordinates", ball.center.len(), dim as u64)?;
    if dim == 0 {
        return Err(Error::Mismatch { what: "number of coordinates", expected: 1, found: 0 });
    }
    agree(
        "number of multipliers",
        certificate.support.len(),
        certificate.multipliers.len() as u64,
    )?;
    if let Some(&beyond) = certificate.support.iter().find(|&&id| id >= source.len()) {
        let found = source.len();
        return Err(Error::Mismatch { what: "number of points", expected: beyond + 1, found });
    }
    let numbers =
        (ball.center.iter().chain(&ball.center_tail).map(|&v| ("a coordinate of the centre", v)))
            .chain([("the radius", ball.radius)])
            .chain(certificate.multipliers.iter().map(|&v| ("a multiplier", v)));
    for (what, value) in numbers {
        if !value.is_finite() {
            return Err(Error::NonFinite { what: what.into(), value });
        }
    }
    if ball.radius < 0.0 {
        return Err(Error::NonFinite {
            what: "the square root of the squared radius".into(),
            value: f64::NAN,
        });
    }
    Ok(())
}

/// What all pictures of one ball share.
struct Picture<'a> {
    solution: &'a Solution<Ball>,
    source: &'a dyn PointSource,
    options: &'a DrawOptions,
    scaled: Scaled,
    survey: Survey,
}

impl Picture<'_> {
    fn ball(&self) -> &Ball {
        &self.solution.answer
    }

    fn certificate(&self) -> &BallCertificate {
        &self.solution.certificate
    }

    fn dim(&self) -> usize {
        self.ball().center.len()
    }

    /// "point" or "ball".
    fn thing(&self) -> &'static str {
        match self.certificate().items {
            Items::Points => "point",
            Items::Balls => "ball",
        }
    }

    fn title(&self) -> String {
        format!(
            "Smallest ball around {}, d = {}",
            counted(self.source.len(), self.thing()),
            self.dim()
        )
    }

    /// The lower bound on the radius that the certificate claims.
    fn lower(&self) -> f64 {
        let gap = self.certificate().gap;
        if gap.is_finite() && gap >= 0.0 { self.ball().radius / (1.0 + gap) } else { 0.0 }
    }

    /// Whether the lower bound can be told from the ball by eye.
    fn lower_is_visible(&self) -> bool {
        let lower = self.lower();
        lower > 0.0 && self.ball().radius - lower > 0.004 * self.ball().radius
    }

    /// Radius and gap in words.
    fn facts(&self) -> String {
        let gap = match self.certificate().gap {
            gap if !gap.is_finite() => "no gap is certified".to_owned(),
            gap => format!("certified relative gap {}", short(gap, 3)),
        };
        let bound = match (self.lower_is_visible(), self.dim()) {
            (false, _) => "",
            (true, 1) => " The dashed line is the lower bound: no enclosing interval is shorter.",
            (true, 2) => " The dashed circle is the lower bound: no enclosing ball is smaller.",
            (true, 3) => " The dashed sphere is the lower bound: no enclosing ball is smaller.",
            (true, _) => {
                " The dashed circle has the radius of the lower bound: no enclosing ball is smaller."
            }
        };
        format!("Radius {}; {gap}.{bound}", short(self.ball().radius, 8))
    }

    /// What is drawn of how many, and what the support is.
    fn counts(&self) -> String {
        let (n, drawn) = (self.source.len(), self.survey.ids.len() as u64);
        let thing = self.thing();
        let support = self.certificate().support.len() as u64;
        let mut words = match support {
            1 => format!(" One support {thing} decides the ball."),
            k => format!(
                " {} support {thing}s decide the ball: the larger the mark, the larger the multiplier.",
                count(k)
            ),
        };
        if drawn == n {
            words += &match n {
                1 => format!(" The one {thing} is drawn."),
                n => format!(" All {} are drawn.", counted(n, thing)),
            };
        } else {
            words += &format!(
                " {} of {} are drawn: the support, {} more that reach far, and an even sample of the others.",
                count(drawn),
                counted(n, thing),
                count(self.survey.far),
            );
        }
        if self.survey.outside > 0 {
            words += &format!(
                " {} {} outside the ball: the answer does not fit these {thing}s.",
                counted(self.survey.outside, thing),
                if self.survey.outside == 1 { "reaches" } else { "reach" },
            );
        }
        words
    }

    /// Radius of the disc of a point that is not of the support, pixels.
    fn dot_size(&self) -> f64 {
        match self.survey.ids.len() {
            0..=100 => 3.6,
            101..=1000 => 2.8,
            1001..=5000 => 2.0,
            _ => 1.4,
        }
    }

    /// Radius of the disc of a support point, pixels: its area grows with the multiplier.
    fn support_size(&self, multiplier: f64) -> f64 {
        let largest = self.certificate().multipliers.iter().fold(0.0_f64, |a, &m| a.max(m));
        if largest > 0.0 { 4.0 + 4.5 * (multiplier.max(0.0) / largest).sqrt() } else { 4.0 }
    }

    /// The items to draw that are not of the support.
    fn others(&self) -> Vec<u64> {
        let mut support = self.certificate().support.clone();
        support.sort_unstable();
        self.survey.ids.iter().copied().filter(|id| support.binary_search(id).is_err()).collect()
    }

    /// The marks of the support: number, size, and the multiplier in words.
    fn support(&self) -> impl Iterator<Item = (u64, f64, String)> + '_ {
        let certificate = self.certificate();
        certificate.support.iter().zip(&certificate.multipliers).map(|(&id, &multiplier)| {
            (
                id,
                self.support_size(multiplier),
                format!("support, multiplier {}", short(multiplier, 4)),
            )
        })
    }

    fn others_name(&self) -> String {
        match self.certificate().items {
            Items::Points => "points".into(),
            Items::Balls => "balls of the input".into(),
        }
    }

    fn support_name(&self) -> String {
        format!("support ({})", counted(self.certificate().support.len() as u64, self.thing()))
    }

    /// The layers of a plane picture; `place` says where an item is drawn, and its own radius.
    fn layers(
        &self,
        place: impl Fn(u64) -> Result<([f64; 2], f64), Error>,
        center: [f64; 2],
        answer: &str,
    ) -> Result<Vec<Layer2>, Error> {
        let others = self.others();
        let places = others.iter().map(|&id| place(id)).collect::<Result<Vec<_>, _>>()?;
        let size = self.dot_size();
        let mut layers = vec![Layer2 {
            name: answer.to_owned(),
            tone: Tone::Answer,
            look: Look::Filled,
            shape: Shape2::Circles(vec![Circle2 { id: None, center, radius: self.ball().radius }]),
        }];
        let balls = self.certificate().items == Items::Balls;
        if !others.is_empty() {
            let shape = if balls {
                let circle = |(&id, &(center, radius)): (&u64, &([f64; 2], f64))| Circle2 {
                    id: Some(id),
                    center,
                    radius,
                };
                Shape2::Circles(others.iter().zip(&places).map(circle).collect())
            } else {
                let point = |(&id, &(at, _)): (&u64, &([f64; 2], f64))| Point2 {
                    id: Some(id),
                    at,
                    size,
                    label: String::new(),
                };
                Shape2::Points(others.iter().zip(&places).map(point).collect())
            };
            layers.push(Layer2 {
                name: self.others_name(),
                tone: Tone::Point,
                look: Look::Filled,
                shape,
            });
        }
        if self.lower_is_visible() {
            layers.push(Layer2 {
                name: "lower bound".into(),
                tone: Tone::Bound,
                look: Look::Dashed,
                shape: Shape2::Circles(vec![Circle2 { id: None, center, radius: self.lower() }]),
            });
        }
        let mut marks = Vec::new();
        let mut circles = Vec::new();
        for (id, size, label) in self.support() {
            let (at, radius) = place(id)?;
            marks.push(Point2 { id: Some(id), at, size, label });
            circles.push(Circle2 { id: None, center: at, radius });
        }
        if balls {
            layers.push(Layer2 {
                name: String::new(),
                tone: Tone::Support,
                look: Look::Filled,
                shape: Shape2::Circles(circles),
            });
        }
        layers.push(Layer2 {
            name: self.support_name(),
            tone: Tone::Support,
            look: Look::Solid,
            shape: Shape2::Points(marks),
        });
        layers.push(Layer2 {
            name: "centre".into(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape2::Crosses(vec![center]),
        });
        Ok(layers)
    }

    /// The row of an item.
    fn row(&self, id: u64) -> Result<Vec<f64>, Error> {
        Ok(gather(self.source, &[id])?)
    }

    /// d = 1: the ball is an interval.
    fn line(&self) -> Result<Scene2, Error> {
        let (center, radius) = (self.ball().center[0], self.ball().radius);
        let own = |row: &[f64]| if row.len() > 1 { row[1] } else { 0.0 };
        let mut layers = self.layers(
            |id| self.row(id).map(|row| ([row[0], 0.0], own(&row))),
            [center, 0.0],
            "smallest ball, an interval",
        )?;
        let half = 0.3 * radius;
        let band = |reach: f64, half: f64| {
            let (a, b) = (center - reach, center + reach);
            Shape2::Polygons(vec![vec![[a, -half], [b, -half], [b, half], [a, half]]])
        };
        for layer in &mut layers {
            if let Shape2::Circles(circles) = &layer.shape {
                layer.shape = match layer.tone {
                    Tone::Answer => band(radius, half),
                    Tone::Bound => band(self.lower(), 0.8 * half),
                    _ => Shape2::Polylines(
                        circles
                            .iter()
                            .map(|c| {
                                vec![[c.center[0] - c.radius, 0.0], [c.center[0] + c.radius, 0.0]]
                            })
                            .collect(),
                    ),
                };
            }
        }
        Ok(Scene2 {
            title: self.title(),
            caption: format!(
                "{}{} The vertical direction has no meaning.",
                self.facts(),
                self.counts()
            ),
            x: self.options.axis(0, 1),
            y: Axis::default(),
            aspect: Aspect::Free,
            layers,
            width: self.options.width,
            height: self.options.height.min(260.0),
        })
    }

    /// d = 2: as it is.
    fn plane(&self) -> Result<Scene2, Error> {
        let own = |row: &[f64]| row.get(2).copied().unwrap_or(0.0);
        let center = [self.ball().center[0], self.ball().center[1]];
        let layers = self.layers(
            |id| self.row(id).map(|row| ([row[0], row[1]], own(&row))),
            center,
            "smallest ball",
        )?;
        Ok(Scene2 {
            title: self.title(),
            caption: self.facts() + &self.counts(),
            x: self.options.axis(0, 2),
            y: self.options.axis(1, 2),
            aspect: Aspect::Equal,
            layers,
            width: self.options.width,
            height: self.options.height,
        })
    }

    /// d = 3: to be turned.
    fn space(&self) -> Result<Scene3, Error> {
        let others = self.others();
        let balls = self.certificate().items == Items::Balls;
        let center = [self.ball().center[0], self.ball().center[1], self.ball().center[2]];
        let sphere = |id, radius| Sphere3 { id, center, radius };
        let mut layers = vec![Layer3 {
            name: "smallest ball".into(),
            tone: Tone::Answer,
            look: Look::Filled,
            shape: Shape3::Spheres(vec![sphere(None, self.ball().radius)]),
        }];
        let rows = gather(self.source, &others)?;
        let at = |row: &[f64]| [row[0], row[1], row[2]];
        if !others.is_empty() {
            let each = others.iter().zip(rows.chunks_exact(self.source.dim()));
            let shape = if balls {
                let ball = |(&id, row): (&u64, &[f64])| Sphere3 {
                    id: Some(id),
                    center: at(row),
                    radius: row[3],
                };
                Shape3::Spheres(each.map(ball).collect())
            } else {
                let size = self.dot_size();
                let point = |(&id, row): (&u64, &[f64])| Point3 {
                    id: Some(id),
                    at: at(row),
                    size,
                    label: String::new(),
                };
                Shape3::Points(each.map(point).collect())
            };
            layers.push(Layer3 {
                name: self.others_name(),
                tone: Tone::Point,
                look: Look::Filled,
                shape,
            });
        }
        if self.lower_is_visible() {
            layers.push(Layer3 {
                name: "lower bound".into(),
                tone: Tone::Bound,
                look: Look::Dashed,
                shape: Shape3::Spheres(vec![sphere(None, self.lower())]),
            });
        }
        let (mut marks, mut spheres) = (Vec::new(), Vec::new());
        for (id, size, label) in self.support() {
            let row = self.row(id)?;
            marks.push(Point3 { id: Some(id), at: at(&row), size, label });
            spheres.push(Sphere3 {
                id: None,
                center: at(&row),
                radius: row.get(3).copied().unwrap_or(0.0),
            });
        }
        if balls {
            layers.push(Layer3 {
                name: String::new(),
                tone: Tone::Support,
                look: Look::Filled,
                shape: Shape3::Spheres(spheres),
            });
        }
        layers.push(Layer3 {
            name: self.support_name(),
            tone: Tone::Support,
            look: Look::Solid,
            shape: Shape3::Points(marks),
        });
        layers.push(Layer3 {
            name: "centre".into(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape3::Crosses(vec![center]),
        });
        Ok(Scene3 {
            title: self.title(),
            caption: self.facts() + &self.counts(),
            axes: [0, 1, 2].map(|k| self.options.axis(k, 3)),
            layers,
            projection: Projection::Perspective,
            azimuth: 35.0,
            elevation: 22.0,
            width: self.options.width,
            height: self.options.height,
        })
    }

    /// d > 3: where the support spreads most.
    fn projection(&self) -> Result<Scene2, Error> {
        let dim = self.dim();
        let (directions, shares) = self.directions()?;
        let place = |id| {
            let row = self.row(id)?;
            let offset: Vec<f64> = self.scaled.offset(&row).collect();
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
    fn directions(&self) -> Result<([Vec<f64>; 2], Option<[f64; 2]>), Error> {
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
        Ok((directions, shares))
    }

    /// d > 3: how far every item reaches from the centre.
    fn distances(&self) -> Result<Option<Plot>, Error> {
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
            Items::Balls => "distance from the centre to the far side",
        };
        Ok(Some(Plot {
            title: format!("How far the {thing}s reach"),
            caption: format!(
                "{} of {} come within {} % of the radius. Each bar counts the {thing}s of one range of distances{}.",
                count(self.survey.close),
                counted(self.source.len(), thing),
                short(100.0 * CLOSE, 2),
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

    /// Bounds and gap after each pass.
    fn passes(&self) -> Vec<Plot> {
        let history = &self.solution.trace.history;
        if history.is_empty() {
            return Vec::new();
        }
        let long = history.len() > 200;
        let drawn = chosen(history.len(), 400);
        let series = |name: &str, tone, look, value: &dyn Fn(usize) -> f64| Series {
            name: name.to_owned(),
            tone,
            look,
            points: drawn
                .iter()
                .map(|&i| [(i + 1) as f64, value(i)])
                .filter(|p| p[1].is_finite())
                .collect(),
        };
        let shown = if drawn.len() < history.len() {
            format!(
                " {} of {} are drawn.",
                count(drawn.len() as u64),
                counted(history.len() as u64, "pass").replace("passs", "passes")
            )
        } else {
            String::new()
        };
        let look = if long { SeriesLook::Line } else { SeriesLook::LineAndDots };
        let plot = |title: &str, caption: String, y: Axis, y_scale, series| Plot {
            title: title.to_owned(),
            caption,
            x: Axis::named("pass over all points"),
            y,
            x_scale: if long { Scale::Log } else { Scale::Linear },
            y_scale,
            series,
            bars: Vec::new(),
            levels: Vec::new(),
            width: self.options.width,
            height: (self.options.height * 0.62).max(180.0),
        };
        let gap = |i: usize| history[i].upper / history[i].lower - 1.0;
        let gap = |i: usize| if history[i].upper == 0.0 { 0.0 } else { gap(i).max(0.0) };
        let unbounded = history.iter().filter(|pass| pass.lower <= 0.0 && pass.upper > 0.0).count();
        let exact = drawn.iter().any(|&i| gap(i) == 0.0);
        let mut gap_words =
            format!("Upper bound divided by lower bound, minus 1, on a logarithmic scale.{shown}");
        if unbounded > 0 {
            gap_words += &format!(
                " The first {} had no lower bound yet.",
                if unbounded == 1 {
                    "pass".to_owned()
                } else {
                    format!("{} passes", count(unbounded as u64))
                }
            );
        }
        if exact {
            gap_words += " An open mark at the lower edge is a gap of 0.";
        }
        vec![
            plot(
                "Bounds on the radius by pass",
                format!("After each pass the smallest radius lies between the two curves.{shown}"),
                Axis::named("radius"),
                Scale::Linear,
                vec![
                    series("upper bound: encloses all", Tone::Answer, look, &|i| history[i].upper),
                    series(
                        "lower bound: proved",
                        Tone::Bound,
                        if long { SeriesLook::Dashed } else { look },
                        &|i| history[i].lower,
                    ),
                ],
            ),
            plot(
                "Gap by pass",
                gap_words,
                Axis::named("relative gap"),
                Scale::Log,
                vec![series("", Tone::Third, look, &gap)],
            ),
        ]
    }
}

/// At most about `most` of `n` indices, evenly on a logarithmic axis, with the first and the last.
fn chosen(n: usize, most: usize) -> Vec<usize> {
    if n <= most {
        return (0..n).collect();
    }
    let step = (n as f64).ln() / (most - 1) as f64;
    let mut indices: Vec<usize> =
        (0..most).map(|k| ((k as f64 * step).exp().round() as usize).clamp(1, n) - 1).collect();
    indices.push(n - 1);
    indices.dedup();
    indices
}
