//! An output that is complete, before it has its name: to be looked at first.

use std::borrow::Borrow;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

use super::{Draft, Store};
use crate::error::Error;

/// A file that is complete and has not its name yet; and what is known of how it was made.
///
/// Dropped without [`publish`](Self::publish) it leaves the earlier file as it was.
pub struct Pending<R, F = File> {
    /// The way in which it was made.
    pub found: R,
    draft: Draft<F>,
    path: PathBuf,
    /// A file that is removed when it is needed no longer; locked until then.
    kept: Option<(PathBuf, F)>,
}

impl<R> Pending<R> {
    /// The file, to be read from any place.
    pub fn file(&mut self) -> &mut File {
        self.draft.file()
    }

    /// Brings the file to the disk and gives it its name, in the place of an earlier one; then a file to resume is removed.
    ///
    /// # Errors
    /// [`Error::File`] if the system refuses.
    pub fn publish(self) -> Result<R, Error> {
        self.finish()
    }
}

impl<R, F> Pending<R, F> {
    pub(crate) fn new(found: R, draft: Draft<F>, path: &Path, kept: Option<(PathBuf, F)>) -> Self {
        Self { found, draft, path: path.to_owned(), kept }
    }

    /// [`Pending::publish`], of whatever is written to.
    pub(crate) fn finish(self) -> Result<R, Error>
    where
        F: Store + Borrow<File>,
    {
        self.draft.publish().map_err(failed(&self.path))?;
        if let Some((path, _)) = &self.kept {
            fs::remove_file(path).map_err(failed(path))?;
        }
        Ok(self.found)
    }
}

/// Returns what the system said, and of which file.
fn failed(path: &Path) -> impl FnOnce(std::io::Error) -> Error {
    let path = path.display().to_string();
    move |source| Error::File { path, source }
}
