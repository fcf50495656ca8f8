//! Devices where a file is expected: most of them never end.

use std::fs::File;

use crate::Error;

/// Refuses a device that holds something and is no terminal, such as `/dev/zero` or a disk; `path` is the file as shown to
/// people. A device without a byte, as `/dev/null` is, reads like an empty file.
///
/// # Errors
/// [`Error::Device`].
#[cfg(unix)]
pub fn refuse_device(file: &File, path: &str) -> Result<(), Error> {
    use std::io::{IsTerminal, Read};
    use std::os::unix::fs::FileTypeExt;

    let is_device = file.metadata().is_ok_and(|found| {
        let kind = found.file_type();
        kind.is_char_device() || kind.is_block_device()
    });
    if !is_device || file.is_terminal() {
        return Ok(());
    }
    let mut reader = file;
    match reader.read(&mut [0]) {
        Ok(0) | Err(_) => Ok(()),
        Ok(_) => Err(Error::Device { path: path.to_owned() }),
    }
}

/// Refuses nothing: other systems show no devices as files.
///
/// # Errors
/// None.
#[cfg(not(unix))]
pub fn refuse_device(_: &File, _: &str) -> Result<(), Error> {
    Ok(())
}
