//! Any text to the reader of models, and points to what it reads.
#![no_main]

use taut::points::Points;
use taut::recognize::classify::{Classifier, Model};

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(model) = Model::from_json(text) else { return };
    let dim = model.dim();
    if dim == 0 || dim > 64 {
        return;
    }
    let values: Vec<f64> = (0..4 * dim).map(|i| i as f64 * 0.7 - 1.0).collect();
    if let Ok(points) = Points::new(&values, dim) {
        let _ = model.predict(points);
    }
});
