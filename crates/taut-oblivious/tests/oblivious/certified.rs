//! Sorted files, transposed files, samples and orders: what the solvers make is confirmed, and nothing that was changed.

#[path = "certified/order.rs"]
mod order;
#[path = "certified/sample.rs"]
mod sample;
#[path = "certified/sort.rs"]
mod sort;
#[path = "certified/transpose.rs"]
mod transpose;

use std::io::Cursor;

use taut_certify::{AnyFileSolution, FileCheckError, FileVerdict, FileViolation, Files};
use taut_points::Monitor;

/// Judges bytes, and if they are given compares them with others.
fn judge(
    found: &AnyFileSolution,
    input: Option<&[u8]>,
    output: &[u8],
) -> Result<FileVerdict, FileViolation> {
    // Through JSON, which is how answers travel.
    let found = &AnyFileSolution::from_json(&found.to_json()).unwrap();
    let (mut from, mut to) = (Cursor::new(input.unwrap_or_default()), Cursor::new(output));
    let input = input.map(|_| &mut from as &mut dyn taut_certify::Data);
    match found.check(Files { input, output: &mut to }, &Monitor::silent()) {
        Ok(verdict) => Ok(verdict),
        Err(FileCheckError::Rejected(violation)) => Err(violation),
        Err(error) => panic!("bytes in memory can be read: {error}"),
    }
}

/// Every number and word of `answer` and `certificate` in the JSON, changed one at a time: no document is confirmed.
fn no_change_is_confirmed(
    found: &AnyFileSolution,
    input: Option<&[u8]>,
    output: &[u8],
    changes: &[(&str, &[&str])],
) {
    judge(found, input, output).unwrap();
    let text = found.to_json();
    for (field, values) in changes {
        for value in *values {
            let changed = replaced(&text, field, value);
            assert_ne!(changed, text, "{field}: {value}");
            let Ok(changed) = AnyFileSolution::from_json(&changed) else { continue };
            assert!(judge(&changed, input, output).is_err(), "{field}: {value}");
        }
    }
    // None was forgotten.
    let document: serde_json::Value = serde_json::from_str(&text).unwrap();
    for part in ["answer", "certificate"] {
        for name in document[part].as_object().unwrap().keys() {
            assert!(changes.iter().any(|(field, _)| field == name), "{name} is not changed");
        }
    }
    for without in changes.iter().map(|change| change.0) {
        let mut document = document.clone();
        let gone = ["answer", "certificate"]
            .into_iter()
            .any(|part| document[part].as_object_mut().unwrap().remove(without).is_some());
        assert!(gone, "{without}");
        if let Ok(changed) = AnyFileSolution::from_json(&document.to_string()) {
            let verdict = judge(&changed, input, output);
            match without {
                "dtype" => assert!(verdict.is_ok(), "the type of npy files may be left out"),
                "header" => assert!(verdict.is_err(), "a header that is left out is none"),
                _ => panic!("{without} may be left out"),
            }
        }
    }
}

/// The document with another value of a field.
fn replaced(text: &str, field: &str, value: &str) -> String {
    let mut document: serde_json::Value = serde_json::from_str(text).unwrap();
    for part in ["answer", "certificate"] {
        if let Some(place) = document[part].get_mut(field) {
            *place = serde_json::from_str(value).unwrap();
        }
    }
    serde_json::to_string_pretty(&document).unwrap()
}

/// Words that look random.
fn words(count: u64) -> Vec<u64> {
    (1..=count).map(|i| i.wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(17)).collect()
}
