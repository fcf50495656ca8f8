//! Bounding dops of points.

use taut::enclose::{DopOptions, bounding_dop};

use super::{Case, Input, cases, clouds, document};

/// Returns the cases of bounding dops.
pub fn all() -> Vec<Case> {
    let mut inputs = clouds::points(3, 20);
    let far: Vec<f64> = (0..30).map(|k| 1e6 + f64::from(k * k % 17) / 1024.0).collect();
    inputs.push(Input::new("far beside their extent", far, 3));
    let tetrahedron = vec![0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0];
    inputs.push(Input::new("a tetrahedron", tetrahedron, 3));
    cases(inputs, |input| {
        let of = |directions: usize| {
            let options = DopOptions { directions, ..DopOptions::default() };
            let found = input.with(|source| bounding_dop(source, &options));
            (format!("k = {directions}"), found.ok().map(|found| document(&found)))
        };
        [6, 14, 18, 26].map(of).to_vec()
    })
}
