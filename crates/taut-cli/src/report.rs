//! What is said about a ball: the same facts on the terminal, beside pictures and in the tour.

use taut::certify::Stop;
use taut::{Ball, Items, Solution, Verdict};
use taut_draw::ball_figures;

use crate::exit::Outcome;
use crate::numbers::{abridged, coordinates, count, counted, exact, gap};
use crate::picture::{self, Drawing, Look};
use crate::reading::Opened;

/// A ball, the points it belongs to, and what the checker proved (`None` where it was not asked).
pub(crate) struct Report<'a> {
    pub(crate) found: &'a Solution<Ball>,
    pub(crate) points: &'a Opened,
    pub(crate) verdict: Option<Verdict>,
}

/// A number with its name, and what there is to say about it where there is room for words.
pub(crate) struct Fact {
    pub(crate) name: &'static str,
    pub(crate) value: String,
    pub(crate) remark: Option<String>,
}

impl Fact {
    pub(crate) fn new(name: &'static str, value: impl Into<String>) -> Self {
        Fact { name, value: value.into(), remark: None }
    }

    pub(crate) fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remark = Some(remark.into());
        self
    }
}

impl Report<'_> {
    /// Why some balls are not drawn.
    pub(crate) const NO_PICTURE: &'static str = "there are no pictures of balls around ellipsoids";

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
        let support = count(self.found.certificate.support.len() as u64);
        let mut centre = Fact::new("centre", coordinates(&answer.center, answer.radius));
        if abridged(&answer.center) {
            centre.value += &format!(" {} in all", count(answer.center.len() as u64));
            centre = centre.remark("the JSON holds them (-o FILE)");
        }
        let (gap, verified) = match &self.verdict {
            Some(proved) => (
                Fact::new("gap", gap(proved.gap)).remark(format!(
                    "no enclosing ball has a radius below {}",
                    exact(proved.lower)
                )),
                Fact::new("verified", "yes")
                    .remark(format!("every {} is inside, and the gap is proved", self.noun())),
            ),
            None => (
                Fact::new("gap", gap(self.found.certificate.gap)).remark("as the solver says"),
                Fact::new("verified", "not checked"),
            ),
        };
        vec![
            Fact::new("radius", exact(answer.radius)),
            centre,
            gap,
            verified,
            Fact::new("method", &*trace.method).remark(stopped(trace.stop)),
            Fact::new("core-set", counted(trace.core_set, self.noun()))
                .remark(format!("{support} of them in the support")),
            Fact::new("passes", count(trace.passes)).remark(counted(trace.iterations, "iteration")),
        ]
    }

    /// Pictures and what stands beside them.
    pub(crate) fn drawing(&self, look: &Look) -> anyhow::Result<Drawing> {
        let dim = self.items().dim(self.points.source().dim());
        let options = look.options(self.points.names(dim));
        let figures = ball_figures(self.found, self.points.source(), &options)
            .map_err(|error| picture::refused(error, self.points))?;
        Ok(Drawing {
            title: self.title(),
            heading: self.points.name().to_owned(),
            facts: self.facts().into_iter().map(picture::fact).collect(),
            figures,
        })
    }

    fn items(&self) -> Items {
        self.found.certificate.items
    }

    fn noun(&self) -> &'static str {
        match self.items() {
            Items::Points => "point",
            Items::Balls => "ball",
            Items::Ellipsoids => "ellipsoid",
        }
    }
}

pub(crate) fn stopped(stop: Stop) -> &'static str {
    match stop {
        Stop::Converged => "converged",
        Stop::Rounding => "stopped where this method's rounding allows no smaller gap",
        Stop::PassBudget => "stopped early by the budget of passes",
    }
}

/// Title and facts as text, a fact a line, the values in one column.
pub(crate) fn text(title: &str, facts: &[Fact]) -> String {
    let width = facts.iter().map(|fact| fact.name.len() + 1).max().unwrap_or(0).max(10);
    let lines = facts.iter().map(|Fact { name, value, remark }| match remark {
        Some(remark) => format!("  {name:<width$}{value}; {remark}\n"),
        None => format!("  {name:<width$}{value}\n"),
    });
    std::iter::once(format!("{title}\n")).chain(lines).collect()
}

/// Whether a run that asked for the gap `epsilon`, stopped for that reason and has the gap `gap` got what it asked for.
pub(crate) fn outcome(stop: Stop, gap: f64, epsilon: f64) -> Outcome {
    match stop {
        Stop::PassBudget => Outcome::StoppedEarly,
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
        ] {
            assert_eq!(outcome(stop, 1e-12, epsilon), expected, "{stop:?} with ε = {epsilon}");
        }
    }
}
