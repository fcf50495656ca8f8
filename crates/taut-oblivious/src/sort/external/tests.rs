//! On files, on disks that fail, and against the checker of `taut-certify`, whose own tests show it doctored files.

mod dealt;
mod disk;
mod faults;
mod hash;
mod killed;
mod names;
mod resumed;

use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use proptest::prelude::*;
use taut_certify::{FileAnswer, Files, Hash128, SortCertificate, SortedFile};
use tempfile::TempDir;

use super::*;
use crate::test_length::long_or;

/// This is the least memory that is accepted, in bytes.
const MEMORY_MIN: usize = 64 << 10;

fn word(i: u64) -> u64 {
    let z = (i + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (z ^ z >> 29).wrapping_mul(0xBF58_476D_1CE4_E5B9)
}

/// Records of a width that have a number at `key`, masked so that keys repeat, and their place behind it.
fn records(n: u64, width: usize, key: usize, mask: u64) -> Vec<u8> {
    let mut bytes = vec![0; n as usize * width];
    for (i, record) in bytes.chunks_exact_mut(width).enumerate() {
        let (number, place) = (word(i as u64) & mask, (i as u32).to_le_bytes());
        let size = 8.min(width - key);
        record[key..key + size].copy_from_slice(&number.to_le_bytes()[..size]);
        for (byte, place) in record.iter_mut().rev().zip(place) {
            *byte ^= place;
        }
    }
    bytes
}

/// The standard library's stable sort, with keys read in its own way.
fn expected(bytes: &[u8], layout: &RecordLayout) -> Vec<u8> {
    let mut records: Vec<&[u8]> = bytes.chunks_exact(layout.width).collect();
    let key = |record: &[u8]| record[layout.key.clone()].to_vec();
    let eight = |record: &[u8]| <[u8; 8]>::try_from(key(record)).expect("eight bytes");
    match layout.kind {
        KeyKind::U64 => records.sort_by_key(|r| u64::from_le_bytes(eight(r))),
        KeyKind::I64 => records.sort_by_key(|r| i64::from_le_bytes(eight(r))),
        KeyKind::F64 => {
            records.sort_by(|a, b| {
                f64::from_le_bytes(eight(a)).total_cmp(&f64::from_le_bytes(eight(b)))
            });
        }
        KeyKind::Bytes => records.sort_by_key(|r| key(r)),
    }
    records.concat()
}

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a folder"))
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn with(bytes: &[u8]) -> Self {
        let folder = Self::new();
        fs::write(folder.path("in"), bytes).expect("written");
        folder
    }

    fn sort(&self, layout: &RecordLayout, memory: usize) -> Result<FileSort, Error> {
        self.sort_with(
            layout,
            &FileSortOptions { memory, ..Default::default() },
            &Monitor::silent(),
        )
    }

    fn sort_with(
        &self,
        layout: &RecordLayout,
        options: &FileSortOptions,
        monitor: &Monitor<'_>,
    ) -> Result<FileSort, Error> {
        sort_file(&self.path("in"), &self.path("out"), layout, options, monitor)
    }

    /// The checker confirms the output, by the certificate and by the records of the input.
    fn verify(&self, layout: &RecordLayout, certificate: &Multiset) {
        let [input, output] =
            ["in", "out"].map(|name| fs::File::open(self.path(name)).expect("a file"));
        verify(layout, certificate, input, output);
    }

    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("a folder");
        let mut names: Vec<String> = entries
            .map(|e| e.expect("an entry").file_name().into_string().expect("a name"))
            .collect();
        names.sort();
        names
    }
}

/// Checks a sorted file with the checker of `taut-certify`.
fn verify(
    layout: &RecordLayout,
    certificate: &Multiset,
    mut input: impl taut_certify::Data,
    mut output: impl taut_certify::Data,
) {
    let answer = SortedFile {
        records: certificate.records,
        width: layout.width as u64,
        header: 0,
        key: [layout.key.start as u64, layout.key.end as u64],
        key_kind: match layout.kind {
            KeyKind::U64 => taut_certify::KeyKind::U64,
            KeyKind::I64 => taut_certify::KeyKind::I64,
            KeyKind::F64 => taut_certify::KeyKind::F64,
            KeyKind::Bytes => taut_certify::KeyKind::Bytes,
        },
    };
    let certificate = SortCertificate { hash: Hash128(certificate.hash) };
    let files = Files { input: Some(&mut input), output: &mut output };
    let found = answer.check(&certificate, files, &Monitor::silent()).expect("confirmed");
    assert!(found.compared);
}

fn layout(width: usize, key: std::ops::Range<usize>, kind: KeyKind) -> RecordLayout {
    RecordLayout { width, key, kind }
}

fn whole_number(width: usize) -> RecordLayout {
    layout(width, 0..8, KeyKind::U64)
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn every_kind_of_key_in_memory_and_beyond() {
    let kinds = [
        layout(8, 0..8, KeyKind::U64),
        layout(16, 8..16, KeyKind::I64),
        layout(32, 3..11, KeyKind::F64),
        layout(17, 2..10, KeyKind::F64),
        layout(24, 0..5, KeyKind::Bytes),
        layout(40, 4..30, KeyKind::Bytes),
        layout(9, 1..9, KeyKind::Bytes),
        layout(1, 0..1, KeyKind::Bytes),
    ];
    for layout in kinds {
        for &n in long_or(&[0, 1, 2, 63, 64, 65, 9000][..], &[1, 64, 65, 9000]) {
            for &mask in long_or(&[u64::MAX, 0xFF, 0][..], &[0xFF, 0]) {
                let bytes = records(n, layout.width, layout.key.start, mask);
                let folder = Folder::with(&bytes);
                let found = folder.sort(&layout, MEMORY_MIN).expect("sorted");
                let sorted = fs::read(folder.path("out")).expect("an output");
                assert!(sorted == expected(&bytes, &layout), "{n} of {layout:?}, {found:?}");
                folder.verify(&layout, &found.certificate);
                assert_eq!(folder.names(), ["in", "out"]);
            }
        }
    }
}

/// Long keys that agree in their first eight bytes: words say nothing, the keys must be compared.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn long_keys_with_a_common_start() {
    let layout = layout(32, 0..20, KeyKind::Bytes);
    let mut bytes = records(6000, 32, 8, 0xFFFF);
    bytes.chunks_exact_mut(32).for_each(|record| record[..8].fill(7));
    let folder = Folder::with(&bytes);
    let found = folder.sort(&layout, MEMORY_MIN).expect("sorted");
    assert!(found.runs > 3);
    assert!(fs::read(folder.path("out")).expect("an output") == expected(&bytes, &layout));
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn memory_and_threads_change_no_byte() {
    let layout = whole_number(16);
    let bytes = records(60_000, 16, 0, 0xFFF);
    let expected = expected(&bytes, &layout);
    let folder = Folder::with(&bytes);
    for (memory, runs) in [(MEMORY_MIN, 24), (1 << 18, 6), (1 << 20, 2), (1 << 24, 1)] {
        for threads in [1, 3] {
            let pool =
                rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
            let found = pool.install(|| folder.sort(&layout, memory)).expect("sorted");
            assert_eq!(found.runs, runs);
            assert!(fs::read(folder.path("out")).expect("an output") == expected, "{memory}");
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn each_byte_is_read_twice_and_written_twice() {
    let bytes = records(40_000, 32, 0, u64::MAX);
    let folder = Folder::with(&bytes);
    let found = folder.sort(&whole_number(32), 256 << 10).expect("sorted");
    assert!(found.runs > 4);
    assert_eq!(found.bytes_read, 2 * bytes.len() as u64);
    assert_eq!(found.bytes_written, 2 * bytes.len() as u64);
    let found = folder.sort(&whole_number(32), 1 << 24).expect("sorted");
    assert_eq!((found.bytes_read, found.bytes_written), (bytes.len() as u64, bytes.len() as u64));
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_file_is_sorted_into_itself_and_an_old_output_is_replaced() {
    let layout = whole_number(8);
    let bytes = records(20_000, 8, 0, u64::MAX);
    let folder = Folder::with(&bytes);
    fs::write(folder.path("out"), "old").expect("written");
    folder.sort(&layout, MEMORY_MIN).expect("sorted");
    let path = folder.path("in");
    let options = FileSortOptions { memory: MEMORY_MIN, ..Default::default() };
    sort_file(&path, &path, &layout, &options, &Monitor::silent()).expect("sorted");
    assert!(fs::read(&path).expect("an output") == expected(&bytes, &layout));
    assert!(fs::read(folder.path("out")).expect("an output") == expected(&bytes, &layout));
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn wrong_calls_are_answered_by_name() {
    let folder = Folder::with(&[0; 100]);
    let said = |layout: &RecordLayout, memory| {
        let error = folder.sort(layout, memory).expect_err("refused");
        assert_eq!(folder.names(), ["in"]);
        error.to_string()
    };
    assert!(said(&whole_number(16), MEMORY_MIN).contains("100 bytes"));
    assert!(said(&layout(0, 0..0, KeyKind::Bytes), MEMORY_MIN).contains("`width`"));
    assert!(said(&layout(10, 4..11, KeyKind::Bytes), MEMORY_MIN).contains("`key`"));
    assert!(said(&layout(10, 4..4, KeyKind::Bytes), MEMORY_MIN).contains("`key`"));
    assert!(said(&layout(10, 0..7, KeyKind::F64), MEMORY_MIN).contains("eight bytes"));
    assert!(said(&layout(10, 0..8, KeyKind::F64), MEMORY_MIN - 1).contains("`memory`"));
    assert!(said(&layout(50, 0..8, KeyKind::F64), 0).contains("`memory`"));
    let missing = FileSortOptions::default();
    let (nowhere, out) = (folder.path("nowhere"), folder.path("out"));
    let error = sort_file(&nowhere, &out, &whole_number(10), &missing, &Monitor::silent());
    assert!(matches!(error, Err(Error::File { path, .. }) if path.ends_with("nowhere")));
    let error = sort_file(folder.0.path(), &out, &whole_number(10), &missing, &Monitor::silent());
    assert!(error.expect_err("refused").to_string().contains("not a regular file"));
}

/// To open a pipe that nobody writes to would be to wait endlessly.
#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_pipe_is_refused_at_once() {
    use rustix::fs::{CWD, FileType, Mode, mknodat};
    let folder = Folder::with(&records(5000, 16, 0, u64::MAX));
    mknodat(CWD, folder.path("pipe"), FileType::Fifo, Mode::RUSR | Mode::WUSR, 0).expect("a pipe");
    let said = |input: &str, resume: Option<&str>| {
        let resume = resume.map(|name| folder.path(name));
        let options = FileSortOptions { memory: MEMORY_MIN, resume, ..Default::default() };
        let (input, output) = (folder.path(input), folder.path("out"));
        let found = sort_file(&input, &output, &whole_number(16), &options, &Monitor::silent());
        found.expect_err("refused").to_string()
    };
    assert!(said("pipe", None).contains("not a regular file"));
    assert!(said("in", Some("pipe")).contains("not a regular file"));
    assert_eq!(folder.names(), ["in", "pipe"]);
}

/// Stopped at any block, the work leaves nothing; and no more than three files are open at any time.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn stopped_anywhere_nothing_is_left() {
    let layout = whole_number(32);
    let folder = Folder::with(&records(30_000, 32, 0, u64::MAX));
    let options = FileSortOptions { memory: MEMORY_MIN, ..Default::default() };
    for limit in [0, 1, 10_000, 29_999, 30_001, 45_000, 59_000] {
        let (cancel, points) = (AtomicBool::new(limit == 0), AtomicU64::new(0));
        let count = |more: u64| {
            if points.fetch_add(more, Ordering::Relaxed) + more >= limit {
                cancel.store(true, Ordering::Relaxed);
            }
            assert!(files_open(folder.0.path()) <= 3);
        };
        let monitor =
            Monitor { on_points: Some(&count), cancel: Some(&cancel), ..Monitor::silent() };
        let stopped = folder.sort_with(&layout, &options, &monitor);
        assert!(matches!(stopped, Err(Error::Cancelled(_))), "{limit}: {stopped:?}");
        assert_eq!(folder.names(), ["in"]);
    }
}

/// Returns how many open files of this process are, or were, in a folder.
fn files_open(folder: &std::path::Path) -> usize {
    let Ok(open) = fs::read_dir("/proc/self/fd") else { return 0 };
    open.filter_map(|entry| fs::read_link(entry.ok()?.path()).ok())
        .filter(|path| path.starts_with(folder))
        .count()
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn passes_and_records_are_told() {
    let folder = Folder::with(&records(40_000, 16, 0, u64::MAX));
    let (passes, points) = (AtomicU64::new(0), AtomicU64::new(0));
    let pass = |number: u64, records: u64| {
        passes.store(number, Ordering::Relaxed);
        assert!(number > 0 && records <= 40_000);
    };
    let count = |more: u64| {
        points.fetch_add(more, Ordering::Relaxed);
    };
    let monitor = Monitor { on_points: Some(&count), on_pass: Some(&pass), cancel: None };
    let options = FileSortOptions { memory: MEMORY_MIN, ..Default::default() };
    let found = folder.sort_with(&whole_number(16), &options, &monitor).expect("sorted");
    assert_eq!((found.runs, passes.into_inner()), (16, 3));
    // Sixteen runs are one too many: two are merged first.
    assert!(points.into_inner() > 2 * 40_000);
}

/// The most memory this process has used at any time, in bytes; 0 where the system does not say.
fn peak() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
    kib.unwrap_or(0) << 10
}

/// As large as it takes to see that memory stays within its limit. `TMPDIR` says where.
#[test]
#[ignore = "writes 9.6 GB: a hundred million records, their runs and the output, and looks at the peak of the process"]
fn a_hundred_million_records_within_their_memory() {
    let n = 100_000_000;
    let folder = Folder::new();
    let file = fs::File::create(folder.path("in")).expect("a file");
    let mut to = std::io::BufWriter::with_capacity(1 << 20, file);
    for i in 0..4 * n {
        std::io::Write::write_all(&mut to, &word(i).to_le_bytes()).expect("room");
    }
    drop(to);
    let layout = whole_number(32);
    let found = folder.sort(&layout, 256 << 20).expect("sorted");
    assert_eq!((found.bytes_read, found.bytes_written), (64 * n, 64 * n));
    assert!(peak() <= 288 << 20, "{} MiB", peak() >> 20);
    folder.verify(&layout, &found.certificate);
}
