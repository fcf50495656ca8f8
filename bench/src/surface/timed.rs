//! Times of taut and of CGAL's advancing front on the same points, by turns, each run in a process of its own.
//!
//! *Idea.* CGAL tells its Delaunay triangulation and its extraction apart. Of taut the triangulation is timed in a process of its own
//! as well, on as many threads, and the extraction is what the whole takes beyond that: least less least.

use super::*;

/// What is timed, in the order of the first round.
#[derive(Clone, Copy, PartialEq)]
enum Work {
    /// taut with so many threads.
    Whole(usize),
    /// taut's triangulation with so many threads.
    Delaunay(usize),
    Cgal,
}

/// What was timed on one input.
pub(super) struct Timed {
    threads: usize,
    ours: Vec<(Work, Builds)>,
    /// Seconds of CGAL's triangulation and extraction.
    theirs: Vec<[f64; 2]>,
    /// Why CGAL gave no answer.
    silence: Option<Silence>,
}

impl Timed {
    /// Lets all take turns, forwards and backwards.
    pub(super) fn by_turns(context: &Context, points: &[Point]) -> Result<Self> {
        let file = context.file("points.f64");
        write_raw(&file, points.as_flattened())?;
        let threads = context.last_threads();
        let mut timed = Timed { threads, ours: vec![], theirs: vec![], silence: None };
        let works = [
            Work::Whole(threads),
            Work::Delaunay(threads),
            Work::Whole(1),
            Work::Delaunay(1),
            Work::Cgal,
        ];
        let mut all = works.map(|work| (work, Builds::default()));
        by_turns(context.runs, &mut all, |(work, builds)| {
            match *work {
                Work::Whole(threads) => {
                    builds.keep(one::alone(threads, &file, context.limit)?);
                }
                Work::Delaunay(threads) => {
                    builds.keep(Program::Taut(threads).build(3, &file, false, context.limit)?);
                }
                // A peer that gave no answer is not asked again.
                Work::Cgal if timed.silence.is_some() => {}
                Work::Cgal => match theirs(context, FRONT, points)? {
                    Ok(found) => timed.theirs.push([found.first, found.second]),
                    Err(silence) => timed.silence = Some(silence),
                },
            }
            Ok(())
        })?;
        timed.ours = all.into();
        Ok(timed)
    }

    /// The least seconds of taut.
    fn least(&self, work: Work) -> Option<f64> {
        self.ours.iter().find(|(other, _)| *other == work)?.1.wall()
    }

    /// Seconds of taut's extraction: what the whole takes beyond the triangulation.
    fn extraction(&self, threads: usize) -> Option<f64> {
        Some(self.least(Work::Whole(threads))? - self.least(Work::Delaunay(threads))?)
    }

    /// The least seconds of CGAL's triangulation, of its extraction, and of both together.
    fn cgal(&self) -> [Option<f64>; 3] {
        let of: [fn(&[f64; 2]) -> f64; 3] = [|t| t[0], |t| t[1], |t| t[0] + t[1]];
        of.map(|of| least(self.theirs.iter().map(of)))
    }

    /// taut's total, its extraction on one thread and on all, each over CGAL's, which knows one.
    pub(super) fn ratios(&self) -> [Option<f64>; 3] {
        let over = |ours: Option<f64>, theirs: Option<f64>| Some(ours? / theirs?);
        let [_, extraction, total] = self.cgal();
        let [on_one, on_all] = [1, self.threads].map(|threads| self.extraction(threads));
        let whole = self.least(Work::Whole(self.threads));
        [over(whole, total), over(on_one, extraction), over(on_all, extraction)]
    }

    /// Columns of [`Self::cells`]. Without other word, on one thread.
    pub(super) const COLUMNS: &'static str = "all threads:s | extraction on all:s | one thread:s \
        | Delaunay:s | extraction:s | CGAL Delaunay:s | CGAL extraction:s | all threads / CGAL:x | extraction / CGAL:x | why";

    /// Times and ratios, for a table.
    pub(super) fn cells(&self) -> Value {
        let [their_delaunay, their_extraction, _] = self.cgal();
        let [total, extraction, _] = self.ratios();
        let silent = self.ours.iter().find_map(|(_, builds)| builds.silence.as_ref());
        let builds: Vec<&Builds> = self.ours.iter().map(|(_, builds)| builds).collect();
        json!({
            "all threads": self.least(Work::Whole(self.threads)), "one thread": self.least(Work::Whole(1)),
            "extraction on all": self.extraction(self.threads), "extraction": self.extraction(1),
            "Delaunay": self.least(Work::Delaunay(1)), "CGAL Delaunay": their_delaunay,
            "CGAL extraction": their_extraction, "all threads / CGAL": total,
            "extraction / CGAL": extraction, "why": silent.or(self.silence.as_ref()),
            "builds": builds, "CGAL": self.theirs,
        })
    }
}
