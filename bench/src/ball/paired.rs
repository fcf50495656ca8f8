//! Paired runs: taut, its peers and a plain read take turns, so that all see the same moods of the machine.

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::{Context as _, Result, ensure};
use serde_json::{Value, json};
use taut_certify::{Ball, Solution, Verdict};
use taut_enclose::{BallOptions, ball};

use super::Context;
use crate::input::Input;
use crate::judge::{Judgement, judge};
use crate::peer::{Answer, Peer, Silence};
use crate::read::plain_read;
use crate::stats::{Summary, seconds, times};
use crate::table::Table;

/// What one input gave.
pub(super) struct Paired {
    /// taut's answer; the same in every run, which is checked.
    pub(super) found: Solution<Ball>,
    /// What the checker says of it, or why it rejects it.
    pub(super) verdict: Result<Verdict, String>,
    /// Threads and the times with them, run by run.
    taut: Vec<(usize, Vec<f64>)>,
    reads: Vec<(usize, Vec<f64>)>,
    peers: Vec<PeerRuns>,
}

struct PeerRuns {
    name: String,
    times: Vec<f64>,
    radius: f64,
    judgement: Option<Judgement>,
    silence: Option<Silence>,
}

/// Runs taut (with each number of threads), the peers and plain reads `context.runs` times, taking turns.
pub(super) fn run(
    context: &Context,
    input: &Input,
    options: &BallOptions<'_>,
    peers: &[&str],
) -> Result<Paired> {
    let source = input.source()?;
    // Pools are built once, outside the times: a program of the user's has its pool, too.
    let pools = context.threads.iter().map(|&threads| {
        rayon::ThreadPoolBuilder::new().num_threads(threads).build().context("a pool of threads")
    });
    let pools = pools.collect::<Result<Vec<_>>>()?;
    let solve = |pool: &rayon::ThreadPool| -> Result<(f64, Solution<Ball>)> {
        pool.install(|| {
            let start = Instant::now();
            let found = ball(&*source, &BallOptions { inputs: input.items, ..*options })?;
            Ok((start.elapsed().as_secs_f64(), found))
        })
    };
    let (_, found) = solve(&pools[pools.len() - 1])?;
    let verdict = found.check(&*source).map_err(|error| error.to_string());
    // Where our own answer is rejected, peers are judged by what it claims, and the table says so.
    let bracket = verdict.clone().unwrap_or(Verdict {
        lower: found.answer.radius / (1.0 + found.certificate.gap),
        upper: found.answer.radius,
        gap: found.certificate.gap,
    });

    let mut taut: Vec<(usize, Vec<f64>)> =
        context.threads.iter().map(|&t| (t, Vec::new())).collect();
    let mut reads = taut.clone();
    let mut running = start_peers(context, input, peers)?;

    let mut ours = || -> Result<()> {
        for ((threads, times), (pool, (_, reads))) in
            taut.iter_mut().zip(pools.iter().zip(&mut reads))
        {
            reads.push(plain_read(input.bytes(), pool));
            let (time, again) = solve(pool)?;
            ensure!(
                again == found,
                "two runs of taut on {} differ ({threads} threads)",
                input.what
            );
            times.push(time);
        }
        Ok(())
    };
    let mut theirs = || {
        running.iter_mut().try_for_each(|(peer, runs)| {
            runs.once_more(peer, context, |answer| {
                Ok(judge(&*source, input.items, &answer.center, answer.radius, &bracket)?)
            })
        })
    };
    for run in 0..context.runs {
        // Who goes first changes, so that nobody always finds the caches of the other.
        if run % 2 == 0 {
            ours()?;
            theirs()?;
        } else {
            theirs()?;
            ours()?;
        }
    }
    let peers = running.into_iter().map(|(_, runs)| runs).collect();
    Ok(Paired { found, verdict, taut, reads, peers })
}

impl PeerRuns {
    /// Lets the peer solve once more, unless it is gone or has used up its time.
    fn once_more(
        &mut self,
        peer: &mut Option<Peer>,
        context: &Context,
        judge: impl Fn(&Answer) -> Result<Judgement>,
    ) -> Result<()> {
        let used = Duration::from_secs_f64(self.times.iter().sum());
        let Some(process) = peer.as_mut().filter(|_| used <= context.peer_budget) else {
            return Ok(());
        };
        match process.solve(context.limit)? {
            Ok(answer) => {
                let this = judge(&answer)?;
                self.times.push(answer.seconds);
                self.radius = answer.radius;
                // The worst of its answers counts.
                if self.judgement.is_none_or(|before| this.is_wrong() || !before.is_wrong()) {
                    self.judgement = Some(this);
                }
            }
            Err(silence) => {
                self.silence = Some(silence);
                *peer = None;
            }
        }
        Ok(())
    }
}

fn start_peers(
    context: &Context,
    input: &Input,
    names: &[&str],
) -> Result<Vec<(Option<Peer>, PeerRuns)>> {
    let path = context.temp.path().join("input.bin");
    if !names.is_empty() {
        input.write(&path)?;
    }
    let start = |&name: &&str| -> Result<(Option<Peer>, PeerRuns)> {
        let started = Peer::start(name, &path, context.temp.path() as &Path)?;
        let silence = started.as_ref().err().cloned();
        let runs = PeerRuns {
            name: name.to_owned(),
            times: Vec::new(),
            radius: f64::NAN,
            judgement: None,
            silence,
        };
        Ok((started.ok(), runs))
    };
    names.iter().map(start).collect()
}

impl Paired {
    /// Times of taut with the last number of threads.
    pub(super) fn taut_time(&self) -> Option<Summary> {
        self.taut.last().and_then(|(_, times)| Summary::of(times))
    }

    /// Times of taut over plain reads, with the last number of threads.
    pub(super) fn reads(&self) -> Option<Summary> {
        let ((_, taut), (_, reads)) = (self.taut.last()?, self.reads.last()?);
        Summary::of_ratios(taut, reads)
    }

    /// The fastest of `names` that answered: its name, its time over ours, and a warning if its answer is wrong.
    pub(super) fn fastest(&self, names: &[&str]) -> Option<(String, Summary, String)> {
        let (_, taut) = self.taut.last()?;
        let of = |runs: &&PeerRuns| Summary::of(&runs.times).map_or(f64::INFINITY, |s| s.median);
        let best = self
            .peers
            .iter()
            .filter(|runs| names.contains(&runs.name.as_str()) && !runs.times.is_empty())
            .min_by(|a, b| of(a).total_cmp(&of(b)))?;
        let note = if best.judgement.is_some_and(|judgement| judgement.is_wrong()) {
            ", whose answer is WRONG"
        } else {
            ""
        };
        Some((best.name.clone(), Summary::of_ratios(&best.times, taut)?, note.to_owned()))
    }

    /// What was found about each of `names` that answered.
    pub(super) fn judgements(&self, names: &[&str]) -> Vec<(&str, Judgement)> {
        let named = self.peers.iter().filter(|runs| names.contains(&runs.name.as_str()));
        named.filter_map(|runs| Some((runs.name.as_str(), runs.judgement?))).collect()
    }

    /// The table of this input.
    pub(super) fn table(&self) -> Table {
        let mut table = Table::new(&[
            "program",
            "threads",
            "min",
            "median",
            "max",
            "runs",
            "÷ taut (range)",
            "radius",
            "judgement",
        ]);
        let verdict = match &self.verdict {
            Ok(verdict) => format!("gap {:.1e}, verified", verdict.gap),
            Err(reason) => format!("REJECTED: {reason}"),
        };
        let radius = format!("{:.12}", self.found.answer.radius);
        for (at, (threads, runs)) in self.taut.iter().enumerate() {
            let ratio = self.ratio(runs);
            let trace = &self.found.trace;
            let judgement = if at + 1 == self.taut.len() {
                format!(
                    "{verdict}; {} passes, core-set {}, support {}",
                    trace.passes,
                    trace.core_set,
                    self.found.certificate.support.len()
                )
            } else {
                verdict.clone()
            };
            table.push(row("taut", threads, runs, ratio, radius.clone(), judgement));
        }
        for (threads, runs) in &self.reads {
            let ratio = self.ratio(runs);
            table.push(row("plain read", threads, runs, ratio, String::new(), String::new()));
        }
        for peer in &self.peers {
            let ratio = self.ratio(&peer.times);
            let judgement = peer.judgement.map(|j| j.to_string());
            let silence = peer.silence.as_ref().map(|s| s.to_string());
            let said = [judgement, silence].into_iter().flatten().collect::<Vec<_>>().join("; ");
            let radius =
                if peer.times.is_empty() { String::new() } else { format!("{:.12}", peer.radius) };
            table.push(row(&peer.name, &1, &peer.times, ratio, radius, said));
        }
        table
    }

    fn ratio(&self, times: &[f64]) -> Option<Summary> {
        self.taut.last().and_then(|(_, taut)| Summary::of_ratios(times, taut))
    }

    /// Everything, run by run.
    pub(super) fn json(&self) -> Value {
        let trace = &self.found.trace;
        let peers = self.peers.iter().map(|peer| {
            json!({
                "name": peer.name,
                "seconds": peer.times,
                "radius": peer.radius,
                "judgement": peer.judgement,
                "wrong": peer.judgement.map(|judgement| judgement.is_wrong()),
                "silence": peer.silence.as_ref().map(|silence| silence.to_string()),
            })
        });
        let of = |runs: &[(usize, Vec<f64>)]| -> Value {
            runs.iter()
                .map(|(threads, times)| json!({ "threads": threads, "seconds": times }))
                .collect()
        };
        json!({
            "taut": of(&self.taut),
            "plain read": of(&self.reads),
            "peers": peers.collect::<Value>(),
            "radius": self.found.answer.radius,
            "gap": self.verdict.as_ref().ok().map(|verdict| verdict.gap),
            "rejected": self.verdict.as_ref().err(),
            "passes": trace.passes,
            "iterations": trace.iterations,
            "core_set": trace.core_set,
            "support": self.found.certificate.support.len(),
            "counters": trace.counters,
        })
    }
}

fn row(
    name: &str,
    threads: &usize,
    runs: &[f64],
    ratio: Option<Summary>,
    radius: String,
    judgement: String,
) -> Vec<String> {
    let time = Summary::of(runs);
    let show = |pick: fn(Summary) -> f64| time.map_or(String::new(), |s| seconds(pick(s)));
    let ratio = ratio.map_or(String::new(), |s| {
        format!("{} ({}–{})", times(s.median), times(s.min), times(s.max))
    });
    vec![
        name.to_owned(),
        threads.to_string(),
        show(|s| s.min),
        show(|s| s.median),
        show(|s| s.max),
        runs.len().to_string(),
        ratio,
        radius,
        judgement,
    ]
}
