//! A local optimum, by linear programs in a region of trust.
//!
//! *Idea.* The size of the ellipse of a shape and a center is the least distance of an edge. Its linear model over small changes
//! of both has the best step of [`weights`]; a step that does not hold what it promises shrinks the region.

use super::shape::{Nearest, Shape};
use super::weights::{self, Column};
use crate::polygon::Segment;

/// Steps of one climb.
const STEPS_MAX: usize = 60;

/// Half the change of the shape, and of the center in sizes, in the first step and at most: no step leads over an edge.
const TRUST: (f64, f64) = (0.1, 0.4);

/// Promised gain, relative to the size, and region of trust below which a climb ends.
const GAIN_MIN: f64 = 1e-11;

/// How many times as far as the nearest edge others are looked at, and how far a climb goes before it looks again.
const NEAR_SIZES: f64 = 3.0;

/// Climbs, each with the edges that are near then.
const CLIMBS_MAX: usize = 20;

/// Points of an ellipse that tell how far it reaches.
const BORDER_POINTS: usize = 16;

/// An ellipse in units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ellipse {
    pub(super) shape: Shape,
    pub(super) center: [f64; 2],
    pub(super) size: f64,
}

impl Ellipse {
    /// The largest ellipse of a shape and center.
    pub(super) fn of(shape: Shape, center: [f64; 2], edges: &[Segment]) -> Self {
        let length = |&edge: &Segment| shape.nearest(center, edge).length;
        let size = edges.iter().map(length).fold(f64::INFINITY, f64::min);
        Ellipse { shape, center, size }
    }

    /// Returns a local optimum, or an ellipse near one.
    pub(super) fn climbed(self, edges: &[Segment]) -> Self {
        let mut best = self;
        for _ in 0..CLIMBS_MAX {
            let far = NEAR_SIZES * best.size;
            let is_near = |&&edge: &&Segment| best.shape.nearest(best.center, edge).length <= far;
            let near: Vec<Segment> = edges.iter().filter(is_near).copied().collect();
            let next = best.climbed_among(&near, far);
            let next = Ellipse::of(next.shape, next.center, edges);
            if next.size <= best.size * (1.0 + GAIN_MIN) {
                return if next.size > best.size { next } else { best };
            }
            best = next;
        }
        best
    }

    /// Climbs by edges that are nearer than `far` in the norm of the start, and no farther than that.
    fn climbed_among(self, near: &[Segment], far: f64) -> Self {
        let (mut best, mut trust) = (self, TRUST.0);
        for _ in 0..STEPS_MAX {
            let column = |&edge: &Segment| {
                let nearest = best.shape.nearest(best.center, edge);
                let [s, t, x, y] = gradient(&nearest);
                let gradient = [s, t, best.size * x, best.size * y].map(|g| trust * g);
                Column { distance: nearest.length, gradient }
            };
            // Distances change by at most about four times the region of trust.
            let farthest = best.size * (1.0 + 5.0 * trust);
            let columns: Vec<Column> =
                near.iter().map(column).filter(|column| column.distance <= farthest).collect();
            let found = weights::best(&columns);
            if found.value <= best.size * (1.0 + GAIN_MIN) {
                break;
            }
            let [s, t, x, y] = found.step.map(|step| trust * step);
            let shape = Shape::new(best.shape.s + s * best.shape.t, best.shape.t * t.exp());
            let [dx, dy] = best.shape.inverse([best.size * x, best.size * y]);
            let center = [best.center[0] + dx, best.center[1] + dy];
            let next = Ellipse::of(shape, center, near);
            let promised = found.value - best.size;
            let held = next.size - best.size;
            if held > 0.7 * promised {
                trust = (2.0 * trust).min(TRUST.1);
            } else if held < 0.3 * promised {
                trust *= 0.35;
            }
            if held > 0.0 {
                if !next.is_within(&self, far) {
                    break;
                }
                best = next;
            }
            if trust < GAIN_MIN {
                break;
            }
        }
        best
    }
}

impl Ellipse {
    /// Whether the ellipse stays nearer than `far` to the center of another one, in its norm.
    fn is_within(&self, other: &Ellipse, far: f64) -> bool {
        (0..BORDER_POINTS).all(|i| {
            let (sine, cosine) =
                (std::f64::consts::TAU * i as f64 / BORDER_POINTS as f64).sin_cos();
            let w = self.shape.inverse([self.size * cosine, self.size * sine]);
            let way = [0, 1].map(|k| self.center[k] + w[k] - other.center[k]);
            other.shape.square(way) <= far * far
        })
    }
}

/// How a distance changes with s/t, with ln t, and with the two coordinates of the image of the center.
pub(super) fn gradient(nearest: &Nearest) -> [f64; 4] {
    let length = nearest.length;
    if length == 0.0 {
        return [0.0; 4];
    }
    let n = nearest.image.map(|x| x / length);
    [length * n[0] * n[1], 0.5 * length * (n[0] * n[0] - n[1] * n[1]), -n[0], -n[1]]
}
