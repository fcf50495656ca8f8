//! `taut memory transpose`: the transpose of a matrix in a file, within a limit on memory, checked.

use std::path::{Path, PathBuf};

use anyhow::bail;
use taut::certify::{AnyFileSolution, FileCheckError, Files, TransposedFile};
use taut::files::{StoredMatrix, transposed};
use taut::oblivious::{
    Error, FileMatrix, FileTransposition, Pending, TransposeFileOptions, check_transposed_samples,
    transpose_file_pending,
};
use taut_io::NpyArray;

use super::is_npy;
use crate::effort::Effort;
use crate::exit::Outcome;
use crate::input::size;
use crate::output::files::{AS_IT_WAS, are_files, explain, opened, publish};
use crate::output::writing;
use crate::watch::Watch;

/// Transpose a matrix in a file, .npy or raw, which may be larger than memory.
#[derive(Debug, clap::Args)]
#[command(after_help = "\
An .npy file says itself what it holds: elements of any fixed width, in C or Fortran order; its transpose is one in C \
order. Another file holds the elements row by row, after --raw-offset bytes of something else, which are left out. Before \
the output takes its name both files are read again from end to end and compared; with --compare only so many elements \
are, once the output is there.
Exit: 0 done · 1 the check failed, nothing written (but with --compare) ·
      2 bad input or usage, nothing written
Example: taut memory transpose matrix.npy -o columns.npy --certificate columns.json
         taut verify columns.json matrix.npy columns.npy
         taut memory transpose a.bin --row-count 1000 --column-count 300 --item-bytes 8 -o b.bin")]
pub(super) struct Args {
    /// The matrix
    input: PathBuf,
    /// Where to write its transpose
    #[arg(short, long, value_name = "FILE", help_heading = "Writing")]
    out: PathBuf,
    /// Rows of the matrix, unless it is .npy
    #[arg(long = "row-count", alias = "rows", value_name = "N")]
    rows: Option<u64>,
    /// Columns of the matrix, unless it is .npy
    #[arg(long = "column-count", alias = "columns", value_name = "N")]
    columns: Option<u64>,
    /// Bytes of an element, at least 1 [default: 8, or as the .npy file says]
    #[arg(long = "item-bytes", alias = "width", value_name = "BYTES")]
    width: Option<usize>,
    /// Bytes of the file before the first element [default: 0, or as the .npy file says]
    #[arg(long = "raw-offset", alias = "offset", value_name = "BYTES")]
    offset: Option<u64>,
    /// Most memory to use for elements
    #[arg(long, value_name = "SIZE", value_parser = size::parse, default_value = "256M")]
    memory: u64,
    /// Compare so many elements, drawn at random, rather than all; 0 compares none
    #[arg(long = "compare", alias = "samples", value_name = "N", conflicts_with = "certificate")]
    samples: Option<u64>,
    /// Chooses the elements that are compared
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Write what the file is said to be and its certificate as JSON, for `taut verify`
    #[arg(long, value_name = "FILE", help_heading = "Writing")]
    certificate: Option<PathBuf>,

    #[command(flatten)]
    effort: Effort,
}

/// The task: the answer, where its elements lie as rows, and the header of the output.
struct Job {
    answer: TransposedFile,
    matrix: FileMatrix,
    header: Vec<u8>,
}

impl Job {
    fn of(stored: &StoredMatrix, header: Vec<u8>) -> Self {
        let answer = stored.transpose(header.len() as u64);
        Self { answer, matrix: stored.matrix(), header }
    }
}

impl Args {
    pub(super) fn run(&self) -> anyhow::Result<Outcome> {
        are_files(&[&self.input, &self.out])?;
        let places = [Some(self.out.as_path()), self.certificate.as_deref()];
        let places: Vec<&Path> = places.into_iter().flatten().collect();
        writing::check_writable(&places, &[&self.input])?;
        let job = match is_npy(&self.input) {
            true => self.npy()?,
            false => self.raw()?,
        };
        let memory = usize::try_from(self.memory).unwrap_or(usize::MAX);
        let options = TransposeFileOptions { memory };
        let watch = self.effort.start()?;
        let written = watch.during("transposing", |monitor| {
            let (header, memory) = (&job.header, &options);
            transpose_file_pending(&self.input, job.matrix, &self.out, header, memory, monitor)
        })?;
        let found = written.found;
        let outcome = match self.samples {
            None => self.compare(&job.answer, written, &watch)?,
            Some(elements) => {
                written.publish()?;
                self.sample(&job, elements, &watch)?
            }
        };
        if outcome == Outcome::Done && !self.effort.quiet {
            writing::print(self.summary(&job.answer, &found).as_bytes())?;
        }
        Ok(outcome)
    }

    fn raw(&self) -> anyhow::Result<Job> {
        let (Some(rows), Some(columns)) = (self.rows, self.columns) else {
            bail!(
                "{}: this is no .npy file: say what it holds with --row-count N and --column-count N",
                self.input.display()
            );
        };
        if is_npy(&self.out) {
            let name = self.out.display();
            bail!(
                "{name}: the transpose of a raw file is one, without a header: name it otherwise"
            );
        }
        let (width, offset) = (self.width.unwrap_or(8), self.offset.unwrap_or(0));
        let stored = StoredMatrix { rows, columns, width, offset, by_columns: false, dtype: None };
        Ok(Job::of(&stored, Vec::new()))
    }

    fn npy(&self) -> anyhow::Result<Job> {
        let array = NpyArray::open(&self.input)?;
        let name = self.input.display();
        let given = [
            ("row-count", self.rows.is_some()),
            ("column-count", self.columns.is_some()),
            ("item-bytes", self.width.is_some()),
            ("raw-offset", self.offset.is_some()),
        ];
        if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
            bail!(
                "--{option} belongs to raw files: {name} says itself what it holds; leave it out"
            );
        }
        if !is_npy(&self.out) {
            bail!("{}: the transpose of an .npy file is one: name it .npy", self.out.display());
        }
        let [rows, columns] = array.shape[..] else {
            bail!(
                "{name}: its shape {:?} has {} axes: a matrix has 2",
                array.shape,
                array.shape.len()
            );
        };
        let turned = NpyArray { shape: vec![columns, rows], fortran: false, ..array.clone() };
        let NpyArray { dtype, width, fortran: by_columns, offset, .. } = array;
        let stored = StoredMatrix { rows, columns, width, offset, by_columns, dtype: Some(dtype) };
        Ok(Job::of(&stored, turned.header()))
    }

    /// Compares the files, every element, then gives the output its name and writes the certificate of what was found.
    fn compare(
        &self,
        answer: &TransposedFile,
        mut written: Pending<FileTransposition>,
        watch: &Watch,
    ) -> anyhow::Result<Outcome> {
        let mut from = opened(&self.input)?;
        let certified = watch.during("checking", |monitor| {
            answer.certify(Files { input: Some(&mut from), output: written.file() }, monitor)
        });
        let certificate = match certified {
            Ok(certificate) => certificate,
            Err(FileCheckError::Rejected(violation)) => {
                let why = explain(&violation, Some(&self.input), &self.out, "the answer");
                writing::print_error(&format!("the check failed: {why}; {AS_IT_WAS}"));
                return Ok(Outcome::CheckFailed);
            }
            Err(error) => return Err(error.into()),
        };
        let solution = transposed(answer.clone(), certificate, &written.found);
        publish(written, self.certificate.as_deref(), &AnyFileSolution::Transpose(solution))?;
        Ok(Outcome::Done)
    }

    fn sample(&self, job: &Job, elements: u64, watch: &Watch) -> anyhow::Result<Outcome> {
        if elements == 0 {
            return Ok(Outcome::Done);
        }
        let (header, drawn) = (job.header.len() as u64, [elements, self.seed]);
        let checked = watch.during("checking", |monitor| {
            check_transposed_samples(&self.input, job.matrix, &self.out, header, drawn, monitor)
        });
        match checked {
            Ok(()) => Ok(Outcome::Done),
            Err(error @ Error::Differs { .. }) => {
                writing::print_error(&error.to_string());
                Ok(Outcome::CheckFailed)
            }
            Err(error) => Err(error.into()),
        }
    }

    fn summary(&self, answer: &TransposedFile, found: &FileTransposition) -> String {
        let TransposedFile { rows, columns, width, .. } = answer;
        let kind = answer.dtype.as_ref().map_or(String::new(), |dtype| format!(", {dtype}"));
        let compared = match self.samples {
            None => "all elements".to_owned(),
            Some(elements) => format!("{elements} elements"),
        };
        format!(
            "{columns} × {rows} elements of {width} bytes{kind}\n\
             bytes read      {}\n\
             bytes written   {}\n\
             tiles           {}\n\
             compared        {compared}\n",
            found.bytes_read, found.bytes_written, found.tiles,
        )
    }
}
