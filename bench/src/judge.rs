//! Every answer is judged before its time is believed.
//!
//! *Ours* by `taut-certify`, which proves a bracket [lower, upper] that holds the smallest radius. *A peer's* by
//! measuring how far the input reaches out of its ball, and whether its radius lies in the bracket. A ball that
//! leaves a point outside is no enclosing ball, however small its time.

use anyhow::Result;
use serde::Serialize;
use taut_certify::{Items, Verdict};
use taut_points::{Monitor, PointSource, ReadError, map_blocks};

/// Relative deviation that rounding in the peer's last steps explains.
pub(crate) const ROUNDING: f64 = 1e-12;
/// A result is called wrong beyond this relative deviation: the tenth digit.
const DEVIATION_MAX: f64 = 1e-10;

/// What was found about a peer's ball.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(crate) struct Judgement {
    /// Items that reach out of the ball by more than rounding.
    pub(crate) outside: u64,
    /// How far the worst reaches out, in radii; negative when all keep off the boundary.
    pub(crate) excess: f64,
    /// How far the radius lies below (negative) or above the certified bracket, in radii; 0 inside.
    pub(crate) off: f64,
}

impl Judgement {
    /// Whether the ball leaves something outside or is not the smallest, by more than the tenth digit.
    pub(crate) fn is_wrong(&self) -> bool {
        !self.is_within(DEVIATION_MAX)
    }

    /// Whether the ball encloses everything and is the smallest, to rounding.
    pub(crate) fn is_right(&self) -> bool {
        self.is_within(ROUNDING)
    }

    /// What was found, in words; `off` is about this quantity.
    pub(crate) fn describe(&self, quantity: &str) -> String {
        let Judgement { outside, excess, off } = self;
        let word = match (self.is_wrong(), self.is_right()) {
            (true, _) => "WRONG: ",
            (_, false) => "INEXACT: ",
            _ => "",
        };
        let encloses = match outside {
            0 => format!("encloses ({excess:.1e})"),
            n => format!("{n} outside by up to {excess:.1e}"),
        };
        match off.abs() <= ROUNDING {
            true => format!("{word}{encloses}, {quantity} in our bracket"),
            false => format!("{word}{encloses}, {quantity} {off:+.1e} off our bracket"),
        }
    }

    fn is_within(&self, tolerance: f64) -> bool {
        // NaN is within nothing.
        self.excess <= tolerance && self.off.abs() <= tolerance
    }
}

impl std::fmt::Display for Judgement {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.describe("radius"))
    }
}

/// Judges the ball of a peer against the input, points or balls, and the bracket that was proved for it.
pub(crate) fn judge(
    source: &dyn PointSource,
    items: Items,
    center: &[f64],
    radius: f64,
    bracket: &Verdict,
) -> Result<Judgement, ReadError> {
    let reaches = map_blocks(source, &Monitor::silent(), |_, rows| {
        let mut row = vec![0.0; source.dim()];
        let (mut reach, mut outside) = (f64::NEG_INFINITY, 0u64);
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            let distance =
                row.iter().zip(center).map(|(x, c)| (x - c) * (x - c)).sum::<f64>().sqrt();
            let this = distance + if items == Items::Balls { row[center.len()] } else { 0.0 };
            // A NaN of the peer, in center or radius, must be lost neither in a comparison nor in a maximum.
            let inside = this <= radius * (1.0 + ROUNDING);
            outside += u64::from(!inside);
            reach = if this.is_nan() { f64::INFINITY } else { reach.max(this) };
        }
        Ok::<_, ReadError>((reach, outside))
    })?;
    let (reach, outside) =
        reaches.into_iter().fold((f64::NEG_INFINITY, 0), |a, b| (a.0.max(b.0), a.1 + b.1));
    let excess = if radius > 0.0 { reach / radius - 1.0 } else { reach };
    let off = match radius {
        r if r < bracket.lower => r / bracket.lower - 1.0,
        r if r > bracket.upper => r / bracket.upper - 1.0,
        r if r.is_nan() => f64::NAN,
        _ => 0.0,
    };
    Ok(Judgement { outside, excess, off })
}

#[cfg(test)]
mod tests {
    use super::*;
    use taut_points::Points;

    const BRACKET: Verdict = Verdict { lower: 1.0, upper: 1.0, gap: 0.0 };

    fn of(center: &[f64], radius: f64) -> Judgement {
        let points = Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2).unwrap();
        judge(&points, Items::Points, center, radius, &BRACKET).unwrap()
    }

    #[test]
    fn a_right_answer_is_right() {
        let right = of(&[1.0, 0.0], 1.0);
        assert_eq!((right.outside, right.excess, right.off), (0, 0.0, 0.0));
        assert!(!right.is_wrong() && right.is_right());
        let inexact = of(&[1.0, 0.0], 1.0 - 1e-11);
        assert!(!inexact.is_wrong() && !inexact.is_right());
    }

    #[test]
    fn too_small_shifted_too_large_and_nan_are_wrong() {
        let small = of(&[1.0, 0.0], 0.999);
        assert!(small.is_wrong() && small.outside == 3 && small.off < 0.0);
        let shifted = of(&[1.0, 1e-3], 1.0);
        assert!(shifted.is_wrong() && shifted.outside == 2 && shifted.off == 0.0);
        let large = of(&[1.0, 0.0], 1.001);
        assert!(large.is_wrong() && large.outside == 0 && large.off > 0.0);
        assert!(of(&[1.0, 0.0], f64::NAN).is_wrong());
        assert!(of(&[f64::NAN, 0.0], 1.0).is_wrong());
    }

    #[test]
    fn balls_reach_further_than_their_centers() {
        let balls = Points::new(&[0.0, 0.5, 2.0, 0.5], 2).unwrap();
        let bracket = Verdict { lower: 1.5, upper: 1.5, gap: 0.0 };
        assert!(!judge(&balls, Items::Balls, &[1.0], 1.5, &bracket).unwrap().is_wrong());
        assert!(judge(&balls, Items::Balls, &[1.0], 1.0, &bracket).unwrap().is_wrong());
    }
}
