//! Ctrl-C ends the work with code 130 and leaves files as they were.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;

use crate::test_folder::TestFolder;

#[test]
fn an_interrupt_leaves_the_earlier_file_and_nothing_else() {
    let folder = TestFolder::new();
    folder.put("points.csv", "earlier points");
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("taut"))
        .current_dir(folder.path(""))
        .args("generate normal -n 100000000 -d 3 -o points.csv --threads 1".split(' '))
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It has begun once its temporary file stands beside the earlier one.
    for _ in 0..500 {
        if folder.files().len() > 1 {
            break;
        }
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(folder.files().len() > 1, "not begun: {:?}", child.wait_with_output());
    let id = child.id().to_string();
    assert!(
        Command::new("sh").args(["-c", &format!("kill -INT {id}")]).status().unwrap().success()
    );
    let ended = child.wait().unwrap();
    assert_eq!(ended.code(), Some(130));
    assert_eq!(folder.files(), ["points.csv"]);
    assert_eq!(folder.text("points.csv"), "earlier points");
}

#[test]
fn an_interrupt_stops_a_triangulation() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 600000 -d 3 -o points.npy").ends(0);
    folder.put("mesh.ply", "earlier mesh");
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("taut"))
        .current_dir(folder.path(""))
        .args("delaunay points.npy -o mesh.ply --threads 1 --progress always".split(' '))
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // It has begun once it says so.
    let mut said = String::new();
    let mut words = BufReader::new(child.stderr.take().unwrap());
    while !said.contains("solving") && words.read_line(&mut said).unwrap() > 0 {}
    let id = child.id().to_string();
    assert!(
        Command::new("sh").args(["-c", &format!("kill -INT {id}")]).status().unwrap().success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(folder.files(), ["mesh.ply", "points.npy"]);
    assert_eq!(folder.text("mesh.ply"), "earlier mesh");
}

#[test]
fn an_interrupt_stops_a_long_range_of_k() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 3000 -d 2 -o points.npy").ends(0);
    folder.put("elbow.csv", "earlier table");
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("taut"))
        .current_dir(folder.path(""))
        .args(
            "centers points.npy --elbow 1..1000 --epsilon 0 -o elbow.csv --progress always"
                .split(' '),
        )
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = String::new();
    let mut words = BufReader::new(child.stderr.take().unwrap());
    while !said.contains("k = 2: radius") && words.read_line(&mut said).unwrap() > 0 {}
    let id = child.id().to_string();
    assert!(
        Command::new("sh").args(["-c", &format!("kill -INT {id}")]).status().unwrap().success()
    );
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(folder.files(), ["elbow.csv", "points.npy"]);
    assert_eq!(folder.text("elbow.csv"), "earlier table");
}
