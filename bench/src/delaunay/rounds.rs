//! Rounds: all programs build the same file by turns, so that what else the machine does meets all alike.

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use anyhow::Result;
use serde_json::{Value, json};

use super::program::{Build, Judged, Program};
use crate::peer::Silence;
use crate::stats::{Summary, seconds, times};
use crate::table::Table;

/// How often, and how long at most.
#[derive(Clone, Copy)]
pub(super) struct Effort {
    /// Rounds.
    pub(super) runs: usize,
    /// Time for one build.
    pub(super) limit: Duration,
    /// Processor time after which a peer takes part in no further round.
    pub(super) peer_budget: Duration,
}

/// What one program did in all rounds.
pub(super) struct Row {
    /// Which.
    pub(super) program: Program,
    builds: Vec<Build>,
    silence: Option<Silence>,
}

/// What all programs did with one input.
pub(super) struct Rounds {
    n: u64,
    rows: Vec<Row>,
    /// The right number of simplices, if anybody knows it.
    reference: Option<u64>,
    /// Cost per point of the same programs for a uniform set of this size.
    uniform: Option<PerPoint>,
}

/// Nanoseconds of processor time per point, by program.
pub(super) type PerPoint = Vec<(Program, f64)>;

/// Lets `programs` build the `n` points in `file` by turns. `known` is the right number of simplices.
pub(super) fn run(
    file: &Path,
    n: u64,
    dim: usize,
    programs: &[Program],
    known: Option<u64>,
    effort: Effort,
) -> Result<Rounds> {
    let start = |&program: &Program| Row { program, builds: Vec::new(), silence: None };
    let mut rows: Vec<Row> = programs.iter().map(start).collect();
    for round in 0..effort.runs {
        // Who follows whom changes, so that nobody always finds the caches of the same one.
        let mut order: Vec<&mut Row> = rows.iter_mut().collect();
        if round % 2 == 1 {
            order.reverse();
        }
        for row in order {
            row.once_more(dim, file, effort)?;
        }
    }
    // Without a known number the exact peers say what is right, and taut has to agree with them.
    let exact = |row: &&Row| matches!(row.program, Program::Peer(_)) && row.program.is_exact();
    let told = || rows.iter().filter(exact).find_map(|row| Some(row.builds.first()?.simplices));
    let reference = known.or_else(told);
    Ok(Rounds { n, rows, reference, uniform: None })
}

impl Row {
    fn once_more(&mut self, dim: usize, file: &Path, effort: Effort) -> Result<()> {
        let used = Duration::from_secs_f64(self.builds.iter().map(|build| build.cpu).sum());
        let is_peer = matches!(self.program, Program::Peer(_));
        if self.silence.is_some() || is_peer && used > effort.peer_budget {
            return Ok(());
        }
        match self.program.build(dim, file, true, effort.limit)? {
            Ok(build) => self.builds.push(build),
            Err(silence) => self.silence = Some(silence),
        }
        Ok(())
    }

    fn of(&self, pick: impl Fn(&Build) -> f64) -> Vec<f64> {
        self.builds.iter().map(pick).collect()
    }

    /// The least processor seconds of its builds.
    fn cpu(&self) -> Option<f64> {
        Summary::of(&self.of(|build| build.cpu)).map(|s| s.min)
    }

    /// The largest peak of its builds, in bytes.
    fn peak(&self) -> Option<u64> {
        self.builds.iter().filter_map(|build| build.peak).max()
    }

    fn exact(&self) -> Option<f64> {
        self.builds.iter().filter_map(|build| build.exact).max_by(f64::total_cmp)
    }

    /// What the checker said of its answers: a rejection if there was one.
    fn judged(&self) -> Option<&Judged> {
        let judged = || self.builds.iter().filter_map(|build| build.judged.as_ref());
        judged().find(|judged| judged.rejected.is_some()).or(judged().next())
    }

    /// The least of these times over the least time of a build.
    fn of_build(&self, time: impl Fn(&Judged) -> f64) -> Option<f64> {
        let times = self.builds.iter().filter_map(|build| build.judged.as_ref()).map(time);
        Some(times.min_by(f64::total_cmp)? / self.cpu()?)
    }

    /// What is to be said of its answers.
    fn judgement(&self, n: u64, reference: Option<u64>) -> String {
        let mut said = Vec::new();
        for build in &self.builds {
            if build.points != n {
                said.push(format!("WRONG: read {} points", build.points));
            }
            match reference {
                Some(right) if build.simplices != right => {
                    said.push(format!(
                        "WRONG by {:+}",
                        build.simplices as i128 - i128::from(right)
                    ));
                }
                _ => {}
            }
        }
        said.sort_unstable();
        said.dedup();
        if said.is_empty() && !self.builds.is_empty() && reference.is_some() {
            said.push("right".to_owned());
        }
        said.extend(self.judged().map(|judged| match &judged.rejected {
            None => "proved".to_owned(),
            Some(why) => format!("REJECTED: {why}"),
        }));
        if !self.program.is_exact() {
            said.push("not exact".to_owned());
        }
        said.extend(self.silence.as_ref().map(Silence::to_string));
        said.join("; ")
    }
}

impl Rounds {
    /// Adds what the programs took for a uniform set of this size.
    pub(super) fn beside(self, uniform: Option<PerPoint>) -> Self {
        Rounds { uniform, ..self }
    }

    /// What each program took per point.
    pub(super) fn per_point(&self) -> PerPoint {
        let cost = |row: &Row| Some((row.program, 1e9 * row.cpu()? / self.n as f64));
        self.rows.iter().filter_map(cost).collect()
    }

    fn row(&self, program: Program) -> Option<&Row> {
        self.rows.iter().find(|row| row.program == program && !row.builds.is_empty())
    }

    /// Least processor time of `program` over that of CGAL, with the range of the ratios round by round.
    pub(super) fn of_cgal(&self, program: Program) -> Option<(f64, Summary)> {
        let (this, cgal) = (self.row(program)?, self.row(super::CGAL)?);
        let range = Summary::of_ratios(&this.of(|build| build.cpu), &cgal.of(|build| build.cpu))?;
        Some((this.cpu()? / cgal.cpu()?, range))
    }

    /// Cost per point of `program` over its own for a uniform set.
    pub(super) fn of_uniform(&self, program: Program) -> Option<f64> {
        let (_, base) = self.uniform.as_ref()?.iter().find(|(other, _)| *other == program)?;
        Some(1e9 * self.row(program)?.cpu()? / self.n as f64 / base)
    }

    /// Largest peak of taut above its input, in bytes per point.
    pub(super) fn bytes(&self, program: Program) -> Option<f64> {
        Some(self.row(program)?.peak()? as f64 / self.n as f64)
    }

    /// The largest share of predicates that no filter decided.
    pub(super) fn exact(&self, program: Program) -> Option<f64> {
        self.row(program)?.exact()
    }

    /// Processor time of the check over that of the build.
    pub(super) fn check(&self, program: Program) -> Option<f64> {
        self.row(program)?.of_build(|judged| judged.check)
    }

    /// The same of the answer in rows of the input, with its certificate.
    fn answer(&self, program: Program) -> Option<f64> {
        self.row(program)?.of_build(|judged| judged.answer)
    }

    /// Wall clock of one thread over that of two, round by round.
    pub(super) fn speedup(&self) -> Option<Summary> {
        let wall = |threads| Some(self.row(Program::Taut(threads))?.of(|build| build.wall));
        Summary::of_ratios(&wall(1)?, &wall(2)?)
    }

    /// Numbers of threads taut was run with.
    pub(super) fn threads(&self) -> Vec<usize> {
        let ours = self.rows.iter().filter(|row| matches!(row.program, Program::Taut(_)));
        ours.map(|row| row.program.threads()).collect()
    }

    /// The table of this input.
    pub(super) fn table(&self) -> Table {
        let mut table = Table::new(&[
            "program",
            "threads",
            "CPU per point",
            "÷ CGAL (range)",
            "÷ uniform",
            "wall",
            "runs",
            "peak per point",
            "simplices",
            "exact stage",
            "answer ÷ build",
            "check ÷ build",
            "judgement",
        ]);
        let text = |value: Option<String>| value.unwrap_or_default();
        for row in &self.rows {
            let program = row.program;
            let wall = Summary::of(&row.of(|build| build.wall));
            table.push(vec![
                row.builds.first().map_or(program.name(), |build| &build.program).to_owned(),
                program.threads().to_string(),
                text(row.cpu().map(|cpu| format!("{:.0} ns", 1e9 * cpu / self.n as f64))),
                text(self.of_cgal(program).map(|(least, range)| {
                    format!("{} ({}–{})", times(least), times(range.min), times(range.max))
                })),
                text(self.of_uniform(program).map(times)),
                text(wall.map(|wall| seconds(wall.min))),
                row.builds.len().to_string(),
                text(self.bytes(program).map(|bytes| format!("{bytes:.0} B"))),
                text(row.builds.first().map(|build| build.simplices.to_string())),
                text(row.exact().map(|share| format!("{share:.1e}"))),
                text(self.answer(program).map(times)),
                text(self.check(program).map(times)),
                row.judgement(self.n, self.reference),
            ]);
        }
        table
    }

    /// Everything, run by run.
    pub(super) fn json(&self) -> Value {
        let rows = self.rows.iter().map(|row| {
            json!({
                "program": row.program.name(),
                "threads": row.program.threads(),
                "builds": row.builds,
                "judgement": row.judgement(self.n, self.reference),
            })
        });
        let uniform = self.uniform.as_ref().map(|base| {
            let named = |(program, cost): &(Program, f64)| {
                (format!("{} {}", program.name(), program.threads()), *cost)
            };
            base.iter().map(named).collect::<BTreeMap<String, f64>>()
        });
        json!({
            "points": self.n,
            "simplices": self.reference,
            "programs": rows.collect::<Value>(),
            "uniform": uniform,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::program::Peer;
    use super::*;

    const SPADE: Program = Program::Peer(Peer::Spade);
    const QHULL: Program = Program::Peer(Peer::Qhull);

    fn row(program: Program, cpu: &[f64], simplices: u64) -> Row {
        let build = |&cpu: &f64| Build {
            program: program.name().to_owned(),
            points: 1000,
            simplices,
            cpu,
            wall: cpu / program.threads() as f64,
            peak: Some(64_000),
            exact: None,
            counters: BTreeMap::new(),
            judged: None,
        };
        Row { program, builds: cpu.iter().map(build).collect(), silence: None }
    }

    fn rounds(rows: Vec<Row>) -> Rounds {
        Rounds { n: 1000, rows, reference: Some(1990), uniform: None }
    }

    #[test]
    fn ratios_are_of_the_least_times_and_ranges_of_each_round() {
        let found = rounds(vec![
            row(super::super::CGAL, &[2e-3, 1e-3], 1990),
            row(Program::Taut(1), &[4e-4, 5e-4], 1990),
            row(Program::Taut(2), &[4e-4, 6e-4], 1990),
        ]);
        let (least, range) = found.of_cgal(Program::Taut(1)).unwrap();
        assert!((least - 0.4).abs() < 1e-12 && (range.min - 0.2).abs() < 1e-12);
        assert!((range.max - 0.5).abs() < 1e-12);
        assert_eq!(found.of_cgal(SPADE).map(|(least, _)| least), None);
        let speedup = found.speedup().unwrap();
        assert!((speedup.max - 2.0).abs() < 1e-12 && (speedup.min - 5.0 / 3.0).abs() < 1e-12);
        assert_eq!((found.bytes(Program::Taut(1)), found.threads()), (Some(64.0), vec![1, 2]));
        assert_eq!(found.of_uniform(Program::Taut(1)), None);
        let found = found.beside(Some(vec![(Program::Taut(1), 800.0)]));
        assert!((found.of_uniform(Program::Taut(1)).unwrap() - 0.5).abs() < 1e-12);
        assert_eq!(found.of_uniform(Program::Taut(2)), None);
    }

    #[test]
    fn a_wrong_number_of_simplices_is_called_so() {
        let judge = |row: Row| row.judgement(1000, Some(1990));
        assert_eq!(judge(row(SPADE, &[1.0, 2.0], 1990)), "right");
        assert_eq!(judge(row(SPADE, &[1.0, 2.0], 1989)), "WRONG by -1");
        assert_eq!(judge(row(QHULL, &[1.0], 1992)), "WRONG by +2; not exact");
        assert_eq!(judge(row(QHULL, &[1.0], 1990)), "right; not exact");
        let mut short = row(SPADE, &[1.0], 1990);
        short.builds[0].points = 999;
        assert_eq!(judge(short), "WRONG: read 999 points");
        let mut ours = row(Program::Taut(1), &[2.0, 1.0], 1990);
        ours.builds[0].judged = Some(Judged { answer: 0.5, check: 0.8, rejected: None });
        assert_eq!(judge(row(Program::Taut(1), &[1.0], 1990)), "right");
        ours.builds[1].simplices = 1991;
        ours.builds[0].judged.as_mut().unwrap().rejected = Some("a dent".to_owned());
        let found = rounds(vec![ours]);
        assert_eq!(found.rows[0].judgement(1000, Some(1990)), "WRONG by +1; REJECTED: a dent");
        // The least time over that of the fastest build.
        assert_eq!(found.check(Program::Taut(1)), Some(0.8));
        assert_eq!(found.answer(Program::Taut(1)), Some(0.5));
        let mut gone = row(SPADE, &[], 0);
        gone.silence = Some(Silence::Ended);
        assert_eq!(judge(gone), "ended without an answer");
        assert_eq!(row(SPADE, &[1.0], 1990).judgement(1000, None), "");
    }
}
