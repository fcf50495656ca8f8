//! Any bytes as an answer about files, and the seeds of the fuzz target.

#[path = "files_any/bytes.rs"]
mod bytes;

use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use proptest::prelude::*;
use taut_certify::{
    DrawnSample, FileCheckError, FileSolution, FileViolation, Files, SampleCertificate, Trace,
};
use taut_points::Monitor;

/// The seeds of the fuzz target; none where this package is alone.
fn seeds() -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/files");
    if !folder.exists() {
        return vec![];
    }
    let seeds = std::fs::read_dir(folder).unwrap();
    seeds.map(|seed| std::fs::read(seed.unwrap().path()).unwrap()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// A seed with bytes changed, cut or put in.
    #[test]
    fn edited_seeds(which in any::<usize>(), edits in prop::collection::vec((any::<usize>(), any::<u8>()), 0..6)) {
        let seeds = seeds();
        if seeds.is_empty() {
            return Ok(());
        }
        let mut seed = seeds[which % seeds.len()].clone();
        for (place, byte) in edits {
            let place = place % seed.len();
            match byte % 3 {
                0 => seed[place] = byte,
                1 => seed.insert(place, byte),
                _ => {
                    seed.drain(place..(place + 3).min(seed.len()));
                }
            }
            if seed.is_empty() {
                break;
            }
        }
        bytes::check_any(&seed);
    }
}

#[test]
fn the_seeds_pass() {
    let seeds = seeds();
    if seeds.is_empty() {
        return println!("skipped the_seeds_pass: this package comes without its seeds");
    }
    assert!(seeds.len() >= 4);
    seeds.iter().for_each(|seed| bytes::check_any(seed));
}

/// A file that has so many bytes by its own word.
struct Sparse(u64);

impl Read for Sparse {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        buffer[..2].copy_from_slice(b"x\n");
        Ok(2)
    }
}

impl Seek for Sparse {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        Ok(if to == SeekFrom::End(0) { self.0 } else { 0 })
    }
}

#[test]
fn a_sample_of_a_sparse_file_takes_no_memory() {
    // In a process of its own, as the most that a process holds is that of all tests of a program.
    const ALONE: &str = "TAUT_TEST_ALONE";
    if std::env::var_os(ALONE).is_none() {
        let name = "files_bytes::a_sample_of_a_sparse_file_takes_no_memory";
        let mut test = std::process::Command::new(std::env::current_exe().unwrap());
        let status = test.args(["--exact", name]).env(ALONE, "1").status().unwrap();
        assert!(status.success(), "{status}");
        return;
    }
    let certificate = SampleCertificate { seed: 1 };
    // Seven million weights of the first division alone.
    let answer = DrawnSample { of: 1_000_000_000_000, drawn: 500_000_000_000 };
    let found = FileSolution { answer, certificate, trace: Trace::default() };
    let (before, mut output) = (most_held(), Sparse(1 << 40));
    let judged = found.check(Files { input: None, output: &mut output }, &Monitor::silent());
    assert!(matches!(judged, Err(FileCheckError::Rejected(FileViolation::Drawn { .. }))));
    let more = most_held() - before;
    assert!(more < 16 << 20, "{more} bytes");
}

/// Bytes that this process has held at most, where the system tells.
fn most_held() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.and_then(|line| line.trim().split(' ').next()?.parse().ok()).unwrap_or(0) << 10
}
