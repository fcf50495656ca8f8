//! Figures of a minimum enclosing ball.
//!
//! *Idea.* In the plane and in space the ball is drawn as it is. Beyond, a projection of it hides what matters: almost
//! all points seem to lie deep inside, though many may touch the boundary. So there are two pictures: a projection
//! along the two directions in which the support spreads most, and the distances of all points from the center.
//! *Guarantee.* The items are read twice at most (once for all, once more for those drawn); what is left out is counted
//! in the caption.

use taut_certify::{Ball, BallCertificate, Items, Solution};
use taut_points::{OrderBy, PointSource};

use crate::item_pass::{Measure, PassQuery, Scaled};
use crate::marks::{agree, all_finite, all_there, support_marks};
use crate::number::{count, counted, digits, exact};
use crate::passes::{Words, passes};
use crate::project::{dot, plane, to_unit_reach};
use crate::scene::{Histogram, Input, Layer, Marks, Projected, Scene, histogram};
use crate::{DrawOptions, Error, Figure, Tone};

/// At most this many points of the support choose the directions of a projection: those with the largest multipliers, as
/// more rows of a high dimension would fill the memory.
const PROJECTION_SUPPORT_MAX: usize = 256;
/// About this many other items help to choose them, where the support spans a line only.
const PROJECTION_ITEM_COUNT: usize = 64;
/// The weight of each of those items, beside multipliers whose sum is 1.
const PROJECTION_ITEM_WEIGHT: f64 = 1e-4;

/// Pictures of a ball and its points: the plane for d ≤ 2, space for d = 3, a projection and the distances from the
/// center beyond; then the bounds and the gap by pass, where the trace has them.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the ball was made for, [`Error::NonFinite`],
/// [`Error::NegativeRadius`], [`Error::Option`], [`Error::Read`].
pub fn ball_figures(
    solution: &Solution<Ball>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    check(solution, source)?;
    let scaled = Scaled::new(&solution.answer);
    let question = PassQuery {
        items: solution.certificate.items,
        support: &solution.certificate.support,
        left_out: &[],
        most: options.max_points,
    };
    let input = Input::read(&scaled, &question, source, options)?;
    let picture = Picture { solution, scaled, input };
    let mut figures = match picture.input.dim {
        1..=3 => vec![picture.scene()?.figure()],
        _ => {
            let projected = picture.projected()?;
            let mut figures = vec![picture.scene()?.projection(projected)];
            figures.extend(picture.distances()?);
            figures
        }
    };
    let passes = passes(&solution.trace.history, &Words::ENCLOSING, options);
    figures.extend(passes.into_iter().map(Figure::Plot));
    Ok(figures)
}

/// Checks what the answer and its points must agree in before anything is drawn.
fn check(solution: &Solution<Ball>, source: &dyn PointSource) -> Result<(), Error> {
    let (ball, certificate) = (&solution.answer, &solution.certificate);
    let dim = certificate.items.dim(source.dim());
    agree("number of coordinates", ball.center.len(), dim)?;
    agree("number of coordinates", dim.max(1), dim)?;
    agree("number of multipliers", certificate.support.len(), certificate.multipliers.len())?;
    all_there("number of points", &certificate.support, source.len())?;
    let center = ball.center.iter().chain(&ball.center_tail);
    let numbers = (center.map(|v| ("a coordinate of the center", v)))
        .chain([("the radius", &ball.radius)])
        .chain(certificate.multipliers.iter().map(|v| ("a multiplier", v)));
    all_finite(numbers)?;
    if ball.radius < 0.0 {
        return Err(Error::NegativeRadius { what: "the radius".into(), value: ball.radius });
    }
    Ok(())
}

/// The data that all pictures of one ball share.
struct Picture<'a> {
    solution: &'a Solution<Ball>,
    scaled: Scaled,
    input: Input<'a>,
}

impl Picture<'_> {
    fn ball(&self) -> &Ball {
        &self.solution.answer
    }

    fn certificate(&self) -> &BallCertificate {
        &self.solution.certificate
    }

    /// The lower bound on the radius that is proved, or that the certificate claims.
    fn lower(&self) -> f64 {
        let gap = self.input.options.gap(self.certificate().gap);
        if gap.is_finite() && gap >= 0.0 { self.ball().radius / (1.0 + gap) } else { 0.0 }
    }

    /// Returns true if the lower bound can be told from the ball by eye.
    fn lower_is_visible(&self) -> bool {
        let lower = self.lower();
        lower > 0.0 && self.ball().radius - lower > 0.004 * self.ball().radius
    }

    /// Radius and gap in words.
    fn facts(&self) -> String {
        let gap = self.input.options.gap_words("relative gap", self.certificate().gap);
        let bound = match (self.lower_is_visible(), self.input.dim) {
            (false, _) => "",
            (true, 1) => " The dashed line is the lower bound: no enclosing interval is shorter.",
            (true, 2) => " The dashed circle is the lower bound: no enclosing ball is smaller.",
            (true, 3) => " The dashed sphere is the lower bound: no enclosing ball is smaller.",
            (true, _) => {
                " The dashed circle has the radius of the lower bound: no enclosing ball is smaller."
            }
        };
        format!("Radius {}; {gap}.{bound}", exact(self.ball().radius))
    }

    /// Returns what is drawn of how many, and what the support is.
    fn counts(&self) -> String {
        let thing = self.input.thing();
        let support = match self.certificate().support.len() as u64 {
            1 => format!(" One support {thing} decides the ball."),
            k => format!(
                " {} support {thing}s decide the ball: the larger the mark, the larger the multiplier.",
                count(k)
            ),
        };
        support + &self.input.drawn("the support, ") + &self.input.misfit("ball")
    }

    /// The items to draw that are not of the support.
    fn others(&self) -> Vec<u64> {
        let mut support = self.certificate().support.clone();
        support.sort_unstable();
        let ids = self.input.item_pass.ids.iter().copied();
        ids.filter(|id| support.binary_search(id).is_err()).collect()
    }

    fn support_name(&self) -> String {
        self.input.named("support", self.certificate().support.len())
    }

    fn scene(&self) -> Result<Scene<'_>, Error> {
        let Input { source, options, items, dim, .. } = self.input;
        let BallCertificate { support, multipliers, .. } = self.certificate();
        let centers = std::slice::from_ref(&self.ball().center);
        let name = match dim {
            1 => "smallest ball, an interval",
            2 | 3 => "smallest ball",
            _ => "shadow of the smallest ball",
        };
        let balls = |radius: f64| Marks::Balls { centers, radius };
        let mut layers =
            vec![Layer::answer(name, balls(self.ball().radius)), self.input.others(self.others())?];
        if self.lower_is_visible() {
            layers.push(Layer::lower_bound(balls(self.lower())));
        }
        if items != Items::Points {
            layers.push(self.input.group(String::new(), Tone::Support, "", support.clone())?);
        }
        let marks =
            support_marks(support, multipliers, |_, id| Ok(self.input.row(id)?[..dim].to_vec()))?;
        layers.push(Layer::support(self.support_name(), marks));
        layers.push(Layer::centers(centers));
        let title = format!(
            "Smallest ball around {}, d = {dim}",
            counted(source.len(), self.input.thing())
        );
        let caption = [self.facts(), self.counts()];
        Ok(Scene { title, caption, dim, options, layers, facing: None })
    }

    /// d > 3: the directions in which the support spreads most, and the part of the squared radius along each, where the
    /// multipliers tell.
    fn projected(&self) -> Result<Projected<'_>, Error> {
        let BallCertificate { support, multipliers, .. } = self.certificate();
        let dim = self.input.dim;
        let mut heavy: Vec<usize> = (0..support.len()).collect();
        heavy.order_by(&|&a, &b| multipliers[b].total_cmp(&multipliers[a]).then(a.cmp(&b)));
        heavy.truncate(PROJECTION_SUPPORT_MAX);
        let mut vectors = Vec::with_capacity(heavy.len() * dim);
        let mut weights = Vec::new();
        for &k in &heavy {
            vectors.extend(self.scaled.offset(&self.input.row(support[k])?));
            weights.push(multipliers[k].max(0.0));
        }
        if heavy.len() < 3 {
            let others = self.others();
            for id in others.iter().step_by((others.len() / PROJECTION_ITEM_COUNT).max(1)) {
                vectors.extend(self.scaled.offset(&self.input.row(*id)?));
                weights.push(PROJECTION_ITEM_WEIGHT);
            }
        }
        to_unit_reach(&mut vectors);
        let directions = plane(&vectors, &weights, dim);
        let weighted = |part: &dyn Fn(&[f64]) -> f64| -> f64 {
            let each = heavy.iter().zip(vectors.chunks_exact(dim));
            each.map(|(&k, v)| multipliers[k] * part(v)).sum()
        };
        let total = weighted(&|v| dot(v, v));
        let is_whole = self.input.items == Items::Points && heavy.len() == support.len();
        let shares = match is_whole && total > 0.0 {
            true => {
                let [a, b] =
                    directions.each_ref().map(|u| weighted(&|v| dot(v, u).powi(2)) / total);
                format!(
                    " Along them lie {} % and {} % of the squared radius; the other {} directions hold the rest.",
                    digits(100.0 * a, 2),
                    digits(100.0 * b, 2),
                    count(dim as u64 - 2),
                )
            }
            false => String::new(),
        };
        let words = format!(
            "A shadow on the two directions in which the support spreads most.{shares} The circle is the shadow of the \
             ball: every {} falls inside it, and even one that touches the ball usually falls well inside; the \
             distances from the center tell which do.",
            self.input.thing()
        );
        let axes = [
            "first direction of the support, from the center",
            "second direction, from the center",
        ];
        Ok(Projected { measure: &self.scaled, unit: self.scaled.unit, directions, words, axes })
    }

    /// d > 3: how far every item reaches from the center.
    fn distances(&self) -> Result<Option<Figure>, Error> {
        let radius = self.ball().radius;
        if radius == 0.0 {
            return Ok(None);
        }
        let items = self.input.items;
        let reach =
            |&id: &u64| Ok(self.scaled.reach(&self.input.row(id)?, items) * self.scaled.unit);
        let reaches: Result<Vec<f64>, Error> =
            self.certificate().support.iter().map(reach).collect();
        let words = Histogram {
            title: format!("How far the {}s reach", self.input.thing()),
            axis: match items {
                Items::Points => "distance from the center",
                Items::Balls | Items::Ellipsoids => "distance from the center to the far side",
            },
            border: "radius",
            reach: radius,
            left_out: 0,
            support: Some((self.support_name(), reaches?)),
        };
        Ok(Some(histogram(&self.input, words)))
    }
}
