//! Random smooth closed curves that do not meet themselves.
//!
//! *Idea.* A circle and 3 to 8 harmonics whose size falls with their order; what crosses itself, or comes so near to it or to a cusp
//! that its least feature is lost in its length, is drawn again.
//! *Guarantee.* The length is at most 200 least features: a few thousand points resolve all of them, and L = ∫ 1/f is less than that.

use std::f64::consts::TAU;

use rand::RngExt;

use super::super::draw::{normal, stream};
use super::{Piece, TestCurve, Wave};

/// A draw is judged by this many points.
const JUDGED_POINTS: usize = 1024;
/// A draw is kept up to this length.
const LENGTH_MAX: f64 = 200.0;

impl TestCurve {
    /// A random smooth closed curve: the same one for the same seed.
    ///
    /// ```
    /// use taut_points::generate::curves::{TestCurve, epsilon_sample};
    /// let truth = TestCurve::random(1).build_with(2000);
    /// let sample = epsilon_sample(&truth, 0.3, 1);
    /// assert_eq!(sample.points.len(), 2 * sample.edges.len());
    /// ```
    pub fn random(seed: u64) -> Self {
        let mut random = stream(seed, 0);
        loop {
            let harmonics: i32 = random.random_range(3..=8);
            let size = 0.8 * random.random::<f64>();
            let mut waves = vec![Wave { order: 1, x: [1.0, 0.0], y: [0.0, 1.0] }];
            for order in 1..=harmonics {
                let scale = size / f64::from(order).powf(1.5);
                let mut draw = || -> f64 { scale * normal(&mut random) };
                waves.push(Wave { order, x: [draw(), draw()], y: [draw(), draw()] });
            }
            let curve = Self { pieces: vec![Piece::closed(waves)] };
            if !crosses_itself(&curve.pieces[0])
                && curve.build_with(JUDGED_POINTS).length() <= LENGTH_MAX
            {
                return curve;
            }
        }
    }
}

/// Returns true if a polygon of few vertices on the curve does.
fn crosses_itself(piece: &Piece) -> bool {
    const N: usize = 256;
    let points: Vec<[f64; 2]> = (0..N).map(|k| piece.at(TAU * k as f64 / N as f64)).collect();
    let side = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0.0
    };
    (0..N).any(|i| {
        let (a, b) = (points[i], points[(i + 1) % N]);
        (i + 2..N).any(|j| {
            let (c, d) = (points[j], points[(j + 1) % N]);
            (j + 1) % N != i && side(a, b, c) != side(a, b, d) && side(c, d, a) != side(c, d, b)
        })
    })
}
