//! `taut memory`: files of records, matrices, samples, orders of points and simulated memories.

mod certificates;
mod npy;
mod order;
mod simulate;

use crate::test_folder::TestFolder;

/// Numbers that look random: the high words of a multiplicative sequence.
pub(crate) fn words(count: u64) -> Vec<u64> {
    (1..=count).map(|i| i.wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(17)).collect()
}

/// Records of 16 bytes: a key, then its place.
pub(crate) fn records(keys: &[u64]) -> Vec<u8> {
    (0u64..).zip(keys).flat_map(|(place, key)| [*key, place]).flat_map(u64::to_le_bytes).collect()
}
#[test]
fn records_are_sorted_checked_and_accounted_for() {
    let folder = TestFolder::new();
    let keys: Vec<u64> = words(20_000).iter().map(|key| key % 5000).collect();
    folder.put("records.bin", records(&keys));
    let mut sorted: Vec<(u64, u64)> = keys.iter().copied().zip(0..).collect();
    sorted.sort();
    let sorted: Vec<u8> =
        sorted.iter().flat_map(|(key, place)| [*key, *place]).flat_map(u64::to_le_bytes).collect();
    // In memory, and in runs; equal keys keep their order either way.
    for (memory, said) in [("256M", "runs            1 "), ("100K", "4.000 × the file")] {
        folder
            .taut(&format!("memory sort records.bin --width 16 --memory {memory} -o sorted.bin"))
            .ends(0)
            .stdout_has(&["20000 records of 16 bytes", said, "read again: in order"]);
        assert!(folder.bytes("sorted.bin") == sorted, "{memory}");
    }
    folder.taut("memory sort records.bin --width 16 --key 8:16 --quiet -o again.bin").ends(0);
    assert!(folder.bytes("again.bin") == records(&keys), "by place: as they were");
}

#[test]
fn what_cannot_be_sorted_is_named_and_nothing_is_written() {
    let folder = TestFolder::new();
    folder.put("records.bin", vec![7u8; 100]);
    folder.put("sorted.bin", "before");
    for (options, said) in [
        ("records.bin --width 16", &["records.bin", "100 bytes", "16"][..]),
        ("records.bin --item-bytes 0", &["`--item-bytes` is 0"]),
        ("records.bin --item-bytes 10 --sort-key 4:20", &["`--sort-key` is 4..20"]),
        ("records.bin --width 10 --key 3:8", &["key", "eight bytes"]),
        ("records.bin --width 10 --memory 1K", &["memory", "1024"]),
        ("records.bin", &["records.bin", "--item-bytes BYTES"]),
        ("points.parquet", &["taut convert points.parquet"]),
        ("missing.bin --width 10", &["missing.bin: no such file or folder"]),
    ] {
        folder.taut(&format!("memory sort {options} -o sorted.bin")).ends(2).stderr_has(said);
        assert_eq!(folder.text("sorted.bin"), "before");
    }
    folder.taut("memory sort records.bin --width 10 -o -").ends(2).stderr_has(&["name a file"]);
    folder
        .taut("memory transpose - --rows 1 --columns 1 -o columns.bin")
        .ends(2)
        .stderr_has(&["name a file"]);
    folder
        .taut("memory sort records.bin --width 10 -o records.bin")
        .ends(2)
        .stderr_has(&["records.bin"]);
}

#[test]
fn matrices_are_transposed_and_compared() {
    let folder = TestFolder::new();
    let matrix: Vec<u8> = (0..30_000u64).flat_map(u64::to_le_bytes).collect();
    folder.put("rows.bin", [b"head".to_vec(), matrix.clone()].concat());
    folder.taut(
        "memory transpose rows.bin --rows 300 --columns 100 --offset 4 --memory 4K -o columns.bin",
    )
    .ends(0)
    .stdout_has(&["100 × 300 elements of 8 bytes", "compared        all elements"]);
    folder
        .taut("memory transpose columns.bin --rows 100 --columns 300 --samples 50 -o back.bin")
        .ends(0)
        .stdout_has(&["50 elements"]);
    assert!(folder.bytes("back.bin") == matrix);
    folder
        .taut("memory transpose rows.bin --rows 300 --columns 101 -o columns.bin")
        .ends(2)
        .stderr_has(&["rows.bin", "240004", "242400"]);
    folder
        .taut("memory transpose columns.bin --rows 100 --columns 300 --width 0 -o back.bin")
        .ends(2)
        .stderr_has(&["at least one byte"]);
    assert!(folder.bytes("back.bin") == matrix);
}

#[test]
fn samples_depend_on_the_seed_alone() {
    let folder = TestFolder::new();
    let drawn = |threads: &str| {
        folder
            .taut(&format!(
                "memory sample -n 1000000 -k 5000 --seed 3 --threads {threads} -o rows.txt"
            ))
            .ends(0);
        folder.text("rows.txt")
    };
    let rows: Vec<u64> = drawn("1").lines().map(|line| line.parse().unwrap()).collect();
    assert!(rows.len() == 5000 && rows.is_sorted_by(|a, b| a < b) && rows[4999] < 1_000_000);
    assert_eq!(drawn("1"), drawn("4"));
    folder.taut("memory sample -n 4 -k 4").ends(0).stdout_has(&["0\n1\n2\n3\n"]);
    folder.taut("memory sample -n 4 -k 5").ends(2).stderr_has(&["k", "5"]);
}

/// A folder that takes no new files, a certificate that cannot be written, a check that fails: what was there stays.
#[cfg(target_os = "linux")]
#[test]
fn outputs_stay_as_they_were_unless_all_can_be_written() {
    let folder = TestFolder::new();
    folder.put("records.bin", records(&words(100)));
    folder.put("points.csv", "0,0\n2,0\n1,1\n");
    folder.put("out.bin", "before");
    folder.put("out.csv", "before");
    for command in [
        "sort records.bin --width 16 -o out.bin --certificate /proc/x.json",
        "transpose records.bin --rows 100 --columns 2 -o out.bin --certificate /proc/x.json",
        "order points.csv --points out.csv -o /proc/x.json",
    ] {
        folder
            .taut(&format!("memory {command}"))
            .ends(2)
            .stderr_has(&["/proc/x.json", "its folder takes no new files"]);
    }
    folder
        .taut("memory sort records.bin --width 16 -o /proc/x.bin")
        .ends(2)
        .stderr_has(&["/proc/x.bin", "its folder takes no new files"]);
    for name in ["out.bin", "out.csv"] {
        assert_eq!(folder.text(name), "before");
    }
    assert_eq!(folder.files(), ["out.bin", "out.csv", "points.csv", "records.bin"]);
}

/// A pipe without a writer, to open which is to wait.
#[cfg(target_os = "linux")]
#[test]
fn pipes_are_refused_at_once() {
    let folder = TestFolder::new();
    folder.put("records.bin", records(&words(100)));
    folder.taut("memory sort records.bin --width 16 -o out.bin --certificate out.json").ends(0);
    for command in [
        "memory sort pipe --width 8 -o x.bin",
        "memory transpose pipe --rows 2 --columns 2 -o x.bin",
        "memory transpose pipe.npy -o x.npy",
        "verify out.json pipe",
    ] {
        let taut = assert_cmd::cargo::cargo_bin!("taut").display().to_string();
        let run =
            folder.shell(&format!("mkfifo pipe pipe.npy 2>/dev/null; timeout 20 {taut} {command}"));
        run.ends(2).stderr_has(&["not a regular file"]);
    }
    folder
        .taut("memory transpose . --rows 2 --columns 2 -o x.bin")
        .ends(2)
        .stderr_has(&["not a regular file"]);
    assert!(!folder.files().contains(&"x.bin".to_owned()));
}

/// Runs of one file are not those of another one that looks as old.
#[test]
fn runs_of_another_input_are_refused() {
    let folder = TestFolder::new();
    let bytes = records(&words(20_000));
    folder.put("records.bin", &bytes);
    folder.put("runs", "of something else");
    folder.put("sorted.bin", "before");
    for memory in ["100K", "256M"] {
        folder
            .taut(&format!(
                "memory sort records.bin --width 16 --memory {memory} -o sorted.bin --resume runs"
            ))
            .ends(2)
            .stderr_has(&["`--checkpoint`", "runs", "same sort"]);
    }
    assert_eq!(folder.text("sorted.bin"), "before");
    assert_eq!(folder.text("runs"), "of something else");
}
