//! Devices, full ones and endless ones, and processes that are killed.

use std::process::{Child, Command, Stdio};
use std::time::Duration;

use crate::test_folder::TestFolder;

/// Starts a command that writes without end, and waits until its temporary file is there.
fn writing_without_end(folder: &TestFolder, out: &str) -> Child {
    let before = temporary(folder);
    let child = Command::new(assert_cmd::cargo::cargo_bin!("taut"))
        .current_dir(folder.path(""))
        .args("generate normal -n 100000000 -d 3 --threads 1 -o".split(' '))
        .arg(out)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    for _ in 0..1000 {
        if temporary(folder).iter().any(|name| !before.contains(name)) {
            return child;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    panic!("not begun: {:?}", child.wait_with_output());
}

/// Names of the temporary files.
fn temporary(folder: &TestFolder) -> Vec<String> {
    folder.files().into_iter().filter(|name| name.starts_with(".taut-tmp-")).collect()
}

#[test]
fn the_file_of_a_killed_process_is_removed_by_the_next_output_and_that_of_a_live_one_is_not() {
    let folder = TestFolder::new();
    let mut dead = writing_without_end(&folder, "dead.csv");
    let left = temporary(&folder);
    dead.kill().unwrap();
    dead.wait().unwrap();
    assert_eq!(temporary(&folder), left, "a killed process cannot clean up");
    assert_eq!(left.len(), 1);

    let mut alive = writing_without_end(&folder, "alive.csv");
    let held = temporary(&folder);
    // Its start removed the one, and nothing removes its own.
    assert!(held.len() == 1 && held != left, "{left:?} {held:?}");
    folder.taut("generate normal -n 10 -d 2 -o small.csv").ends(0);
    assert_eq!(temporary(&folder), held);
    alive.kill().unwrap();
    alive.wait().unwrap();
    folder.taut("generate normal -n 10 -d 2 -o small.csv").ends(0);
    assert_eq!(folder.files(), ["small.csv"]);
}

#[test]
fn an_endless_answer_is_refused() {
    let folder = TestFolder::new();
    folder.put("points.csv", "0,0\n1,1\n");
    let device = ["is a device, which may never end"];
    folder.taut("verify /dev/zero points.csv").ends(2).stderr_has(&device);
    folder.shell("taut verify - points.csv < /dev/zero").ends(2).stderr_has(&["no JSON object"]);
    folder.shell("yes '{' | taut verify - points.csv").ends(2).stderr_has(&["nested too deeply"]);
    folder.shell("yes '{}' | taut verify - points.csv").ends(2).stderr_has(&["more follows"]);
    folder.shell("yes | taut draw - points.csv -o a.svg").ends(2).stderr_has(&["no JSON object"]);
    folder.taut("verify /dev/null points.csv").ends(2);
    assert_eq!(folder.files(), ["points.csv"]);
}

#[test]
fn an_endless_device_is_no_file_of_points() {
    let folder = TestFolder::new();
    let device = ["is a device, which may never end"];
    for options in ["--raw-dim 3 --raw-type f64", "--format parquet", "--format ply"] {
        if !cfg!(feature = "arrow") && options.ends_with("parquet") {
            continue;
        }
        folder.taut(&format!("ball /dev/zero {options}")).ends(2).stderr_has(&device);
        folder.shell(&format!("taut ball - {options} < /dev/zero")).ends(2).stderr_has(&device);
    }
    folder.taut("ball /dev/null --format csv").ends(2).stderr_has(&["is empty"]);
    folder.shell("taut ball - < /dev/null").ends(2).stderr_has(&["is empty"]);
}

#[test]
fn a_full_device_is_said_by_everything_that_speaks() {
    let folder = TestFolder::new();
    for line in [
        "--help",
        "-h",
        "--version",
        "help ball",
        "ball --help",
        "memory sort --help",
        "formats",
        "completions bash",
        "generate normal -n 10 -d 2",
    ] {
        folder
            .shell(&format!("taut {line} > /dev/full"))
            .ends(2)
            .stderr_has(&["standard output: writing failed", "No space left"]);
        // Whoever closes a pipe has seen enough.
        folder.shell(&format!("(taut {line}; echo $? > code) | true")).ends(0);
        assert_eq!(folder.text("code"), "0\n", "{line}");
    }
}
