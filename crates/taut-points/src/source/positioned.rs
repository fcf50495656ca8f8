//! Reads and writes at a place of a file, for several threads that share one handle.
//!
//! *Trap.* To seek and then to read takes two steps, between which another thread may seek: that returns the bytes of another
//! place. Unix and Windows have calls that take the place with them; elsewhere a lock makes one step of the two.

use std::fs::File;
use std::io::{self, ErrorKind};

/// Reads some bytes at `offset`, none at the end of the file. On Windows it moves the cursor of the file.
///
/// # Errors
/// What the system says.
pub fn read_at(file: &File, buffer: &mut [u8], offset: u64) -> io::Result<usize> {
    #[cfg(unix)]
    return std::os::unix::fs::FileExt::read_at(file, buffer, offset);
    #[cfg(windows)]
    return std::os::windows::fs::FileExt::seek_read(file, buffer, offset);
    #[cfg(not(any(unix, windows)))]
    return locked(file, offset, |mut file| io::Read::read(&mut file, buffer));
}

/// Writes some of the bytes at `offset`. On Windows it moves the cursor of the file.
///
/// # Errors
/// What the system says.
pub fn write_at(file: &File, bytes: &[u8], offset: u64) -> io::Result<usize> {
    #[cfg(unix)]
    return std::os::unix::fs::FileExt::write_at(file, bytes, offset);
    #[cfg(windows)]
    return std::os::windows::fs::FileExt::seek_write(file, bytes, offset);
    #[cfg(not(any(unix, windows)))]
    return locked(file, offset, |mut file| io::Write::write(&mut file, bytes));
}

/// Moves the cursor and does the work, one thread at a time.
#[cfg(not(any(unix, windows)))]
fn locked<R>(file: &File, offset: u64, work: impl FnOnce(&File) -> io::Result<R>) -> io::Result<R> {
    use std::sync::{Mutex, PoisonError};
    static CURSOR: Mutex<()> = Mutex::new(());
    let _guard = CURSOR.lock().unwrap_or_else(PoisonError::into_inner);
    let mut cursor = file;
    io::Seek::seek(&mut cursor, io::SeekFrom::Start(offset))?;
    work(file)
}

/// Fills the buffer from `offset` on, in as many reads as it takes.
///
/// # Errors
/// What the system says, and [`ErrorKind::UnexpectedEof`] where the file ends before.
pub fn read_exact_at(file: &File, mut buffer: &mut [u8], mut offset: u64) -> io::Result<()> {
    while !buffer.is_empty() {
        match read_at(file, buffer, offset) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Ok(read) => {
                buffer = &mut buffer[read..];
                offset += read as u64;
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

/// Writes all bytes from `offset` on, in as many writes as it takes.
///
/// # Errors
/// What the system says, and [`ErrorKind::WriteZero`] where it takes no more.
pub fn write_all_at(file: &File, mut bytes: &[u8], mut offset: u64) -> io::Result<()> {
    while !bytes.is_empty() {
        match write_at(file, bytes, offset) {
            Ok(0) => return Err(ErrorKind::WriteZero.into()),
            Ok(written) => {
                bytes = &bytes[written..];
                offset += written as u64;
            }
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_that_share_a_handle_read_the_places_they_asked_for() {
        let file = tempfile::tempfile().unwrap();
        let words: Vec<u8> = (0..4096u64).flat_map(u64::to_le_bytes).collect();
        write_all_at(&file, &words, 0).unwrap();
        std::thread::scope(|scope| {
            for thread in 0..4u64 {
                let file = &file;
                scope.spawn(move || {
                    for step in 0..2000 {
                        let word = (step * 61 + thread * 1021) % 4096;
                        let mut bytes = [0; 8];
                        read_exact_at(file, &mut bytes, word * 8).unwrap();
                        assert_eq!(u64::from_le_bytes(bytes), word);
                    }
                });
            }
        });
        let past = read_exact_at(&file, &mut [0; 8], 4096 * 8 - 4).unwrap_err();
        assert_eq!(past.kind(), ErrorKind::UnexpectedEof);
    }
}
