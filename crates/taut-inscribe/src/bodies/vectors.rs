//! Vectors of space in plain arithmetic.

pub(super) fn dot(p: [f64; 3], q: [f64; 3]) -> f64 {
    p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
}

pub(super) fn cross(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
}

pub(super) fn minus(p: [f64; 3], q: [f64; 3]) -> [f64; 3] {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

/// p + t·q.
pub(super) fn plus(p: [f64; 3], t: f64, q: [f64; 3]) -> [f64; 3] {
    [p[0] + t * q[0], p[1] + t * q[1], p[2] + t * q[2]]
}

/// The point of a triangle that is nearest to the origin.
pub(super) fn nearest([a, b, c]: [[f64; 3]; 3]) -> [f64; 3] {
    // Above the triangle the plane is nearest, else an edge.
    let (u, v) = (minus(b, a), minus(c, a));
    let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
    let (au, av) = (-dot(a, u), -dot(a, v));
    let area = uu * vv - uv * uv;
    let (s, t) = (vv * au - uv * av, uu * av - uv * au);
    if area > 0.0 && s >= 0.0 && t >= 0.0 && s + t <= area {
        return plus(plus(a, s / area, u), t / area, v);
    }
    let on_edge = |[a, b]: [[f64; 3]; 2]| {
        let e = minus(b, a);
        let share = -dot(a, e) / dot(e, e);
        plus(a, if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }, e)
    };
    let mut best = on_edge([a, b]);
    for edge in [[b, c], [c, a]] {
        let found = on_edge(edge);
        if dot(found, found) < dot(best, best) {
            best = found;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_is_in_the_face_on_an_edge_or_a_corner() {
        let face = [[-1.0, -1.0, 2.0], [3.0, -1.0, 2.0], [-1.0, 3.0, 2.0]];
        assert_eq!(nearest(face), [0.0, 0.0, 2.0]);
        let moved = |by: [f64; 3]| face.map(|p| plus(p, 1.0, by));
        assert_eq!(nearest(moved([2.0, 0.0, 0.0])), [1.0, 0.0, 2.0]);
        assert_eq!(nearest(moved([2.0, 2.0, 0.0])), [1.0, 1.0, 2.0]);
        // A triangle without area is a segment or a point.
        assert_eq!(nearest([[1.0, 5.0, 0.0], [1.0, -5.0, 0.0], [1.0, 1.0, 0.0]]), [1.0, 0.0, 0.0]);
        assert_eq!(nearest([[1.0, 2.0, 3.0]; 3]), [1.0, 2.0, 3.0]);
    }
}
