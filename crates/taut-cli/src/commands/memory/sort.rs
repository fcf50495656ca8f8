//! `taut memory sort`: a file of records in order, within a limit on memory, with a certificate.

use std::ops::Range;
use std::path::PathBuf;

use anyhow::{anyhow, bail};
use taut::certify::AnyFileSolution;
use taut::files::sorted;
use taut::oblivious::Error;
use taut::oblivious::external::{
    FileSort, FileSortOptions, KeyKind, RecordLayout, sort_file_pending,
};
use taut_io::{Format, NpyArray};

use super::{is_npy, key};
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::reading::wrong_option;
use crate::input::size;
use crate::output::files::{Proof, are_files};
use crate::output::writing;

/// Sort a file of records of fixed width by their key, which may be larger than memory.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
An .npy file says itself what it holds: its rows are sorted by their first number, or by all their bytes where they hold bytes, and \
the output is one of the same shape. Another \
file holds records of --item-bytes from its first byte on.
Records with equal keys keep their order. Before it takes its name the output is read again and proved to be in order \
and to hold the records that were read, by a hash of 128 bits of all of them; `taut verify` reads the input once more, \
too. Without --checkpoint nothing is left behind, however the process ends; with it the input must be the same file, \
unchanged.
Exit: 0 done · 1 the check failed, nothing written · 2 bad input or usage, nothing written
Example: taut memory sort records.bin --item-bytes 32 --sort-key 0:8 --kind u64 -o sorted.bin \\
             --certificate sorted.json
         taut verify sorted.json records.bin sorted.bin
         taut memory sort points.npy -o sorted.npy")]
pub(super) struct Args {
    /// The records, one after the other
    input: PathBuf,
    /// Where to write them
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: PathBuf,
    /// Bytes of a record, at least 1 [default: those of a row of an .npy file]
    #[arg(long = "item-bytes", alias = "width", value_name = "BYTES")]
    width: Option<usize>,
    /// The bytes of a record that are the key, as START:END [default: the first eight; of --kind bytes all]
    #[arg(long = "sort-key", alias = "key", value_name = "RANGE", value_parser = key::parse)]
    key: Option<Range<usize>>,
    /// The type of the key: numbers have the least significant byte first [default: u64, or as the .npy file says]
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// Most memory to use for records
    #[arg(long, value_name = "SIZE", value_parser = size::parse, default_value = "256M")]
    memory: u64,
    /// Folder for what does not fit in memory [default: that of the output]
    #[arg(long, value_name = "FOLDER")]
    scratch: Option<PathBuf>,
    /// Keep what was done in this file until the output is there; go on from it if it is there
    #[arg(long = "checkpoint", alias = "resume", value_name = "FILE", conflicts_with = "scratch")]
    resume: Option<PathBuf>,
    /// Print what the file is said to be and its certificate as JSON instead of the summary
    #[arg(long, help_heading = "Writing")]
    json: bool,
    #[command(flatten)]
    proof: Proof,

    #[command(flatten)]
    effort: Effort,
}

/// The way in which a key is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Kind {
    /// unsigned integers of 64 bits
    U64,
    /// signed integers of 64 bits
    I64,
    /// doubles, in total order: NaN comes last or, if negative, first
    F64,
    /// bytes, compared from the first one on
    Bytes,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        are_files(&[&self.input, &self.out])?;
        self.proof.look_at(&self.out, &[&self.input])?;
        let (layout, header) = match is_npy(&self.input) {
            true => self.npy()?,
            false => (self.raw()?, 0),
        };
        let memory = usize::try_from(self.memory).unwrap_or(usize::MAX);
        let (scratch, resume) = (self.scratch.clone(), self.resume.clone());
        let options = FileSortOptions { memory, scratch, resume, header };
        let watch = self.effort.start()?;
        let written = watch.during("sorting", |monitor| {
            sort_file_pending(&self.input, &self.out, &layout, &options, monitor)
        });
        let written = written.map_err(explain)?;
        let found = written.found.clone();
        let solution = AnyFileSolution::Sort(sorted(&layout, &found));
        let outcome = self.proof.finish(&solution, written, &self.out, &watch)?;
        if outcome != Outcome::Done {
            return Ok(outcome);
        }
        match (self.json, self.effort.quiet) {
            (true, _) => writing::print((solution.to_json() + "\n").as_bytes())?,
            (false, true) => {}
            (false, false) => writing::print(self.summary(&layout, &found).as_bytes())?,
        }
        Ok(Outcome::Done)
    }

    fn raw(&self) -> anyhow::Result<RecordLayout> {
        let name = self.input.display();
        if let Some(format @ (Format::Parquet | Format::Arrow)) = Format::of_path(&self.input).0 {
            bail!(
                "{name}: {format} has columns, not records: make an .npy file of it with taut convert {name} -o FILE.npy"
            );
        }
        if is_npy(&self.out) {
            bail!(
                "{}: the records of a raw file have no header: name it otherwise",
                self.out.display()
            );
        }
        let width = self.width.ok_or_else(|| {
            anyhow!(
                "{name}: this is no .npy file: say how long a record is with --item-bytes BYTES"
            )
        })?;
        Ok(self.layout(width, self.kind.unwrap_or(Kind::U64)))
    }

    /// Rows of an array as records, and the bytes before them.
    fn npy(&self) -> anyhow::Result<(RecordLayout, u64)> {
        let array = NpyArray::open(&self.input)?;
        let name = self.input.display();
        if self.width.is_some() {
            bail!(
                "--item-bytes belongs to raw files: {name} says itself what it holds; leave it out"
            );
        }
        if !is_npy(&self.out) {
            bail!("{}: the rows of an .npy file make one: name it .npy", self.out.display());
        }
        let row = match &array.shape[..] {
            [] => bail!("{name} is a single number: rows are sorted"),
            [_, others @ ..] if array.fortran && !others.is_empty() => bail!(
                "{name}: its elements lie column by column (Fortran order): write rows with numpy.ascontiguousarray"
            ),
            [_, others @ ..] => others,
        };
        let width = row.iter().try_fold(array.width, |width, &axis| {
            usize::try_from(axis).ok().and_then(|axis| width.checked_mul(axis))
        });
        let width = width
            .filter(|&width| width > 0)
            .ok_or_else(|| anyhow!("{name}: its rows have no bytes, or too many"))?;
        let kind = match (self.kind, &*array.dtype) {
            (Some(kind), _) => kind,
            (None, "<f8") => Kind::F64,
            (None, "<i8") => Kind::I64,
            (None, "<u8") => Kind::U64,
            (None, "|u1") => Kind::Bytes,
            (None, text) if text.starts_with("|S") => Kind::Bytes,
            (None, other) => bail!(
                "{name}: rows of type {other} have no order here; there is one for <f8, <i8, <u8, |u1 and |S: convert it, or say what \
                 the bytes of the key are with --kind"
            ),
        };
        Ok((self.layout(width, kind), array.offset))
    }

    fn layout(&self, width: usize, kind: Kind) -> RecordLayout {
        let usual = if kind == Kind::Bytes { 0..width } else { 0..8 };
        let kind = match kind {
            Kind::U64 => KeyKind::U64,
            Kind::I64 => KeyKind::I64,
            Kind::F64 => KeyKind::F64,
            Kind::Bytes => KeyKind::Bytes,
        };
        RecordLayout { width, key: self.key.clone().unwrap_or(usual), kind }
    }

    fn summary(&self, layout: &RecordLayout, found: &FileSort) -> String {
        let records = found.certificate.records;
        let bytes = records * layout.width as u64;
        let moved = found.bytes_read + found.bytes_written;
        let times = if bytes == 0 { 0.0 } else { moved as f64 / bytes as f64 };
        let checked = match self.proof.no_verify {
            true => "not read again",
            false => "read again: in order, and by the hash the records that were read",
        };
        format!(
            "{records} records of {} bytes in order of bytes {} to {}\n\
             runs            {} ({} of an earlier process)\n\
             bytes read      {}\n\
             bytes written   {}, {times:.3} × the file with those read\n\
             hash            {:032x}\n\
             output          {checked}\n",
            layout.width,
            layout.key.start,
            layout.key.end - 1,
            found.runs,
            found.runs_resumed,
            found.bytes_read,
            found.bytes_written,
            found.certificate.hash,
        )
    }
}

/// The error with options by their names on the command line.
fn explain(error: Error) -> anyhow::Error {
    match error {
        Error::Option { name, value, expected } => {
            let name = match name {
                "width" => "item-bytes",
                "key" => "sort-key",
                "resume" => "checkpoint",
                other => other,
            };
            wrong_option(name, &value, expected)
        }
        other => other.into(),
    }
}
