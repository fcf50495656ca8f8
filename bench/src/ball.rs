//! The minimum enclosing ball: each section has an input, peers and goals.

mod case;
mod core_sets;
pub(crate) mod file;
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
use crate::rounds::{Opponents, PeerRuns, Rounds, Seen};
pub(crate) use case::AREA;
use case::{BUDGET_STOPS, FASTER, OF_CAT, READS, SHARE, SPEEDUP, UNEXPLAINED, stops};
use paired::Paired;
