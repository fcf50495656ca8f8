//! An answer with what proves it and how it came about.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize, de::DeserializeOwned};
use taut_points::{Monitor, PointSource};

use crate::CheckError;

/// A tight shape that can be judged from the points and its certificate.
pub trait Answer: Serialize + DeserializeOwned {
    /// The data that convince a third party that this answer is tight.
    type Certificate: Serialize + DeserializeOwned;

    /// The result of the checker if it finds nothing wrong.
    type Verdict;

    /// The word for it in JSON: `"ball"`.
    const KIND: &'static str;

    /// Judges this answer over `source` with the help of `certificate`, in one or two passes.
    ///
    /// # Errors
    /// [`CheckError::Rejected`] with the first violation, [`CheckError::Read`] when the points cannot be read.
    fn check(
        &self,
        certificate: &Self::Certificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<Self::Verdict, CheckError>;
}

/// An answer, what proves it, and how it came about (counters only: no clock, so runs compare equal).
#[derive(Clone, Debug, PartialEq)]
pub struct Solution<A: Answer> {
    /// The shape.
    pub answer: A,
    /// Its proof.
    pub certificate: A::Certificate,
    /// Counters of the run.
    pub trace: Trace,
}

impl<A: Answer> Solution<A> {
    /// A second opinion: judges the answer over the points, with code that shares nothing with the solver.
    ///
    /// # Errors
    /// The first [`Violation`](crate::Violation), or what reading the points says.
    pub fn check(&self, source: &dyn PointSource) -> Result<A::Verdict, CheckError> {
        self.answer.check(&self.certificate, source, &Monitor::silent())
    }
}

/// Why a solver stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stop {
    /// The wanted gap was reached; for ε = 0, no point violates the answer beyond rounding.
    #[default]
    Converged,
    /// Rounding lets no smaller gap be proved; the gap reached is larger than the one wanted.
    Rounding,
    /// The budget of passes was used up.
    PassBudget,
    /// The budget of nodes of a search was used up.
    NodeBudget,
    /// The search ended, but to write down what it found takes more nodes than a proof is granted: a lower bound below it is proved.
    ProofBudget,
}

/// The bounds known after one pass over all points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the bounds of a pass: an object with lower, upper and working_set"
)]
pub struct PassBounds {
    /// Lower bound on the optimal radius or log-volume, proved by the multipliers of that moment.
    pub lower: f64,
    /// Radius or log-volume that encloses all points from the center of that moment.
    pub upper: f64,
    /// Points in the working set then.
    pub working_set: u64,
}

/// The way in which an answer came about: counters of events, the same on every run and for every number of threads.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a trace: an object of counters")]
pub struct Trace {
    /// The method, by the name the command line gives it.
    pub method: String,
    /// Why it stopped.
    pub stop: Stop,
    /// Reads of all points.
    pub passes: u64,
    /// Steps of the inner solver.
    pub iterations: u64,
    /// Points the method chose to work on, |X|; the support is a part of it.
    pub core_set: u64,
    /// Bounds by pass.
    pub history: Vec<PassBounds>,
    /// Other events worth counting, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub counters: BTreeMap<String, u64>,
}
