//! An output that appears under its name when it is complete, and else not at all.
//!
//! *Guarantee.* Where the system has files without a name, it takes the draft back when the process ends, in whatever
//! way. The finished file takes the place of an earlier one in one step: of the file behind a symbolic link, with its
//! permissions. What cannot be replaced is refused at the start, not after the work.
//! *Trap.* A file without a name can be given one that is free, but cannot replace another; so where the output exists,
//! the new one is named beside it for the moment between two calls of the system.
//! *Trap.* A rename needs no right to write the earlier file; whoever took that right away meant it.

use std::borrow::Borrow;
use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use tempfile::TempPath;

use super::Store;

/// An output that nobody sees yet.
pub(crate) struct Draft<F = File> {
    file: F,
    /// The other name of the file, which is removed with the draft; none if it has no name at all.
    name: Option<TempPath>,
    target: PathBuf,
}

impl<F: Store + Borrow<File>> Draft<F> {
    /// Starts a file in the folder of what it will be, or replace; `open` makes of the file what is written to.
    pub(crate) fn beside(path: &Path, open: impl FnOnce(File) -> F) -> io::Result<Self> {
        let target = target(path)?;
        let earlier = match fs::metadata(&target) {
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            found => Some(found?),
        };
        if let Some(earlier) = &earlier {
            if !earlier.is_file() {
                return Err(io::Error::new(ErrorKind::InvalidInput, "not a regular file"));
            }
            File::options().append(true).open(&target)?;
        } else if target.file_name().is_none()
            || path.as_os_str().as_encoded_bytes().ends_with(b"/")
        {
            return Err(io::Error::new(ErrorKind::InvalidInput, "not the name of a file"));
        }
        let (file, name) = match unnamed(folder(&target)) {
            Some(file) => (file, None),
            None => named(folder(&target)).map(|(file, name)| (file, Some(name)))?,
        };
        if let Some(earlier) = earlier {
            file.set_permissions(earlier.permissions())?;
        }
        Ok(Self { file: open(file), name, target })
    }

    /// Brings the bytes to the disk and gives the file its name, in the place of any other file with this name.
    pub(crate) fn publish(self) -> io::Result<()> {
        self.file.sync()?;
        match self.name {
            Some(name) => name.persist(&self.target)?,
            None => link(self.file.borrow(), &self.target)?,
        }
        settle(folder(&self.target))
    }
}

impl Draft {
    /// The file as it is so far, to be read by way of the system's cache.
    pub(crate) fn file(&mut self) -> &mut File {
        self.file.past_cache(false);
        &mut self.file
    }
}

fn named(folder: &Path) -> io::Result<(File, TempPath)> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".taut-");
    // As any new file; else nobody but the owner might read it.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    fs::metadata(folder)?;
    // The system speaks of a name that nobody asked for.
    let refused = |error: io::Error| match error.kind() {
        ErrorKind::NotFound => io::Error::other("its folder takes no new files"),
        ErrorKind::PermissionDenied => ErrorKind::PermissionDenied.into(),
        _ => error,
    };
    Ok(builder.tempfile_in(folder).map_err(refused)?.into_parts())
}

pub(crate) fn folder(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// The file behind symbolic links, whether it is there or not.
pub(crate) fn target(path: &Path) -> io::Result<PathBuf> {
    let mut target = path.to_owned();
    // As many links as Linux follows.
    for _ in 0..40 {
        match fs::read_link(&target) {
            Ok(next) => target = folder(&target).join(next),
            // Not a link, or nothing at all.
            Err(_) => return Ok(target),
        }
    }
    Err(io::Error::new(ErrorKind::InvalidInput, "too many symbolic links"))
}

/// Has a new name in a folder survive the machine, if the folder may be read.
fn settle(folder: &Path) -> io::Result<()> {
    #[cfg(unix)]
    if let Ok(open) = File::open(folder) {
        match open.sync_all() {
            // Some file systems do not sync folders.
            Err(error) if error.kind() == ErrorKind::InvalidInput => {}
            result => return result,
        }
    }
    #[cfg(not(unix))]
    let _ = folder;
    Ok(())
}

#[cfg(not(target_os = "linux"))]
fn unnamed(_: &Path) -> Option<File> {
    None
}

#[cfg(not(target_os = "linux"))]
fn link(_: &File, _: &Path) -> io::Result<()> {
    Err(ErrorKind::Unsupported.into())
}

#[cfg(target_os = "linux")]
use linux::{link, unnamed};

#[cfg(target_os = "linux")]
mod linux {
    use std::fs::{self, File};
    use std::io;
    use std::os::fd::AsRawFd;
    use std::path::{Path, PathBuf};

    use rustix::fs::{AtFlags, CWD, Mode, OFlags, linkat, open};
    use rustix::io::Errno;

    /// Where the system shows an open file.
    fn shown(file: &File) -> PathBuf {
        PathBuf::from(format!("/proc/self/fd/{}", file.as_raw_fd()))
    }

    /// A file without a name, if the file system has these and `/proc` lets it have one later.
    pub(super) fn unnamed(folder: &Path) -> Option<File> {
        let flags = OFlags::TMPFILE | OFlags::RDWR | OFlags::CLOEXEC;
        let file = File::from(open(folder, flags, Mode::from_raw_mode(0o666)).ok()?);
        fs::symlink_metadata(shown(&file)).is_ok().then_some(file)
    }

    /// Gives a file without a name one, whether that is free or not.
    pub(super) fn link(file: &File, target: &Path) -> io::Result<()> {
        let to = |name: &Path| linkat(CWD, shown(file), CWD, name, AtFlags::SYMLINK_FOLLOW);
        match to(target) {
            Err(Errno::EXIST) => {}
            result => return Ok(result?),
        }
        let mut number = 0;
        loop {
            let name = format!(".taut-{}-{number}", std::process::id());
            let beside = super::folder(target).join(name);
            match to(&beside) {
                Err(Errno::EXIST) => number += 1,
                Err(error) => return Err(error.into()),
                Ok(()) => {
                    return fs::rename(&beside, target).inspect_err(|_| {
                        // What went wrong is told; that the name stays behind would be one thing more.
                        let _ = fs::remove_file(&beside);
                    });
                }
            }
        }
    }
}

impl<F: Store> Store for Draft<F> {
    fn read_at(&self, bytes: &mut [u8], at: u64) -> io::Result<usize> {
        self.file.read_at(bytes, at)
    }

    fn write_at(&self, bytes: &[u8], at: u64) -> io::Result<usize> {
        self.file.write_at(bytes, at)
    }

    fn reserve(&self, bytes: u64) -> io::Result<()> {
        self.file.reserve(bytes)
    }

    fn sync(&self) -> io::Result<()> {
        self.file.sync()
    }

    fn past_cache(&self, past: bool) -> bool {
        self.file.past_cache(past)
    }
}
