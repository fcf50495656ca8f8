//! Bytes that travel between the places: little-endian numbers behind a line that says what they are and who wrote them.

use super::PartsError;

/// The version of taut that wrote bytes is part of them, as kernels of another version can round differently.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Bytes in the making.
#[derive(Clone, Debug)]
pub struct ByteWriter {
    bytes: Vec<u8>,
}

impl ByteWriter {
    /// Begins bytes that are a `what`, in one word.
    pub fn new(what: &str) -> Self {
        ByteWriter { bytes: format!("taut {VERSION} {what}\n").into_bytes() }
    }

    /// Appends a whole number.
    pub fn whole(&mut self, number: u64) {
        self.bytes.extend(number.to_le_bytes());
    }

    /// Appends the length of a list.
    pub fn count(&mut self, count: usize) {
        self.whole(count as u64);
    }

    /// Appends a number, bit by bit.
    pub fn float(&mut self, number: f64) {
        self.whole(number.to_bits());
    }

    /// Appends a list of numbers and its length.
    pub fn floats(&mut self, numbers: &[f64]) {
        self.count(numbers.len());
        numbers.iter().for_each(|&number| self.float(number));
    }

    /// Appends a list of whole numbers and its length.
    pub fn wholes(&mut self, numbers: &[u64]) {
        self.count(numbers.len());
        numbers.iter().for_each(|&number| self.whole(number));
    }

    /// All that was written.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

/// Bytes from which numbers are taken one after the other.
#[derive(Clone, Debug)]
pub struct ByteReader<'a> {
    what: &'static str,
    left: &'a [u8],
}

impl<'a> ByteReader<'a> {
    /// Begins to read bytes that should be a `what` of this version of taut.
    ///
    /// # Errors
    /// [`PartsError::Bytes`] if they are not.
    pub fn new(what: &'static str, bytes: &'a [u8]) -> Result<Self, PartsError> {
        let head = ByteWriter::new(what).into_bytes();
        let left = bytes.strip_prefix(&head[..]).ok_or(PartsError::Bytes { what })?;
        Ok(ByteReader { what, left })
    }

    /// The error for numbers that cannot be.
    pub fn wrong(&self) -> PartsError {
        PartsError::Bytes { what: self.what }
    }

    /// The next whole number.
    ///
    /// # Errors
    /// [`PartsError::Bytes`] if nothing is left.
    pub fn whole(&mut self) -> Result<u64, PartsError> {
        let (number, left) = self.left.split_first_chunk::<8>().ok_or(self.wrong())?;
        self.left = left;
        Ok(u64::from_le_bytes(*number))
    }

    /// The next whole number, as one that counts what memory holds.
    ///
    /// # Errors
    /// [`PartsError::Bytes`] if nothing is left, or if it is too large.
    pub fn size(&mut self) -> Result<usize, PartsError> {
        usize::try_from(self.whole()?).map_err(|_| self.wrong())
    }

    /// The length of a list whose elements take `size` bytes each, or more.
    ///
    /// # Errors
    /// [`PartsError::Bytes`] if fewer bytes are left.
    pub fn count(&mut self, size: usize) -> Result<usize, PartsError> {
        let count = self.whole()?;
        let fits = count.checked_mul(size as u64).is_some_and(|all| all <= self.left.len() as u64);
        if fits { Ok(count as usize) } else { Err(self.wrong()) }
    }

    /// The next number.
    ///
    /// # Errors
    /// As [`whole`](Self::whole).
    pub fn float(&mut self) -> Result<f64, PartsError> {
        self.whole().map(f64::from_bits)
    }

    /// The next list of numbers.
    ///
    /// # Errors
    /// As [`count`](Self::count).
    pub fn floats(&mut self) -> Result<Vec<f64>, PartsError> {
        let count = self.count(8)?;
        (0..count).map(|_| self.float()).collect()
    }

    /// The next list of whole numbers.
    ///
    /// # Errors
    /// As [`count`](Self::count).
    pub fn wholes(&mut self) -> Result<Vec<u64>, PartsError> {
        let count = self.count(8)?;
        (0..count).map(|_| self.whole()).collect()
    }

    /// Ends with `value` if all was read.
    ///
    /// # Errors
    /// [`PartsError::Bytes`] if something is left.
    pub fn end<T>(self, value: T) -> Result<T, PartsError> {
        if self.left.is_empty() { Ok(value) } else { Err(self.wrong()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_comes_back_and_damage_is_an_error() {
        let mut writer = ByteWriter::new("test");
        writer.wholes(&[1, u64::MAX]);
        writer.floats(&[-0.0, f64::MIN_POSITIVE, f64::INFINITY]);
        let bytes = writer.into_bytes();
        let read = |bytes: &[u8]| -> Result<(Vec<u64>, Vec<f64>), PartsError> {
            let mut reader = ByteReader::new("test", bytes)?;
            let read = (reader.wholes()?, reader.floats()?);
            reader.end(read)
        };
        let (wholes, floats) = read(&bytes).unwrap();
        assert_eq!(wholes, [1, u64::MAX]);
        assert!(floats[0].is_sign_negative() && floats[2] == f64::INFINITY);
        for end in 0..bytes.len() {
            assert!(read(&bytes[..end]).is_err(), "{end}");
        }
        assert!(read(&[&bytes[..], &[0]].concat()).is_err());
        assert!(ByteReader::new("other", &bytes).is_err());
        let huge = [&ByteWriter::new("test").into_bytes()[..], &[255; 8]].concat();
        assert!(read(&huge).is_err());
    }
}
