//! The predicates of the plane as polynomials in coordinate differences, over any kind of number.

use crate::number::Number;

/// The 2 × 2 determinant [uv] = uₓvᵧ − uᵧvₓ: twice the area of the triangle 0uv.
#[inline(always)]
pub(crate) fn minor<N: Number>(u: &[N; 2], v: &[N; 2]) -> N {
    u[0] * v[1] - u[1] * v[0]
}

/// |u|².
#[inline(always)]
pub(crate) fn lift<N: Number>(u: &[N; 2]) -> N {
    u[0] * u[0] + u[1] * u[1]
}

/// u·v.
#[inline(always)]
pub(crate) fn dot<N: Number>(u: &[N; 2], v: &[N; 2]) -> N {
    u[0] * v[0] + u[1] * v[1]
}

/// The cofactors of the lifts of a, b and c in the in-circle determinant, all relative to the query point.
#[inline(always)]
pub(crate) fn cofactors<N: Number>([a, b, c]: &[[N; 2]; 3]) -> [N; 3] {
    [minor(b, c), minor(c, a), minor(a, b)]
}

/// The in-circle determinant D = |a|²[bc] + |b|²[ca] + |c|²[ab] from its cofactors.
#[inline(always)]
pub(crate) fn in_circle<N: Number>(p: &[[N; 2]; 3], cofactors: &[N; 3]) -> N {
    lift(&p[0]) * cofactors[0] + lift(&p[1]) * cofactors[1] + lift(&p[2]) * cofactors[2]
}

/// One coordinate of the numerator U of the circumcenter U/2[uv] of the triangle 0uv.
#[inline(always)]
pub(crate) fn numerator<N: Number>(u: &[N; 2], v: &[N; 2], axis: usize) -> N {
    match axis {
        0 => v[1] * lift(u) - u[1] * lift(v),
        _ => u[0] * lift(v) - v[0] * lift(u),
    }
}
