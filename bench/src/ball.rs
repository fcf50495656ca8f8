//! The minimum enclosing ball: each section has an input, peers and goals.

mod balls;
mod case;
mod core_sets;
pub(crate) mod file;
mod goals;
mod paired;
mod points;
mod threads;

use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};

use serde::{Deserialize, Serialize};
use taut_certify::{Ball, Items, Solution, Stop, Verdict};
use taut_enclose::{BallMethod, BallOptions, ball};
use taut_points::{FileSource, ScalarKind};

use crate::input::{Input, Radii};
use crate::judge::{Judgement, judge};
use crate::prelude::*;
use crate::raw;
use crate::rounds::{Beside, PeerRuns, Rounds, Seen};
use case::{AREA, BallsCase, FGK, Kind, PointsCase};
use goals::{BUDGET_STOPS, FASTER, OF_CAT, READS, SHARE, UNEXPLAINED, stops};
use paired::{Goals, Paired};

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
