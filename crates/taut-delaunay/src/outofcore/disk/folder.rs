//! The folder of a triangulation: names of its files, and files that appear whole.

use std::ffi::OsString;
use std::fs::{self, File, Metadata};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::Error;

/// The error of the system about a file.
pub(super) fn failed(path: &Path) -> impl Fn(io::Error) -> Error + use<> {
    let path = path.display().to_string();
    move |source| Error::File { path: path.clone(), source }
}

/// Where the files of a triangulation are.
#[derive(Clone, Debug)]
pub(super) struct Folder {
    root: PathBuf,
}

impl Folder {
    pub(super) fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// What the triangulation is.
    pub(super) fn manifest(&self) -> PathBuf {
        self.root.join(super::manifest::NAME)
    }

    /// Tests whether nothing is there; where work is to be resumed, nothing but what comes before the manifest.
    pub(super) fn is_new(&self, resume: bool) -> Result<bool, Error> {
        let names = |folder: &Path| -> Result<Vec<OsString>, Error> {
            let entries = match fs::read_dir(folder) {
                Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(vec![]),
                entries => entries.map_err(failed(folder))?,
            };
            entries.map(|entry| Ok(entry.map_err(failed(folder))?.file_name())).collect()
        };
        let found = names(&self.root)?;
        if !resume || found.is_empty() {
            return Ok(found.is_empty());
        }
        let is_ours = found.iter().all(|name| name == "work" || name == "manifest.part");
        Ok(is_ours && names(&self.work())?.iter().all(|name| name == "lock"))
    }

    /// The tile of a node, and its front while that is needed.
    pub(super) fn tile(&self, node: u32) -> PathBuf {
        self.root.join(super::tile_name(node))
    }

    /// The folder of what is removed at the end: `lock`, `distribution`, `tree`, buckets, drafts of
    /// these, and `stamps`.
    pub(super) fn work(&self) -> PathBuf {
        self.root.join("work")
    }

    /// The points of a node.
    pub(super) fn bucket(&self, node: u32) -> PathBuf {
        self.work().join(format!("bucket-{node:08}"))
    }

    /// How far points have been distributed.
    pub(super) fn commit(&self) -> PathBuf {
        self.work().join("distribution")
    }

    /// The tree, once all points are distributed.
    pub(super) fn tree(&self) -> PathBuf {
        self.work().join("tree")
    }

    /// Notes on the files of finished tiles.
    pub(super) fn stamps(&self) -> PathBuf {
        self.work().join("stamps")
    }

    /// Removes the working files but the lock; files that are not ours stay.
    pub(super) fn clear_work(&self) -> Result<(), Error> {
        let is_ours = |name: &str| {
            let name = name.strip_suffix(".part").unwrap_or(name);
            matches!(name, "distribution" | "tree" | "stamps") || name.starts_with("bucket-")
        };
        for entry in fs::read_dir(self.work()).map_err(failed(&self.work()))? {
            let entry = entry.map_err(failed(&self.work()))?;
            if entry.file_name().to_str().is_some_and(is_ours) {
                remove(&entry.path())?;
            }
        }
        Ok(())
    }

    /// Removes the lock and the working folder, unless that has files that are not ours.
    pub(super) fn remove_work(&self) -> Result<(), Error> {
        remove(&self.work().join("lock"))?;
        match fs::remove_dir(self.work()) {
            Err(error) if is_kept(error.kind()) => Ok(()),
            result => result.map_err(failed(&self.work())),
        }
    }

    /// Removes what a run began that can never end, and the folder itself if it was made for it.
    pub(super) fn discard(&self, with_root: bool) -> Result<(), Error> {
        self.clear_work()?;
        self.remove_work()?;
        remove(&self.manifest())?;
        if !with_root {
            return Ok(());
        }
        match fs::remove_dir(&self.root) {
            Err(error) if is_kept(error.kind()) => Ok(()),
            result => result.map_err(failed(&self.root)),
        }
    }
}

/// Tests whether a folder stays or is gone already without that being an error.
fn is_kept(kind: io::ErrorKind) -> bool {
    matches!(kind, io::ErrorKind::DirectoryNotEmpty | io::ErrorKind::NotFound)
}

/// Writes a file beside its name, brings it to the disk and names it; an earlier file is replaced. Returns also what the system
/// says of the file at that moment.
pub(super) fn write_whole<R>(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<R, Error>,
) -> Result<(R, Option<Metadata>), Error> {
    let draft = path.with_extension("part");
    let mut file = File::create(&draft).map_err(failed(&draft))?;
    let result = write(&mut file)?;
    file.sync_all().map_err(failed(&draft))?;
    fs::rename(&draft, path).map_err(failed(path))?;
    // Now, as others may find the file by its name from here on.
    let found = file.metadata().ok();
    sync_folder(path)?;
    Ok((result, found))
}

/// Writes these bytes as [`write_whole`].
pub(super) fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), Error> {
    write_whole(path, |file| file.write_all(bytes).map_err(failed(path)))?;
    Ok(())
}

/// Has a new name survive the machine.
fn sync_folder(path: &Path) -> Result<(), Error> {
    #[cfg(unix)]
    if let Some(folder) = path.parent() {
        let open = File::open(folder).map_err(failed(folder))?;
        match open.sync_all() {
            // Some file systems do not sync folders.
            Err(error) if error.kind() == io::ErrorKind::InvalidInput => {}
            result => result.map_err(failed(folder))?,
        }
    }
    #[cfg(not(unix))]
    let _ = path;
    Ok(())
}

/// Removes a file that may be gone already.
pub(super) fn remove(path: &Path) -> Result<(), Error> {
    match fs::remove_file(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        result => result.map_err(failed(path)),
    }
}

/// Bytes that are left where a folder is; `None` where the system does not say.
#[cfg(unix)]
pub(super) fn free_bytes(folder: &Path) -> Option<u64> {
    let found = rustix::fs::statvfs(folder).ok()?;
    Some(found.f_bavail.saturating_mul(found.f_frsize))
}

#[cfg(not(unix))]
pub(super) fn free_bytes(_: &Path) -> Option<u64> {
    None
}
