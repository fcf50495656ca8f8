//! Text and pictures to files, whole or not at all, and words to standard output.
//!
//! *Idea.* Everything that can fail is done before the first file takes its name: places are looked at before the
//! work, bytes go to temporary files after it, then the words to standard output, and the renames come last. So an
//! error leaves earlier files as they were.

use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use anyhow::{anyhow, bail};
use taut::Solution;
use taut::certify::{Answer, ReadingChoice};
use taut_io::{AtomicFile, AtomicFolder, Error, Format, Table};

use crate::watch::interrupted;

/// Refuses places that cannot be written, that are among the `inputs`, or that are named twice, before any work is done.
pub(crate) fn check_writable(outputs: &[&Path], inputs: &[&Path]) -> anyhow::Result<()> {
    for &output in outputs.iter().filter(|output| !is_stream(output)) {
        let path = output.display().to_string();
        if output.is_dir() {
            return Err(Error::Directory { path }.into());
        }
        let folder = output.parent().filter(|folder| !folder.as_os_str().is_empty());
        if folder.is_some_and(|folder| !folder.is_dir()) {
            return Err(Error::NotFound { path }.into());
        }
        if inputs.iter().any(|input| same_file(output, input)) {
            bail!("`{path}` is the input: name another file for the answer");
        }
    }
    for (place, &output) in outputs.iter().enumerate() {
        if outputs[..place].iter().any(|earlier| same_place(output, earlier)) {
            let path = output.display();
            bail!("`{path}` is named for two outputs: name another file for one of them");
        }
    }
    // A folder that takes no new files says so only when one is made.
    let files = outputs.iter().filter(|output| !is_stream(output));
    Ok(files.copied().try_for_each(taut_io::check_writable)?)
}

/// Tests whether the name of a file is one for JSON: it has its extension, or none, or is no regular file.
pub(crate) fn names_json(path: &Path) -> bool {
    extension_of(path).is_none_or(|extension| extension == "json")
}

/// The extension of a file, in small letters; none of streams, devices and the like, which take anything.
fn extension_of(path: &Path) -> Option<String> {
    let is_other = path.metadata().is_ok_and(|there| !there.is_file() && !there.is_dir());
    let extension = path.extension().filter(|_| !is_stream(path) && !is_other)?;
    Some(extension.to_string_lossy().to_lowercase())
}

/// Refuses the extension of anything else where JSON is written.
pub(crate) fn check_json(path: &Path, option: &str) -> anyhow::Result<()> {
    let shown = path.display();
    match Format::of_path(path) {
        _ if names_json(path) => Ok(()),
        (_, Some(_)) => bail!("{shown}: {option} writes JSON, not compressed: name it .json"),
        (Some(format), _) => {
            bail!("{shown}: {option} writes JSON, no {format} file: name it .json")
        }
        _ => bail!("{shown}: {option} writes JSON: name it .json"),
    }
}

/// Returns true if JSON is to be written, which the extension says, or else `is_asked`; refuses any other extension than that of
/// the text that is written else.
pub(crate) fn writes_json(path: &Path, is_asked: bool, text: &str) -> anyhow::Result<bool> {
    match extension_of(path).as_deref() {
        None => Ok(is_asked),
        Some("json") => Ok(true),
        Some(extension) if extension == text && !is_asked => Ok(false),
        Some(_) if is_asked => check_json(path, "--json").map(|()| true),
        Some(_) => bail!("{}: -o writes .{text} or .json; name one of these", path.display()),
    }
}

/// Tests whether two outputs would end up in one place, there already or not.
fn same_place(one: &Path, other: &Path) -> bool {
    let place = |path: &Path| -> Option<PathBuf> {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        Some(folder.unwrap_or(Path::new(".")).canonicalize().ok()?.join(path.file_name()?))
    };
    one == other || same_file(one, other) || place(one).is_some_and(|one| Some(one) == place(other))
}

/// Tests whether `-` is meant, standard input or output.
pub(crate) fn is_stream(path: &Path) -> bool {
    path == Path::new("-")
}

/// Returns true if writing to the regular file `output` would replace what is read from `input`.
fn same_file(output: &Path, input: &Path) -> bool {
    let input = if is_stream(input) { Path::new("/dev/stdin") } else { input };
    let (Ok(to), Ok(from)) = (output.metadata(), input.metadata()) else { return false };
    #[cfg(unix)]
    let same = {
        use std::os::unix::fs::MetadataExt;
        (to.dev(), to.ino()) == (from.dev(), from.ino())
    };
    #[cfg(not(unix))]
    let same =
        output.canonicalize().is_ok_and(|to| input.canonicalize().is_ok_and(|from| to == from));
    to.is_file() && from.is_file() && same
}

/// Files and words that are written together.
#[derive(Default)]
pub(crate) struct Outputs {
    files: Vec<AtomicFile>,
    folders: Vec<AtomicFolder>,
    words: Vec<u8>,
    /// How the points of the answers were read.
    reading: Option<ReadingChoice>,
}

impl Outputs {
    /// Outputs of answers about points that were read in some way.
    pub(crate) fn of_reading(reading: Option<ReadingChoice>) -> Self {
        Outputs { reading, ..Outputs::default() }
    }

    /// Prepares the file `path`; `-` is standard output.
    pub(crate) fn add(&mut self, path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
        if is_stream(path) {
            self.words.extend_from_slice(bytes);
            return Ok(());
        }
        if interrupted() {
            bail!("interrupted: {} is as it was", path.display());
        }
        let mut file = taut_io::create(path)?;
        file.write_all(bytes)
            .and_then(|()| file.flush())
            .map_err(|source| failed(file.path(), &source))?;
        self.files.push(file);
        Ok(())
    }

    /// Prepares the file `path` with the JSON of an answer, piece by piece; `-` is standard output.
    pub(crate) fn add_json<A: Answer>(
        &mut self,
        path: &Path,
        found: &Solution<A>,
    ) -> anyhow::Result<()> {
        if is_stream(path) {
            self.print_json(found);
            return Ok(());
        }
        if interrupted() {
            bail!("interrupted: {} is as it was", path.display());
        }
        let mut file = taut_io::create(path)?;
        found
            .write_json_with(self.reading.as_ref(), &mut file)
            .and_then(|()| file.write_all(b"\n"))
            .and_then(|()| file.flush())
            .map_err(|source| failed(file.path(), &source))?;
        self.hold(file);
        Ok(())
    }

    /// Prepares the file `path` with a table.
    pub(crate) fn add_table(&mut self, path: &Path, table: &Table) -> anyhow::Result<()> {
        if interrupted() {
            bail!("interrupted: {} is as it was", path.display());
        }
        self.hold(taut_io::table_file(table, path)?);
        Ok(())
    }

    /// Prints the JSON of an answer.
    pub(crate) fn print_json<A: Answer>(&mut self, found: &Solution<A>) {
        let written = found.write_json_with(self.reading.as_ref(), &mut self.words);
        debug_assert!(written.is_ok(), "memory takes all that is written");
        self.words.push(b'\n');
    }

    /// Keeps a file that is complete, until all of them are.
    pub(crate) fn hold(&mut self, file: AtomicFile) {
        self.files.push(file);
    }

    /// Keeps a folder that is complete, until all outputs are.
    pub(crate) fn hold_folder(&mut self, folder: AtomicFolder) {
        self.folders.push(folder);
    }

    /// Returns true if no file is prepared.
    pub(crate) fn is_empty(&self) -> bool {
        self.files.is_empty() && self.folders.is_empty()
    }

    /// Words for standard output.
    pub(crate) fn print(&mut self, words: &str) {
        self.words.extend_from_slice(words.as_bytes());
    }

    /// Says the words, then gives the files their names.
    pub(crate) fn finish(self) -> anyhow::Result<()> {
        self.finish_after(|| Ok(()))
    }

    /// The same, after something else that takes its name.
    pub(crate) fn finish_after(
        self,
        first: impl FnOnce() -> anyhow::Result<()>,
    ) -> anyhow::Result<()> {
        if interrupted() {
            bail!("interrupted: all files are as they were");
        }
        first()?;
        print(&self.words)?;
        self.files.into_iter().try_for_each(AtomicFile::commit)?;
        self.folders.into_iter().try_for_each(AtomicFolder::commit)?;
        Ok(())
    }
}

/// Replaces the file `path` by `bytes`, or writes them to standard output for `-`.
pub(crate) fn replace(path: &Path, bytes: &[u8]) -> anyhow::Result<()> {
    let mut outputs = Outputs::default();
    outputs.add(path, bytes)?;
    outputs.finish()
}

/// Writes to standard output, at once.
pub(crate) fn print(bytes: &[u8]) -> anyhow::Result<()> {
    let mut out = std::io::stdout().lock();
    unless_closed(out.write_all(bytes).and_then(|()| out.flush()))
}

/// Returns what it means how writing to standard output went.
pub(crate) fn unless_closed(written: std::io::Result<()>) -> anyhow::Result<()> {
    match written {
        // Whoever reads has enough: that changes neither what is written to files nor how the command ends.
        Err(source) if source.kind() == ErrorKind::BrokenPipe => Ok(()),
        written => written.map_err(|source| failed("standard output", &source)),
    }
}

/// Says on standard error, in one line, what is wrong or to be done.
pub(crate) fn print_error(words: &str) {
    print_line(&format!("taut: {}", printable(words)));
}

/// Writes a line to standard error; nothing depends on whether anybody reads it.
pub(crate) fn print_line(line: &str) {
    writeln!(std::io::stderr(), "{line}").ok();
}

/// Returns what a terminal can show as it is: names in files may hold characters that would command it.
pub(crate) fn printable(words: &str) -> String {
    let mut shown = String::with_capacity(words.len());
    for c in words.chars() {
        match c.is_control() {
            true => shown.extend(c.escape_default()),
            false => shown.push(c),
        }
    }
    shown
}

fn failed(what: &str, source: &std::io::Error) -> anyhow::Error {
    anyhow!("{what}: writing failed: {source}")
}

#[cfg(test)]
mod tests {
    #[test]
    fn nothing_shown_commands_the_terminal() {
        assert_eq!(super::printable("a\u{1b}[31m\n\u{9b}ä"), "a\\u{1b}[31m\\n\\u{9b}ä");
    }
}
