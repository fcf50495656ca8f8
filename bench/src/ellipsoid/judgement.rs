//! The ellipsoid of a peer as a user would use it: what lies outside, and whether its volume is the least.

use super::*;
use crate::judge;

/// What was found about the ellipsoid of a peer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Judgement {
    /// Points that lie outside, by how much the norm exceeds 1 at the worst of them, and how far the logarithm of the volume
    /// lies from the bracket that was proved.
    pub(super) found: judge::Judgement,
    /// The logarithm of its volume.
    pub(super) log_volume: f64,
}

impl Judgement {
    /// Judges {x : (x − c)'Q(x − c) ≤ 1} in dimension d; `numbers` are c, then Q by rows.
    pub(super) fn of(
        values: &[f64],
        d: usize,
        numbers: &[f64],
        bracket: Option<&EllipsoidVerdict>,
    ) -> Judgement {
        if numbers.len() != d * (d + 1) {
            let found = judge::Judgement { outside: 0, excess: f64::NAN, off: f64::NAN };
            return Judgement { found, log_volume: f64::NAN };
        }
        let (center, matrix) = numbers.split_at(d);
        let (mut outside, mut worst) = (0, f64::NEG_INFINITY);
        let mut offset = vec![0.0; d];
        for row in values.chunks_exact(d) {
            offset.iter_mut().zip(row).zip(center).for_each(|((o, x), c)| *o = x - c);
            let images = matrix.chunks_exact(d).map(|q| product(q, &offset));
            let norm = images.zip(&offset).map(|(image, o)| image * o).sum::<f64>().sqrt();
            // NaN is inside nothing.
            let inside = norm <= 1.0 + judge::ROUNDING;
            outside += u64::from(!inside);
            worst = if norm.is_nan() { f64::INFINITY } else { worst.max(norm) };
        }
        let mut lower = matrix.to_vec();
        let log_det = linear::cholesky(&mut lower, d);
        let log_volume = linear::log_unit_ball(d) - 0.5 * log_det.unwrap_or(f64::NAN);
        let off = bracket.map_or(f64::NAN, |bracket| match log_volume {
            volume if volume < bracket.lower => volume - bracket.lower,
            volume if volume > bracket.upper => volume - bracket.upper,
            volume if volume.is_nan() => f64::NAN,
            _ => 0.0,
        });
        let found = judge::Judgement { outside, excess: worst - 1.0, off };
        Judgement { found, log_volume }
    }
}

impl std::fmt::Display for Judgement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.found.describe("log-volume"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_outside_and_wrong_areas_are_seen() {
        let unit = EllipsoidVerdict {
            lower: std::f64::consts::PI.ln() - 1e-15,
            upper: std::f64::consts::PI.ln() + 1e-15,
            gap: 2e-15,
            excess: 0.0,
            matrix_excess: 0.0,
            off_hull: 0.0,
            rank: 2,
        };
        let values = [1.0, 0.0, -1.0, 0.0, 0.0, 1.0];
        let of = |numbers: &[f64]| Judgement::of(&values, 2, numbers, Some(&unit));
        let right = of(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]);
        assert_eq!((right.found.outside, right.found.excess, right.found.off), (0, 0.0, 0.0));
        assert_eq!(right.to_string(), "encloses (0.0e0), log-volume in our bracket");
        let shifted = of(&[0.5, 0.0, 1.0, 0.0, 0.0, 1.0]);
        assert_eq!((shifted.found.outside, shifted.found.off), (2, 0.0));
        assert!(shifted.to_string().starts_with("WRONG: 2 outside by up to 5.0e-1"));
        assert!(of(&[0.0, 0.0, 0.5, 0.0, 0.0, 0.5]).to_string().starts_with("WRONG: encloses"));
        let nan = of(&[f64::NAN, 0.0, 1.0, 0.0, 0.0, 1.0]);
        assert!(nan.found.outside == 3 && nan.to_string().starts_with("WRONG"));
        assert!(of(&[0.0]).to_string().starts_with("WRONG"));
    }
}
