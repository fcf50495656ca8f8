//! Circles that are tangent to a curve at a point, and what they meet.

use super::tree::Area;

/// R is told up to this much of it: on a circle all points are as near as each other, and to find the nearest would take all.
const RADIUS_TOLERANCE: f64 = 1.0 / 64.0;

/// Circles that are tangent at a point.
#[derive(Clone, Copy)]
pub(super) struct Tangent {
    pub(super) v: [f64; 2],
    /// Of length 1.
    pub(super) normal: [f64; 2],
    /// τ.
    pub(super) forgiven: f64,
}

impl Tangent {
    /// The radius of the circle through v + w.
    pub(super) fn through(&self, w: [f64; 2]) -> f64 {
        let room = dot(self.normal, w).abs() - self.forgiven;
        if room > 0.0 { dot(w, w) / (2.0 * room) } else { f64::INFINITY }
    }

    /// Whether circles of a radius surely miss an edge: where the power |w|² − 2r(|n·w| − τ) of both ends is above g²/4 for an edge of
    /// length g, that of the point next to the center is above 0.
    pub(super) fn misses(&self, [a, b]: [[f64; 2]; 2], radius: f64) -> bool {
        let (e, quarter) = (minus(b, a), 0.25 * (1.0 + 1e-9));
        let power =
            |w: [f64; 2]| dot(w, w) - 2.0 * radius * (dot(self.normal, w).abs() - self.forgiven);
        power(minus(a, self.v)).min(power(minus(b, self.v))) > quarter * dot(e, e)
    }

    /// No circle through a point of a box has a smaller radius, by more than a little.
    pub(super) fn least(&self, area: &Area) -> f64 {
        let near = area.distance_squared(self.v);
        let center = [0, 1].map(|k| (area.least[k] + area.most[k]) / 2.0 - self.v[k]);
        let reach: f64 =
            (0..2).map(|k| (area.most[k] - area.least[k]) / 2.0 * self.normal[k].abs()).sum();
        let room = dot(self.normal, center).abs() + reach - self.forgiven;
        // An empty box gives NaN, and is as good as none.
        if room > 0.0 { near / (2.0 * room) * (1.0 + RADIUS_TOLERANCE) } else { f64::INFINITY }
    }

    /// The least radius of a circle through a point of an edge.
    ///
    /// With w = p + u·e and room r₀ + r₁u on one side, |w|²/(r₀ + r₁u) is least at an end or where
    /// e²r₁u² + 2e²r₀u + 2(p·e)r₀ − p²r₁ = 0.
    pub(super) fn through_edge(&self, [a, b]: [[f64; 2]; 2]) -> f64 {
        let (p, e) = (minus(a, self.v), minus(b, a));
        let (pp, pe, ee) = (dot(p, p), dot(p, e), dot(e, e));
        let mut radius = self.through(p).min(self.through([p[0] + e[0], p[1] + e[1]]));
        for side in [1.0, -1.0] {
            let r0 = side * dot(self.normal, p) - self.forgiven;
            let r1 = side * dot(self.normal, e);
            if r0.max(r0 + r1) <= 0.0 {
                continue;
            }
            let (q0, q1, q2) = (2.0 * pe * r0 - pp * r1, ee * r0, ee * r1);
            let root = (q1 * q1 - q2 * q0).max(0.0).sqrt();
            // The roots of q2·u² + 2·q1·u + q0, without cancellation.
            let sum = -(q1 + root.copysign(q1));
            for u in [sum / q2, q0 / sum] {
                if u > 0.0 && u < 1.0 {
                    radius = radius.min(self.through([p[0] + u * e[0], p[1] + u * e[1]]));
                }
            }
        }
        radius
    }
}

pub(super) fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}
