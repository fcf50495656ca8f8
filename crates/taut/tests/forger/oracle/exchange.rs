//! The minimum volume enclosing ellipsoid of balls and ellipsoids, bracketed in 256 bits.
//!
//! *Idea.* Every point of a body gives a lower bound as a point by itself does, and the bodies' reach in the frame of a trial
//! ellipsoid gives an upper bound. So points of the bodies are weighed ([`mvee`](super::mvee)), and the farthest points of
//! bodies that reach out of the trial ellipsoid join, until both bounds meet or no longer approach each other. Points
//! without weight leave.

use super::body::{Body, Framed};
use super::interval::Interval;
use super::linear::{Matrix, Vector, Way, transposed};
use super::mvee::{Bracket, MU_EXPONENT_MIN, Trial, larger, weights};

/// At most this many rounds are made.
const ROUNDS_MAX: usize = 40;
/// Rounds end at this width, as a power of two.
const WIDTH_EXPONENT: i64 = -58;

/// A point of a body: where it touches for a direction.
struct Contact {
    body: usize,
    direction: Vector,
}

/// The bracket of bodies in the space that they span; `None` where they do not, or no bracket is found.
pub(super) fn bracket(bodies: &[Body]) -> Option<Bracket> {
    let rank = bodies.first()?.center.len();
    let mut contacts = first_contacts(bodies, rank);
    let mut best: Option<Bracket> = None;
    let mut stalled = 0;
    let mut end = -40;
    for _ in 0..ROUNDS_MAX {
        let points = |way: Way| -> Option<Matrix> {
            contacts.iter().map(|c| bodies[c.body].touching(&c.direction, way)).collect()
        };
        let plain = points(Way::Plain)?;
        let Some(u) = weights(&plain, end) else { break };
        let trial = Trial::of(&points(Way::Proved)?, &u, Way::Proved)?;
        let frame = frame(&trial)?;
        let (mut far, mut joining) = (Interval::zero(), vec![]);
        let limit = Interval::integer(rank as i64);
        for (index, body) in bodies.iter().enumerate() {
            let framed = Framed::of(&frame, &trial.mean, body);
            let upper = framed.upper()?;
            let near = limit.minus(&limit.scaled(-30));
            if upper.at_most(&near) != Some(true) {
                for t in framed.touching(&upper)? {
                    joining.push(Contact { body: index, direction: transposed(&frame, &t) });
                }
            }
            far = larger(far, upper);
        }
        let found = trial.bracket(&far)?;
        let before = best.as_ref().map(width);
        best = Some(match best {
            None => found,
            Some(best) => Bracket {
                lower: larger(best.lower, found.lower),
                upper: larger(best.upper.negative(), found.upper.negative()).negative(),
            },
        });
        let now = best.as_ref().map(width)?;
        end = (2 * now.binary_order() - 40).clamp(MU_EXPONENT_MIN, end);
        if now.binary_order() < WIDTH_EXPONENT {
            break;
        }
        let is_slow = before.is_some_and(|b| now.at_most(&b.scaled(-1)) != Some(true));
        stalled = if is_slow { stalled + 1 } else { 0 };
        if stalled == 6 {
            break;
        }
        let mut keep = u.iter().map(|u| u.is_positive() && u.binary_order() > -40);
        contacts.retain(|_| keep.next().unwrap_or(true));
        contacts.extend(joining);
    }
    best
}

fn width(bracket: &Bracket) -> Interval {
    bracket.upper.minus(&bracket.lower).into_middle()
}

/// Where the bodies touch their boxes.
fn first_contacts(bodies: &[Body], rank: usize) -> Vec<Contact> {
    let mut contacts = vec![];
    for (body, item) in bodies.iter().enumerate() {
        let Some(shape) = &item.shape else {
            contacts.push(Contact { body, direction: vec![] });
            continue;
        };
        for j in (0..rank).filter(|&j| shape.matrix()[j][j].is_positive()) {
            for sign in [1, -1] {
                let unit = |k| Interval::integer(if k == j { sign } else { 0 });
                contacts.push(Contact { body, direction: (0..rank).map(unit).collect() });
            }
        }
    }
    contacts
}

/// F with |F(x − p̄)|² = (x − p̄)ᵀΣ⁻¹(x − p̄).
fn frame(trial: &Trial) -> Option<Matrix> {
    let n = trial.mean.len();
    let unit =
        |j: usize| -> Vector { (0..n).map(|k| Interval::integer(i64::from(j == k))).collect() };
    let columns: Matrix = (0..n).map(|j| trial.factor.whitened(&unit(j))).collect::<Option<_>>()?;
    Some((0..n).map(|a| columns.iter().map(|column| column[a].clone()).collect()).collect())
}
