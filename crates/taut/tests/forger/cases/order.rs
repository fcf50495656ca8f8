//! Points along curves.

use taut::certify::OrderCurve;
use taut::{OrderOptions, spatial_order};

use super::{Case, Input, cases, clouds, document};

use crate::random::Random;
/// Returns the cases of orders.
pub fn all() -> Vec<Case> {
    let mut found = vec![];
    for dim in 2..=3 {
        let mut inputs = clouds::points(dim, 20);
        inputs.push(clusters(dim));
        found.extend(cases(inputs, |input| {
            [OrderCurve::Hilbert, OrderCurve::Morton]
                .into_iter()
                .map(|curve| {
                    let found = input.with(|source| {
                        spatial_order(source, &OrderOptions { curve, ..Default::default() })
                    });
                    (format!("{curve:?}"), found.ok().map(|found| document(&found)))
                })
                .collect()
        }));
    }
    found
}

/// Clusters within clusters, so that grids are laid in cells of grids.
fn clusters(dim: usize) -> Input {
    let mut random = Random::new("clusters", dim as u64);
    let mut values = vec![1.0; dim];
    for scale in [1.0, 1e-8, 1e-16] {
        values.extend((0..9 * dim).map(|_| random.between(0, 3) as f64 * scale));
    }
    Input::new(format!("clusters, d = {dim}"), values, dim)
}
