//! The oracle of the minimum enclosing ball.
//!
//! The optimum of the input lies in a bracket of relative width 2⁻¹⁰⁰ or less, whatever the answer says; everything else is
//! decided exactly. Of rows that are ellipsoids no bracket is
//! known here: the largest lower bound that was verified and the smallest ball must agree.

use taut::certify::{Ball, Verdict};
use taut::{Items, Solution};

use super::Truth;
use super::dyadic::{Dyadic, exact, sum};
use super::enclosing::{Body, Bracket, bracket, digits, dual};
use super::shapes::{Shape, shapes};

/// The unit roundoff of `f64` is 2 to this, 2⁻⁵³.
const ROUNDOFF_EXPONENT: i64 = -53;

/// The true facts about one input.
pub struct BallOracle {
    items: Items,
    dim: usize,
    rows: usize,
    bodies: Vec<Body>,
    bracket: Option<Bracket>,
    /// Rows that are ellipsoids.
    shapes: Option<Vec<Shape>>,
}

impl BallOracle {
    /// Finds the smallest ball of the rows; of rows that are no such items no claim is true.
    pub fn new(values: &[f64], columns: usize, items: Items) -> Self {
        let dim = items.dim(columns);
        let bodies = bodies(values, columns, items).unwrap_or_default();
        let bracket = (!bodies.is_empty()).then(|| bracket(&bodies));
        let rows = values.len() / columns;
        let shapes = match items {
            Items::Ellipsoids if dim > 0 => shapes(values, columns),
            _ => None,
        };
        BallOracle { items, dim, rows, bodies, bracket, shapes }
    }

    /// Judges every claim of an accepted answer.
    pub fn judge(&self, solution: &Solution<Ball>, verdict: &Verdict) -> Truth {
        let are_ellipsoids = self.items == Items::Ellipsoids;
        if self.dim == 0 || self.bracket.is_none() && self.shapes.is_none() {
            return Truth::False("the rows are no items that a ball is the smallest around".into());
        }
        let (ball, certificate) = (&solution.answer, &solution.certificate);
        let dim = self.dim;
        let directions = if are_ellipsoids { certificate.support.len() } else { 0 };
        let is_number = |value: f64| value >= 0.0 && value.is_finite();
        let form = [
            (is_number(ball.radius), "the radius is no number of at least 0"),
            (ball.center.len() == dim, "the center has another dimension"),
            (ball.center.iter().all(|c| c.is_finite()), "the center is not finite"),
            (is_tail(&ball.center, &ball.center_tail), "the tail is not what rounding leaves"),
            (verdict.upper == ball.radius, "the upper bound is not the radius"),
            (is_number(verdict.lower), "the lower bound is no number of at least 0"),
            (is_number(certificate.gap), "the claimed gap is no number of at least 0"),
            (
                certificate.directions.len() == directions,
                "there is no direction for each ellipsoid",
            ),
            (
                certificate.directions.iter().all(|a| a.len() == dim),
                "a direction has another dimension",
            ),
            (
                certificate.directions.iter().flatten().all(|x| x.is_finite()),
                "a direction is not finite",
            ),
            (verdict.gap >= 0.0, "the gap is negative"),
        ];
        if let Some((_, reason)) = form.iter().find(|(holds, _)| !holds) {
            return Truth::False((*reason).into());
        }
        let center = center_of(&ball.center, &ball.center_tail);
        let radius = Dyadic::of(ball.radius);
        let sizes = match &self.bracket {
            Some(bracket) => enclosed(&self.bodies, &center, &radius)
                .and(|| bounded(bracket, verdict.lower, &radius, verdict.gap)),
            None => self.shapes_enclosed(ball),
        };
        sizes
            .and(|| {
                Truth::claim(is_gap_granted(verdict.gap, certificate.gap), || {
                    format!("gap {:e} proved, {:e} claimed", verdict.gap, certificate.gap)
                })
            })
            .and(|| self.multipliers(solution, &center, &radius))
            .and(|| self.proved(solution, verdict, &radius))
    }

    /// Every ellipsoid lies in the ball.
    fn shapes_enclosed(&self, ball: &Ball) -> Truth {
        let shapes = self.shapes.iter().flatten().enumerate();
        shapes.fold(Truth::True, |truth, (row, shape)| {
            truth.and(|| match shape.is_within(&ball.center, &ball.center_tail, ball.radius) {
                Some(true) => Truth::True,
                Some(false) => Truth::False(format!("ellipsoid {row} reaches beyond the radius")),
                None => Truth::Undecided(format!("ellipsoid {row} may reach beyond the radius")),
            })
        })
    }

    /// The lower bound is no larger than what the multipliers prove, or the radius of a ball of the support; and the gap is
    /// that to it, or more. The optimum may be far above what they prove, and would hide a gap that is too small.
    fn proved(&self, solution: &Solution<Ball>, verdict: &Verdict, radius: &Dyadic) -> Truth {
        if self.bodies.is_empty() {
            return Truth::True;
        }
        let certificate = &solution.certificate;
        let support: Vec<&Body> =
            certificate.support.iter().map(|&row| &self.bodies[row as usize]).collect();
        let bits = digits(&self.bodies);
        let by_lambda = dual(&support, &exact(&certificate.multipliers), bits);
        let largest = support.iter().map(|body| &body.radius).max().into_iter().cloned();
        let most = largest.fold(by_lambda, Dyadic::max);
        let most = &most + &most.scaled(-100);
        let Verdict { lower, gap, .. } = *verdict;
        let is_below = Truth::claim(Dyadic::of(lower) <= most, || {
            format!(
                "the lower bound {lower:e} exceeds {}, which the multipliers prove",
                most.text()
            )
        });
        is_below.and(|| {
            let is_covered = gap == f64::INFINITY
                || &(&Dyadic::integer(1) + &Dyadic::of(gap)) * &most >= *radius;
            Truth::claim(is_covered, || {
                format!(
                    "the radius exceeds {}, which the multipliers prove, by more than a gap of {gap:e}",
                    most.text()
                )
            })
        })
    }

    /// The multipliers are convex, and the center is their combination of the support.
    fn multipliers(&self, solution: &Solution<Ball>, center: &[Dyadic], radius: &Dyadic) -> Truth {
        let (ball, certificate) = (&solution.answer, &solution.certificate);
        let (support, lambda) = (&certificate.support, &certificate.multipliers);
        if support.is_empty() || support.len() != lambda.len() {
            return Truth::False("support and multipliers differ in length".into());
        }
        let may_repeat = self.items == Items::Ellipsoids;
        let ascending =
            support.windows(2).all(|pair| pair[0] < pair[1] || may_repeat && pair[0] == pair[1]);
        if !ascending || support.iter().any(|&row| row >= self.rows as u64) {
            return Truth::False("the support is no ascending list of rows".into());
        }
        if !lambda.iter().all(|&l| l > 0.0 && l.is_finite()) {
            return Truth::False("a multiplier is not above 0".into());
        }
        let lambda = exact(lambda);
        let weight = sum(lambda.iter().cloned());
        let off = (&weight - &Dyadic::integer(1)).abs();
        if off > Dyadic::integer(2 * (support.len() as i64 + 2)).scaled(ROUNDOFF_EXPONENT) {
            return Truth::False(format!("the multipliers sum to 1 but for {}", off.text()));
        }
        // Points of ellipsoids are rounded, so their combination is not asked for.
        if may_repeat {
            return Truth::True;
        }
        for (j, c) in center.iter().enumerate() {
            let moment = sum(support
                .iter()
                .zip(&lambda)
                .map(|(&row, l)| l * &(&self.bodies[row as usize].position[j] - c)));
            let size = Dyadic::of(ball.center[j].abs());
            let granted = match ball.center_tail.is_empty() {
                true => (&size + radius).scaled(ROUNDOFF_EXPONENT + 2),
                false => {
                    &radius.scaled(ROUNDOFF_EXPONENT + 2) + &size.scaled(2 * ROUNDOFF_EXPONENT + 3)
                }
            };
            // Multipliers below 2⁻²⁰⁰ count as 0 in the checker.
            let granted = &(&granted + &granted.scaled(-40)) + &Dyadic::power(-1074);
            let granted = &granted + &radius.scaled(-180);
            if moment.abs() > &granted * &weight {
                return Truth::False(format!("the multipliers give another center in column {j}"));
            }
        }
        Truth::True
    }
}

/// Reads rows as points or as balls; none if they cannot be that.
pub fn bodies(values: &[f64], columns: usize, items: Items) -> Option<Vec<Body>> {
    let body = |row: &[f64]| {
        let (position, radius) = match (items, row) {
            (Items::Points, _) => (row, 0.0),
            (Items::Balls, [position @ .., radius]) if !position.is_empty() => (position, *radius),
            _ => return None,
        };
        (radius >= 0.0).then(|| Body {
            position: exact(position),
            radius: Dyadic::of(radius),
            weight: Dyadic::integer(1),
        })
    };
    values.chunks_exact(columns).map(body).collect()
}

/// Tests whether a tail is empty, or what rounding a center to doubles leaves over.
pub fn is_tail(center: &[f64], tail: &[f64]) -> bool {
    tail.is_empty()
        || tail.len() == center.len()
            && center.iter().zip(tail).all(|(&c, &t)| t.is_finite() && c + t == c)
}

/// Returns the exact center.
pub fn center_of(center: &[f64], tail: &[f64]) -> Vec<Dyadic> {
    let tail = tail.iter().copied().chain(std::iter::repeat(0.0));
    center.iter().zip(tail).map(|(&c, t)| &Dyadic::of(c) + &Dyadic::of(t)).collect()
}

/// Returns true if a gap proved is as small as the one claimed, up to the slack that the format grants.
pub fn is_gap_granted(proved: f64, claimed: f64) -> bool {
    proved <= (claimed * (1.0 + 1e-9) + 4e-16) * (1.0 + 1e-15)
}

fn enclosed(bodies: &[Body], center: &[Dyadic], radius: &Dyadic) -> Truth {
    match bodies.iter().position(|body| !body.is_within(center, radius)) {
        None => Truth::True,
        Some(row) => {
            let reach = bodies[row].reach(center, 200)[0].clone();
            let excess = (&reach - radius).text();
            Truth::False(format!("row {row} reaches beyond the radius by {excess}"))
        }
    }
}

/// Judges `lower` ≤ R* and `upper` ≤ (1 + gap)·R* for an optimum R* in a bracket.
pub fn bounded(bracket: &Bracket, lower: f64, upper: &Dyadic, gap: f64) -> Truth {
    let lower = Dyadic::of(lower);
    if !bracket.is_narrow() {
        return Truth::Undecided("the bracket of the optimum is not narrow".into());
    }
    let first = Truth::claim(lower <= bracket.upper, || {
        let excess = (&lower - &bracket.upper).quotient(&lower, 60).text();
        format!("the lower bound exceeds the optimum by {excess} of it")
    });
    first.and(|| {
        // An infinite gap claims nothing.
        if gap == f64::INFINITY {
            return Truth::True;
        }
        if !(gap >= 0.0 && gap.is_finite()) {
            return Truth::False(format!("the gap is {gap}"));
        }
        let stretch = &Dyadic::integer(1) + &Dyadic::of(gap);
        Truth::claim(&stretch * &bracket.upper >= *upper, || {
            format!("the radius exceeds the optimum by more than a gap of {gap:e}")
        })
    })
}
