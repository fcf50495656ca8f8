//! From points to an answer that is checked, written and reported: the same for every subcommand that finds a shape.
//!
//! Output files are checked first, and none takes its name before all are complete: an error leaves earlier files as
//! they were.

use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::{Monitor, Solution};
use taut_io::Format;

use crate::clock::Clock;
use crate::commands::verify::judge;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::{Opened, Reading};
use crate::input::samples::Samples;
use crate::output::picture::{Drawing, Picture, PictureOptions};
use crate::output::writing::{self, Outputs};
use crate::reports::{self, Field, Report, Summary};
use crate::watch::Watch;

/// A subcommand that finds one shape: its input, its solver and its outputs.
pub(crate) trait Find {
    type Answer: Summary;
    /// The data that the solver keeps beside the answer, for outputs of its own.
    type Extra;

    /// The rows, and how they are read.
    fn input(&self) -> Input<'_>;

    /// Describes what the subcommand does with its answer.
    fn output(&self) -> Output<'_>;

    /// The options for samples of curves in place of rings, in subcommands on polygons.
    fn samples(&self) -> Option<&Samples> {
        None
    }

    /// Opens the rows.
    fn open(&self, _watch: &Watch) -> anyhow::Result<Opened> {
        let input = self.input();
        match self.samples() {
            Some(samples) => samples.open(input),
            None => input.reading.open(input.path),
        }
    }

    /// Refuses options that the method does not have.
    fn check_method_options(&self) -> anyhow::Result<()> {
        Ok(())
    }

    /// Refuses options and names of files, before any work.
    fn check_options(&self) -> anyhow::Result<()> {
        self.check_method_options()?;
        if let Some(samples) = self.samples() {
            samples.check(self.output())?;
        }
        self.output().refuse_other_formats(self.input().path)
    }

    /// Files that are written beside `-o` and `--draw`.
    fn side_files(&self) -> Vec<&Path> {
        self.samples().map_or(vec![], Samples::files)
    }

    /// Does all the work in another way, where the points ask for that.
    fn divert(&self, _points: &Opened, _watch: &Watch) -> anyhow::Result<Option<Outcome>> {
        Ok(None)
    }

    /// Finds the shape.
    fn solve(
        &self,
        points: &Opened,
        watch: &Watch,
    ) -> anyhow::Result<(Solution<Self::Answer>, Self::Extra)>;

    /// Fields of the summary beyond those of the answer.
    fn side_fields(&self, _extra: &Self::Extra) -> Vec<Field> {
        Vec::new()
    }

    /// Prepares all files but the picture.
    fn write(
        &self,
        found: &mut Solution<Self::Answer>,
        _extra: &Self::Extra,
        points: &Opened,
        outputs: &mut Outputs,
        _monitor: &Monitor<'_>,
    ) -> anyhow::Result<()> {
        if let Some(samples) = self.samples() {
            samples.write(points, outputs)?;
        }
        match self.output().out {
            Some(out) => outputs.add_json(out, found),
            None => Ok(()),
        }
    }

    /// Returns how the command ends once the answer is written.
    fn outcome(&self, _found: &Solution<Self::Answer>) -> Outcome {
        Outcome::Done
    }
}

/// Where rows come from, and how much effort is spent on them.
#[derive(Clone, Copy)]
pub(crate) struct Input<'a> {
    pub(crate) path: &'a Path,
    pub(crate) reading: &'a Reading,
    pub(crate) effort: &'a Effort,
}

/// The outputs of an answer.
#[derive(Clone, Copy)]
pub(crate) struct Output<'a> {
    pub(crate) no_verify: bool,
    pub(crate) out: Option<&'a Path>,
    pub(crate) json: bool,
    pub(crate) draw: Option<&'a Path>,
}

/// The options of most subcommands for what is done with an answer.
#[derive(Debug, clap::Args)]
pub(crate) struct OutputOptions {
    /// Do without the independent check, which is one more read of all rows
    #[arg(long)]
    no_verify: bool,
    /// Write the answer and its certificate as JSON; - is standard output
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: Option<PathBuf>,
    /// Print the JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    /// Draw the answer with what it was made for; .svg and .png show one picture, .html all
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    draw: Option<PathBuf>,
}

impl OutputOptions {
    pub(crate) fn output(&self) -> Output<'_> {
        Output {
            no_verify: self.no_verify,
            out: self.out.as_deref(),
            json: self.json,
            draw: self.draw.as_deref(),
        }
    }
}

/// Opens, solves, checks, draws, writes and reports.
pub(crate) fn run(command: &impl Find) -> anyhow::Result<Outcome> {
    let (input, output) = (command.input(), command.output());
    command.check_options()?;
    let picture = output.check_files(input.path, &command.side_files())?;
    let watch = input.effort.start()?;
    let mut clock = Clock::start();
    let points = command.open(&watch)?;
    clock.lap("reading");
    if let Some(outcome) = command.divert(&points, &watch)? {
        return Ok(outcome);
    }

    let (mut found, extra) = command.solve(&points, &watch)?;
    clock.lap("solving");

    let Ok(verdict) = check(&found, &points, &watch, output, "")? else {
        return Ok(Outcome::CheckFailed);
    };
    if verdict.is_some() {
        clock.lap("checking");
    }

    let report = Report { found: &found, points: points.source(), verdict };
    let (title, mut fields) = (report.title(), report.fields());
    fields.extend(points.origin());
    fields.extend(command.side_fields(&extra));
    let drawn = match picture {
        Some(picture) => {
            let style = PictureOptions::default();
            let drawn = picture.draw(Drawing::of(&report, &points, &style)?, &style)?;
            clock.lap("drawing");
            Some(drawn)
        }
        None => None,
    };

    let mut outputs = Outputs::default();
    // Watched to the end, so that an interrupt leaves no half of a file.
    watch.during("writing", |monitor| {
        command.write(&mut found, &extra, &points, &mut outputs, monitor)?;
        match (output.draw, &drawn) {
            (Some(path), Some(drawn)) => outputs.add(path, drawn),
            _ => Ok(()),
        }
    })?;
    if !outputs.is_empty() {
        clock.lap("writing");
    }
    let side_files = command.side_files();
    // Where data go to standard output, nothing else does.
    if !output.is_standard_output() && !side_files.into_iter().any(writing::is_stream) {
        if output.json {
            outputs.print(&(found.to_json() + "\n"));
        } else if !input.effort.quiet {
            fields.push(clock.field());
            outputs.print(&reports::text(&title, &fields));
        }
    }
    outputs.finish()?;
    Ok(command.outcome(&found))
}

/// Verifies the answer unless `--no-verify` is given. If the check fails, prints the violation, after words on which answer it
/// is, and returns `Err(Rejected)`.
pub(crate) fn check<A: Summary>(
    found: &Solution<A>,
    points: &Opened,
    watch: &Watch,
    output: Output<'_>,
    which: &str,
) -> anyhow::Result<Result<Option<A::Verdict>, Rejected>> {
    if output.no_verify {
        return Ok(Ok(None));
    }
    match judge(found, points, watch)? {
        Ok(verdict) => Ok(Ok(Some(verdict))),
        Err(violation) => {
            let why = points.explain_violation(&violation, A::FOUND);
            writing::print_error(&format!("the check failed{which}: {why}"));
            Ok(Err(Rejected))
        }
    }
}

/// An answer was rejected, which has been reported.
pub(crate) struct Rejected;

impl<'a> Output<'a> {
    /// Checks that all outputs can be written, and returns the requested picture format.
    pub(crate) fn check_files(
        &self,
        input: &Path,
        others: &[&Path],
    ) -> anyhow::Result<Option<Picture>> {
        let picture = self.draw.map(Picture::of_path).transpose()?;
        let outputs: Vec<&Path> =
            [self.out, self.draw].into_iter().flatten().chain(others.iter().copied()).collect();
        writing::check_writable(&outputs, &[input])?;
        Ok(picture)
    }

    /// Refuses the extension of a picture where JSON is written.
    pub(crate) fn refuse_pictures_as_json(&self) -> anyhow::Result<()> {
        match self.out.filter(|out| Picture::of_path(out).is_ok()) {
            Some(out) => bail!("{}: -o writes JSON; draw with --draw {0}", out.display()),
            None => Ok(()),
        }
    }

    /// Refuses the extension of anything else where JSON is written, except those of plain text. That an output would replace the
    /// input is said first.
    pub(crate) fn refuse_other_formats(&self, input: &Path) -> anyhow::Result<()> {
        self.refuse_pictures_as_json()?;
        let Some(out) = self.out else { return Ok(()) };
        match Format::of_path(out).0 {
            None | Some(Format::Whitespace) => Ok(()),
            Some(format) => {
                writing::check_writable(&[out], &[input])?;
                let name = format.name();
                bail!("{}: -o writes JSON, no {name} file: name it .json", out.display())
            }
        }
    }

    /// Returns true if the answer goes to standard output, where then nothing else does.
    pub(crate) fn is_standard_output(&self) -> bool {
        self.out.is_some_and(writing::is_stream)
    }
}
