//! From points to an answer that is checked, written and told: the same for every subcommand that finds one shape.
//!
//! Places are looked at first, and nothing takes its name before all of it is there: an error leaves earlier files as
//! they were.

use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::enclose::Error as SolveError;
use taut::{Answer, Monitor, Solution};

use crate::clock::Clock;
use crate::effort::Effort;
use crate::picture::{Look, Picture};
use crate::reading::{Opened, Reading};
use crate::report::{self, Report, Tell};
use crate::verify::judge;
use crate::writing::{self, Outputs};

/// What is done with an answer once it is found.
#[derive(Debug, clap::Args)]
pub(crate) struct Delivery {
    /// Do without the independent check, which is one more read of all rows
    #[arg(long)]
    no_verify: bool,
    /// Write the answer and its certificate as JSON; - is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    pub(crate) out: Option<PathBuf>,
    /// Print the JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Draw the answer with what it was made for; .svg and .png show one picture, .html all
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    pub(crate) draw: Option<PathBuf>,
}

/// Where rows come from, and how much effort is spent on them.
pub(crate) struct Desk<'a> {
    pub(crate) path: &'a Path,
    pub(crate) reading: &'a Reading,
    pub(crate) effort: &'a Effort,
}

impl Delivery {
    /// Opens, solves, checks, writes and says; `None` where the check failed, which has been said.
    pub(crate) fn deliver<A: Answer>(
        &self,
        desk: &Desk<'_>,
        solve: impl FnOnce(&Opened, &Monitor<'_>) -> Result<Solution<A>, SolveError>,
    ) -> anyhow::Result<Option<Solution<A>>>
    where
        for<'a> Report<'a, A>: Tell,
    {
        let picture = self.look_at_places(desk.path)?;
        let watch = desk.effort.start()?;
        let mut clock = Clock::start();
        let points = desk.reading.open(desk.path)?;
        clock.lap("reading");

        let found = watch
            .during("solving", |monitor| solve(&points, monitor))
            .map_err(|error| points.explain(error))?;
        clock.lap("solving");

        let mut verdict = None;
        if !self.no_verify {
            match judge(&found, &points, &watch)? {
                Ok(proved) => verdict = Some(proved),
                Err(violation) => {
                    let violation = points.explain_violation(&violation, Report::<A>::FOUND);
                    writing::complain(&format!("the check failed: {violation}"));
                    return Ok(None);
                }
            }
            clock.lap("checking");
        }

        let report = Report { found: &found, points: &points, verdict };
        let drawn = picture
            .map(|picture| picture.draw(report.drawing(&Look::default())?, &Look::default()))
            .transpose()?;

        let mut outputs = Outputs::default();
        let json = || found.to_json() + "\n";
        if let Some(out) = &self.out {
            outputs.add(out, json().as_bytes())?;
        }
        if let (Some(path), Some(drawn)) = (&self.draw, drawn) {
            outputs.add(path, &drawn)?;
        }
        // Where the answer goes to standard output, nothing else does.
        if self.out.as_deref().is_none_or(|out| !writing::is_stream(out)) {
            if self.json {
                outputs.say(&json());
            } else if !desk.effort.quiet {
                let mut facts = report.facts();
                facts.push(clock.fact());
                outputs.say(&report::text(&report.title(), &facts));
            }
        }
        outputs.finish()?;
        Ok(Some(found))
    }

    /// Whether the check is wanted.
    pub(crate) fn is_verified(&self) -> bool {
        !self.no_verify
    }

    /// Refuses what cannot be written, before any work; the kind of picture that is wanted.
    pub(crate) fn look_at_places(&self, input: &Path) -> anyhow::Result<Option<Picture>> {
        let picture = self.draw.as_deref().map(Picture::of_path).transpose()?;
        if let Some(out) = &self.out
            && Picture::of_path(out).is_ok()
        {
            bail!("{}: -o writes JSON; draw with --draw {0}", out.display());
        }
        let outputs: Vec<&Path> =
            [&self.out, &self.draw].into_iter().flatten().map(|path| &**path).collect();
        writing::look_at(&outputs, &[input])?;
        Ok(picture)
    }
}
