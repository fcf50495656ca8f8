//! Reading files from front to back and from any place, with the name of the one that fails.

use std::io::{ErrorKind, Read, Seek, SeekFrom};

use taut_points::Monitor;

use super::{FileCheckError, WhichFile};

/// Bytes that can be read from any place: a file, or a cursor over memory.
pub trait Data: Read + Seek {}

impl<T: Read + Seek> Data for T {}

/// The files to judge.
pub struct Files<'a> {
    /// The input that was read, if it is there to be compared.
    pub input: Option<&'a mut dyn Data>,
    /// The output that was written.
    pub output: &'a mut dyn Data,
}

/// Bytes that are read in one go.
const BLOCK: usize = 1 << 20;

/// One of the files, and its length.
pub(super) struct Source<'a> {
    pub(super) which: WhichFile,
    pub(super) length: u64,
    data: &'a mut dyn Data,
}

impl<'a> Source<'a> {
    pub(super) fn new(which: WhichFile, data: &'a mut dyn Data) -> Result<Self, FileCheckError> {
        let length = data
            .seek(SeekFrom::End(0))
            .map_err(|source| FileCheckError::Read { file: which, source })?;
        Ok(Self { which, length, data })
    }

    /// Fills `to` from the byte `at` on.
    pub(super) fn read_at(&mut self, at: u64, to: &mut [u8]) -> Result<(), FileCheckError> {
        let read = self.data.seek(SeekFrom::Start(at)).and_then(|_| self.data.read_exact(to));
        read.map_err(|source| FileCheckError::Read { file: self.which, source })
    }

    /// Calls `work` with the items of `width` bytes from the byte `at` to the end of the file, many at a time.
    ///
    /// The bytes must be a whole number of items.
    pub(super) fn items(
        &mut self,
        at: u64,
        width: usize,
        monitor: &Monitor<'_>,
        mut work: impl FnMut(&[u8]) -> Result<(), FileCheckError>,
    ) -> Result<(), FileCheckError> {
        let count = (self.length - at) / width as u64;
        monitor.pass(1, count);
        let most = (BLOCK / width).max(1) as u64;
        let mut buffer = vec![0; (most.min(count) as usize) * width];
        let mut done = 0;
        while done < count {
            monitor.check()?;
            let items = most.min(count - done);
            let part = &mut buffer[..items as usize * width];
            self.read_at(at + done * width as u64, part)?;
            part.chunks_exact(width).try_for_each(&mut work)?;
            done += items;
            monitor.points(items);
        }
        Ok(())
    }

    /// Calls `work` with the lines of the file, without their ends.
    pub(super) fn lines(
        &mut self,
        monitor: &Monitor<'_>,
        mut work: impl FnMut(&[u8]) -> Result<(), FileCheckError>,
    ) -> Result<(), FileCheckError> {
        let failed = |source| FileCheckError::Read { file: WhichFile::Output, source };
        self.data.seek(SeekFrom::Start(0)).map_err(failed)?;
        let mut buffer = vec![0; BLOCK];
        let mut held = Vec::new();
        loop {
            monitor.check()?;
            let read = match self.data.read(&mut buffer) {
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                read => read.map_err(failed)?,
            };
            if read == 0 {
                break;
            }
            let mut rest = &buffer[..read];
            while let Some(end) = rest.iter().position(|&byte| byte == b'\n') {
                held.extend_from_slice(&rest[..end]);
                work(&held)?;
                held.clear();
                rest = &rest[end + 1..];
            }
            held.extend_from_slice(rest);
            // No number has so many digits; a file of one endless line must not fill memory.
            held.truncate(64);
        }
        if held.is_empty() { Ok(()) } else { work(&held) }
    }
}
