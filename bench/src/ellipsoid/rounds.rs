//! taut with each number of threads, and a peer, by turns: of each the least time of all rounds counts.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result};
use serde_json::{Value, json};

use super::Context;
use crate::meter::Meter;
use crate::peer::{Answer, Peer, Silence};
use crate::stats::Summary;

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

    /// Least processor seconds with one thread.
    pub(super) fn one_thread(&self) -> Option<f64> {
        self.taut.iter().find(|timed| timed.threads == 1).map(|timed| least(&timed.cpu))
    }

    /// Least seconds of the peer.
    pub(super) fn peer_seconds(&self) -> Option<f64> {
        let (_, seconds) = self.peer.as_ref()?.as_ref().ok()?;
        Some(least(seconds))
    }

    /// The middle of the seconds of the peer: one that shuffles its points anew in each round is lucky in some.
    pub(super) fn peer_median(&self) -> Option<f64> {
        let (_, seconds) = self.peer.as_ref()?.as_ref().ok()?;
        Some(Summary::of(seconds)?.median)
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
    for _ in 0..context.runs {
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
        if let Some(Ok(peer)) = &mut running
            && spent < context.peer_budget
        {
            let start = Instant::now();
            match peer.solve(context.limit)? {
                Ok(answer) => {
                    let mut seconds = told.take().map_or(vec![], |(_, seconds)| seconds);
                    seconds.push(answer.seconds);
                    told = Some((answer, seconds));
                }
                Err(silence) => running = Some(Err(silence)),
            }
            spent += start.elapsed();
        }
    }
    let peer = running.map(|running| match (running, told) {
        (Err(silence), _) => Err(silence),
        (Ok(_), told) => told.ok_or(Silence::Ended),
    });
    Ok(Rounds { found: found.context("no round")?, taut, peer })
}
