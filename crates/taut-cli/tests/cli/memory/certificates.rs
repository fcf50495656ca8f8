//! Certificates of files through `taut verify`.

use super::{records, words};

use crate::desk::Desk;
#[test]
fn a_sorted_file_is_verified_with_and_without_its_input() {
    let desk = Desk::new();
    let keys: Vec<u64> = words(5000).iter().map(|key| key % 900).collect();
    desk.put("records.bin", records(&keys));
    desk.taut(
        "memory sort records.bin --width 16 --memory 64K -o sorted.bin --certificate sorted.json",
    )
    .ends(0);
    desk.taut("verify sorted.json records.bin sorted.bin").ends(0).says(&[
        "Verified: 5000 records of 16 bytes in order",
        "bytes 0 to 7, as u64",
        "those of the input",
    ]);
    desk.taut("verify sorted.json sorted.bin").ends(0).says(&["those of the certificate"]);
    desk.taut("verify sorted.json records.bin")
        .ends(1)
        .says(&["Rejected: records.bin is not sorted: record ", "(from 0)"]);
    let mut other = desk.bytes("sorted.bin");
    other[15] ^= 1;
    desk.put("other.bin", &other);
    desk.taut("verify sorted.json records.bin other.bin")
        .ends(1)
        .says(&["Rejected: other.bin has hash ", "other content"]);
    other.truncate(16 * 4999);
    desk.put("other.bin", &other);
    desk.taut("verify sorted.json other.bin").ends(1).says(&["other.bin has 79984 bytes"]);
    let text = desk.text("sorted.json");
    desk.put("wrong.json", text.replace("\"width\": 16", "\"width\": 0"));
    desk.taut("verify wrong.json sorted.bin").ends(1).says(&["wrong.json: width is 0"]);
    desk.put("wrong.json", text.replace("\"u64\"", "\"u32\""));
    desk.taut("verify wrong.json sorted.bin").ends(2).complains(&["wrong.json", "u32"]);
}

#[test]
fn a_sample_is_drawn_again() {
    let desk = Desk::new();
    desk.taut("memory sample -n 1000000000 -k 9000 --seed 5 -o rows.txt --certificate rows.json")
        .ends(0);
    desk.taut("verify rows.json rows.txt")
        .ends(0)
        .says(&["Verified: 9000 numbers of 1,000,000,000", "drawn again"]);
    // A file that it was made from is nothing to be passed over in silence.
    desk.taut("verify rows.json rows.json rows.txt")
        .ends(2)
        .complains(&["rows.json: a sample is drawn from numbers, not from a file"]);
    let text = desk.text("rows.json");
    let promise = text.replace("\"of\": 1000000000", "\"of\": 18446744073709551615");
    desk.put("promise.json", promise.replace("\"drawn\": 9000", "\"drawn\": 4611686018427387904"));
    desk.taut("verify promise.json rows.txt").ends(1).says(&[
        "Rejected: rows.txt has ",
        "4611686018427387904 lines of a number take 9223372036854775807",
    ]);
    desk.put("rows.json", desk.text("rows.json").replace("\"seed\": 5", "\"seed\": 6"));
    desk.taut("verify rows.json rows.txt").ends(1).says(&["line 1 of rows.txt is "]);
    desk.taut("memory sample -n 10 -k 3 -o same.txt --certificate same.txt")
        .ends(2)
        .complains(&["same.txt", "two outputs"]);
    assert!(!desk.files().contains(&"same.txt".to_owned()));
}

#[test]
fn files_and_points_are_told_apart() {
    let desk = Desk::new();
    desk.put("points.csv", "0,0\n2,0\n1,1\n");
    desk.taut("ball points.csv -o ball.json").ends(0);
    desk.taut("memory sample -n 9 -k 3 -o rows.txt --certificate rows.json").ends(0);
    desk.taut("verify ball.json points.csv rows.txt").ends(2).complains(&["one file of points"]);
    desk.taut("verify rows.json rows.txt --epsilon 1").ends(2).complains(&["--epsilon"]);
    desk.taut("verify rows.json missing.txt").ends(2).complains(&["missing.txt"]);
    desk.taut("verify rows.json a b c").ends(2);
    desk.taut("verify rows.json").ends(2);
    desk.taut("draw rows.json points.csv -o rows.svg").ends(2).complains(&["about files"]);
    desk.pipe(desk.text("rows.json"), "verify - rows.txt").ends(0).says(&["Verified: 3 numbers"]);
}
