//! A piece of a plane curve x(t) = x₀ + vt + Σ (a cos kt + b sin kt), exact in point and normal at every t.

use std::f64::consts::TAU;

/// One frequency of both coordinates: (a, b) of x and of y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wave {
    pub(super) order: i32,
    pub(super) x: [f64; 2],
    pub(super) y: [f64; 2],
}

/// A curve over a range of the parameter.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    center: [f64; 2],
    /// The vector that is added for each unit of t.
    drift: [f64; 2],
    waves: Vec<Wave>,
    range: [f64; 2],
    pub(super) closed: bool,
}

impl Piece {
    /// A closed curve of these frequencies.
    pub(super) fn closed(waves: Vec<Wave>) -> Self {
        Self { center: [0.0; 2], drift: [0.0; 2], waves, range: [0.0, TAU], closed: true }
    }

    /// An ellipse along the axes.
    pub(super) fn ellipse(radii: [f64; 2], center: [f64; 2]) -> Self {
        let wave = Wave { order: 1, x: [radii[0], 0.0], y: [0.0, radii[1]] };
        Self { center, ..Self::closed(vec![wave]) }
    }

    /// r(t) = radius + Σ c cos(mt + φ) in polar coordinates, for terms (m, c, φ).
    pub(super) fn polar(radius: f64, terms: &[(i32, f64, f64)]) -> Self {
        let mut piece = Self::ellipse([radius, radius], [0.0, 0.0]);
        for &(m, c, phase) in terms {
            // cos(mt + φ)·cos t and cos(mt + φ)·sin t are halves of sums of the frequencies m + 1 and m − 1.
            let (sin, cos) = phase.sin_cos();
            let (sin, cos) = (0.5 * c * sin, 0.5 * c * cos);
            piece.waves.push(Wave { order: m + 1, x: [cos, -sin], y: [sin, cos] });
            piece.waves.push(Wave { order: m - 1, x: [cos, -sin], y: [-sin, -cos] });
        }
        piece
    }

    /// A sine wave with ends.
    pub(super) fn wave(width: f64, height: f64, crests: i32) -> Self {
        let wave = Wave { order: crests, x: [0.0; 2], y: [0.0, height] };
        Self { drift: [width / TAU, 0.0], closed: false, ..Self::closed(vec![wave]) }
    }

    /// The arc between two parameters.
    pub(super) fn between(self, from: f64, to: f64) -> Self {
        Self { range: [from, to], closed: false, ..self }
    }

    pub(super) fn at(&self, t: f64) -> [f64; 2] {
        let mut point = [self.center[0] + self.drift[0] * t, self.center[1] + self.drift[1] * t];
        for wave in &self.waves {
            let (sin, cos) = (f64::from(wave.order) * t).sin_cos();
            point[0] += wave.x[0] * cos + wave.x[1] * sin;
            point[1] += wave.y[0] * cos + wave.y[1] * sin;
        }
        point
    }

    /// The unit normal at t, to the left of growing t.
    pub(super) fn normal(&self, t: f64) -> [f64; 2] {
        let mut tangent = self.drift;
        for wave in &self.waves {
            let k = f64::from(wave.order);
            let (sin, cos) = (k * t).sin_cos();
            tangent[0] += k * (wave.x[1] * cos - wave.x[0] * sin);
            tangent[1] += k * (wave.y[1] * cos - wave.y[0] * sin);
        }
        let norm = tangent[0].hypot(tangent[1]);
        [-tangent[1] / norm, tangent[0] / norm]
    }

    /// n + 1 parameters of equal distance along the curve; of an arc n, from end to end.
    pub(super) fn equally_spaced(&self, n: usize) -> Vec<f64> {
        let fine = 4 * n;
        let parameter =
            |k: usize| self.range[0] + (self.range[1] - self.range[0]) * (k as f64 / fine as f64);
        let mut along = Vec::with_capacity(fine + 1);
        let (mut length, mut last) = (0.0, self.at(self.range[0]));
        for k in 0..=fine {
            let next = self.at(parameter(k));
            length += (next[0] - last[0]).hypot(next[1] - last[1]);
            along.push(length);
            last = next;
        }
        let steps = n - usize::from(!self.closed);
        let mut k = 0;
        let spaced = (0..=steps).map(|i| {
            let wanted = length * (i as f64 / steps as f64);
            while k + 1 < fine && along[k + 1] < wanted {
                k += 1;
            }
            let share = ((wanted - along[k]) / (along[k + 1] - along[k])).clamp(0.0, 1.0);
            parameter(k) + share * (parameter(k + 1) - parameter(k))
        });
        spaced.collect()
    }
}
