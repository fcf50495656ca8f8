//! A folder of its own for each test, and the command run in it.

use std::path::PathBuf;

use assert_cmd::cargo::cargo_bin_cmd;
use tempfile::TempDir;

/// A folder to work in; gone after the test.
pub(crate) struct TestFolder {
    folder: TempDir,
}

/// The way in which a run ended and what it said.
pub(crate) struct Run {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl TestFolder {
    pub(crate) fn new() -> Self {
        TestFolder { folder: TempDir::new().unwrap() }
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub(crate) fn put(&self, name: &str, contents: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), contents).unwrap();
    }

    pub(crate) fn bytes(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn text(&self, name: &str) -> String {
        String::from_utf8(self.bytes(name)).unwrap()
    }

    /// Names of the files in the folder, sorted.
    pub(crate) fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> =
            entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// Runs `taut` with the words of `line`, and `input` on standard input.
    pub(crate) fn pipe(&self, input: impl Into<Vec<u8>>, line: &str) -> Run {
        let mut command = cargo_bin_cmd!("taut");
        command.current_dir(self.folder.path()).env_remove("TAUT_THREADS");
        let output = command.args(line.split_whitespace()).write_stdin(input).output().unwrap();
        Run {
            code: output.status.code().unwrap_or(-1),
            out: String::from_utf8(output.stdout).unwrap(),
            err: String::from_utf8(output.stderr).unwrap(),
        }
    }

    /// Runs `taut` with the words of `line`.
    pub(crate) fn taut(&self, line: &str) -> Run {
        self.pipe("", line)
    }

    /// Runs a line of the shell, in which `taut` is the command under test.
    #[cfg(unix)]
    pub(crate) fn shell(&self, line: &str) -> Run {
        let binary = assert_cmd::cargo::cargo_bin!("taut");
        let output = std::process::Command::new("sh")
            .current_dir(self.folder.path())
            .env_remove("TAUT_THREADS")
            .args(["-c", &format!("taut() {{ '{}' \"$@\"; }}; {line}", binary.display())])
            .output()
            .unwrap();
        Run {
            code: output.status.code().unwrap_or(-1),
            out: String::from_utf8_lossy(&output.stdout).into_owned(),
            err: String::from_utf8_lossy(&output.stderr).into_owned(),
        }
    }
}

impl Run {
    /// Asserts the exit code, showing what was said if it is another.
    #[track_caller]
    pub(crate) fn ends(self, code: i32) -> Self {
        assert_eq!(self.code, code, "{self:#?}");
        self
    }

    /// Asserts that standard output holds each of `parts`.
    #[track_caller]
    pub(crate) fn stdout_has(self, parts: &[&str]) -> Self {
        for part in parts {
            assert!(self.out.contains(part), "no `{part}` in {self:#?}");
        }
        self
    }

    /// Asserts that there is one line of error that holds each of `parts`.
    #[track_caller]
    pub(crate) fn stderr_has(self, parts: &[&str]) -> Self {
        assert!(self.err.starts_with("taut: ") && self.err.lines().count() == 1, "{self:#?}");
        for part in parts {
            assert!(self.err.contains(part), "no `{part}` in {self:#?}");
        }
        self
    }

    pub(crate) fn json(&self) -> serde_json::Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error} in {self:#?}"))
    }
}

/// The output of a failed assertion: enough to see what happened.
impl std::fmt::Debug for Run {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let some = |text: &str| text.chars().take(2000).collect::<String>();
        write!(
            f,
            "exit code {}\n--- output\n{}\n--- errors\n{}",
            self.code,
            some(&self.out),
            some(&self.err)
        )
    }
}
