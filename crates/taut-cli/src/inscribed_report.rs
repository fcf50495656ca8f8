//! What is said about an ellipsoid inside a polytope.

use taut::certify::Stop;
use taut::points::PointSource;
use taut::{InscribedEllipsoid, InscribedVerdict, Solution};
use taut_draw::{DrawOptions, Error as DrawError, Figure, inscribed_figures};

use crate::numbers::{count, counted, exact, gap};
use crate::report::{Claims, Fact, Report, Tell, centre, gap_and_verified, stopped};

impl Tell for Report<'_, InscribedEllipsoid> {
    const FOUND: &'static str = "the ellipsoid found";

    fn title(&self) -> String {
        let sides = counted(self.points.source().len(), "half-space");
        let dim = counted(self.dim() as u64, "dimension");
        format!("Largest ellipsoid inside {sides} in {dim}")
    }

    fn facts(&self) -> Vec<Fact> {
        let (answer, certificate) = (&self.found.answer, &self.found.certificate);
        let trace = &self.found.trace;
        // Digits of the centre count beside the extent of the ellipsoid.
        let widest = answer.axes.iter().flatten().fold(0.0f64, |m, g| m.max(g.abs()));
        let proved = self.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no ellipsoid inside has a log-volume above {upper}"))
        });
        let ended = match trace.stop {
            Stop::PassBudget => "stopped early by the budget of steps",
            stop => stopped(stop),
        };
        let verified = "it lies in every half-space, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        vec![
            Fact::new("log-volume", exact(answer.log_volume)),
            centre(&answer.center, if widest > 0.0 { widest } else { 1.0 }),
            gap,
            verified,
            Fact::new("method", &*trace.method).remark(ended),
            Fact::new("support", counted(certificate.support.len() as u64, "half-space"))
                .remark("with a multiplier above 0"),
            Fact::new("steps", count(trace.iterations)),
        ]
    }

    fn dim(&self) -> usize {
        self.found.answer.center.len()
    }

    fn figures(&self, options: &DrawOptions) -> Result<Vec<Figure>, DrawError> {
        inscribed_figures(self.found, self.points.source(), options)
    }
}

/// What the checker proved.
pub(crate) fn claims_of_inscribed(
    found: &Solution<InscribedEllipsoid>,
    verdict: &InscribedVerdict,
    source: &dyn PointSource,
) -> Claims {
    let (lower, upper) = (exact(verdict.lower), exact(verdict.upper));
    let sides = counted(source.len(), "half-space");
    let dim = counted(found.answer.center.len() as u64, "dimension");
    let volume = exact(found.answer.log_volume);
    Claims {
        what: format!("inscribed ellipsoid of log-volume {volume} within {sides} in {dim}"),
        gap: Some(verdict.gap),
        facts: vec![
            Fact::proved("bracket", format!("{lower} ≤ largest log-volume ≤ {upper}")),
            Fact::proved("gap", gap(verdict.gap))
                .remark("in log-volume, from the half-spaces alone"),
        ],
    }
}
