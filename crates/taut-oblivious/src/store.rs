//! Files by position, whole reads and writes, and files that appear when they are whole.

use std::fs::{self, File};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// Bytes by position: a file, or what a test puts in its place.
pub(crate) trait Store {
    /// Reads some bytes at `at`, none at the end.
    fn read_at(&self, buffer: &mut [u8], at: u64) -> io::Result<usize>;

    /// Writes some bytes at `at`.
    fn write_at(&self, bytes: &[u8], at: u64) -> io::Result<usize>;

    /// Fills the buffer, in as many reads as it takes.
    fn read_exact_at(&self, mut buffer: &mut [u8], mut at: u64) -> io::Result<()> {
        while !buffer.is_empty() {
            match self.read_at(buffer, at) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(n) => {
                    buffer = &mut buffer[n..];
                    at += n as u64;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Writes all bytes, in as many writes as it takes.
    fn write_all_at(&self, mut bytes: &[u8], mut at: u64) -> io::Result<()> {
        while !bytes.is_empty() {
            match self.write_at(bytes, at) {
                Ok(0) => return Err(ErrorKind::WriteZero.into()),
                Ok(n) => {
                    bytes = &bytes[n..];
                    at += n as u64;
                }
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl Store for File {
    fn read_at(&self, buffer: &mut [u8], at: u64) -> io::Result<usize> {
        #[cfg(unix)]
        return std::os::unix::fs::FileExt::read_at(self, buffer, at);
        #[cfg(not(unix))]
        {
            let mut file = self;
            io::Seek::seek(&mut file, io::SeekFrom::Start(at))?;
            io::Read::read(&mut file, buffer)
        }
    }

    fn write_at(&self, bytes: &[u8], at: u64) -> io::Result<usize> {
        #[cfg(unix)]
        return std::os::unix::fs::FileExt::write_at(self, bytes, at);
        #[cfg(not(unix))]
        {
            let mut file = self;
            io::Seek::seek(&mut file, io::SeekFrom::Start(at))?;
            io::Write::write(&mut file, bytes)
        }
    }
}

/// A file under a temporary name; gone if it is not finished, unless the process is killed.
pub(crate) struct Unfinished {
    file: NamedTempFile,
    path: PathBuf,
}

impl Unfinished {
    /// In the folder of what it will replace, the file behind a symbolic link, and with its permissions.
    pub(crate) fn beside(path: &Path) -> io::Result<Self> {
        let earlier = fs::metadata(path).ok();
        let path = if earlier.is_some() { fs::canonicalize(path)? } else { path.to_owned() };
        let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let mut builder = tempfile::Builder::new();
        builder.prefix(".taut-");
        #[cfg(unix)]
        builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        let file = builder.tempfile_in(folder)?;
        if let Some(earlier) = earlier {
            if !earlier.is_file() {
                return Err(io::Error::new(ErrorKind::InvalidInput, "not a regular file"));
            }
            // A rename needs no right to write the earlier file; whoever took that right away meant it.
            File::options().append(true).open(&path)?;
            file.as_file().set_permissions(earlier.permissions())?;
        }
        Ok(Self { file, path })
    }

    pub(crate) fn file(&self) -> &File {
        self.file.as_file()
    }

    /// Brings the bytes to the disk and gives the file its name.
    pub(crate) fn finish(self) -> io::Result<()> {
        self.file.as_file().sync_all()?;
        self.file.persist(self.path).map(drop).map_err(|e| e.error)
    }
}
