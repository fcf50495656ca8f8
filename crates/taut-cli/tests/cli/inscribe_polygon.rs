//! `taut inscribe polygon`: found, proved, drawn; changed answers refused.

use crate::test_folder::TestFolder;

/// A square of side 4 with a hole of side 2 in its middle: a corridor of 4 by 1 is best.
const FRAME: &str = "x,y,ring\n0,0,0\n4,0,0\n4,4,0\n0,4,0\n1,1,1\n3,1,1\n3,3,1\n1,3,1\n";

#[test]
fn a_corridor_is_found_proved_and_drawn() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    folder
        .taut("inscribe polygon frame.csv -o polygon.json --draw polygon.svg")
        .ends(0)
        .stdout_has(&[
            "Large convex polygon in a polygon of 8 points\n",
            "\n  area",
            "yes; it is convex and inside, no edge enters it",
            "no convex set in the polygon has an area above",
        ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("polygon.json")).unwrap();
    assert_eq!(found["kind"], "convex-polygon");
    assert!((found["answer"]["area"].as_f64().unwrap() - 4.0).abs() < 1e-6);
    let picture = folder.text("polygon.svg");
    for part in ["polygon of 8 points", "convex polygon"] {
        assert!(picture.contains(part), "{part}");
    }
    folder.taut("verify polygon.json frame.csv").ends(0).stdout_has(&[
        ": convex polygon of ",
        "≤ largest area ≤",
        "proved: of convex sets inside by the even-odd rule",
    ]);
    folder.taut("draw polygon.json frame.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    let all = folder.taut("inscribe polygon frame.csv --json").ends(0).out;
    assert_eq!(folder.pipe(FRAME, "inscribe polygon - --json --threads 1").ends(0).out, all);
}

#[test]
fn changed_polygons_and_bad_input_are_refused() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    folder.taut("inscribe polygon frame.csv -o polygon.json").ends(0);
    let mut found: serde_json::Value = serde_json::from_str(&folder.text("polygon.json")).unwrap();
    found["answer"]["vertices"][0][0] = 2.0.into();
    folder.put("moved.json", found.to_string());
    folder.taut("verify moved.json frame.csv").ends(1).stdout_has(&["Rejected: "]);
    folder.put("crossed.csv", FRAME.replace("3,3,1", "5,3,1"));
    folder.taut("inscribe polygon crossed.csv").ends(2).stderr_has(&["meets the edge"]);
    folder.taut("inscribe polygon frame.csv --epsilon 0").ends(2).stderr_has(&["`--epsilon` is 0"]);
    folder.taut("inscribe polygon frame.csv --starts 0").ends(2).stderr_has(&["`--starts` is 0"]);
}
