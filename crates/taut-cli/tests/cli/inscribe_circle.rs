//! `taut inscribe circle`: found, proved, drawn; rings that are no polygon refused by row.

use crate::test_folder::TestFolder;

/// An L, whose largest circle touches the reflex corner: radius 2√2/(1 + √2).
const L: &str = "x,y\n0,0\n3,0\n3,2\n2,2\n2,3\n0,3\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("ring.csv", L);
    folder
}

#[test]
fn the_largest_circle_in_an_l_touches_its_corner() {
    let folder = folder();
    folder.taut("inscribe circle ring.csv -o circle.json --draw circle.svg").ends(0).stdout_has(&[
        "Largest circle in a polygon of 6 points\n",
        "\n  radius",
        "1.17157287",
        "\n  gap",
        "no circle in the polygon has a radius above 1.17157287",
        "yes; its center is inside, no edge enters it",
        "rows 1, 3, 4, 6",
        "checking ",
    ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("circle.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-circle");
    assert_eq!(found["certificate"]["touching"], serde_json::json!([0, 2, 3, 5]));
    let picture = folder.text("circle.svg");
    for part in ["polygon of 6 points", "largest circle", "touching edges"] {
        assert!(picture.contains(part), "{part}");
    }
    folder.taut("verify circle.json ring.csv --epsilon 1.1e-9").ends(0).stdout_has(&[
        ": inscribed circle of radius 1.17157287",
        "≤ largest radius ≤",
        "proved: of circles with their center inside by the even-odd rule",
    ]);
    folder.taut("draw circle.json ring.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
}

#[test]
fn one_of_many_features_is_chosen_and_verified() {
    let folder = TestFolder::new();
    let feature = |name: &str, x: u32| {
        let ring = format!("[[{x},0],[{},0],[{x},2]]", x + 2);
        format!(
            "{{\"type\": \"Feature\", \"properties\": {{\"name\": \"{name}\"}}, \"geometry\": {{\"type\": \"Polygon\", \"coordinates\": [{ring}]}}}}"
        )
    };
    let all = [feature("Kenya", 0), feature("Chile", 7)].join(",");
    folder.put(
        "world.geojson",
        format!("{{\"type\": \"FeatureCollection\", \"features\": [{all}]}}"),
    );
    folder.put("world.wkt", "POLYGON((0 0,2 0,0 2,0 0))\nPOLYGON((7 0,9 0,7 2,7 0))\n");
    folder.put(
        "world.svg",
        "<svg><path id='a' d='M0 0h2L0 2z'/><path id='b' d='M7 0h2L7 2z'/></svg>",
    );
    for (file, select) in
        [("world.geojson", "Chile"), ("world.geojson", "1"), ("world.wkt", "1"), ("world.svg", "b")]
    {
        let command = format!("inscribe circle {file} --select {select} -o circle.json");
        folder
            .taut(&command)
            .ends(0)
            .stdout_has(&["  radius         0.58578643762", "(7.58578644"]);
        folder.taut(&format!("verify circle.json {file} --select {select}")).ends(0);
        folder.taut(&format!("verify circle.json {file} --select 0")).ends(1);
        folder.taut(&format!("draw circle.json {file} --select {select} -o circle.svg")).ends(0);
    }
    folder
        .taut("inscribe circle world.geojson --select Peru")
        .ends(2)
        .stderr_has(&["\"Kenya\", \"Chile\""]);
    folder.taut("inscribe circle world.geojson").ends(2).stderr_has(&["--select"]);
    folder.put("ring.csv", "0,0\n2,0\n0,2\n");
    folder
        .taut("inscribe circle ring.csv --select 0")
        .ends(2)
        .stderr_has(&["csv files have no features"]);
}

#[test]
fn geojson_and_other_points_are_read_alike() {
    let folder = folder();
    let ring = "[[0,0],[3,0],[3,2],[2,2],[2,3],[0,3],[0,0]]";
    let polygon = format!("{{\"type\": \"Polygon\", \"coordinates\": [{ring}]}}");
    folder.put(
        "ring.geojson",
        format!("{{\"type\": \"Feature\", \"properties\": {{}}, \"geometry\": {polygon}}}"),
    );
    folder.taut("inscribe circle ring.geojson -o circle.json").ends(0).stdout_has(&["1.17157287"]);
    folder.taut("verify circle.json ring.geojson").ends(0);
    // The closing vertex is a row of its own.
    folder.taut("verify circle.json ring.csv").ends(1).stdout_has(&["the data changed"]);
    folder.put("holes.geojson", polygon.replace("]]]", "]], [[1,1],[1.5,1],[1,1.5],[1,1]]]"));
    folder.taut("inscribe circle holes.geojson -o holed.json --draw holed.svg").ends(0).stdout_has(
        &[
            "Largest circle in a polygon of 11 points",
            "no circle in the polygon has a radius above 0.767949",
        ],
    );
    folder
        .taut("verify holed.json holes.geojson")
        .ends(0)
        .stdout_has(&["in a polygon of 11 points"]);
    let all = folder.taut("inscribe circle ring.csv --json").ends(0).out;
    assert_eq!(folder.pipe(L, "inscribe circle - --json").ends(0).out, all);
    assert_eq!(folder.taut("inscribe circle ring.csv -o - --threads 1").ends(0).out, all);
}

#[test]
fn a_changed_answer_is_rejected_with_its_row() {
    let folder = folder();
    folder.taut("inscribe circle ring.csv -o circle.json").ends(0);
    let text = folder.text("circle.json");
    let mut found: serde_json::Value = serde_json::from_str(&text).unwrap();
    found["answer"]["radius"] = 1.2.into();
    folder.put("larger.json", found.to_string());
    folder
        .taut("verify larger.json ring.csv")
        .ends(1)
        .stdout_has(&["Rejected: ", "less than the radius"]);
    found["answer"]["radius"] = 1.0.into();
    folder.put("smaller.json", found.to_string());
    folder.taut("verify smaller.json ring.csv").ends(1).stdout_has(&["Rejected: smaller.json"]);
}

#[test]
fn rings_that_are_no_polygon_are_refused() {
    let folder = TestFolder::new();
    folder.put("bow.csv", "0,0\n2,2\n2,0\n0,2\n");
    folder
        .taut("inscribe circle bow.csv -o circle.json")
        .ends(2)
        .stderr_has(&["bow.csv: the edge from row 1 to row 2 meets the edge from row 3 to row 4"]);
    assert_eq!(folder.files(), ["bow.csv"]);
    folder.put("two.csv", "0,0\n2,2\n0,0\n");
    folder.taut("inscribe circle two.csv").ends(2).stderr_has(&["has 2 distinct vertices"]);
    folder.put("space.csv", "0,0,1\n2,2,1\n0,1,0\n");
    folder.taut("inscribe circle space.csv").ends(2).stderr_has(&[
        "space.csv, row 1: the number of the ring is 1: expected 0 in the first row",
    ]);
    folder.put("four.csv", "0,0,1,1\n2,2,1,1\n0,1,0,1\n");
    folder
        .taut("inscribe circle four.csv")
        .ends(2)
        .stderr_has(&["points have 4 coordinates", "--columns"]);
    folder.put("ring.csv", L);
    folder
        .taut("inscribe circle ring.csv --epsilon 0")
        .ends(2)
        .stderr_has(&["option `--epsilon` is 0"]);
    folder
        .taut("inscribe circle ring.csv --max-cells 0")
        .ends(2)
        .stderr_has(&["`--max-cells` is 0"]);
    folder
        .taut("inscribe circle ring.csv --max-cells 1")
        .ends(3)
        .stdout_has(&["within the budget of cells"]);
}
