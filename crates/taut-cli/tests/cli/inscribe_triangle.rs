//! `taut inscribe triangle`: found, proved, drawn; holes from GeoJSON; bad rings refused by row.

use crate::test_folder::TestFolder;

/// A rectangle of 8 by 2 with a hole in its left half: half of the right half is best, and a little more.
const FRAME: &str = "x,y,ring\n0,0,0\n8,0,0\n8,2,0\n0,2,0\n1,0.5,1\n3,0.5,1\n3,1.5,1\n1,1.5,1\n";

#[test]
fn the_largest_triangle_beside_a_hole_is_proved_and_drawn() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    folder
        .taut("inscribe triangle frame.csv -o triangle.json --draw triangle.svg --epsilon 1e-4")
        .ends(0)
        .stdout_has(&[
            "Largest triangle in a polygon of 8 points\n",
            "\n  area",
            "\n  corners",
            "yes; it lies in the polygon, and the gap is proved",
            "no triangle in the polygon has an area above ",
            "of the proof",
        ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("triangle.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-triangle");
    // From the right upper corner of the hole along both walls: half of 5 by 2 at least, half of 8 by 2 at most.
    let area = found["answer"]["area"].as_f64().unwrap();
    assert!((5.0..8.0).contains(&area), "{area}");
    let picture = folder.text("triangle.svg");
    for part in ["polygon of 8 points", "largest triangle", "touching edges"] {
        assert!(picture.contains(part), "{part}");
    }
    folder.taut("verify triangle.json frame.csv --epsilon 1.1e-4").ends(0).stdout_has(&[
        ": inscribed triangle of area ",
        "≤ largest area ≤",
        "proved: of triangles inside by the even-odd rule",
    ]);
    folder.taut("draw triangle.json frame.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    // The same polygon as GeoJSON has closing vertices, which are rows of their own.
    let rings = "[[0,0],[8,0],[8,2],[0,2],[0,0]], [[1,0.5],[3,0.5],[3,1.5],[1,1.5],[1,0.5]]";
    folder.put("frame.geojson", format!("{{\"type\": \"Polygon\", \"coordinates\": [{rings}]}}"));
    folder.taut("inscribe triangle frame.geojson -o other.json").ends(0);
    folder.taut("verify other.json frame.geojson").ends(0);
    folder.taut("verify other.json frame.csv").ends(1).stdout_has(&["the data changed"]);
}

#[test]
fn changed_triangles_and_bad_polygons_are_refused() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    let all = folder.taut("inscribe triangle frame.csv --json").ends(0).out;
    assert_eq!(folder.pipe(FRAME, "inscribe triangle - --json --threads 1").ends(0).out, all);
    folder.taut("inscribe triangle frame.csv -o triangle.json").ends(0);
    let text = folder.text("triangle.json");
    let mut found: serde_json::Value = serde_json::from_str(&text).unwrap();
    found["answer"]["corners"][0][0] = 9.0.into();
    folder.put("moved.json", found.to_string());
    folder.taut("verify moved.json frame.csv").ends(1).stdout_has(&["Rejected: "]);
    folder.put("bad.csv", FRAME.replace("1,0.5,1", "1,0.5,2"));
    folder
        .taut("inscribe triangle bad.csv")
        .ends(2)
        .stderr_has(&["bad.csv", "bad.csv, row 5: the number of the ring is 2"]);
    folder.put("crossed.csv", FRAME.replace("3,1.5,1", "9,1.5,1"));
    folder.taut("inscribe triangle crossed.csv").ends(2).stderr_has(&["meets the edge"]);
    folder
        .taut("inscribe triangle frame.csv --epsilon 0")
        .ends(2)
        .stderr_has(&["`--epsilon` is 0"]);
    folder
        .taut("inscribe triangle frame.csv --max-cells 1")
        .ends(3)
        .stdout_has(&["within the budget of cells"]);
}

#[test]
fn the_method_of_the_thesis_is_proved_with_its_gap() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    folder
        .taut("inscribe triangle frame.csv --method thesis --sample-count 100 -o sampled.json")
        .ends(0)
        .stdout_has(&["Large triangle in a polygon of 8 points\n", "\n  method", "thesis"]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("sampled.json")).unwrap();
    assert!(found["certificate"]["gap"].as_f64().unwrap() > 1e-3);
    folder.taut("verify sampled.json frame.csv").ends(0).stdout_has(&["≤ largest area ≤"]);
    folder
        .taut("inscribe triangle frame.csv --method thesis --sample-count 2")
        .ends(2)
        .stderr_has(&["sample-count"]);
    folder.taut("inscribe triangle frame.csv --method guess").ends(2);
}
