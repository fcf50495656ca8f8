//! The names that nearly every section uses.

pub(crate) use anyhow::{Context as _, Result, anyhow, bail, ensure};
pub(crate) use serde_json::{Value, json};
pub(crate) use std::ops::Range;
pub(crate) use std::path::{Path, PathBuf};
pub(crate) use std::time::{Duration, Instant};
pub(crate) use taut_points::{Distribution, Monitor, Points, generate};

pub(crate) use crate::area::{Area, Options, Run, Section, runs, section};
pub(crate) use crate::context::Context;
pub(crate) use crate::data;
pub(crate) use crate::goals::{Found, GAP, Goal, MEMORY, PASSES, Quantity, RADIUS, SECONDS, Unit};
pub(crate) use crate::input::{SEED, is_permutation, read_raw, shuffled, write_raw, write_rows};
pub(crate) use crate::job::Job;
pub(crate) use crate::meter::{self, Meter};
pub(crate) use crate::outcome::{Bounds, Outcome, aim_only};
pub(crate) use crate::peer::{self, Answer, Peer, Silence};
pub(crate) use crate::process::{Build, Builds, by_turns};
pub(crate) use crate::stats::{Summary, least, range, seconds, times};
pub(crate) use crate::table::{Table, joined};
