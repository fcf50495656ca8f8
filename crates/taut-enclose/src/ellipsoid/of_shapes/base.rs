//! Coordinates in which items are round, all in all, and the way back from them.

use taut_certify::Hull;
use taut_kernels::vector::{add_scaled, dot};
use taut_kernels::{Center, DoubleDouble};

use crate::ellipsoid::dense::forward;
use crate::shapes::Shapes;

/// Coordinates y = P(x − o) in which the items are round, all in all.
pub(super) struct Base {
    pub(super) center: Center,
    /// P, r × d.
    pub(super) matrix: Vec<f64>,
    /// P as seen from the hull, lower triangular, r × r: P = LB.
    pub(super) lower: Vec<f64>,
    /// B, r × d, where the items lie in a hull.
    pub(super) directions: Option<Vec<f64>>,
    pub(super) rank: usize,
}

impl Base {
    /// F for the matrix M of the base: s·MP, r × d.
    pub(super) fn factor(&self, matrix: &[f64], scale: f64) -> Vec<f64> {
        let (rank, dim) = (self.rank, self.center.dim());
        let mut factor = vec![0.0; rank * dim];
        for (a, row) in factor.chunks_exact_mut(dim).enumerate() {
            for b in 0..=a {
                let other = &self.matrix[b * dim..(b + 1) * dim];
                add_scaled(row, matrix[a * rank + b], other);
            }
            row.iter_mut().for_each(|v| *v *= scale);
        }
        factor
    }

    /// The point y of the base in the space of the items.
    pub(super) fn back(&self, y: &[f64]) -> Center {
        let dim = self.center.dim();
        let mut inner = y.to_vec();
        forward(&self.lower, self.rank, &mut inner);
        let x = match &self.directions {
            None => inner,
            Some(directions) => {
                let mut x = vec![0.0; dim];
                for (&z, row) in inner.iter().zip(directions.chunks_exact(dim)) {
                    add_scaled(&mut x, z, row);
                }
                x
            }
        };
        let tail = |j: usize| self.center.low.get(j).copied().unwrap_or(0.0);
        let terms: Vec<DoubleDouble> = (0..dim)
            .map(|j| DoubleDouble { high: self.center.high[j], low: tail(j) } + x[j].into())
            .collect();
        Center {
            high: terms.iter().map(|term| term.high).collect(),
            low: terms.iter().map(|term| term.low).collect(),
        }
    }

    /// A direction of the base in the space of the items: P′a, of length 1 in its largest coordinate.
    pub(super) fn direction(&self, a: &[f64]) -> Vec<f64> {
        let dim = self.center.dim();
        let mut direction = vec![0.0; dim];
        for (&a, row) in a.iter().zip(self.matrix.chunks_exact(dim)) {
            add_scaled(&mut direction, a, row);
        }
        let largest = direction.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if largest > 0.0 {
            direction.iter_mut().for_each(|v| *v /= largest);
        }
        direction
    }

    /// The hull with the largest distance of any item from it.
    pub(super) fn hull(&self, shapes: &Shapes, center: &Center) -> Option<Hull> {
        let directions = self.directions.as_ref()?;
        let dim = shapes.dim();
        let basis: Vec<Vec<f64>> = directions.chunks_exact(dim).map(<[f64]>::to_vec).collect();
        Some(Hull { distance: distance(shapes, center, &basis), basis })
    }
}

/// Returns how far items lie from a hull at most, rounded up.
fn distance(shapes: &Shapes, center: &Center, basis: &[Vec<f64>]) -> f64 {
    let dim = shapes.dim();
    let off = |x: &mut [f64]| {
        for row in basis {
            let product = dot(x, row);
            add_scaled(x, -product, row);
        }
    };
    let mut distance = 0.0f64;
    let mut reach = 0.0f64;
    for i in 0..shapes.len() {
        let tail = |j: usize| center.low.get(j).copied().unwrap_or(0.0);
        let parts = shapes.center(i).iter().zip(&center.high).enumerate();
        let mut x: Vec<f64> = parts.map(|(j, (m, c))| (m - c) - tail(j)).collect();
        reach = x.iter().fold(reach, |most, v| most.max(v.abs()));
        off(&mut x);
        // (I − B′B)S(I − B′B), of which the trace is the square of how far the item reaches off its own center.
        let mut rows: Vec<Vec<f64>> =
            (0..dim).map(|j| (0..dim).map(|k| shapes.entry(i, j, k).high).collect()).collect();
        rows.iter_mut().for_each(|row| off(row));
        let column = |j: usize| {
            let mut column: Vec<f64> = rows.iter().map(|row| row[j]).collect();
            off(&mut column);
            column[j]
        };
        let trace: f64 = (0..dim).map(column).sum();
        distance = distance.max(dot(&x, &x).sqrt() + trace.max(0.0).sqrt());
    }
    let rounding = 4.0 * f64::EPSILON * (dim as f64).sqrt() * (dim + basis.len()) as f64;
    distance * (1.0 + 1e-12) + rounding * reach
}
