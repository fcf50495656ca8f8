//! Rounds: all programs build the same file by turns, so that what else the machine does meets all alike.

use super::*;

/// What one program did in all rounds.
pub(super) struct Row {
    /// Which.
    program: Program,
    did: Builds,
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
    context: &Context,
    file: &Path,
    n: u64,
    dim: usize,
    programs: &[Program],
    known: Option<u64>,
) -> Result<Rounds> {
    let start = |&program: &Program| Row { program, did: Builds::default() };
    let mut rows: Vec<Row> = programs.iter().map(start).collect();
    by_turns(context.runs, &mut rows, |Row { program, did }| {
        let used = Duration::from_secs_f64(did.builds.iter().map(|build| build.cpu).sum());
        let is_peer = matches!(program, Program::Peer(_));
        if did.silence.is_none() && !(is_peer && used > context.peer_budget) {
            did.keep(program.build(dim, file, true, context.limit)?);
        }
        Ok(())
    })?;
    // Without a known number the exact peers say what is right, and taut has to agree with them.
    let exact = |row: &&Row| matches!(row.program, Program::Peer(_)) && row.program.is_exact();
    let told = || rows.iter().filter(exact).find_map(|row| Some(row.did.builds.first()?.simplices));
    let reference = known.or_else(told);
    Ok(Rounds { n, rows, reference, uniform: None })
}

impl Row {
    fn exact(&self) -> Option<f64> {
        self.did.builds.iter().filter_map(|build| build.exact).max_by(f64::total_cmp)
    }

    /// What the checker said of its answers: a rejection if there was one.
    fn judged(&self) -> Option<&Judged> {
        let judged = || self.did.builds.iter().filter_map(|build| build.judged.as_ref());
        judged().find(|judged| judged.rejected.is_some()).or(judged().next())
    }

    /// The least of these times over the least time of a build.
    fn of_build(&self, time: impl Fn(&Judged) -> f64) -> Option<f64> {
        let times = self.did.builds.iter().filter_map(|build| build.judged.as_ref()).map(time);
        Some(times.min_by(f64::total_cmp)? / self.did.cpu()?)
    }

    /// What is to be said of its answers.
    fn judgement(&self, n: u64, reference: Option<u64>) -> String {
        let mut said = Vec::new();
        for build in &self.did.builds {
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
        if said.is_empty() && !self.did.builds.is_empty() && reference.is_some() {
            said.push("right".to_owned());
        }
        said.extend(self.judged().map(|judged| match &judged.rejected {
            None => "proved".to_owned(),
            Some(why) => format!("REJECTED: {why}"),
        }));
        if !self.program.is_exact() {
            said.push("not exact".to_owned());
        }
        said.extend(self.did.silence.as_ref().map(Silence::to_string));
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
        let cost = |row: &Row| Some((row.program, 1e9 * row.did.cpu()? / self.n as f64));
        self.rows.iter().filter_map(cost).collect()
    }

    fn row(&self, program: Program) -> Option<&Row> {
        self.rows.iter().find(|row| row.program == program && !row.did.builds.is_empty())
    }

    /// Least processor time of `program` over that of CGAL, with the range of the ratios round by round.
    pub(super) fn of_cgal(&self, program: Program) -> Option<(f64, Summary)> {
        let (this, cgal) = (self.row(program)?, self.row(Program::Peer(CGAL))?);
        let range =
            Summary::of_ratios(&this.did.all(|build| build.cpu), &cgal.did.all(|build| build.cpu))?;
        Some((this.did.cpu()? / cgal.did.cpu()?, range))
    }

    /// Cost per point of `program` over its own for a uniform set.
    pub(super) fn of_uniform(&self, program: Program) -> Option<f64> {
        let (_, base) = self.uniform.as_ref()?.iter().find(|(other, _)| *other == program)?;
        Some(1e9 * self.row(program)?.did.cpu()? / self.n as f64 / base)
    }

    /// Largest peak of taut above its input, in bytes per point.
    pub(super) fn bytes(&self, program: Program) -> Option<f64> {
        self.row(program)?.did.bytes_per_point()
    }

    /// Wall clock of one thread over that of two, round by round.
    pub(super) fn speedup(&self) -> Option<Summary> {
        let wall = |threads| Some(self.row(Program::Taut(threads))?.did.all(|build| build.wall));
        Summary::of_ratios(&wall(1)?, &wall(2)?)
    }

    /// Numbers of threads taut was run with.
    pub(super) fn threads(&self) -> Vec<usize> {
        let ours = self.rows.iter().filter(|row| matches!(row.program, Program::Taut(_)));
        ours.map(|row| row.program.threads()).collect()
    }

    /// The table of this input, with everything run by run.
    pub(super) fn table(&self) -> Table {
        let mut table = Table::new(
            "program | threads | CPU per point:ns | ÷ CGAL:x | by rounds:x | ÷ uniform:x | \
                wall:s | runs | peak per point:0 | simplices | exact stage:e | answer ÷ build:x | check ÷ build:x | judgement",
        );
        for row in &self.rows {
            let (program, first) = (row.program, row.did.builds.first());
            let (of_cgal, by_rounds) = self.of_cgal(program).unzip();
            table.push(json!({
                "program": first.map_or(program.name(), |build| &build.program), "threads": program.threads(),
                "CPU per point": row.did.cpu().map(|cpu| cpu / self.n as f64), "÷ CGAL": of_cgal,
                "by rounds": by_rounds, "÷ uniform": self.of_uniform(program), "wall": row.did.wall(),
                "runs": row.did.builds.len(), "peak per point": self.bytes(program),
                "simplices": first.map(|build| build.simplices), "exact stage": row.exact(),
                "answer ÷ build": row.of_build(|judged| judged.answer),
                "check ÷ build": row.of_build(|judged| judged.check),
                "judgement": row.judgement(self.n, self.reference), "builds": row.did.builds,
            }));
        }
        table
    }

    /// What the programs took for a uniform set, for the report.
    pub(super) fn json(&self) -> Value {
        let uniform = self.uniform.as_ref().map(|base| {
            let named = |(program, cost): &(Program, f64)| {
                (format!("{} {}", program.name(), program.threads()), *cost)
            };
            base.iter().map(named).collect::<BTreeMap<String, f64>>()
        });
        json!({ "points": self.n, "simplices": self.reference, "uniform": uniform })
    }
}

impl Rounds {
    /// What goals ask for. Builds that are not right are left out by the rounds themselves.
    pub(super) fn found(&self) -> Found {
        let one = Program::Taut(1);
        let mut found = Found::default();
        found.add_with_text(
            OF_CGAL,
            self.of_cgal(one).map(|(least, rounds)| {
                (least, format!("{}; by rounds {}", times(least), range(rounds, times)))
            }),
        );
        found.add(OF_UNIFORM, self.of_uniform(one));
        for threads in self.threads() {
            found.add(BYTES, self.bytes(Program::Taut(threads)));
        }
        let row = self.row(one);
        found.add(EXACT_RATE, row.and_then(Row::exact));
        found.add(CHECK, row.and_then(|row| row.of_build(|judged| judged.check)));
        found.median(SPEEDUP, self.speedup(), times);
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let builds = cpu.iter().map(build).collect();
        Row { program, did: Builds { builds, silence: None } }
    }

    fn rounds(rows: Vec<Row>) -> Rounds {
        Rounds { n: 1000, rows, reference: Some(1990), uniform: None }
    }

    #[test]
    fn ratios_are_of_the_least_times_and_ranges_of_each_round() {
        let found = rounds(vec![
            row(Program::Peer(CGAL), &[2e-3, 1e-3], 1990),
            row(Program::Taut(1), &[4e-4, 5e-4], 1990),
            row(Program::Taut(2), &[4e-4, 6e-4], 1990),
        ]);
        let (least, range) = found.of_cgal(Program::Taut(1)).unwrap();
        assert!((least - 0.4).abs() < 1e-12 && (range.min - 0.2).abs() < 1e-12);
        assert!((range.max - 0.5).abs() < 1e-12);
        assert_eq!(found.of_cgal(Program::Peer(SPADE)).map(|(least, _)| least), None);
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
        assert_eq!(judge(row(Program::Peer(SPADE), &[1.0, 2.0], 1990)), "right");
        assert_eq!(judge(row(Program::Peer(SPADE), &[1.0, 2.0], 1989)), "WRONG by -1");
        assert_eq!(judge(row(Program::Peer(QHULL), &[1.0], 1992)), "WRONG by +2; not exact");
        assert_eq!(judge(row(Program::Peer(QHULL), &[1.0], 1990)), "right; not exact");
        let mut short = row(Program::Peer(SPADE), &[1.0], 1990);
        short.did.builds[0].points = 999;
        assert_eq!(judge(short), "WRONG: read 999 points");
        let mut ours = row(Program::Taut(1), &[2.0, 1.0], 1990);
        ours.did.builds[0].judged = Some(Judged { answer: 0.5, check: 0.8, rejected: None });
        assert_eq!(judge(row(Program::Taut(1), &[1.0], 1990)), "right");
        ours.did.builds[1].simplices = 1991;
        ours.did.builds[0].judged.as_mut().unwrap().rejected = Some("a dent".to_owned());
        let found = rounds(vec![ours]);
        assert_eq!(found.rows[0].judgement(1000, Some(1990)), "WRONG by +1; REJECTED: a dent");
        // The least time over that of the fastest build.
        assert_eq!(found.rows[0].of_build(|judged| judged.check), Some(0.8));
        assert_eq!(found.rows[0].of_build(|judged| judged.answer), Some(0.5));
        let mut gone = row(Program::Peer(SPADE), &[], 0);
        gone.did.silence = Some(Silence::Ended);
        assert_eq!(judge(gone), "ended without an answer");
        assert_eq!(row(Program::Peer(SPADE), &[1.0], 1990).judgement(1000, None), "");
    }
}
