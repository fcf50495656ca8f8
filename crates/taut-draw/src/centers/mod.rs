//! Figures of k centers.
//!
//! *Idea.* In the plane and in space the balls of the answer's radius around the centers are drawn as they are, with the
//! items, those that are left out, and the core-set that proves the lower bound. Beyond, there is a projection along the two
//! directions in which the centers spread most, and the distance of every item from the center next to it.
//! *Guarantee.* The items are read twice at most (once for all, once more for those drawn); what is left out of the
//! picture is counted in the caption.
//! *Trap.* With weights no ball holds the points of a center: how far a point may be depends on its weight. None is drawn.

mod elbow;
mod groups;
mod nearest;

use taut_certify::{Centers, CentersCertificate, Solution};
use taut_points::{PointSource, gather};

use self::groups::WithoutColumn;
use self::nearest::Nearest;
use crate::item_pass::{Measure, PassQuery};
use crate::marks::{agree, all_finite, all_there, support_size};
use crate::number::{count, counted, exact};
use crate::options::NO_GAP;
use crate::passes::{Words, passes};
use crate::project::{plane, to_unit_reach};
use crate::scene::{Histogram, Input, Layer, Marks, Projected, Scene, histogram};
use crate::{DrawOptions, Error, Figure, Tone};
pub use elbow::{ElbowStep, elbow_figure};

/// The weight of an item in the choice of the directions of a projection, beside centers of weight 1.
const PROJECTION_ITEM_WEIGHT: f64 = 1e-4;
/// About this many items of each group are looked at for that; more would take long in high dimensions and change little.
const PROJECTION_ITEM_COUNT: usize = 64;

/// The tones of items, by the number of their center.
const CLUSTER_TONES: [Tone; 4] = [Tone::Point, Tone::Second, Tone::Fourth, Tone::Bound];

/// The noun for the steps between two pairs of bounds.
const STEP_WORDS: Words =
    Words { step: ["step", "steps", "step of the search"], ..Words::ENCLOSING };

/// Pictures of k centers and their items: the plane for d ≤ 2, space for d = 3, a projection and the distances from the
/// nearest center beyond; then the bounds and the gap by step of the search, where the trace has them.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the centers were found for, [`Error::NonFinite`],
/// [`Error::NegativeRadius`], [`Error::Option`], [`Error::Read`].
pub fn centers_figures(
    solution: &Solution<Centers>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (answer, certificate) = (&solution.answer, &solution.certificate);
    let column = group_column(certificate, source)?;
    let without = column.map(|column| WithoutColumn::new(source, column));
    let (rows, source): (_, &dyn PointSource) = match &without {
        Some(without) => (source, without),
        None => (source, source),
    };
    let dim = check(answer, certificate, source)?;
    let nearest = Nearest::new(answer, certificate, dim);
    let mut always = [&certificate.core_set[..], &answer.outliers].concat();
    // Several points of one ellipsoid are one row.
    always.sort_unstable();
    always.dedup();
    let question = PassQuery {
        items: certificate.items,
        support: &always,
        left_out: &answer.outliers,
        most: options.max_points,
    };
    let input = Input::read(&nearest, &question, source, options)?;
    let clusters = match column {
        None if answer.centers.len() > 1 => {
            nearest.centers_of(&gather(source, &input.item_pass.ids)?, certificate.items)
        }
        None => vec![],
        Some(column) => {
            let ids = &input.item_pass.ids;
            groups::centers_of(ids, answer, certificate, &nearest, rows, column)?
        }
    };
    let picture = Picture { answer, certificate, nearest, input, clusters };
    let layers = picture.layers()?;
    let mut figures = match dim {
        1..=3 => vec![picture.scene(layers).figure()],
        _ => {
            let projected = picture.projected(&layers);
            let mut figures = vec![picture.scene(layers).projection(projected)];
            figures.extend(picture.distances());
            figures
        }
    };
    let steps = passes(&solution.trace.history, &STEP_WORDS, options);
    figures.extend(steps.into_iter().map(Figure::Plot));
    Ok(figures)
}

/// The column of groups, where the certificate names one.
fn group_column(
    certificate: &CentersCertificate,
    source: &dyn PointSource,
) -> Result<Option<usize>, Error> {
    let Some(group) = certificate.group else { return Ok(None) };
    let columns = source.dim();
    match usize::try_from(group).ok().filter(|&group| group < columns && columns > 1) {
        Some(group) => Ok(Some(group)),
        None => agree("number of columns", (group as usize).saturating_add(1).max(2), columns)
            .map(|()| None),
    }
}

/// Checks what the answer and its items must agree in before anything is drawn; the dimension.
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
    agree("number of centers", answer.centers.len().max(1), answer.centers.len())?;
    answer.centers.iter().try_for_each(|c| agree("number of coordinates", c.len(), dim))?;
    all_there(
        "number of points",
        certificate.core_set.iter().chain(&answer.outliers),
        source.len(),
    )?;
    let centers = answer.centers.iter().flatten().map(|v| ("a coordinate of a center", v));
    all_finite(
        centers.chain([("the radius", &answer.radius), ("the lower bound", &answer.lower_bound)]),
    )?;
    if answer.radius < 0.0 {
        return Err(Error::NegativeRadius { what: "the radius".into(), value: answer.radius });
    }
    Ok(dim)
}

/// The data that all pictures of the same centers share.
struct Picture<'a> {
    answer: &'a Centers,
    certificate: &'a CentersCertificate,
    nearest: Nearest,
    input: Input<'a>,
    /// For each item drawn its center, or that of its group; none where there is one center.
    clusters: Vec<usize>,
}

impl<'a> Picture<'a> {
    /// Returns true if balls are drawn, and those of the lower bound.
    fn has_balls(&self) -> bool {
        !self.certificate.weights
    }

    /// The lower bound on the radius that is proved, or that the answer claims.
    fn lower(&self) -> f64 {
        let Centers { radius, lower_bound, .. } = *self.answer;
        match self.input.options.proved_gap {
            Some(gap) if gap.is_finite() && gap >= 0.0 => radius / (1.0 + gap),
            Some(_) => 0.0,
            None => lower_bound,
        }
    }

    fn lower_is_visible(&self) -> bool {
        let (radius, lower) = (self.answer.radius, self.lower());
        self.has_balls() && lower > 0.0 && radius - lower > 0.004 * radius
    }

    /// Radius, gap and lower bound in words.
    fn facts(&self) -> String {
        let Centers { radius, lower_bound, .. } = *self.answer;
        let gap = match radius > 0.0 && lower_bound <= 0.0 {
            true => NO_GAP.to_owned(),
            false => self.input.options.gap_words("relative gap", self.certificate.gap),
        };
        let shape = match self.input.dim {
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
                " Distances count times the weight of the point, so there is no one circle around a center."
            }
            false => "",
        };
        format!("Radius {}; {gap}.{bound}{weights}", exact(radius))
    }

    /// The rows of the core-set, ascending: several points of one ellipsoid are one.
    fn core_set(&self) -> Vec<u64> {
        let mut rows = self.certificate.core_set.clone();
        rows.sort_unstable();
        rows.dedup();
        rows
    }

    /// Returns what is drawn of how many, and what proves the bound.
    fn counts(&self) -> String {
        let thing = self.input.thing();
        let core_set = match self.core_set().len() as u64 {
            0 => String::new(),
            1 => format!(" The one {thing} of the core-set proves the lower bound."),
            m => format!(" The {} {thing}s of the core-set prove the lower bound.", count(m)),
        };
        let left_out = match self.answer.outliers.len() as u64 {
            0 => String::new(),
            1 => format!(" One {thing} is left out."),
            z => format!(" {} {thing}s are left out.", count(z)),
        };
        let drawn = self.input.drawn("the core-set, what is left out, ");
        core_set + &left_out + &drawn + &self.input.misfit("balls")
    }

    /// "the 5 balls", by what they are in this dimension.
    fn balls_name(&self) -> String {
        let shape = match self.input.dim {
            1 => "interval",
            2 => "circle",
            3 => "sphere",
            _ => return "shadows of the balls".into(),
        };
        match self.answer.centers.len() as u64 {
            1 => format!("the {shape}"),
            k => format!("the {} {shape}s", count(k)),
        }
    }

    /// Balls, rows of no part, the lower bound, the core-set, rows left out, and centers.
    fn layers(&self) -> Result<Vec<Layer<'a>>, Error> {
        let Centers { centers, outliers, radius, .. } = self.answer;
        let mut core = self.core_set();
        core.retain(|id| outliers.binary_search(id).is_err());
        let is_other =
            |id: &u64| core.binary_search(id).is_err() && outliers.binary_search(id).is_err();
        let others: Vec<u64> = self.input.item_pass.ids.iter().copied().filter(is_other).collect();
        let balls = |radius: &f64| Marks::Balls { centers, radius: *radius };
        let mut layers = Vec::new();
        if self.has_balls() {
            layers.push(Layer::answer(self.balls_name(), balls(radius)));
        }
        match self.clusters.is_empty() {
            true => layers.push(self.input.others(others)?),
            false => layers.extend(self.clustered(&others)?),
        }
        if self.lower_is_visible() {
            layers.push(Layer::lower_bound(balls(&self.lower())));
        }
        let name = self.input.named("core-set", core.len());
        let mut core = self.input.group(name, Tone::Support, "of the core-set", core)?;
        if let Marks::Items(group) = &mut core.marks {
            group.size = support_size(0.0, 0.0);
        }
        layers.push(core);
        let name = self.input.named("left out", outliers.len());
        layers.push(self.input.left_out(name, "left out", outliers.clone())?);
        layers.push(Layer::centers(centers));
        Ok(layers)
    }

    /// The items of which nothing else is said, in a tone by their center; tones come again after some centers.
    fn clustered(&self, others: &[u64]) -> Result<Vec<Layer<'static>>, Error> {
        let tones = CLUSTER_TONES.len().min(self.answer.centers.len());
        (0..tones)
            .map(|at| {
                let of_tone = |(id, center): (&u64, &usize)| {
                    (center % tones == at && others.binary_search(id).is_ok()).then_some(*id)
                };
                let drawn = self.input.item_pass.ids.iter().zip(&self.clusters);
                let ids: Vec<u64> = drawn.filter_map(of_tone).collect();
                let more = if at + tones < self.answer.centers.len() { ", …" } else { "" };
                let name = format!("{}s of center {}{more}", self.input.thing(), at + 1);
                self.input.group(name, CLUSTER_TONES[at], "", ids)
            })
            .collect()
    }

    fn scene(&self, layers: Vec<Layer<'a>>) -> Scene<'a> {
        let Input { source, options, dim, .. } = self.input;
        let things = counted(source.len(), self.input.thing());
        let title = format!("Centers of {things}, k = {}, d = {dim}", count(self.certificate.k));
        Scene { title, caption: [self.facts(), self.counts()], dim, options, layers, facing: None }
    }

    /// d > 3: the directions of the centers, and of a few items where the centers do not span a plane.
    fn projected(&self, layers: &[Layer<'_>]) -> Projected<'_> {
        let mut vectors: Vec<f64> = self.nearest.offsets().flatten().collect();
        let mut weights = vec![1.0; self.answer.centers.len()];
        for tone in [Tone::Support, Tone::Point] {
            for layer in layers.iter().filter(|layer| layer.tone == tone) {
                let Marks::Items(group) = &layer.marks else { continue };
                let step = (group.ids.len() / PROJECTION_ITEM_COUNT).max(1);
                for row in group.rows.chunks_exact(group.columns).step_by(step) {
                    vectors.extend(self.nearest.offset(&row[..self.input.dim]));
                    weights.push(PROJECTION_ITEM_WEIGHT);
                }
            }
        }
        to_unit_reach(&mut vectors);
        let words = "A shadow on the two directions in which the centers spread most, from the middle of them. Shadows of \
                     balls may lie over one another where the balls are far apart, and an item that touches a ball \
                     usually falls well inside.";
        Projected {
            measure: &self.nearest,
            unit: self.nearest.unit,
            directions: plane(&vectors, &weights, self.input.dim),
            words: words.to_owned(),
            axes: ["first direction of the centers", "second direction"],
        }
    }

    /// d > 3: how far every item reaches from the center next to it.
    fn distances(&self) -> Option<Figure> {
        let radius = self.answer.radius;
        let words = Histogram {
            title: format!(
                "How far the {}s reach from the center next to them",
                self.input.thing()
            ),
            axis: "distance from the nearest center",
            border: "radius",
            reach: radius,
            left_out: self.answer.outliers.len(),
            support: None,
        };
        (radius > 0.0).then(|| histogram(&self.input, words))
    }
}
