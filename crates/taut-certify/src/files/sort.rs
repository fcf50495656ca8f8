//! The checker of sorted files of records.
//!
//! *Idea.* The output is read from front to back: no key is below the one before it, and the multiset of its records is
//! that of the certificate. The input is read, too, if it is there, and must have that multiset.
//! *Guarantee.* In order: exact. The same records: two multisets that differ agree in 128 bits by chance only.
//! *Trap.* That records with equal keys keep their order is not proved: it would take memory for every key.

use std::cmp::Ordering;

use serde::{Deserialize, Serialize};
use taut_points::Monitor;

use super::bytes::Source;
use super::{FileAnswer, FileCheckError, FileVerdict, FileViolation, Files, Hash128, WhichFile};

/// The way in which the bytes of a key compare.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum KeyKind {
    /// As unsigned integers of 64 bits, least significant byte first.
    U64,
    /// As signed integers of 64 bits, least significant byte first.
    I64,
    /// As doubles, least significant byte first, in the total order of [`f64::total_cmp`].
    F64,
    /// As bytes, from the first one on.
    Bytes,
}

/// A file of records of fixed width in order of a key in each.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a sorted file: an object with records, width, key and key_kind"
)]
pub struct SortedFile {
    /// Number of records.
    pub records: u64,
    /// Bytes of a record, 1 to 2²⁴.
    pub width: u64,
    /// Bytes before the first record, 0 to 2²⁴, which are no records and the same in input and output.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub header: u64,
    /// The bytes of a record that are the key: the first, and the one after the last.
    pub key: [u64; 2],
    /// The meaning of these bytes.
    pub key_kind: KeyKind,
}

/// The proof of which records a sorted file holds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the certificate of a sorted file: an object with hash")]
pub struct SortCertificate {
    /// Sum of the hashes of all records, modulo 2¹²⁸, of the input and of the output; the bytes before the first record, if there are
    /// some, are one more.
    pub hash: Hash128,
}

/// Widest record, and most bytes before the first.
const WIDTH_MAX: u64 = 1 << 24;

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde calls it with a reference")]
fn is_zero(value: &u64) -> bool {
    *value == 0
}

impl FileAnswer for SortedFile {
    type Certificate = SortCertificate;
    const KIND: &'static str = "sort";

    fn check(
        &self,
        certificate: &SortCertificate,
        files: Files<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<FileVerdict, FileCheckError> {
        self.sound()?;
        let compared = files.input.is_some();
        let sources = [
            Some(Source::new(WhichFile::Output, files.output)?),
            files.input.map(|data| Source::new(WhichFile::Input, data)).transpose()?,
        ];
        let mut sources: Vec<Source<'_>> = sources.into_iter().flatten().collect();
        for source in &sources {
            let records = u128::from(self.records) * u128::from(self.width);
            let expected = u128::from(self.header) + records;
            if u128::from(source.length) != expected {
                let (file, found) = (source.which, source.length);
                return Err(FileViolation::Length { file, found, expected }.into());
            }
        }
        for source in &mut sources {
            let found = self.read(source, monitor)?;
            if found != certificate.hash {
                let (claimed, found) = (certificate.hash.to_string(), found.to_string());
                return Err(FileViolation::Hash { file: source.which, claimed, found }.into());
            }
        }
        Ok(FileVerdict { items: self.records, compared })
    }
}

impl SortedFile {
    fn sound(&self) -> Result<(), FileViolation> {
        let Self { width, header, key: [start, end], key_kind, .. } = *self;
        let wrong = |what, value, expected| Err(FileViolation::Number { what, value, expected });
        if !(1..=WIDTH_MAX).contains(&width) {
            return wrong("width", width.to_string(), "1 to 16777216 bytes");
        }
        if header > WIDTH_MAX {
            return wrong("header", header.to_string(), "0 to 16777216 bytes");
        }
        if start >= end || end > width {
            return wrong("key", format!("{start}:{end}"), "some bytes within the record");
        }
        if key_kind != KeyKind::Bytes && end - start != 8 {
            return wrong("key", format!("{start}:{end}"), "eight bytes for a number");
        }
        Ok(())
    }

    /// The multiset of a file; of the output it must be in order.
    fn read(
        &self,
        source: &mut Source<'_>,
        monitor: &Monitor<'_>,
    ) -> Result<Hash128, FileCheckError> {
        let ordered = source.which == WhichFile::Output;
        let key = self.key[0] as usize..self.key[1] as usize;
        let mut before = vec![0; key.len()];
        let (mut hash, mut number) = (Hash128::default(), 0);
        if self.header > 0 {
            let mut header = vec![0; self.header as usize];
            source.read_at(0, &mut header)?;
            hash.add([&header, &[]]);
        }
        source.items(self.header, self.width as usize, monitor, |record| {
            hash.add([record, &[]]);
            if ordered {
                let now = &record[key.clone()];
                if number > 0 && self.key_kind.compare(&before, now).is_gt() {
                    let file = WhichFile::Output;
                    return Err(FileViolation::Unsorted { file, record: number }.into());
                }
                before.copy_from_slice(now);
            }
            number += 1;
            Ok(())
        })?;
        Ok(hash)
    }
}

impl KeyKind {
    fn compare(self, a: &[u8], b: &[u8]) -> Ordering {
        let number = |key: &[u8]| key.iter().rev().fold(0u64, |n, &byte| n << 8 | u64::from(byte));
        match self {
            KeyKind::U64 => number(a).cmp(&number(b)),
            KeyKind::I64 => number(a).cast_signed().cmp(&number(b).cast_signed()),
            KeyKind::F64 => f64::from_bits(number(a)).total_cmp(&f64::from_bits(number(b))),
            KeyKind::Bytes => a.cmp(b),
        }
    }
}
