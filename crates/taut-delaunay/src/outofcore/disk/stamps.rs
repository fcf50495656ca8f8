//! Notes by which a resumed run knows tiles that nobody wrote to since they got their names; it need not read these.
//!
//! *Idea.* When a tile is done, the metadata of its file are noted: device, inode number, length, and the time of the last change
//! (ctime). Each write moves that time, and no ordinary call sets it. A resumed run compares them.
//! *Guarantee.* Nobody wrote to a tile with the same metadata through the file system, until the system is started again: whether
//! the bytes reached the disk is another question, so notes of another start (boot ID) are void. A note that is missing or broken
//! costs the reading of its tile, nothing else.
//! *Trap.* Some file systems have no such time, or one of whole seconds: there are no notes but on those of [`LOCAL`]. Even there
//! the clock of files may stand still for 10 ms; and a page that another process has mapped may be written to twice with one change
//! of the time. Such a write, and damage on the medium itself, are found by the check of the folder alone.
//! *Trap.* Only Linux has a boot ID; elsewhere there are no notes.
//! *Bytes*: the boot ID, then node u64, device u64, inode u64, length u64, seconds i64, nanoseconds i64 of each note.

use std::collections::HashMap;
use std::fs::{self, File, Metadata};
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use crate::outofcore::bytes::Reader;

const NOTE_BYTES: usize = 48;

/// Metadata that tell whether a file was written to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Stamp {
    device: u64,
    inode: u64,
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
            inode: found.ino(),
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

/// File systems that move the time of the last change with each write: ext2 to ext4, XFS, Btrfs, F2FS, bcachefs, ZFS, tmpfs, and
/// overlays of these.
#[cfg(target_os = "linux")]
const LOCAL: [u32; 8] = [
    0xEF53,
    0x5846_5342,
    0x9123_683E,
    0xF2F5_2010,
    0xCA45_1A4E,
    0x2FC1_2FC1,
    0x0102_1994,
    0x794C_7630,
];

/// The boot ID of the system, if the file system of a folder is one of [`LOCAL`].
#[cfg(target_os = "linux")]
fn boot_id(folder: &Path) -> Option<Vec<u8>> {
    let kind = rustix::fs::statfs(folder).ok()?.f_type;
    // The kind has 32 bits, and a type that differs between machines.
    if !LOCAL.contains(&(kind as u32)) {
        return None;
    }
    fs::read("/proc/sys/kernel/random/boot_id").ok().filter(|name| !name.is_empty())
}

#[cfg(not(target_os = "linux"))]
fn boot_id(_: &Path) -> Option<Vec<u8>> {
    None
}

/// The notes on the tiles of a folder.
#[derive(Debug)]
pub(super) struct Stamps {
    earlier: HashMap<u32, Stamp>,
    /// The file of all notes; `None` once one could not be written.
    file: Mutex<Option<File>>,
}

impl Stamps {
    /// Opens the notes in a file, or begins it.
    pub(super) fn open(path: &Path) -> Self {
        Self::open_in(path, path.parent().and_then(boot_id))
    }

    /// Tests whether there are notes on files in this folder.
    #[cfg(test)]
    pub(super) fn has_notes_in(folder: &Path) -> bool {
        boot_id(folder).is_some()
    }

    fn open_in(path: &Path, boot: Option<Vec<u8>>) -> Self {
        let Some(boot) = boot else {
            return Self { earlier: HashMap::new(), file: Mutex::new(None) };
        };
        let bytes = fs::read(path).unwrap_or_default();
        let notes = bytes.strip_prefix(&*boot).unwrap_or_default().as_chunks::<NOTE_BYTES>().0;
        let earlier = notes.iter().filter_map(parse).collect();
        // Written again, so that the next note does not follow half a note.
        let begun = File::create(path).and_then(|mut file| {
            file.write_all(&[&boot, notes.as_flattened()].concat())?;
            Ok(file)
        });
        Self { earlier, file: Mutex::new(begun.ok()) }
    }

    /// Tests whether a tile was noted, and its file is still as it was then.
    pub(super) fn is_untouched(&self, node: u32, found: &Metadata) -> bool {
        let stamp = Stamp::of(found);
        stamp.is_some() && self.earlier.get(&node).copied() == stamp
    }

    /// Notes a tile, by metadata that its file had before its bytes were known, or when it got its name.
    pub(super) fn note(&self, node: u32, found: &Metadata) {
        let Some(stamp) = Stamp::of(found) else { return };
        let mut note = Vec::with_capacity(NOTE_BYTES);
        for word in [u64::from(node), stamp.device, stamp.inode, stamp.length] {
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
        inode: reader.u64()?,
        length: reader.u64()?,
        seconds: reader.u64()?.cast_signed(),
        nanoseconds: reader.u64()?.cast_signed(),
    };
    Some((node, stamp))
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    /// On any file system.
    fn open(path: &Path) -> Stamps {
        Stamps::open_in(path, Some("boot".into()))
    }

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
        open(&notes).note(7, &seen(&tile));
        let again = || open(&notes);
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
        let open = |boot: &str| Stamps::open_in(&notes, Some(boot.into()));
        open("first").note(7, &seen(&tile));
        assert!(open("first").is_untouched(7, &seen(&tile)));
        assert!(!open("other").is_untouched(7, &seen(&tile)));
        // That start has begun a file of its own.
        assert!(!open("first").is_untouched(7, &seen(&tile)));
        let unknown = Stamps::open_in(&notes, None);
        unknown.note(7, &seen(&tile));
        assert!(!unknown.is_untouched(7, &seen(&tile)));
    }

    #[test]
    fn half_a_note_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let (tile, notes) = (folder.path().join("tile"), folder.path().join("stamps"));
        fs::write(&tile, "four").unwrap();
        let stamps = open(&notes);
        (1..4).for_each(|node| stamps.note(node, &seen(&tile)));
        let bytes = fs::read(&notes).unwrap();
        fs::write(&notes, &bytes[..bytes.len() - 9]).unwrap();
        let stamps = open(&notes);
        let untouched = |stamps: &Stamps| -> Vec<u32> {
            (0..6).filter(|&k| stamps.is_untouched(k, &seen(&tile))).collect()
        };
        assert_eq!(untouched(&stamps), [1, 2]);
        stamps.note(5, &seen(&tile));
        assert_eq!(untouched(&open(&notes)), [1, 2, 5]);
    }
}
