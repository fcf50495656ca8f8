//! Figures of a minimum enclosing ball.
//!
//! *Idea.* In the plane and in space the ball is drawn as it is. Beyond, a projection of it hides what matters: almost
//! all points seem to lie deep inside, though many may touch the boundary. So there are two pictures: a projection
//! along the two directions in which the support spreads most, and the distances of all points from the centre.
//! *Guarantee.* The items are read twice at most (once for all, once more for those drawn); what is left out is counted
//! in the caption.

mod plane;
mod shadow;
mod space;

use taut_certify::{Ball, BallCertificate, Solution};
use taut_points::{PointSource, gather};

use crate::marks::{
    agree, all_finite, all_there, dot_size, drawn_of, misfit, others_name, support_size,
};
use crate::number::{count, counted, short};
use crate::passes::{Words, passes};
use crate::survey::{Question, Scaled, Survey, noun, survey};
use crate::{DrawOptions, Error, Figure};

/// Pictures of a ball and its points: the plane for d ≤ 2, space for d = 3, a projection and the distances from the
/// centre beyond; then the bounds and the gap by pass, where the trace has them.
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
    let question = Question {
        items: solution.certificate.items,
        support: &solution.certificate.support,
        left_out: &[],
        most: options.max_points,
    };
    let survey = survey(&scaled, &question, source)?;
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
    let passes = passes(&solution.trace.history, &Words::ENCLOSING, options);
    figures.extend(passes.into_iter().map(Figure::Plot));
    Ok(figures)
}

/// What the answer and its points must agree in before anything is drawn.
fn check(solution: &Solution<Ball>, source: &dyn PointSource) -> Result<(), Error> {
    let (ball, certificate) = (&solution.answer, &solution.certificate);
    let dim = certificate.items.dim(source.dim());
    agree("number of coordinates", ball.center.len(), dim)?;
    agree("number of coordinates", dim.max(1), dim)?;
    agree("number of multipliers", certificate.support.len(), certificate.multipliers.len())?;
    all_there("number of points", &certificate.support, source.len())?;
    let center = ball.center.iter().chain(&ball.center_tail);
    let numbers = (center.map(|v| ("a coordinate of the centre", v)))
        .chain([("the radius", &ball.radius)])
        .chain(certificate.multipliers.iter().map(|v| ("a multiplier", v)));
    all_finite(numbers)?;
    if ball.radius < 0.0 {
        return Err(Error::NegativeRadius { what: "the radius".into(), value: ball.radius });
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
        noun(self.certificate().items)
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
        let which = format!(
            "the support, {} more that reach far, and an even sample of the others",
            count(self.survey.far)
        );
        words += &drawn_of(drawn, n, thing, &which);
        words += &misfit(self.survey.outside, thing, "ball");
        words
    }

    /// Radius of the disc of a point that is not of the support, pixels.
    fn dot_size(&self) -> f64 {
        dot_size(self.survey.ids.len())
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
        let largest = certificate.multipliers.iter().fold(0.0_f64, |a, &m| a.max(m));
        let pairs = certificate.support.iter().zip(&certificate.multipliers);
        pairs.map(move |(&id, &multiplier)| {
            let label = format!("support, multiplier {}", short(multiplier, 4));
            (id, support_size(multiplier, largest), label)
        })
    }

    fn others_name(&self) -> String {
        others_name(self.certificate().items)
    }

    fn support_name(&self) -> String {
        format!("support ({})", counted(self.certificate().support.len() as u64, self.thing()))
    }

    /// The row of an item.
    fn row(&self, id: u64) -> Result<Vec<f64>, Error> {
        Ok(gather(self.source, &[id])?)
    }
}
