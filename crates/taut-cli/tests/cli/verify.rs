//! `taut verify`: proves, or rejects and says why.

use crate::desk::Desk;

const SQUARE: &str = "x,y\n0,0\n2,0\n2,2\n0,2\n1,1.5\n";

fn solved() -> Desk {
    let desk = Desk::new();
    desk.put("points.csv", SQUARE);
    desk.taut("ball points.csv --epsilon 0 -o ball.json").ends(0);
    desk
}

/// Changes the answer by a function of its JSON.
fn doctor(desk: &Desk, change: impl Fn(&mut serde_json::Value)) {
    let mut document = serde_json::from_str(&desk.text("ball.json")).unwrap();
    change(&mut document);
    desk.put("doctored.json", document.to_string());
}

#[test]
fn a_true_answer_is_proved_with_its_bracket() {
    let desk = solved();
    let run = desk.taut("verify ball.json points.csv").ends(0).says(&[
        "Verified: ball of radius 1.41421356",
        "\n  bracket   1.41421356",
        " ≤ smallest radius ≤ 1.41421356",
        "\n  gap       ",
    ]);
    assert_eq!(run.err, "");
    let quiet = desk.taut("verify ball.json points.csv --quiet").ends(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
}

#[test]
fn either_input_may_be_standard_input_but_not_both() {
    let desk = solved();
    desk.pipe(desk.text("ball.json"), "verify - points.csv").ends(0).says(&["Verified"]);
    desk.pipe(SQUARE, "verify ball.json -").ends(0).says(&["Verified"]);
    desk.pipe("", "verify - -").ends(2).complains(&["only one"]);
}

#[test]
fn changed_data_is_known_by_its_hash() {
    let desk = solved();
    desk.put("changed.csv", SQUARE.replace("1.5", "1.25"));
    desk.taut("verify ball.json changed.csv").ends(1).says(&[
        "Rejected: changed.csv",
        "hash",
        "data changed",
    ]);
}

#[test]
fn a_smaller_radius_leaves_a_point_outside() {
    let desk = solved();
    doctor(&desk, |ball| {
        let radius = &mut ball["answer"]["radius"];
        *radius = (radius.as_f64().unwrap() - 1e-9).into();
    });
    let run = desk
        .taut("verify doctored.json points.csv")
        .ends(1)
        .says(&["Rejected: points.csv: row 1 of the data: point 0 ", "outside"]);
    assert!(run.err.is_empty());
    assert_eq!(desk.taut("verify doctored.json points.csv -q").ends(1).out, "");
}

#[test]
fn a_larger_radius_breaks_the_gap_claimed() {
    let desk = solved();
    doctor(&desk, |ball| {
        let radius = &mut ball["answer"]["radius"];
        *radius = (radius.as_f64().unwrap() * 1.001).into();
    });
    desk.taut("verify doctored.json points.csv").ends(1).says(&["Rejected", "gap"]);
}

#[test]
fn another_dimension_is_rejected() {
    let desk = solved();
    desk.put("space.csv", "0,0,0\n1,1,1\n");
    desk.taut("verify ball.json space.csv").ends(1).says(&["Rejected: space.csv"]);
}

#[test]
fn what_is_no_answer_is_named() {
    let desk = solved();
    desk.put("other.json", "{\"schema\": 1, \"kind\": \"torus\"}");
    desk.taut("verify other.json points.csv").ends(2).complains(&["other.json", "torus"]);
    desk.taut("verify points.csv points.csv").ends(2).complains(&["points.csv", "not an answer"]);
    desk.taut("verify missing.json points.csv").ends(2).complains(&["missing.json"]);
    desk.put("binary.json", [0xff, 0xfe, 0x00]);
    desk.taut("verify binary.json points.csv").ends(2).complains(&["binary.json"]);
}
