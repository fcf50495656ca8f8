//! The minimum enclosing ball: each section has an input, peers and goals.

mod balls;
mod case;
mod core_sets;
pub(crate) mod file;
mod goals;
mod paired;
mod points;
mod threads;

use crate::prelude::*;
use case::{AREA, Kind};

/// Runs the sections that were asked for.
pub(crate) fn run(options: &Options) -> Result<()> {
    AREA.run(options, |context, out, section| {
        let goals = [section.must, section.aim];
        match &section.kind {
            Kind::Points(case) => points::run(context, out, goals, case),
            Kind::Usps => points::run_usps(context, out, goals),
            Kind::Balls(case) => balls::run(context, out, goals, case),
            Kind::File => file::run(context, out),
            Kind::CoreSets => core_sets::run(context, out),
            Kind::Threads => threads::run(context, out),
        }
    })
}
