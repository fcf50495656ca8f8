//! A file of the system of which one call goes wrong, be it past the cache or by way of it.
//!
//! *Guarantee.* What a call is said to have moved has been moved, and nothing else: a short write leaves the rest of the
//! file as it was.

use std::borrow::Borrow;
use std::fs::File;
use std::io::{self, ErrorKind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering::Relaxed};

use super::Store;

/// The fault that occurs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fault {
    /// The call of this number, from 0, is refused: a read, a write, or a wait for the disk.
    Refused(u64, ErrorKind),
    /// The read or write of this number moves that many bytes at most, and not all if there are more than one.
    Short(u64, usize),
    /// There is no room behind this byte. What is before it is still written.
    Full(u64),
    /// As before, and told when room is reserved.
    FullAndTold(u64),
    /// Reads find the end here.
    Cut(u64),
}

/// The record of what happened to a file.
#[derive(Debug, Default)]
pub(crate) struct Record {
    /// Reads, writes and waits.
    pub(crate) calls: AtomicU64,
    /// Reads and writes past the cache.
    pub(crate) past_cache: AtomicU64,
    /// States whether something went wrong.
    pub(crate) has_failed: AtomicBool,
}

pub(crate) struct Faulty<'a> {
    file: File,
    fault: Option<Fault>,
    record: &'a Record,
    is_past: AtomicBool,
}

impl<'a> Faulty<'a> {
    pub(crate) fn new(file: File, fault: Option<Fault>, record: &'a Record) -> Self {
        Self { file, fault, record, is_past: AtomicBool::new(false) }
    }

    fn fails<T>(&self, how: T) -> T {
        self.record.has_failed.store(true, Relaxed);
        how
    }

    /// Returns how much of so many bytes at a place are moved.
    fn part(&self, bytes: usize, at: u64, is_write: bool) -> io::Result<usize> {
        let call = self.record.calls.fetch_add(1, Relaxed);
        self.record.past_cache.fetch_add(self.is_past.load(Relaxed).into(), Relaxed);
        let before = |end: u64| bytes.min(usize::try_from(end.saturating_sub(at)).unwrap_or(bytes));
        match self.fault {
            Some(Fault::Refused(number, kind)) if number == call => self.fails(Err(kind.into())),
            Some(Fault::Short(number, most)) if number == call => {
                self.fails(Ok(most.min(bytes.saturating_sub(1)).max(bytes.min(1))))
            }
            Some(Fault::Full(end) | Fault::FullAndTold(end)) if is_write && before(end) < bytes => {
                match before(end) {
                    0 => self.fails(Err(ErrorKind::StorageFull.into())),
                    some => Ok(some),
                }
            }
            Some(Fault::Cut(end)) if !is_write && before(end) < bytes => {
                self.fails(Ok(before(end)))
            }
            _ => Ok(bytes),
        }
    }

    /// Moves `part` of `whole` bytes. Past the cache the system moves whole pages only, but may stop within one.
    fn moved(
        &self,
        part: usize,
        whole: usize,
        call: impl FnOnce(&File) -> io::Result<usize>,
    ) -> io::Result<usize> {
        let is_past = part < whole && self.is_past.load(Relaxed);
        if is_past {
            self.file.past_cache(false);
        }
        let moved = call(&self.file);
        if is_past {
            self.file.past_cache(true);
        }
        moved
    }
}

impl Borrow<File> for Faulty<'_> {
    fn borrow(&self) -> &File {
        &self.file
    }
}

impl Store for Faulty<'_> {
    fn read_at(&self, buffer: &mut [u8], at: u64) -> io::Result<usize> {
        let (whole, part) = (buffer.len(), self.part(buffer.len(), at, false)?);
        self.moved(part, whole, |file| Store::read_at(file, &mut buffer[..part], at))
    }

    fn write_at(&self, bytes: &[u8], at: u64) -> io::Result<usize> {
        let part = self.part(bytes.len(), at, true)?;
        self.moved(part, bytes.len(), |file| Store::write_at(file, &bytes[..part], at))
    }

    fn reserve(&self, bytes: u64) -> io::Result<()> {
        match self.fault {
            Some(Fault::FullAndTold(end)) if bytes > end => {
                self.fails(Err(ErrorKind::StorageFull.into()))
            }
            _ => self.file.reserve(bytes),
        }
    }

    fn sync(&self) -> io::Result<()> {
        let call = self.record.calls.fetch_add(1, Relaxed);
        match self.fault {
            // An interruption is not told here: a file waits on by itself.
            Some(Fault::Refused(number, kind))
                if number == call && kind != ErrorKind::Interrupted =>
            {
                self.fails(Err(kind.into()))
            }
            // What a test sees does not depend on it.
            _ => Ok(()),
        }
    }

    fn soon(&self, at: u64, bytes: u64) {
        self.file.soon(at, bytes);
    }

    fn past_cache(&self, past: bool) -> bool {
        let is_past = self.file.past_cache(past);
        self.is_past.store(is_past, Relaxed);
        is_past
    }
}
