//! taut, its peers and a plain read on one input, and what goals ask of their times and answers.

use super::*;
use crate::rounds;

/// What one input gave.
pub(super) struct Paired {
    rounds: Rounds<Solution<Ball>>,
    /// What the checker says of taut's answer, or why it rejects it.
    verdict: Result<Verdict, String>,
    /// The worst that was found of the answers of each peer.
    judgements: Vec<(String, Judgement)>,
}

impl Paired {
    /// Lets taut (with each number of threads), the peers and plain reads take turns.
    pub(super) fn run(context: &Context, input: &Input) -> Result<Self> {
        let (source, peers) = (input.source()?, context.peers);
        let inputs = input.items;
        let options = BallOptions { epsilon: 0.0, inputs, ..BallOptions::default() };
        let solve = || Ok(ball(&*source, &options)?);
        let first = context.pool()?.install(solve)?;
        let verdict = first.check(&*source).map_err(|error| error.to_string());
        // Where our own answer is rejected, peers are judged by what it claims, and the table says so.
        let bracket = verdict.clone().unwrap_or(Verdict {
            lower: first.answer.radius / (1.0 + first.certificate.gap),
            upper: first.answer.radius,
            gap: first.certificate.gap,
        });
        let rows = if peers.is_empty() { (&[][..], 1) } else { input.rows()? };
        let beside = Opponents { peers, rows, reads: Some(input.bytes()) };
        let mut judgements: Vec<(String, Judgement)> = vec![];
        let rounds = rounds::run(context, context.runs, beside, solve, |seen| {
            match seen {
                Seen::Ours(again) => {
                    ensure!(*again == first, "two runs of taut on {} differ", input.what);
                }
                Seen::Theirs(name, answer) => {
                    let this = judge(&*source, inputs, &answer.center, answer.radius, &bracket)?;
                    // The worst of its answers counts.
                    match judgements.iter_mut().find(|(other, _)| other == name) {
                        None => judgements.push((name.to_owned(), this)),
                        Some((_, worst)) if this.is_wrong() || !worst.is_wrong() => *worst = this,
                        Some(_) => {}
                    }
                }
            }
            Ok(())
        })?;
        Ok(Paired { rounds, verdict, judgements })
    }

    fn judgement(&self, peer: &str) -> Option<&Judgement> {
        self.judgements.iter().find(|(name, _)| name == peer).map(|(_, judgement)| judgement)
    }

    /// The fastest of `names` that answered: its name, with a warning if its answer is wrong, and its time over ours.
    fn fastest(&self, names: &[&str]) -> Option<(String, Summary)> {
        let median = |peer: &PeerRuns| Summary::of(&peer.seconds).map(|summary| summary.median);
        let named = self.rounds.peers.iter().filter(|peer| names.contains(&peer.name.as_str()));
        let timed = named.filter_map(|peer| Some((peer, median(peer)?)));
        let (best, _) = timed.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let is_wrong = self.judgement(&best.name).is_some_and(Judgement::is_wrong);
        let note = if is_wrong { ", whose answer is WRONG" } else { "" };
        let ratios = Summary::of_ratios(&best.seconds, self.rounds.walls())?;
        Some((format!("{}{note}", best.name), ratios))
    }

    /// What was measured, as far as `goals` ask for it.
    fn found(&self, goals: [&[Goal]; 2]) -> Found {
        let gap = self.verdict.as_ref().map(|verdict| verdict.gap);
        let mut found = Found::proved(gap.map_err(String::clone));
        let trace = &self.rounds.found.trace;
        if let Ok(verdict) = &self.verdict {
            found.add_with_text(RADIUS, Some((verdict.upper, format!("{:.13}", verdict.upper))));
        }
        found.add_with_text(BUDGET_STOPS, Some(stops(trace.stop)));
        found.add(PASSES, trace.passes as f64);
        found.median(SECONDS, Summary::of(self.rounds.walls()), seconds);
        let reads = self.rounds.taut.last();
        let reads = reads.and_then(|timed| Summary::of_ratios(&timed.wall, &timed.reads));
        found.median(READS, reads, times);
        let walls = |threads: usize| {
            self.rounds.taut.iter().find(|timed| timed.threads == threads).map(|timed| &timed.wall)
        };
        let speedup = walls(1).zip(walls(2)).and_then(|(one, two)| Summary::of_ratios(one, two));
        found.median(SPEEDUP, speedup, times);
        for goal in goals.into_iter().flatten() {
            // Goals that speak of one quantity speak of the same peers: the last of them counts.
            if !goal.peers.is_empty() {
                found.forget(goal.what);
            }
            match goal.what {
                FASTER => {
                    let fastest = self.fastest(goal.peers).map(|(name, ratios)| {
                        (ratios.median, format!("{} against {name}", range(ratios, times)))
                    });
                    found.add_with_text(FASTER, fastest);
                }
                SHARE => {
                    for peer in goal.peers {
                        let share = self.fastest(&[peer]).map(|(name, ratios)| {
                            (1.0 / ratios.median, format!("1 / {} of {name}", range(ratios, times)))
                        });
                        found.add_with_text(SHARE, share);
                    }
                }
                UNEXPLAINED => {
                    for peer in goal.peers {
                        let judged = self.judgement(peer);
                        found.add_with_text(
                            UNEXPLAINED,
                            judged.map(|it| (0.0, format!("{peer} {it}"))),
                        );
                    }
                }
                _ => {}
            }
        }
        found
    }

    /// Prints the table of this input, and judges it by the goals of the section.
    pub(super) fn show(&self, out: &mut Outcome, input: &Input) {
        out.table(&input.what, self.table());
        let trace = &self.rounds.found.trace;
        out.keep("trace", json!(trace));
        out.judge(&self.found(out.lists));
    }

    fn table(&self) -> Table {
        let mut table = Table::new(
            "program | threads | min:s | median:s | max:s | runs | ÷ taut:x | radius:12 | judgement",
        );
        let found = &self.rounds.found;
        let verdict = match &self.verdict {
            Ok(verdict) => format!("gap {:.1e}, verified", verdict.gap),
            Err(reason) => format!("REJECTED: {reason}"),
        };
        let judgement = format!(
            "{verdict}; {} passes, core-set {}, support {}",
            found.trace.passes,
            found.trace.core_set,
            found.certificate.support.len()
        );
        let row = |name: &str, threads: usize, seconds: &[f64]| {
            let time = Summary::of(seconds);
            json!({
                "program": name, "threads": threads, "min": time.map(|s| s.min), "median": time.map(|s| s.median),
                "max": time.map(|s| s.max), "runs": seconds.len(), "seconds": seconds,
                "÷ taut": Summary::of_ratios(seconds, self.rounds.walls()),
            })
        };
        for timed in &self.rounds.taut {
            let said = json!({ "radius": found.answer.radius, "judgement": judgement });
            table.push(joined([row("taut", timed.threads, &timed.wall), said]));
        }
        for timed in &self.rounds.taut {
            table.push(row("plain read", timed.threads, &timed.reads));
        }
        for peer in &self.rounds.peers {
            let judged = self.judgement(&peer.name);
            let said =
                [judged.map(Judgement::to_string), peer.silence.as_ref().map(Silence::to_string)];
            let said = json!({
                "radius": peer.answer.as_ref().map(|answer| answer.radius),
                "judgement": said.into_iter().flatten().collect::<Vec<_>>().join("; "), "judged": judged,
            });
            table.push(joined([row(&peer.name, 1, &peer.seconds), said]));
        }
        table
    }
}
