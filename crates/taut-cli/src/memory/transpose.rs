//! `taut memory transpose`: the transpose of a matrix in a file, within a limit on memory, checked.

use std::path::PathBuf;

use taut::oblivious::{
    FileCheck, FileMatrix, TransposeFileOptions, check_transposed_file, transpose_file,
};

use crate::effort::Effort;
use crate::exit::Outcome;
use crate::{size, writing};

/// Transpose a matrix in a file, which may be larger than memory.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
The file holds the elements row by row, after --offset bytes of something else, which are left out. Both files are read
again from end to end and compared, unless --samples says how many elements will do.
Example: taut memory transpose matrix.bin --rows 1000000 --columns 300 --width 8 -o columns.bin")]
pub(super) struct Args {
    /// The matrix
    input: PathBuf,
    /// Where to write its transpose
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Rows of the matrix
    #[arg(long, value_name = "N")]
    rows: u64,
    /// Columns of the matrix
    #[arg(long, value_name = "N")]
    columns: u64,
    /// Bytes of an element, at least 1
    #[arg(long, value_name = "BYTES", default_value_t = 8)]
    width: usize,
    /// Bytes of the file before the first element
    #[arg(long, value_name = "BYTES", default_value_t = 0)]
    offset: u64,
    /// Most memory to use for elements
    #[arg(long, value_name = "SIZE", value_parser = size::parse, default_value = "256M")]
    memory: u64,
    /// Compare so many elements, drawn at random, rather than all; 0 compares none
    #[arg(long, value_name = "N")]
    samples: Option<u64>,
    /// Chooses the elements that are compared
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,

    #[command(flatten)]
    effort: Effort,
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        let Self { rows, columns, width, offset, .. } = *self;
        let matrix = FileMatrix { rows, columns, width, offset };
        let memory = usize::try_from(self.memory).unwrap_or(usize::MAX);
        let options = TransposeFileOptions { memory };
        writing::look_at(&[&self.out], &[&self.input])?;
        let watch = self.effort.start()?;
        let found = watch.during("transposing", |monitor| {
            transpose_file(&self.input, matrix, &self.out, &[], &options, monitor)
        })?;
        let check = match self.samples {
            None => FileCheck::Whole,
            Some(elements) => FileCheck::Sample { elements, seed: self.seed },
        };
        if self.samples != Some(0) {
            let checked = watch.during("checking", |monitor| {
                check_transposed_file(&self.input, matrix, &self.out, 0, check, monitor)
            });
            if !super::holds(checked)? {
                return Ok(Outcome::CheckFailed);
            }
        }
        if !self.effort.quiet {
            let compared = match self.samples {
                None => "all elements".to_owned(),
                Some(elements) => format!("{elements} elements"),
            };
            let said = format!(
                "{columns} × {rows} elements of {width} bytes\n\
                 bytes read      {}\n\
                 bytes written   {}\n\
                 tiles           {}\n\
                 compared        {compared}\n",
                found.bytes_read, found.bytes_written, found.tiles,
            );
            writing::say(said.as_bytes())?;
        }
        Ok(Outcome::Done)
    }
}
