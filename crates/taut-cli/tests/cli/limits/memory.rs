//! A process without memory: exit code 2 and a line that says so.

#![cfg(target_os = "linux")]

use std::fs::File;
use std::io::Write;

use super::npy_header;

use crate::test_folder::TestFolder;
/// An array of two columns, big-endian or little-endian, of `rows` zeros that take no room on the disk.
fn zeros(folder: &TestFolder, name: &str, kind: &str, rows: u64) {
    let mut file = File::create(folder.path(name)).unwrap();
    let header = npy_header(kind, rows, 2);
    file.write_all(&header).unwrap();
    file.set_len(header.len() as u64 + rows * 16).unwrap();
}

#[test]
fn points_that_outgrow_the_memory_of_the_process_are_an_error_with_a_remedy() {
    let folder = TestFolder::new();
    // 192 MB of values that must be turned around, so they are decoded to memory.
    zeros(&folder, "big.npy", ">f8", 12_000_000);
    folder
        .shell("ulimit -d 150000; taut ball big.npy --threads 1")
        .ends(2)
        .stderr_has(&["big.npy: out of memory", "--memory"]);
    folder.shell("ulimit -d 150000; taut ball big.npy --threads 1 --memory 20M --quiet").ends(0);
}

#[test]
fn a_solver_that_runs_out_of_memory_ends_with_code_2_and_leaves_no_file() {
    let folder = TestFolder::new();
    zeros(&folder, "big.npy", "<f8", 6_000_000);
    folder
        .shell("ulimit -d 150000; taut delaunay big.npy --threads 1 -o mesh.ply")
        .ends(2)
        .stderr_has(&["out of memory: the system refused ", "--memory"]);
    assert_eq!(folder.files(), ["big.npy"]);
}

#[test]
fn an_output_that_was_begun_is_removed_when_memory_runs_out() {
    let folder = TestFolder::new();
    // A point fits, but not its text.
    folder
        .shell("ulimit -d 150000; taut generate normal -n 9 -d 4000000 --threads 1 -o wide.csv")
        .ends(2)
        .stderr_has(&["out of memory: the system refused "]);
    assert_eq!(folder.files(), Vec::<String>::new());
}

#[test]
fn a_library_that_handles_the_lack_of_memory_still_says_what_was_asked_for() {
    let folder = TestFolder::new();
    folder
        .shell("ulimit -d 150000; taut memory sample -k 100000000000 -n 1000000000000 -o s.txt")
        .ends(2)
        .stderr_has(&["option `k` is 100000000000", "memory"]);
    folder
        .taut("generate normal -n 1 -d 500000000000000000 --type f32")
        .ends(2)
        .stderr_has(&["option `--dim` is 500000000000000000", "fits into memory"]);
    assert_eq!(folder.files(), Vec::<String>::new());
}
