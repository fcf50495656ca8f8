//! What is said about a ball: the same facts on the terminal, beside pictures and in the tour.

use taut::certify::Stop;
use taut::{Ball, Items, Solution, Verdict};

use crate::exit::Outcome;
use crate::numbers::{abridged, coordinates, count, counted, exact, gap};
use crate::reading::Opened;

/// A ball, the points it belongs to, and what the checker proved (`None` where it was not asked).
pub(crate) struct Report<'a> {
    pub(crate) found: &'a Solution<Ball>,
    pub(crate) points: &'a Opened,
    pub(crate) verdict: Option<Verdict>,
}

/// A name and what stands behind it.
pub(crate) type Fact = (&'static str, String);

impl Report<'_> {
    /// What this is, in one line.
    pub(crate) fn title(&self) -> String {
        let source = self.points.source();
        let dim = self.items().dim(source.dim()) as u64;
        format!(
            "Smallest ball around {} in {}",
            counted(source.len(), self.noun()),
            counted(dim, "dimension")
        )
    }

    /// The numbers, each with its name.
    pub(crate) fn facts(&self) -> Vec<Fact> {
        let (answer, trace) = (&self.found.answer, &self.found.trace);
        let support = self.found.certificate.support.len() as u64;
        let mut centre = coordinates(&answer.center, answer.radius);
        if abridged(&answer.center) {
            centre += &format!(" {} in all", count(answer.center.len() as u64));
        }
        vec![
            ("radius", exact(answer.radius)),
            ("centre", centre),
            ("gap", self.gap()),
            ("verified", self.verified()),
            ("method", format!("{}, {}", trace.method, stopped(trace.stop))),
            (
                "core-set",
                format!(
                    "{}, {} of them in the support",
                    counted(trace.core_set, self.noun()),
                    count(support)
                ),
            ),
            (
                "passes",
                format!("{}; {}", count(trace.passes), counted(trace.iterations, "iteration")),
            ),
        ]
    }

    fn gap(&self) -> String {
        match &self.verdict {
            Some(proved) => format!(
                "{}: no enclosing ball has a radius below {}",
                gap(proved.gap),
                exact(proved.lower)
            ),
            None => format!("{}, as the solver says", gap(self.found.certificate.gap)),
        }
    }

    fn verified(&self) -> String {
        match self.verdict {
            Some(_) => format!("yes: every {} is inside, and the gap is proved", self.noun()),
            None => "not checked".to_owned(),
        }
    }

    fn items(&self) -> Items {
        self.found.certificate.items
    }

    fn noun(&self) -> &'static str {
        match self.items() {
            Items::Points => "point",
            Items::Balls => "ball",
        }
    }
}

fn stopped(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "converged",
        Stop::Rounding => "stopped where rounding hides any smaller gap",
        Stop::PassBudget => "stopped early by the budget of passes",
    }
}

/// Title and facts as text, a fact a line.
pub(crate) fn text(title: &str, facts: &[Fact]) -> String {
    let lines = facts.iter().map(|(name, value)| format!("  {name:<10}{value}\n"));
    std::iter::once(format!("{title}\n")).chain(lines).collect()
}

/// Whether a run that asked for the gap `epsilon` got it.
pub(crate) fn outcome(found: &Solution<Ball>, epsilon: f64) -> Outcome {
    match found.trace.stop {
        Stop::PassBudget => Outcome::StoppedEarly,
        // ε = 0 asks for what rounding allows, and has it; a positive ε is a promise that was not kept.
        Stop::Rounding if epsilon > 0.0 && found.certificate.gap > epsilon => Outcome::StoppedEarly,
        Stop::Rounding | Stop::Converged => Outcome::Done,
    }
}
