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
mod five_point;
mod options;
mod report;
mod search;
mod shape;
mod tree;
mod view;
mod weights;
mod widths;

use std::collections::BTreeMap;

use taut_certify::{EllipseCertificate, InscribedEllipse, Solution, Trace};
use taut_points::PointSource;

pub(crate) use self::options::check as check_options;
pub use self::options::{EllipseFivePointOptions, EllipseMethod, EllipseOptions};
use crate::Error;
use crate::levels::Levels;
use crate::polygon::Polygon;
use crate::units::Units;

use self::ascent::Ellipse;
use self::shape::Shape;

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
    let found = search::search(units, options)?;
    let best = found.best.ok_or(Error::TooThin)?;
    let reported = report::rounded(&best, units).ok_or(Error::TooThin)?;
    let best_size = reported.size;
    let reported = match &options.method {
        EllipseMethod::BranchAndBound => reported,
        EllipseMethod::FivePoint(five) => {
            let through_five = five_point::largest(units, five, &options.monitor)?;
            let rounded = through_five.and_then(|ellipse| report::rounded(&ellipse, units));
            rounded.ok_or_else(|| options::too_few(five.samples))?
        }
    };
    if !reported.answer.area.is_normal() {
        return Err(Error::Area);
    }
    let gap_of = |size: f64| {
        let ratio = found.upper / size;
        (ratio * ratio * (1.0 + 16.0 * f64::EPSILON) - 1.0).max(0.0)
    };
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
        gap: gap_of(reported.size),
        points_hash: polygon.points_hash,
    };
    let counters = [
        ("cells", certificate.tree.len() as u64),
        ("ascents", found.ascents),
        ("vertices", polygon.rows.len() as u64),
    ];
    let trace = Trace {
        method: options.method.name().to_owned(),
        stop: report::stop(found.is_complete, gap_of(best_size), options.epsilon),
        passes: 1,
        iterations: certificate.tree.len() as u64,
        core_set: certificate.touching.len() as u64,
        history: vec![],
        counters: BTreeMap::from(counters.map(|(name, count)| (name.to_owned(), count))),
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
