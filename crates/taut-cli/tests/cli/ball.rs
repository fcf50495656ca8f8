//! `taut ball`: the summary, the JSON, and the exit codes of runs that end well.

use crate::test_folder::TestFolder;
#[cfg(unix)]
use crate::test_length::long_or;

/// Smallest disc: center (1, 0), radius 1, by the first two points.
const TRIANGLE: &str = "x,y\n0,0\n2,0\n1,0.5\n";

#[test]
fn the_summary_names_every_number() {
    let folder = TestFolder::new();
    folder.put("points.csv", TRIANGLE);
    let run = folder.taut("ball points.csv").ends(0).stdout_has(&[
        "Smallest ball around 3 points in 2 dimensions\n",
        "\n  radius    1",
        "\n  center    (1, 0)\n",
        "\n  gap       ",
        "\n  verified  yes; every point is inside, and the gap is proved\n",
        "\n  method    core-set; converged\n",
        "\n  core-set  ",
        "of them in the support\n",
        "\n  passes    ",
        "s; reading ",
        ", checking ",
    ]);
    assert_eq!(run.err, "");
    assert_eq!(folder.files(), ["points.csv"]);
}

#[test]
fn many_coordinates_are_cut_short_on_the_terminal_and_whole_in_the_file() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 40 -d 20 -o points.npy").ends(0);
    folder
        .taut("ball points.npy -o ball.json")
        .ends(0)
        .stdout_has(&[", …) 20 in all; the JSON holds them (-o FILE)\n", "s; reading "]);
    let written: serde_json::Value = serde_json::from_str(&folder.text("ball.json")).unwrap();
    assert_eq!(written["answer"]["center"].as_array().unwrap().len(), 20);
}

#[test]
fn the_json_is_one_document_with_the_names_at_the_door() {
    let folder = TestFolder::new();
    folder.put("points.csv", TRIANGLE);
    let run = folder.taut("ball points.csv --json -o ball.json --epsilon 0").ends(0);
    let document = run.json();
    let keys: Vec<&String> = document.as_object().unwrap().keys().collect();
    assert_eq!(keys.len(), 5);
    for key in ["schema", "kind", "answer", "certificate", "trace"] {
        assert!(document.get(key).is_some(), "{key}");
    }
    assert_eq!(document["kind"], "ball");
    for (coordinate, value) in
        document["answer"]["center"].as_array().unwrap().iter().zip([1.0, 0.0])
    {
        assert!((coordinate.as_f64().unwrap() - value).abs() < 1e-14, "{coordinate}");
    }
    assert!((document["answer"]["radius"].as_f64().unwrap() - 1.0).abs() < 1e-14);
    assert_eq!(document["certificate"]["support"], serde_json::json!([0, 1]));
    assert_eq!(folder.text("ball.json"), run.out);
    for line in ["ball points.csv -o - --epsilon 0", "ball points.csv -o - --json --epsilon 0"] {
        assert_eq!(folder.taut(line).ends(0).out, run.out, "{line}");
    }
    assert!(!run.out.contains("seconds") && !run.out.contains("time"), "no clock in the JSON");
}

#[test]
fn quiet_says_nothing_and_still_writes() {
    let folder = TestFolder::new();
    folder.put("points.csv", TRIANGLE);
    let run = folder.taut("ball points.csv -o ball.json --quiet --progress always").ends(0);
    assert_eq!((run.out.as_str(), run.err.as_str()), ("", ""));
    assert!(folder.text("ball.json").contains("\"radius\""));
}

#[test]
fn without_the_check_nothing_is_called_verified() {
    let folder = TestFolder::new();
    folder.put("points.csv", TRIANGLE);
    let run =
        folder.taut("ball points.csv --no-verify").ends(0).stdout_has(&["verified  not checked\n"]);
    assert!(!run.out.contains("yes"), "{}", run.out);
}

#[test]
fn balls_are_centers_and_a_radius() {
    let folder = TestFolder::new();
    folder.put("discs.csv", "x,y,r\n0,0,1\n5,0,2\n");
    folder.taut("ball discs.csv --balls --epsilon 0 -o ball.json").ends(0).stdout_has(&[
        "around 2 balls in 2 dimensions",
        "\n  radius    4\n",
        "\n  center    (3, 0)\n",
    ]);
    folder.taut("verify ball.json discs.csv").ends(0);
}

#[test]
fn columns_are_chosen_by_name_number_and_range() {
    let folder = TestFolder::new();
    folder.put("points.csv", "name,x,y\n1,0,0\n2,2,0\n3,1,0.5\n");
    for columns in ["x,y", "1,2", "1-2", "1-"] {
        folder
            .taut(&format!("ball points.csv --columns {columns} --epsilon 0"))
            .ends(0)
            .stdout_has(&["\n  center    (1, 0)\n"]);
    }
}

#[test]
fn raw_files_are_read_with_their_layout() {
    let folder = TestFolder::new();
    let values: Vec<u8> = [9.0f32, 0.0, 0.0, 2.0, 0.0, 1.0, 0.5].map(f32::to_le_bytes).concat();
    folder.put("points.bin", values);
    folder
        .taut("ball points.bin --raw-dim 2 --raw-type f32 --raw-offset 4 --epsilon 0")
        .ends(0)
        .stdout_has(&["3 points in 2 dimensions", "\n  center    (1, 0)\n"]);
    folder.taut("ball points.bin --raw-dim 2").ends(2).stderr_has(&["--type"]);
}

#[test]
fn standard_input_is_a_dash() {
    let folder = TestFolder::new();
    folder.pipe(TRIANGLE, "ball -").ends(0).stdout_has(&["3 points in 2 dimensions"]);
}

#[cfg(unix)]
#[test]
fn generate_pipes_into_ball() {
    let folder = TestFolder::new();
    folder
        .shell("taut generate sphere -n 500 -d 3 | taut ball -")
        .ends(0)
        .stdout_has(&["500 points in 3 dimensions", "verified  yes"]);
}

#[cfg(unix)]
#[test]
fn a_reader_that_leaves_early_is_no_failure() {
    let folder = TestFolder::new();
    let run = folder
        .shell("{ taut generate normal -n 200000 -d 3; echo code $? >&2; } | head -n 1")
        .ends(0);
    assert_eq!(run.err, "code 0\n");
    assert_eq!(run.out.lines().count(), 1);
}

#[cfg(unix)]
#[test]
fn a_stop_by_budget_stays_one_when_nobody_listens() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 500 -d 30 -o points.npy").ends(0);
    for to in ["-o ball.json", "-o -", "--json"].into_iter().step_by(long_or(1, 2)) {
        let line = format!("taut ball points.npy --batch 1 --max-passes 3 --epsilon 0 {to}");
        let run = folder.shell(&format!("{{ sleep 0.3; {line}; echo code $? >&2; }} | true"));
        assert_eq!(run.err, "code 3\n", "{to}");
    }
    folder.taut("verify ball.json points.npy").ends(0);
}

#[test]
fn the_center_shown_lies_in_its_ball() {
    let folder = TestFolder::new();
    folder.put("far.csv", "1000000000000.5,7\n1000000000001.5,7\n");
    folder.taut("ball far.csv").ends(0).stdout_has(&["\n  center    (1000000000001, 7)\n"]);
}

#[test]
fn a_budget_ends_the_work_with_its_gap_and_code_3() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 500 -d 30 -o points.npy").ends(0);
    folder
        .taut("ball points.npy --batch 1 --max-passes 3 --epsilon 0 -o ball.json")
        .ends(3)
        .stdout_has(&[
            "stopped early by the budget of passes",
            "verified  yes",
            "\n  passes    3;",
        ]);
    // What was reached is still an answer with its proof.
    folder.taut("verify ball.json points.npy").ends(0);
}

#[test]
fn a_gap_below_rounding_is_not_claimed() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 300 -d 5 -o points.npy").ends(0);
    folder
        .taut("ball points.npy --epsilon 1e-300")
        .ends(3)
        .stdout_has(&["rounding", "verified  yes"]);
    folder.taut("ball points.npy --epsilon 0").ends(0);
}

#[test]
fn every_method_ends_in_the_same_ball() {
    let folder = TestFolder::new();
    folder.put("points.csv", TRIANGLE);
    for method in ["core-set", "thesis-pure", "thesis-fast", "badoiu-clarkson"] {
        let run = folder
            .taut(&format!("ball points.csv --json --method {method} --epsilon 0.01"))
            .ends(0);
        let radius = run.json()["answer"]["radius"].as_f64().unwrap();
        assert!((1.0 - 1e-12..=1.01).contains(&radius), "{method}: {radius}");
        assert_eq!(run.json()["trace"]["method"], method);
    }
}

#[test]
fn the_accuracy_of_core_sets_is_an_option_of_the_methods_that_have_one() {
    let folder = TestFolder::new();
    folder.put("points.csv", TRIANGLE);
    for method in ["thesis-pure", "thesis-fast"] {
        folder
            .taut(&format!("ball points.csv --method {method} --delta 1e-4 --epsilon 0.01"))
            .ends(0);
    }
    for words in
        ["--delta 1e-4", "--method badoiu-clarkson --delta 1e-4", "--method thesis-pure --delta 0"]
    {
        let run = folder.taut(&format!("ball points.csv {words} --epsilon 0.01")).ends(2);
        assert!(run.err.contains("delta"), "{}", run.err);
    }
}

#[test]
fn memory_bounds_what_is_held_and_changes_no_byte() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 3000 -d 4 -o points.csv").ends(0);
    let all = folder.taut("ball points.csv --json").ends(0).out;
    assert_eq!(folder.taut("ball points.csv --json --memory 10K").ends(0).out, all);
    folder.taut("ball points.csv --memory lots").ends(2);
}

#[test]
fn progress_is_told_on_standard_error_alone() {
    let folder = TestFolder::new();
    folder.put("points.csv", TRIANGLE);
    let run = folder.taut("ball points.csv --json --progress always").ends(0);
    assert!(run.err.contains("solving: pass 1 over 3 points\n"), "{}", run.err);
    run.json();
    assert_eq!(folder.taut("ball points.csv --progress never").ends(0).err, "");
}
