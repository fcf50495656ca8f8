//! Decides whether what is said of an inscribed ellipsoid is true.
//!
//! *Claims.* |Gᵀa| ≤ b − aᵀc for every half-space; `lower` is at most the largest log-volume and `upper` at least that;
//! `gap` is at least the largest log-volume less that of the answer; the log-volume stated is that of G.
//! *Truth.* The largest log-volume is bracketed once per input by [`mvie`](super::mvie), from the center of the first answer
//! judged that lies inside: which point that is does not change the bracket but for its last digits.

#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use taut::Solution;
use taut::certify::{InscribedEllipsoid, InscribedVerdict};

use super::Truth;
use super::claims::Claims;
use super::ellipsoid::{is_gap_granted, log_volume_tolerance};
use super::interval::{Interval, log_unit_ball};
use super::linear::{Matrix, Vector, determinant, dot, exact, exact_rows, squared_length};
use super::mvee::Bracket;
use super::mvie::{self, Side};

/// The truth about the ellipsoids in one polytope.
pub(crate) struct InscribedOracle {
    /// Half-spaces other than the whole space; `None` where a row is empty or not finite.
    sides: Option<Vec<Side>>,
    optimum: OnceLock<Option<Bracket>>,
}

impl InscribedOracle {
    pub(crate) fn new(values: &[f64], columns: usize) -> Self {
        let dim = columns.saturating_sub(1);
        let rows = values.chunks_exact(columns.max(1));
        let sides: Option<Vec<Option<Side>>> = rows.map(|row| side(row, dim)).collect();
        let sides = sides.map(|sides| sides.into_iter().flatten().collect());
        InscribedOracle { sides, optimum: OnceLock::new() }
    }

    pub(crate) fn judge(
        &self,
        solution: &Solution<InscribedEllipsoid>,
        verdict: &InscribedVerdict,
    ) -> Truth {
        let mut claims = Claims::default();
        let answer = &solution.answer;
        let Some(sides) = &self.sides else {
            return Truth::Undecided("some row is not a half-space".into());
        };
        let numbers = [verdict.lower, verdict.upper, verdict.gap, answer.log_volume];
        let (Some(center), Some(axes), Some(numbers)) =
            (exact(&answer.center), exact_rows(&answer.axes), exact(&numbers))
        else {
            return Truth::False("a number is not finite".into());
        };
        let [lower, upper, gap, stated] = &numbers[..] else {
            return Truth::False("a number is not finite".into());
        };
        let dim = center.len();
        if axes.len() != dim || sides.iter().any(|side| side.normal.len() != dim) {
            return Truth::False("the lengths of lists disagree".into());
        }
        inside(&mut claims, sides, &center, &axes);
        let Some(volume) = determinant(&axes).and_then(|det| det.absolute().ln()) else {
            return Truth::False("the axes are singular".into());
        };
        let volume = volume.plus(&log_unit_ball(dim));
        let granted = log_volume_tolerance(&answer.axes, volume.rounded());
        claims.near("log-volume", stated, &volume, granted);
        claims.near("lower end, the log-volume", lower, &volume, 2.0 * granted);
        claims.at_most("lower end, as the log-volume", lower, &volume);
        if verdict.upper < f64::MAX {
            claims.at_most("log-volume and gap, as the upper end", &volume.plus(gap), upper);
        }
        let (found, claimed) = (verdict.gap, solution.certificate.gap);
        claims.holds(Some(is_gap_granted(found, claimed, dim)), || {
            format!("gap {found:e} proved, {claimed:e} claimed")
        });
        if claims.is_settled_false() {
            return claims.truth();
        }
        let Some(optimum) = self.optimum.get_or_init(|| mvie::bracket(sides, &center)) else {
            return Truth::Undecided("the largest log-volume is not known".into());
        };
        claims.below("lower end", lower, optimum);
        claims.above("upper end", upper, optimum);
        claims.above("log-volume and gap", &volume.plus(gap), optimum);
        claims.truth()
    }

    /// The lower end of the bracket, and how wide that is.
    #[cfg(test)]
    pub(crate) fn bracket_for_tests(&self) -> Option<(f64, f64)> {
        let Bracket { lower, upper } = self.optimum.get()?.as_ref()?;
        Some((lower.rounded(), upper.minus(lower).rounded()))
    }
}

/// A row over the power of two that brings the largest entry of a to about 1; nothing for a = 0 and b ≥ 0.
fn side(row: &[f64], dim: usize) -> Option<Option<Side>> {
    let (normal, bound) = (exact(&row[..dim])?, Interval::exact(row[dim])?);
    let used = normal.iter().filter(|a| a.is_nonzero()).map(Interval::binary_order);
    let Some(order) = used.max() else { return (row[dim] >= 0.0).then_some(None) };
    let normal = normal.iter().map(|a| a.scaled(-order)).collect();
    Some(Some(Side { normal, bound: bound.scaled(-order) }))
}

/// |Gᵀa|² ≤ (b − aᵀc)² and b − aᵀc ≥ 0.
fn inside(claims: &mut Claims, sides: &[Side], center: &[Interval], axes: &Matrix) {
    for (row, side) in sides.iter().enumerate() {
        let room = side.bound.minus(&dot(&side.normal, center));
        claims.at_most(
            &format!("half-space {row}: 0 and the room at the center"),
            &Interval::zero(),
            &room,
        );
        let columns = (0..center.len()).map(|k| {
            let terms = axes.iter().zip(&side.normal);
            terms.fold(Interval::zero(), |sum, (row, a)| sum.plus(&row[k].times(a)))
        });
        let normal: Vector = columns.collect();
        let what = format!("half-space {row}: squared reach and room");
        claims.at_most(&what, &squared_length(&normal), &room.square());
    }
}
