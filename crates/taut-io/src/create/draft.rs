//! Temporary files beside the outputs they will become, and the removal of those that a process left behind.
//!
//! *Idea.* A temporary file is locked as long as its process lives. Whoever makes another one in the same folder takes the
//! lock of each that is there: where that succeeds, the process is dead, killed before it could clean up, and its file is
//! removed. The lock goes with the process, so no clock and no process number is trusted.
//! *Trap.* Between the creation and the lock of a file another process may take it for one left behind. So a file that
//! cannot be locked, or has lost its name by the time it is, is given up for a new one.

use std::fs::{self, File, Permissions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

use tempfile::NamedTempFile;

/// The beginning of the names of temporary files.
pub(super) const PREFIX: &str = ".taut-tmp-";

/// The number of times that a new file may be taken away before its lock, by one process after the other.
const ATTEMPTS_MAX: usize = 8;

/// The temporary files of this process that have not taken their names.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// A temporary file, in the list of the unfinished ones.
#[derive(Debug)]
pub(super) struct Draft {
    file: NamedTempFile,
    entry: Entry,
}

/// An entry of the list of unfinished files, as long as it lives.
#[derive(Debug)]
struct Entry(PathBuf);

impl Entry {
    fn new(path: &Path) -> Self {
        if let Ok(mut unfinished) = UNFINISHED.lock() {
            unfinished.push(path.to_owned());
        }
        Entry(path.to_owned())
    }
}

impl Drop for Entry {
    fn drop(&mut self) {
        if let Ok(mut unfinished) = UNFINISHED.lock() {
            unfinished.retain(|path| *path != self.0);
        }
    }
}

impl Draft {
    /// A file in `folder`, with the permissions of the earlier one or those of any new one.
    pub(super) fn new(folder: &Path, earlier: Option<Permissions>) -> io::Result<Self> {
        sweep(folder);
        let mut builder = tempfile::Builder::new();
        builder.prefix(PREFIX);
        // Temporary files are private unless told otherwise; the umask is applied to this by the system.
        #[cfg(unix)]
        if earlier.is_none() {
            builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
        }
        let mut file = builder.tempfile_in(folder)?;
        for _ in 1..ATTEMPTS_MAX {
            if is_locked(&file) {
                break;
            }
            file = builder.tempfile_in(folder)?;
        }
        if let Some(permissions) = earlier {
            // Set before the first byte is written: what was private is so at every moment.
            file.as_file().set_permissions(permissions)?;
        }
        let entry = Entry::new(file.path());
        Ok(Draft { file, entry })
    }

    /// Brings the bytes to the disk and gives the file its name.
    pub(super) fn publish(self, path: &Path) -> io::Result<()> {
        let Draft { file, entry } = self;
        file.as_file().sync_all()?;
        file.persist(path).map_err(|error| error.error)?;
        drop(entry);
        Ok(())
    }
}

impl io::Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Takes the lock of a new file. False if it has no name any more; true where the file system has no locks, as nobody
/// removes files there.
fn is_locked(file: &NamedTempFile) -> bool {
    match file.as_file().try_lock() {
        Ok(()) | Err(TryLockError::Error(_)) => file.path().exists(),
        Err(TryLockError::WouldBlock) => false,
    }
}

/// Removes the temporary files in a folder whose processes are dead; what cannot be removed stays.
fn sweep(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let is_ours = entry.file_name().to_str().is_some_and(|name| name.starts_with(PREFIX));
        // To open a pipe of that name would be to wait for its other end.
        if !is_ours || !entry.file_type().is_ok_and(|kind| kind.is_file()) {
            continue;
        }
        let path = entry.path();
        let Ok(file) = File::open(&path) else { continue };
        if file.try_lock().is_ok() {
            fs::remove_file(&path).ok();
        }
    }
}

/// Removes the temporary files of all outputs that are not finished, for a process that is about to end at once.
///
/// It neither waits nor allocates, so it may be called where memory has run out: a file that another thread is about to begin
/// or to finish stays, and so does one with a very long path.
pub fn remove_unfinished() {
    /// The standard library makes no copy on the heap of a path of fewer bytes.
    const PATH_BYTES_MAX: usize = 300;
    let Ok(unfinished) = UNFINISHED.try_lock() else { return };
    for path in unfinished.iter().filter(|path| path.as_os_str().len() < PATH_BYTES_MAX) {
        fs::remove_file(path).ok();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_unlocked_temporary_files_are_swept() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in [".taut-tmp-dead", ".taut-other", "taut-tmp-mine", ".taut-tmp-alive"] {
            fs::write(at(name), "x").unwrap();
        }
        fs::create_dir(at(".taut-tmp-folder")).unwrap();
        let alive = File::open(at(".taut-tmp-alive")).unwrap();
        alive.lock().unwrap();
        let draft = Draft::new(folder.path(), None).unwrap();
        let ours = draft.file.path().to_owned();
        sweep(folder.path());
        assert!(!at(".taut-tmp-dead").exists());
        for name in [".taut-other", "taut-tmp-mine", ".taut-tmp-alive", ".taut-tmp-folder"] {
            assert!(at(name).exists(), "{name}");
        }
        assert!(ours.exists());
        drop(draft);
        assert!(!ours.exists());
        // Of this process, the only other file in the making: a test of its own would remove those of this one.
        let draft = Draft::new(folder.path(), None).unwrap();
        let ours = draft.file.path().to_owned();
        remove_unfinished();
        assert!(!ours.exists());
    }

    #[test]
    fn a_file_that_was_swept_before_its_lock_is_given_up() {
        let folder = tempfile::tempdir().unwrap();
        let file = NamedTempFile::new_in(folder.path()).unwrap();
        assert!(is_locked(&file));
        let held = NamedTempFile::new_in(folder.path()).unwrap();
        let sweeper = File::open(held.path()).unwrap();
        sweeper.lock().unwrap();
        assert!(!is_locked(&held));
        fs::remove_file(held.path()).unwrap();
        drop(sweeper);
        assert!(!is_locked(&held));
    }
}
