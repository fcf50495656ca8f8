//! `taut verify`: proves, or rejects and says why.

use crate::test_folder::TestFolder;

const SQUARE: &str = "x,y\n0,0\n2,0\n2,2\n0,2\n1,1.5\n";

fn solved() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("points.csv", SQUARE);
    folder.taut("ball points.csv --epsilon 0 -o ball.json").ends(0);
    folder
}

/// Changes the answer by a function of its JSON.
fn doctor(folder: &TestFolder, change: impl Fn(&mut serde_json::Value)) {
    let mut document = serde_json::from_str(&folder.text("ball.json")).unwrap();
    change(&mut document);
    folder.put("doctored.json", document.to_string());
}

#[test]
fn a_true_answer_is_proved_with_its_bracket() {
    let folder = solved();
    let run = folder.taut("verify ball.json points.csv").ends(0).stdout_has(&[
        "Verified within a gap of ",
        ": ball of radius 1.41421356",
        " points in 2 dimensions\n",
        "\n  bracket   1.41421356",
        " ≤ smallest radius ≤ 1.41421356",
        "\n  gap       ",
        "; proved: relative, from the points alone\n",
    ]);
    assert_eq!(run.err, "");
    let quiet = folder.taut("verify ball.json points.csv --quiet").ends(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
}

#[test]
fn either_input_may_be_standard_input_but_not_both() {
    let folder = solved();
    folder.pipe(folder.text("ball.json"), "verify - points.csv").ends(0).stdout_has(&["Verified"]);
    folder.pipe(SQUARE, "verify ball.json -").ends(0).stdout_has(&["Verified"]);
    folder.pipe("", "verify - -").ends(2).stderr_has(&["only one"]);
}

#[test]
fn changed_data_is_known_by_its_hash() {
    let folder = solved();
    folder.put("changed.csv", SQUARE.replace("1.5", "1.25"));
    folder.taut("verify ball.json changed.csv").ends(1).stdout_has(&[
        "Rejected: changed.csv does not belong to ball.json",
        "hash",
        "data changed",
    ]);
}

#[test]
fn a_smaller_radius_leaves_a_point_outside() {
    let folder = solved();
    doctor(&folder, |ball| {
        let radius = &mut ball["answer"]["radius"];
        *radius = (radius.as_f64().unwrap() - 1e-9).into();
    });
    let run = folder
        .taut("verify doctored.json points.csv")
        .ends(1)
        .stdout_has(&["Rejected: points.csv, row 1: point 0 lies ", "outside"]);
    assert!(run.err.is_empty());
    assert_eq!(folder.taut("verify doctored.json points.csv -q").ends(1).out, "");
}

#[test]
fn a_larger_radius_breaks_the_gap_claimed() {
    let folder = solved();
    doctor(&folder, |ball| {
        let radius = &mut ball["answer"]["radius"];
        *radius = (radius.as_f64().unwrap() * 1.001).into();
    });
    folder.taut("verify doctored.json points.csv").ends(1).stdout_has(&["Rejected", "gap"]);
}

#[test]
fn another_dimension_is_rejected() {
    let folder = solved();
    folder.put("space.csv", "0,0,0\n1,1,1\n");
    folder.taut("verify ball.json space.csv").ends(1).stdout_has(&[
        "Rejected: space.csv does not belong to ball.json: the center has 2 numbers, but the points have dimension 3",
    ]);
}

#[test]
fn faults_of_the_answer_name_its_file() {
    let folder = solved();
    doctor(&folder, |ball| ball["certificate"]["multipliers"] = serde_json::json!([1.0]));
    folder.taut("verify doctored.json points.csv").ends(1).stdout_has(&[
        "Rejected: doctored.json: the list of multipliers has 1 number, expected 2\n",
    ]);
    doctor(&folder, |ball| ball["answer"]["radius"] = (-1e-200).into());
    folder
        .taut("verify doctored.json points.csv")
        .ends(1)
        .stdout_has(&["Rejected: doctored.json: the radius is -1e-200: "]);
}

#[test]
fn points_that_are_no_numbers_are_bad_input_in_any_format() {
    let folder = solved();
    folder.put("nan.csv", SQUARE.replace("1.5", "NaN"));
    folder.taut("verify ball.json nan.csv").ends(2).stderr_has(&["nan.csv", "row 5", "`y`", "NaN"]);
    folder.put(
        "nan.f64",
        [0.0, 1.0, 2.0, f64::NAN, 3.0, 3.0, 4.0, 4.0].map(f64::to_le_bytes).concat(),
    );
    folder
        .taut("verify ball.json nan.f64 --raw-dim 2 --raw-type f64")
        .ends(2)
        .stderr_has(&["nan.f64", "row 2", "column 1", "NaN"]);
    folder.put("discs.csv", "x,y,r\n0,0,1\n5,0,2\n");
    folder.taut("ball discs.csv --balls -o discs.json").ends(0);
    folder.put("discs.csv", "x,y,r\n0,0,1\n5,0,-2\n");
    folder.taut("verify discs.json discs.csv").ends(2).stderr_has(&["row 2", "`r`", "-2"]);
}

#[test]
fn a_loose_certificate_is_true_but_not_tight() {
    let folder = solved();
    folder.taut("generate normal -n 200 -d 4 -o points.csv").ends(0);
    folder.taut("ball points.csv -o ball.json").ends(0);
    folder.taut("ball points.csv --epsilon 0.5 --method badoiu-clarkson -o loose.json").ends(0);
    let gap = folder
        .taut("verify loose.json points.csv")
        .ends(0)
        .stdout_has(&["Verified within a gap of "]);
    assert!(!gap.out.contains("within a gap of 0"), "{gap:?}");
    folder.taut("verify loose.json points.csv --epsilon 0.9").ends(0);
    folder
        .taut("verify loose.json points.csv --epsilon 1e-9")
        .ends(1)
        .stdout_has(&["Rejected: loose.json: a gap of ", "--epsilon 1e-9"]);
    folder.taut("verify ball.json points.csv --epsilon 1e-9").ends(0);
    for epsilon in ["-1", "NaN", "tiny"] {
        let run = folder.taut(&format!("verify ball.json points.csv --epsilon {epsilon}")).ends(2);
        assert!(run.err.contains("at least 0"), "{run:?}");
    }
}

#[cfg(unix)]
#[test]
fn a_rejection_stays_one_when_nobody_listens() {
    let folder = solved();
    doctor(&folder, |ball| ball["answer"]["radius"] = 1.0.into());
    // The pipe has no reader left when the command starts.
    let line = "{ sleep 0.3; taut verify doctored.json points.csv; echo code $? >&2; } | true";
    assert_eq!(folder.shell(line).err, "code 1\n");
}

#[test]
fn a_byte_order_mark_is_no_fault_and_a_second_form_is_one() {
    let folder = solved();
    folder.put("bom.json", format!("\u{feff}{}", folder.text("ball.json")));
    folder.taut("verify bom.json points.csv").ends(0);
    let places =
        ["/note", "/answer/note", "/certificate/note", "/trace/note", "/trace/history/0/note"];
    for place in places {
        let (parent, _) = place.rsplit_once('/').unwrap();
        doctor(&folder, |ball| ball.pointer_mut(parent).unwrap()["note"] = 1.into());
        folder
            .taut("verify doctored.json points.csv")
            .ends(2)
            .stderr_has(&["doctored.json", "`note`"]);
    }
    doctor(&folder, |ball| {
        let hash = &mut ball["certificate"]["points_hash"];
        *hash = format!("+{}", &hash.as_str().unwrap()[1..]).into();
    });
    folder.taut("verify doctored.json points.csv").ends(2).stderr_has(&["16 digits"]);
}

#[test]
fn no_file_commands_the_terminal() {
    let folder = solved();
    folder.put("other.json", "{\"schema\": 1, \"kind\": \"\\u001b[31mred\"}");
    let run = folder.taut("verify other.json points.csv").ends(2).stderr_has(&["[31mred"]);
    assert!(!run.err.contains('\u{1b}'));
    folder.put("named.csv", "x,\u{1b}[31my\n0,0\n1,NaN\n");
    let run = folder.taut("ball named.csv").ends(2).stderr_has(&["[31my"]);
    assert!(!run.err.contains('\u{1b}'));
}

#[test]
fn what_is_no_answer_is_named() {
    let folder = solved();
    folder.taut("verify points.csv ball.json").ends(2).stderr_has(&[
        "points.csv: not an answer of taut: it is no JSON object",
        "the answer comes first",
    ]);
    folder.put("bare.csv", "0,0\n1,1\n");
    folder.taut("verify bare.csv ball.json").ends(2).stderr_has(&["the answer comes first"]);
    std::fs::create_dir(folder.path("folder")).unwrap();
    folder
        .taut("verify folder points.csv")
        .ends(2)
        .stderr_has(&["folder: a folder without manifest.txt"]);
    folder.put("list.json", "[]");
    folder.put("word.json", "\"ball\"");
    folder.put("half.json", &folder.text("ball.json")[..40]);
    for file in ["list.json", "word.json", "half.json"] {
        let run = folder.taut(&format!("verify {file} points.csv")).ends(2).stderr_has(&[file]);
        assert!(!run.err.contains("struct"), "{run:?}");
    }
    folder.put("other.json", "{\"schema\": 1, \"kind\": \"torus\"}");
    folder.taut("verify other.json points.csv").ends(2).stderr_has(&["other.json", "torus"]);
    folder
        .taut("verify points.csv points.csv")
        .ends(2)
        .stderr_has(&["points.csv", "not an answer"]);
    folder.taut("verify missing.json points.csv").ends(2).stderr_has(&["missing.json"]);
    folder.put("binary.json", [0xff, 0xfe, 0x00]);
    folder.taut("verify binary.json points.csv").ends(2).stderr_has(&["binary.json"]);
}

/// One file read as points and as balls has two answers, both true: the report says of which inputs each is.
#[test]
fn what_the_rows_stand_for_is_said() {
    let folder = TestFolder::new();
    folder.put("rows.csv", "0,0,1\n4,0,0.5\n0,3,0.25\n");
    folder.taut("ball rows.csv -o points.json").ends(0);
    folder.taut("ball rows.csv --balls -o balls.json").ends(0);
    let said = |answer: &str| folder.taut(&format!("verify {answer} rows.csv")).ends(0).out;
    let first = |text: &str| text.lines().next().unwrap_or_default().to_owned();
    let (points, balls) = (first(&said("points.json")), first(&said("balls.json")));
    assert!(
        points.contains("within a gap of ") && points.ends_with("around 3 points in 3 dimensions")
    );
    assert!(
        balls.contains("within a gap of ") && balls.ends_with("around 3 balls in 2 dimensions")
    );
}
