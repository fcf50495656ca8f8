//! Where the data lie in the unit ball that is drawn.
//!
//! *Trap.* Squares of large numbers overflow and those of small ones vanish: all is divided by a power of two first.

use crate::axes::unit;
use crate::{Scene3, Shape3};

/// Where the unit ball of the view lies in the data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stage {
    unit: f64,
    middle: [f64; 3],
    radius: f64,
}

/// All finite marks of a scene as balls.
pub(super) fn balls(scene: &Scene3) -> Vec<([f64; 3], f64)> {
    let mut balls: Vec<([f64; 3], f64)> = Vec::new();
    for layer in &scene.layers {
        match &layer.shape {
            Shape3::Points(points) => balls.extend(points.iter().map(|p| (p.at, 0.0))),
            Shape3::Crosses(places) => balls.extend(places.iter().map(|&p| (p, 0.0))),
            Shape3::Spheres(spheres) => balls.extend(spheres.iter().map(|s| (s.center, s.radius))),
            Shape3::Polylines(chains) => balls.extend(chains.iter().flatten().map(|&p| (p, 0.0))),
            Shape3::Mesh(mesh) => balls.extend(mesh.vertices.iter().map(|&p| (p, 0.0))),
            Shape3::Surface(surface) => {
                balls.extend(surface.vertices.iter().map(|&p| (p, 0.0)));
            }
        }
    }
    balls.retain(|(p, r)| finite(p) && r.is_finite() && *r >= 0.0);
    balls
}

/// The ball that holds all finite marks of a scene: the box around them decides its middle.
pub(crate) fn stage(scene: &Scene3) -> Stage {
    let balls = balls(scene);
    let unit = unit(balls.iter().flat_map(|(p, r)| [p[0], p[1], p[2], *r]));
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for (p, r) in &balls {
        for k in 0..3 {
            low[k] = low[k].min(p[k] / unit - r / unit);
            high[k] = high[k].max(p[k] / unit + r / unit);
        }
    }
    if balls.is_empty() {
        (low, high) = ([-1.0; 3], [1.0; 3]);
    }
    let middle = [0, 1, 2].map(|k| low[k] + (high[k] - low[k]) / 2.0);
    let reach = |(p, r): &([f64; 3], f64)| {
        let square: f64 = (0..3).map(|k| (p[k] / unit - middle[k]).powi(2)).sum();
        square.sqrt() + r / unit
    };
    let radius = balls.iter().map(reach).fold(0.0, f64::max);
    Stage { unit, middle, radius: if radius > 0.0 { radius } else { 1.0 } }
}

impl Stage {
    /// A place in the unit ball.
    pub(crate) fn place(&self, p: &[f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| (p[k] / self.unit - self.middle[k]) / self.radius)
    }

    /// For each coordinate the place of 0 and the length of 1; zeros where these are no numbers.
    pub(crate) fn map(&self) -> [[f64; 2]; 3] {
        self.middle.map(|middle| {
            let map = [-middle / self.radius, 1.0 / self.unit / self.radius];
            if map.iter().all(|x| x.is_finite()) { map } else { [0.0; 2] }
        })
    }

    /// A length in the unit ball.
    pub(crate) fn length(&self, r: f64) -> f64 {
        r / self.unit / self.radius
    }
}

pub(crate) fn finite(p: &[f64; 3]) -> bool {
    p.iter().all(|v| v.is_finite())
}
