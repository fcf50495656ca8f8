//! Conics x'Qx + R'x + f = 0, and the ellipses among them.
//!
//! *Corrections* to section 8.4 of the thesis. The center solves 2Qx = −R. With μ = R'Q⁻¹R/4 − f the area is π·μ/√det Q; μ is not the
//! same for all conics through some points, so that det Q alone is no measure of the area. The least semi-axis is √(μ/λ), λ being the
//! larger eigenvalue of Q.

use super::super::shape::Shape;

/// x'Qx + R'x + f, which is below 0 inside of an ellipse.
#[derive(Clone, Copy, Debug)]
pub(super) struct Conic {
    /// q₁₁, q₁₂ and q₂₂.
    pub(super) q: [f64; 3],
    pub(super) r: [f64; 2],
    pub(super) f: f64,
}

/// The ellipse of a conic.
#[derive(Clone, Copy, Debug)]
pub(super) struct Real {
    pub(super) center: [f64; 2],
    pub(super) shape: Shape,
    /// The area over π.
    pub(super) square_of_size: f64,
    /// The least semi-axis.
    pub(super) least_axis: f64,
}

impl Conic {
    /// The gradient, which points out of an ellipse.
    pub(super) fn gradient(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [a, b, c] = self.q;
        [2.0 * (a * x + b * y) + self.r[0], 2.0 * (b * x + c * y) + self.r[1]]
    }

    /// A sum with two weights.
    pub(super) fn mixed(&self, weight: f64, other: &Conic, of_other: f64) -> Conic {
        let sum = |one: f64, two: f64| weight * one + of_other * two;
        Conic {
            q: std::array::from_fn(|k| sum(self.q[k], other.q[k])),
            r: std::array::from_fn(|k| sum(self.r[k], other.r[k])),
            f: sum(self.f, other.f),
        }
    }

    /// The same conic with 1 as its largest coefficient in size.
    pub(super) fn normalized(&self) -> Conic {
        let all = self.q.iter().chain(&self.r).chain([&self.f]);
        let largest = all.fold(0.0f64, |most, x| most.max(x.abs()));
        if largest > 0.0 { self.mixed(1.0 / largest, self, 0.0) } else { *self }
    }

    /// The ellipse, if the conic is one and is below 0 inside.
    pub(super) fn ellipse(&self) -> Option<Real> {
        let ([a, b, c], [r, s]) = (self.q, self.r);
        let determinant = a * c - b * b;
        if !(a > 0.0 && determinant > 0.0) {
            return None;
        }
        let center = [-(c * r - b * s), -(a * s - b * r)].map(|x| 0.5 * x / determinant);
        let mu = -0.5 * (r * center[0] + s * center[1]) - self.f;
        let root = determinant.sqrt();
        let larger = 0.5 * (a + c + (a - c).hypot(2.0 * b));
        let found = Real {
            center,
            shape: Shape::new(b / c, root / c),
            square_of_size: mu / root,
            least_axis: (mu / larger).sqrt(),
        };
        (mu > 0.0 && found.square_of_size.is_finite()).then_some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_ellipse_has_its_center_area_and_shape() {
        // Semi-axes 3 and ½, turned by 0.4, around (5, −2).
        let (sine, cosine) = 0.4f64.sin_cos();
        let (u, v) = (1.0 / 9.0, 4.0);
        let q = [
            u * cosine * cosine + v * sine * sine,
            (u - v) * sine * cosine,
            u * sine * sine + v * cosine * cosine,
        ];
        let c = [5.0, -2.0];
        let qc = [q[0] * c[0] + q[1] * c[1], q[1] * c[0] + q[2] * c[1]];
        let f = c[0] * qc[0] + c[1] * qc[1] - 1.0;
        let conic = Conic { q, r: qc.map(|x| -2.0 * x), f };
        let scaled = conic.mixed(7.0, &conic, 1.0);
        for conic in [conic, scaled] {
            let found = conic.ellipse().unwrap();
            assert!((0..2).all(|k| (found.center[k] - c[k]).abs() < 1e-12), "{found:?}");
            assert!((found.square_of_size - 1.5).abs() < 1e-12, "{found:?}");
            assert!((found.least_axis - 0.5).abs() < 1e-12, "{found:?}");
            // The end of the longer axis has the size as its norm.
            let end = found.shape.square([3.0 * cosine, 3.0 * sine]);
            assert!((end - 1.5).abs() < 1e-12, "{end}");
            let outward = conic.gradient([c[0] + 3.0 * cosine, c[1] + 3.0 * sine]);
            assert!(outward[0] * cosine + outward[1] * sine > 0.0);
        }
        assert!(Conic { f: f + 2.0, ..conic }.ellipse().is_none());
        assert!(Conic { q: [1.0, 2.0, 1.0], ..conic }.ellipse().is_none());
    }
}
