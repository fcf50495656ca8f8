//! Keys: 32 secret bytes from a file, from the environment or from the system's random numbers.

use std::io::{Read, Write};
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use zeroize::Zeroizing;

use super::StoreError;

/// Bytes of a key.
const KEY_BYTES: usize = 32;
/// Bytes of a key's file, at most: digits and the end of a line.
const FILE_BYTES_MAX: u64 = 1024;

/// A secret key; its bytes are overwritten when it is dropped.
#[derive(Clone)]
pub struct Key(Zeroizing<[u8; KEY_BYTES]>);

impl std::fmt::Debug for Key {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Key(secret)")
    }
}

impl Key {
    /// Makes a key of the system's random numbers.
    ///
    /// # Errors
    /// [`StoreError::Key`] where the system has none.
    pub fn generate() -> Result<Self, StoreError> {
        let mut bytes = Zeroizing::new([0; KEY_BYTES]);
        random(bytes.as_mut_slice())?;
        Ok(Key(bytes))
    }

    /// Takes 32 bytes.
    #[must_use]
    pub fn from_bytes(bytes: [u8; KEY_BYTES]) -> Self {
        Key(Zeroizing::new(bytes))
    }

    /// Reads 64 hexadecimal digits, or 44 characters of base64; `origin` is where the text is from, for messages.
    ///
    /// # Errors
    /// [`StoreError::Key`] for other texts.
    pub fn from_text(text: &str, origin: &str) -> Result<Self, StoreError> {
        let text = text.trim();
        let mut bytes = Zeroizing::new([0; KEY_BYTES]);
        let is_read = match text.len() {
            64 => read_hex(text, bytes.as_mut_slice()),
            _ => STANDARD.decode_slice(text, bytes.as_mut_slice()) == Ok(KEY_BYTES),
        };
        match is_read {
            true => Ok(Key(bytes)),
            false => Err(bad(origin, "expected 32 bytes as 64 hexadecimal digits or as base64")),
        }
    }

    /// Reads a key from a file: 32 bytes, or a text as [`Key::from_text`] takes it.
    ///
    /// # Errors
    /// [`StoreError::Key`] where the file is no key, or where others than its owner may read or change it (on Unix);
    /// [`StoreError::Io`].
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, StoreError> {
        let path = path.as_ref();
        let origin = path.display().to_string();
        let failed = |error| StoreError::io(path, error);
        let file = std::fs::File::open(path).map_err(failed)?;
        let metadata = file.metadata().map_err(failed)?;
        if !metadata.is_file() {
            return Err(bad(&origin, "it is not a regular file"));
        }
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            if metadata.permissions().mode() & 0o077 != 0 {
                let problem = "others than its owner may use the file; take that away (chmod 600)";
                return Err(bad(&origin, problem));
            }
        }
        let mut content = Zeroizing::new(Vec::with_capacity(FILE_BYTES_MAX as usize + 1));
        file.take(FILE_BYTES_MAX + 1).read_to_end(&mut content).map_err(failed)?;
        if let Ok(bytes) = <[u8; KEY_BYTES]>::try_from(content.as_slice()) {
            // Random bytes are all printable once in 10¹³ times.
            if bytes.iter().all(|byte| (b' '..=b'~').contains(byte)) {
                let problem = "32 printable characters are a passphrase and no key: make one with `taut hand key`";
                return Err(bad(&origin, problem));
            }
            return Ok(Key::from_bytes(bytes));
        }
        Key::from_text(std::str::from_utf8(&content).unwrap_or_default(), &origin)
    }

    /// Reads a key from a variable of the environment, as [`Key::from_text`] does; none where it is not set.
    ///
    /// # Errors
    /// [`StoreError::Key`] where the variable holds no key.
    pub fn from_environment(variable: &str) -> Result<Option<Self>, StoreError> {
        match std::env::var(variable) {
            Ok(text) => Key::from_text(&Zeroizing::new(text), variable).map(Some),
            Err(std::env::VarError::NotPresent) => Ok(None),
            Err(std::env::VarError::NotUnicode(_)) => Err(bad(variable, "it is not text")),
        }
    }

    /// Writes the key as hexadecimal digits to a new file that its owner alone may read.
    ///
    /// # Errors
    /// [`StoreError::Exists`] and [`StoreError::Io`].
    pub fn write_new(&self, path: impl AsRef<Path>) -> Result<(), StoreError> {
        let path = path.as_ref();
        let mut file = create_private(path)?;
        let mut text = Zeroizing::new(String::with_capacity(2 * KEY_BYTES + 1));
        self.0.iter().for_each(|byte| push_hex(&mut text, *byte));
        text.push('\n');
        let written = file.write_all(text.as_bytes()).and_then(|()| file.sync_all());
        written.map_err(|error| StoreError::io(path, error))
    }

    pub(super) fn bytes(&self) -> &[u8; KEY_BYTES] {
        &self.0
    }
}

/// Makes a new file that, on Unix, its owner alone may read.
pub(super) fn create_private(path: &Path) -> Result<std::fs::File, StoreError> {
    let mut options = std::fs::OpenOptions::new();
    options.write(true).create_new(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        options.mode(0o600);
    }
    options.open(path).map_err(|error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => {
            StoreError::Exists { path: path.display().to_string() }
        }
        _ => StoreError::io(path, error),
    })
}

/// Fills a buffer with random bytes of the system.
pub(super) fn random(bytes: &mut [u8]) -> Result<(), StoreError> {
    getrandom::fill(bytes).map_err(|error| bad("the system's random numbers", error))
}

fn bad(origin: &str, problem: impl std::fmt::Display) -> StoreError {
    StoreError::Key { origin: origin.to_owned(), problem: problem.to_string() }
}

/// Appends a byte as two hexadecimal digits.
pub(super) fn push_hex(text: &mut String, byte: u8) {
    let digit = |value: u8| char::from_digit(value.into(), 16).unwrap_or('0');
    text.push(digit(byte >> 4));
    text.push(digit(byte & 15));
}

/// Reads hexadecimal digits that fill a buffer.
pub(super) fn read_hex(text: &str, bytes: &mut [u8]) -> bool {
    let digits = text.as_bytes();
    let value = |digit: u8| char::from(digit).to_digit(16);
    digits.len() == 2 * bytes.len()
        && bytes.iter_mut().zip(digits.chunks_exact(2)).all(|(byte, pair)| {
            match (value(pair[0]), value(pair[1])) {
                (Some(high), Some(low)) => {
                    *byte = (16 * high + low) as u8;
                    true
                }
                _ => false,
            }
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_read_as_digits_and_as_base64() {
        let hex = "00".repeat(31) + "fF";
        let base = "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAP8=";
        let mut expected = [0; 32];
        expected[31] = 255;
        for text in [hex.as_str(), base, "  AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAP8=\n"] {
            assert_eq!(Key::from_text(text, "a test").unwrap().bytes(), &expected, "{text}");
        }
        for text in ["", "00", &hex[1..], &("g".repeat(64)), &(hex.clone() + "0"), &base[1..], "é"]
        {
            let error = Key::from_text(text, "a test").unwrap_err().to_string();
            assert!(error.contains("a test") && error.contains("32 bytes"), "{error}");
        }
        assert_eq!(format!("{:?}", Key::from_bytes([7; 32])), "Key(secret)");
        assert_ne!(Key::generate().unwrap().bytes(), Key::generate().unwrap().bytes());
    }
}
