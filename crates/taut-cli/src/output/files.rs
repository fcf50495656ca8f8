//! Answers about files: judged beside the file that was read, told, and their certificates written.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::certify::{
    AnyFileSolution, Data, DrawnSample, FileAnswer, FileCheckError, FileSolution, FileVerdict,
    FileViolation, Files, KeyKind, SortedFile, TransposedFile, WhichFile,
};
use taut::oblivious::Pending;

use crate::exit::Outcome;
use crate::output::numbers::{count, counted};
use crate::output::writing::{self, Outputs};
use crate::reports::Field;
use crate::watch::Watch;

/// Where the certificate of a file goes.
#[derive(Clone, Debug, clap::Args)]
pub(crate) struct Proof {
    /// Write what the file is said to be and its certificate as JSON, for `taut verify`
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    pub(crate) certificate: Option<PathBuf>,
    /// Do without the independent check, which reads the output again
    #[arg(long)]
    pub(crate) no_verify: bool,
}

impl Proof {
    /// Refuses places that cannot be written.
    pub(crate) fn look_at(&self, out: &Path, inputs: &[&Path]) -> anyhow::Result<()> {
        let outputs: Vec<&Path> =
            [Some(out), self.certificate.as_deref()].into_iter().flatten().collect();
        writing::check_writable(&outputs, inputs)
    }

    /// Checks a file that has not its name yet, unless that is not wanted, then gives it and its certificate theirs.
    pub(crate) fn finish<R>(
        &self,
        found: &AnyFileSolution,
        mut written: Pending<R>,
        out: &Path,
        watch: &Watch,
    ) -> anyhow::Result<Outcome> {
        if !self.no_verify
            && let Err(violation) = judge_open(found, (None, out), None, written.file(), watch)?
        {
            let why = explain(&violation, None, out, "the certificate");
            writing::print_error(&format!("the check failed: {why}; {AS_IT_WAS}"));
            return Ok(Outcome::CheckFailed);
        }
        publish(written, self.certificate.as_deref(), found)?;
        Ok(Outcome::Done)
    }
}

/// Said of outputs whose check failed.
pub(crate) const AS_IT_WAS: &str = "nothing was written";

/// Gives a file its name, and then its certificate; if that cannot be written, neither.
pub(crate) fn publish<R>(
    written: Pending<R>,
    certificate: Option<&Path>,
    found: &AnyFileSolution,
) -> anyhow::Result<()> {
    let mut outputs = Outputs::default();
    if let Some(path) = certificate {
        outputs.add(path, (found.to_json() + "\n").as_bytes())?;
    }
    outputs.finish_after(|| Ok(written.publish().map(drop)?))
}

/// The verdict on a file, or the first violation; an error where a file cannot be read.
pub(crate) fn judge(
    found: &AnyFileSolution,
    input: Option<&Path>,
    output: &Path,
    watch: &Watch,
) -> anyhow::Result<Result<FileVerdict, FileViolation>> {
    let mut read = input.map(opened).transpose()?;
    let mut written = opened(output)?;
    judge_open(found, (input, output), read.as_mut(), &mut written, watch)
}

/// The same of files that are open, with their names.
fn judge_open(
    found: &AnyFileSolution,
    (input, output): (Option<&Path>, &Path),
    read: Option<&mut File>,
    written: &mut File,
    watch: &Watch,
) -> anyhow::Result<Result<FileVerdict, FileViolation>> {
    let judged = watch.during("checking", |monitor| {
        let input = read.map(|file| file as &mut dyn Data);
        found.check(Files { input, output: written }, monitor)
    });
    match judged {
        Ok(verdict) => Ok(Ok(verdict)),
        Err(FileCheckError::Rejected(violation)) => Ok(Err(violation)),
        Err(error @ FileCheckError::NoInput) => {
            Err(anyhow!("{}: {error}", shown(WhichFile::Input, input, output)))
        }
        Err(FileCheckError::Read { file, source }) => {
            let name = shown(file, input, output);
            Err(anyhow!("{name}: reading failed: {source}"))
        }
        Err(error) => Err(error.into()),
    }
}

/// Refuses standard input and output where files are read and written at many places.
pub(crate) fn are_files(paths: &[&Path]) -> anyhow::Result<()> {
    match paths.iter().any(|path| writing::is_stream(path)) {
        true => Err(anyhow!("- cannot be read or written at many places: name a file")),
        false => Ok(()),
    }
}

pub(crate) fn opened(path: &Path) -> anyhow::Result<File> {
    let name = path.display();
    let failed = |source| taut_io::Error::reading(&name.to_string(), source);
    // A pipe has no place to go back to, and to open one is to wait until somebody writes to it.
    if !fs::metadata(path).map_err(failed)?.is_file() {
        bail!("{name} is not a regular file: answers about files are judged from files");
    }
    Ok(File::open(path).map_err(failed)?)
}

/// A violation with the names of the files.
pub(crate) fn explain(
    violation: &FileViolation,
    input: Option<&Path>,
    output: &Path,
    answer: &str,
) -> String {
    let said = violation.to_string();
    if let FileViolation::Number { .. } = violation {
        return format!("{answer}: {said}");
    }
    [WhichFile::Input, WhichFile::Output]
        .into_iter()
        .fold(said, |said, file| said.replace(&file.to_string(), &shown(file, input, output)))
}

fn shown(file: WhichFile, input: Option<&Path>, output: &Path) -> String {
    match (file, input) {
        (WhichFile::Input, Some(input)) => input.display().to_string(),
        (WhichFile::Input, None) => "the input".to_owned(),
        (WhichFile::Output, _) => output.display().to_string(),
    }
}

pub(crate) trait FileSummary: FileAnswer + Sized {
    /// Returns what was proved, in one line, and the fields.
    fn claims(found: &FileSolution<Self>, verdict: &FileVerdict) -> (String, Vec<Field>);
}

const BY_HASH: &str = "by a hash of 128 bits, which other content has by chance only";

impl FileSummary for SortedFile {
    fn claims(found: &FileSolution<Self>, verdict: &FileVerdict) -> (String, Vec<Field>) {
        let [start, end] = found.answer.key;
        let kind = match found.answer.key_kind {
            KeyKind::U64 => "u64",
            KeyKind::I64 => "i64",
            KeyKind::F64 => "f64",
            KeyKind::Bytes => "bytes",
        };
        let title = format!(
            "{} of {} bytes in order",
            counted(verdict.items, "record"),
            count(found.answer.width)
        );
        let key = format!("bytes {start} to {}, as {kind}", end.saturating_sub(1));
        let records = match verdict.compared {
            true => "those of the input",
            false => "those of the certificate",
        };
        let mut fields = vec![
            Field::proved("key", key).remark("no key is below the one before it"),
            Field::proved("records", records).remark(BY_HASH),
            Field::new("equal keys", "order not proved"),
        ];
        if found.answer.header > 0 {
            let header = counted(found.answer.header, "byte");
            fields.insert(2, Field::proved("header", header).remark("as it was, by the same hash"));
        }
        (title, fields)
    }
}

impl FileSummary for TransposedFile {
    fn claims(found: &FileSolution<Self>, verdict: &FileVerdict) -> (String, Vec<Field>) {
        let (rows, columns) = (count(found.answer.columns), count(found.answer.rows));
        let title = format!("{rows} × {columns}, the transpose");
        let elements = match verdict.compared {
            true => Field::proved("elements", count(verdict.items))
                .remark("each compared with the one of the input"),
            false => Field::proved("elements", count(verdict.items)).remark(BY_HASH),
        };
        let mut fields = vec![elements];
        let [input, output] = [found.answer.input_offset, found.answer.output_offset];
        if found.answer.dtype.is_none() && input.max(output) > 0 {
            let begin =
                format!("byte {} of the input, {} of the output", count(input), count(output));
            fields.push(
                Field::new("from", begin).remark("what comes before is judged in .npy files only"),
            );
        }
        (title, fields)
    }
}

impl FileSummary for DrawnSample {
    fn claims(found: &FileSolution<Self>, verdict: &FileVerdict) -> (String, Vec<Field>) {
        let of = count(found.answer.of);
        let title = format!("{} of {of}", counted(verdict.items, "number"));
        let seed = Field::proved("seed", found.certificate.seed.to_string())
            .remark("each number was drawn again: different, in order, in range");
        (title, vec![seed])
    }
}
