//! Files of the folder that the environment variable `TAUT_DATA` names.

use crate::prelude::*;

/// Returns the path of a file; `None`, after saying so, where the folder does not hold it.
pub(crate) fn find(name: &str) -> Option<PathBuf> {
    let path = std::env::var_os("TAUT_DATA").map(|folder| Path::new(&folder).join(name));
    let path = path.filter(|path| path.exists());
    if path.is_none() {
        println!("left out: set TAUT_DATA to a folder with {name}");
    }
    path
}

/// Returns the text of a file that is compressed with xz; `None`, after saying so, where it is missing.
pub(crate) fn read_xz(name: &str) -> Result<Option<String>> {
    let Some(path) = find(name) else { return Ok(None) };
    let open =
        || std::io::read_to_string(liblzma::read::XzDecoder::new(std::fs::File::open(&path)?));
    Ok(Some(open().with_context(|| path.display().to_string())?))
}

/// Returns the text of a file that is compressed with gzip; `None`, after saying so, where it is missing.
pub(crate) fn read_gz(name: &str) -> Result<Option<String>> {
    let Some(path) = find(name) else { return Ok(None) };
    let open =
        || std::io::read_to_string(flate2::read::GzDecoder::new(std::fs::File::open(&path)?));
    Ok(Some(open().with_context(|| path.display().to_string())?))
}
