//! Points of classes by a fixed recipe, and helpers of the tests.

use taut_points::Points;
use taut_recognize::classify::{
    Labeled, Method, Model, Preset, PresetOptions, TrainOptions, train,
};

/// Numbers of the generator SplitMix64.
pub(crate) struct Draws(pub(crate) u64);

impl Draws {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub(crate) fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// About normal: the sum of twelve uniform numbers less 6.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }
}

/// A labeled set that owns its parts.
#[derive(Clone)]
pub(crate) struct Set {
    pub(crate) values: Vec<f64>,
    pub(crate) dim: usize,
    pub(crate) labels: Vec<u32>,
    pub(crate) classes: Vec<String>,
}

impl Set {
    /// Normal classes with `per_class` points each, whose centers are `apart` standard deviations from 0.
    pub(crate) fn normal(
        classes: usize,
        per_class: usize,
        dim: usize,
        apart: f64,
        seed: u64,
    ) -> Self {
        let mut draws = Draws(seed);
        let centers: Vec<f64> = (0..classes * dim).map(|_| apart * draws.normal()).collect();
        let labels: Vec<u32> = (0..classes * per_class).map(|i| (i % classes) as u32).collect();
        let values = labels
            .iter()
            .flat_map(|&label| {
                let center = &centers[label as usize * dim..][..dim];
                center.iter().map(|c| c + draws.normal()).collect::<Vec<_>>()
            })
            .collect();
        Set { values, dim, labels, classes: names(classes) }
    }

    pub(crate) fn points(&self) -> Points<'_, f64> {
        Points::new(&self.values, self.dim).unwrap()
    }

    pub(crate) fn labeled(&self) -> Labeled<'_> {
        Labeled::new(self.points(), &self.labels, &self.classes).unwrap()
    }

    /// The rows at some places.
    pub(crate) fn subset(&self, places: &[usize]) -> Set {
        Set {
            values: places.iter().flat_map(|&i| self.points().row(i).to_vec()).collect(),
            labels: places.iter().map(|&i| self.labels[i]).collect(),
            ..self.clone()
        }
    }

    pub(crate) fn train(&self, method: Method) -> Model {
        let options = TrainOptions { candidates: vec![method], ..Default::default() };
        train(self.labeled(), &options).unwrap()
    }
}

pub(crate) fn names(classes: usize) -> Vec<String> {
    (0..classes).map(|class| format!("class {class}")).collect()
}

/// Options for a preset with what it has by default.
pub(crate) fn preset(preset: Preset) -> TrainOptions<'static> {
    TrainOptions {
        candidates: preset.candidates(&PresetOptions::default()).unwrap(),
        committee: preset.committee(),
        ..Default::default()
    }
}

/// The share of points whose class is found.
pub(crate) fn accuracy(model: &Model, test: &Set) -> f64 {
    let found = model.predict(test.points()).unwrap();
    let right =
        found.iter().zip(&test.labels).filter(|(found, label)| found.class == Some(**label));
    right.count() as f64 / test.labels.len() as f64
}
