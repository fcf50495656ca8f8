//! Where the filter was uncertain: the exact stages of space, one after the other; they are those of the plane.

use crate::number::{Difference, Number, Polynomial};
use crate::perturbation::tie;
use crate::sign::Sign;
use crate::space::Point;
use crate::space::polynomials::{cofactors, determinant, in_sphere, lift, minor};
use crate::stages::{Exact, Stages};
use crate::wide::Wide;
use crate::{double_double, unbounded, wide};

/// Largest coordinate difference m for which 6m³ and less are exact.
const ORIENT_WHOLE: f64 = 114_000.0;
const _: () = assert!(6 * 114_000_u64.pow(3) <= 1 << 53);

/// Largest coordinate difference m for which 72m⁵ and less, the four products of 3m² by 6m³, are exact.
const IN_SPHERE_WHOLE: f64 = 659.0;
const _: () = assert!(72 * 659_u64.pow(5) <= 1 << 53);

pub(crate) struct Orient;

impl Polynomial<9> for Orient {
    const DEGREE: u32 = 3;
    const ROUNDINGS: u32 = 8;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 9]) -> N {
        determinant(&[d[0], d[1], d[2]], &[d[3], d[4], d[5]], &[d[6], d[7], d[8]])
    }
}

pub(crate) struct InSphere;

impl Polynomial<12> for InSphere {
    const DEGREE: u32 = 5;
    const ROUNDINGS: u32 = 16;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 12]) -> N {
        let p = rows(d);
        in_sphere(&p, &cofactors(&p))
    }
}

/// The coordinates of the points, relative to the origin.
#[inline(always)]
pub(crate) fn relative<const V: usize, const K: usize>(
    points: [Point; V],
    origin: Point,
) -> [Difference; K] {
    std::array::from_fn(|i| [points[i / 3][i % 3], origin[i % 3]])
}

#[inline(always)]
fn rows<N: Copy>(d: &[N; 12]) -> [[N; 3]; 4] {
    [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]], [d[9], d[10], d[11]]]
}

/// The exact sign of `orient(a, b, c, d)`, for the rare call that a filter left open. The coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn orient_exact(a: Point, b: Point, c: Point, d: Point, exact: &mut Exact) -> Sign {
    let differences: [Difference; 9] = relative([b, c, d], a);
    if exact.integral {
        let d = differences.map(|[from, less]| from - less);
        if within(&d, ORIENT_WHOLE) {
            exact.stages.integer += 1;
            return Sign::from(Orient::evaluate(&d));
        }
    }
    if let Some(d) = wide::integers(&differences) {
        exact.stages.wide += 1;
        let [u, v, w] = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]]];
        let [vw, wu, uv] = [(&v, &w), (&w, &u), (&u, &v)].map(|(u, v)| wide_minor(u, v));
        return expanded([(u[2], vw), (v[2], wu), (w[2], uv)]).sign();
    }
    if let Some(sign) = double_double::sign::<Orient, 9>(&differences) {
        exact.stages.double_double += 1;
        return sign;
    }
    exact.stages.unbounded += 1;
    unbounded::sign::<Orient, 9>(&differences)
}

/// The exact sign of `in_sphere(a, b, c, d, q)`, for the rare call that a filter left open. The coordinates are
/// finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn in_sphere_exact(
    a: Point,
    b: Point,
    c: Point,
    d: Point,
    q: Point,
    exact: &mut Exact,
) -> Sign {
    stages::<false>(a, b, c, d, q, exact)
}

/// The exact answer of `conflict(a, b, c, d, q)`, for the rare call that a filter left open: the orientation of
/// abcd is positive, q is none of them, and the coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn conflict_exact(a: Point, b: Point, c: Point, d: Point, q: Point, exact: &mut Exact) -> bool {
    stages::<true>(a, b, c, d, q, exact).is_positive()
}

/// The sign of the in-sphere determinant, ties broken if that is asked for.
#[inline(always)]
fn stages<const PERTURBED: bool>(
    a: Point,
    b: Point,
    c: Point,
    d: Point,
    q: Point,
    exact: &mut Exact,
) -> Sign {
    let (points, stages) = ([a, b, c, d], &mut exact.stages);
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
fn beyond_fixed<const PERTURBED: bool>(points: [Point; 4], q: Point, stages: &mut Stages) -> Sign {
    if let Some(sign) = double_double::sign::<InSphere, 12>(&relative(points, q)) {
        stages.double_double += 1;
        return sign;
    }
    stages.unbounded += 1;
    any_length::<PERTURBED>(points, q, &mut stages.ties)
}

#[inline(always)]
pub(crate) fn whole<const PERTURBED: bool>(
    points: [Point; 4],
    q: Point,
    ties: &mut u64,
) -> Option<Sign> {
    let p = points.map(|p| [p[0] - q[0], p[1] - q[1], p[2] - q[2]]);
    if !within(p.as_flattened(), IN_SPHERE_WHOLE) {
        return None;
    }
    let cofactors = cofactors(&p);
    let det = in_sphere(&p, &cofactors);
    if !PERTURBED || det != 0.0 {
        return Some(Sign::from(det));
    }
    *ties += 1;
    Some(tie_of_whole_numbers(&p, &cofactors))
}

#[inline(always)]
pub(crate) fn fixed<const PERTURBED: bool>(
    points: [Point; 4],
    q: Point,
    ties: &mut u64,
) -> Option<Sign> {
    let p = rows(&wide::integers::<12>(&relative(points, q))?);
    let cofactors = wide_cofactors(&p);
    let sign = (term(&p[0], cofactors[0]).plus(term(&p[1], cofactors[1])))
        .plus(term(&p[2], cofactors[2]).plus(term(&p[3], cofactors[3])))
        .sign();
    if !PERTURBED || !sign.is_zero() {
        return Some(sign);
    }
    *ties += 1;
    Some(tie(&points, &q, |vertex| cofactors[vertex].sign()))
}

pub(crate) fn any_length<const PERTURBED: bool>(
    points: [Point; 4],
    q: Point,
    ties: &mut u64,
) -> Sign {
    let sign = unbounded::sign::<InSphere, 12>(&relative(points, q));
    if !PERTURBED || !sign.is_zero() {
        return sign;
    }
    *ties += 1;
    let [a, b, c, d] = points;
    tie(&points, &q, |vertex| {
        // bcd, −cda, dab, −abc, the negative ones with two points exchanged.
        let facet = [[b, c, d], [d, c, a], [d, a, b], [b, a, c]][vertex];
        unbounded::sign::<Orient, 9>(&relative(facet, q))
    })
}

/// Returns true if all are at most so large; not if one is NaN.
#[inline(always)]
fn within(differences: &[f64], max: f64) -> bool {
    differences.iter().fold(true, |within, d| within & (d.abs() <= max))
}

/// The tie rule where the points are relative to q and small: a key orders them as their coordinates do, since
/// |y|, |z| < 2¹⁰, and those beyond q are those with a positive key.
#[inline(always)]
fn tie_of_whole_numbers(p: &[[f64; 3]; 4], cofactors: &[f64; 4]) -> Sign {
    let (mut largest, mut decisive) = (0.0, -1.0);
    for (&[x, y, z], &cofactor) in p.iter().zip(cofactors) {
        let key = (x * 2048.0 + y) * 2048.0 + z;
        let replaces = (cofactor != 0.0) & (key > largest);
        largest = if replaces { key } else { largest };
        decisive = if replaces { cofactor } else { decisive };
    }
    Sign::from(decisive)
}

#[inline(always)]
fn wide_minor(u: &[i64; 3], v: &[i64; 3]) -> i128 {
    minor(&u.map(i128::from), &v.map(i128::from))
}

/// |p|² by its cofactor.
#[inline(always)]
fn term(p: &[i64; 3], cofactor: Wide<3>) -> Wide<5> {
    cofactor.times(Wide::from(lift(&p.map(i128::from))))
}

/// Σ z·m, the expansion of a determinant along its third column.
#[inline(always)]
fn expanded([first, second, third]: [(i64, i128); 3]) -> Wide<3> {
    let term = |(z, minor)| -> Wide<3> { Wide::from(minor).times(Wide::<1>::from(z)) };
    term(first).plus(term(second)).plus(term(third))
}

/// As the generic cofactors, but each step in the width that it needs.
#[inline(always)]
fn wide_cofactors([a, b, c, d]: &[[i64; 3]; 4]) -> [Wide<3>; 4] {
    let (ab, bc, cd) = (wide_minor(a, b), wide_minor(b, c), wide_minor(c, d));
    let (ac, bd, ad) = (wide_minor(a, c), wide_minor(b, d), wide_minor(a, d));
    [
        expanded([(b[2], cd), (c[2], -bd), (d[2], bc)]),
        expanded([(c[2], ad), (a[2], -cd), (d[2], -ac)]),
        expanded([(a[2], bd), (b[2], -ad), (d[2], ab)]),
        expanded([(b[2], ac), (a[2], -bc), (c[2], -ab)]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::tests::constants_are_those_of;

    #[test]
    fn constants() {
        constants_are_those_of::<Orient, 9>();
        constants_are_those_of::<InSphere, 12>();
    }
}
