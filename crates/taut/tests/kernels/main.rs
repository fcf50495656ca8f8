//! Every instruction set gives the answers of the portable kernels: the same bits where answers are exact.
#![allow(missing_docs)]

mod answers;

use std::collections::BTreeMap;
use std::process::Command;

use taut::points::KERNELS_VARIABLE;

/// Has this program print its answers instead of comparing those of others.
const PRINT_VARIABLE: &str = "TAUT_PRINT_ANSWERS";

/// Prints the answers where asked; the test below runs it in a process of its own, as an instruction set is chosen once.
#[test]
fn print_answers() {
    if std::env::var_os(PRINT_VARIABLE).is_some() {
        for answer in answers::all() {
            println!("answer {} {:016x} {}", answer.is_exact, answer.hash, answer.name);
        }
    }
}

/// Returns the hash and the exactness of each answer with kernels limited to an instruction set.
fn answers_by(kernels: &str) -> BTreeMap<String, (String, bool)> {
    let output = Command::new(std::env::current_exe().unwrap())
        .args(["print_answers", "--exact", "--nocapture"])
        .env(PRINT_VARIABLE, "1")
        .env(KERNELS_VARIABLE, kernels)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{kernels}: {text}");
    let mut found = BTreeMap::new();
    for line in text.lines().filter_map(|line| line.strip_prefix("answer ")) {
        let [exact, hash, name] = line.splitn(3, ' ').collect::<Vec<_>>()[..] else {
            panic!("{line}")
        };
        found.insert(name.to_owned(), (hash.to_owned(), exact == "true"));
    }
    found
}

#[test]
fn exact_answers_have_the_same_bits_for_every_instruction_set() {
    let portable = answers_by("portable");
    assert!(portable.len() > 200, "35 inputs, and some six answers to most");
    // The best of this machine, and one between where it has one.
    for kernels in ["", "avx2"] {
        let found = answers_by(kernels);
        assert_eq!(found.len(), portable.len());
        let mut differ: BTreeMap<&str, usize> = BTreeMap::new();
        for (name, (hash, is_exact)) in &found {
            let is_same = *hash == portable[name].0;
            assert!(is_same || !is_exact, "{kernels}: {name}");
            let tool = name.split_once(": ").unwrap().1;
            *differ.entry(tool).or_default() += usize::from(!is_same);
        }
        println!("{kernels:?} and portable kernels, answers that differ: {differ:?}");
    }
}
