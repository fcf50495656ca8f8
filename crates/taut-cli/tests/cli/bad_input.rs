//! Tests what goes wrong is named (file, row, column, value, remedy), the exit code is 2, and files stay as they were.

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

const GOOD_CSV: &str = "x,y,z\n0,0,0\n2,0,0\n1,0.5,0\n";

/// Runs `taut ball FILE -o ball.json --draw ball.svg` over earlier outputs, which must survive.
#[track_caller]
fn refused(folder: &TestFolder, file: &str, parts: &[&str]) {
    folder.put("ball.json", "earlier answer");
    folder.put("ball.svg", "earlier picture");
    let before = folder.files();
    let run =
        folder.taut(&format!("ball {file} -o ball.json --draw ball.svg")).ends(2).stderr_has(parts);
    assert_eq!(run.out, "");
    assert_eq!(folder.text("ball.json"), "earlier answer");
    assert_eq!(folder.text("ball.svg"), "earlier picture");
    assert_eq!(folder.files(), before, "something was left behind");
}

#[test]
fn a_ragged_row() {
    let folder = TestFolder::new();
    folder.put("ragged.csv", "x,y,z\n0,0,0\n2,0\n1,1,1\n");
    refused(
        &folder,
        "ragged.csv",
        &["ragged.csv", "row 2", "line 3", "2 columns", "3 are expected"],
    );
}

#[test]
fn not_a_number() {
    let folder = TestFolder::new();
    folder.put("nan.csv", GOOD_CSV.replace("0.5", "NaN"));
    refused(&folder, "nan.csv", &["nan.csv", "row 3", "column 1", "`y`", "NaN"]);
    folder.put("word.csv", GOOD_CSV.replace("0.5", "half"));
    refused(&folder, "word.csv", &["word.csv", "row 3", "column 1", "`y`", "`half`"]);
}

#[test]
fn not_a_number_in_a_binary_file() {
    let folder = TestFolder::new();
    folder.put("nan.f64", [0.0, 1.0, 2.0, f64::NAN].map(f64::to_le_bytes).concat());
    refused(
        &folder,
        "nan.f64 --raw-dim 2 --raw-type f64",
        &["nan.f64", "row 2", "column 1", "NaN"],
    );
}

#[test]
fn infinity() {
    let folder = TestFolder::new();
    folder.put("inf.csv", GOOD_CSV.replace("0.5", "-inf"));
    refused(&folder, "inf.csv", &["inf.csv", "row 3", "column 1", "`y`", "inf"]);
    folder.put("inf.f32", [0.0, f32::INFINITY].map(f32::to_le_bytes).concat());
    refused(
        &folder,
        "inf.f32 --raw-dim 1 --raw-type f32",
        &["inf.f32", "row 2", "column 0", "inf"],
    );
}

#[test]
fn a_negative_radius() {
    let folder = TestFolder::new();
    folder.put("discs.csv", "x,y,radius\n0,0,1\n1,1,-0.25\n");
    refused(&folder, "discs.csv --balls", &["discs.csv", "row 2", "column 2", "`radius`", "-0.25"]);
    folder.put("line.csv", "1\n2\n");
    refused(&folder, "line.csv --balls", &["line.csv", "a center and a radius"]);
}

#[test]
fn an_empty_file() {
    let folder = TestFolder::new();
    folder.put("empty.csv", "");
    refused(&folder, "empty.csv", &["empty.csv", "empty"]);
    folder.put("header.csv", "x,y\n");
    refused(&folder, "header.csv", &["header.csv", "no point"]);
    folder.pipe("", "ball -").ends(2).stderr_has(&["standard input"]);
}

#[test]
fn a_truncated_npy() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 100 -d 3 -o whole.npy").ends(0);
    let whole = folder.bytes("whole.npy");
    for keep in [whole.len() - 1, whole.len() / 2, 40, 5] {
        folder.put("cut.npy", &whole[..keep]);
        refused(&folder, "cut.npy", &["cut.npy"]);
    }
}

#[cfg(feature = "arrow")]
#[test]
fn a_truncated_parquet() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 100 -d 3 -o whole.parquet").ends(0);
    let whole = folder.bytes("whole.parquet");
    for keep in [whole.len() - 1, whole.len() / 2, 6] {
        folder.put("cut.parquet", &whole[..keep]);
        refused(&folder, "cut.parquet", &["cut.parquet"]);
    }
}

#[test]
fn a_truncated_archive() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 100 -d 3 -o whole.csv.gz").ends(0);
    let whole = folder.bytes("whole.csv.gz");
    folder.put("cut.csv.gz", &whole[..whole.len() / 2]);
    refused(&folder, "cut.csv.gz", &["cut.csv.gz"]);
}

#[test]
fn a_folder() {
    let folder = TestFolder::new();
    std::fs::create_dir(folder.path("folder.csv")).unwrap();
    refused(&folder, "folder.csv", &["folder.csv", "folder"]);
    folder.put("points.csv", GOOD_CSV);
    folder.taut("ball points.csv -o folder.csv").ends(2).stderr_has(&["folder.csv"]);
    folder.taut("ball points.csv -o nowhere/ball.json").ends(2).stderr_has(&["nowhere/ball.json"]);
}

#[test]
fn a_missing_file() {
    refused(&TestFolder::new(), "missing.csv", &["missing.csv", "no such file"]);
}

#[cfg(unix)]
#[test]
fn no_permission() {
    use std::os::unix::fs::PermissionsExt;
    let folder = TestFolder::new();
    folder.put("secret.csv", GOOD_CSV);
    std::fs::set_permissions(folder.path("secret.csv"), PermissionsExt::from_mode(0o000)).unwrap();
    if std::fs::read(folder.path("secret.csv")).is_ok() {
        eprintln!("skipped: no_permission, as this user may read everything");
        return;
    }
    refused(&folder, "secret.csv", &["secret.csv", "permission"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk() {
    let folder = TestFolder::new();
    folder.put("points.csv", GOOD_CSV);
    let lines = [
        "ball points.csv -o /dev/full",
        "ball points.csv --json -o /dev/full",
        "generate normal -n 10 -d 2 --format csv -o /dev/full",
        "tour -o /dev/full --quiet",
    ];
    for line in lines.into_iter().take(long_or(usize::MAX, 3)) {
        let run = folder.taut(line).ends(2).stderr_has(&["/dev/full", "No space left"]);
        assert!(!run.out.contains('{'), "{line} printed an answer that was not written");
    }
    folder.shell("taut ball missing.csv 2> /dev/full").ends(2);
    folder.shell("taut ball points.csv -q --progress always 2> /dev/full").ends(0);
    folder.shell("taut ball points.csv --progress always 2> /dev/full").ends(0);
    folder.put("ball.json", "earlier answer");
    for line in [
        "taut ball points.csv > /dev/full",
        "taut ball points.csv -o ball.json > /dev/full",
        "taut ball points.csv --json -o ball.json --draw ball.svg > /dev/full",
    ] {
        folder.shell(line).ends(2).stderr_has(&["standard output", "No space left"]);
    }
    folder.taut("ball points.csv -o ball.json --draw nowhere/ball.svg").ends(2);
    assert_eq!(folder.text("ball.json"), "earlier answer");
    assert_eq!(folder.files(), ["ball.json", "points.csv"]);
}

/// A file may not grow beyond one block: as on a full disk, a write fails halfway.
#[cfg(target_os = "linux")]
#[test]
fn a_write_that_fails_halfway_leaves_the_earlier_file() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 300 -d 200 -o points.npy").ends(0);
    folder.put("ball.json", "earlier answer");
    let before = folder.files();
    for trap in ["", "trap '' XFSZ; "] {
        let limit = format!("{trap}ulimit -f 1; taut");
        folder
            .shell(&format!("{limit} ball points.npy --quiet --epsilon 0.1 -o ball.json"))
            .ends(2)
            .stderr_has(&["ball.json", "File too large"]);
        folder
            .shell(&format!("{limit} generate normal -n 9999 -d 9 -o ball.json --format csv"))
            .ends(2)
            .stderr_has(&["ball.json", "File too large"]);
    }
    assert_eq!(folder.text("ball.json"), "earlier answer");
    assert_eq!(folder.files(), before);
}

#[test]
fn an_output_that_is_an_input_is_refused() {
    let folder = TestFolder::new();
    folder.put("points.csv", GOOD_CSV);
    folder.put("picture.svg", GOOD_CSV);
    folder.taut("ball points.csv -o ball.json").ends(0);
    std::fs::create_dir(folder.path("folder")).unwrap();
    std::fs::copy(folder.path("ball.json"), folder.path("answer.svg")).unwrap();
    let mut lines = vec![
        ("ball points.csv -o points.csv", "points.csv"),
        ("ball points.csv -o folder/../points.csv", "points.csv"),
        ("ball picture.svg --format csv --draw picture.svg", "picture.svg"),
        ("draw answer.svg points.csv -o answer.svg", "answer.svg"),
        ("draw ball.json picture.svg --format csv -o picture.svg", "picture.svg"),
    ];
    if cfg!(unix) {
        std::fs::hard_link(folder.path("points.csv"), folder.path("twin.csv")).unwrap();
        lines.push(("ball points.csv -o twin.csv", "twin.csv"));
    }
    for (line, file) in lines {
        folder
            .taut(line)
            .ends(2)
            .stderr_has(&[&format!("{file}` is the input: name another file")]);
    }
    assert_eq!(folder.text("points.csv"), GOOD_CSV);
    assert_eq!(folder.text("picture.svg"), GOOD_CSV);
    assert_eq!(folder.text("answer.svg"), folder.text("ball.json"));
}

#[test]
fn one_file_for_two_outputs_is_refused() {
    let folder = TestFolder::new();
    folder.put("points.csv", GOOD_CSV);
    for line in [
        "delaunay points.csv -o same.json --voronoi same.json",
        "delaunay points.csv -o same.ply --hull ./same.ply",
        "delaunay points.csv -o - --voronoi -",
    ] {
        folder.taut(line).ends(2).stderr_has(&["is named for two outputs"]);
    }
    assert!(!folder.path("same.json").exists() && !folder.path("same.ply").exists());
}

#[cfg(unix)]
#[test]
fn an_output_that_is_standard_input_is_refused() {
    let folder = TestFolder::new();
    folder.put("points.csv", GOOD_CSV);
    folder.shell("taut ball - -o points.csv < points.csv").ends(2).stderr_has(&["is the input"]);
    assert_eq!(folder.text("points.csv"), GOOD_CSV);
}

#[test]
fn unknown_names_and_options_out_of_range() {
    let folder = TestFolder::new();
    folder.put("points.csv", GOOD_CSV);
    folder.put("points.xls", GOOD_CSV);
    for (line, part) in [
        ("ball points.csv --method simplex", "simplex"),
        ("ball points.csv --format excel", "excel"),
        ("ball points.xls", "points.xls"),
        ("ball points.csv --epsilon 1.5", "1.5"),
        ("ball points.csv --epsilon -1", "--epsilon` is -1"),
        ("ball points.csv --epsilon NaN", "NaN"),
        ("ball points.csv --epsilon 0 --method badoiu-clarkson", "badoiu-clarkson"),
        ("ball points.csv --max-passes 1", "--max-passes"),
        ("ball points.csv --batch 0", "--batch"),
        ("ball points.csv --threads 0", "from 1 to 1024"),
        ("ball points.csv --threads 1025", "from 1 to 1024"),
        ("ball points.csv --threads 99999999999999999999", "from 1 to 1024"),
        ("generate clusters -n 1 -d 1 --spread -1", "--spread` is -1"),
        ("generate shell -n 1 -d 1 --thickness NaN", "--thickness` is NaN"),
        ("generate normal -n 1 -d 0", "--dim` is 0"),
        ("man points.csv/pages", "Not a directory"),
        ("tour -o tour.json", "tour.json"),
        ("tour --samples points.csv", "points.csv"),
        ("tour -o nowhere/tour.html", "nowhere/tour.html"),
        ("ball points.csv --columns w", "`w`"),
        ("ball points.csv --columns 7", "7"),
        ("ball points.csv --draw ball.bmp", "ball.bmp"),
        ("ball points.csv -o ball.svg", "--draw"),
        ("ball", "<POINTS>"),
        ("dance", "dance"),
        ("", "Usage"),
    ] {
        let run = folder.taut(line).ends(2);
        assert!(run.err.contains(part), "no `{part}` after `taut {line}`: {run:?}");
        assert_eq!(run.out, "", "{line}");
    }
    assert_eq!(folder.files(), ["points.csv", "points.xls"]);
}

/// Some of these changes make the decoder panic; that is caught, and its words must not reach the user either.
#[cfg(feature = "arrow")]
#[test]
fn a_damaged_arrow_file_is_one_line_of_complaint() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 20 -d 3 -o whole.arrow").ends(0);
    let whole = folder.bytes("whole.arrow");
    for at in (130..200).chain(400..440).step_by(long_or(1, 3)) {
        let mut changed = whole.clone();
        changed[at] ^= 0xff;
        folder.put("changed.arrow", &changed);
        let run = folder.taut("ball changed.arrow");
        assert!(!run.err.contains("panicked") && run.err.lines().count() <= 1, "{at}: {}", run.err);
    }
}
