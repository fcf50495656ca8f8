//! Where the filter was uncertain: the exact stages, one after the other.

use crate::number::{Difference, Number, Polynomial};
use crate::perturbation::tie;
use crate::sign::Sign;
use crate::space::Point;
use crate::space::polynomials::{cofactors, determinant, in_sphere};
use crate::stages::Exact;
use crate::unbounded;

struct Orient;

impl Polynomial<9> for Orient {
    const DEGREE: u32 = 3;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 9]) -> N {
        determinant(&[d[0], d[1], d[2]], &[d[3], d[4], d[5]], &[d[6], d[7], d[8]])
    }
}

struct InSphere;

impl Polynomial<12> for InSphere {
    const DEGREE: u32 = 5;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 12]) -> N {
        let p = [[d[0], d[1], d[2]], [d[3], d[4], d[5]], [d[6], d[7], d[8]], [d[9], d[10], d[11]]];
        in_sphere(&p, &cofactors(&p))
    }
}

/// The coordinates of the points, relative to the origin.
fn relative<const V: usize, const K: usize>(points: [Point; V], origin: Point) -> [Difference; K] {
    std::array::from_fn(|i| [points[i / 3][i % 3], origin[i % 3]])
}

/// The exact sign of `orient(a, b, c, d)`, for the rare call that a filter left open. The coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn orient_exact(a: Point, b: Point, c: Point, d: Point, exact: &mut Exact) -> Sign {
    exact.stages.unbounded += 1;
    unbounded::sign::<Orient, 9>(&relative([b, c, d], a))
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
    exact.stages.unbounded += 1;
    unbounded::sign::<InSphere, 12>(&relative([a, b, c, d], q))
}

/// The exact answer of `conflict(a, b, c, d, q)`, for the rare call that a filter left open: the orientation of
/// abcd is positive, q is none of them, and the coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn conflict_exact(a: Point, b: Point, c: Point, d: Point, q: Point, exact: &mut Exact) -> bool {
    match in_sphere_exact(a, b, c, d, q, exact) {
        Sign::Positive => true,
        Sign::Negative => false,
        Sign::Zero => {
            exact.stages.ties += 1;
            tie(&[a, b, c, d], &q, |vertex| {
                // bcd, −cda, dab, −abc, the negative ones with two points exchanged.
                let facet = [[b, c, d], [d, c, a], [d, a, b], [b, a, c]][vertex];
                unbounded::sign::<Orient, 9>(&relative(facet, q))
            })
        }
    }
}
