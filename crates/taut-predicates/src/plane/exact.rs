//! Where the filter was uncertain: the exact stages, one after the other.

use crate::number::{Difference, Number, Polynomial};
use crate::perturbation::tie;
use crate::plane::Point;
use crate::plane::polynomials::{cofactors, in_circle, minor};
use crate::sign::Sign;
use crate::stages::Exact;
use crate::unbounded;

struct Orient;

impl Polynomial<4> for Orient {
    const DEGREE: u32 = 2;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 4]) -> N {
        minor(&[d[0], d[1]], &[d[2], d[3]])
    }
}

struct InCircle;

impl Polynomial<6> for InCircle {
    const DEGREE: u32 = 4;

    #[inline(always)]
    fn evaluate<N: Number>(d: &[N; 6]) -> N {
        let p = [[d[0], d[1]], [d[2], d[3]], [d[4], d[5]]];
        in_circle(&p, &cofactors(&p))
    }
}

fn orient_differences(a: Point, b: Point, c: Point) -> [Difference; 4] {
    [[b[0], a[0]], [b[1], a[1]], [c[0], a[0]], [c[1], a[1]]]
}

fn in_circle_differences(a: Point, b: Point, c: Point, q: Point) -> [Difference; 6] {
    [[a[0], q[0]], [a[1], q[1]], [b[0], q[0]], [b[1], q[1]], [c[0], q[0]], [c[1], q[1]]]
}

/// The exact sign of `orient(a, b, c)`, for the rare call that a filter left open. The coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn orient_exact(a: Point, b: Point, c: Point, exact: &mut Exact) -> Sign {
    exact.stages.unbounded += 1;
    unbounded::sign::<Orient, 4>(&orient_differences(a, b, c))
}

/// The exact sign of `in_circle(a, b, c, q)`, for the rare call that a filter left open. The coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn in_circle_exact(a: Point, b: Point, c: Point, q: Point, exact: &mut Exact) -> Sign {
    exact.stages.unbounded += 1;
    unbounded::sign::<InCircle, 6>(&in_circle_differences(a, b, c, q))
}

/// The exact answer of `conflict(a, b, c, q)`, for the rare call that a filter left open: a, b, c turn
/// counter-clockwise, q is none of them, and the coordinates are finite.
#[cold]
#[inline(never)]
#[must_use]
pub fn conflict_exact(a: Point, b: Point, c: Point, q: Point, exact: &mut Exact) -> bool {
    match in_circle_exact(a, b, c, q, exact) {
        Sign::Positive => true,
        Sign::Negative => false,
        Sign::Zero => {
            exact.stages.ties += 1;
            tie(&[a, b, c], &q, |vertex| {
                let (u, v) = [(b, c), (c, a), (a, b)][vertex];
                unbounded::sign::<Orient, 4>(&orient_differences(q, u, v))
            })
        }
    }
}
