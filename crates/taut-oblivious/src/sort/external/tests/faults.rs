//! Sorts through files of which one call goes wrong: each call, and each place where the disk may be full.
//!
//! Either nothing comes of it but the error, which names the file, or the output is what it always is.

use std::io::ErrorKind;
use std::sync::atomic::Ordering::Relaxed;

use super::*;
use crate::sort::external::files;
use crate::store::faulty::{Fault, Faulty, Record};
use crate::test_length::long_or;

/// What is sorted, with which memory, and whether the runs have a name.
struct Case {
    folder: Folder,
    layout: RecordLayout,
    options: FileSortOptions,
    expected: Vec<u8>,
}

const EARLIER: &[u8] = b"earlier";

impl Case {
    fn new(n: u64, width: usize, memory: usize, resumes: bool) -> Self {
        let (bytes, layout) = (records(n, width, 0, u64::MAX), whole_number(width));
        let folder = Folder::with(&bytes);
        let resume = resumes.then(|| folder.path("runs"));
        let options = FileSortOptions { memory, resume, ..Default::default() };
        let expected = expected(&bytes, &layout);
        Self { folder, layout, options, expected }
    }

    /// Sorts with a fault in the file of one name: `in`, `out` or `runs`.
    fn sort(&self, name: &str, fault: Option<Fault>, record: &Record) -> Result<FileSort, Error> {
        fs::write(self.folder.path("out"), EARLIER).expect("written");
        let [input, output] = ["in", "out"].map(|name| self.folder.path(name));
        let (is_runs, silent) = (|path: &str| path.contains("runs"), Record::default());
        let open = |file, path: &str| {
            let is_it = if name == "runs" { is_runs(path) } else { path.ends_with(name) };
            if is_it { Faulty::new(file, fault, record) } else { Faulty::new(file, None, &silent) }
        };
        let monitor = Monitor::silent();
        files::sort(&input, &output, &self.layout, &self.options, &monitor, open)?.finish()
    }

    /// Returns how a file is called in errors.
    fn called(&self, name: &str) -> String {
        match name {
            "runs" if self.options.resume.is_none() => {
                format!("runs in {}", self.folder.0.path().display())
            }
            name => self.folder.path(name).display().to_string(),
        }
    }

    fn is_sorted(&self) -> bool {
        fs::read(self.folder.path("out")).expect("an output") == self.expected
    }

    /// Calls of the file of a name if nothing goes wrong, and those of them past the cache.
    fn calls(&self, name: &str) -> (u64, u64) {
        let record = Record::default();
        self.sort(name, None, &record).expect("sorted");
        assert!(self.is_sorted());
        (record.calls.into_inner(), record.past_cache.into_inner())
    }

    /// A fault that nobody sees afterwards.
    fn is_overcome(&self, name: &str, fault: Fault) {
        let record = Record::default();
        let found = self.sort(name, Some(fault), &record);
        assert!(found.is_ok() && self.is_sorted(), "{name}, {fault:?}: {found:?}");
        assert_eq!(self.folder.names(), ["in", "out"]);
    }

    /// A fault that is an error of one kind, of the file with this name.
    fn is_told(&self, name: &str, fault: Fault, kind: ErrorKind) {
        let record = Record::default();
        let found = self.sort(name, Some(fault), &record);
        assert!(record.has_failed.into_inner(), "{name}, {fault:?} never came");
        let Err(Error::File { path, source }) = found else {
            panic!("{name}, {fault:?}: {found:?}")
        };
        assert_eq!((path, source.kind()), (self.called(name), kind), "{fault:?}");
        assert_eq!(fs::read(self.folder.path("out")).expect("an output"), EARLIER, "{fault:?}");
        if self.options.resume.is_none() {
            assert_eq!(self.folder.names(), ["in", "out"], "{name}, {fault:?}");
            return;
        }
        // What is left of the runs is good for another start.
        let record = Record::default();
        let found = self.sort(name, None, &record);
        assert!(found.is_ok() && self.is_sorted(), "after {name}, {fault:?}: {found:?}");
        assert_eq!(self.folder.names(), ["in", "out"]);
    }

    /// Each call of each file, with all that may happen to it.
    fn every_call(&self, names: &[&str]) {
        for name in names {
            let calls = self.calls(name).0;
            // Odd, so that faults take turns.
            let step = long_or(1, ((calls / 4) | 1).min(9));
            for call in (0..calls).step_by(step as usize) {
                self.is_overcome(name, Fault::Refused(call, ErrorKind::Interrupted));
                // In turn a byte, and a page and a half, as the system may leave it past the cache.
                let moved = if call % 2 == 0 { 1 } else { 4096 + 2048 };
                self.is_overcome(name, Fault::Short(call, moved));
                let kinds = [ErrorKind::PermissionDenied, ErrorKind::StorageFull];
                let kind = kinds[call as usize / 2 % 2];
                self.is_told(name, Fault::Refused(call, kind), kind);
            }
        }
    }

    /// A disk that is full from one of these bytes on.
    fn full_at(&self, name: &str, places: impl Iterator<Item = u64>) {
        for k in places {
            for fault in [Fault::Full(k), Fault::FullAndTold(k)] {
                self.is_told(name, fault, ErrorKind::StorageFull);
            }
        }
    }
}

/// Two runs by way of the cache, the second one short.
fn by_runs(resumes: bool) -> Case {
    Case::new(75, 900, MEMORY_MIN, resumes)
}

/// In memory; by runs without a name; by runs with one.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn any_call_by_way_of_the_cache() {
    Case::new(40, 16, MEMORY_MIN, false).every_call(&["in", "out"]);
    by_runs(false).every_call(&["in", "runs", "out"]);
    by_runs(true).every_call(&["runs"]);
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_disk_full_from_any_byte_on() {
    let bytes = |n: u64, width| 0..n * width;
    Case::new(40, 16, MEMORY_MIN, false).full_at("out", bytes(40, 16).step_by(long_or(1, 7)));
    // Numbers without a common factor with blocks or records.
    let step = long_or(997, 2999);
    by_runs(false).full_at("out", bytes(75, 900).step_by(step));
    by_runs(false).full_at("runs", bytes(75, 900).step_by(step));
    let head = (0..400).step_by(long_or(41, 97));
    by_runs(true).full_at("runs", head.chain(bytes(75, 900).step_by(long_or(9001, 20_011))));
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn an_input_cut_at_any_place() {
    let case = by_runs(false);
    for end in (0..75 * 900).step_by(997) {
        case.is_told("in", Fault::Cut(end), ErrorKind::UnexpectedEof);
        case.is_told("runs", Fault::Cut(end), ErrorKind::UnexpectedEof);
    }
}

/// One less would fit into memory, and half a page is left over.
const RECORDS: u64 = 957;

/// Runs and output whose blocks are whole pages but for the last, large enough to go past the cache.
fn past_the_cache(resumes: bool) -> Case {
    Case::new(RECORDS, 2048, 2 << 20, resumes)
}

/// Returns true if files of the folder for temporary files can do it at all.
fn can_pass_the_cache() -> bool {
    let can = crate::store::Store::past_cache(&tempfile::tempfile().expect("a file"), true);
    if !can {
        eprintln!("left out: no file here can be written past the cache of the system");
    }
    can
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn any_call_past_the_cache() {
    if !can_pass_the_cache() {
        return;
    }
    let case = past_the_cache(false);
    for name in ["runs", "out"] {
        let (calls, past) = case.calls(name);
        assert!(past > 25 && past < calls, "{name}: {past} of {calls}");
    }
    case.every_call(&["runs", "out"]);
}

/// A file system that takes the flag and then refuses what is not in units of its own.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn any_call_that_cannot_pass_the_cache_after_all() {
    if !can_pass_the_cache() {
        return;
    }
    let case = past_the_cache(false);
    for name in ["runs", "out"] {
        let (calls, _) = case.calls(name);
        for call in (0..calls).step_by(long_or(1, 4)) {
            let (record, kind) = (Record::default(), ErrorKind::InvalidInput);
            let found = case.sort(name, Some(Fault::Refused(call, kind)), &record);
            assert!(record.has_failed.into_inner());
            match found {
                // From there on, by way of the cache.
                Ok(_) => assert!(case.is_sorted() && record.past_cache.load(Relaxed) <= call + 1),
                // By way of it already: the end of a run, or the wait at the end.
                Err(Error::File { path, source }) => {
                    assert_eq!((path, source.kind()), (case.called(name), kind));
                    assert_eq!(fs::read(case.folder.path("out")).expect("an output"), EARLIER);
                }
                Err(other) => panic!("{other}"),
            }
            assert_eq!(case.folder.names(), ["in", "out"]);
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_disk_full_from_any_place_on_past_the_cache() {
    if !can_pass_the_cache() {
        return;
    }
    let size = RECORDS * 2048;
    // At all distances from the start of a page.
    let step = long_or(9, 29) * 4096 + 1365;
    let places = || (0..size).step_by(step).chain([size - 1]);
    let case = past_the_cache(false);
    case.full_at("runs", places());
    case.full_at("out", places());
}
