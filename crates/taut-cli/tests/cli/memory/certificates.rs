//! Certificates of files through `taut verify`.

use super::{records, words};

use crate::test_folder::TestFolder;
#[test]
fn a_sorted_file_is_verified_with_and_without_its_input() {
    let folder = TestFolder::new();
    let keys: Vec<u64> = words(5000).iter().map(|key| key % 900).collect();
    folder.put("records.bin", records(&keys));
    folder.taut(
        "memory sort records.bin --width 16 --memory 64K -o sorted.bin --certificate sorted.json",
    )
    .ends(0);
    folder.taut("verify sorted.json records.bin sorted.bin").ends(0).stdout_has(&[
        "Verified: 5000 records of 16 bytes in order",
        "bytes 0 to 7, as u64",
        "those of the input",
    ]);
    folder.taut("verify sorted.json sorted.bin").ends(0).stdout_has(&["those of the certificate"]);
    folder
        .taut("verify sorted.json records.bin")
        .ends(1)
        .stdout_has(&["Rejected: records.bin is not sorted: record ", "(from 0)"]);
    let mut other = folder.bytes("sorted.bin");
    other[15] ^= 1;
    folder.put("other.bin", &other);
    folder
        .taut("verify sorted.json records.bin other.bin")
        .ends(1)
        .stdout_has(&["Rejected: other.bin has hash ", "other content"]);
    other.truncate(16 * 4999);
    folder.put("other.bin", &other);
    folder.taut("verify sorted.json other.bin").ends(1).stdout_has(&["other.bin has 79984 bytes"]);
    let text = folder.text("sorted.json");
    folder.put("wrong.json", text.replace("\"width\": 16", "\"width\": 0"));
    folder.taut("verify wrong.json sorted.bin").ends(1).stdout_has(&["wrong.json: width is 0"]);
    folder.put("wrong.json", text.replace("\"u64\"", "\"u32\""));
    folder.taut("verify wrong.json sorted.bin").ends(2).stderr_has(&["wrong.json", "u32"]);
}

#[test]
fn a_sample_is_drawn_again() {
    let folder = TestFolder::new();
    folder
        .taut("memory sample -n 1000000000 -k 9000 --seed 5 -o rows.txt --certificate rows.json")
        .ends(0);
    folder
        .taut("verify rows.json rows.txt")
        .ends(0)
        .stdout_has(&["Verified: 9000 numbers of 1,000,000,000", "drawn again"]);
    // A file that it was made from is nothing to be passed over in silence.
    folder
        .taut("verify rows.json rows.json rows.txt")
        .ends(2)
        .stderr_has(&["rows.json: a sample is drawn from numbers, not from a file"]);
    let text = folder.text("rows.json");
    let promise = text.replace("\"of\": 1000000000", "\"of\": 18446744073709551615");
    folder
        .put("promise.json", promise.replace("\"drawn\": 9000", "\"drawn\": 4611686018427387904"));
    folder.taut("verify promise.json rows.txt").ends(1).stdout_has(&[
        "Rejected: rows.txt has ",
        "4611686018427387904 lines of a number take 9223372036854775807",
    ]);
    folder.put("rows.json", folder.text("rows.json").replace("\"seed\": 5", "\"seed\": 6"));
    folder.taut("verify rows.json rows.txt").ends(1).stdout_has(&["line 1 of rows.txt is "]);
    folder
        .taut("memory sample -n 10 -k 3 -o same.txt --certificate same.txt")
        .ends(2)
        .stderr_has(&["same.txt", "two outputs"]);
    assert!(!folder.files().contains(&"same.txt".to_owned()));
}

#[test]
fn files_and_points_are_told_apart() {
    let folder = TestFolder::new();
    folder.put("points.csv", "0,0\n2,0\n1,1\n");
    folder.taut("ball points.csv -o ball.json").ends(0);
    folder.taut("memory sample -n 9 -k 3 -o rows.txt --certificate rows.json").ends(0);
    folder.taut("verify ball.json points.csv rows.txt").ends(2).stderr_has(&["one file of points"]);
    folder.taut("verify rows.json rows.txt --epsilon 1").ends(2).stderr_has(&["--epsilon"]);
    folder.taut("verify rows.json missing.txt").ends(2).stderr_has(&["missing.txt"]);
    folder.taut("verify rows.json a b c").ends(2);
    folder.taut("verify rows.json").ends(2);
    folder.taut("draw rows.json points.csv -o rows.svg").ends(2).stderr_has(&["about files"]);
    folder
        .pipe(folder.text("rows.json"), "verify - rows.txt")
        .ends(0)
        .stdout_has(&["Verified: 3 numbers"]);
}
