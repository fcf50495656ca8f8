//! Which files are open, under which names, and what is left of them.
//!
//! *Guarantee.* Runs are in a file without a name, which the system takes back when the process ends, in whatever way;
//! the output is in another one until it is complete, then it gets its name in one step. With
//! [`FileSortOptions::resume`] the runs have that name instead, and only success removes it, once the name of the output
//! has reached the disk.

use std::borrow::Borrow;
use std::fs::{File, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

use taut_points::Monitor;

use super::digest;
use super::engine;
use super::journal::{Journal, Origin};
use super::layout::RecordLayout;
use super::medium::Medium;
use super::plan::Plan;
use super::{FileSort, FileSortOptions};
use crate::error::Error;
use crate::store::{self, Draft, Pending, Store};

/// Bytes before the first record, at most.
const HEADER_MAX: u64 = 1 << 24;

/// Sorts a file; `open` makes of each file, by its name in errors, what is read and written.
pub(super) fn sort<F: Store + Borrow<File> + Send + Sync>(
    input: &Path,
    output: &Path,
    layout: &RecordLayout,
    options: &FileSortOptions,
    monitor: &Monitor<'_>,
    open: impl Fn(File, &str) -> F,
) -> Result<Pending<FileSort, F>, Error> {
    layout.check()?;
    if let Some(path) = &options.resume {
        // The file of runs is removed at the end.
        if [input, output].iter().any(|other| whereabouts(other) == whereabouts(path)) {
            return Err(Error::Option {
                name: "resume",
                value: path.display().to_string(),
                expected: "another file than the input and the output",
            });
        }
    }
    let (file, about) = at(input, store::open(input))?;
    let width = layout.width as u64;
    if options.header > HEADER_MAX {
        let (value, expected) = (options.header.to_string(), "at most 16777216 bytes");
        return Err(Error::Option { name: "header", value, expected });
    }
    let Some(bytes) = about.len().checked_sub(options.header) else {
        let (value, expected) = (options.header.to_string(), "at most the bytes of the input");
        return Err(Error::Option { name: "header", value, expected });
    };
    if bytes % width != 0 {
        let path = input.display().to_string();
        return Err(Error::Partial { path, bytes, width: layout.width });
    }
    let plan = Plan::new(layout, bytes / width, options.memory)?;
    let medium = |file, path: String| Medium::new(open(file, &path), path);
    let mut from = medium(file, input.display().to_string());
    let to = output.display().to_string();
    let draft = at(output, Draft::beside(output, |file| open(file, &to)))?;
    let mut to = Medium::new(draft, to);
    let header_hash = copy_header(options.header, &mut from, &mut to)?;
    let mut kept = None;
    let mut found = if plan.fits() {
        // Runs that are kept are those of a sort with less memory.
        if let Some(path) = options.resume.as_ref().filter(|path| path.exists()) {
            return Err(Journal::other(&path.display().to_string()));
        }
        engine::within(&plan, &mut from, &mut to, monitor)?
    } else if let Some(path) = &options.resume {
        let file = at(path, open_or_create(path))?;
        let length = at(path, file.metadata())?.len();
        let mut runs = medium(file, path.display().to_string());
        let journal = Journal::open(&plan, origin(&about), options.header, length, &mut runs)?;
        let found = engine::beyond(&plan, &mut from, &mut runs, Some(&journal), &mut to, monitor)?;
        kept = Some((path.clone(), runs.into_store()));
        found
    } else {
        let target = at(output, store::target(output))?;
        let folder = options.scratch.as_deref().unwrap_or(store::folder(&target));
        let file = at(folder, tempfile::tempfile_in(folder))?;
        let mut runs = medium(file, format!("runs in {}", folder.display()));
        engine::beyond(&plan, &mut from, &mut runs, None, &mut to, monitor)?
    };
    (found.header, found.header_hash) = (options.header, header_hash);
    Ok(Pending::new(found, to.into_store(), output, kept))
}

/// Copies what is before the first record, and has both files begin behind it; the hash of it.
fn copy_header<I: Store, O: Store>(
    length: u64,
    from: &mut Medium<I>,
    to: &mut Medium<O>,
) -> Result<u128, Error> {
    if length == 0 {
        return Ok(0);
    }
    let mut header = vec![0; length as usize];
    from.read(&mut header, 0)?;
    to.write(&header, 0)?;
    from.start_at(length);
    to.start_at(length);
    Ok(digest::hash(&header))
}

/// Returns what tells a file from others, as far as the system says.
fn origin(about: &Metadata) -> Origin {
    let modified = about.modified().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
    let modified = modified.map_or(0, |since| since.as_nanos() as u64);
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let seconds = about.ctime().wrapping_mul(1_000_000_000);
        [modified, seconds.wrapping_add(about.ctime_nsec()) as u64, about.ino()]
    }
    #[cfg(not(unix))]
    {
        let created = about.created().ok().and_then(|time| time.duration_since(UNIX_EPOCH).ok());
        [modified, created.map_or(0, |since| since.as_nanos() as u64), 0]
    }
}

/// Names the file that an error is about.
fn at<T>(path: &Path, result: io::Result<T>) -> Result<T, Error> {
    result.map_err(|source| Error::File { path: path.display().to_string(), source })
}

/// Where a file is, or would be, by one name.
fn whereabouts(path: &Path) -> PathBuf {
    let path = store::target(path).unwrap_or_else(|_| path.to_owned());
    let beside = || Some(store::folder(&path).canonicalize().ok()?.join(path.file_name()?));
    path.canonicalize().ok().or_else(beside).unwrap_or(path)
}

/// Opens the file of runs; two processes must not share it.
fn open_or_create(path: &Path) -> io::Result<File> {
    if path.exists() {
        store::regular(path)?;
    }
    let file = File::options().read(true).write(true).create(true).truncate(false).open(path)?;
    file.try_lock().map_err(io::Error::from)?;
    Ok(file)
}
