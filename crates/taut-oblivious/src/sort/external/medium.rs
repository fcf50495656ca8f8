//! A file with its name for errors, and counters; past the cache of the system where its blocks are whole pages.

use std::io::{self, ErrorKind};
use std::ops::Range;

use crate::error::Error;
use crate::store::{PAGE, Store};

pub(super) struct Medium<S> {
    store: S,
    path: String,
    pub(super) bytes_read: u64,
    pub(super) bytes_written: u64,
    /// True if whole pages are to go past the cache.
    past_cache: bool,
    /// True if the file is set to that just now.
    is_past: bool,
    /// Where the file begins for whoever reads and writes.
    start: u64,
}

impl<S: Store> Medium<S> {
    pub(super) fn new(store: S, path: String) -> Self {
        let (bytes_read, bytes_written, start) = (0, 0, 0);
        Self { store, path, bytes_read, bytes_written, past_cache: false, is_past: false, start }
    }

    /// Has all places count from this byte on.
    pub(super) fn start_at(&mut self, start: u64) {
        self.start = start;
    }

    /// Has whole pages go past the system's cache, as far as the system can.
    pub(super) fn past_cache(&mut self) {
        self.past_cache = true;
    }

    pub(super) fn into_store(self) -> S {
        self.store
    }

    pub(super) fn path(&self) -> &str {
        &self.path
    }

    /// Fills `bytes` from a place.
    pub(super) fn read(&mut self, bytes: &mut [u8], offset: u64) -> Result<(), Error> {
        self.bytes_read += bytes.len() as u64;
        let offset = self.start + offset;
        let (address, length) = (bytes.as_ptr().addr(), bytes.len());
        let some = |store: &S, part: Range<usize>| {
            let at = offset + part.start as u64;
            store.read_at(&mut bytes[part], at)
        };
        self.all(address, length, offset, ErrorKind::UnexpectedEof, some)
    }

    pub(super) fn write(&mut self, bytes: &[u8], offset: u64) -> Result<(), Error> {
        self.bytes_written += bytes.len() as u64;
        let offset = self.start + offset;
        let (address, length) = (bytes.as_ptr().addr(), bytes.len());
        let some = |store: &S, part: Range<usize>| {
            let at = offset + part.start as u64;
            store.write_at(&bytes[part], at)
        };
        self.all(address, length, offset, ErrorKind::WriteZero, some)
    }

    /// Calls `some` until all is moved; that nothing was is the error `stuck`.
    fn all(
        &mut self,
        address: usize,
        length: usize,
        offset: u64,
        stuck: ErrorKind,
        mut some: impl FnMut(&S, Range<usize>) -> io::Result<usize>,
    ) -> Result<(), Error> {
        let mut done = 0;
        while done < length {
            let left = length - done;
            let aligned = (address + done).is_multiple_of(PAGE)
                && (offset + done as u64).is_multiple_of(PAGE as u64);
            let past = self.past_cache && aligned && left >= PAGE;
            if past != self.is_past {
                let can = self.store.past_cache(past);
                self.past_cache &= can || !past;
                self.is_past = can;
            }
            let end = if self.is_past { length - left % PAGE } else { length };
            match some(&self.store, done..end) {
                Ok(0) => return Err(self.error(stuck.into())),
                Ok(more) => done += more,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                // The system wants other multiples than pages, or cannot after all.
                Err(error) if error.kind() == ErrorKind::InvalidInput && self.is_past => {
                    self.past_cache = false;
                }
                Err(error) => return Err(self.error(error)),
            }
        }
        Ok(())
    }

    pub(super) fn reserve(&self, bytes: u64) -> Result<(), Error> {
        self.store.reserve(self.start + bytes).map_err(|error| self.error(error))
    }

    pub(super) fn sync(&self) -> Result<(), Error> {
        self.store.sync().map_err(|error| self.error(error))
    }

    /// These bytes will be read soon: the system may bring them to its cache.
    pub(super) fn soon(&self, offset: u64, bytes: u64) {
        if !self.past_cache {
            self.store.soon(self.start + offset, bytes);
        }
    }

    fn error(&self, source: io::Error) -> Error {
        Error::File { path: self.path.clone(), source }
    }
}
