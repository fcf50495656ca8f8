//! Figures of the largest ellipsoid inside a polytope.
//!
//! *Idea.* In the plane and in space polytope and ellipsoid are drawn as they are. Beyond, the planes through the center
//! along pairs of coordinates cut both of them: unlike shadows, such cuts of a polytope need its half-spaces alone. Beside them
//! stands how near each half-space comes.
//! *Guarantee.* The half-spaces are read once; what is left out is counted in the caption.

mod clip;
mod cuts;
mod polytope;
mod sides;

use taut_certify::{InscribedCertificate, InscribedEllipsoid, Solution};
use taut_points::PointSource;

use self::sides::{Side, Sides, TOUCH_TOLERANCE};
use crate::body::Body;
use crate::marks::{agree, all_finite, all_there, support_size};
use crate::number::{count, counted, digits, exact};
use crate::passes::{Gap, Words, passes};
use crate::scene::{Layer, Mark, Marks, Scene};
use crate::{DrawOptions, Error, Figure, LineStyle, Tone};

/// Pictures of an ellipsoid in a polytope, whose half-spaces are the rows of `source`: the plane for d ≤ 2, space for
/// d = 3, cuts through the center and the distances of the half-spaces beyond; then bounds and gap by stage, where the
/// trace has them.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the ellipsoid was made for, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn inscribed_figures(
    solution: &Solution<InscribedEllipsoid>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    check(solution, source)?;
    let InscribedEllipsoid { center, axes, .. } = &solution.answer;
    let dim = center.len();
    let most = match dim {
        3 => options.max_points.min(polytope::HALF_SPACES_MAX),
        _ => options.max_points,
    };
    let sides = Sides::read(&solution.answer, &solution.certificate, source, most)?;
    let body = Body::of_axes(center, axes);
    let picture = Picture { solution, source, options, body, sides };
    let mut figures = match dim {
        1..=3 => vec![picture.scene().figure()],
        _ => vec![Figure::Plane(picture.cuts()), Figure::Plot(picture.distances())],
    };
    let words = Words {
        quantity: "log-volume",
        answer: "the largest log-volume",
        gap: Gap::Difference,
        step: ["stage", "stages", "stage of the path"],
        upper: ("upper bound", Tone::Bound),
        lower: ("lower bound: inside", Tone::Answer),
    };
    let stages = passes(&solution.trace.history, &words, options);
    figures.extend(stages.into_iter().map(Figure::Plot));
    Ok(figures)
}

/// Checks what the answer and its half-spaces must agree in before anything is drawn.
fn check(solution: &Solution<InscribedEllipsoid>, source: &dyn PointSource) -> Result<(), Error> {
    let (ellipsoid, certificate) = (&solution.answer, &solution.certificate);
    let dim = ellipsoid.center.len();
    agree("number of columns", dim + 1, source.dim())?;
    agree("number of coordinates", dim.max(1), dim)?;
    agree("number of rows of the axes", dim, ellipsoid.axes.len())?;
    for row in &ellipsoid.axes {
        agree("length of a row of the axes", dim, row.len())?;
    }
    agree("number of multipliers", certificate.support.len(), certificate.multipliers.len())?;
    all_there("number of half-spaces", &certificate.support, source.len())?;
    let numbers = (ellipsoid.center.iter().map(|v| ("a coordinate of the center", v)))
        .chain(ellipsoid.axes.iter().flatten().map(|v| ("an entry of the axes", v)))
        .chain(certificate.multipliers.iter().map(|v| ("a multiplier", v)));
    all_finite(numbers)
}

/// The data that all pictures of one ellipsoid share.
struct Picture<'a> {
    solution: &'a Solution<InscribedEllipsoid>,
    source: &'a dyn PointSource,
    options: &'a DrawOptions,
    body: Body,
    sides: Sides,
}

/// The name of the ellipsoid in legends.
const ELLIPSOID: &str = "largest ellipsoid inside";

impl Picture<'_> {
    fn ellipsoid(&self) -> &InscribedEllipsoid {
        &self.solution.answer
    }

    fn certificate(&self) -> &InscribedCertificate {
        &self.solution.certificate
    }

    fn dim(&self) -> usize {
        self.ellipsoid().center.len()
    }

    fn title(&self) -> String {
        let sides = counted(self.source.len(), "half-space");
        format!("Largest ellipsoid inside {sides}, d = {}", self.dim())
    }

    /// c + Gy.
    fn place(&self, y: &[f64]) -> Vec<f64> {
        let InscribedEllipsoid { center, axes, .. } = self.ellipsoid();
        let along = |row: &[f64]| row.iter().zip(y).map(|(g, y)| g * y).sum::<f64>();
        center.iter().zip(axes).map(|(c, row)| c + along(row)).collect()
    }

    /// Polytope, ellipsoid, where half-spaces touch it, and its center.
    fn scene(&self) -> Scene<'_> {
        let (dim, options) = (self.dim(), self.options);
        let (polytope, is_whole) = self.polytope();
        let line_style = if dim == 3 { LineStyle::Solid } else { LineStyle::Filled };
        let polytope = Layer::new("polytope", Tone::Point, line_style, polytope);
        let body = Marks::Ellipsoid { body: &self.body, part: 1.0 };
        let mark = |side: &Side| Mark {
            id: side.id,
            at: self.place(&side.seen),
            size: support_size(side.weight, self.sides.largest),
            label: format!("touching half-space, weight {}", digits(side.weight, 4)),
        };
        let marks = self.sides.support().map(mark).collect();
        let mut layers = vec![
            polytope,
            Layer::answer(ELLIPSOID, body),
            Layer::support(self.touching_name(), marks),
            Layer::centers(std::slice::from_ref(&self.body.center)),
        ];
        if dim == 3 {
            // In space the ellipsoid is seen through the edges around it.
            layers.swap(0, 1);
        }
        let facing = if dim == 3 { self.body.principal().into_iter().next() } else { None };
        let caption = [self.caption(is_whole), String::new()];
        Scene { title: self.title(), caption, dim, options, layers, facing }
    }

    fn touching_name(&self) -> String {
        format!("touching ({})", counted(self.sides.support().count() as u64, "half-space"))
    }

    /// Volume, gap and support in words, and what is drawn of how many.
    fn caption(&self, is_whole: bool) -> String {
        let gap = self.options.gap_words("gap in log-volume", self.certificate().gap);
        let mut words = format!("Log-volume {}; {gap}.", exact(self.ellipsoid().log_volume));
        let touching = self.sides.support().count() as u64;
        words += &format!(
            " {} the ellipsoid{}.",
            match touching {
                1 => "One half-space decides".to_owned(),
                k => format!("{} half-spaces decide", count(k)),
            },
            match self.dim() {
                1..=3 => ": the larger the mark where one touches, the larger its weight",
                _ => "",
            }
        );
        let (n, drawn) = (self.source.len(), self.sides.near.len() as u64);
        if drawn < n {
            words += &format!(
                " {} of {} are drawn, those that come nearest: the others may cut off more.",
                count(drawn),
                counted(n, "half-space")
            );
        }
        if !is_whole {
            words +=
                " What is drawn of the polytope is cut off: it has no end, or one very far away.";
        }
        if self.sides.cutting > 0 {
            words += &format!(
                " {} into the ellipsoid: the answer does not fit these half-spaces.",
                match self.sides.cutting {
                    1 => "1 half-space cuts".to_owned(),
                    k => format!("{} half-spaces cut", count(k)),
                }
            );
        }
        words
    }

    /// Returns how many come near, in words.
    fn nearness(&self) -> String {
        format!(
            "{} of {} come within {} % of touching.",
            count(self.sides.close),
            counted(self.source.len(), "half-space"),
            digits(100.0 * TOUCH_TOLERANCE, 2)
        )
    }
}
