//! Where the filter was uncertain: the exact stages of the plane, one after the other.
//!
//! 1. *Whole numbers in `f64`*, if all coordinates are whole and those of the call close together: then no operation
//!    rounds, and even a zero is a proof. On gridded data nearly every call ends here, most of them as ties, which are
//!    broken with the cofactors at hand and coordinates packed into one key each.
//! 2. *Fixed width*, see [`crate::wide`]; ties with the cofactors at hand.
//! 3. *Double-double*, see [`crate::double_double`], where coordinates differ too much in magnitude for that. After fixed
//!    width, as it takes longer and proves no tie (`examples/stages.rs`).
//! 4. *Any length*, see [`crate::unbounded`].

use crate::number::{Difference, Number, Polynomial};
use crate::perturbation::tie;
use crate::plane::Point;
use crate::plane::polynomials::{cofactors, in_circle, lift, minor};
use crate::sign::Sign;
use crate::stages::{Exact, Stages};
use crate::wide::Wide;
use crate::{double_double, unbounded, wide};

/// Largest coordinate difference m for which 2m² and less are exact.
const ORIENT_WHOLE: f64 = (1u64 << 26) as f64;
const _: () = assert!(2 * (1u64 << 26).pow(2) <= 1 << 53);

/// Largest coordinate difference m for which 12m⁴ and less, the three products of 2m² by 2m², are exact.
const IN_CIRCLE_WHOLE: f64 = 5200.0;
const _: () = assert!(12 * 5200_u64.pow(4) <= 1 << 53);

pub(crate) struct Orient;

impl Polynomial<4> for Orient {
    const DEGREE: u32 = 2;
    const ROUNDINGS: u32 = 4;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 4]) -> N {
        minor(&[d[0], d[1]], &[d[2], d[3]])
    }
}

pub(crate) struct InCircle;

impl Polynomial<6> for InCircle {
    const DEGREE: u32 = 4;
    const ROUNDINGS: u32 = 11;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 6]) -> N {
        let p = [[d[0], d[1]], [d[2], d[3]], [d[4], d[5]]];
        in_circle(&p, &cofactors(&p))
    }
}

/// The coordinates of the points, relative to the origin.
#[inline(always)]
pub(crate) fn relative<const V: usize, const K: usize>(
    points: [Point; V],
    origin: Point,
) -> [Difference; K] {
    std::array::from_fn(|i| [points[i / 2][i % 2], origin[i % 2]])
}

/// The exact sign of `orient(a, b, c)`, for the rare call that a filter left open. The coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn orient_exact(a: Point, b: Point, c: Point, exact: &mut Exact) -> Sign {
    let differences = relative([b, c], a);
    if exact.integral {
        let d = differences.map(|[from, less]| from - less);
        if within(&d, ORIENT_WHOLE) {
            exact.stages.integer += 1;
            return Sign::from(Orient::evaluate(&d));
        }
    }
    if let Some(d) = wide::integers(&differences) {
        exact.stages.wide += 1;
        return Sign::from(Orient::evaluate(&d.map(i128::from)));
    }
    if let Some(sign) = double_double::sign::<Orient, 4>(&differences) {
        exact.stages.double_double += 1;
        return sign;
    }
    exact.stages.unbounded += 1;
    unbounded::sign::<Orient, 4>(&differences)
}

/// The exact sign of `in_circle(a, b, c, q)`, for the rare call that a filter left open. The coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn in_circle_exact(a: Point, b: Point, c: Point, q: Point, exact: &mut Exact) -> Sign {
    stages::<false>(a, b, c, q, exact)
}

/// The exact answer of `conflict(a, b, c, q)`, for the rare call that a filter left open: a, b, c turn
/// counter-clockwise, q is none of them, and the coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn conflict_exact(a: Point, b: Point, c: Point, q: Point, exact: &mut Exact) -> bool {
    stages::<true>(a, b, c, q, exact).is_positive()
}

/// The sign of the in-circle determinant, ties broken if that is asked for.
#[inline(always)]
fn stages<const PERTURBED: bool>(
    a: Point,
    b: Point,
    c: Point,
    q: Point,
    exact: &mut Exact,
) -> Sign {
    let (points, stages) = ([a, b, c], &mut exact.stages);
    if exact.integral
        && let Some(sign) = whole::<PERTURBED>(points, q, &mut stages.ties)
    {
        stages.integer += 1;
        return sign;
    }
    if let Some(sign) = fixed::<PERTURBED>(points, q, &mut stages.ties) {
        stages.wide += 1;
        return sign;
    }
    beyond_fixed::<PERTURBED>(points, q, stages)
}

/// The last stages, out of the way of those that do the work.
#[cold]
#[inline(never)]
fn beyond_fixed<const PERTURBED: bool>(points: [Point; 3], q: Point, stages: &mut Stages) -> Sign {
    if let Some(sign) = double_double::sign::<InCircle, 6>(&relative(points, q)) {
        stages.double_double += 1;
        return sign;
    }
    stages.unbounded += 1;
    any_length::<PERTURBED>(points, q, &mut stages.ties)
}

#[inline(always)]
pub(crate) fn whole<const PERTURBED: bool>(
    points: [Point; 3],
    q: Point,
    ties: &mut u64,
) -> Option<Sign> {
    let p = points.map(|p| [p[0] - q[0], p[1] - q[1]]);
    if !within(p.as_flattened(), IN_CIRCLE_WHOLE) {
        return None;
    }
    let cofactors = cofactors(&p);
    let det = in_circle(&p, &cofactors);
    if !PERTURBED || det != 0.0 {
        return Some(Sign::from(det));
    }
    *ties += 1;
    Some(tie_of_whole_numbers(&p, &cofactors))
}

#[inline(always)]
pub(crate) fn fixed<const PERTURBED: bool>(
    points: [Point; 3],
    q: Point,
    ties: &mut u64,
) -> Option<Sign> {
    let d = wide::integers::<6>(&relative(points, q))?;
    let p = [[d[0], d[1]], [d[2], d[3]], [d[4], d[5]]].map(|p| p.map(i128::from));
    let cofactors = cofactors(&p);
    let sign = term(&p[0], cofactors[0])
        .plus(term(&p[1], cofactors[1]))
        .plus(term(&p[2], cofactors[2]))
        .sign();
    if !PERTURBED || !sign.is_zero() {
        return Some(sign);
    }
    *ties += 1;
    Some(tie(&points, &q, |vertex| Sign::from(cofactors[vertex])))
}

/// |p|² by its cofactor.
#[inline(always)]
fn term(p: &[i128; 2], cofactor: i128) -> Wide<4> {
    Wide::from(lift(p)).times(Wide::from(cofactor))
}

pub(crate) fn any_length<const PERTURBED: bool>(
    points: [Point; 3],
    q: Point,
    ties: &mut u64,
) -> Sign {
    let sign = unbounded::sign::<InCircle, 6>(&relative(points, q));
    if !PERTURBED || !sign.is_zero() {
        return sign;
    }
    *ties += 1;
    let [a, b, c] = points;
    tie(&points, &q, |vertex| {
        let edge = [[b, c], [c, a], [a, b]][vertex];
        unbounded::sign::<Orient, 4>(&relative(edge, q))
    })
}

/// Returns true if all are at most so large; not if one is NaN.
#[inline(always)]
fn within(differences: &[f64], max: f64) -> bool {
    differences.iter().fold(true, |within, d| within & (d.abs() <= max))
}

/// The tie rule where the points are relative to q and small: a key orders them as their coordinates do, since
/// |y| < 2¹³, and those beyond q are those with a positive key.
#[inline(always)]
fn tie_of_whole_numbers(p: &[[f64; 2]; 3], cofactors: &[f64; 3]) -> Sign {
    let (mut largest, mut decisive) = (0.0, -1.0);
    for (&[x, y], &cofactor) in p.iter().zip(cofactors) {
        let key = x * 16384.0 + y;
        let replaces = (cofactor != 0.0) & (key > largest);
        largest = if replaces { key } else { largest };
        decisive = if replaces { cofactor } else { decisive };
    }
    Sign::from(decisive)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::tests::constants_are_those_of;

    #[test]
    fn constants() {
        constants_are_those_of::<Orient, 4>();
        constants_are_those_of::<InCircle, 6>();
    }
}
