//! Dihedral angles beside given ones, without a trigonometric function of data.
//!
//! *Idea.* With d along the edge, the angle of two triangles about it is that of d × p and d × q. It is below θ ≤ π/2 if their
//! product is positive and (p·q)² > cos²θ·|p|²|q|², where cos²θ = (1 + cos 2θ)/2 is exactly 1/2 for π/4: on grids, where angles of
//! π/4 abound, the comparison is exact.
//! *Guarantee.* A fixed order of operations in `f64`: the same points give the same answer. Elsewhere the angle is right to a few units
//! in the last place.

use crate::surface::vector::{cross, dot, minus};

/// A bound for angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bound {
    /// cos²θ; none for 0, below which there is no angle.
    square: Option<f64>,
}

impl Bound {
    /// For an angle from 0 to π/2.
    pub(super) fn of(theta: f64) -> Self {
        Self { square: (theta > 0.0).then(|| 0.5 * (1.0 + (2.0 * theta).cos())) }
    }

    /// Tests whether two normals make a smaller angle.
    pub(super) fn exceeds(self, p: [f64; 3], q: [f64; 3]) -> bool {
        let product = dot(p, q);
        self.square.is_some_and(|square| {
            product > 0.0 && product * product > square * (dot(p, p) * dot(q, q))
        })
    }
}

/// The normal of the half-plane of x about the edge from u along d.
pub(super) fn half_plane(u: [f64; 3], d: [f64; 3], x: [f64; 3]) -> [f64; 3] {
    cross(d, minus(x, u))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

    use super::*;

    /// The angle between a half-plane at 0 and one at `at`, both about the last axis.
    fn exceeds(theta: f64, at: [f64; 2]) -> bool {
        let d = [0.0, 0.0, 3.0];
        let [p, q] = [[1.0, 0.0, 0.3], [at[0], at[1], -2.0]].map(|x| half_plane([0.0; 3], d, x));
        Bound::of(theta).exceeds(p, q)
    }

    #[test]
    fn angles_of_grids_are_exact() {
        assert!(!exceeds(FRAC_PI_4, [1.0, 1.0]) && !exceeds(FRAC_PI_4, [7.0, -7.0]));
        assert!(exceeds(FRAC_PI_4, [1.0, 1.0 - 1e-15]));
        assert!(!exceeds(FRAC_PI_2, [0.0, 1.0]) && exceeds(FRAC_PI_2, [1e-9, 1.0]));
        assert!(!exceeds(0.0, [1.0, 0.0]) && !exceeds(FRAC_PI_4, [-1.0, 0.0]));
    }

    #[test]
    fn angles_are_those_of_trigonometry() {
        for degrees in 0..360 {
            let angle = (f64::from(degrees) + 0.5).to_radians();
            let turned = angle.min(2.0 * PI - angle);
            for theta in [PI / 12.0, FRAC_PI_4, 1.0, FRAC_PI_2] {
                assert_eq!(exceeds(theta, [angle.cos(), angle.sin()]), turned < theta);
            }
        }
    }
}
