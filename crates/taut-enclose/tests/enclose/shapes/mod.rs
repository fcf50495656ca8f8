//! Ellipsoids to try the solvers of items with.
#![allow(dead_code, unreachable_pub)] // each test binary uses a part

use taut_points::{Distribution, generate};

/// {m + v : vv′ ⪯ S}.
#[derive(Clone, Debug)]
pub struct Item {
    pub center: Vec<f64>,
    /// S, d × d.
    pub shape: Vec<f64>,
}

impl Item {
    /// The image under x ↦ Ax + b.
    pub fn mapped(&self, a: &[f64], b: &[f64]) -> Item {
        let dim = self.center.len();
        let center = (0..dim)
            .map(|i| b[i] + (0..dim).map(|j| a[i * dim + j] * self.center[j]).sum::<f64>())
            .collect();
        let product: Vec<f64> = times(a, &self.shape, dim);
        let mut shape = vec![0.0; dim * dim];
        for i in 0..dim {
            for j in 0..dim {
                shape[i * dim + j] = (0..dim).map(|k| product[i * dim + k] * a[j * dim + k]).sum();
            }
        }
        Item { center, shape }
    }

    /// As a row of a source.
    pub fn row(&self) -> Vec<f64> {
        let dim = self.center.len();
        let lower = (0..dim).flat_map(|i| (0..=i).map(move |j| (i, j)));
        self.center.iter().copied().chain(lower.map(|(i, j)| self.shape[i * dim + j])).collect()
    }
}

fn times(a: &[f64], b: &[f64], dim: usize) -> Vec<f64> {
    (0..dim * dim)
        .map(|at| (0..dim).map(|k| a[at / dim * dim + k] * b[k * dim + at % dim]).sum())
        .collect()
}

/// The rows of items and how many numbers each has.
pub fn rows_of(items: &[Item]) -> (Vec<f64>, usize) {
    let rows: Vec<Vec<f64>> = items.iter().map(Item::row).collect();
    (rows.concat(), rows[0].len())
}

/// Normal centers, and shapes size²·GG′/d for normal matrices G; every seventh is flat in one direction.
pub fn random_items(n: usize, dim: usize, seed: u64, size: f64) -> Vec<Item> {
    let centers: Vec<f64> = generate(Distribution::Normal, n, dim, seed).unwrap();
    let factors: Vec<f64> = generate(Distribution::Normal, n * dim, dim, seed + 1000).unwrap();
    (0..n)
        .map(|i| {
            let mut g = factors[i * dim * dim..(i + 1) * dim * dim].to_vec();
            if i % 7 == 6 && dim > 1 {
                (0..dim).for_each(|k| g[k * dim] = 0.0);
            }
            let shape = (0..dim * dim)
                .map(|at| {
                    let (a, b) = (at / dim, at % dim);
                    let sum: f64 = (0..dim).map(|k| g[a * dim + k] * g[b * dim + k]).sum();
                    size * size * sum / dim as f64
                })
                .collect();
            Item { center: centers[i * dim..(i + 1) * dim].to_vec(), shape }
        })
        .collect()
}

/// Points on the border of an ellipse, at equal angles.
pub fn border(item: &Item, count: usize) -> Vec<f64> {
    // A root of S by Cholesky, with zeros where S is singular.
    let s = &item.shape;
    let a = s[0].sqrt();
    let b = if a > 0.0 { s[2] / a } else { 0.0 };
    let c = (s[3] - b * b).max(0.0).sqrt();
    (0..count)
        .flat_map(|k| {
            let (sine, cosine) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
            [item.center[0] + a * cosine, item.center[1] + b * cosine + c * sine]
        })
        .collect()
}
