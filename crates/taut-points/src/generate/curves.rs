//! Curves of the plane whose truth is known, and samples of them with and without noise.
//!
//! *Problem.* What a reconstruction is worth shows only beside the curve that was sampled, its local feature size f(x) (the
//! distance of x from the medial axis) and samples whose density and noise follow a stated law.
//! *Idea.* Every curve is a Fourier curve or an arc of one: points and normals are exact at any parameter. It is scaled so that
//! the least f is 1, so that lengths mean the same on all of them.
//! *Guarantee.* The vertices kept as truth lie on the curve, equally spaced along it; f is from a fine sample of the medial axis,
//! as accurate as their spacing. A sample depends on the curve, n, the noise and the seed alone, not on threads.
//! *Reference.* Section 4.1 of the thesis: density 1 / (L·f) with L = ∫ 1/f, then a shift along the normal by at most δ.

mod feature;
mod fourier;
mod random;
mod sample;
mod source;

use feature::features_of;
use fourier::{Piece, Wave};

pub use sample::{CurveNoise, CurveSample, EpsilonSample, epsilon_sample, sample_curve};
pub use source::CurveSource;

/// A set of curves given by formulas, before it is measured and scaled by [`build`](Self::build).
#[derive(Clone, Debug, PartialEq)]
pub struct TestCurve {
    pieces: Vec<Piece>,
}

/// Curves with what is known about them, scaled so that the least local feature size is 1.
#[derive(Clone, Debug, PartialEq)]
pub struct TruthCurves {
    /// The curves, each as points on it, equally spaced along it; of an arc both ends are among them.
    pub loops: Vec<Vec<[f64; 2]>>,
    /// States whether each curve closes: an edge leads from its last point to its first.
    pub closed: Vec<bool>,
    /// The local feature size at each of these points.
    pub features: Vec<Vec<f64>>,
    /// L = ∫ 1/f along all curves: n = c·L samples have a spacing of f/c.
    pub length_over_feature: f64,
    /// The largest local feature size.
    pub feature_max: f64,
    /// The formulas, unscaled.
    pieces: Vec<Piece>,
    /// The parameter of each point; of a closed curve the last is that of the first, one period later.
    parameters: Vec<Vec<f64>>,
    /// The factor that the formulas are multiplied by.
    scale: f64,
}

impl TestCurve {
    /// Points kept of each curve by [`build`](Self::build).
    pub const VERTICES: usize = 10_000;

    /// All names with what they stand for.
    pub const NAMES: [(&'static str, &'static str); 8] = [
        ("circle", "a circle"),
        ("ellipse3", "an ellipse three times as long as wide"),
        ("flower5", "five round petals"),
        ("bumpy", "a blob with bumps of three sizes"),
        ("gear20", "a ring with twenty shallow teeth"),
        ("multi4", "four curves, nested and side by side"),
        ("arc", "three quarters of a circle"),
        ("wave", "an open wave of four crests"),
    ];

    /// The curve with a name of [`NAMES`](Self::NAMES).
    pub fn named(name: &str) -> Option<Self> {
        let pieces = match name {
            "circle" => vec![Piece::ellipse([1.0, 1.0], [0.0, 0.0])],
            "ellipse3" => vec![Piece::ellipse([3.0, 1.0], [0.0, 0.0])],
            "flower5" => vec![Piece::polar(1.0, &[(5, 0.3, 0.0)])],
            "bumpy" => vec![Piece::polar(1.0, &[(3, 0.2, 0.0), (7, 0.1, 1.0), (12, 0.05, 2.0)])],
            "gear20" => vec![Piece::polar(3.0, &[(20, 0.25, 0.0)])],
            "multi4" => vec![
                Piece::ellipse([3.0, 3.0], [0.0, 0.0]),
                Piece::ellipse([2.0, 1.8], [0.0, 0.0]),
                Piece::ellipse([0.8, 0.5], [-0.9, 0.0]),
                Piece::ellipse([0.5, 0.8], [0.9, 0.0]),
            ],
            "arc" => {
                vec![
                    Piece::ellipse([1.0, 1.0], [0.0, 0.0]).between(0.0, 1.5 * std::f64::consts::PI),
                ]
            }
            "wave" => vec![Piece::wave(8.0, 1.0, 4)],
            _ => return None,
        };
        Some(Self { pieces })
    }

    /// Points on each curve, and the parameters they have.
    fn points(&self, vertices: usize) -> (Vec<Vec<[f64; 2]>>, Vec<Vec<f64>>) {
        let parameters: Vec<Vec<f64>> =
            self.pieces.iter().map(|piece| piece.equally_spaced(vertices)).collect();
        let points = self.pieces.iter().zip(&parameters).map(|(piece, parameters)| {
            parameters[..vertices].iter().map(|&t| piece.at(t)).collect()
        });
        (points.collect(), parameters)
    }

    /// Measures the curves and scales them.
    pub fn build(&self) -> TruthCurves {
        self.build_with(Self::VERTICES)
    }

    /// The same with another number of points on each curve (at least 16), for many curves in little time.
    pub fn build_with(&self, vertices: usize) -> TruthCurves {
        let vertices = vertices.max(16);
        let (mut loops, parameters) = self.points(vertices);
        let mut features = features_of(&self.pieces, &loops, &parameters);
        let smallest = features.iter().flatten().fold(f64::INFINITY, |a, &b| a.min(b));
        let scale = 1.0 / smallest;
        loops.iter_mut().flatten().flatten().for_each(|v| *v *= scale);
        features.iter_mut().flatten().for_each(|f| *f *= scale);
        let mut truth = TruthCurves {
            loops,
            closed: self.pieces.iter().map(|piece| piece.closed).collect(),
            feature_max: features.iter().flatten().fold(0.0, |a, &b| a.max(b)),
            features,
            length_over_feature: 0.0,
            pieces: self.pieces.clone(),
            parameters,
            scale,
        };
        truth.length_over_feature = truth.edges(false).map(|(_, _, weight)| weight).sum();
        truth
    }
}

impl TruthCurves {
    /// The edges between neighboring points: curve, number of the first point, and length, divided by f unless `plain`.
    fn edges(&self, plain: bool) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        self.loops.iter().enumerate().flat_map(move |(curve, points)| {
            let (n, features) = (points.len(), &self.features[curve]);
            (0..n - usize::from(!self.closed[curve])).map(move |i| {
                let (a, b) = (points[i], points[(i + 1) % n]);
                let length = (b[0] - a[0]).hypot(b[1] - a[1]);
                let feature = 0.5 * (features[i] + features[(i + 1) % n]);
                (curve, i, if plain { length } else { length / feature })
            })
        })
    }

    /// Length of all curves together.
    pub fn length(&self) -> f64 {
        self.edges(true).map(|(_, _, length)| length).sum()
    }

    /// The point of a curve with the share `u` of the edge after its point `i`, on the curve itself, and the unit normal there.
    fn on_curve(&self, curve: usize, i: usize, u: f64) -> ([f64; 2], [f64; 2]) {
        let t = &self.parameters[curve];
        let t = t[i] + u * (t[i + 1] - t[i]);
        let piece = &self.pieces[curve];
        (piece.at(t).map(|v| v * self.scale), piece.normal(t))
    }
}

#[cfg(test)]
mod tests;
