//! Where decoded points go: to memory, and to a temporary file once they outgrow it.
//!
//! *Guarantee.* The points read back are the same on both ways, and at most the allowed bytes (and one buffer of
//! [`BUFFER_BYTES`] bytes) are held.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

use taut_points::{FileSource, OwnedPoints, PointSource, Scalar, try_reserve_exact};

use crate::Error;
use crate::input::Job;

/// This many bytes are gathered before a write to the temporary file.
const BUFFER_BYTES: usize = 1 << 20;

pub(crate) struct Sink<'a, T> {
    job: &'a Job<'a>,
    dim: usize,
    values: Vec<T>,
    /// Most values held before the first spill.
    limit: usize,
    spill: Option<Spill>,
}

struct Spill {
    file: BufWriter<File>,
    rows: u64,
}

impl<'a, T: Scalar> Sink<'a, T> {
    /// A sink of points of dimension `dim` ≥ 1.
    pub(crate) fn new(job: &'a Job<'a>, dim: usize) -> Self {
        let limit = job.options.memory.map_or(usize::MAX, |bytes| {
            usize::try_from(bytes).unwrap_or(usize::MAX) / size_of::<T>()
        });
        Sink { job, dim, values: Vec::new(), limit, spill: None }
    }

    /// Dimension of the points.
    #[cfg(feature = "arrow")]
    pub(crate) fn dim(&self) -> usize {
        self.dim
    }

    /// Number of points so far.
    pub(crate) fn len(&self) -> u64 {
        self.spill.as_ref().map_or(0, |spill| spill.rows) + (self.values.len() / self.dim) as u64
    }

    /// Adds whole points.
    pub(crate) fn push(&mut self, rows: &[T]) -> Result<(), Error> {
        let wanted = self.values.len().saturating_add(rows.len());
        if let Some(spill) = &mut self.spill {
            spill.file.write_all(bytemuck::cast_slice(rows)).map_err(|e| failed(self.job, e))?;
            spill.rows += (rows.len() / self.dim) as u64;
            return Ok(());
        }
        if wanted > self.limit {
            let file = temporary(self.job)?;
            let mut file = BufWriter::with_capacity(BUFFER_BYTES, file);
            file.write_all(bytemuck::cast_slice(&self.values)).map_err(|e| failed(self.job, e))?;
            let held = (self.values.len() / self.dim) as u64;
            self.values = Vec::new();
            self.spill = Some(Spill { file, rows: held });
            return self.push(rows);
        }
        if wanted > self.values.capacity() {
            // Doubling, as a Vec does by itself, but never past what is allowed.
            let grown = self.values.capacity().saturating_mul(2).min(self.limit).max(wanted);
            let more = grown - self.values.len();
            // Where twice as much is too much, exactly as much may still be there.
            try_reserve_exact(&mut self.values, more)
                .or_else(|_| try_reserve_exact(&mut self.values, rows.len()))
                .map_err(|_| Error::OutOfMemory {
                    path: self.job.path.to_owned(),
                    bytes: (wanted as u64).saturating_mul(size_of::<T>() as u64),
                })?;
        }
        self.values.extend_from_slice(rows);
        Ok(())
    }

    /// The points as a source; no point at all is an error.
    pub(crate) fn finish(self) -> Result<Box<dyn PointSource>, Error> {
        let n = self.len();
        if n == 0 {
            return Err(Error::NoRows { path: self.job.path.to_owned() });
        }
        let Some(spill) = self.spill else {
            let points = OwnedPoints::new(self.values, self.dim).expect("whole points were added");
            return Ok(Box::new(points));
        };
        let file = spill.file.into_inner().map_err(|e| failed(self.job, e.into_error()))?;
        let shown = Path::new(self.job.path);
        Ok(Box::new(FileSource::from_file(file, shown, 0, n, self.dim, T::KIND)?))
    }
}

/// A temporary file where the options want it. It has no name (or, on Windows, is deleted by the system when it is
/// closed), so nothing stays behind however this process ends.
pub(crate) fn temporary(job: &Job<'_>) -> Result<File, Error> {
    let made = match &job.options.temp_dir {
        Some(folder) => tempfile::tempfile_in(folder),
        None => tempfile::tempfile(),
    };
    made.map_err(|source| failed(job, source))
}

/// A temporary file could not be written.
pub(crate) fn failed(job: &Job<'_>, source: std::io::Error) -> Error {
    let folder = job.options.temp_dir.clone().unwrap_or_else(std::env::temp_dir);
    Error::Spill { path: job.path.to_owned(), folder: folder.display().to_string(), source }
}
