//! `taut inscribe rectangle --oriented`: the largest rectangle of any direction, and what is said about it.

use taut::certify::{InscribedOrientedRectangle, Stop};
use taut::inscribe::{OrientedRectangleOptions, inscribed_oriented_rectangle};
use taut::points::PointSource;
use taut::{Monitor, Solution};

use super::Rectangle;
use super::report::corner;
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::input::samples::Samples;
use crate::output::numbers::{count, counted, exact, gap};
use crate::pipeline::{Find, Input, Output};
use crate::reports::{self, Claims, Field, Report, Summary, gap_and_verified, stopped};
use crate::watch::Watch;

/// The options of the command, for a rectangle of any direction.
pub(super) struct Oriented<'a>(pub(super) &'a Rectangle);

impl Find for Oriented<'_> {
    type Answer = InscribedOrientedRectangle;
    type Extra = ();

    fn input(&self) -> Input<'_> {
        self.0.input()
    }

    fn output(&self) -> Output<'_> {
        self.0.output()
    }

    fn samples(&self) -> Option<&Samples> {
        self.0.samples()
    }

    fn solve(
        &self,
        ring: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<InscribedOrientedRectangle>, ())> {
        let solve = |monitor: &Monitor<'_>| {
            let (epsilon, max_cells) = (self.0.epsilon, self.0.max_cells);
            let options = OrientedRectangleOptions { epsilon, max_cells, monitor: *monitor };
            inscribed_oriented_rectangle(ring.source(), &options)
        };
        let found = watch.during("solving", solve).map_err(|error| ring.explain(error))?;
        Ok((found, ()))
    }

    fn outcome(&self, found: &Solution<InscribedOrientedRectangle>) -> Outcome {
        reports::outcome(found.trace.stop, found.certificate.gap, self.0.epsilon)
    }
}

impl Summary for InscribedOrientedRectangle {
    const FOUND: &'static str = "the rectangle found";

    fn title(report: &Report<'_, Self>) -> String {
        let vertices = counted(report.points.source().len(), "point");
        format!("Largest rectangle of any direction in a polygon of {vertices}")
    }

    fn fields(report: &Report<'_, Self>) -> Vec<Field> {
        let (answer, certificate) = (&report.found.answer, &report.found.certificate);
        let trace = &report.found.trace;
        let proved = report.verdict.as_ref().map(|proved| {
            let upper = exact(proved.upper);
            (proved.gap, format!("no rectangle in the polygon has an area above {upper}"))
        });
        let ended = match trace.stop {
            Stop::NodeBudget => "a larger gap was proved within the budget of cells",
            stop => stopped(stop),
        };
        let verified = "it is inside, no edge enters it, and the gap is proved".to_owned();
        let [gap, verified] = gap_and_verified(proved, certificate.gap, verified);
        let degrees = answer.axis[1].atan2(answer.axis[0]).to_degrees();
        vec![
            Field::new("area", exact(answer.area)),
            Field::new("corners", answer.corners().map(corner).join(", ")),
            Field::new("angle", format!("{degrees:.3} degrees")).remark("of the longer sides"),
            gap,
            verified,
            Field::new("method", &*trace.method).remark(ended),
            Field::new("cells", count(certificate.tree.len() as u64)).remark("of the proof"),
        ]
    }

    fn dim(_report: &Report<'_, Self>) -> usize {
        2
    }

    fn claims(found: &Solution<Self>, verdict: &Self::Verdict, source: &dyn PointSource) -> Claims {
        let (lower, upper) = (exact(verdict.lower), exact(verdict.upper));
        let points = counted(source.len(), "point");
        let area = exact(found.answer.area);
        Claims {
            what: format!(
                "inscribed rectangle of any direction of area {area} in a polygon of {points}"
            ),
            gap: Some(verdict.gap),
            fields: vec![
                Field::proved("bracket", format!("{lower} ≤ largest area ≤ {upper}"))
                    .remark("of rectangles of any direction inside by the even-odd rule"),
                Field::proved("gap", gap(verdict.gap)).remark("relative, from the polygon alone"),
            ],
        }
    }
}
