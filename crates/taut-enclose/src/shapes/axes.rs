//! The axes of items in a common frame, and the unit of that frame.
//!
//! *Idea.* What is asked of an item again and again, its farthest point from a center, is asked along its own axes
//! ([`reach`](super::reach)). These are found once, in O(d³) for each item.

use taut_kernels::Center;
use taut_kernels::vector::{add_scaled, dot};
use taut_points::parallel::IntoParallel;
use taut_points::{exponent_of, two_to};

use super::Shapes;
use super::eigen::eigen;
use super::frame::Framed;
use crate::Error;

/// Squares of half axes, and their directions as rows.
pub(crate) struct Axes {
    pub(crate) squares: Vec<f64>,
    pub(crate) directions: Vec<f64>,
}

impl Axes {
    /// Those of all items of a frame.
    pub(crate) fn of_all(framed: &Framed) -> Vec<Self> {
        (0..framed.len())
            .into_par_iter()
            .with_min_len(32)
            .map(|i| {
                let (squares, directions) = eigen(&mut framed.shape(i).to_vec(), framed.rank);
                Axes { squares, directions }
            })
            .collect()
    }

    /// m − c along each axis.
    pub(crate) fn along(&self, center: &[f64], from: &[f64]) -> Vec<f64> {
        let offset: Vec<f64> = center.iter().zip(from).map(|(m, c)| m - c).collect();
        self.directions.chunks_exact(offset.len()).map(|v| dot(v, &offset)).collect()
    }

    /// Σ βₖvₖ over the axes.
    pub(crate) fn direction(&self, beta: &[f64]) -> Vec<f64> {
        let mut direction = vec![0.0; beta.len()];
        for (&beta, v) in beta.iter().zip(self.directions.chunks_exact(beta.len())) {
            add_scaled(&mut direction, beta, v);
        }
        direction
    }
}

/// An n × n matrix with this value on its diagonal.
pub(crate) fn diagonal(dim: usize, value: f64) -> Vec<f64> {
    (0..dim * dim).map(|at| if at / dim == at % dim { value } else { 0.0 }).collect()
}

/// An origin among the items, and a power of two of about how far they reach.
pub(crate) fn units(shapes: &Shapes) -> Result<(Center, f64), Error> {
    let origin = shapes.center(0).to_vec();
    let mut reach = 0.0f64;
    for i in 0..shapes.len() {
        for (j, (m, o)) in shapes.center(i).iter().zip(&origin).enumerate() {
            reach = reach.max((m - o).abs()).max(shapes.width(i, j));
        }
    }
    if !(reach * (shapes.dim() as f64)).is_finite() {
        return Err(Error::Overflow);
    }
    let scale = if reach == 0.0 { 1.0 } else { power_below(reach) };
    Ok((Center { high: origin, low: vec![] }, scale))
}

/// The power of two of about a size above 0, kept away from the ends of the range.
pub(crate) fn power_below(size: f64) -> f64 {
    two_to(exponent_of(size).clamp(-1000, 1000))
}
