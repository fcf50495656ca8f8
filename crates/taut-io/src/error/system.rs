//! Explains what errors of the operating system mean for a file.

use std::io;

use crate::{Compression, Content, Error, Format};

impl Error {
    /// Returns what an error of opening or reading the file shown as `path` means, for those who read it themselves.
    pub fn reading(path: &str, source: io::Error) -> Error {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Error::NotFound { path },
            io::ErrorKind::IsADirectory => Error::Directory { path },
            io::ErrorKind::PermissionDenied => Error::Permission { path, action: "read" },
            // A decoder of ours has said it better, at the place where it happened.
            _ => match source.downcast::<Error>() {
                Ok(inner) => inner,
                Err(source) => Error::Read { path, source },
            },
        }
    }

    /// Returns what an error of creating or writing `path` means.
    pub fn writing(path: &str, source: io::Error) -> Error {
        let path = path.to_owned();
        match source.kind() {
            io::ErrorKind::NotFound => Error::NotFound { path },
            io::ErrorKind::IsADirectory => Error::Directory { path },
            io::ErrorKind::PermissionDenied => Error::Permission { path, action: "write" },
            _ => Error::Write { path, source },
        }
    }

    /// Returns what an error of writing a file means that would have replaced `path`.
    pub(crate) fn replacing(path: &str, source: io::Error) -> Error {
        match Error::writing(path, source) {
            Error::Write { path, source } => Error::Replace { path, source },
            other => other,
        }
    }

    /// Why no file compressed so is read or written.
    pub(crate) fn not_built(path: &str, compression: Compression) -> Error {
        let name = compression.name();
        Error::NotBuilt { path: path.to_owned(), name, feature: name }
    }

    /// Why such content is not read from a file of this format.
    pub(crate) fn not_readable(path: &str, format: Format, content: Content) -> Error {
        let path = path.to_owned();
        match format.holds(content) && !format.is_built() {
            true => Error::NotBuilt { path, name: format.name(), feature: "arrow" },
            false => Error::NotReadable { path, format, content },
        }
    }

    /// Why such content is not written to a file of this format.
    pub(crate) fn not_writable(path: &str, format: Format, content: Content) -> Error {
        let path = path.to_owned();
        match format.holds(content) && !format.is_built() {
            true => Error::NotBuilt { path, name: format.name(), feature: "arrow" },
            false => Error::NotWritable { path, format, content },
        }
    }
}
