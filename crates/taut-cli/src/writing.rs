//! Text and pictures to files, whole or not at all, and words to standard output.

use std::io::Write;
use std::path::Path;

use anyhow::bail;
use taut_io::AtomicFile;

use crate::watch::interrupted;

/// Replaces the file `path` by `bytes`, or writes them to standard output for `-`.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    Ok(stage(path, bytes)?.commit()?)
}

/// Writes `bytes` where they take the place of `path` once they are committed; until then an earlier file stays as
/// it was. Of several files, all are staged before the first is committed.
pub(crate) fn stage(path: &Path, bytes: &[u8]) -> anyhow::Result<AtomicFile> {
    if interrupted() {
        bail!("interrupted: {} is as it was", path.display());
    }
    let mut file = taut_io::create(path)?;
    match file.write_all(bytes) {
        Ok(()) => Ok(file),
        Err(source) => Err(failed(file.path(), source)),
    }
}

/// Writes to standard output, at once.
pub(crate) fn say(bytes: &[u8]) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    let written = out.write_all(bytes).and_then(|()| out.flush());
    written.map_err(|source| failed("standard output", source))
}

fn failed(what: &str, source: std::io::Error) -> anyhow::Error {
    let said = format!("{what}: writing failed: {source}");
    anyhow::Error::new(source).context(said)
}
