//! Arrays of NumPy in an archive, as `numpy.savez` and `savez_compressed` write it.
//!
//! *Read.* The one array of the archive, or the one whose name or number is chosen.
//! *Trap.* NumPy writes sizes of 64 bits, for small arrays too; the list at the end of the archive is what is read, as the local headers
//! may leave sizes open.
//! *Reference.* PKWARE, APPNOTE.TXT 6.3, sections 4.3 and 4.5; NumPy, `numpy.lib.format`.

use std::fs::File;
use std::io::{self, BufRead, BufReader, Cursor, Read, Seek, SeekFrom};

use flate2::Crc;
use flate2::bufread::DeflateDecoder;

use super::{Decoded, Seekable, npy};
use crate::input::{Job, Medium};
use crate::{Error, Feature, FilePlace, Format};

/// Bytes of the record at the end, with the longest comment.
const END_BYTES_MAX: u64 = 22 + 0xffff;

/// Bytes of the list of files, at most.
const LIST_BYTES_MAX: u64 = 1 << 26;

trait Archive: Read + Seek {}
impl<T: Read + Seek> Archive for T {}

/// A file in the archive.
struct Member {
    name: String,
    is_deflated: bool,
    packed: u64,
    checksum: u32,
    /// Where its local header begins.
    at: u64,
}

pub(super) fn read(job: &Job<'_>, medium: Medium) -> Result<Decoded, Error> {
    let mut archive: Box<dyn Archive> = match medium.seekable(job)? {
        Seekable::File(file) => Box::new(BufReader::<File>::new(file)),
        Seekable::Bytes(bytes) => Box::new(Cursor::new(bytes)),
    };
    let members = members(job, &mut *archive)?;
    let member = choose(job, &members)?;
    let mut local = [0; 30];
    read_at(job, &mut *archive, member.at, &mut local)?;
    if !local.starts_with(b"PK\x03\x04") {
        return Err(damaged(job, "an array is not where its list says"));
    }
    let lengths = u64::from(half(&local, 26)) + u64::from(half(&local, 28));
    let begin = member.at.saturating_add(30 + lengths);
    archive.seek(SeekFrom::Start(begin)).map_err(|source| Error::reading(job.path, source))?;
    let packed = BufReader::new(archive.take(member.packed));
    let stream: Box<dyn Read> = match member.is_deflated {
        true => Box::new(DeflateDecoder::new(packed)),
        false => Box::new(packed),
    };
    let other = damaged(job, "the checksum of the array is another one");
    let (sum, expected) = (Crc::new(), member.checksum);
    let summed = Summed { stream, sum, expected, other: Some(other) };
    let mut stream: Box<dyn BufRead> = Box::new(BufReader::new(summed));
    let header = npy::header(job, &mut stream)?;
    npy::decode(job, &header, stream)
}

/// A stream that ends with an error where its bytes have another checksum than the archive says.
struct Summed {
    stream: Box<dyn Read>,
    sum: Crc,
    expected: u32,
    /// The error, until it is given.
    other: Option<Error>,
}

impl Read for Summed {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let read = self.stream.read(bytes)?;
        self.sum.update(&bytes[..read]);
        let is_other = read == 0 && !bytes.is_empty() && self.sum.sum() != self.expected;
        match self.other.take_if(|_| is_other) {
            Some(other) => Err(io::Error::other(other)),
            None => Ok(read),
        }
    }
}

fn damaged(job: &Job<'_>, problem: &str) -> Error {
    Error::Damaged {
        path: job.path.to_owned(),
        format: Format::Npz,
        place: FilePlace::File,
        problem: problem.to_owned(),
    }
}

fn half(bytes: &[u8], at: usize) -> u16 {
    bytes.get(at..at + 2).map_or(0, |two| u16::from_le_bytes([two[0], two[1]]))
}

fn word(bytes: &[u8], at: usize) -> u32 {
    let four = bytes.get(at..at + 4).and_then(|four| four.try_into().ok());
    four.map_or(0, u32::from_le_bytes)
}

fn long(bytes: &[u8], at: usize) -> Option<u64> {
    bytes.get(at..at + 8).and_then(|eight| eight.try_into().ok()).map(u64::from_le_bytes)
}

fn read_at(
    job: &Job<'_>,
    archive: &mut dyn Archive,
    at: u64,
    bytes: &mut [u8],
) -> Result<(), Error> {
    let read = archive.seek(SeekFrom::Start(at)).and_then(|_| archive.read_exact(bytes));
    read.map_err(|source| match source.kind() {
        std::io::ErrorKind::UnexpectedEof => damaged(job, "it ends too early"),
        _ => Error::reading(job.path, source),
    })
}

/// The arrays that the list at the end names.
fn members(job: &Job<'_>, archive: &mut dyn Archive) -> Result<Vec<Member>, Error> {
    let failed = |source| Error::reading(job.path, source);
    let length = archive.seek(SeekFrom::End(0)).map_err(failed)?;
    let mut tail = vec![0; length.min(END_BYTES_MAX) as usize];
    let tail_at = length - tail.len() as u64;
    read_at(job, archive, tail_at, &mut tail)?;
    let end = tail.windows(4).rposition(|four| four == b"PK\x05\x06");
    let end = end.ok_or_else(|| damaged(job, "there is no list of its files at its end"))?;
    let record = &tail[end..];
    // Its last two bytes are the length of the comment that follows.
    if record.len() < 22 + usize::from(half(record, 20)) {
        return Err(damaged(job, "the list of its files is cut short"));
    }
    let mut size = u64::from(word(record, 12));
    let mut at = u64::from(word(record, 16));
    // The record of 64 bits is told by a locator before this one.
    let locator = (tail_at + end as u64).checked_sub(20);
    if let (true, Some(locator_at)) =
        (at == u64::from(u32::MAX) || size == u64::from(u32::MAX), locator)
    {
        let mut locator = [0; 20];
        read_at(job, archive, locator_at, &mut locator)?;
        let mut large = [0; 56];
        read_at(job, archive, long(&locator, 8).unwrap_or(0), &mut large)?;
        if !locator.starts_with(b"PK\x06\x07") || !large.starts_with(b"PK\x06\x06") {
            return Err(damaged(job, "its list of files is not where it should be"));
        }
        (size, at) = (long(&large, 40).unwrap_or(0), long(&large, 48).unwrap_or(0));
    }
    if size > LIST_BYTES_MAX || at.saturating_add(size) > length {
        return Err(damaged(job, "its list of files is longer than it can be"));
    }
    let mut list = vec![0; size as usize];
    read_at(job, archive, at, &mut list)?;
    let (mut members, mut rest) = (vec![], &list[..]);
    while rest.starts_with(b"PK\x01\x02") {
        let [name, extra, comment] = [28, 30, 32].map(|at| usize::from(half(rest, at)));
        let end = 46 + name + extra + comment;
        if end > rest.len() {
            return Err(damaged(job, "its list of files is cut short"));
        }
        let (text, more) = rest[46..].split_at(name);
        let flags = half(rest, 8);
        let (mut packed, whole, mut at) =
            (u64::from(word(rest, 20)), u64::from(word(rest, 24)), u64::from(word(rest, 42)));
        let most = u64::from(u32::MAX);
        sizes_of_64_bits(&more[..extra], whole == most, &mut packed, &mut at);
        let name = String::from_utf8_lossy(text).into_owned();
        let method = half(rest, 10);
        if let Some(array) = name.strip_suffix(".npy") {
            if flags & 1 != 0 || !matches!(method, 0 | 8) {
                return Err(damaged(
                    job,
                    "an array is encrypted, or packed in another way than by deflation",
                ));
            }
            let (name, is_deflated, checksum) = (array.to_owned(), method == 8, word(rest, 16));
            members.push(Member { name, is_deflated, packed, checksum, at });
        }
        rest = &rest[end..];
    }
    Ok(members)
}

/// Takes sizes that do not fit into 32 bits from the extra field, where they stand one after the other.
fn sizes_of_64_bits(extra: &[u8], is_whole_there: bool, packed: &mut u64, at: &mut u64) {
    let mut rest = extra;
    while rest.len() >= 4 {
        let (id, size) = (half(rest, 0), usize::from(half(rest, 2)));
        let field = rest.get(4..4 + size).unwrap_or_default();
        if id == 1 {
            let mut place = if is_whole_there { 8 } else { 0 };
            for value in [packed, at] {
                if *value == u64::from(u32::MAX) {
                    *value = long(field, place).unwrap_or(0);
                    place += 8;
                }
            }
            return;
        }
        rest = rest.get(4 + size..).unwrap_or_default();
    }
}

/// The array that is wanted, or the only one.
fn choose<'a>(job: &Job<'_>, members: &'a [Member]) -> Result<&'a Member, Error> {
    let names = || {
        let names: Vec<String> =
            members.iter().map(|member| format!("{:?}", member.name)).collect();
        names.join(", ")
    };
    let refused = |problem: String| Error::Feature { path: job.path.to_owned(), problem };
    match (&job.options.feature, members) {
        (_, []) => Err(damaged(job, "it holds no array")),
        (None, [only]) => Ok(only),
        (None, several) => Err(refused(format!(
            "it holds {} arrays: choose one with --select: {}",
            several.len(),
            names()
        ))),
        (Some(Feature::Name(name)), several) => {
            several.iter().find(|member| member.name == *name).ok_or_else(|| {
                refused(format!("no array has the name {name:?}; there are {}", names()))
            })
        }
        (Some(Feature::Number(number)), several) => {
            let found = usize::try_from(*number).ok().and_then(|number| several.get(number));
            found.ok_or_else(|| {
                refused(format!(
                    "there is no array {number}: it has {}, counted from 0",
                    several.len()
                ))
            })
        }
    }
}
