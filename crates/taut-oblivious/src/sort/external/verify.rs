//! A second opinion on a sorted file: it is in order, and holds these records.
//!
//! Reads the file from front to back by plain calls of the standard library. Nothing here is shared with the sort: how
//! a key is read and compared and how records are hashed stands here once more, after the definitions in the docs.

use std::cmp::Ordering;
use std::fs::File;
use std::io::{BufReader, ErrorKind, Read};
use std::path::Path;

use taut_points::Monitor;

use super::{KeyKind, Multiset, RecordLayout};
use crate::error::Error;

/// What is found in a file of records.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inspection {
    /// The records, whatever their order.
    pub multiset: Multiset,
    /// The first record whose key is below the key before it; none if the file is sorted.
    pub descent: Option<u64>,
}

/// Reads a file of records: whether it is sorted, and what proves which records it holds.
///
/// Knows nothing of how it came about, and can be asked of any file. One read of the file.
///
/// # Errors
/// [`Error::Option`] for a layout that makes no sense, [`Error::File`], [`Error::Partial`], [`Error::Cancelled`].
pub fn inspect(
    path: &Path,
    layout: &RecordLayout,
    monitor: &Monitor<'_>,
) -> Result<Inspection, Error> {
    layout.check()?;
    let name = || path.display().to_string();
    let file = |source| Error::File { path: name(), source };
    let mut reader = BufReader::with_capacity(1 << 20, File::open(path).map_err(file)?);
    let (mut before, mut record) = (vec![0; layout.width], vec![0; layout.width]);
    let (mut records, mut sum, mut descent) = (0, 0u128, None);
    loop {
        let read = fill(&mut reader, &mut record).map_err(file)?;
        if read == 0 {
            break;
        }
        if read < layout.width {
            let bytes = records * layout.width as u64 + read as u64;
            return Err(Error::Partial { path: name(), bytes, width: layout.width });
        }
        sum = sum.wrapping_add(fingerprint(&record));
        if records > 0 && descent.is_none() && compare(layout, &before, &record).is_gt() {
            descent = Some(records);
        }
        std::mem::swap(&mut before, &mut record);
        records += 1;
        if records % (1 << 16) == 0 {
            monitor.check()?;
            monitor.points(1 << 16);
        }
    }
    monitor.points(records % (1 << 16));
    Ok(Inspection { multiset: Multiset { records, hash: sum }, descent })
}

/// Checks that a file is sorted and holds the records of a certificate.
///
/// # Errors
/// [`Error::UnsortedFile`] and [`Error::OtherRecords`] if it is not or does not; else those of [`inspect`].
pub fn verify(
    path: &Path,
    layout: &RecordLayout,
    certificate: &Multiset,
    monitor: &Monitor<'_>,
) -> Result<(), Error> {
    let found = inspect(path, layout, monitor)?;
    let path = path.display().to_string();
    if let Some(record) = found.descent {
        return Err(Error::UnsortedFile { path, record });
    }
    if found.multiset != *certificate {
        let (expected, found) = (certificate.records, found.multiset.records);
        return Err(Error::OtherRecords { path, expected, found });
    }
    Ok(())
}

/// Reads as much as there is room for, or up to the end.
fn fill(reader: &mut impl Read, to: &mut [u8]) -> std::io::Result<usize> {
    let mut done = 0;
    while done < to.len() {
        match reader.read(&mut to[done..]) {
            Ok(0) => break,
            Ok(more) => done += more,
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
    Ok(done)
}

/// The order of the keys of two records.
fn compare(layout: &RecordLayout, a: &[u8], b: &[u8]) -> Ordering {
    let (a, b) = (&a[layout.key.clone()], &b[layout.key.clone()]);
    let number = |key: &[u8]| {
        // Least significant byte first.
        key.iter().rev().fold(0u64, |number, &byte| number << 8 | u64::from(byte))
    };
    match layout.kind {
        KeyKind::U64 => number(a).cmp(&number(b)),
        KeyKind::I64 => (number(a) as i64).cmp(&(number(b) as i64)),
        KeyKind::F64 => f64::from_bits(number(a)).total_cmp(&f64::from_bits(number(b))),
        KeyKind::Bytes => a.cmp(b),
    }
}

/// The hash of one record: two lanes of 64 bits, of which each takes a word by a product of 128 bits whose halves meet.
fn fingerprint(record: &[u8]) -> u128 {
    let meet = |product: u128| (product as u64) ^ (product >> 64) as u64;
    let (mut low, mut high) = (0x243f_6a88_85a3_08d3_u64, 0x1319_8a2e_0370_7344_u64);
    let (first, second) = (0x9e37_79b9_7f4a_7c15_u128, 0xd6e8_feb8_6659_fd93_u128);
    for bytes in record.chunks(8) {
        let x = bytes.iter().rev().fold(0u64, |x, &byte| x << 8 | u64::from(byte));
        low = meet(u128::from(low ^ x) * first);
        high = meet(u128::from(high.wrapping_add(x.rotate_right(32))) * second);
    }
    low = meet(u128::from(low ^ 0xbf58_476d_1ce4_e5b9) * first);
    high = meet(u128::from(high ^ 0x94d0_49bb_1331_11eb) * second);
    u128::from(low) | u128::from(high) << 64
}
