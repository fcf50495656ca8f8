//! A process that is killed leaves what was there, and the runs if they have a name.
#![cfg(target_os = "linux")]

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

use super::*;

const FOLDER: &str = "TAUT_TEST_SORT_FOLDER";
const RESUME: &str = "TAUT_TEST_SORT_RESUME";

/// What the killed process does: nothing unless it is told where.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn sorts_slowly_where_it_is_told() {
    let Some(folder) = std::env::var_os(FOLDER) else { return };
    let path = |name: &str| PathBuf::from(&folder).join(name);
    let resume = std::env::var_os(RESUME).map(|_| path("runs"));
    let options = FileSortOptions { memory: MEMORY_MIN, resume, ..Default::default() };
    // Each block is said, and then waits for a while.
    let report = |records: u64| {
        println!("block {records}");
        std::thread::sleep(std::time::Duration::from_millis(2));
    };
    let monitor = Monitor { on_points: Some(&report), ..Monitor::silent() };
    sort_file(&path("in"), &path("out"), &whole_number(32), &options, &monitor).expect("sorted");
}

/// Starts a process that sorts and kills it after so many blocks.
fn kill_after(folder: &Folder, blocks: usize, resume: bool) {
    let mut command = Command::new(std::env::current_exe().expect("this program"));
    command.args([
        "--exact",
        "sort::external::tests::killed::sorts_slowly_where_it_is_told",
        "--nocapture",
    ]);
    command.env(FOLDER, folder.0.path()).stdout(Stdio::piped());
    if resume {
        command.env(RESUME, "yes");
    }
    let mut child = command.spawn().expect("started");
    let lines = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    let said =
        lines.map_while(Result::ok).filter(|line| line.contains("block ")).take(blocks).count();
    assert_eq!(said, blocks, "killed before the end");
    child.kill().expect("killed");
    child.wait().expect("ended");
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn killed_at_any_block_the_old_output_stands_and_nothing_is_left() {
    let bytes = records(20_000, 32, 0, u64::MAX);
    let folder = Folder::with(&bytes);
    fs::write(folder.path("out"), "old").expect("written");
    for blocks in [1, 60, 170] {
        kill_after(&folder, blocks, false);
        assert_eq!(folder.names(), ["in", "out"]);
        assert_eq!(fs::read(folder.path("out")).expect("an output"), b"old");
    }
    kill_after(&folder, 100, true);
    assert_eq!(folder.names(), ["in", "out", "runs"]);
    let options = FileSortOptions {
        memory: MEMORY_MIN,
        resume: Some(folder.path("runs")),
        ..Default::default()
    };
    let found = folder.sort_with(&whole_number(32), &options, &Monitor::silent()).expect("sorted");
    assert!(found.runs_resumed > 3, "{found:?}");
    assert!(
        fs::read(folder.path("out")).expect("an output") == expected(&bytes, &whole_number(32))
    );
    assert_eq!(folder.names(), ["in", "out"]);
}
