//! Figures of a minimum volume enclosing ellipsoid, and of a robust one.
//!
//! *Idea.* In the plane and in space the ellipsoid is drawn as it is. Beyond, its shadows are: the projection of
//! {c + Xy : |y| ≤ 1} to two coordinates is the ellipse of the two rows of X, and all items fall inside it. Beside them
//! stands how far every item reaches.
//! *Guarantee.* The items are read twice at most (once for all, once more for those drawn); what is left out is counted
//! in the caption.

mod robust;

use taut_certify::{Ellipsoid, EllipsoidCertificate, Items, RobustEllipsoid, Solution};
use taut_points::{PointSource, gather};

use self::robust::Robust;
use crate::body::{Body, touching};
use crate::item_pass::{Measure, PassQuery};
use crate::marks::{agree, all_finite, all_there, support_marks};
use crate::number::{count, counted, exact};
use crate::passes::{Gap, Words, passes};
use crate::scene::pairs::most;
use crate::scene::{Histogram, Input, Layer, Marks, Pairs, Scene, histogram};
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
    let mut figures = vec![picture.figure()?];
    if picture.dim() > 3 {
        figures.push(picture.reach()?);
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
    let mut figures = vec![picture.figure()?];
    let distances = picture.distances()?;
    if let Some(picture) = picture.closer()? {
        figures.push(picture.figure()?);
    }
    figures.extend(distances);
    Ok(figures)
}

/// Checks what the answer and its points must agree in before anything is drawn.
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
    let numbers = (center.map(|v| ("a coordinate of the center", v)))
        .chain(ellipsoid.factor.iter().flatten().map(|v| ("an entry of the factor", v)))
        .chain(basis.iter().flatten().map(|v| ("an entry of the hull", v)))
        .chain(certificate.directions.iter().flatten().map(|v| ("a direction", v)))
        .chain(certificate.multipliers.iter().map(|v| ("a multiplier", v)));
    all_finite(numbers)
}

/// The data that all pictures of one ellipsoid share.
struct Picture<'a> {
    ellipsoid: &'a Ellipsoid,
    certificate: &'a EllipsoidCertificate,
    /// The data of a robust ellipsoid; `None` for a smallest one.
    robust: Option<Robust<'a>>,
    body: Body,
    input: Input<'a>,
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
        let question = PassQuery {
            items: certificate.items,
            support: &certificate.support,
            left_out: &certificate.left_out,
            // Where there are many panels, each mark is drawn once in each.
            most: if dim > 3 { most(options.max_points, dim) } else { options.max_points },
        };
        let input = Input::read(&body, &question, source, options)?;
        Ok(Picture { ellipsoid, certificate, robust, body, input })
    }

    /// The ellipsoid and its items, in the picture that their dimension asks for.
    fn figure(&self) -> Result<Figure, Error> {
        let Input { source, options, dim, .. } = self.input;
        let EllipsoidCertificate { support, multipliers, directions, .. } = self.certificate;
        let (inside, out) = self.others();
        let left_out = gather(source, &out)?;
        let scaled = |body, part| Marks::Ellipsoid { body, part };
        let mut layers = vec![Layer::answer(self.name(), scaled(&self.body, 1.0))];
        layers.extend(self.robust.as_ref().and_then(Robust::kept_layer));
        layers.push(self.input.others(inside)?);
        layers.push(self.input.left_out(self.left_out_name(), "", out)?);
        if self.lower_is_visible() {
            layers.push(Layer::lower_bound(scaled(&self.body, self.lower())));
        }
        let marks = support_marks(support, multipliers, |k, id| {
            let row = self.input.row(id)?;
            Ok(match directions.get(k) {
                None => row[..dim].to_vec(),
                Some(direction) => touching(self.input.items, dim, &row, direction),
            })
        })?;
        layers.push(Layer::support(self.support_name(), marks));
        layers.push(Layer::centers(std::slice::from_ref(&self.body.center)));
        let facing = if dim == 3 { self.facing(&left_out) } else { None };
        let caption = [self.facts(), self.counts()];
        let scene = Scene { title: self.title(), caption, dim, options, layers, facing };
        Ok(match dim {
            1..=3 => scene.figure(),
            _ => scene.pairs(&Pairs::new(&self.body, &left_out, source.dim())),
        })
    }

    /// In space, the longest axis; the mean of the outliers from the center, where a robust ellipsoid has some.
    fn facing(&self, left_out: &[f64]) -> Option<Vec<f64>> {
        if self.robust.is_none() || left_out.is_empty() {
            return self.body.principal().into_iter().next();
        }
        let mean = |k: usize| {
            let offsets = left_out[k..].iter().step_by(3).map(|x| x - self.body.center[k]);
            offsets.sum::<f64>() / (left_out.len() / 3) as f64
        };
        Some([0, 1, 2].map(mean).to_vec())
    }

    /// d > 3: |F(x − c)| of every item, which shadows cannot tell.
    fn reach(&self) -> Result<Figure, Error> {
        let EllipsoidCertificate { items, support, left_out, .. } = self.certificate;
        let part = |&id: &u64| Ok(self.body.part(&self.input.row(id)?, *items));
        let reaches: Result<Vec<f64>, Error> = support.iter().map(part).collect();
        let words = Histogram {
            title: format!("How far the {}s reach", self.input.thing()),
            axis: match items {
                Items::Points => "|F(x − c)|: 0 at the center, 1 on the border",
                Items::Balls | Items::Ellipsoids => "largest |F(x − c)|: 1 on the border",
            },
            border: "border",
            reach: 1.0,
            left_out: left_out.len(),
            support: Some((self.support_name(), reaches?)),
        };
        Ok(histogram(&self.input, words))
    }

    fn dim(&self) -> usize {
        self.body.dim()
    }

    fn rank(&self) -> usize {
        self.body.rank()
    }

    fn title(&self) -> String {
        if let Some(robust) = &self.robust {
            return robust.title(self.input.source.len(), self.dim());
        }
        let inside = self.input.source.len().saturating_sub(self.certificate.left_out.len() as u64);
        let of = match self.certificate.left_out.len() {
            0 => String::new(),
            _ => format!(" of {}", count(self.input.source.len())),
        };
        format!(
            "Smallest ellipsoid around {}{of}, d = {}",
            counted(inside, self.input.thing()),
            self.dim()
        )
    }

    /// By which factor the axes of the ellipsoid shrink to give it the volume of the lower bound.
    fn lower(&self) -> f64 {
        let gap = self.input.options.gap(self.certificate.gap);
        if gap.is_finite() && gap >= 0.0 { (-gap / self.rank().max(1) as f64).exp() } else { 0.0 }
    }

    /// Returns true if the lower bound can be told from the ellipsoid by eye.
    fn lower_is_visible(&self) -> bool {
        self.robust.is_none() && self.lower() > 0.0 && self.lower() < 0.996
    }

    /// Volume and gap in words.
    fn facts(&self) -> String {
        if let Some(robust) = &self.robust {
            return robust.facts();
        }
        let gap = self.input.options.gap_words("gap in log-volume", self.certificate.gap);
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
        format!("Log-volume {}; {gap}.{flat}{bound}", exact(self.ellipsoid.log_volume))
    }

    /// Returns what is drawn of how many, and what the support is.
    fn counts(&self) -> String {
        let EllipsoidCertificate { support, directions, left_out, .. } = self.certificate;
        let thing = self.input.thing();
        let mut words = match support.len() as u64 {
            0 => String::new(),
            1 => format!(" One support {thing} decides the ellipsoid."),
            k => format!(
                " {} support {} decide the ellipsoid: the larger the mark, the larger the multiplier.",
                count(k),
                match directions.is_empty() {
                    true => format!("{thing}s"),
                    false => format!("marks, where {thing}s touch it,"),
                }
            ),
        };
        match left_out.len() as u64 {
            _ if self.robust.is_some() => {}
            0 => {}
            1 => words += &format!(" One {thing} is left out."),
            k => words += &format!(" {} {thing}s are left out.", count(k)),
        }
        words += &match self.robust.as_ref().map(|robust| robust.beyond) {
            Some(1) => " 1 outlier lies beyond the picture.".to_owned(),
            Some(beyond @ 2..) => format!(" {} outliers lie beyond the picture.", count(beyond)),
            _ => self.input.drawn(if support.is_empty() { "" } else { "the support, " }),
        };
        words + &self.input.misfit("ellipsoid")
    }

    /// The items to draw: those enclosed that are not of the support, and those left out.
    fn others(&self) -> (Vec<u64>, Vec<u64>) {
        let EllipsoidCertificate { support, left_out, directions, .. } = self.certificate;
        let is_in = |list: &[u64], id: &u64| list.binary_search(id).is_ok();
        let (out, inside): (Vec<u64>, Vec<u64>) =
            self.input.item_pass.ids.iter().partition(|id| is_in(left_out, id));
        // Marks stand where items touch; the items themselves are still to be drawn.
        let is_drawn = |id: &u64| !directions.is_empty() || !is_in(support, id);
        (inside.into_iter().filter(is_drawn).collect(), out)
    }

    fn support_name(&self) -> String {
        self.input.named("support", self.certificate.support.len())
    }

    fn left_out_name(&self) -> String {
        let word = if self.robust.is_some() { "outliers" } else { "left out" };
        self.input.named(word, self.certificate.left_out.len())
    }

    /// The name of the ellipsoid in legends.
    fn name(&self) -> String {
        self.robust.as_ref().map_or_else(|| "smallest ellipsoid".into(), Robust::name)
    }
}
