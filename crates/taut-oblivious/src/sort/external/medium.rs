//! Files as the sort sees them: places of bytes that can fall short, be interrupted, or be full.

use std::fs::File;
use std::io;

use crate::error::Error;

/// A place of bytes. All reading and writing of the sort goes through this trait, so that a test can be a disk that fails.
pub(super) trait Storage: Send + Sync {
    /// Reads some bytes at a place, perhaps fewer than there is room for; 0 only at the end.
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize>;

    /// Writes some bytes at a place, perhaps not all.
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize>;

    /// Makes sure there is room for so many bytes, where that can be known.
    fn reserve(&self, bytes: u64) -> io::Result<()>;

    /// Waits until what was written would survive the machine.
    fn sync(&self) -> io::Result<()>;

    /// These bytes will be read soon.
    fn soon(&self, offset: u64, bytes: u64);
}

impl Storage for File {
    #[cfg(unix)]
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        std::os::unix::fs::FileExt::read_at(self, bytes, offset)
    }

    #[cfg(unix)]
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        std::os::unix::fs::FileExt::write_at(self, bytes, offset)
    }

    #[cfg(not(unix))]
    fn read_at(&self, bytes: &mut [u8], offset: u64) -> io::Result<usize> {
        use io::{Read, Seek};
        let mut file = self;
        file.seek(io::SeekFrom::Start(offset))?;
        file.read(bytes)
    }

    #[cfg(not(unix))]
    fn write_at(&self, bytes: &[u8], offset: u64) -> io::Result<usize> {
        use io::{Seek, Write};
        let mut file = self;
        file.seek(io::SeekFrom::Start(offset))?;
        file.write(bytes)
    }

    #[cfg(target_os = "linux")]
    fn reserve(&self, bytes: u64) -> io::Result<()> {
        use rustix::fs::{FallocateFlags, fallocate};
        use rustix::io::Errno;
        match fallocate(self, FallocateFlags::KEEP_SIZE, 0, bytes) {
            // Not every file system can; then a full disk shows when it is full.
            Err(Errno::OPNOTSUPP | Errno::NOSYS | Errno::INVAL) => Ok(()),
            result => Ok(result?),
        }
    }

    #[cfg(not(target_os = "linux"))]
    fn reserve(&self, _: u64) -> io::Result<()> {
        Ok(())
    }

    fn sync(&self) -> io::Result<()> {
        self.sync_data()
    }

    #[cfg(target_os = "linux")]
    fn soon(&self, offset: u64, bytes: u64) {
        // A hint: that it is refused changes nothing.
        let length = std::num::NonZeroU64::new(bytes);
        let _ = rustix::fs::fadvise(self, offset, length, rustix::fs::Advice::WillNeed);
    }

    #[cfg(not(target_os = "linux"))]
    fn soon(&self, _: u64, _: u64) {}
}

/// A storage with its name for errors, and counters.
pub(super) struct Medium<S> {
    storage: S,
    path: String,
    pub(super) bytes_read: u64,
    pub(super) bytes_written: u64,
}

impl<S: Storage> Medium<S> {
    pub(super) fn new(storage: S, path: String) -> Self {
        Self { storage, path, bytes_read: 0, bytes_written: 0 }
    }

    pub(super) fn into_storage(self) -> S {
        self.storage
    }

    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Fills `bytes` from a place.
    pub(super) fn read(&mut self, bytes: &mut [u8], offset: u64) -> Result<(), Error> {
        let mut done = 0;
        while done < bytes.len() {
            match self.storage.read_at(&mut bytes[done..], offset + done as u64) {
                Ok(0) => return Err(self.error(io::ErrorKind::UnexpectedEof.into())),
                Ok(more) => done += more,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(self.error(error)),
            }
        }
        self.bytes_read += bytes.len() as u64;
        Ok(())
    }

    /// Writes all of `bytes` to a place.
    pub(super) fn write(&mut self, bytes: &[u8], offset: u64) -> Result<(), Error> {
        let mut done = 0;
        while done < bytes.len() {
            match self.storage.write_at(&bytes[done..], offset + done as u64) {
                Ok(0) => return Err(self.error(io::ErrorKind::WriteZero.into())),
                Ok(more) => done += more,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => return Err(self.error(error)),
            }
        }
        self.bytes_written += bytes.len() as u64;
        Ok(())
    }

    pub(super) fn reserve(&self, bytes: u64) -> Result<(), Error> {
        self.storage.reserve(bytes).map_err(|error| self.error(error))
    }

    pub(super) fn sync(&self) -> Result<(), Error> {
        loop {
            match self.storage.sync() {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                result => return result.map_err(|error| self.error(error)),
            }
        }
    }

    pub(super) fn soon(&self, offset: u64, bytes: u64) {
        self.storage.soon(offset, bytes);
    }

    fn error(&self, source: io::Error) -> Error {
        Error::File { path: self.path.clone(), source }
    }
}
