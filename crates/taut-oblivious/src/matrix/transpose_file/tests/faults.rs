//! Transpositions through files of which one call goes wrong: each call, and each byte from which on the disk may be full.
//!
//! Either nothing comes of it but the error, which names the file, or the target is what it always is.

use super::*;
use crate::store::faulty::{Fault, Faulty, Record};
use crate::test_length::long_or;

/// Tiles of eight by eight, and narrower ones at the ends.
const MATRIX: FileMatrix = FileMatrix { rows: 20, columns: 15, width: 8, offset: 3 };
const OPTIONS: TransposeFileOptions = TransposeFileOptions { memory: 1024 };
const HEADER: &[u8] = b"head";
const EARLIER: &[u8] = b"earlier";

struct Case {
    folder: tempfile::TempDir,
    expected: Vec<u8>,
}

impl Case {
    fn new() -> Self {
        let (folder, from) = (tempfile::tempdir().unwrap(), bytes(3 + 20 * 15 * 8));
        std::fs::write(folder.path().join("from"), &from).unwrap();
        let expected = [HEADER, &plain(&from[3..], 20, 15, 8)].concat();
        Self { folder, expected }
    }

    fn target(&self) -> Vec<u8> {
        std::fs::read(self.folder.path().join("to")).unwrap()
    }

    /// Transposes with a fault in the file of one name; no more than the two files are there afterwards.
    fn run(
        &self,
        name: &str,
        fault: Option<Fault>,
        record: &Record,
    ) -> Result<FileTransposition, Error> {
        let [from, to] = ["from", "to"].map(|name| self.folder.path().join(name));
        std::fs::write(&to, EARLIER).unwrap();
        let silent = Record::default();
        let through = |file, path: &Path| match path.ends_with(name) {
            true => Faulty::new(file, fault, record),
            false => Faulty::new(file, None, &silent),
        };
        let found =
            transpose_through(&from, MATRIX, &to, HEADER, &OPTIONS, &Monitor::silent(), through)
                .and_then(Pending::finish);
        assert_eq!(std::fs::read_dir(self.folder.path()).unwrap().count(), 2, "{fault:?}");
        found
    }

    fn is_overcome(&self, name: &str, fault: Fault) {
        let found = self.run(name, Some(fault), &Record::default());
        assert!(found.is_ok() && self.target() == self.expected, "{name} {fault:?}: {found:?}");
    }

    fn is_told(&self, name: &str, fault: Fault, kind: ErrorKind) {
        let record = Record::default();
        let found = self.run(name, Some(fault), &record);
        assert!(record.has_failed.into_inner(), "{name} {fault:?} never came");
        match found {
            Err(Error::File { path, source }) => {
                assert!(Path::new(&path) == self.folder.path().join(name), "{path}");
                assert_eq!(source.kind(), kind, "{fault:?}");
            }
            other => panic!("{name} {fault:?}: {other:?}"),
        }
        assert_eq!(self.target(), EARLIER, "{fault:?}");
    }
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn any_call() {
    let case = Case::new();
    for name in ["from", "to"] {
        let record = Record::default();
        case.run(name, None, &record).unwrap();
        assert!(case.target() == case.expected);
        for call in 0..record.calls.into_inner() {
            case.is_overcome(name, Fault::Refused(call, ErrorKind::Interrupted));
            case.is_overcome(name, Fault::Short(call, 1 + call as usize % 60));
            case.is_told(name, Fault::Refused(call, ErrorKind::Other), ErrorKind::Other);
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_disk_full_and_a_file_cut_at_any_byte() {
    let case = Case::new();
    for k in (0..case.expected.len() as u64).step_by(long_or(1, 7)) {
        case.is_told("to", Fault::Full(k), ErrorKind::StorageFull);
    }
    for k in (0..case.expected.len() as u64).step_by(97) {
        case.is_told("to", Fault::FullAndTold(k), ErrorKind::StorageFull);
    }
    for k in (0..3 + 20 * 15 * 8).step_by(long_or(1, 5)) {
        case.is_told("from", Fault::Cut(k), ErrorKind::UnexpectedEof);
    }
}
