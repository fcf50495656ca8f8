//! Folders that appear whole or not at all.
//!
//! *Idea.* Files go to a temporary folder beside the name; [`AtomicFolder::commit`] renames it. An earlier folder is moved aside
//! first and removed last.
//! *Guarantee.* An earlier folder is replaced only if all it holds are files that the caller knows as its own.
//! *Trap.* A process that is killed leaves its temporary folder, `.taut-tmp-` and six letters, for a person to remove.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::{draft, folder as folder_of, refused};
use crate::Error;
use crate::error::shown_path;

/// A folder in the making; see [`create_folder`]. Dropped without [`commit`](Self::commit), it leaves no trace.
#[derive(Debug)]
pub struct AtomicFolder {
    display: String,
    path: PathBuf,
    draft: TempDir,
}

/// Starts a folder that will be `path`. An earlier folder of that name is replaced; it may hold files alone, each with a path
/// for which `is_own` is true.
///
/// # Errors
/// Those of [`check_folder`].
pub fn create_folder(path: &Path, is_own: impl Fn(&Path) -> bool) -> Result<AtomicFolder, Error> {
    let draft = check(path, is_own)?;
    Ok(AtomicFolder { display: shown_path(path), path: path.to_owned(), draft })
}

/// Tests whether a folder can be made or replaced where `path` says; nothing is left.
///
/// # Errors
/// [`Error::NoFolder`] where a file stands there, [`Error::LinkedFolder`] where a link does, [`Error::OtherFolder`] for an earlier folder that holds anything else,
/// [`Error::NotFound`] (of the folder around it), [`Error::Permission`], [`Error::Write`].
pub fn check_folder(path: &Path, is_own: impl Fn(&Path) -> bool) -> Result<(), Error> {
    check(path, is_own).map(drop)
}

fn check(path: &Path, is_own: impl Fn(&Path) -> bool) -> Result<TempDir, Error> {
    let display = shown_path(path);
    let failed = |source| Error::writing(&display, source);
    match fs::symlink_metadata(path) {
        Ok(meta) if meta.is_symlink() => return Err(Error::LinkedFolder { path: display }),
        Ok(meta) if !meta.is_dir() => return Err(Error::NoFolder { path: display }),
        Ok(_) => {
            for entry in fs::read_dir(path).map_err(failed)? {
                let entry = entry.map_err(failed)?;
                if !entry.file_type().is_ok_and(|kind| kind.is_file()) || !is_own(&entry.path()) {
                    let name = entry.file_name().to_string_lossy().into_owned();
                    return Err(Error::OtherFolder { path: display, name });
                }
            }
        }
        Err(source) if source.kind() == io::ErrorKind::NotFound => {}
        Err(source) => return Err(failed(source)),
    }
    let around = folder_of(path);
    temporary(around).map_err(|source| failed(refused(source, around)))
}

/// A temporary folder with the permissions of any new one.
fn temporary(around: &Path) -> io::Result<TempDir> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(draft::PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o777));
    builder.tempdir_in(around)
}

/// A folder for work, which goes with all it holds when this is dropped.
#[derive(Debug)]
pub struct ScratchFolder(TempDir);

impl ScratchFolder {
    /// Makes one beside the file or folder `path`.
    ///
    /// # Errors
    /// [`Error::NotFound`] (of the folder around it), [`Error::Permission`], [`Error::Write`].
    pub fn beside(path: &Path) -> Result<Self, Error> {
        let around = folder_of(path);
        let failed = |source| Error::writing(&shown_path(path), refused(source, around));
        temporary(around).map(ScratchFolder).map_err(failed)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.0.path()
    }
}

impl AtomicFolder {
    /// The folder to which files are written until it takes its name.
    pub fn path(&self) -> &Path {
        self.draft.path()
    }

    /// Puts the folder in its place.
    ///
    /// # Errors
    /// [`Error::Replace`]; the earlier folder is then as it was.
    pub fn commit(self) -> Result<(), Error> {
        let AtomicFolder { display, path, draft } = self;
        publish(&path, &draft).map_err(|source| Error::replacing(&display, source))?;
        // It has its name now, so there is nothing to remove under the other one.
        drop(draft.keep());
        Ok(())
    }
}

fn publish(path: &Path, draft: &TempDir) -> io::Result<()> {
    if !path.exists() {
        return fs::rename(draft.path(), path);
    }
    let aside = temporary(folder_of(path))?;
    let earlier = aside.path().join("earlier");
    fs::rename(path, &earlier)?;
    match fs::rename(draft.path(), path) {
        Ok(()) => aside.close(),
        Err(source) => fs::rename(&earlier, path).and(Err(source)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is_own(path: &Path) -> bool {
        path.extension().is_some_and(|extension| extension == "obj")
    }

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<String> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    #[test]
    fn a_folder_appears_whole_and_replaces_an_earlier_one() {
        let around = tempfile::tempdir().unwrap();
        let path = around.path().join("parts");
        for files in [&["a.obj", "b.obj"][..], &["c.obj"]] {
            let made = create_folder(&path, is_own).unwrap();
            for file in files {
                fs::write(made.path().join(file), "v 0 0 0\n").unwrap();
            }
            made.commit().unwrap();
            assert_eq!(names(&path), files);
            assert_eq!(names(around.path()), ["parts"]);
        }
        drop(create_folder(&path, is_own).unwrap());
        assert_eq!(
            (names(&path), names(around.path())),
            (vec!["c.obj".into()], vec!["parts".into()])
        );
    }

    #[test]
    fn a_folder_for_work_goes_with_what_it_holds() {
        let around = tempfile::tempdir().unwrap();
        let made = ScratchFolder::beside(&around.path().join("mesh.ply")).unwrap();
        fs::write(made.path().join("file"), "x").unwrap();
        assert_eq!(names(around.path()).len(), 1);
        drop(made);
        assert_eq!(names(around.path()), [""; 0]);
        assert!(ScratchFolder::beside(&around.path().join("no/where")).is_err());
    }

    #[test]
    fn folders_of_others_and_files_are_refused_and_stay() {
        let around = tempfile::tempdir().unwrap();
        let at = |name: &str| around.path().join(name);
        fs::create_dir(at("notes")).unwrap();
        fs::write(at("notes/letter.txt"), "dear").unwrap();
        fs::create_dir(at("nested")).unwrap();
        fs::create_dir(at("nested/inner.obj")).unwrap();
        fs::write(at("file"), "").unwrap();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(at("notes"), at("link")).unwrap();
            let said = check_folder(&at("link"), is_own).unwrap_err().to_string();
            assert!(said.contains("link is a link"), "{said}");
            fs::remove_file(at("link")).unwrap();
        }
        for (name, word) in [
            ("notes", "letter.txt"),
            ("nested", "inner.obj"),
            ("file", "is a file"),
            ("no/where", "no such"),
        ] {
            let said = check_folder(&at(name), is_own).unwrap_err().to_string();
            assert!(said.contains(word), "{said}");
            assert!(create_folder(&at(name), is_own).is_err());
        }
        assert_eq!(names(&at("notes")), ["letter.txt"]);
        assert_eq!(names(around.path()), ["file", "nested", "notes"]);
        fs::create_dir(at("empty")).unwrap();
        assert!(check_folder(&at("empty"), is_own).is_ok());
    }
}
