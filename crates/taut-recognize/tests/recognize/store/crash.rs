//! A process that is killed while it enrolls.

use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};
use std::time::Duration;

use taut_recognize::store::{Key, Store};

use super::help::{Place, name, scan, scans};
use crate::test_length::long_or;

/// Names the store to the child, which is this test program.
const CHILD_VARIABLE: &str = "TAUT_TEST_STORE_OF_CHILD";
/// Times that a child is killed in the long tests.
const KILLS: u64 = 12;

/// Is the child where the variable is set, and enrolls until it is killed.
#[test]
fn child_that_enrolls() {
    let Some(path) = std::env::var_os(CHILD_VARIABLE) else { return };
    let mut store = Store::open(path, &Key::from_bytes([7; 32]), None).unwrap();
    loop {
        let person = store.len() as u64;
        store.enroll(&name(person), &scans(person)).unwrap();
        // Standard output of a test is kept back; standard error as a file is not. It has no buffer: one call writes the
        // line whole, where `writeln!` would write it piece by piece.
        use std::io::Write;
        std::io::stderr().write_all(format!("enrolled {person}\n").as_bytes()).unwrap();
    }
}

#[test]
fn killing_a_process_loses_nobody_and_damages_nothing() {
    let place = Place::new();
    let mut enrolled = 0;
    for kill in (0..KILLS).step_by(long_or(1, 3)) {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "store::crash::child_that_enrolls", "--nocapture"])
            .env(CHILD_VARIABLE, &place.path)
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        // Only what the child says counts, so the times need no meaning.
        let mut lines = BufReader::new(child.stderr.take().unwrap());
        let (send, receive) = std::sync::mpsc::channel();
        let reader = std::thread::spawn(move || {
            let mut line = String::new();
            while lines.read_line(&mut line).unwrap() > 0 {
                // A line without its end is what a kill has cut: nothing was told.
                if let Some(person) =
                    line.strip_prefix("enrolled ").and_then(|rest| rest.strip_suffix('\n'))
                {
                    send.send(person.parse::<u64>().unwrap()).ok();
                }
                line.clear();
            }
        });
        let mut told = receive.recv().expect("a child enrolls somebody");
        std::thread::sleep(Duration::from_micros(1700 * kill * kill));
        child.kill().unwrap();
        child.wait().unwrap();
        reader.join().unwrap();
        told = receive.try_iter().last().unwrap_or(told);
        let mut store = place.open();
        let found = store.len() as u64;
        // One more may have been written and not told.
        assert!(found == told + 1 || found == told + 2, "{found} people, {told} told");
        assert!(found > enrolled);
        enrolled = found;
        let names: Vec<String> = store.people().unwrap().into_iter().map(|p| p.name).collect();
        assert_eq!(names, (0..found).map(name).collect::<Vec<_>>());
        let last = found - 1;
        assert!(store.verify(&name(last), &scan(last, 4)).unwrap().is_accepted);
    }
    println!("{enrolled} people after the last kill");
}
