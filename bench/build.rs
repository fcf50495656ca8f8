//! Tells the bench the commit it is built from: what a later checkout says is not what was measured.

use std::process::Command;

fn main() {
    let described = git(&["describe", "--always", "--dirty", "--tags"]);
    println!("cargo::rustc-env=TAUT_BUILT_FROM={}", described.as_deref().unwrap_or("unknown"));
    // A commit moves the log of HEAD; `--dirty` is about what the bench is built from.
    if let Some(log) = git(&["rev-parse", "--git-path", "logs/HEAD"]) {
        println!("cargo::rerun-if-changed={log}");
    }
    for path in ["../crates", "../Cargo.toml", "../Cargo.lock", "src", "Cargo.toml", "build.rs"] {
        println!("cargo::rerun-if-changed={path}");
    }
}

/// What git prints, if it does.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}
