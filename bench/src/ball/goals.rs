//! What a case has to reach, and whether it did.

use serde_json::{Value, json};
use taut_certify::{Stop, Verdict};

use super::paired::Paired;
use crate::stats::{Summary, seconds, times};

/// One thing to reach.
#[derive(Clone, Copy)]
pub(super) enum Goal {
    /// The verified gap is at most this.
    Gap(f64),
    /// The radius is this.
    Radius {
        /// What it is.
        value: f64,
        /// How far off it may be.
        tolerance: f64,
    },
    /// The radius is √d / 2 to 1e-12, relative.
    HalfDiagonal,
    /// The solver says that it converged: no budget was used up.
    Converged,
    /// The median time is at most this, in seconds.
    Seconds(f64),
    /// So many reads of all points at most.
    Passes(u64),
    /// The median time is at most so many plain reads of the same memory.
    Reads(f64),
    /// At least so many times faster than the fastest of these peers.
    FasterThan {
        /// Builds of one peer.
        peers: &'static [&'static str],
        /// How many times.
        times: f64,
    },
    /// At most this share of the time of each of these peers.
    ShareOf {
        /// The peers.
        peers: &'static [&'static str],
        /// The share.
        share: f64,
    },
    /// Each of these peers gave the ball we proved, or what is wrong with its own is shown.
    Judged {
        /// The peers.
        peers: &'static [&'static str],
    },
    /// Peak memory of the solving process is at most this, in bytes.
    PeakMemory(u64),
    /// Each pass runs at least at this share of the speed of `cat`.
    ShareOfCat(f64),
}

/// What was measured of one input, as far as goals ask for it.
#[derive(Default)]
pub(super) struct Measured<'a> {
    /// Verified by the checker; `None` when it rejected the answer.
    pub(super) verdict: Option<Verdict>,
    /// Dimension of the space.
    pub(super) dim: usize,
    /// Reads of all points.
    pub(super) passes: u64,
    /// Why the solver stopped.
    pub(super) stop: Stop,
    /// Times of taut, and of peers and plain reads beside it.
    pub(super) paired: Option<&'a Paired>,
    /// Peak memory, bytes.
    pub(super) peak: Option<u64>,
    /// Speed of passes over speed of `cat`.
    pub(super) of_cat: Option<Summary>,
}

impl Goal {
    /// The goal in words, what was measured, and whether the goal is met (`None`: not measured).
    fn judge(self, found: &Measured<'_>) -> (String, String, Option<bool>) {
        let spread = |s: Summary| {
            format!(
                "{} (range {}–{}, {} runs)",
                times(s.median),
                times(s.min),
                times(s.max),
                s.count
            )
        };
        let radius = found.verdict.map(|verdict| verdict.upper);
        match self {
            Goal::Gap(bound) => (
                format!("gap ≤ {bound:e}"),
                found.verdict.map_or("rejected by the checker".into(), |v| {
                    format!("{:.1e}, verified", v.gap)
                }),
                Some(found.verdict.is_some_and(|v| v.gap <= bound)),
            ),
            Goal::Radius { value, tolerance } => (
                format!("radius {value} ± {tolerance:e}"),
                radius.map_or("none".into(), |r| format!("{r:.12}")),
                Some(radius.is_some_and(|r| (r - value).abs() <= tolerance)),
            ),
            Goal::HalfDiagonal => {
                let value = 0.5 * (found.dim as f64).sqrt();
                (
                    format!("radius √{} / 2 = {value:.13} to 1e-12", found.dim),
                    radius.map_or("none".into(), |r| {
                        format!("{r:.13}, {:+.1e} off", r / value - 1.0)
                    }),
                    Some(radius.is_some_and(|r| (r / value - 1.0).abs() <= 1e-12)),
                )
            }
            Goal::Converged => (
                "no cap reached".into(),
                format!("{:?}", found.stop).to_lowercase(),
                Some(found.stop == Stop::Converged),
            ),
            Goal::Seconds(bound) => {
                let time = found.paired.and_then(Paired::taut_time);
                (
                    format!("at most {}", seconds(bound)),
                    time.map_or("none".into(), |s| {
                        format!(
                            "{} (range {}–{}, {} runs)",
                            seconds(s.median),
                            seconds(s.min),
                            seconds(s.max),
                            s.count
                        )
                    }),
                    time.map(|s| s.median <= bound),
                )
            }
            Goal::Passes(bound) => (
                format!("at most {bound} passes"),
                found.passes.to_string(),
                Some(found.passes <= bound),
            ),
            Goal::Reads(bound) => {
                let reads = found.paired.and_then(Paired::reads);
                (
                    format!("at most {bound} plain reads"),
                    reads.map_or("none".into(), spread),
                    reads.map(|s| s.median <= bound),
                )
            }
            Goal::FasterThan { peers, times: bound } => {
                let best = found.paired.and_then(|paired| paired.fastest(peers));
                (
                    format!("{bound}× faster than {}", peers.join(" and ")),
                    best.as_ref().map_or("no peer answered".into(), |(name, s, note)| {
                        format!(
                            "{}× (range {}–{}, {} runs) against {name}{note}",
                            times(s.median),
                            times(s.min),
                            times(s.max),
                            s.count
                        )
                    }),
                    best.map(|(_, s, _)| s.median >= bound),
                )
            }
            Goal::ShareOf { peers, share } => {
                let all: Vec<(String, Summary, String)> = peers
                    .iter()
                    .filter_map(|peer| found.paired.and_then(|paired| paired.fastest(&[peer])))
                    .collect();
                let said = all.iter().map(|(name, s, note)| {
                    format!(
                        "1/{} (range 1/{}–1/{}, {} runs) of {name}{note}",
                        times(s.median),
                        times(s.max),
                        times(s.min),
                        s.count
                    )
                });
                let said = said.collect::<Vec<_>>().join("; ");
                (
                    format!("at most {:.2} of the time of {}", share, peers.join(" and ")),
                    if said.is_empty() { "no peer answered".into() } else { said },
                    (!all.is_empty()).then(|| all.iter().all(|(_, s, _)| 1.0 / s.median <= share)),
                )
            }
            Goal::Judged { peers } => {
                let all = found.paired.map_or(Vec::new(), |paired| paired.judgements(peers));
                let said = all.iter().map(|(name, judgement)| format!("{name} {judgement}"));
                let said = said.collect::<Vec<_>>().join("; ");
                (
                    format!(
                        "{} inside our certified bracket, or shown to be wrong",
                        peers.join(" and ")
                    ),
                    if said.is_empty() { "no peer answered".into() } else { said },
                    (!all.is_empty()).then_some(true),
                )
            }
            Goal::PeakMemory(bound) => (
                format!("peak memory at most {} MiB", bound >> 20),
                found.peak.map_or("not measured".into(), |peak| {
                    format!("{:.0} MiB", peak as f64 / f64::from(1 << 20))
                }),
                found.peak.map(|peak| peak <= bound),
            ),
            Goal::ShareOfCat(share) => (
                format!("each pass at ≥ {:.0} % of the speed of cat", 100.0 * share),
                found.of_cat.map_or("not measured".into(), |s| {
                    format!("slowest pass {:.0} %, median {:.0} %", 100.0 * s.min, 100.0 * s.median)
                }),
                found.of_cat.map(|s| s.min >= share),
            ),
        }
    }
}

/// Prints each goal with what was measured, and returns the same for the report.
pub(super) fn print(must: &[Goal], aim: &[Goal], found: &Measured<'_>) -> Value {
    let all = must.iter().map(|goal| ("must", goal)).chain(aim.iter().map(|goal| ("aim", goal)));
    let lines = all.map(|(kind, goal)| {
        let (goal, measured, met) = goal.judge(found);
        let word = match met {
            Some(true) => "met",
            Some(false) => "NOT MET",
            None => "not measured",
        };
        println!("- {kind}: {goal}: {measured}: {word}");
        json!({ "kind": kind, "goal": goal, "measured": measured, "met": met })
    });
    lines.collect()
}
