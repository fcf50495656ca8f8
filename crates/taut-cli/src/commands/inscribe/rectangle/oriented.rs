//! `taut inscribe rectangle --oriented`: the largest rectangle of any direction.

use taut::certify::InscribedOrientedRectangle;
use taut::inscribe::{OrientedRectangleOptions, inscribed_oriented_rectangle};
use taut::{Monitor, Solution};

use super::Rectangle;
use crate::exit::Outcome;
use crate::input::reading::Opened;
use crate::input::samples::Samples;
use crate::pipeline::{Find, Input, Output};
use crate::reports;
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
