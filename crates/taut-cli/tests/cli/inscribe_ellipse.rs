//! `taut inscribe ellipse`: found, proved, drawn; holes from GeoJSON; bad rings refused by row.

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

/// A square of side 4 with a hole of side 2 in its middle: the best ellipse fills a corridor of 4 by 1, π.
const FRAME: &str = "x,y,ring\n0,0,0\n4,0,0\n4,4,0\n0,4,0\n1,1,1\n3,1,1\n3,3,1\n1,3,1\n";

#[test]
fn the_largest_ellipse_beside_a_hole_fills_a_corridor() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    folder
        .taut("inscribe ellipse frame.csv -o ellipse.json --draw ellipse.svg --epsilon 1e-6")
        .ends(0)
        .stdout_has(&[
            "Largest ellipse in a polygon of 8 points\n",
            "\n  area",
            "3.14159",
            "\n  semi-axes",
            "yes; its center is inside, no edge enters it",
            "no ellipse in the polygon has an area above 3.14159",
            "of the proof",
        ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("ellipse.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-ellipse");
    let picture = folder.text("ellipse.svg");
    for part in ["polygon of 8 points", "largest ellipse", "touching edges"] {
        assert!(picture.contains(part), "{part}");
    }
    folder.taut("verify ellipse.json frame.csv --epsilon 1.1e-6").ends(0).stdout_has(&[
        ": inscribed ellipse of area 3.14159",
        "≤ largest area ≤",
        "proved: of ellipses with their center inside by the even-odd rule",
    ]);
    folder.taut("draw ellipse.json frame.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    // The same polygon as GeoJSON has closing vertices, which are rows of their own.
    let rings = "[[0,0],[4,0],[4,4],[0,4],[0,0]], [[1,1],[3,1],[3,3],[1,3],[1,1]]";
    folder.put("frame.geojson", format!("{{\"type\": \"Polygon\", \"coordinates\": [{rings}]}}"));
    folder.taut("inscribe ellipse frame.geojson -o other.json").ends(0).stdout_has(&["3.14"]);
    folder.taut("verify other.json frame.geojson").ends(0);
    folder.taut("verify other.json frame.csv").ends(1).stdout_has(&["the data changed"]);
}

#[test]
fn changed_ellipses_and_bad_polygons_are_refused() {
    let folder = TestFolder::new();
    folder.put("frame.csv", FRAME);
    let all = folder.taut("inscribe ellipse frame.csv --json").ends(0).out;
    assert_eq!(folder.pipe(FRAME, "inscribe ellipse - --json --threads 1").ends(0).out, all);
    folder.taut("inscribe ellipse frame.csv -o ellipse.json").ends(0);
    let text = folder.text("ellipse.json");
    let mut found: serde_json::Value = serde_json::from_str(&text).unwrap();
    found["answer"]["center"] = [1.0, 1.0].as_slice().into();
    folder.put("moved.json", found.to_string());
    folder.taut("verify moved.json frame.csv").ends(1).stdout_has(&["Rejected: "]);
    folder.put("bad.csv", FRAME.replace("1,1,1", "1,1,2"));
    folder
        .taut("inscribe ellipse bad.csv")
        .ends(2)
        .stderr_has(&["bad.csv", "bad.csv, row 5: the number of the ring is 2"]);
    folder.put("crossed.csv", FRAME.replace("3,3,1", "5,3,1"));
    folder.taut("inscribe ellipse crossed.csv").ends(2).stderr_has(&["meets the edge"]);
    folder.taut("inscribe ellipse frame.csv --epsilon 0").ends(2).stderr_has(&["`--epsilon` is 0"]);
    folder
        .taut("inscribe ellipse frame.csv --max-cells 1")
        .ends(3)
        .stdout_has(&["within the budget of cells"]);
}

#[test]
fn samples_of_a_curve_are_joined_and_have_an_ellipse_by_either_method() {
    let folder = TestFolder::new();
    // Samples of an ellipse with the semi-axes 3 and 2, not in order: seven and sixty have no common factor.
    let sample = |i: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * (7 * i % 60) as f64 / 60.0).sin_cos();
        format!("{},{}\n", 3.0 * cosine, 2.0 * sine)
    };
    folder.put("points.csv", (0..60).map(sample).collect::<String>());
    folder.taut("curve points.csv -o ring.geojson").ends(0);
    let area = |name: &str| {
        folder.taut(&format!("verify {name} ring.geojson")).ends(0);
        let found: serde_json::Value = serde_json::from_str(&folder.text(name)).unwrap();
        found["answer"]["area"].as_f64().unwrap()
    };
    folder.taut("inscribe ellipse ring.geojson -o largest.json").ends(0);
    folder
        .taut("inscribe ellipse ring.geojson --method five-point --sample-count 60 -o five.json")
        .ends(0)
        .stdout_has(&["Large ellipse in a polygon of ", "five-point"]);
    let (largest, five) = (area("largest.json"), area("five.json"));
    // The polygon between the samples has the ellipse scaled by cos(π/60) inside, and is in the ellipse itself.
    let whole = 6.0 * std::f64::consts::PI;
    let chord = (std::f64::consts::PI / 60.0).cos();
    assert!(largest <= whole && largest * 1.001 >= whole * chord * chord, "{largest}");
    assert!(five <= largest * 1.001 && five >= 0.95 * largest, "{five} for {largest}");
    folder
        .taut("inscribe ellipse ring.geojson --method five-point --sample-count 5")
        .ends(2)
        .stderr_has(&["sample-count"]);
}

#[test]
fn samples_without_edges_are_joined_for_every_shape() {
    let folder = TestFolder::new();
    // Samples of an ellipse with semi-axes 3 and 2, in no order.
    let (n, share) = long_or((120, 0.998), (40, 0.993));
    let point = |i: usize| {
        let angle = std::f64::consts::TAU * ((i * 37) % n) as f64 / n as f64;
        format!("{:?},{:?}\n", 3.0 * angle.cos(), 2.0 * angle.sin())
    };
    folder.put("points.csv", (0..n).map(point).collect::<String>());
    // What the polygon between the samples leaves of the area 6π, or of the circle of radius 2, is at least cos²(π/n).
    let pi = std::f64::consts::PI;
    for (shape, least) in [
        ("circle", 0.0),
        ("ellipse", 6.0 * pi * share),
        ("polygon", 6.0 * pi * 0.9),
        ("rectangle", 12.0 * 0.99),
        ("rectangle --oriented", 12.0 * 0.99),
        ("triangle", 6.0 * 0.75 * 3f64.sqrt() * 0.99),
    ] {
        folder
            .taut(&format!("inscribe {shape} points.csv --samples --ring ring.csv -o found.json"))
            .ends(0);
        folder.taut("verify found.json ring.csv").ends(0);
        let found: serde_json::Value = serde_json::from_str(&folder.text("found.json")).unwrap();
        match found["answer"]["radius"].as_f64() {
            Some(radius) => assert!(radius > 1.99 && radius <= 2.0, "{radius}"),
            None => {
                let area = found["answer"]["area"].as_f64().unwrap();
                assert!(area >= least && area <= 6.0 * pi, "{shape}: {area}, {least}");
            }
        }
    }
    assert!(folder.text("ring.csv").starts_with("x,y,ring\n"));
    let wave = |i: i32| format!("{:?},{:?}\n", 0.1 * f64::from(i), (0.1 * f64::from(i)).sin());
    folder.put("open.csv", (0..100).map(wave).collect::<String>());
    folder
        .taut("inscribe triangle open.csv --samples --ring open_ring.csv -o found.json")
        .ends(2)
        .stderr_has(&["a curve with ends"]);
    folder.taut("inscribe triangle points.csv --ring ring.csv").ends(2);
    folder
        .taut("inscribe triangle points.csv --samples -o found.json")
        .ends(2)
        .stderr_has(&["--ring"]);
}
