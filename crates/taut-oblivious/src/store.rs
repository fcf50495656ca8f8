//! Bytes by position, whole reads and writes, and files that appear when they are whole.
//!
//! *Trap.* Written by way of the system's cache, a page costs the system more time than sorting its records costs this
//! crate: pages must be found, filled and written back. What is written once, in large blocks, and read much later, goes
//! past that cache where the system can.

mod draft;
#[cfg(test)]
pub(crate) mod faulty;
mod pending;

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind};
use std::path::Path;

pub(crate) use draft::{Draft, folder, target};
pub use pending::Pending;

/// Addresses, places and lengths of bytes that go past the system's cache are multiples of this.
pub(crate) const PAGE: usize = 4096;

/// Opens a regular file to be read, and says what the system knows of it; anything else is an error at once.
///
/// *Trap.* To open a pipe is to wait until somebody writes to it.
pub(crate) fn open(path: &Path) -> io::Result<(File, Metadata)> {
    regular(path)?;
    let file = File::open(path)?;
    let about = file.metadata()?;
    Ok((file, about))
}

/// Refuses what is there and is no regular file.
pub(crate) fn regular(path: &Path) -> io::Result<()> {
    match fs::metadata(path)?.is_file() {
        true => Ok(()),
        false => Err(io::Error::new(ErrorKind::InvalidInput, "not a regular file")),
    }
}

/// Bytes by position: a file, or what a test puts in its place.
pub trait Store {
    /// Reads some bytes at `at`, none at the end.
    fn read_at(&self, buffer: &mut [u8], at: u64) -> io::Result<usize>;

    /// Writes some bytes at `at`.
    fn write_at(&self, bytes: &[u8], at: u64) -> io::Result<usize>;

    /// Makes sure there is room for so many bytes, where that can be known.
    fn reserve(&self, _bytes: u64) -> io::Result<()> {
        Ok(())
    }

    /// Waits until what was written would survive the machine.
    fn sync(&self) -> io::Result<()> {
        Ok(())
    }

    /// These bytes will be read soon.
    fn soon(&self, _at: u64, _bytes: u64) {}

    /// Has reads and writes go past the system's cache from now on, or no longer; whether they do.
    fn past_cache(&self, _past: bool) -> bool {
        false
    }

    /// Fills the buffer, in as many reads as it takes.
    fn read_exact_at(&self, buffer: &mut [u8], at: u64) -> io::Result<()> {
        let mut done = 0;
        while done < buffer.len() {
            match self.read_at(&mut buffer[done..], at + done as u64) {
                Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
                Ok(n) => done += n,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }

    /// Writes all bytes, in as many writes as it takes.
    fn write_all_at(&self, bytes: &[u8], at: u64) -> io::Result<()> {
        let mut done = 0;
        while done < bytes.len() {
            match self.write_at(&bytes[done..], at + done as u64) {
                Ok(0) => return Err(ErrorKind::WriteZero.into()),
                Ok(n) => done += n,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

impl Store for File {
    fn read_at(&self, buffer: &mut [u8], at: u64) -> io::Result<usize> {
        taut_points::read_at(self, buffer, at)
    }

    fn write_at(&self, bytes: &[u8], at: u64) -> io::Result<usize> {
        taut_points::write_at(self, bytes, at)
    }

    #[cfg(target_os = "linux")]
    fn reserve(&self, bytes: u64) -> io::Result<()> {
        use rustix::fs::{FallocateFlags, fallocate};
        use rustix::io::Errno;
        if bytes == 0 {
            return Ok(());
        }
        match fallocate(self, FallocateFlags::KEEP_SIZE, 0, bytes) {
            // Not every file system can; then a full disk shows when it is full.
            Err(Errno::OPNOTSUPP | Errno::NOSYS | Errno::INVAL) => Ok(()),
            result => Ok(result?),
        }
    }

    fn sync(&self) -> io::Result<()> {
        loop {
            match self.sync_all() {
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                result => return result,
            }
        }
    }

    #[cfg(target_os = "linux")]
    fn soon(&self, at: u64, bytes: u64) {
        // A hint: that it is refused changes nothing.
        let length = std::num::NonZeroU64::new(bytes);
        let _ = rustix::fs::fadvise(self, at, length, rustix::fs::Advice::WillNeed);
    }

    #[cfg(target_os = "linux")]
    fn past_cache(&self, past: bool) -> bool {
        use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
        // Not every file system can; then all goes by way of the cache.
        let set = |flags: OFlags| fcntl_setfl(self, flags & !OFlags::DIRECT | direct(past));
        past & fcntl_getfl(self).and_then(set).is_ok()
    }
}

#[cfg(target_os = "linux")]
fn direct(past: bool) -> rustix::fs::OFlags {
    if past { rustix::fs::OFlags::DIRECT } else { rustix::fs::OFlags::empty() }
}
