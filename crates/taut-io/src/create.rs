//! Files that appear whole or not at all.
//!
//! *Idea.* Bytes go to a temporary file in the same folder; [`AtomicFile::commit`] brings them to the disk and
//! renames. So a full disk, an error or an interruption leaves the earlier file as it was.
//! The new file has the permissions of the earlier one, and an earlier file that may not be written is not replaced.
//! A process that is killed leaves its temporary file, `.taut-tmp-` and six letters; the next output in that folder removes it.
//! *Trap.* Renaming onto a device would replace it: what exists and is no regular file is written in place.

mod draft;
mod folder;

use std::fs::{self, File, Permissions};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};

use draft::Draft;

use crate::Error;
use crate::error::shown_path;

pub use draft::remove_unfinished;
pub use folder::{AtomicFolder, ScratchFolder, check_folder, create_folder};

/// A file in the making; see [`create`]. Dropped without [`commit`](Self::commit), it leaves no trace.
#[derive(Debug)]
pub struct AtomicFile {
    display: String,
    to: Target,
}

#[derive(Debug)]
enum Target {
    /// A temporary file and the name it will take.
    Rename(BufWriter<Draft>, PathBuf),
    /// A device or a pipe.
    InPlace(BufWriter<File>),
    Stdout(BufWriter<Stdout>),
    /// No file at all.
    Memory(Vec<u8>),
}

/// Starts a file that will be `path`; `-` is standard output.
///
/// # Errors
/// [`Error::Directory`], [`Error::NotFound`] (of the folder), [`Error::Permission`], [`Error::Write`].
pub fn create(path: &Path) -> Result<AtomicFile, Error> {
    if path.as_os_str() == "-" {
        let to = Target::Stdout(BufWriter::new(io::stdout()));
        return Ok(AtomicFile { display: "standard output".to_owned(), to });
    }
    let display = shown_path(path);
    let failed = |source| Error::writing(&display, source);
    let to = match fs::metadata(path) {
        Ok(meta) if meta.is_dir() => return Err(Error::Directory { path: display }),
        Ok(meta) if !meta.is_file() => {
            let file = File::options().write(true).open(path).map_err(failed)?;
            Target::InPlace(BufWriter::new(file))
        }
        Ok(meta) => {
            // A rename needs no right to write the earlier file; whoever took that right away meant it.
            File::options().append(true).open(path).map_err(failed)?;
            // The file behind a symbolic link is replaced, not the link.
            let behind = fs::canonicalize(path).map_err(failed)?;
            rename_to(behind, Some(meta.permissions())).map_err(failed)?
        }
        Err(_) => rename_to(end_of_links(path), None).map_err(failed)?,
    };
    Ok(AtomicFile { display, to })
}

/// Where links lead that end at no file: it is made there, as the system does when it opens such a link to write.
fn end_of_links(path: &Path) -> PathBuf {
    let mut end = path.to_owned();
    // As many links as Linux follows before it calls them a circle.
    for _ in 0..40 {
        let Ok(to) = fs::read_link(&end) else { break };
        end = end.parent().unwrap_or(Path::new("")).join(to);
    }
    end
}

/// The folder that an output is written to; `None` where it is a device, a pipe, standard output, or in no folder.
pub(crate) fn folder_of_output(path: &Path) -> Option<PathBuf> {
    let behind = match fs::metadata(path) {
        _ if path.as_os_str() == "-" => return None,
        Ok(meta) if !meta.is_file() => return None,
        Ok(_) => fs::canonicalize(path).ok()?,
        Err(_) => end_of_links(path),
    };
    Some(folder(&behind).to_owned())
}

/// Tests whether a file can be made or replaced where `path` says, as far as that shows without doing it; nothing is left.
///
/// # Errors
/// Those of [`create`].
pub fn check_writable(path: &Path) -> Result<(), Error> {
    let display = shown_path(path);
    let failed = |source| Error::writing(&display, source);
    let behind = match fs::metadata(path) {
        Ok(meta) if meta.is_dir() => return Err(Error::Directory { path: display }),
        // To open a pipe is to begin with it.
        Ok(meta) if !meta.is_file() => return Ok(()),
        Ok(_) => {
            File::options().append(true).open(path).map_err(failed)?;
            fs::canonicalize(path).map_err(failed)?
        }
        Err(_) => end_of_links(path),
    };
    let folder = folder(&behind);
    tempfile::tempfile_in(folder).map_err(|error| failed(refused(error, folder)))?;
    Ok(())
}

fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Why no file can be made in a folder: the system may speak of a name that nobody asked for.
fn refused(error: io::Error, folder: &Path) -> io::Error {
    match error.kind() {
        io::ErrorKind::NotFound if folder.is_dir() => {
            io::Error::other("its folder takes no new files")
        }
        _ => error,
    }
}

/// A temporary file beside `path`, with the permissions of the earlier file, or those of any new one.
fn rename_to(path: PathBuf, earlier: Option<Permissions>) -> io::Result<Target> {
    let folder = folder(&path);
    let file = Draft::new(folder, earlier).map_err(|error| refused(error, folder))?;
    Ok(Target::Rename(BufWriter::with_capacity(1 << 16, file), path))
}

impl AtomicFile {
    /// Bytes that become no file, with the name that messages give them.
    pub(crate) fn in_memory(name: &str) -> Self {
        AtomicFile { display: name.to_owned(), to: Target::Memory(Vec::new()) }
    }

    /// The bytes of what is no file; empty for a file.
    pub(crate) fn into_memory(self) -> Vec<u8> {
        match self.to {
            Target::Memory(bytes) => bytes,
            _ => Vec::new(),
        }
    }

    /// The file as shown to people.
    pub fn path(&self) -> &str {
        &self.display
    }

    /// Puts the file in its place, with everything written so far on the disk.
    ///
    /// # Errors
    /// [`Error::Replace`], for instance when the disk is full: the earlier file is then as it was. [`Error::Write`] for
    /// a device, a pipe or standard output.
    pub fn commit(self) -> Result<(), Error> {
        let display = self.display;
        let replaces = matches!(self.to, Target::Rename(..));
        let done = match self.to {
            Target::Stdout(mut out) => out.flush(),
            Target::Memory(_) => Ok(()),
            Target::InPlace(mut file) => file.flush(),
            Target::Rename(file, path) => file
                .into_inner()
                .map_err(io::IntoInnerError::into_error)
                .and_then(|file| file.publish(&path)),
        };
        done.map_err(|source| match replaces {
            true => Error::replacing(&display, source),
            false => Error::writing(&display, source),
        })
    }

    /// Returns what it means that writing to this file failed.
    ///
    /// Only of a file that would have been replaced can be said that the earlier one stays.
    pub(crate) fn failure(&self) -> fn(&str, io::Error) -> Error {
        match self.to {
            Target::Rename(..) => Error::replacing,
            _ => Error::writing,
        }
    }

    fn writer(&mut self) -> &mut dyn Write {
        match &mut self.to {
            Target::Rename(file, _) => file,
            Target::InPlace(file) => file,
            Target::Stdout(out) => out,
            Target::Memory(bytes) => bytes,
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer().flush()
    }
}
