//! Vectors of the plane and of space as arrays, for what is done in plain `f64`.

/// As the map of an array that is not empty, in a loop of known length: closures given to that one are not always inlined.
#[inline(always)]
pub(crate) fn mapped<T: Copy, U: Copy, const N: usize>(from: [T; N], f: impl Fn(T) -> U) -> [U; N] {
    let mut to = [f(from[0]); N];
    for i in 1..N {
        to[i] = f(from[i]);
    }
    to
}

#[inline(always)]
pub(crate) fn difference<const D: usize>(p: [f64; D], q: [f64; D]) -> [f64; D] {
    let mut difference = p;
    for i in 0..D {
        difference[i] -= q[i];
    }
    difference
}

#[inline(always)]
pub(crate) fn dot<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (0..D).map(|i| p[i] * q[i]).sum()
}

/// The squared length.
#[inline(always)]
pub(crate) fn square<const D: usize>(p: [f64; D]) -> f64 {
    dot(p, p)
}

#[inline(always)]
pub(crate) fn cross(u: [f64; 3], v: [f64; 3]) -> [f64; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// The largest magnitude of a coordinate.
#[inline(always)]
pub(crate) fn largest<const D: usize>(points: &[[f64; D]]) -> f64 {
    points.iter().flatten().fold(0.0, |m: f64, x| if x.abs() > m { x.abs() } else { m })
}
