//! A file that appears under its name when it is complete, and else not at all.

use std::fs::File;
use std::io;
use std::path::Path;

use tempfile::TempPath;

use super::files::folder;
use super::medium::Storage;

/// An output that nobody sees yet.
pub(super) enum Draft {
    /// A file without a name: the system takes it back when the process ends, in whatever way.
    #[cfg(target_os = "linux")]
    Unnamed(File),
    /// A file under another name, which is removed with the draft.
    Named(File, TempPath),
}

impl Draft {
    /// Starts a file in the folder of `target`.
    pub(super) fn beside(target: &Path) -> io::Result<Self> {
        #[cfg(target_os = "linux")]
        if let Some(file) = linux::unnamed(folder(target)) {
            return Ok(Self::Unnamed(file));
        }
        Self::named(target)
    }

    /// Starts a file with a name of its own in the folder of `target`.
    fn named(target: &Path) -> io::Result<Self> {
        let mut builder = tempfile::Builder::new();
        builder.prefix(".taut-");
        // As any new file; else nobody but the owner might read what has been sorted.
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let (file, name) = builder.tempfile_in(folder(target))?.into_parts();
        Ok(Self::Named(file, name))
    }

    /// Gives the file its name, in the place of any other file with this name.
    pub(super) fn publish(self, target: &Path) -> io::Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => linux::link(&file, target),
            Self::Named(_, name) => Ok(name.persist(target)?),
        }
    }

    fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file,
            Self::Named(file, _) => file,
        }
    }
}

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
            let beside =
                super::folder(target).join(format!(".taut-{}-{number}", std::process::id()));
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

impl Storage for Draft {
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        Storage::read_at(self.file(), bytes, offset)
    }

    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        Storage::write_at(self.file(), bytes, offset)
    }

    fn reserve(&self, bytes: u64) -> io::Result<()> {
        self.file().reserve(bytes)
    }

    fn sync(&self) -> io::Result<()> {
        self.file().sync()
    }

    fn soon(&self, offset: u64, bytes: u64) {
        self.file().soon(offset, bytes);
    }
}
