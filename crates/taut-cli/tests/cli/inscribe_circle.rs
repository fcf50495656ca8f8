//! `taut inscribe circle`: found, proved, drawn; rings that are no polygon refused by row.

use crate::desk::Desk;

/// An L, whose largest circle touches the reflex corner: radius 2√2/(1 + √2).
const L: &str = "x,y\n0,0\n3,0\n3,2\n2,2\n2,3\n0,3\n";

fn desk() -> Desk {
    let desk = Desk::new();
    desk.put("ring.csv", L);
    desk
}

#[test]
fn the_largest_circle_in_an_l_touches_its_corner() {
    let desk = desk();
    desk.taut("inscribe circle ring.csv -o circle.json --draw circle.svg").ends(0).says(&[
        "Largest circle in a polygon of 6 points\n",
        "\n  radius",
        "1.17157287",
        "\n  gap",
        "no circle in the polygon has a radius above 1.17157287",
        "yes; its center is inside, no edge enters it",
        "rows 1, 3, 4, 6",
        "checking ",
    ]);
    let found: serde_json::Value = serde_json::from_str(&desk.text("circle.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-circle");
    assert_eq!(found["certificate"]["touching"], serde_json::json!([0, 2, 3, 5]));
    let picture = desk.text("circle.svg");
    for part in ["polygon of 6 points", "largest circle", "touching edges"] {
        assert!(picture.contains(part), "{part}");
    }
    desk.taut("verify circle.json ring.csv --epsilon 1.1e-9").ends(0).says(&[
        ": inscribed circle of radius 1.17157287",
        "≤ largest radius ≤",
        "proved: of circles with their center inside by the even-odd rule",
    ]);
    desk.taut("draw circle.json ring.csv -o again.svg").ends(0);
    assert_eq!(desk.text("again.svg"), picture);
}

#[test]
fn geojson_and_other_points_are_read_alike() {
    let desk = desk();
    let ring = "[[0,0],[3,0],[3,2],[2,2],[2,3],[0,3],[0,0]]";
    let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{ring}]}}");
    desk.put(
        "ring.geojson",
        format!("{{\"type\": \"Feature\", \"properties\": {{}}, \"geometry\": {polygon}}}"),
    );
    desk.taut("inscribe circle ring.geojson -o circle.json").ends(0).says(&["1.17157287"]);
    desk.taut("verify circle.json ring.geojson").ends(0);
    // The closing vertex is a row of its own.
    desk.taut("verify circle.json ring.csv").ends(1).says(&["the data changed"]);
    desk.put("holes.geojson", polygon.replace("]]]", "]], [[1,1],[1.5,1],[1,1.5],[1,1]]]"));
    desk.taut("inscribe circle holes.geojson -o holed.json --draw holed.svg").ends(0).says(&[
        "Largest circle in a polygon of 11 points",
        "no circle in the polygon has a radius above 0.767949",
    ]);
    desk.taut("verify holed.json holes.geojson").ends(0).says(&["in a polygon of 11 points"]);
    let all = desk.taut("inscribe circle ring.csv --json").ends(0).out;
    assert_eq!(desk.pipe(L, "inscribe circle - --json").ends(0).out, all);
    assert_eq!(desk.taut("inscribe circle ring.csv -o - --threads 1").ends(0).out, all);
}

#[test]
fn a_changed_answer_is_rejected_with_its_row() {
    let desk = desk();
    desk.taut("inscribe circle ring.csv -o circle.json").ends(0);
    let text = desk.text("circle.json");
    let mut found: serde_json::Value = serde_json::from_str(&text).unwrap();
    found["answer"]["radius"] = 1.2.into();
    desk.put("larger.json", found.to_string());
    desk.taut("verify larger.json ring.csv").ends(1).says(&["Rejected: ", "less than the radius"]);
    found["answer"]["radius"] = 1.0.into();
    desk.put("smaller.json", found.to_string());
    desk.taut("verify smaller.json ring.csv").ends(1).says(&["Rejected: smaller.json"]);
}

#[test]
fn rings_that_are_no_polygon_are_refused() {
    let desk = Desk::new();
    desk.put("bow.csv", "0,0\n2,2\n2,0\n0,2\n");
    desk.taut("inscribe circle bow.csv -o circle.json").ends(2).complains(&[
        "bow.csv: the edge from point 0 to point 1 meets the edge from point 2 to point 3",
    ]);
    assert_eq!(desk.files(), ["bow.csv"]);
    desk.put("two.csv", "0,0\n2,2\n0,0\n");
    desk.taut("inscribe circle two.csv").ends(2).complains(&["has 2 distinct vertices"]);
    desk.put("space.csv", "0,0,1\n2,2,1\n0,1,0\n");
    desk.taut("inscribe circle space.csv")
        .ends(2)
        .complains(&["the ring number of point 0 is 1.0: expected 0 for the first point"]);
    desk.put("four.csv", "0,0,1,1\n2,2,1,1\n0,1,0,1\n");
    desk.taut("inscribe circle four.csv")
        .ends(2)
        .complains(&["points have 4 coordinates", "--columns"]);
    desk.put("ring.csv", L);
    desk.taut("inscribe circle ring.csv --epsilon 0")
        .ends(2)
        .complains(&["option `--epsilon` is 0"]);
    desk.taut("inscribe circle ring.csv --max-cells 0").ends(2).complains(&["`--max-cells` is 0"]);
    desk.taut("inscribe circle ring.csv --max-cells 1")
        .ends(3)
        .says(&["within the budget of cells"]);
}
