//! `taut verify`: judges an answer from the points and its certificate alone.

pub(crate) mod mesh;
pub(crate) mod tiles;

use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use serde_json::{Value, json};
use taut::certify::{Answer, Violation};
use taut::certify::{
    AnyDocument, AnyFileSolution, CentersViolation, CheckError, JsonError, ReadingChoice,
    with_file_solution, with_solution,
};
use taut::enclose::Error as SolveError;
use taut::{AnySolution, Solution};

use self::mesh::{MeshOnPoints, is_mesh};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::answer_file;
use crate::input::obstacles::Obstacles;
use crate::input::reading::{Opened, Reading};
use crate::output::files::{self, FileSummary};
use crate::output::writing;
use crate::reports::{self, Claims, Summary};
use crate::watch::Watch;

/// Check an answer and its certificate against the points, trusting neither.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Columns and the like have to be chosen as for the answer: the certificate knows its points by a hash.
Exit: 0 proved · 1 rejected, with the first violation, or a larger gap than --epsilon ·
      2 bad input or usage
A mesh (.ply, .obj, .off, .stl, .vtu, .parquet) has no certificate and is judged for what it is: triangles in space as a \
surface, with its topology, whether it meets itself and whether its triangles have empty balls; other simplices as the \
Delaunay triangulation. Its points are those of the second file, or else its vertices. A \
sorted or transposed file is judged with the file it was made from, or alone by the hash of the certificate; a sample \
is made from no file. A folder of tiles is judged with its points, within --memory [default: 512M], both of any size.
Example: taut verify ball.json points.csv --epsilon 1e-6
         taut verify mesh.ply points.csv")]
pub(crate) struct Args {
    /// The answer, as `taut ball -o`, `taut memory sort --certificate` and their like write it; - is standard input. A folder of
    /// tiles, as `taut delaunay -o FOLDER` writes it
    answer: PathBuf,
    /// The points, in any format of `taut formats`; - is standard input. Of inscribed bodies: the mesh. Of an answer about files: the file that was read,
    /// then the one that was written, or the latter alone. Of a mesh: by default its vertices
    #[arg(value_name = "POINTS", num_args = 0..=2)]
    files: Vec<PathBuf>,
    /// Largest relative gap to accept, at least 0 [default: the one the certificate claims]
    #[arg(long, value_name = "REAL", value_parser = epsilon, allow_negative_numbers = true)]
    epsilon: Option<f64>,
    /// Print the verdict as JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
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
        if is_mesh(&self.answer) {
            self.obstacles.refuse()?;
            return self.run_mesh(&watch);
        }
        let Some(first) = self.files.first() else {
            bail!("name the points after {}: only meshes are judged alone", shown(&self.answer));
        };
        let (document, choice) = read_document(&self.answer, first)?;
        let answer = match document {
            AnyDocument::Files(found) => {
                self.obstacles.refuse()?;
                return self.run_files(&found, &watch);
            }
            AnyDocument::Points(answer) => *answer,
        };
        let reading = self.reading.as_for(choice.as_ref());
        let reading = reading.map_err(|error| anyhow!("{}: {error}", shown(&self.answer)))?;
        let points = reading.open_for(self.only_file()?, &self.obstacles, &answer)?;
        let source = points.source();
        let judged = with_solution!(&answer, found => {
            judge(found, &points, &watch)?.map(|verdict| {
                let claims = Summary::claims(found, &verdict, source);
                (claims, serde_json::to_value(verdict))
            })
        });
        let name = shown(&self.answer);
        // A loose certificate is as true as a tight one: how tight it is belongs to what is said.
        let most = self.epsilon.unwrap_or(f64::INFINITY);
        self.print_judgment(match judged {
            Err(violation) => Judgment::rejected(&points.explain_violation(&violation, &name)),
            Ok((mut claims, verdict)) => match claims.gap.filter(|&proved| proved > most) {
                Some(proved) => Judgment::rejected(&too_loose(&name, proved, most)),
                None => {
                    claims.fields.extend(points.notes());
                    Judgment::proved(&claims, answer.kind(), verdict?)
                }
            },
        })
    }
}

impl Args {
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
        self.print_judgment(match files::judge(found, input, output, watch)? {
            Ok(verdict) => {
                let (what, fields) =
                    with_file_solution!(found, found => FileSummary::claims(found, &verdict));
                let claims = Claims { what, gap: None, fields };
                Judgment::proved(&claims, found.kind(), serde_json::to_value(verdict)?)
            }
            Err(violation) => {
                let answer = shown(&self.answer);
                Judgment::rejected(&files::explain(&violation, input, output, &answer))
            }
        })
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
        self.print_judgment(match judged {
            Ok(verdict) => {
                let proved = serde_json::to_value(verdict)?;
                Judgment::proved(&tiles::claims(&verdict), "tiles", proved)
            }
            Err(why) => Judgment::rejected(&why),
        })
    }

    /// Judges a file of a mesh, which has no certificate.
    fn run_mesh(&self, watch: &Watch) -> anyhow::Result<Outcome> {
        if self.epsilon.is_some() {
            bail!("--epsilon belongs to answers with a gap, not to meshes: leave it out");
        }
        let points = match &self.files[..] {
            [] => None,
            _ => Some(self.only_file()?.to_owned()),
        };
        let mesh = MeshOnPoints::open(&self.answer, points.as_ref(), &self.reading)?;
        self.print_judgment(match mesh.judge(watch)? {
            Ok(judged) => {
                let (mut claims, doubt) = judged.claims(&mesh.points);
                claims.fields.extend(mesh.points.notes());
                match doubt {
                    None => Judgment::proved(&claims, judged.kind(), judged.to_json()?),
                    Some(doubt) => {
                        let why = format!("{}: {doubt}", shown(&self.answer));
                        let mut rejected = Judgment::rejected(&why);
                        rejected.text += &reports::text(&claims.what, &claims.fields);
                        rejected.json["verdict"] = judged.to_json()?;
                        rejected
                    }
                }
            }
            Err(why) => Judgment::rejected(&why),
        })
    }

    /// Says what was found, in words or as JSON.
    fn print_judgment(&self, judgment: Judgment) -> anyhow::Result<Outcome> {
        match (self.json, self.effort.quiet) {
            (true, _) => writing::print(format!("{:#}\n", judgment.json).as_bytes())?,
            (false, true) => {}
            (false, false) => writing::print(judgment.text.as_bytes())?,
        }
        Ok(judgment.outcome)
    }
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
pub(crate) fn read_answer(
    path: &Path,
    points: &Path,
) -> anyhow::Result<(AnySolution, Option<ReadingChoice>)> {
    match read_document(path, points)? {
        (AnyDocument::Points(answer), choice) => Ok((*answer, choice)),
        (AnyDocument::Files(_), _) => {
            bail!("{}: an answer about files, not about points", shown(path))
        }
    }
}

/// Reads an answer, and how the points that it is about were read.
fn read_document(
    path: &Path,
    points: &Path,
) -> anyhow::Result<(AnyDocument, Option<ReadingChoice>)> {
    if writing::is_stream(path) && writing::is_stream(points) {
        bail!("only one of answer and points can be standard input: give a file for the other")
    }
    let (name, text) = (shown(path), answer_file::read(path)?);
    let refused = |error| match error {
        JsonError::Syntax { .. } => anyhow!("{name}: {error}; {}", answer_file::ORDER),
        error => anyhow!("{name}: {error}"),
    };
    let document = AnyDocument::from_json(&text).map_err(refused)?;
    Ok((document, ReadingChoice::of_json(&text).map_err(refused)?))
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

/// How an answer was judged, in words and as JSON.
struct Judgment {
    outcome: Outcome,
    text: String,
    json: Value,
}

impl Judgment {
    /// Of an answer that is so, with the verdict as all languages have it.
    fn proved(claims: &Claims, kind: &str, verdict: Value) -> Self {
        let json = json!({
            "verified": true, "kind": kind, "what": claims.what, "gap": claims.gap, "verdict": verdict
        });
        Judgment { outcome: Outcome::Done, text: claims.text(), json }
    }

    /// Of an answer that is refused, with the reason.
    fn rejected(why: &str) -> Self {
        Judgment {
            outcome: Outcome::CheckFailed,
            text: format!("Rejected: {}\n", writing::printable(why)),
            json: json!({ "verified": false, "reason": why }),
        }
    }
}

/// All digits: rounded to a few, the gap could look like the one allowed.
fn too_loose(name: &str, proved: f64, most: f64) -> String {
    format!("{name}: a gap of {proved:e} is proved, larger than --epsilon {most:e}")
}
