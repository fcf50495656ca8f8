//! `taut inscribe rectangle`: found, proved, drawn; changed answers refused.

use crate::test_folder::TestFolder;

/// A square of side 4 with a hole of side 2 in its middle: a corridor of 4 by 1 is best.
const FRAME: &str = "x,y,ring\n0,0,0\n4,0,0\n4,4,0\n0,4,0\n1,1,1\n3,1,1\n3,3,1\n1,3,1\n";

#[test]
fn a_corridor_is_found_proved_and_drawn() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    folder
        .taut("inscribe rectangle frame.csv -o rectangle.json --draw rectangle.svg")
        .ends(0)
        .stdout_has(&[
            "Largest rectangle along the axes in a polygon of 8 points\n",
            "\n  area",
            "yes; it is inside, no edge enters it",
            "no rectangle along the axes in the polygon has an area above",
        ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("rectangle.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-rectangle");
    assert!((found["answer"]["area"].as_f64().unwrap() - 4.0).abs() < 1e-2);
    let picture = folder.text("rectangle.svg");
    for part in ["polygon of 8 points", "largest rectangle"] {
        assert!(picture.contains(part), "{part}");
    }
    folder.taut("verify rectangle.json frame.csv").ends(0).stdout_has(&[
        ": inscribed rectangle of area ",
        "≤ largest area ≤",
        "proved: of rectangles inside by the even-odd rule",
    ]);
    folder.taut("draw rectangle.json frame.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    let all = folder.taut("inscribe rectangle frame.csv --json").ends(0).out;
    assert_eq!(folder.pipe(FRAME, "inscribe rectangle - --json --threads 1").ends(0).out, all);
}

#[test]
fn a_rectangle_of_any_direction_is_found_proved_and_drawn() {
    let folder = TestFolder::new();
    // A rectangle of sides 5 and 10 along (3, 4) and (-4, 3).
    folder.put("ring.csv", "x,y\n0,0\n3,4\n-5,10\n-8,6\n");
    folder
        .taut("inscribe rectangle ring.csv --oriented -o found.json --draw found.svg")
        .ends(0)
        .stdout_has(&[
            "Largest rectangle of any direction in a polygon of 4 points\n",
            "degrees",
            "yes; it is inside, no edge enters it",
            "no rectangle in the polygon has an area above",
        ]);
    let mut found: serde_json::Value = serde_json::from_str(&folder.text("found.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-oriented-rectangle");
    assert!((found["answer"]["area"].as_f64().unwrap() - 50.0).abs() < 1e-6);
    assert!((found["answer"]["ratio"].as_f64().unwrap() - 0.5).abs() < 1e-6);
    assert!(folder.text("found.svg").contains("largest rectangle"));
    folder.taut("verify found.json ring.csv").ends(0).stdout_has(&[
        ": inscribed rectangle of any direction of area ",
        "proved: of rectangles of any direction inside",
    ]);
    found["answer"]["ratio"] = 0.51.into();
    folder.put("moved.json", found.to_string());
    folder.taut("verify moved.json ring.csv").ends(1).stdout_has(&["Rejected: "]);
}

#[test]
fn changed_rectangles_and_bad_input_are_refused() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    folder.taut("inscribe rectangle frame.csv -o rectangle.json").ends(0);
    let mut found: serde_json::Value =
        serde_json::from_str(&folder.text("rectangle.json")).unwrap();
    found["answer"]["high"][1] = 3.5.into();
    folder.put("moved.json", found.to_string());
    folder.taut("verify moved.json frame.csv").ends(1).stdout_has(&["Rejected: "]);
    folder.put("crossed.csv", FRAME.replace("3,3,1", "5,3,1"));
    folder.taut("inscribe rectangle crossed.csv").ends(2).stderr_has(&["meets the edge"]);
    folder
        .taut("inscribe rectangle frame.csv --epsilon 0")
        .ends(2)
        .stderr_has(&["`--epsilon` is 0"]);
    folder
        .taut("inscribe rectangle frame.csv --max-cells 1")
        .ends(3)
        .stdout_has(&["budget of cells"]);
}
