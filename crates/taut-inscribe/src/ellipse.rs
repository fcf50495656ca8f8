//! The largest ellipse in a polygon.
//!
//! *Problem.* Find the ellipse of the largest area whose center is inside and that no edge enters.
//! *Idea.* For each shape (s, t), a norm of determinant 1, the ellipse is a largest circle ([`shape`]). Branch and bound over cells of
//! shapes and centers ([`search`]), in units of the bounding box ([`crate::units`]). The size of an ellipse is at most Σ λᵢ·dist(c, eᵢ)
//! for weights λ ≥ 0 with Σ λᵢ = 1, and over a cell a linear bound of that sum is largest at one of sixteen corners ([`cell`]).
//! The weights solve a linear program with five rows ([`weights`]); its dual is the step of a local ascent ([`ascent`]).
//! *Guarantee.* largest area ≤ (1 + ε)·area, from the leaves of the subdivision, which are the certificate. No ellipse is reported
//! that an edge enters.
//! *Trap.* Cells of centers are skewed as their shapes are: a box along the axes is no cell for a long ellipse across it.
//! *Reference.* For largest circles, Garcia-Castellanos and Lombardo, Scottish Geographical J. 123(3), 2007. The bound by edges
//! over shapes is new here.

mod ascent;
mod cell;
mod method;
mod report;
mod sampled;
mod search;
mod shape;
mod tree;
mod view;
mod weights;
mod widths;

use std::collections::BTreeMap;

use taut_certify::{EllipseCertificate, InscribedEllipse, Solution, Trace};
use taut_points::{InputError, Monitor, PointSource, shown_number};

use crate::Error;
use crate::levels::Levels;
use crate::polygon::{Polygon, is_inside, is_measurable};
use crate::units::Units;

use self::ascent::Ellipse;
use self::shape::Shape;

pub use self::method::{EllipseMethod, EllipseThesisOptions};

/// How to look for the ellipse. Write `EllipseOptions { epsilon: 1e-6, ..Default::default() }`.
#[derive(Clone)]
pub struct EllipseOptions<'a> {
    /// How the ellipse is found. Default [`EllipseMethod::BranchAndBound`].
    pub method: EllipseMethod,
    /// Proved relative gap of the area to reach, in (0, 1): largest area ≤ (1 + ε)·area. For other methods than the default it is the gap
    /// of the largest ellipse that the search of the bound finds. Default 1e-3.
    pub epsilon: f64,
    /// Most cells of the certificate; where ε takes more, a larger gap is proved. At least 1, by default a million.
    pub max_cells: u64,
    /// Watches the work and can stop it. Default [`Monitor::silent`].
    pub monitor: Monitor<'a>,
}

impl Default for EllipseOptions<'_> {
    fn default() -> Self {
        EllipseOptions {
            method: EllipseMethod::default(),
            epsilon: 1e-3,
            max_cells: 1_000_000,
            monitor: Monitor::silent(),
        }
    }
}

/// Rings of a polygon for the methods of the thesis, at most: each ring has three samples or more, and facets grow with the square.
const RINGS_MAX: usize = 300;

/// Finds the ellipse of the largest area in a polygon.
///
/// Points (x, y) are the vertices of one ring in order; points (x, y, r) those of several rings, r being the number of the ring:
/// 0, 1, and so on. Inside is what an odd number of rings wind around. The last vertex of a ring may repeat its first. The points
/// are read once and kept in memory.
///
/// # Errors
/// [`Error::NotSimple`] with two edges that meet, [`Error::RingNumber`], [`Error::TooFewVertices`], [`Error::TooThin`],
/// [`Error::Area`] when the area is no normal number, and [`Error::Input`] for bad points or options, and for what reading says.
pub fn inscribed_ellipse(
    polygon: &dyn PointSource,
    options: &EllipseOptions<'_>,
) -> Result<Solution<InscribedEllipse>, Error> {
    check_options(options)?;
    let polygon = Polygon::read(polygon, &options.monitor)?;
    solved(&polygon, &Units::of(&polygon.edges), options)
}

/// Finds the ellipse in a polygon that has been read.
pub(crate) fn solved(
    polygon: &Polygon,
    units: &Units,
    options: &EllipseOptions<'_>,
) -> Result<Solution<InscribedEllipse>, Error> {
    let mut counters = BTreeMap::new();
    let mut count = |name: &str, count: u64| counters.insert(name.to_owned(), count);
    let sampled = match options.method {
        EllipseMethod::BranchAndBound => None,
        EllipseMethod::Thesis(thesis) | EllipseMethod::FivePoint(thesis) => {
            let rings = units.edges.chunk_by(|one, next| one[1] == next[0]).count();
            if rings > RINGS_MAX {
                let (name, value) = ("method", options.method.name().to_owned());
                let expected = "branch-and-bound for polygons of more than 300 rings";
                return Err(InputError::Option { name, value, expected }.into());
            }
            let has_five = matches!(options.method, EllipseMethod::FivePoint(_));
            let found = sampled::largest(units, &thesis, has_five, &options.monitor)?;
            count("samples", found.samples);
            count("facets", found.facets);
            let reported = found.ellipse.and_then(|ellipse| report::rounded(&ellipse, units));
            let (method, samples) = (options.method.name(), found.samples);
            Some(reported.ok_or(Error::NoneAmongSamples { method, samples })?)
        }
    };
    let found = search::search(units, options, sampled.as_ref().map(|reported| reported.size))?;
    let best = found.best.ok_or(Error::TooThin)?;
    let best = report::rounded(&best, units).ok_or(Error::TooThin)?;
    let reached = (found.upper / best.size).powi(2) - 1.0;
    let reported = sampled.unwrap_or(best);
    // In units of the last place of the coordinates the center may be rounded out of the polygon.
    if !is_inside(polygon.edges.iter().copied(), reported.answer.center) {
        return Err(Error::TooThin);
    }
    let ratio = found.upper / reported.size;
    let gap = (ratio * ratio * (1.0 + 16.0 * f64::EPSILON) - 1.0).max(0.0);
    if !(report::has_digits(&reported.answer) && is_measurable(reported.answer.area, gap)) {
        return Err(Error::Area);
    }
    let numbers = |parts: Vec<(u32, u64)>| match parts[..] {
        [(edge, _)] => vec![polygon.rows[edge as usize]],
        _ => parts.iter().flat_map(|&(edge, w)| [polygon.rows[edge as usize], w]).collect(),
    };
    let certificate = EllipseCertificate {
        touching: reported.touching.iter().map(|&edge| polygon.rows[edge as usize]).collect(),
        root: found.root,
        directions: found.directions,
        tree: found.log.tree,
        leaves: found.log.leaves.into_iter().map(numbers).collect(),
        gap,
        points_hash: polygon.points_hash,
    };
    count("cells", certificate.tree.len() as u64);
    count("ascents", found.ascents);
    count("vertices", polygon.rows.len() as u64);
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop: report::stop(found.is_complete, reached, options.epsilon),
        passes: 1,
        iterations: certificate.tree.len() as u64,
        core_set: certificate.touching.len() as u64,
        history: vec![],
        counters,
    };
    Ok(Solution { answer: reported.answer, certificate, trace })
}

/// Local optima: their centers and the forms of their norms |w|² = m₀w₁² + 2m₁w₁w₂ + m₂w₂², the largest of their starts first.
pub(crate) fn local_optima(units: &Units, most: usize) -> Vec<([f64; 2], [f64; 3])> {
    let (edges, levels) = (&units.edges, Levels::of(&units.edges, units.extent[1]));
    let is_inside = |ellipse: &Ellipse| levels.is_inside(edges, ellipse.center);
    let circles = search::largest_circles(units, most).into_iter().filter(is_inside);
    let found = circles.map(|circle| circle.climbed(edges)).filter(is_inside);
    let form = |Shape { s, t, .. }: Shape| [t + s * s / t, s / t, 1.0 / t];
    found.map(|ellipse| (ellipse.center, form(ellipse.shape))).collect()
}

pub(crate) fn check_options(options: &EllipseOptions<'_>) -> Result<(), InputError> {
    let wrong = |name, value, expected| Err(InputError::Option { name, value, expected });
    if !(options.epsilon > 0.0 && options.epsilon < 1.0) {
        return wrong("epsilon", shown_number(options.epsilon), "a number above 0 and below 1");
    }
    if options.max_cells == 0 {
        return wrong("max_cells", "0".to_owned(), "at least 1");
    }
    match options.method {
        EllipseMethod::BranchAndBound => Ok(()),
        EllipseMethod::Thesis(thesis) | EllipseMethod::FivePoint(thesis) => thesis.check(),
    }
}
