//! `taut verify`: judges an answer from the points and its certificate alone.

pub(crate) mod tiles;

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::certify::{Answer, Violation};
use taut::certify::{
    AnyDocument, AnyFileSolution, CentersViolation, CheckError, JsonError, check_simplices,
    with_file_solution, with_solution,
};
use taut::enclose::Error as SolveError;
use taut::points::{Blocks, Scratch};
use taut::{AnySolution, Solution};
use taut_io::{Content, Format, Mesh, open_mesh};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::answer_file;
use crate::input::obstacles::Obstacles;
use crate::input::reading::{Opened, Reading};
use crate::output::files::{self, FileSummary};
use crate::output::writing;
use crate::reports::triangulation::claims_of_triangulation;
use crate::reports::{self, Summary};
use crate::watch::Watch;

/// Check an answer and its certificate against the points, trusting neither.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Columns and the like have to be chosen as for the answer: the certificate knows its points by a hash.
Exit: 0 proved · 1 rejected, with the first violation, or a larger gap than --epsilon ·
      2 bad input or usage
A mesh of simplices (.ply, .obj, .off, .vtu, .parquet) is judged as a Delaunay triangulation, without certificate. A \
sorted or transposed file is judged with the file it was made from, or alone by the hash of the certificate; a sample \
is made from no file. A folder of tiles is judged with its points, within --memory [default: 512M], both of any size.
Example: taut verify ball.json points.csv --epsilon 1e-6")]
pub(crate) struct Args {
    /// The answer, as `taut ball -o`, `taut memory sort --certificate` and their like write it; - is standard input. A folder of
    /// tiles, as `taut delaunay -o FOLDER` writes it
    answer: PathBuf,
    /// The points, in any format of `taut formats`; - is standard input. Of inscribed bodies: the mesh. Of an answer about files: the file that was read,
    /// then the one that was written, or the latter alone
    #[arg(value_name = "POINTS", required = true, num_args = 1..=2)]
    files: Vec<PathBuf>,
    /// Largest relative gap to accept, at least 0 [default: the one the certificate claims]
    #[arg(long, value_name = "REAL", value_parser = epsilon, allow_negative_numbers = true)]
    epsilon: Option<f64>,
    /// Folder for the temporary files of the check of a folder of tiles [default: that of the system]
    #[arg(long, value_name = "FOLDER")]
    scratch: Option<PathBuf>,
    #[command(flatten)]
    obstacles: Obstacles,
    #[command(flatten)]
    reading: Reading,
    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(crate) fn run(&self) -> anyhow::Result<Outcome> {
        let watch = self.effort.start()?;
        if self.answer.is_dir() {
            self.obstacles.refuse()?;
            return self.run_tiles(&watch);
        }
        if self.scratch.is_some() {
            bail!("--scratch belongs to the check of a folder of tiles: leave it out");
        }
        if Format::of_path_for(&self.answer, Content::Triangulation).is_some() {
            self.obstacles.refuse()?;
            return self.run_mesh(&watch);
        }
        let answer = match read_document(&self.answer, &self.files[0])? {
            AnyDocument::Files(found) => {
                self.obstacles.refuse()?;
                return self.run_files(&found, &watch);
            }
            AnyDocument::Points(answer) => *answer,
        };
        let points = self.reading.open_for(self.only_file()?, &self.obstacles, &answer)?;
        let source = points.source();
        let judged = with_solution!(&answer, found => {
            judge(found, &points, &watch)?.map(|verdict| Summary::claims(found, &verdict, source))
        });
        let name = shown(&self.answer);
        // A loose certificate is as true as a tight one: how tight it is belongs to what is said.
        let most = self.epsilon.unwrap_or(f64::INFINITY);
        let (outcome, text) = match judged {
            Err(violation) => rejected(&points.explain_violation(&violation, &name)),
            Ok(claims) => match claims.gap.filter(|&proved| proved > most) {
                Some(proved) => rejected(&too_loose(&name, proved, most)),
                None => (Outcome::Done, claims.text()),
            },
        };
        if !self.effort.quiet {
            writing::print(text.as_bytes())?;
        }
        Ok(outcome)
    }
}

impl Args {
    fn open_points(&self) -> anyhow::Result<Opened> {
        self.reading.open(self.only_file()?)
    }

    /// The one file that an answer about points has.
    fn only_file(&self) -> anyhow::Result<&Path> {
        match &self.files[..] {
            [path] => Ok(path),
            _ => bail!(
                "{} belongs to one file of points: two belong to an answer about files",
                shown(&self.answer)
            ),
        }
    }

    /// Judges a file that was written, beside the one that was read if that is named, too.
    fn run_files(&self, found: &AnyFileSolution, watch: &Watch) -> anyhow::Result<Outcome> {
        if self.epsilon.is_some() {
            bail!("--epsilon belongs to answers with a gap, not to files: leave it out");
        }
        let (input, output) = match &self.files[..] {
            [input, output] => (Some(input.as_path()), output),
            [output] => (None, output),
            _ => bail!("name the file that was written, after the one that was read"),
        };
        let (outcome, text) = match files::judge(found, input, output, watch)? {
            Ok(verdict) => {
                let (what, fields) =
                    with_file_solution!(found, found => FileSummary::claims(found, &verdict));
                (Outcome::Done, reports::text(&format!("Verified: {what}"), &fields))
            }
            Err(violation) => {
                rejected(&files::explain(&violation, input, output, &shown(&self.answer)))
            }
        };
        if !self.effort.quiet {
            writing::print(text.as_bytes())?;
        }
        Ok(outcome)
    }

    /// Judges a folder of tiles.
    fn run_tiles(&self, watch: &Watch) -> anyhow::Result<Outcome> {
        if self.epsilon.is_some() {
            bail!("--epsilon belongs to answers with a gap, not to triangulations: leave it out");
        }
        let memory = self.reading.memory().unwrap_or(tiles::MEMORY_DEFAULT);
        let points = self.reading.beside_work(memory).open_told(self.only_file()?, watch)?;
        let memory = points.memory_left(memory);
        let judged = tiles::judge(&self.answer, &points, memory, self.scratch.as_deref(), watch)?;
        let (outcome, text) = match judged {
            Ok(verdict) => (Outcome::Done, tiles::claims(&verdict).text()),
            Err(why) => rejected(&why),
        };
        if !self.effort.quiet {
            writing::print(text.as_bytes())?;
        }
        Ok(outcome)
    }

    /// Judges the simplices of a file of a mesh, which has no certificate.
    fn run_mesh(&self, watch: &Watch) -> anyhow::Result<Outcome> {
        let mesh = open_mesh(&self.answer, Content::Triangulation, None)?;
        let name = shown(&self.answer);
        let points = self.open_points()?;
        let judged = match other_vertices(&mesh, &name, &points)? {
            Some(problem) => Err(problem),
            None => {
                let check = |monitor: &taut::Monitor<'_>| {
                    check_simplices(points.source(), &mesh.simplices, mesh.width, monitor)
                };
                verdict(watch.during("checking", check), &points)?
                    .map_err(|violation| points.explain_violation(&violation, &name))
            }
        };
        let (outcome, text) = match judged {
            Ok(verdict) => {
                let source = points.source();
                let claims = claims_of_triangulation(&verdict, source.len(), source.dim());
                (Outcome::Done, claims.text())
            }
            Err(why) => rejected(&why),
        };
        if !self.effort.quiet {
            writing::print(text.as_bytes())?;
        }
        Ok(outcome)
    }
}

/// Returns how the vertices of a mesh are not the points, if they are not: ids would then mean something else.
fn other_vertices(mesh: &Mesh, file: &str, points: &Opened) -> anyhow::Result<Option<String>> {
    // Parquet holds ids alone.
    let vertices = &mesh.vertices;
    if vertices.is_empty() {
        return Ok(None);
    }
    let (source, name) = (points.source(), points.name());
    let mine = |problem: String| Ok(Some(format!("{name} does not belong to {file}: {problem}")));
    if vertices.len() as u64 != source.len() {
        return mine(format!("there are {} points, but {} vertices", source.len(), vertices.len()));
    }
    let dim = source.dim().min(3);
    let (blocks, mut scratch) = (Blocks::of(source), Scratch::new());
    let mut row = vec![0.0; source.dim()];
    for block in 0..blocks.count() {
        let range = blocks.range(block);
        let first = range.start as usize;
        let rows = source.read(range, &mut scratch).map_err(|e| points.reading_failed(e))?;
        for i in 0..rows.len() {
            rows.copy_row(i, &mut row);
            if row[..dim] != vertices[first + i][..dim] {
                return mine(format!("vertex {} is another than point {0}", first + i));
            }
        }
    }
    Ok(None)
}

/// The verdict, or the first violation; an error where the points cannot be read.
pub(crate) fn judge<A: Answer>(
    found: &Solution<A>,
    points: &Opened,
    watch: &Watch,
) -> anyhow::Result<Result<A::Verdict, Violation>> {
    let check = |monitor: &taut::Monitor<'_>| {
        found.answer.check(&found.certificate, points.source(), monitor)
    };
    verdict(watch.during("checking", check), points)
}

/// Tells a rejected answer from points that no answer can be judged by.
fn verdict<V>(
    judged: Result<V, CheckError>,
    points: &Opened,
) -> anyhow::Result<Result<V, Violation>> {
    match judged {
        Ok(verdict) => Ok(Ok(verdict)),
        // Points no answer can be judged by are no fault of the answer.
        Err(CheckError::Rejected(Violation::NonFinite { row, column, value })) => {
            Err(points.not_finite(row, column, value))
        }
        Err(CheckError::Rejected(Violation::NegativeRadius { row, value })) => {
            Err(points.explain(SolveError::NegativeRadius { row, value }))
        }
        Err(CheckError::Rejected(Violation::NegativeShape { row })) => {
            Err(points.explain(SolveError::NegativeShape { row }))
        }
        Err(CheckError::Rejected(Violation::Centers(CentersViolation::Weight { row, value }))) => {
            Err(points.explain(SolveError::NonPositiveWeight { row, value }))
        }
        Err(CheckError::Rejected(violation)) => Ok(Err(violation)),
        Err(CheckError::Read(error)) => Err(points.reading_failed(error)),
        Err(error) => Err(error.into()),
    }
}

/// Reads an answer about points; `points` is the other input, as both cannot be standard input.
pub(crate) fn read_answer(path: &Path, points: &Path) -> anyhow::Result<AnySolution> {
    match read_document(path, points)? {
        AnyDocument::Points(answer) => Ok(*answer),
        AnyDocument::Files(_) => bail!("{}: an answer about files, not about points", shown(path)),
    }
}

fn read_document(path: &Path, points: &Path) -> anyhow::Result<AnyDocument> {
    if writing::is_stream(path) && writing::is_stream(points) {
        bail!("only one of answer and points can be standard input: give a file for the other")
    }
    let (name, text) = (shown(path), answer_file::read(path)?);
    AnyDocument::from_json(&text).map_err(|error| match error {
        JsonError::Syntax { .. } => anyhow!("{name}: {error}; {}", answer_file::ORDER),
        error => anyhow!("{name}: {error}"),
    })
}

/// The file of an answer as shown to people.
pub(crate) fn shown(path: &Path) -> String {
    if writing::is_stream(path) { "standard input".into() } else { path.display().to_string() }
}

fn epsilon(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(epsilon) if epsilon >= 0.0 => Ok(epsilon),
        _ => Err("expected a number, at least 0".into()),
    }
}

/// The outcome of an answer that is refused, with the reason.
fn rejected(why: &str) -> (Outcome, String) {
    (Outcome::CheckFailed, format!("Rejected: {}\n", writing::printable(why)))
}

/// All digits: rounded to a few, the gap could look like the one allowed.
fn too_loose(name: &str, proved: f64, most: f64) -> String {
    format!("{name}: a gap of {proved:e} is proved, larger than --epsilon {most:e}")
}
