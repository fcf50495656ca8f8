//! Text and pictures to files, whole or not at all, and words to standard output.

use std::io::Write;
use std::path::Path;

use anyhow::anyhow;

/// Replaces the file `path` by `bytes`, or writes them to standard output for `-`; an earlier file stays as it was
/// until the last byte is on the disk.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    if path == Path::new("-") {
        return say(bytes);
    }
    let mut file = taut_io::create(path)?;
    file.write_all(bytes).map_err(|source| {
        anyhow!(
            "{}: writing failed: {source}; an earlier file of that name is as it was",
            file.path()
        )
    })?;
    Ok(file.commit()?)
}

/// Writes to standard output, at once.
pub(crate) fn say(bytes: &[u8]) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    out.write_all(bytes).and_then(|()| out.flush()).map_err(|source| {
        let said = format!("standard output: writing failed: {source}");
        anyhow::Error::new(source).context(said)
    })
}
