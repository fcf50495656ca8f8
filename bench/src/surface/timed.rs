//! Times of taut and of CGAL's advancing front on the same points, by turns, each run in a process of its own.
//!
//! *Idea.* CGAL tells its Delaunay triangulation and its extraction apart. Of taut the triangulation is timed in a process of its own
//! as well, on as many threads, and the extraction is what the whole takes beyond that: least less least.

use anyhow::Result;
use serde_json::{Value, json};

use super::found::{Way, theirs};
use super::one;
use super::samples::Point;
use crate::context::Context;
use crate::delaunay::program::{Build, Program};
use crate::input::write_raw;
use crate::peer::Silence;
use crate::stats::{seconds, times};

/// What is timed, in the order of the first round.
#[derive(Clone, Copy)]
enum Run {
    Whole,
    Single,
    Delaunay,
    SingleDelaunay,
    Cgal,
}

/// What was timed on one input.
#[derive(Default)]
pub(super) struct Timed {
    /// taut with all threads that were asked for.
    pub(super) whole: Vec<Build>,
    /// taut on one thread.
    single: Vec<Build>,
    /// taut's triangulation with all threads that were asked for.
    delaunay: Vec<Build>,
    /// taut's triangulation on one thread.
    single_delaunay: Vec<Build>,
    /// Triangulation and extraction of CGAL.
    theirs: Vec<[f64; 2]>,
    /// Why somebody gave no answer.
    pub(super) silence: Option<Silence>,
}

impl Timed {
    /// Lets all take turns, forwards and backwards.
    pub(super) fn by_turns(context: &Context, points: &[Point]) -> Result<Self> {
        let file = context.temp.path().join("points.f64");
        write_raw(&file, points.as_flattened())?;
        let mut timed = Timed::default();
        for round in 0..context.runs {
            let mut order =
                [Run::Whole, Run::Delaunay, Run::Single, Run::SingleDelaunay, Run::Cgal];
            if round % 2 == 1 {
                order.reverse();
            }
            for run in order {
                let said = match run {
                    Run::Whole => one::alone(context.threads[0], &file, context.limit)?
                        .map(|build| timed.whole.push(build)),
                    Run::Single => {
                        one::alone(1, &file, context.limit)?.map(|build| timed.single.push(build))
                    }
                    Run::Delaunay => Program::Taut(context.threads[0])
                        .build(3, &file, false, context.limit)?
                        .map(|build| timed.delaunay.push(build)),
                    Run::SingleDelaunay => Program::Taut(1)
                        .build(3, &file, false, context.limit)?
                        .map(|build| timed.single_delaunay.push(build)),
                    // A peer that gave no answer is not asked again.
                    Run::Cgal if timed.theirs.len() < round => Ok(()),
                    Run::Cgal => theirs(context, Way::Front, points)?
                        .map(|found| timed.theirs.push([found.first, found.second])),
                };
                timed.silence = timed.silence.or(said.err());
            }
        }
        Ok(timed)
    }

    /// Seconds of taut with all threads.
    pub(super) fn total(&self) -> Option<f64> {
        least(&self.whole)
    }

    /// Seconds of taut's extraction on one thread.
    pub(super) fn extraction(&self) -> Option<f64> {
        Some(least(&self.single)? - least(&self.single_delaunay)?)
    }

    /// Seconds of taut's extraction with all threads.
    fn extraction_on_all(&self) -> Option<f64> {
        Some(self.total()? - least(&self.delaunay)?)
    }

    /// Seconds of CGAL.
    fn their_total(&self) -> Option<f64> {
        self.theirs.iter().map(|[first, second]| first + second).min_by(f64::total_cmp)
    }

    /// Seconds of CGAL's extraction.
    fn their_extraction(&self) -> Option<f64> {
        self.theirs.iter().map(|theirs| theirs[1]).min_by(f64::total_cmp)
    }

    /// taut's total over CGAL's.
    pub(super) fn total_ratio(&self) -> Option<f64> {
        Some(self.total()? / self.their_total()?)
    }

    /// taut's extraction over CGAL's.
    pub(super) fn extraction_ratio(&self) -> Option<f64> {
        Some(self.extraction()? / self.their_extraction()?)
    }

    /// taut's extraction with all threads over CGAL's, which knows one.
    pub(super) fn extraction_ratio_on_all(&self) -> Option<f64> {
        Some(self.extraction_on_all()? / self.their_extraction()?)
    }

    /// Names of [`Self::cells`]. Without other word, on one thread.
    pub(super) const HEAD: [&'static str; 9] = [
        "all threads",
        "extraction on all",
        "one thread",
        "Delaunay",
        "extraction",
        "CGAL Delaunay",
        "CGAL extraction",
        "all threads / CGAL",
        "extraction / CGAL",
    ];

    /// Times and ratios, for a table.
    pub(super) fn cells(&self) -> Vec<String> {
        let their_delaunay = self.theirs.iter().map(|theirs| theirs[0]).min_by(f64::total_cmp);
        let all = [
            self.total(),
            self.extraction_on_all(),
            least(&self.single),
            least(&self.single_delaunay),
            self.extraction(),
            their_delaunay,
            self.their_extraction(),
        ];
        let ratios = [self.total_ratio(), self.extraction_ratio()];
        let show = |value: Option<f64>, show: fn(f64) -> String| value.map_or("–".to_owned(), show);
        let cells = all.map(|value| show(value, seconds)).into_iter();
        cells.chain(ratios.map(|value| show(value, times))).collect()
    }

    /// For the report.
    pub(super) fn json(&self) -> Value {
        json!({
            "whole": self.whole, "single": self.single, "delaunay": self.delaunay,
            "single_delaunay": self.single_delaunay, "cgal": self.theirs,
            "silence": self.silence.as_ref().map(ToString::to_string),
        })
    }
}

/// The least time by the clock.
fn least(builds: &[Build]) -> Option<f64> {
    builds.iter().map(|build| build.wall).min_by(f64::total_cmp)
}
