//! The report about an answer, from the crate that has the words, and how a command ends that found it.

pub(crate) use taut_report::*;

use taut::certify::Stop;

use crate::exit::Outcome;

/// Tests whether a run that asked for the gap `epsilon`, stopped for that reason and has the gap `gap` got what it asked for.
pub(crate) fn outcome(stop: Stop, gap: f64, epsilon: f64) -> Outcome {
    match stop {
        Stop::PassBudget | Stop::NodeBudget | Stop::ProofBudget => Outcome::StoppedEarly,
        // ε = 0 asks for what rounding allows, and has it; a positive ε is a promise that was not kept.
        Stop::Rounding if epsilon > 0.0 && gap > epsilon => Outcome::StoppedEarly,
        Stop::Rounding | Stop::Converged => Outcome::Done,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_promise_that_was_not_kept_is_no_success() {
        for (stop, epsilon, expected) in [
            (Stop::Converged, 1e-9, Outcome::Done),
            (Stop::Converged, 0.0, Outcome::Done),
            (Stop::Rounding, 0.0, Outcome::Done),
            (Stop::Rounding, 1e-9, Outcome::Done),
            (Stop::Rounding, 1e-15, Outcome::StoppedEarly),
            (Stop::PassBudget, 1e-9, Outcome::StoppedEarly),
            (Stop::NodeBudget, 1e-9, Outcome::StoppedEarly),
            (Stop::ProofBudget, 1e-9, Outcome::StoppedEarly),
        ] {
            assert_eq!(outcome(stop, 1e-12, epsilon), expected, "{stop:?} with ε = {epsilon}");
        }
    }
}
