//! Rows as points of the feature space, and their squared distances ρ(x, y) = K(x, x) + K(y, y) − 2K(x, y).

use taut_certify::Kernel;
use taut_kernels::vector::dot;
use taut_kernels::{Center, squared_distances};
use taut_points::{PointSource, Rows, gather};

use super::decay::decay_all;
use crate::Error;

/// Some rows of a source, widened to `f64`.
#[derive(Clone, Default)]
pub(super) struct Features {
    pub(super) ids: Vec<u64>,
    /// Row after row.
    pub(super) rows: Vec<f64>,
    /// K(x, x) for the kernels that need it; empty for the others.
    pub(super) own: Vec<f64>,
}

impl Features {
    /// Rows with numbers from `first` on.
    pub(super) fn block(kernel: Kernel, first: u64, rows: &Rows<'_>, dim: usize) -> Self {
        let ids = (first..first + rows.len() as u64).collect();
        let mut features = Features { ids, rows: vec![0.0; rows.len() * dim], own: vec![] };
        for (k, row) in features.rows.chunks_exact_mut(dim).enumerate() {
            rows.copy_row(k, row);
        }
        features.complete(kernel, dim);
        features
    }

    /// Reads rows by number.
    pub(super) fn read(
        kernel: Kernel,
        source: &dyn PointSource,
        ids: Vec<u64>,
    ) -> Result<Self, Error> {
        let rows = gather(source, &ids)?;
        let mut features = Features { ids, rows, own: vec![] };
        features.complete(kernel, source.dim());
        Ok(features)
    }

    /// Takes the rows that were appended to `ids` and `rows` into account.
    pub(super) fn complete(&mut self, kernel: Kernel, dim: usize) {
        match kernel {
            Kernel::Polynomial { gamma, offset, degree } => {
                let new = self.rows.chunks_exact(dim).skip(self.own.len());
                let own = new.map(|x| power(gamma * dot(x, x) + offset, degree));
                self.own.extend(own.collect::<Vec<_>>());
            }
            Kernel::Precomputed => {
                let new = self.ids.iter().zip(self.rows.chunks_exact(dim)).skip(self.own.len());
                let own = new.map(|(&id, row)| row[id as usize]);
                self.own.extend(own.collect::<Vec<_>>());
            }
            _ => {}
        }
    }

    /// The largest K(x, x), for kernels that need it; else 0.
    pub(super) fn own_largest(&self) -> f64 {
        self.own.iter().copied().fold(0.0, f64::max)
    }

    pub(super) fn len(&self) -> usize {
        self.ids.len()
    }

    pub(super) fn row(&self, i: usize, dim: usize) -> &[f64] {
        &self.rows[i * dim..(i + 1) * dim]
    }

    /// The rows at some places.
    pub(super) fn subset(&self, places: &[usize], dim: usize) -> Self {
        Features {
            ids: places.iter().map(|&i| self.ids[i]).collect(),
            rows: places.iter().flat_map(|&i| self.row(i, dim)).copied().collect(),
            own: if self.own.is_empty() {
                vec![]
            } else {
                places.iter().map(|&i| self.own[i]).collect()
            },
        }
    }

    /// Appends the rows of another.
    pub(super) fn append(&mut self, other: Features) {
        self.ids.extend(other.ids);
        self.rows.extend(other.rows);
        self.own.extend(other.own);
    }

    /// Writes ρ(y, x) to `out` for each row x, where y is row `from` of `other`.
    pub(super) fn distances_from(
        &self,
        kernel: Kernel,
        other: &Features,
        from: usize,
        dim: usize,
        out: &mut [f64],
    ) {
        let y = other.row(from, dim);
        match kernel {
            Kernel::Polynomial { gamma, offset, degree } => {
                for ((x, own), out) in self.rows.chunks_exact(dim).zip(&self.own).zip(out) {
                    let both = power(gamma * dot(x, y) + offset, degree);
                    *out = if x == y { 0.0 } else { (own + other.own[from] - 2.0 * both).max(0.0) };
                }
            }
            Kernel::Precomputed => {
                let (id, own_y) = (other.ids[from] as usize, other.own[from]);
                for (k, (x, own)) in self.rows.chunks_exact(dim).zip(&self.own).enumerate() {
                    let is_same = self.ids[k] as usize == id;
                    out[k] = if is_same { 0.0 } else { (own + own_y - 2.0 * x[id]).max(0.0) };
                }
            }
            kernel => {
                let center = Center { high: y.to_vec(), low: vec![] };
                squared_distances(&self.rows, dim, &center, out);
                if let Kernel::Gaussian { gamma } = kernel {
                    decay_all(gamma, out);
                }
            }
        }
    }
}

fn power(base: f64, degree: u32) -> f64 {
    (1..degree).fold(base, |power, _| power * base)
}
