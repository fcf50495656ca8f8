//! The result of a method, which is then proved: the best center so far, its multipliers, and what the pass from it found.

use std::collections::BTreeMap;

use taut_certify::{PassBounds, Stop};
use taut_kernels::Center;

use crate::item_reader::{ItemReader, PassResult};
use crate::top::Far;

/// A center with its multipliers, and the pass that was made from it.
pub(super) struct Candidate {
    pub(super) support: Vec<u64>,
    pub(super) lambda: Vec<f64>,
    pub(super) center: Center,
    pub(super) found: PassResult,
}

/// The result of a method, in the units of its reader.
pub(super) struct Outcome {
    best: Option<(f64, Candidate)>,
    pub(super) stop: Option<Stop>,
    pub(super) iterations: u64,
    pub(super) core_set: u64,
    pub(super) history: Vec<PassBounds>,
    pub(super) counters: BTreeMap<String, u64>,
}

impl Outcome {
    pub(super) fn new() -> Self {
        Outcome {
            best: None,
            stop: None,
            iterations: 0,
            core_set: 0,
            history: vec![],
            counters: BTreeMap::new(),
        }
    }

    /// All items are one point: it is the center.
    pub(super) fn single(reader: &ItemReader<'_>, id: u64) -> Result<Self, crate::Error> {
        let center = Center { high: reader.rows(&[id])?[..reader.dim()].to_vec(), low: vec![] };
        let found = PassResult {
            farthest: Far { id, reach2: 0.0 },
            far: vec![],
            listed_above: 0.0,
            by_face: vec![],
        };
        let mut outcome = Outcome::new();
        outcome.offer(0.0, || (vec![id], vec![1.0], center, found));
        outcome.bounds(PassBounds { lower: 0.0, upper: 0.0, working_set: 1 });
        outcome.core_set = 1;
        outcome.stop = Some(Stop::Converged);
        Ok(outcome)
    }

    /// Keeps a candidate if its gap is smaller than that of the best so far.
    pub(super) fn offer(
        &mut self,
        gap: f64,
        candidate: impl FnOnce() -> (Vec<u64>, Vec<f64>, Center, PassResult),
    ) {
        if self.best.as_ref().is_none_or(|(least, _)| gap < *least) {
            let (support, lambda, center, found) = candidate();
            self.best = Some((gap, Candidate { support, lambda, center, found }));
        }
    }

    pub(super) fn bounds(&mut self, bounds: PassBounds) {
        self.history.push(bounds);
    }

    pub(super) fn count(&mut self, name: &str, events: u64) {
        if events > 0 {
            self.counters.insert(name.to_owned(), events);
        }
    }

    /// The best candidate; every method makes a pass before it ends.
    pub(super) fn into_best(mut self) -> (Candidate, Self) {
        let (_, candidate) = self.best.take().expect("every method makes a pass before it ends");
        (candidate, self)
    }
}
