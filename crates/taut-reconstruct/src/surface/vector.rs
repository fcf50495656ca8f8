//! Vectors of space.

pub(super) type Vector = [f64; 3];

pub(super) fn minus(p: Vector, q: Vector) -> Vector {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

pub(super) fn dot(p: Vector, q: Vector) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

pub(super) fn cross(p: Vector, q: Vector) -> Vector {
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

/// The circumcenter of the triangle 0uv; not finite where that is too flat for `f64`.
pub(super) fn circumcenter(u: Vector, v: Vector) -> Vector {
    let n = cross(u, v);
    let (nu, vn) = (cross(n, u), cross(v, n));
    let (u2, v2, scale) = (dot(u, u), dot(v, v), 2.0 * dot(n, n));
    [0, 1, 2].map(|i| (nu[i] * v2 + vn[i] * u2) / scale)
}

/// The circumcenter of the tetrahedron 0uvw; not finite where that is too flat for `f64`.
pub(super) fn sphere_center(u: Vector, v: Vector, w: Vector) -> Vector {
    let (vw, wu, uv) = (cross(v, w), cross(w, u), cross(u, v));
    let (u2, v2, w2, scale) = (dot(u, u), dot(v, v), dot(w, w), 2.0 * dot(u, vw));
    [0, 1, 2].map(|i| (u2 * vw[i] + v2 * wu[i] + w2 * uv[i]) / scale)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centers_are_equally_far() {
        let (u, v, w) = ([3.0, 0.5, -1.0], [0.2, 2.0, 0.7], [1.0, -0.4, 2.5]);
        let distance = |p, q| dot(minus(p, q), minus(p, q)).sqrt();
        let c = circumcenter(u, v);
        assert!((distance(c, u) - distance(c, [0.0; 3])).abs() < 1e-14);
        assert!((distance(c, v) - distance(c, [0.0; 3])).abs() < 1e-14);
        assert!(dot(c, cross(u, v)).abs() < 1e-13);
        let c = sphere_center(u, v, w);
        for p in [u, v, w] {
            assert!((distance(c, p) - distance(c, [0.0; 3])).abs() < 1e-14);
        }
    }
}
