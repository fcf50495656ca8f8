//! The predicates of space as polynomials in coordinate differences, over any kind of number.

use crate::number::Number;

/// The determinant of the first two coordinates, [uv] = uₓvᵧ − uᵧvₓ.
#[inline(always)]
pub(crate) fn minor<N: Number>(u: &[N; 3], v: &[N; 3]) -> N {
    u[0] * v[1] - u[1] * v[0]
}

/// |u|².
#[inline(always)]
pub(crate) fn lift<N: Number>(u: &[N; 3]) -> N {
    u[0] * u[0] + u[1] * u[1] + u[2] * u[2]
}

/// u·v.
#[inline(always)]
pub(crate) fn dot<N: Number>(u: &[N; 3], v: &[N; 3]) -> N {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

/// u × v.
#[inline(always)]
pub(crate) fn cross<N: Number>(u: &[N; 3], v: &[N; 3]) -> [N; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The determinant of the rows u, v, w: six times the volume of the tetrahedron 0uvw.
#[inline(always)]
pub(crate) fn determinant<N: Number>(u: &[N; 3], v: &[N; 3], w: &[N; 3]) -> N {
    u[2] * minor(v, w) - v[2] * minor(u, w) + w[2] * minor(u, v)
}

/// The cofactors of the lifts of a, b, c and d in the in-sphere determinant, all relative to the query point:
/// bcd, −cda, dab, −abc. The six minors are shared.
#[inline(always)]
pub(crate) fn cofactors<N: Number>([a, b, c, d]: &[[N; 3]; 4]) -> [N; 4] {
    let (ab, bc, cd) = (minor(a, b), minor(b, c), minor(c, d));
    let (ac, bd, ad) = (minor(a, c), minor(b, d), minor(a, d));
    [
        b[2] * cd - c[2] * bd + d[2] * bc,
        c[2] * ad - a[2] * cd - d[2] * ac,
        a[2] * bd - b[2] * ad + d[2] * ab,
        b[2] * ac - a[2] * bc - c[2] * ab,
    ]
}

/// The in-sphere determinant D = |a|²bcd − |b|²cda + |c|²dab − |d|²abc from its cofactors.
#[inline(always)]
pub(crate) fn in_sphere<N: Number>(p: &[[N; 3]; 4], cofactors: &[N; 4]) -> N {
    (lift(&p[0]) * cofactors[0] + lift(&p[1]) * cofactors[1])
        + (lift(&p[2]) * cofactors[2] + lift(&p[3]) * cofactors[3])
}

/// One coordinate of the numerator U of the circumcenter U/2·det(u, v, w) of the tetrahedron 0uvw.
#[inline(always)]
pub(crate) fn numerator<N: Number>(u: &[N; 3], v: &[N; 3], w: &[N; 3], axis: usize) -> N {
    let cross = |u: &[N; 3], v: &[N; 3]| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        u[i] * v[j] - u[j] * v[i]
    };
    lift(u) * cross(v, w) + lift(v) * cross(w, u) + lift(w) * cross(u, v)
}
