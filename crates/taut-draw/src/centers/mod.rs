//! Figures of k centres.
//!
//! *Idea.* In the plane and in space the balls of the answer's radius around the centres are drawn as they are, with the
//! items, those that are left out, and the core-set that proves the lower bound. Beyond, there is a projection along the two
//! directions in which the centres spread most, and the distance of every item from the centre next to it.
//! *Guarantee.* The items are read twice at most (once for all, once more for those drawn); what is left out of the
//! picture is counted in the caption.
//! *Trap.* With weights no ball holds the points of a centre: how far a point may be depends on its weight. None is drawn.

mod elbow;
mod nearest;
mod plane;
mod shadow;
mod space;

use taut_certify::{Centers, CentersCertificate, Items, Solution};
use taut_points::{PointSource, gather};

use self::nearest::Nearest;
use crate::marks::{
    agree, all_finite, all_there, dot_size, drawn_of, misfit, others_name, support_size,
};
use crate::number::{count, counted, short};
use crate::passes::{Words, passes};
use crate::survey::{Question, Survey, noun, survey};
use crate::{DrawOptions, Error, Figure, Tone};
pub use elbow::{ElbowStep, elbow_figure};

/// The marks of items that are left out are this many times as large as those of the others.
const LEFT_OUT_SCALE: f64 = 1.6;

/// What there is between two pairs of bounds.
const STEP_WORDS: Words =
    Words { step: ["step", "steps", "step of the search"], ..Words::ENCLOSING };

/// Pictures of k centres and their items: the plane for d ≤ 2, space for d = 3, a projection and the distances from the
/// nearest centre beyond; then the bounds and the gap by step of the search, where the trace has them.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the centres were found for, [`Error::NonFinite`],
/// [`Error::NegativeRadius`], [`Error::Option`], [`Error::Read`].
pub fn centers_figures(
    solution: &Solution<Centers>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (answer, certificate) = (&solution.answer, &solution.certificate);
    let dim = check(answer, certificate, source)?;
    let nearest = Nearest::new(answer, certificate, dim);
    let always = [&certificate.core_set[..], &answer.outliers].concat();
    let question = Question {
        items: certificate.items,
        support: &always,
        left_out: &answer.outliers,
        most: options.max_points,
    };
    let survey = survey(&nearest, &question, source)?;
    let picture = Picture { answer, certificate, source, options, dim, nearest, survey };
    let mut figures = match dim {
        1 => vec![Figure::Plane(picture.line()?)],
        2 => vec![Figure::Plane(picture.plane()?)],
        3 => vec![Figure::Space(picture.space()?)],
        _ => {
            let mut figures = vec![Figure::Plane(picture.projection()?)];
            figures.extend(picture.distances()?.map(Figure::Plot));
            figures
        }
    };
    let steps = passes(&solution.trace.history, &STEP_WORDS, options);
    figures.extend(steps.into_iter().map(Figure::Plot));
    Ok(figures)
}

/// What the answer and its items must agree in before anything is drawn; the dimension.
fn check(
    answer: &Centers,
    certificate: &CentersCertificate,
    source: &dyn PointSource,
) -> Result<usize, Error> {
    let dim = match certificate.weights {
        true => source.dim().saturating_sub(1),
        false => certificate.items.dim(source.dim()),
    };
    agree("number of coordinates", dim.max(1), dim)?;
    agree("number of centres", answer.centers.len().max(1), answer.centers.len())?;
    answer.centers.iter().try_for_each(|c| agree("number of coordinates", c.len(), dim))?;
    all_there(
        "number of points",
        certificate.core_set.iter().chain(&answer.outliers),
        source.len(),
    )?;
    let centers = answer.centers.iter().flatten().map(|v| ("a coordinate of a centre", v));
    all_finite(
        centers.chain([("the radius", &answer.radius), ("the lower bound", &answer.lower_bound)]),
    )?;
    if answer.radius < 0.0 {
        return Err(Error::NegativeRadius { what: "the radius".into(), value: answer.radius });
    }
    Ok(dim)
}

/// What all pictures of the same centres share.
struct Picture<'a> {
    answer: &'a Centers,
    certificate: &'a CentersCertificate,
    source: &'a dyn PointSource,
    options: &'a DrawOptions,
    dim: usize,
    nearest: Nearest,
    survey: Survey,
}

/// Rows that are drawn alike.
struct Group {
    name: String,
    tone: Tone,
    /// Of their discs, pixels.
    size: f64,
    /// What else to say of each on hovering.
    label: &'static str,
    ids: Vec<u64>,
    /// n × columns.
    rows: Vec<f64>,
}

impl Picture<'_> {
    /// "point" or "ball".
    fn thing(&self) -> &'static str {
        noun(self.certificate.items)
    }

    fn title(&self) -> String {
        format!(
            "Centres of {}, k = {}, d = {}",
            counted(self.source.len(), self.thing()),
            count(self.certificate.k),
            self.dim
        )
    }

    /// Whether balls are drawn, and those of the lower bound.
    fn has_balls(&self) -> bool {
        !self.certificate.weights
    }

    fn lower_is_visible(&self) -> bool {
        let Centers { radius, lower_bound, .. } = *self.answer;
        self.has_balls() && lower_bound > 0.0 && radius - lower_bound > 0.004 * radius
    }

    /// Radius, gap and lower bound in words.
    fn facts(&self) -> String {
        let Centers { radius, lower_bound, .. } = *self.answer;
        let gap = match self.certificate.gap {
            _ if radius > 0.0 && lower_bound <= 0.0 => "no gap is certified".to_owned(),
            gap => format!("certified relative gap {}", short(gap, 3)),
        };
        let shape = match self.dim {
            1 => "interval",
            3 => "sphere",
            _ => "circle",
        };
        let bound = match (self.lower_is_visible(), self.certificate.k) {
            (false, _) => String::new(),
            (true, 1) => {
                format!(
                    " The dashed {shape} has the radius of the lower bound: no smaller one would do."
                )
            }
            (true, k) => format!(
                " The dashed {shape}s have the radius of the lower bound: no {} smaller ones would do.",
                count(k)
            ),
        };
        let weights = match self.certificate.weights {
            true => {
                " Distances count times the weight of the point, so there is no one circle around a centre."
            }
            false => "",
        };
        format!("Radius {}; {gap}.{bound}{weights}", short(radius, 8))
    }

    /// What is drawn of how many, and what proves the bound.
    fn counts(&self) -> String {
        let (n, drawn) = (self.source.len(), self.survey.ids.len() as u64);
        let thing = self.thing();
        let mut words = match self.certificate.core_set.len() as u64 {
            0 => String::new(),
            1 => format!(" The one {thing} of the core-set proves the lower bound."),
            m => format!(" The {} {thing}s of the core-set prove the lower bound.", count(m)),
        };
        words += &match self.answer.outliers.len() as u64 {
            0 => String::new(),
            1 => format!(" One {thing} is left out."),
            z => format!(" {} {thing}s are left out.", count(z)),
        };
        let which = format!(
            "the core-set, what is left out, {} more that reach far, and an even sample of the others",
            count(self.survey.far)
        );
        words += &drawn_of(drawn, n, thing, &which);
        words += &misfit(self.survey.outside, thing, "balls");
        words
    }

    /// The rows to draw: those of no part, those of the core-set, those that are left out.
    fn groups(&self) -> Result<[Group; 3], Error> {
        let outliers = &self.answer.outliers;
        let mut core: Vec<u64> = self.certificate.core_set.clone();
        core.sort_unstable();
        core.dedup();
        core.retain(|id| outliers.binary_search(id).is_err());
        let is_other =
            |id: &u64| core.binary_search(id).is_err() && outliers.binary_search(id).is_err();
        let others: Vec<u64> = self.survey.ids.iter().copied().filter(is_other).collect();
        let dot = dot_size(self.survey.ids.len());
        let named =
            |word: &str, ids: usize| format!("{word} ({})", counted(ids as u64, self.thing()));
        let core_name = named("core-set", core.len());
        let out_name = named("left out", outliers.len());
        Ok([
            self.group(others_name(self.certificate.items), Tone::Point, dot, "", others)?,
            self.group(core_name, Tone::Support, support_size(0.0, 0.0), "of the core-set", core)?,
            self.group(out_name, Tone::Third, LEFT_OUT_SCALE * dot, "left out", outliers.clone())?,
        ])
    }

    fn group(
        &self,
        name: String,
        tone: Tone,
        size: f64,
        label: &'static str,
        ids: Vec<u64>,
    ) -> Result<Group, Error> {
        let rows = gather(self.source, &ids)?;
        Ok(Group { name, tone, size, label, ids, rows })
    }

    /// "the 5 balls", by what they are in this dimension.
    fn balls_name(&self, one: &str, many: &str) -> String {
        match self.answer.centers.len() as u64 {
            1 => format!("the {one}"),
            k => format!("the {} {many}", count(k)),
        }
    }

    fn centers_name(&self) -> String {
        if self.answer.centers.len() == 1 { "centre".into() } else { "centres".into() }
    }

    /// The radius of a row that is a ball.
    fn own_radius(&self, row: &[f64]) -> f64 {
        if self.certificate.items == Items::Balls { row[self.dim] } else { 0.0 }
    }
}
