//! `taut ellipsoid --robust`: center, scatter and outliers, and their proof.

use crate::test_folder::TestFolder;

/// A grid of 5 × 5 around (2, 2), and six rows where somebody's hand slipped: rows 26 to 31.
fn grid() -> String {
    let inside = (0..25).map(|i| format!("{},{}\n", i % 5, i / 5));
    let outside = (0..6).map(|i| format!("1000,{i}\n"));
    std::iter::once("x,y\n".to_owned()).chain(inside).chain(outside).collect()
}

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("points.csv", grid());
    folder
}

#[test]
fn outliers_are_named_and_all_is_verified() {
    let folder = folder();
    let rows = "\n  outliers   6; rows 26, 27, 28, 29, 30, 31\n";
    for (line, parts) in [
        ("mcd", ["\n  kept       17 of 31 points\n", rows, "C-step", "of normal points"]),
        (
            "mve",
            ["\n  kept       17 of 31 points\n", rows, "\n  gap        ", "0.975 of normal points"],
        ),
        (
            "trim --coverage 0.8",
            ["\n  kept       25 of 31 points\n", rows, "\n  gap        ", "around the points kept"],
        ),
    ] {
        let line = format!("ellipsoid points.csv --robust {line} -o robust.json");
        folder.taut(&line).ends(0).stdout_has(&[
            "Robust ellipsoid of 31 points in 2 dimensions\n",
            "\n  center     (2, 2)\n",
            "\n  log-det    ",
            "\n  verified   yes; ",
            "checking ",
        ]);
        folder.taut(&line).ends(0).stdout_has(&parts);
        let found: serde_json::Value = serde_json::from_str(&folder.text("robust.json")).unwrap();
        assert_eq!(found["kind"], "robust-ellipsoid");
        assert_eq!(found["answer"]["outliers"], serde_json::json!([25, 26, 27, 28, 29, 30]));
        folder.taut("verify robust.json points.csv").ends(0).stdout_has(&[
            "Verified",
            ": robust ellipsoid by ",
            "of 31 points in 2 dimensions\n",
            " 6; proved: exactly the points outside",
        ]);
        folder.put("other.csv", grid().replacen("0,0\n", "0,0.5\n", 1));
        folder.taut("verify robust.json other.csv").ends(1).stdout_has(&["Rejected: other.csv"]);
    }
}

#[test]
fn the_json_is_one_document_wherever_it_goes() {
    let folder = folder();
    let all = folder.taut("ellipsoid points.csv --robust mcd --json").ends(0).out;
    assert_eq!(folder.taut("ellipsoid points.csv --robust mcd -o -").ends(0).out, all);
    assert_eq!(
        folder.taut("ellipsoid points.csv --robust mcd --json --threads 1").ends(0).out,
        all
    );
    let run = folder.taut("ellipsoid points.csv --robust mcd --quiet -o robust.json").ends(0);
    assert_eq!((run.out.as_str(), run.err.as_str()), ("", ""));
    assert_eq!(folder.text("robust.json"), all);
    let run = folder.taut("ellipsoid points.csv --robust mcd --no-verify").ends(0);
    assert!(run.out.contains("not checked") && !run.out.contains("yes"), "{}", run.out);
}

#[test]
fn outliers_are_drawn_apart_beside_the_ellipsoid() {
    let folder = folder();
    for (method, parts) in [
        ("mcd", &["tolerance ellipsoid, 97.5 %", "outliers (6 points)", "17 points kept"][..]),
        ("mve", &["tolerance ellipsoid, 97.5 %", "smallest around the points kept"]),
        ("trim --coverage 0.8", &["smallest ellipsoid around the points kept", "support ("]),
    ] {
        let line =
            format!("ellipsoid points.csv --robust {method} -o robust.json --draw robust.svg");
        folder.taut(&line).ends(0);
        let picture = folder.text("robust.svg");
        for part in parts {
            assert!(picture.contains(part), "{method}: {part}");
        }
        assert!(!picture.contains("NaN"), "{method}");
        folder.taut("draw robust.json points.csv -o again.svg").ends(0);
        assert_eq!(folder.text("again.svg"), picture, "{method}");
        // Rows far out ask for a look from near by; then come the distances.
        folder.taut("draw robust.json points.csv -o close.svg --figure 2").ends(0);
        assert!(folder.text("close.svg").contains("from near by"), "{method}");
        assert!(folder.text("close.svg").contains("6 outliers lie beyond the picture"), "{method}");
        folder.taut("draw robust.json points.csv -o far.svg --figure 3").ends(0);
        assert!(folder.text("far.svg").contains("Distances in the metric"), "{method}");
        folder.taut("draw robust.json points.csv -o far.svg --figure 4").ends(2);
    }
    folder.put("other.csv", grid().replacen("0,0\n", "0,0.5\n", 1));
    folder.taut("draw robust.json other.csv -o other.svg").ends(1).stderr_has(&["other.csv"]);
    assert!(!folder.files().contains(&"other.svg".to_owned()));
}

#[test]
fn a_lie_about_the_outliers_is_found() {
    let folder = folder();
    folder.taut("ellipsoid points.csv --robust mcd -o robust.json").ends(0);
    let mut lie: serde_json::Value = serde_json::from_str(&folder.text("robust.json")).unwrap();
    lie["answer"]["outliers"] = serde_json::json!([25, 26, 27, 28, 29]);
    folder.put("lie.json", lie.to_string());
    folder
        .taut("verify lie.json points.csv")
        .ends(1)
        .stdout_has(&["Rejected: points.csv, row 31: ", "point 30"]);
}

#[test]
fn the_level_moves_the_border_and_the_coverage_the_count() {
    let folder = folder();
    let volume = |line: &str| {
        let run = folder.taut(&format!("ellipsoid points.csv --robust mcd --json {line}")).ends(0);
        run.json()["answer"]["log_volume"].as_f64().unwrap()
    };
    assert!(volume("--level 0.5") < volume("") && volume("") < volume("--level 0.9999"));
    folder
        .taut("ellipsoid points.csv --robust mcd --coverage 1")
        .ends(0)
        .stdout_has(&["\n  kept       31 of 31 points\n"]);
}

#[test]
fn exact_fits_are_reported() {
    let folder = TestFolder::new();
    let line: String = (0..20).map(|i| format!("{i},{i}\n")).collect();
    folder.put("line.csv", line + "0,7\n3,100\n");
    folder.taut("ellipsoid line.csv --robust mcd -o robust.json").ends(0).stdout_has(&[
        "\n  exact fit  20 of 22 points in a flat of dimension 1; ",
        "\n  outliers   2; rows 21, 22\n",
    ]);
    folder
        .taut("verify robust.json line.csv")
        .ends(0)
        .stdout_has(&["\n  dimension     1; proved\n"]);
}

#[test]
fn wrong_input_and_options_are_named() {
    let folder = folder();
    folder.put("nan.csv", grid().replacen("0,0\n", "0,NaN\n", 1));
    for (line, parts) in [
        ("nan.csv --robust mcd", &["nan.csv", "row 1", "column 1", "`y`", "NaN"][..]),
        ("points.csv --robust mcd --keep 0.4", &["--keep` is 0.4", "[0.5, 1]"]),
        ("points.csv --robust trim --keep 0", &["--keep` is 0", "(0, 1]"]),
        ("points.csv --robust mve --level 1", &["--level` is 1", "[0.5, 1)"]),
        ("points.csv --robust mve --epsilon 0", &["--epsilon` is 0", "(0, 0.01]"]),
        ("points.csv --robust trim --level 0.9", &["--level", "trim"]),
        ("points.csv --keep 0.9", &["--robust"]),
        ("points.csv --robust mad", &["mad", "mcd, mve, trim"]),
        ("points.csv --robust mcd --balls", &["--balls"]),
        ("points.csv --robust mcd --method newton", &["--method"]),
    ] {
        let run = folder.taut(&format!("ellipsoid {line} -o found.json")).ends(2);
        assert!(parts.iter().all(|part| run.err.contains(part)), "{parts:?} in {run:?}");
        assert_eq!(run.out, "", "{line}");
    }
    assert_eq!(folder.files(), ["nan.csv", "points.csv"]);
}
