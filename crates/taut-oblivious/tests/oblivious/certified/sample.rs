//! Samples: the checker draws what the solver draws, bit for bit.

use std::io::Cursor;

use proptest::prelude::*;
use taut_certify::{
    AnyFileSolution, DrawnSample, FileCheckError, FileSolution, FileViolation, Files,
    SampleCertificate, Trace,
};
use taut_oblivious::sample;
use taut_points::Monitor;

use super::{judge, no_change_is_confirmed};

fn drawn(seed: u64, of: u64, k: u64) -> (AnyFileSolution, Vec<u8>) {
    let numbers = sample(seed, of, k).unwrap();
    let text: String = numbers.iter().map(|number| format!("{number}\n")).collect();
    let (answer, certificate) = (DrawnSample { of, drawn: k }, SampleCertificate { seed });
    let found = FileSolution { answer, certificate, trace: Trace::default() };
    (AnyFileSolution::Sample(found), text.into_bytes())
}

#[test]
fn samples_of_all_kinds_are_drawn_again() {
    for (of, k) in [
        (0, 0),
        (1, 0),
        (1, 1),
        (10, 4),
        (10, 9),
        (5000, 4096),
        (5000, 4097),
        (5000, 5000),
        (1 << 20, 30_000),
        (100_000, 99_000),
        (u64::MAX, 20_000),
        (1 << 40, 4097),
    ] {
        for seed in [0, 7, u64::MAX] {
            let (found, text) = drawn(seed, of, k);
            let verdict = judge(&found, None, &text);
            assert_eq!(verdict.map(|verdict| verdict.items), Ok(k), "{k} of {of}, seed {seed}");
        }
    }
}

#[test]
fn every_field_counts() {
    let (found, text) = drawn(3, 1_000_000, 9000);
    no_change_is_confirmed(
        &found,
        None,
        &text,
        &[
            ("of", &["999999", "1000001", "8999", "0", "18446744073709551615"]),
            ("drawn", &["8999", "9001", "0", "1000001"]),
            ("seed", &["2", "4", "-1", "0.5"]),
        ],
    );
}

#[test]
fn promises_of_many_numbers_need_a_file_of_many_bytes() {
    let promise = |of: u64, drawn: u64| {
        let certificate = SampleCertificate { seed: 1 };
        let answer = DrawnSample { of, drawn };
        FileSolution { answer, certificate, trace: Trace::default() }
    };
    for (of, drawn) in [(1_000_000_000_000_000, 500_000_000_000_000), (u64::MAX, 1 << 62)] {
        let found = AnyFileSolution::Sample(promise(of, drawn));
        for text in [&b""[..], b"1\n2\n3"] {
            let refused = judge(&found, None, text).unwrap_err();
            assert!(matches!(refused, FileViolation::Short { .. }), "{refused}");
        }
    }
    // The shortest file there can be.
    let (ten, text) = drawn(1, 10, 10);
    assert_eq!(text.trim_ascii_end().len(), 19);
    assert!(judge(&ten, None, text.trim_ascii_end()).is_ok());
}

#[test]
fn a_sample_has_no_input() {
    let (found, text) = drawn(3, 1000, 50);
    let (mut input, mut output) = (Cursor::new(b"anything"), Cursor::new(text));
    let files = Files { input: Some(&mut input), output: &mut output };
    assert!(matches!(found.check(files, &Monitor::silent()), Err(FileCheckError::NoInput)));
}

#[test]
fn other_lines_are_seen() {
    let (found, text) = drawn(3, 1000, 50);
    let text = String::from_utf8(text).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    let joined = |lines: &[&str]| lines.iter().map(|line| format!("{line}\n")).collect::<String>();
    let mut swapped = lines.clone();
    swapped.swap(10, 11);
    let mut twice = lines.clone();
    twice[20] = lines[21];
    for wrong in [
        joined(&swapped),
        joined(&twice),
        joined(&lines[1..]),
        text.clone() + "1000\n",
        text.clone() + "\n",
        text.replacen('\n', " \n", 1),
        text.replacen(lines[5], &format!("0{}", lines[5]), 1),
        format!("{}{text}", "9".repeat(3_000_000)),
        joined(&lines[..49]),
        format!("{}\n", lines[0]).repeat(50),
    ] {
        let refused = judge(&found, None, wrong.as_bytes()).unwrap_err();
        assert!(matches!(refused, FileViolation::Drawn { .. }), "{refused}");
    }
    // A last line without an end is a line.
    assert!(judge(&found, None, text.trim_end().as_bytes()).is_ok());
}

proptest! {
    #[test]
    fn any_numbers(seed in any::<u64>(), of in 0u64..20_000, share in 0.0..1.0f64) {
        let k = (of as f64 * share) as u64;
        let (found, text) = drawn(seed, of, k);
        prop_assert!(judge(&found, None, &text).is_ok());
    }
}
