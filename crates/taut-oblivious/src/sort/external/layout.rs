//! Where the key of a record is, and how keys compare.

use std::cmp::Ordering;
use std::ops::Range;

use crate::error::Error;
use crate::key::rank;

/// The way in which the bytes of a key are to be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum KeyKind {
    /// A 64-bit unsigned integer, least significant byte first.
    U64,
    /// A 64-bit signed integer, least significant byte first.
    I64,
    /// A double, least significant byte first; in the total order of [`f64::total_cmp`].
    F64,
    /// Bytes in lexicographic order. Integers with the most significant byte first are sorted this way, too.
    Bytes,
}

impl KeyKind {
    /// All kinds with their names in Python and in JSON.
    pub const NAMES: [(&'static str, Self); 4] =
        [("u64", Self::U64), ("i64", Self::I64), ("f64", Self::F64), ("bytes", Self::Bytes)];
}

/// Records of fixed width, and the key in each.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct RecordLayout {
    /// Bytes of a record.
    pub width: usize,
    /// The bytes of it that are the key: eight for numbers.
    pub key: Range<usize>,
    /// The meaning of these bytes.
    pub kind: KeyKind,
}

impl RecordLayout {
    /// Tests whether it makes sense.
    pub(super) fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| Err(Error::Option { name, value, expected });
        if !(1..=1 << 24).contains(&self.width) {
            return wrong("width", self.width.to_string(), "1 to 16777216 bytes");
        }
        if self.key.start >= self.key.end || self.key.end > self.width {
            return wrong("key", format!("{:?}", self.key), "some bytes within the record");
        }
        if self.kind != KeyKind::Bytes && self.key.len() != 8 {
            return wrong("key", format!("{:?}", self.key), "eight bytes for a number");
        }
        Ok(())
    }

    /// A number in the order of the keys, but for keys of more than eight bytes that agree in these.
    #[inline]
    pub(super) fn rank(&self, record: &[u8]) -> u64 {
        let key = &record[self.key.clone()];
        if let Ok(word) = <[u8; 8]>::try_from(key) {
            return match self.kind {
                KeyKind::U64 => u64::from_le_bytes(word),
                KeyKind::I64 => rank(i64::from_le_bytes(word)),
                KeyKind::F64 => rank(f64::from_le_bytes(word)),
                KeyKind::Bytes => u64::from_be_bytes(word),
            };
        }
        let mut word = [0; 8];
        let first = key.len().min(8);
        word[..first].copy_from_slice(&key[..first]);
        u64::from_be_bytes(word)
    }

    pub(super) fn ranks(&self, records: &[u8], words: &mut [u64]) {
        let (start, width) = (self.key.start, self.width);
        // The kind of the key is looked at once, not for each record.
        if self.key.len() == 8 && self.kind == KeyKind::U64 {
            for (word, record) in words.iter_mut().zip(records.chunks_exact(width)) {
                *word = u64::from_le_bytes(record[start..].as_chunks().0[0]);
            }
            return;
        }
        for (word, record) in words.iter_mut().zip(records.chunks_exact(width)) {
            *word = self.rank(record);
        }
    }

    /// Returns true if ranks may be equal where keys are not.
    pub(super) fn is_long(&self) -> bool {
        self.key.len() > 8
    }

    /// The order of two keys whose ranks are equal.
    pub(super) fn compare_rest(&self, a: &[u8], b: &[u8]) -> Ordering {
        let rest =
            |record: &[u8]| self.key.start + 8.min(self.key.len())..self.key.end.min(record.len());
        a[rest(a)].cmp(&b[rest(b)])
    }
}
