//! Figures of a minimum volume enclosing ellipsoid, and of a robust one.
//!
//! *Idea.* In the plane and in space the ellipsoid is drawn as it is. Beyond, its shadows are: the projection of
//! {c + Xy : |y| ≤ 1} to two coordinates is the ellipse of the two rows of X, and all items fall inside it. Beside them
//! stands how far every item reaches.
//! *Guarantee.* The items are read twice at most (once for all, once more for those drawn); what is left out is counted
//! in the caption.

pub(crate) mod body;
pub(crate) mod pairs;
pub(crate) mod plane;
mod reach;
mod robust;
pub(crate) mod space;

use taut_certify::{Ellipsoid, EllipsoidCertificate, RobustEllipsoid, Solution};
use taut_points::{PointSource, gather};

use self::body::Body;
use self::robust::Robust;
use crate::marks::{
    agree, all_finite, all_there, dot_size, drawn_of, misfit, others_name, support_size,
};
use crate::number::{count, counted, short};
use crate::passes::{Gap, Words, passes};
use crate::survey::{Measure, Question, Survey, noun, survey};
use crate::{DrawOptions, Error, Figure};

/// Pictures of an ellipsoid and its points: the plane for d ≤ 2, space for d = 3, shadows on pairs of coordinates and how
/// far the points reach beyond; then the bounds and the gap by pass, where the trace has them.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the ellipsoid was made for, [`Error::NonFinite`],
/// [`Error::NegativeRadius`], [`Error::Option`], [`Error::Read`].
pub fn ellipsoid_figures(
    solution: &Solution<Ellipsoid>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let picture = Picture::of(&solution.answer, &solution.certificate, None, source, options)?;
    let mut figures = vec![picture.scene()?];
    if picture.dim() > 3 {
        figures.push(Figure::Plot(picture.reach()?));
    }
    let words = Words {
        quantity: "log-volume",
        answer: "the least log-volume",
        gap: Gap::Difference,
        ..Words::ENCLOSING
    };
    let passes = passes(&solution.trace.history, &words, options);
    figures.extend(passes.into_iter().map(Figure::Plot));
    Ok(figures)
}

/// Pictures of a robust ellipsoid and its points: the plane for d ≤ 2, space for d = 3, shadows on pairs of coordinates
/// beyond, with outliers in a tone and a size of their own; a close-up where some of them lie far out; then the
/// distance of each point in the metric of the ellipsoid.
///
/// # Errors
/// As [`ellipsoid_figures`].
pub fn robust_figures(
    solution: &Solution<RobustEllipsoid>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (ellipsoid, certificate) = robust::as_left_out(solution);
    let robust = Robust::of(solution, source)?;
    let picture = Picture::of(&ellipsoid, &certificate, Some(robust), source, options)?;
    let mut figures = vec![picture.scene()?];
    let distances = picture.distances()?;
    if let Some(picture) = picture.closer()? {
        figures.push(picture.scene()?);
    }
    figures.extend(distances.map(Figure::Plot));
    Ok(figures)
}

/// What the answer and its points must agree in before anything is drawn.
fn check(
    ellipsoid: &Ellipsoid,
    certificate: &EllipsoidCertificate,
    source: &dyn PointSource,
) -> Result<(), Error> {
    let dim = certificate.items.dim(source.dim());
    agree("number of coordinates", ellipsoid.dim(), dim)?;
    agree("number of coordinates", dim.max(1), dim)?;
    let basis = ellipsoid.hull.as_ref().map_or(&[][..], |hull| &hull.basis);
    let rank = if ellipsoid.hull.is_some() { basis.len() } else { dim };
    agree("number of rows of the factor", rank, ellipsoid.rank())?;
    for row in ellipsoid.factor.iter().chain(basis) {
        agree("length of a row of the factor", dim, row.len())?;
    }
    let support = certificate.support.len();
    agree("number of multipliers", support, certificate.multipliers.len())?;
    let directions = certificate.directions.len();
    agree("number of directions", if directions == 0 { 0 } else { support }, directions)?;
    for direction in &certificate.directions {
        agree("length of a direction", dim, direction.len())?;
    }
    let named = certificate.support.iter().chain(&certificate.left_out);
    all_there("number of points", named, source.len())?;
    let center = ellipsoid.center.iter().chain(&ellipsoid.center_tail);
    let numbers = (center.map(|v| ("a coordinate of the centre", v)))
        .chain(ellipsoid.factor.iter().flatten().map(|v| ("an entry of the factor", v)))
        .chain(basis.iter().flatten().map(|v| ("an entry of the hull", v)))
        .chain(certificate.directions.iter().flatten().map(|v| ("a direction", v)))
        .chain(certificate.multipliers.iter().map(|v| ("a multiplier", v)));
    all_finite(numbers)
}

/// What all pictures of one ellipsoid share.
struct Picture<'a> {
    ellipsoid: &'a Ellipsoid,
    certificate: &'a EllipsoidCertificate,
    /// What there is to say where the ellipsoid is no smallest one.
    robust: Option<Robust<'a>>,
    source: &'a dyn PointSource,
    options: &'a DrawOptions,
    body: Body,
    survey: Survey,
}

/// One mark of the support.
struct Mark {
    id: u64,
    /// Where the item touches.
    at: Vec<f64>,
    size: f64,
    label: String,
}

impl<'a> Picture<'a> {
    /// Reads all items once.
    fn of(
        ellipsoid: &'a Ellipsoid,
        certificate: &'a EllipsoidCertificate,
        robust: Option<Robust<'a>>,
        source: &'a dyn PointSource,
        options: &'a DrawOptions,
    ) -> Result<Self, Error> {
        check(ellipsoid, certificate, source)?;
        let body = Body::of(ellipsoid);
        let dim = body.dim();
        let question = Question {
            items: certificate.items,
            support: &certificate.support,
            left_out: &certificate.left_out,
            // Where there are many panels, each mark is drawn once in each.
            most: if dim > 3 { pairs::most(options.max_points, dim) } else { options.max_points },
        };
        let survey = survey(&body, &question, source)?;
        Ok(Picture { ellipsoid, certificate, robust, source, options, body, survey })
    }

    /// The ellipsoid and its items, in the picture that their dimension asks for.
    fn scene(&self) -> Result<Figure, Error> {
        Ok(match self.dim() {
            1 => Figure::Plane(self.line()?),
            2 => Figure::Plane(self.plane()?),
            3 => Figure::Space(self.space()?),
            _ => Figure::Plane(self.pairs()?),
        })
    }

    fn certificate(&self) -> &'a EllipsoidCertificate {
        self.certificate
    }

    fn dim(&self) -> usize {
        self.body.dim()
    }

    fn rank(&self) -> usize {
        self.body.rank()
    }

    /// "point", "ball" or "ellipsoid".
    fn thing(&self) -> &'static str {
        noun(self.certificate().items)
    }

    fn title(&self) -> String {
        if let Some(robust) = &self.robust {
            return robust.title(self.source.len(), self.dim());
        }
        let inside = self.source.len().saturating_sub(self.certificate().left_out.len() as u64);
        let of = match self.certificate().left_out.len() {
            0 => String::new(),
            _ => format!(" of {}", count(self.source.len())),
        };
        format!(
            "Smallest ellipsoid around {}{of}, d = {}",
            counted(inside, self.thing()),
            self.dim()
        )
    }

    /// By which factor the axes of the ellipsoid shrink to give it the volume of the lower bound.
    fn lower(&self) -> f64 {
        let gap = self.certificate().gap;
        if gap.is_finite() && gap >= 0.0 { (-gap / self.rank().max(1) as f64).exp() } else { 0.0 }
    }

    /// Whether the lower bound can be told from the ellipsoid by eye.
    fn lower_is_visible(&self) -> bool {
        self.robust.is_none() && self.lower() > 0.0 && self.lower() < 0.996
    }

    /// Volume and gap in words.
    fn facts(&self) -> String {
        if let Some(robust) = &self.robust {
            return robust.facts();
        }
        let gap = match self.certificate().gap {
            gap if !gap.is_finite() => "no gap is certified".to_owned(),
            gap => format!("certified gap {} in log-volume", short(gap, 3)),
        };
        let flat = match (self.rank(), self.dim()) {
            (r, d) if r == d => String::new(),
            (0, _) => " All lie in one point.".into(),
            (r, d) => {
                format!(" All lie in a flat of dimension {r} of {d}, and so does the ellipsoid.")
            }
        };
        let bound = match (self.lower_is_visible(), self.dim()) {
            (true, 1..=3) => {
                " The dashed copy has the volume of the lower bound: none that encloses is smaller."
            }
            _ => "",
        };
        format!("Log-volume {}; {gap}.{flat}{bound}", short(self.ellipsoid.log_volume, 8))
    }

    /// What is drawn of how many, and what the support is.
    fn counts(&self) -> String {
        let (n, drawn) = (self.source.len(), self.survey.ids.len() as u64);
        let thing = self.thing();
        let mut words = match self.certificate().support.len() as u64 {
            0 => String::new(),
            1 => format!(" One support {thing} decides the ellipsoid."),
            k => format!(
                " {} support {} decide the ellipsoid: the larger the mark, the larger the multiplier.",
                count(k),
                match self.certificate().directions.is_empty() {
                    true => format!("{thing}s"),
                    false => format!("marks, where {thing}s touch it,"),
                }
            ),
        };
        match self.certificate().left_out.len() as u64 {
            _ if self.robust.is_some() => {}
            0 => {}
            1 => words += &format!(" One {thing} is left out."),
            k => words += &format!(" {} {thing}s are left out.", count(k)),
        }
        if let Some(beyond @ 1..) = self.robust.as_ref().map(|robust| robust.beyond) {
            let lie = if beyond == 1 { "outlier lies" } else { "outliers lie" };
            words += &format!(" {} {lie} beyond the picture.", count(beyond));
        } else {
            let far = match self.survey.far {
                0 => String::new(),
                far => format!("{} more that reach far, ", count(far)),
            };
            let support = if self.certificate().support.is_empty() { "" } else { "the support, " };
            let which = format!("{support}{far}and an even sample of the others");
            words += &drawn_of(drawn, n, thing, &which);
        }
        words += &misfit(self.survey.outside, thing, "ellipsoid");
        words
    }

    /// Radius of the disc of a point that is not of the support, pixels.
    fn dot_size(&self) -> f64 {
        dot_size(self.survey.ids.len())
    }

    /// The items to draw: those enclosed that are not of the support, and those left out.
    fn others(&self) -> (Vec<u64>, Vec<u64>) {
        let EllipsoidCertificate { support, left_out, .. } = self.certificate();
        let is_in = |list: &[u64], id: &u64| list.binary_search(id).is_ok();
        let (out, inside): (Vec<u64>, Vec<u64>) =
            self.survey.ids.iter().partition(|id| is_in(left_out, id));
        let points = self.certificate().directions.is_empty();
        // Marks stand where items touch; the items themselves are still to be drawn.
        let inside = inside.into_iter().filter(|id| !points || !is_in(support, id)).collect();
        (inside, out)
    }

    /// The marks of the support.
    fn support(&self) -> Result<Vec<Mark>, Error> {
        let certificate = self.certificate();
        let largest = certificate.multipliers.iter().fold(0.0_f64, |a, &m| a.max(m));
        let pairs = certificate.support.iter().zip(&certificate.multipliers).enumerate();
        pairs
            .map(|(k, (&id, &multiplier))| {
                let row = self.row(id)?;
                let at = match certificate.directions.get(k) {
                    None => row[..self.dim()].to_vec(),
                    Some(direction) => {
                        body::touching(certificate.items, self.dim(), &row, direction)
                    }
                };
                let label = format!("support, multiplier {}", short(multiplier, 4));
                Ok(Mark { id, at, size: support_size(multiplier, largest), label })
            })
            .collect()
    }

    fn others_name(&self) -> String {
        others_name(self.certificate().items)
    }

    fn support_name(&self) -> String {
        format!("support ({})", counted(self.certificate().support.len() as u64, self.thing()))
    }

    fn left_out_name(&self) -> String {
        let name = if self.robust.is_some() { "outliers" } else { "left out" };
        format!("{name} ({})", counted(self.certificate().left_out.len() as u64, self.thing()))
    }

    /// The name of the ellipsoid in legends.
    fn name(&self) -> String {
        self.robust.as_ref().map_or_else(|| "smallest ellipsoid".into(), Robust::name)
    }

    /// A second ellipsoid to compare with.
    fn second(&self) -> Option<&Body> {
        self.robust.as_ref()?.kept.as_ref()
    }

    /// The row of an item.
    fn row(&self, id: u64) -> Result<Vec<f64>, Error> {
        Ok(gather(self.source, &[id])?)
    }
}
