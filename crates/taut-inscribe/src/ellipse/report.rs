//! The ellipse found, as numbers of the input that no edge enters.

use taut_certify::{InscribedEllipse, Stop};
use taut_points::two_to;

use super::ascent::Ellipse;
use super::shape::Shape;
use crate::units::Units;

/// What rounding of coordinates, axes and distances can change, relative to what they are made of: 2⁻⁴⁷.
const ROUNDING: f64 = two_to(-47);

/// How much farther than the size a touching edge may be, relative to the size; rounding comes on top.
const TOUCHING_SLACK: f64 = 1e-9;

/// Share of a gap by which rounding may miss it.
const GAP_SLACK: f64 = 1e-9;

/// An answer.
pub(super) struct Reported {
    pub(super) answer: InscribedEllipse,
    /// The size in units.
    pub(super) size: f64,
    /// Edges that the ellipse touches up to rounding, ascending.
    pub(super) touching: Vec<u32>,
}

/// Rounds an ellipse in units and shrinks it by what that can change; `None` where nothing is left.
pub(super) fn rounded(best: &Ellipse, units: &Units) -> Option<Reported> {
    let center = units.given_point(best.center);
    let shape = best.shape;
    // The center is rounded once more by the input.
    let moved = units.point(center);
    let lengths: Vec<f64> =
        units.edges.iter().map(|&edge| shape.nearest(moved, edge).length).collect();
    let least = lengths.iter().copied().fold(f64::INFINITY, f64::min);
    let (s, t) = (shape.s.abs(), shape.t);
    let error = ROUNDING * ((1.0 + s) / t.sqrt() + t.sqrt() + least * (1.0 + s / t));
    let size = least - error;
    if size.is_nan() || size <= 0.0 {
        return None;
    }
    let touched = least * (1.0 + TOUCHING_SLACK) + 2.0 * error;
    let touching = (0..lengths.len() as u32).filter(|&edge| lengths[edge as usize] <= touched);
    let [first, second] = columns(&shape, size);
    let axes = [
        [units.given_length(0, first[0]), units.given_length(0, second[0])],
        [units.given_length(1, first[1]), units.given_length(1, second[1])],
    ];
    let area = std::f64::consts::PI * (axes[0][0] * axes[1][1]);
    Some(Reported {
        answer: InscribedEllipse { center, axes, area },
        size,
        touching: touching.collect(),
    })
}

/// Whether the axes have all digits: subnormal ones would be those of another ellipse, which edges may enter.
pub(super) fn has_digits(answer: &InscribedEllipse) -> bool {
    [answer.axes[0][0], answer.axes[1][1]].iter().all(|x| x.is_normal())
}

/// The columns of the map from the unit disk; the first coordinate of the second is 0.
fn columns(shape: &Shape, size: f64) -> [[f64; 2]; 2] {
    [shape.inverse([size, 0.0]), shape.inverse([0.0, size])]
}

/// Why the search ended.
pub(super) fn stop(is_complete: bool, gap: f64, epsilon: f64) -> Stop {
    match is_complete {
        _ if gap <= epsilon * (1.0 + GAP_SLACK) => Stop::Converged,
        true => Stop::Rounding,
        false => Stop::NodeBudget,
    }
}
