//! Vectors of the plane and of space as arrays, for what is done in plain `f64`.

#[inline(always)]
pub(crate) fn difference<const D: usize>(p: [f64; D], q: [f64; D]) -> [f64; D] {
    std::array::from_fn(|i| p[i] - q[i])
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
