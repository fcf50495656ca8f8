//! Files that appear whole or not at all.
//!
//! *Idea.* Bytes go to a temporary file in the same folder; [`AtomicFile::commit`] brings them to the disk and
//! renames. So a full disk, an error or an interruption leaves the earlier file as it was.
//! *Trap.* Renaming onto a device would replace it: what exists and is no regular file is written in place.

use std::fs::{self, File};
use std::io::{self, BufWriter, Stdout, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use crate::Error;

/// A file in the making; see [`create`]. Dropped without [`commit`](Self::commit), it leaves no trace.
#[derive(Debug)]
pub struct AtomicFile {
    shown: String,
    to: Target,
}

#[derive(Debug)]
enum Target {
    /// A temporary file and the name it will take.
    Rename(BufWriter<NamedTempFile>, PathBuf),
    /// A device or a pipe.
    InPlace(BufWriter<File>),
    Stdout(BufWriter<Stdout>),
}

/// Starts a file that will be `path`; `-` is standard output.
///
/// # Errors
/// [`Error::Directory`], [`Error::NotFound`] (of the folder), [`Error::Permission`], [`Error::Write`].
pub fn create(path: &Path) -> Result<AtomicFile, Error> {
    if path.as_os_str() == "-" {
        let to = Target::Stdout(BufWriter::new(io::stdout()));
        return Ok(AtomicFile { shown: "standard output".to_owned(), to });
    }
    let shown = path.display().to_string();
    let failed = |source| Error::writing(&shown, source);
    let to = match fs::metadata(path) {
        Ok(meta) if meta.is_dir() => return Err(Error::Directory { path: shown }),
        Ok(meta) if !meta.is_file() => {
            let file = File::options().write(true).open(path).map_err(failed)?;
            Target::InPlace(BufWriter::new(file))
        }
        // The file behind a symbolic link is replaced, not the link.
        Ok(_) => rename_to(fs::canonicalize(path).map_err(failed)?).map_err(failed)?,
        Err(_) => rename_to(path.to_owned()).map_err(failed)?,
    };
    Ok(AtomicFile { shown, to })
}

fn rename_to(path: PathBuf) -> io::Result<Target> {
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".taut-");
    // Temporary files are private unless told otherwise; the umask is applied to this by the system.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    Ok(Target::Rename(BufWriter::with_capacity(1 << 16, builder.tempfile_in(folder)?), path))
}

impl AtomicFile {
    /// The file as shown to people.
    pub fn path(&self) -> &str {
        &self.shown
    }

    /// Puts the file in its place, with everything written so far on the disk.
    ///
    /// # Errors
    /// [`Error::Write`], for instance when the disk is full; the earlier file is then as it was.
    pub fn commit(self) -> Result<(), Error> {
        let shown = self.shown;
        let done = match self.to {
            Target::Stdout(mut out) => out.flush(),
            Target::InPlace(mut file) => file.flush(),
            Target::Rename(file, path) => file
                .into_inner()
                .map_err(io::IntoInnerError::into_error)
                .and_then(|file| file.as_file().sync_all().map(|()| file))
                .and_then(|file| file.persist(path).map(drop).map_err(|e| e.error)),
        };
        done.map_err(|source| Error::writing(&shown, source))
    }

    fn writer(&mut self) -> &mut dyn Write {
        match &mut self.to {
            Target::Rename(file, _) => file,
            Target::InPlace(file) => file,
            Target::Stdout(out) => out,
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
