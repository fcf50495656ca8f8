//! Which finished tiles nobody has written to since they got their names, so that a resumed run need not read them.
//!
//! *Idea.* When a tile is done, the system's record of its file is noted: device, number, length, and the time of the last
//! change, which every write and every rename moves and no program can set back. A resumed run compares it.
//! *Guarantee.* A tile with the same record has the bytes that were written, as long as the system has not been started again:
//! that it reached the disk is another question, so after a new start all notes are void. A note that is missing or broken
//! costs the reading of its tile, nothing else.
//! *Trap.* The system's clock of files may stand still for some milliseconds; a write by another program within that time
//! after a tile got its name is not seen here, but by the check of the folder. Where the system does not say when it was
//! started, which is anywhere but on Linux, there are no notes.
//! *Bytes*: the system's start, then node u64, device u64, file u64, length u64, seconds i64, nanoseconds i64 of each note.

use std::collections::HashMap;
use std::fs::{self, File, Metadata};
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::outofcore::bytes::Reader;

const NOTE_BYTES: usize = 48;

/// What the system records of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamp {
    device: u64,
    file: u64,
    length: u64,
    seconds: i64,
    nanoseconds: i64,
}

#[cfg(target_os = "linux")]
impl Stamp {
    fn of(found: &Metadata) -> Option<Self> {
        use std::os::unix::fs::MetadataExt;
        Some(Self {
            device: found.dev(),
            file: found.ino(),
            length: found.size(),
            seconds: found.ctime(),
            nanoseconds: found.ctime_nsec(),
        })
    }
}

#[cfg(not(target_os = "linux"))]
impl Stamp {
    fn of(_: &Metadata) -> Option<Self> {
        None
    }
}

/// Names the time since the system was started; `None` where it has no such name.
fn system_start() -> Option<Vec<u8>> {
    let path = cfg!(target_os = "linux").then_some("/proc/sys/kernel/random/boot_id")?;
    fs::read(path).ok().filter(|name| !name.is_empty())
}

/// The notes on the tiles of a folder.
#[derive(Debug)]
pub(super) struct Stamps {
    earlier: HashMap<u32, Stamp>,
    /// Where more notes go; `None` once one could not be written.
    file: Mutex<Option<File>>,
}

impl Stamps {
    /// Opens the notes in a file, or begins it.
    pub(super) fn open(path: &Path) -> Self {
        Self::open_since(path, system_start())
    }

    fn open_since(path: &Path, start: Option<Vec<u8>>) -> Self {
        let Some(start) = start else {
            return Self { earlier: HashMap::new(), file: Mutex::new(None) };
        };
        let bytes = fs::read(path).unwrap_or_default();
        let notes = bytes.strip_prefix(&*start).unwrap_or_default().as_chunks::<NOTE_BYTES>().0;
        let earlier = notes.iter().filter_map(parse).collect();
        // Written again, so that the next note does not follow half a note.
        let begun = File::create(path).and_then(|mut file| {
            file.write_all(&[&start, notes.as_flattened()].concat())?;
            Ok(file)
        });
        Self { earlier, file: Mutex::new(begun.ok()) }
    }

    /// Tests whether a tile was noted, and its file is still as it was then.
    pub(super) fn is_untouched(&self, node: u32, found: &Metadata) -> bool {
        let stamp = Stamp::of(found);
        stamp.is_some() && self.earlier.get(&node).copied() == stamp
    }

    /// Notes a tile that is known to have its bytes, by what the system said of its file before that was known.
    pub(super) fn note(&self, node: u32, found: &Metadata) {
        let Some(stamp) = Stamp::of(found) else { return };
        let mut note = Vec::with_capacity(NOTE_BYTES);
        for word in [u64::from(node), stamp.device, stamp.file, stamp.length] {
            note.extend(word.to_le_bytes());
        }
        note.extend(stamp.seconds.to_le_bytes());
        note.extend(stamp.nanoseconds.to_le_bytes());
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        // After half a note, on a full disk, none is readable.
        if file.as_mut().is_some_and(|file| file.write_all(&note).is_err()) {
            *file = None;
        }
    }
}

fn parse(note: &[u8; NOTE_BYTES]) -> Option<(u32, Stamp)> {
    let mut reader = Reader::new(note);
    let node = u32::try_from(reader.u64()?).ok()?;
    let stamp = Stamp {
        device: reader.u64()?,
        file: reader.u64()?,
        length: reader.u64()?,
        seconds: reader.u64()?.cast_signed(),
        nanoseconds: reader.u64()?.cast_signed(),
    };
    Some((node, stamp))
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    fn seen(path: &Path) -> Metadata {
        fs::metadata(path).unwrap()
    }

    /// So long that the system's clock of files has moved on.
    fn wait() {
        std::thread::sleep(std::time::Duration::from_millis(20));
    }

    #[test]
    fn a_file_is_untouched_until_it_is_written_to_or_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let (tile, notes) = (folder.path().join("tile"), folder.path().join("stamps"));
        fs::write(&tile, "four").unwrap();
        Stamps::open(&notes).note(7, &seen(&tile));
        let again = || Stamps::open(&notes);
        assert!(again().is_untouched(7, &seen(&tile)));
        assert!(!again().is_untouched(6, &seen(&tile)));
        let written = seen(&tile).modified().unwrap();
        wait();
        fs::write(&tile, "five").unwrap();
        // The time of the last write can be set back, that of the last change cannot.
        File::options().append(true).open(&tile).unwrap().set_modified(written).unwrap();
        assert_eq!(seen(&tile).modified().unwrap(), written);
        assert!(!again().is_untouched(7, &seen(&tile)));
        again().note(7, &seen(&tile));
        assert!(again().is_untouched(7, &seen(&tile)));
        let other = folder.path().join("other");
        fs::write(&other, "five").unwrap();
        fs::rename(&other, &tile).unwrap();
        assert!(!again().is_untouched(7, &seen(&tile)));
    }

    #[test]
    fn notes_are_void_after_a_new_start_of_the_system() {
        let folder = tempfile::tempdir().unwrap();
        let (tile, notes) = (folder.path().join("tile"), folder.path().join("stamps"));
        fs::write(&tile, "four").unwrap();
        let open = |start: &str| Stamps::open_since(&notes, Some(start.into()));
        open("first").note(7, &seen(&tile));
        assert!(open("first").is_untouched(7, &seen(&tile)));
        assert!(!open("other").is_untouched(7, &seen(&tile)));
        // That start has begun a file of its own.
        assert!(!open("first").is_untouched(7, &seen(&tile)));
        let unknown = Stamps::open_since(&notes, None);
        unknown.note(7, &seen(&tile));
        assert!(!unknown.is_untouched(7, &seen(&tile)));
    }

    #[test]
    fn half_a_note_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let (tile, notes) = (folder.path().join("tile"), folder.path().join("stamps"));
        fs::write(&tile, "four").unwrap();
        let stamps = Stamps::open(&notes);
        (1..4).for_each(|node| stamps.note(node, &seen(&tile)));
        let bytes = fs::read(&notes).unwrap();
        fs::write(&notes, &bytes[..bytes.len() - 9]).unwrap();
        let stamps = Stamps::open(&notes);
        let untouched = |stamps: &Stamps| -> Vec<u32> {
            (0..6).filter(|&k| stamps.is_untouched(k, &seen(&tile))).collect()
        };
        assert_eq!(untouched(&stamps), [1, 2]);
        stamps.note(5, &seen(&tile));
        assert_eq!(untouched(&Stamps::open(&notes)), [1, 2, 5]);
    }
}
