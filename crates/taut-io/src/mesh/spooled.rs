//! Simplices that wait in a file without name until their number is known, which most formats want first.

use std::fs::File;
use std::io::{BufReader, BufWriter, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use super::SimplexSource;
use crate::Error;

/// Ids that are handed on at once.
const SIMPLICES_AT_ONCE: usize = 1 << 14;

/// Simplices in a temporary file.
pub struct SpooledSimplices {
    width: usize,
    count: u64,
    folder: PathBuf,
    file: Mutex<BufWriter<File>>,
}

impl SpooledSimplices {
    /// No simplices of `width` vertices yet; the file is in `folder`, or where the system has temporary files.
    ///
    /// # Errors
    /// [`Error::Spill`].
    ///
    /// # Panics
    /// If `width` is 0.
    pub fn new(width: usize, folder: Option<&Path>) -> Result<Self, Error> {
        assert!(width > 0, "simplices have vertices");
        let folder = folder.map_or_else(std::env::temp_dir, Path::to_owned);
        let file = tempfile::tempfile_in(&folder).map_err(|source| failed(&folder, source))?;
        Ok(Self { width, count: 0, folder, file: Mutex::new(BufWriter::new(file)) })
    }

    /// Adds a simplex.
    ///
    /// # Errors
    /// [`Error::Spill`].
    ///
    /// # Panics
    /// If it has another number of vertices.
    pub fn push(&mut self, ids: &[u32]) -> Result<(), Error> {
        assert_eq!(ids.len(), self.width);
        self.count += 1;
        let file = self.file.get_mut().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.write_all(bytemuck::cast_slice(ids)).map_err(|source| failed(&self.folder, source))
    }
}

fn failed(folder: &Path, source: std::io::Error) -> Error {
    let folder = folder.display().to_string();
    Error::Spill { path: "the simplices".to_owned(), folder, source }
}

impl SimplexSource for SpooledSimplices {
    fn count(&self) -> u64 {
        self.count
    }

    fn read(&self, put: &mut dyn FnMut(&[u32]) -> Result<(), Error>) -> Result<(), Error> {
        let failed = |source| failed(&self.folder, source);
        let mut writer = self.file.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        writer.flush().map_err(failed)?;
        let file = writer.get_mut();
        file.rewind().map_err(failed)?;
        let mut reader = BufReader::with_capacity(1 << 18, file);
        let mut ids = vec![0u32; SIMPLICES_AT_ONCE * self.width];
        let mut rest = self.count;
        while rest > 0 {
            let simplices = rest.min(SIMPLICES_AT_ONCE as u64);
            let piece = &mut ids[..simplices as usize * self.width];
            reader.read_exact(bytemuck::cast_slice_mut(piece)).map_err(failed)?;
            put(piece)?;
            rest -= simplices;
        }
        Ok(())
    }
}
