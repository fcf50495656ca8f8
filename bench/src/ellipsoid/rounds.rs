//! taut with each number of threads, and a peer, by turns: of each the least time of all rounds counts.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use serde_json::{Value, json};

use super::Context;
use super::goals::Measured;
use crate::meter::Meter;
use crate::peer::{Answer, Peer, Silence};
use crate::stats::{Summary, seconds};

/// Columns of times: the least by the clock with the last number of threads, the least of the processors for the same,
/// the least of the processor with one thread.
pub(super) const TIME_COLUMNS: [&str; 3] = ["clock", "processors", "one thread"];

/// Times of taut with one number of threads.
pub(super) struct Timed {
    /// Threads.
    pub(super) threads: usize,
    /// Seconds by the clock, round by round.
    pub(super) wall: Vec<f64>,
    /// Processor seconds of all threads, round by round.
    pub(super) cpu: Vec<f64>,
}

/// What was found, and how long it took.
pub(super) struct Rounds<T> {
    /// The last answer; all are the same.
    pub(super) found: T,
    /// By number of threads.
    pub(super) taut: Vec<Timed>,
    /// Answer and seconds of the peer, or why there are none; `None` where no peer was asked for.
    pub(super) peer: Option<Result<(Answer, Vec<f64>), Silence>>,
}

/// The least.
fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

impl<T> Rounds<T> {
    /// Least seconds by the clock with the last number of threads.
    pub(super) fn clock(&self) -> Option<f64> {
        self.taut.last().map(|timed| least(&timed.wall))
    }

    /// Least processor seconds of all threads, with the last number of them.
    pub(super) fn processors(&self) -> Option<f64> {
        self.taut.last().map(|timed| least(&timed.cpu))
    }

    /// Least processor seconds with one thread.
    pub(super) fn one_thread(&self) -> Option<f64> {
        self.taut.iter().find(|timed| timed.threads == 1).map(|timed| least(&timed.cpu))
    }

    /// What goals ask for of the times.
    pub(super) fn measured(&self) -> Measured {
        Measured {
            clock: self.clock(),
            processors: self.processors(),
            one_thread: self.one_thread(),
            faster: self.faster().map(|(ratio, _)| ratio),
            ..Measured::default()
        }
    }

    /// Cells under [`TIME_COLUMNS`].
    pub(super) fn cells(&self) -> Vec<String> {
        let times = [self.clock(), self.processors(), self.one_thread()];
        times.map(|time| time.map(seconds).unwrap_or_default()).into()
    }

    /// Least seconds of the peer.
    pub(super) fn peer_seconds(&self) -> Option<f64> {
        let (_, seconds) = self.peer.as_ref()?.as_ref().ok()?;
        Some(least(seconds))
    }

    /// Least time of the peer over our least time by the clock, and the ratios of the rounds one by one.
    pub(super) fn faster(&self) -> Option<(f64, Summary)> {
        let (_, theirs) = self.peer.as_ref()?.as_ref().ok()?;
        let ours = &self.taut.last()?.wall;
        Some((least(theirs) / least(ours), Summary::of_ratios(theirs, ours)?))
    }

    /// All times, for the report.
    pub(super) fn json(&self) -> Value {
        let taut = self
            .taut
            .iter()
            .map(|timed| json!({ "threads": timed.threads, "wall": timed.wall, "cpu": timed.cpu }));
        let peer = self.peer.as_ref().map(|peer| match peer {
            Ok((_, seconds)) => json!(seconds),
            Err(silence) => json!(silence.to_string()),
        });
        json!({ "taut": taut.collect::<Vec<_>>(), "peer": peer })
    }
}

/// Runs all rounds of `solve`; `peer` is a program and the file it reads.
pub(super) fn run<T: Send>(
    context: &Context,
    threads: &[usize],
    peer: Option<(&str, &Path)>,
    solve: impl Fn() -> Result<T> + Sync,
) -> Result<Rounds<T>> {
    let pools = threads
        .iter()
        .map(|&threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build())
        .collect::<Result<Vec<_>, _>>()?;
    let mut taut: Vec<Timed> =
        threads.iter().map(|&threads| Timed { threads, wall: vec![], cpu: vec![] }).collect();
    let mut running = match peer {
        Some((name, file)) => Some(Peer::start(name, file, context.temp.path())?),
        None => None,
    };
    let mut told: Option<(Answer, Vec<f64>)> = None;
    let (mut found, mut spent) = (None, Duration::ZERO);
    for round in 0..context.runs {
        // A B, then B A: neither is always the one that finds the caches as the other left them.
        let is_peer_first = round % 2 == 1;
        if is_peer_first {
            ask(context, &mut running, &mut told, &mut spent)?;
        }
        for (pool, timed) in pools.iter().zip(&mut taut) {
            // Only one answer is held, as with a peer.
            drop(found.take());
            let meter = Meter::start();
            let answer = pool.install(&solve)?;
            let cost = meter.stop();
            timed.wall.push(cost.wall);
            timed.cpu.push(cost.cpu);
            found = Some(answer);
        }
        if !is_peer_first {
            ask(context, &mut running, &mut told, &mut spent)?;
        }
    }
    let peer = running.map(|running| match (running, told) {
        (Err(silence), _) => Err(silence),
        (Ok(_), told) => told.ok_or(Silence::Ended),
    });
    Ok(Rounds { found: found.context("no round")?, taut, peer })
}

/// Lets the peer solve once more, unless it was too slow or is gone.
fn ask(
    context: &Context,
    running: &mut Option<Result<Peer, Silence>>,
    told: &mut Option<(Answer, Vec<f64>)>,
    spent: &mut Duration,
) -> Result<()> {
    if let Some(Ok(peer)) = running
        && *spent < context.peer_budget
    {
        let start = Instant::now();
        match peer.solve(context.limit)? {
            Ok(answer) => {
                let mut seconds = told.take().map_or(vec![], |(_, seconds)| seconds);
                seconds.push(answer.seconds);
                *told = Some((answer, seconds));
            }
            Err(silence) => *running = Some(Err(silence)),
        }
        *spent += start.elapsed();
    }
    Ok(())
}
