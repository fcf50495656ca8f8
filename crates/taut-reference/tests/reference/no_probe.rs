//! A probe that does not record costs nothing: the machine code says so.
//!
//! All of `src/algorithms/` is compiled by itself with all optimizations, for `NoProbe`; once as it is, and once with
//! every line that tells a probe of something left blank. Nine functions in ten must have the same instructions, in the
//! same order; where the compiler, seeing another source, puts blocks or spills otherwise, the number of instructions
//! must be the same within 2 %, and within 0.5 % in all. A probe that records must add 2 % at least, in all. And a
//! loop written without any probe must be the code of its twin.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The program to compile: each algorithm for one type, which takes its generic parts along.
const ROOT: &str = r#"
#![crate_type = "lib"]
#![allow(warnings)]
pub mod probe;
pub mod algorithms;
pub use probe::{Access, NoProbe, Probe};

#[derive(Debug)]
pub enum Error {
    Option { name: &'static str, value: String, expected: &'static str },
}

pub fn transpose(a: &[f64], b: &mut [f64], n: usize) -> Result<(), Error> {
    algorithms::transpose(a, b, n, n, 1)
}
pub fn strassen(a: &[f64], b: &[f64], c: &mut [f64], n: usize) -> Result<(), Error> {
    algorithms::strassen(a, b, c, n, 1)
}
pub fn mergesort(a: &mut [u64]) { algorithms::mergesort(a) }
pub fn quicksort(a: &mut [u64]) { algorithms::quicksort(a, 1) }
pub fn funnelsort(a: &mut [u64]) { algorithms::funnelsort(a) }
pub fn columnsort(a: &mut [u64]) { algorithms::columnsort(a) }
pub fn distribution_sort(a: &mut [u64]) { algorithms::distribution_sort(a, 1) }
pub fn distributor_sort(a: &mut [u64]) {
    algorithms::distributor_sort(a, algorithms::DistributorForm::Recursive, 1)
}
pub fn select(a: &mut [u64]) -> Option<u64> { algorithms::select(a, 7) }
pub fn search(tree: &algorithms::VebTree<u64>) -> usize { tree.lower_bound(7) }
pub fn lu(a: &mut [f64], n: usize) -> Result<algorithms::Lu, Error> { algorithms::lu(a, n, n) }
pub fn fft(a: &mut [[f64; 2]]) -> Result<(), Error> {
    algorithms::fft(a, algorithms::Direction::Forward)
}
#[inline(never)] pub fn reverse(a: &mut [u64]) { algorithms::reverse(a) }
"#;

/// A line of [`ROOT`] as one would write it without probes.
const BARE: &str = "#[inline(never)] pub fn reverse(a: &mut [u64]) {
    for i in 0..a.len() / 2 {
        let j = a.len() - 1 - i;
        (a[i], a[j]) = (a[j], a[i]);
    }
}";

/// Copies the sources, changed line by line, into a folder of that name and compiles them to assembly.
fn assembly(name: &str, change: impl Fn(&str) -> String) -> String {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("no_probe").join(name);
    fs::create_dir_all(folder.join("algorithms")).expect("a folder for temporary files");
    let changed = |text: &str| text.lines().map(|line| change(line) + "\n").collect::<String>();
    fs::write(folder.join("lib.rs"), changed(ROOT)).expect("written");
    let copy = |file: &Path, to: &Path| {
        let text = fs::read_to_string(file).expect("sources are text");
        fs::write(to.join(file.file_name().expect("a file")), changed(&text)).expect("written");
    };
    copy(&crates.join("taut-oblivious/src/probe.rs"), &folder);
    for entry in fs::read_dir(crates.join("taut-reference/src/algorithms")).expect("the sources") {
        copy(&entry.expect("an entry").path(), &folder.join("algorithms"));
    }
    let compiler = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let output = Command::new(compiler)
        .args(["--edition=2024", "--emit=asm", "-Copt-level=3", "-Ccodegen-units=1", "lib.rs"])
        .current_dir(&folder)
        .output()
        .expect("the compiler runs");
    assert!(output.status.success(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    fs::read_to_string(folder.join("lib.s")).expect("assembly was written")
}

fn tells(line: &str) -> bool {
    let calls = ["place", "place_at", "lift", "lift_from", "read", "write", "record"];
    let line = line.trim();
    calls.iter().any(|call| line.starts_with(&format!("probe.{call}("))) && line.ends_with(';')
}

/// The instructions of each function without their operands: registers are dealt out again for each change of the source.
fn functions(assembly: &str) -> BTreeMap<&str, Vec<&str>> {
    let mut functions = BTreeMap::<&str, Vec<&str>>::new();
    let mut name = "";
    for line in assembly.lines() {
        let first = line.split_whitespace().next().unwrap_or_default();
        if line.starts_with(|c: char| c.is_alphabetic() || c == '_') && line.ends_with(':') {
            name = line;
        } else if line.starts_with('\t') && !first.starts_with('.') {
            functions.entry(name).or_default().push(first);
        }
    }
    functions
}

#[test]
#[cfg_attr(miri, ignore = "runs the compiler")]
fn a_probe_that_does_not_record_leaves_no_trace_in_the_code() {
    if !Path::new(env!("CARGO_MANIFEST_DIR")).join("../taut-oblivious/src/probe.rs").exists() {
        return println!("skipped: this package comes without the source of the probes");
    }
    let told = assembly("told", str::to_owned);
    let blank = assembly("blank", |line| match line {
        _ if tells(line) => String::new(),
        _ if line.contains("pub fn reverse(") => BARE.to_owned(),
        _ => line.to_owned(),
    });
    let recorded = assembly("recorded", |line| {
        let line =
            line.replace("const IS_RECORDING: bool = false", "const IS_RECORDING: bool = true");
        line.replace(
            "fn record(&mut self, _: usize, _: usize, _: Access) {}",
            "fn record(&mut self, at: usize, _: usize, _: Access) { std::hint::black_box(at); }",
        )
    });
    let [told, blank, recorded] = [&told, &blank, &recorded].map(|text| functions(text));

    assert!(told.keys().eq(blank.keys()), "the same functions");
    assert!(told.len() > 40, "{} functions", told.len());
    let other: Vec<_> = told.keys().filter(|&&name| told[name] != blank[name]).collect();
    assert!(told.keys().any(|name| name.contains("3lib7reverse")));
    assert!(!other.iter().any(|name| name.contains("3lib7reverse")));
    assert!(10 * other.len() <= told.len(), "other instructions in {other:?}");
    for name in other {
        let (a, b) = (told[name].len(), blank[name].len());
        // Without calls the compiler may order code otherwise, and need a few more.
        assert!(50 * a.saturating_sub(b) <= a, "{name} has {a} instructions, without calls {b}");
    }
    let size = |functions: &BTreeMap<&str, Vec<&str>>| functions.values().map(Vec::len).sum();
    let (a, b): (usize, usize) = (size(&told), size(&blank));
    assert!(200 * a.saturating_sub(b) <= a, "{a} instructions, without calls {b}");
    // A probe that records does leave traces, or this test would find none in anything.
    let of = |name: &&&str| {
        recorded.get(**name).is_none_or(|recorded| recorded.len() > told[**name].len())
    };
    let longer = told.keys().filter(of).count();
    println!(
        "{a} instructions; without calls {b}; longer for a probe that records: {longer} functions"
    );
    assert!(longer > 10, "{longer} of {}", told.len());
    let _ = fs::remove_dir_all(Path::new(env!("CARGO_TARGET_TMPDIR")).join("no_probe"));
}
