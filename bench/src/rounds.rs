//! taut with each number of threads, and peers, by turns, so that all see the same moods of the machine.

use crate::context::bound_pool;
use crate::prelude::*;
use crate::read::plain_read;

/// Columns of times: the median and the least by the clock with the last number of threads, the least of the processors for the same,
/// the least of the processor with one thread.
pub(crate) const TIME_COLUMNS: &str = "median:s | least:s | processors:s | one thread:s";

/// Times of taut with one number of threads, round by round.
pub(crate) struct Timed {
    pub(crate) threads: usize,
    /// Seconds by the clock.
    pub(crate) wall: Vec<f64>,
    /// Processor seconds of all threads.
    pub(crate) cpu: Vec<f64>,
    /// Seconds of a plain read of the input by these threads, where it was asked for.
    pub(crate) reads: Vec<f64>,
}

/// What a peer did in all rounds.
pub(crate) struct PeerRuns {
    pub(crate) name: String,
    process: Option<Peer>,
    /// Seconds of the solver, round by round.
    pub(crate) seconds: Vec<f64>,
    /// Its last answer.
    pub(crate) answer: Option<Answer>,
    /// Why there is no more.
    pub(crate) silence: Option<Silence>,
}

/// What was found, and how long it took.
pub(crate) struct Rounds<T> {
    /// The last answer of taut.
    pub(crate) found: T,
    /// By number of threads.
    pub(crate) taut: Vec<Timed>,
    pub(crate) peers: Vec<PeerRuns>,
}

/// An answer that has just been found.
pub(crate) enum Seen<'a, T> {
    Ours(&'a T),
    Theirs(&'a str, &'a Answer),
}

/// What takes part beside taut.
#[derive(Clone, Copy, Default)]
pub(crate) struct Opponents<'a> {
    /// Peers by name.
    pub(crate) peers: &'a [&'a str],
    /// The rows that peers read and the number of their columns.
    pub(crate) rows: (&'a [f64], usize),
    /// Memory that is read before each run of taut.
    pub(crate) reads: Option<&'a [u8]>,
}

/// Runs all rounds of `solve`; each answer is shown to `see`, outside the times.
pub(crate) fn run<T: Send>(
    context: &Context,
    runs: usize,
    beside: Opponents<'_>,
    solve: impl Fn() -> Result<T> + Sync,
    mut see: impl FnMut(Seen<'_, T>) -> Result<()>,
) -> Result<Rounds<T>> {
    let timed = |&threads| -> Result<_> {
        // Pools are built once, outside the times: a program of the user's has its pool, too.
        Ok((bound_pool(threads)?, Timed { threads, wall: vec![], cpu: vec![], reads: vec![] }))
    };
    let mut taut = context.threads.iter().map(timed).collect::<Result<Vec<_>>>()?;
    let mut peers = start_peers(context, beside)?;
    let mut found = None;
    for round in 0..runs {
        // Who goes first changes, so that nobody always finds the caches of the other.
        for is_taut in [round % 2 == 0, round % 2 == 1] {
            if !is_taut {
                peers.iter_mut().try_for_each(|peer| peer.once_more(context, &mut see))?;
                continue;
            }
            for (pool, timed) in &mut taut {
                timed.reads.extend(beside.reads.map(|bytes| plain_read(bytes, pool)));
                // Only one answer is held, as with a peer.
                drop(found.take());
                // On a thread of the pool, as with peers in their processes: to wake that thread is no part of a solver.
                let (answer, cost) = pool.install(|| {
                    let meter = Meter::start();
                    let answer = solve();
                    (answer, meter.stop())
                });
                let answer = answer?;
                timed.wall.push(cost.wall);
                timed.cpu.push(cost.cpu);
                see(Seen::Ours(&answer))?;
                found = Some(answer);
            }
        }
    }
    let taut = taut.into_iter().map(|(_, timed)| timed).collect();
    Ok(Rounds { found: found.context("no round")?, taut, peers })
}

fn start_peers(context: &Context, beside: Opponents<'_>) -> Result<Vec<PeerRuns>> {
    let file = context.file("rows");
    if !beside.peers.is_empty() {
        write_rows(&file, beside.rows.0, beside.rows.1)?;
    }
    let start = |name: &&str| -> Result<PeerRuns> {
        let started = Peer::start(name, &file, context.temp.path())?;
        let silence = started.as_ref().err().cloned();
        let process = started.ok();
        Ok(PeerRuns { name: name.to_string(), process, seconds: vec![], answer: None, silence })
    };
    beside.peers.iter().map(start).collect()
}

impl PeerRuns {
    /// Lets the peer solve once more, unless it is gone or has used up its time.
    fn once_more<T>(
        &mut self,
        context: &Context,
        mut see: impl FnMut(Seen<'_, T>) -> Result<()>,
    ) -> Result<()> {
        let used = Duration::from_secs_f64(self.seconds.iter().sum());
        let Some(process) = self.process.as_mut().filter(|_| used <= context.peer_budget) else {
            return Ok(());
        };
        match process.solve(context.limit)? {
            Ok(answer) => {
                see(Seen::Theirs(&self.name, &answer))?;
                self.seconds.push(answer.seconds);
                self.answer = Some(answer);
            }
            Err(silence) => (self.process, self.silence) = (None, Some(silence)),
        }
        Ok(())
    }

    /// Its least seconds.
    pub(crate) fn least(&self) -> Option<f64> {
        least(self.seconds.iter().copied())
    }

    /// Why there is no answer, for a table.
    pub(crate) fn said(&self) -> String {
        self.silence.as_ref().map(Silence::to_string).unwrap_or_default()
    }
}

impl<T> Rounds<T> {
    /// Seconds by the clock with the last number of threads, round by round.
    pub(crate) fn walls(&self) -> &[f64] {
        self.taut.last().map_or(&[], |timed| &timed.wall)
    }

    /// Least seconds by the clock with the last number of threads.
    pub(crate) fn clock(&self) -> Option<f64> {
        least(self.walls().iter().copied())
    }

    /// Least processor seconds of all threads, with the last number of them.
    pub(crate) fn processors(&self) -> Option<f64> {
        least(self.taut.last()?.cpu.iter().copied())
    }

    /// Least processor seconds with one thread.
    pub(crate) fn one_thread(&self) -> Option<f64> {
        least(self.taut.iter().find(|timed| timed.threads == 1)?.cpu.iter().copied())
    }

    /// Cells under [`TIME_COLUMNS`].
    pub(crate) fn cells(&self) -> Value {
        json!({
            "median": Summary::of(self.walls()).map(|times| times.median), "least": self.clock(),
            "processors": self.processors(), "one thread": self.one_thread(),
        })
    }

    /// The only peer.
    pub(crate) fn peer(&self) -> Option<&PeerRuns> {
        self.peers.first()
    }

    /// Least time of a peer over our least time by the clock, and the ratios of the rounds one by one.
    pub(crate) fn faster(&self, peer: &PeerRuns) -> Option<(f64, Summary)> {
        Some((peer.least()? / self.clock()?, Summary::of_ratios(&peer.seconds, self.walls())?))
    }

    /// All times, for the report.
    pub(crate) fn json(&self) -> Value {
        let taut = self.taut.iter().map(|timed| {
            json!({
                "threads": timed.threads, "wall": timed.wall, "cpu": timed.cpu, "plain_reads": timed.reads,
            })
        });
        let peers = self.peers.iter().map(
            |peer| json!({ "name": peer.name, "seconds": peer.seconds, "silence": peer.silence }),
        );
        json!({ "taut": taut.collect::<Value>(), "peers": peers.collect::<Value>() })
    }
}
