//! The attack on answers about files: forged documents, and forged bytes.

use std::io::Cursor;
use std::time::Instant;

use taut::Monitor;
use taut::certify::{AnyFileSolution, Data, Files};

use crate::attack::{Tally, budget};

use crate::cases::files::FileCase;
use crate::forge::Forger;
use crate::oracle::files::judge;
use crate::random::Random;
/// Forges documents and files of all cases in turn, and judges what the checker lets pass.
pub fn attack(kind: &str, cases: &[FileCase]) -> Tally {
    let mut tally = Tally::default();
    let documents: Vec<_> =
        cases.iter().map(|case| (case.name.clone(), case.document.clone())).collect();
    let forgers: Vec<Forger> =
        documents.chunks(1).map(|own| Forger::new(own, &documents)).collect();
    for number in 0..budget() {
        let at = (number % cases.len() as u64) as usize;
        let case = &cases[at];
        let mut random = Random::new(kind, number);
        let mut forgery = forgers[at].forge(&mut random);
        let (mut input, mut output) = (case.input.clone(), case.output.clone());
        // A document by itself is forged, or a file, or both.
        if random.chance(40) {
            forgery.text = case.document.to_string();
            forgery.edits.clear();
        }
        if random.chance(50) {
            forgery.edits.push(forge_bytes(&mut random, &mut output));
        }
        match &mut input {
            Some(bytes) if random.chance(20) => {
                forgery.edits.push(forge_bytes(&mut random, bytes));
            }
            Some(_) if random.chance(40) => input = None,
            _ => {}
        }
        let told = || {
            let edits = forgery.edits.join("\n  ");
            let text = &forgery.text;
            format!(
                "{kind}, forgery {number}, of {}\n  {edits}\n  {text}\n  {input:?}\n  {output:?}",
                case.name
            )
        };
        tally.forgeries += 1;
        let Ok(solution) = AnyFileSolution::from_json(&forgery.text) else {
            tally.unread += 1;
            continue;
        };
        let mut read = input.as_ref().map(Cursor::new);
        let mut written = Cursor::new(&output);
        let files =
            Files { input: read.as_mut().map(|data| data as &mut dyn Data), output: &mut written };
        let begin = Instant::now();
        let checked = solution.check(files, &Monitor::silent());
        tally.slowest = tally.slowest.max(begin.elapsed());
        match checked {
            Err(error) => tally.refuse(&error.to_string()),
            Ok(verdict) => {
                tally.accepted += 1;
                // The hash says which honest file it is.
                let hash =
                    |text: &str| text.split("\"hash\":\"").nth(1).map(|rest| rest[..32].to_owned());
                let claimed = hash(&forgery.text);
                let honest = cases.iter().find(|case| hash(&case.document.to_string()) == claimed);
                let honest = honest.map_or(&[][..], |case| &case.output);
                tally.note(judge(&solution, &verdict, input.as_deref(), &output, honest), &told);
            }
        }
    }
    tally
}

/// Changes a few bytes: some value, a swap, a part that is cut off, repeated or said in words.
fn forge_bytes(random: &mut Random, bytes: &mut Vec<u8>) -> String {
    let length = bytes.len();
    match random.below(6) {
        0 if length > 0 => {
            let at = random.below(length);
            bytes[at] ^= 1 << random.below(8);
            format!("byte {at} changed")
        }
        1 if length > 1 => {
            let (a, b) = (random.below(length), random.below(length));
            bytes.swap(a, b);
            format!("bytes {a} and {b} exchanged")
        }
        2 => {
            bytes.truncate(random.below(length + 1));
            format!("cut to {} bytes", bytes.len())
        }
        3 if length > 0 => {
            let width = 1 + random.below(length);
            bytes.rotate_left(width);
            format!("rotated by {width}")
        }
        4 => {
            let word = *random.pick(&["nothing", "0", "\n", "nothing\n", "\r\n", " ", "+1"]);
            bytes.extend_from_slice(word.as_bytes());
            format!("with {word:?} at its end")
        }
        _ => {
            let byte = random.next() as u8;
            bytes.insert(random.below(length + 1), byte);
            format!("with a byte {byte} more")
        }
    }
}
