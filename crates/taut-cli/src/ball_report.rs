//! What is said about a ball.

use taut::points::PointSource;
use taut::{Ball, Items, Solution, Verdict};
use taut_draw::{DrawOptions, Error as DrawError, Figure, ball_figures};

use crate::numbers::{count, counted, exact, gap};
use crate::report::{Claims, Fact, Report, Tell, centre, gap_and_verified, inputs, noun, stopped};

/// Why some balls are not drawn.
pub(crate) const NO_PICTURE: &str = "there are no pictures of balls around ellipsoids";

impl Tell for Report<'_, Ball> {
    const FOUND: &'static str = "the ball found";

    fn title(&self) -> String {
        let around = counted(self.points.source().len(), noun(self.items()));
        format!("Smallest ball around {around} in {}", counted(self.dim() as u64, "dimension"))
    }

    fn facts(&self) -> Vec<Fact> {
        let (answer, trace) = (&self.found.answer, &self.found.trace);
        let (certificate, noun) = (&self.found.certificate, noun(self.items()));
        let support = count(certificate.support.len() as u64);
        let proved = self.verdict.as_ref().map(|proved| {
            let lower = exact(proved.lower);
            (proved.gap, format!("no enclosing ball has a radius below {lower}"))
        });
        let verified = format!("every {noun} is inside, and the gap is proved");
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        vec![
            Fact::new("radius", exact(answer.radius)),
            centre(&answer.center, answer.radius),
            gap,
            verified,
            Fact::new("method", &*trace.method).remark(stopped(trace.stop)),
            Fact::new("core-set", counted(trace.core_set, noun))
                .remark(format!("{support} of them in the support")),
            Fact::new("passes", count(trace.passes)).remark(counted(trace.iterations, "iteration")),
        ]
    }

    fn dim(&self) -> usize {
        self.items().dim(self.points.source().dim())
    }

    fn figures(&self, options: &DrawOptions) -> Result<Vec<Figure>, DrawError> {
        ball_figures(self.found, self.points.source(), options)
    }
}

impl Report<'_, Ball> {
    fn items(&self) -> Items {
        self.found.certificate.items
    }
}

/// What the checker proved.
pub(crate) fn claims_of_ball(
    found: &Solution<Ball>,
    verdict: &Verdict,
    source: &dyn PointSource,
) -> Claims {
    let inputs = inputs(found.certificate.items, source.len(), source.dim());
    let bracket = format!("{} ≤ smallest radius ≤ {}", exact(verdict.lower), exact(verdict.upper));
    Claims {
        what: format!("ball of radius {} around {inputs}", exact(found.answer.radius)),
        gap: Some(verdict.gap),
        facts: vec![
            Fact::proved("bracket", bracket),
            Fact::proved("gap", gap(verdict.gap)).remark("relative, from the points alone"),
        ],
    }
}
