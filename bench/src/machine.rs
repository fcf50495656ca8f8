//! What has to be known of the machine and the programs to read a time.

use std::process::Command;

use crate::prelude::*;

/// Versions of the peers that Cargo.lock, that of `peers/rust`, that of `peers/tours` and `bench/setup` name.
const CRATES: &str = "\
    miniball (crate) 0.5.0; extsort 0.5.0; fast_hilbert 2.1.0; indexset 0.16.0; kiddo 6.3.0; quickheap 0.2.0; \
    imageproc 0.27.0; polylabel 3.3.0; parry3d-f64 0.31.1; rand 0.10.3; rdst 0.20.14; transpose 0.2.3; \
    voracious_radix_sort 1.2.0; concorde_rs 0.1.1; numpy (sort) 2.4.6";

/// Packages of PyPI, whose versions are those that are installed.
const PACKAGES: [&str; 20] = [
    "cyminiball",
    "miniball",
    "numpy",
    "scipy",
    "scikit-learn",
    "scikit-learn-extra",
    "opencv-python-headless",
    "cvxpy",
    "clarabel",
    "dynesty",
    "highspy",
    "elkai",
    "open3d",
    "pymeshlab",
    "shapely",
    "python-polylabel",
    "libigl",
    "drake",
    "vhacdx",
    "coacd",
];

/// Prints a line for each package: its name and its version.
const ASK: &str = "
import sys, importlib.metadata as m
for name in sys.argv[1:]:
    try: print(name, m.version(name))
    except m.PackageNotFoundError: print(name, 'not-installed')
";

/// Machine, versions and date, as one JSON object.
pub(crate) fn describe() -> Value {
    let cpu = file("/proc/cpuinfo");
    let field = |name: &str| {
        cpu.lines()
            .find(|line| line.starts_with(name))
            .and_then(|line| line.split_once(':'))
            .map_or("unknown", |(_, value)| value.trim())
            .to_owned()
    };
    let memory = file("/proc/meminfo");
    let installed = Command::new(peer::folder().join(".venv/bin/python"))
        .args(["-c", ASK])
        .args(PACKAGES)
        .output()
        .map(|done| String::from_utf8_lossy(&done.stdout).into_owned())
        .unwrap_or_default();
    let installed = if installed.is_empty() {
        PACKAGES.map(|name| format!("{name} not-installed")).join("\n")
    } else {
        installed
    };
    let peers = CRATES.split("; ").chain(installed.lines());
    let peers = peers.filter_map(|peer| peer.rsplit_once(' '));
    let peers = peers.map(|(name, version)| (name.to_owned(), version.into())).collect();
    let machine = json!({
        "date": output("date", &["-u", "+%Y-%m-%dT%H:%M:%SZ"]),
        "cpu": field("model name"),
        "cores": std::thread::available_parallelism().map_or(1, usize::from),
        "memory": memory.lines().next().and_then(|line| line.split_once(':')).map(|(_, size)| size.trim()),
        "load": file("/proc/loadavg").trim(),
        "kernel": output("uname", &["-sr"]),
        "rustc": output("rustc", &["--version"]),
        "taut": env!("TAUT_BUILT_FROM"),
        "g++": output("g++", &["-dumpfullversion"]),
        "cgal": output("dpkg-query", &["-W", "-f=${Version}", "libcgal-dev"]),
        "fgk": file(&peer::folder().join("peers/build/fgk-version").to_string_lossy()).trim(),
        "eigen": output("dpkg-query", &["-W", "-f=${Version}", "libeigen3-dev"]),
    });
    joined([machine, Value::Object(peers)])
}

fn file(path: &str) -> String {
    std::fs::read_to_string(path).unwrap_or_default()
}

fn output(program: &str, arguments: &[&str]) -> String {
    match Command::new(program).args(arguments).output() {
        Ok(done) if done.status.success() => {
            String::from_utf8_lossy(&done.stdout).trim().to_owned()
        }
        _ => "unknown".to_owned(),
    }
}
