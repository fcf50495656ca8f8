//! `taut memory sort`: a file of records in order, within a limit on memory, with a certificate.

use std::ops::Range;
use std::path::PathBuf;

use taut::certify::AnyFileSolution;
use taut::files::sorted;
use taut::oblivious::external::{
    FileSort, FileSortOptions, KeyKind, RecordLayout, sort_file_pending,
};

use super::key;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::size;
use crate::output::files::{Proof, are_files};
use crate::output::writing;

/// Sort a file of records of fixed width by their key, which may be larger than memory.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
Records with equal keys keep their order. Before it takes its name the output is read again and proved to be in order \
and to hold the records that were read, by a hash of 128 bits of all of them; `taut verify` reads the input once more, \
too. Without --checkpoint nothing is left behind, however the process ends; with it the input must be the same file, \
unchanged.
Exit: 0 done · 1 the check failed, nothing written · 2 bad input or usage, nothing written
Example: taut memory sort records.bin --item-bytes 32 --sort-key 0:8 --kind u64 -o sorted.bin \\
             --certificate sorted.json
         taut verify sorted.json records.bin sorted.bin")]
pub(super) struct Args {
    /// The records, one after the other
    input: PathBuf,
    /// Where to write them
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Bytes of a record, at least 1
    #[arg(long = "item-bytes", alias = "width", value_name = "BYTES")]
    width: usize,
    /// The bytes of a record that are the key, as START:END [default: the first eight; of --kind bytes all]
    #[arg(long = "sort-key", alias = "key", value_name = "RANGE", value_parser = key::parse)]
    key: Option<Range<usize>>,
    /// The type of the key: numbers have the least significant byte first
    #[arg(long, value_enum, default_value = "u64")]
    kind: Kind,
    /// Most memory to use for records
    #[arg(long, value_name = "SIZE", value_parser = size::parse, default_value = "256M")]
    memory: u64,
    /// Folder for what does not fit in memory [default: that of the output]
    #[arg(long, value_name = "FOLDER")]
    scratch: Option<PathBuf>,
    /// Keep what was done in this file until the output is there; go on from it if it is there
    #[arg(long = "checkpoint", alias = "resume", value_name = "FILE", conflicts_with = "scratch")]
    resume: Option<PathBuf>,
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
        let layout = self.layout();
        let memory = usize::try_from(self.memory).unwrap_or(usize::MAX);
        let options =
            FileSortOptions { memory, scratch: self.scratch.clone(), resume: self.resume.clone() };
        are_files(&[&self.input, &self.out])?;
        self.proof.look_at(&self.out, &[&self.input])?;
        let watch = self.effort.start()?;
        let written = watch.during("sorting", |monitor| {
            sort_file_pending(&self.input, &self.out, &layout, &options, monitor)
        })?;
        let found = written.found.clone();
        let solution = AnyFileSolution::Sort(sorted(&layout, &found));
        let outcome = self.proof.finish(&solution, written, &self.out, &watch)?;
        if outcome != Outcome::Done {
            return Ok(outcome);
        }
        if !self.effort.quiet {
            writing::print(self.summary(&layout, &found).as_bytes())?;
        }
        Ok(Outcome::Done)
    }

    fn layout(&self) -> RecordLayout {
        let kind = match self.kind {
            Kind::U64 => KeyKind::U64,
            Kind::I64 => KeyKind::I64,
            Kind::F64 => KeyKind::F64,
            Kind::Bytes => KeyKind::Bytes,
        };
        let usual = if self.kind == Kind::Bytes { 0..self.width } else { 0..8 };
        RecordLayout { width: self.width, key: self.key.clone().unwrap_or(usual), kind }
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
