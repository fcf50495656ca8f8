//! `taut curve`: the summary, the files, what is refused, and how runs end.

use serde_json::Value;

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

/// Points of circles, each with a center, a radius and a number.
fn circles(list: &[([f64; 2], f64, usize)]) -> String {
    let mut text = String::from("x,y\n");
    for &([x, y], r, n) in list {
        for i in 0..n {
            let t = std::f64::consts::TAU * i as f64 / n as f64;
            text += &format!("{},{}\n", x + r * t.cos(), y + r * t.sin());
        }
    }
    text
}

/// An island with two lakes, one of which has an islet, and an island beside it.
fn islands() -> String {
    circles(&[
        ([0.0, 0.0], 8.0, 160),
        ([-4.0, 0.0], 2.0, 80),
        ([3.0, 0.0], 3.0, 90),
        ([3.0, 0.0], 1.0, 60),
        ([20.0, 0.0], 4.0, 100),
    ])
}

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("islands.csv", islands());
    folder
}

fn document(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn the_summary_names_every_number() {
    let run = folder().taut("curve islands.csv --method hnn-crust").ends(0).stdout_has(&[
        "490 points in the plane: 5 curves\n",
        "\n  curves    5; 5 closed, 0 open\n",
        "\n  vertices  490; each is a point of the input\n",
        "\n  band      0; no point is farther from the curves\n",
        "\n  certified yes; evidence: sampled at ε ≤ 0.",
        "\n  verified  yes; no two edges meet, and the band holds\n",
        "\n  method    hnn-crust\n",
        "s; reading ",
        ", checking ",
    ]);
    assert_eq!(run.err, "");
}

#[test]
fn the_json_is_one_document_with_the_names_at_the_door() {
    let folder = folder();
    let line = "curve islands.csv --method nn-crust --places";
    let run = folder.taut(&format!("{line} --json -o curve.json")).ends(0);
    let found = run.json();
    assert_eq!(found["kind"], "curve");
    let curves = found["answer"]["curves"].as_array().unwrap();
    assert_eq!(curves.len(), 5);
    for curve in curves {
        assert_eq!(curve["closed"], true);
        assert_eq!(
            curve["vertices"].as_array().unwrap().len(),
            curve["rows"].as_array().unwrap().len()
        );
    }
    assert_eq!(found["answer"]["noise"], 0.0);
    assert_eq!(found["answer"]["places"].as_array().unwrap().len(), 490);
    assert_eq!(folder.text("curve.json"), run.out);
    for option in ["-o -", "--json --threads 1", "--json --threads 3"] {
        assert_eq!(folder.taut(&format!("{line} {option}")).ends(0).out, run.out, "{option}");
    }
    let quiet = folder.taut(&format!("{line} --quiet -o quiet.json")).ends(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
    assert_eq!(folder.text("quiet.json"), run.out);
    let run = folder.taut("curve islands.csv --method nn-crust --no-verify").ends(0);
    assert!(run.out.contains("not checked"), "{}", run.out);
}

#[test]
fn answers_are_verified_and_lies_rejected() {
    let folder = folder();
    folder.taut("curve islands.csv --method nn-crust -o curve.json").ends(0);
    folder.taut("verify curve.json islands.csv").ends(0).stdout_has(&[
        "Verified: 5 curves through ",
        "\n  band      0; proved: no point is farther off\n",
        "\n  simple    yes; proved: no two edges meet, by exact predicates\n",
        "\n  certified yes; evidence: sampled at ε ≤ 0.",
    ]);
    let sound = document(&folder.text("curve.json"));
    let lie = |change: &dyn Fn(&mut Value)| {
        let mut found = sound.clone();
        change(&mut found);
        folder.put("lie.json", found.to_string());
        folder.taut("verify lie.json islands.csv").ends(1).stdout_has(&["Rejected: "]);
    };
    lie(&|found| found["answer"]["curves"][0]["vertices"][0][0] = 0.25.into());
    lie(&|found| {
        let vertices = found["answer"]["curves"][1]["vertices"].as_array_mut().unwrap();
        vertices.swap(3, 20);
        let rows = found["answer"]["curves"][1]["rows"].as_array_mut().unwrap();
        rows.swap(3, 20);
    });
    lie(&|found| {
        found["answer"]["curves"].as_array_mut().unwrap().pop();
    });
    lie(&|found| found["answer"]["outliers"] = serde_json::json!([0]));
    lie(&|found| found["certificate"]["sampling_ratio"] = 1e-6.into());
    let mut open = sound.clone();
    open["answer"]["curves"][0]["closed"] = false.into();
    folder.put("lie.json", open.to_string());
    folder
        .taut("verify lie.json islands.csv")
        .ends(1)
        .stdout_has(&["Rejected: lie.json: the sampling ratio"]);
    folder.put("other.csv", islands() + "9,9\n");
    folder.taut("verify curve.json other.csv").ends(1).stdout_has(&["Rejected: other.csv", "hash"]);
    folder.put("space.csv", "0,0,0\n1,1,1\n");
    folder
        .taut("verify curve.json space.csv")
        .ends(1)
        .stdout_has(&["space.csv does not belong to"]);
}

/// Half a circle has ends, so nothing can be certified, which is no failure.
#[test]
fn what_is_not_certified_says_why() {
    let folder = TestFolder::new();
    let mut half = String::new();
    for i in 0..=60 {
        let t = std::f64::consts::PI * f64::from(i) / 60.0;
        half += &format!("{},{}\n", t.cos(), t.sin());
    }
    folder.put("half.csv", half);
    for ends in ["", " --open"] {
        folder
            .taut(&format!("curve half.csv --method nn-crust{ends} -o half.json"))
            .ends(0)
            .stdout_has(&[
                "\n  curves    1; open\n",
                "\n  certified no; evidence: curve 0 has ends, which may be those of a gap; all counted from 0\n",
            ]);
        folder
            .taut("verify half.json half.csv")
            .ends(0)
            .stdout_has(&["certified no; evidence: curve 0 has ends"]);
    }
}

#[test]
fn tours_come_with_a_bound() {
    let folder = folder();
    folder.taut("curve islands.csv --method tour -o tour.json").ends(0).stdout_has(&[
        "490 points in the plane: a tour\n",
        "\n  tour gap  ",
        "length over its lower bound, less 1\n",
    ]);
    folder
        .taut("verify tour.json islands.csv --epsilon 0.1")
        .ends(0)
        .stdout_has(&[": a tour through 490 points in the plane\n"]);
    folder.taut("verify tour.json islands.csv --epsilon 1e-9").ends(1).stdout_has(&["a gap of "]);
    folder
        .taut("curve islands.csv --method tour --open")
        .ends(0)
        .stdout_has(&["in the plane: a path\n"]);
}

#[test]
fn geojson_has_holes_and_turns_by_the_right_hand_rule() {
    let folder = folder();
    folder.taut("curve islands.csv --method hnn-crust -o islands.geojson").ends(0);
    let found = document(&folder.text("islands.geojson"));
    assert_eq!(found["type"], "FeatureCollection");
    let features = found["features"].as_array().unwrap();
    let mut rings_of: Vec<usize> = Vec::new();
    for feature in features {
        assert_eq!(feature["geometry"]["type"], "Polygon");
        let rings = feature["geometry"]["coordinates"].as_array().unwrap();
        assert_eq!(feature["properties"]["curves"].as_array().unwrap().len(), rings.len());
        for (place, ring) in rings.iter().enumerate() {
            let ring: Vec<[f64; 2]> = serde_json::from_value(ring.clone()).unwrap();
            assert_eq!(ring.first(), ring.last());
            let area: f64 = ring.windows(2).map(|w| w[0][0] * w[1][1] - w[1][0] * w[0][1]).sum();
            assert_eq!(area > 0.0, place == 0, "ring {place} turns the wrong way");
        }
        rings_of.push(rings.len());
    }
    rings_of.sort_unstable();
    // The island with its lakes, the islet in one of them, and the other island.
    assert_eq!(rings_of, [1, 1, 3]);
}

/// The vertices in the csv and in the path are those of the JSON, to the last bit.
#[test]
fn files_of_curves_hold_the_vertices() {
    let folder = folder();
    folder.put("line.csv", "0,0.1\n1,0.2\n2,1e-7\n3,0.1\n");
    for (points, method) in [("islands.csv", "nn-crust"), ("line.csv", "nn-crust")] {
        let line = format!("curve {points} --method {method}");
        folder.taut(&format!("{line} -o a.json --path a.svg")).ends(0);
        folder.taut(&format!("{line} -o a.csv")).ends(0);
        folder.taut(&format!("{line} -o a.csv.gz")).ends(0);
        let found = document(&folder.text("a.json"));
        let mut rows: Vec<[f64; 4]> = Vec::new();
        for (number, curve) in found["answer"]["curves"].as_array().unwrap().iter().enumerate() {
            let closed = f64::from(u8::from(curve["closed"] == true));
            for at in curve["vertices"].as_array().unwrap() {
                let [x, y] = [0, 1].map(|k| at[k].as_f64().unwrap());
                rows.push([number as f64, closed, x, y]);
            }
        }
        let numbers: Vec<f64> = rows.iter().flat_map(|&[_, _, x, y]| [x, y]).collect();
        let text = folder.text("a.csv");
        assert_eq!(text.lines().next(), Some("curve,closed,x,y"));
        let parsed =
            |line: &str| -> Vec<f64> { line.split(',').map(|x| x.parse().unwrap()).collect() };
        let read: Vec<Vec<f64>> = text.lines().skip(1).map(parsed).collect();
        assert_eq!(read, rows);
        assert!(folder.bytes("a.csv.gz").starts_with(&[0x1f, 0x8b]));
        let svg = folder.text("a.svg");
        let path = svg.split(" d=\"").nth(1).unwrap().split('"').next().unwrap();
        let drawn: Vec<f64> = path
            .split(|c: char| c.is_whitespace() || "MLZ".contains(c))
            .filter(|word| !word.is_empty())
            .map(|word| word.parse().unwrap())
            .collect();
        assert_eq!(drawn, numbers);
        let closed = found["answer"]["curves"].as_array().unwrap().iter();
        let closed = closed.filter(|curve| curve["closed"] == true).count();
        assert_eq!(path.matches('Z').count(), closed);
    }
    folder.taut("curve line.csv --method nn-crust -o line.geojson").ends(0);
    assert!(folder.text("line.geojson").contains("\"LineString\""));
    // Curves are points again.
    folder.taut("ball a.csv --columns x,y").ends(0);
}

#[test]
fn pictures_are_drawn_now_and_later() {
    let folder = folder();
    folder.taut("curve islands.csv --method corners -o a.json --draw a.svg").ends(0);
    folder.taut("draw a.json islands.csv -o b.svg").ends(0);
    assert_eq!(folder.text("a.svg"), folder.text("b.svg"));
    assert!(folder.text("a.svg").contains("5 closed curves"));
    folder.taut("draw a.json islands.csv -o b.html").ends(0);
    assert!(folder.text("b.html").contains("curves"));
}

#[test]
fn few_points_are_no_error() {
    let folder = TestFolder::new();
    for (name, points) in [
        ("one.csv", "1,2\n"),
        ("copies.csv", "1,2\n1,2\n1,2\n"),
        ("two.csv", "0,0\n1,0\n"),
        ("three.csv", "0,0\n1,0\n0,1\n"),
        ("line.csv", "0,0\n3,3\n1,1\n2,2\n"),
        ("far.csv", "0,0\n1e150,0\n0,1e150\n1e150,1e150\n"),
    ] {
        folder.put(name, points);
        for (at, method) in [
            "auto",
            "crust",
            "one-step-crust",
            "nn-crust",
            "conservative-crust",
            "hnn-crust",
            "corners",
            "tour",
        ]
        .into_iter()
        .enumerate()
        .step_by(long_or(1, 2))
        {
            let out = format!("out.{}", ["json", "csv", "geojson"][(at + points.len()) % 3]);
            let outputs = format!("-o {out} --path path.svg --draw p.svg");
            folder.taut(&format!("curve {name} --method {method} {outputs}")).ends(0);
        }
    }
}

#[test]
fn what_is_wrong_is_named() {
    let folder = folder();
    folder.put("nan.csv", "x,y\n0,0\n1,nan\n");
    folder.put("space.csv", "0,0,0\n1,1,1\n");
    folder.put("one.csv", "0\n1\n");
    folder.put("none.csv", "x,y\n");
    for (line, parts) in [
        ("curve nan.csv", &["nan.csv: row 2 (line 3), column 1 (`y`)", "must be finite"][..]),
        ("curve space.csv", &["space.csv: points have 3 coordinates: expected 2", "--columns"]),
        ("curve one.csv", &["one.csv: points have 1 coordinate: expected 2"]),
        ("curve none.csv", &["none.csv"]),
        ("curve missing.csv", &["missing.csv: no such file"]),
        (
            "curve islands.csv --method thesis --rho 0.5",
            &["option `--rho` is 0.5: expected a number of at least 1"],
        ),
        (
            "curve islands.csv --method thesis-crude --omega 0",
            &["option `--omega` is 0: expected a number above 0"],
        ),
        ("curve islands.csv --method thesis --omega=-inf", &["option `--omega` is -inf"]),
        (
            "curve islands.csv --feature 1",
            &["--feature is of --method thesis and thesis-crude, not of auto"],
        ),
        ("curve islands.csv -o a.svg", &["a.svg", "--draw a.svg", "--path a.svg"]),
        ("curve islands.csv -o a.png", &["a.png", "--draw a.png"]),
        ("curve islands.csv -o a.ply", &["a.ply: -o writes .json, .csv or .geojson"]),
        ("curve islands.csv --path a.csv", &["a.csv: --path writes SVG"]),
        ("curve islands.csv -o islands.csv", &["islands.csv` is the input"]),
        ("curve islands.csv --draw a.svg --path a.svg", &["named for two outputs"]),
        ("curve islands.csv -o nowhere/a.json", &["nowhere/a.json"]),
    ] {
        let before = folder.files();
        folder.taut(line).ends(2).stderr_has(parts);
        assert_eq!(folder.files(), before, "{line}");
    }
    let run = folder.taut("curve islands.csv --method splines").ends(2);
    assert!(run.err.contains("splines") && run.err.contains("hnn-crust"), "{}", run.err);
    let run = folder.taut("curve").ends(2);
    assert!(run.err.contains("POINTS"), "{}", run.err);
}

#[test]
fn threads_and_the_order_of_rows_change_nothing() {
    let folder = folder();
    let mut rows: Vec<String> = islands().lines().skip(1).map(str::to_owned).collect();
    rows.reverse();
    rows.rotate_left(123);
    folder.put("other.csv", format!("x,y\n{}\n", rows.join("\n")));
    for method in ["hnn-crust", "corners", "tour"].into_iter().step_by(long_or(1, 2)) {
        let write = |input: &str, threads: usize| {
            folder
                .taut(&format!("curve {input} --method {method} --threads {threads} -o a.csv"))
                .ends(0);
            folder.text("a.csv")
        };
        let one = write("islands.csv", 1);
        assert_eq!(write("islands.csv", 3), one, "{method}");
        assert_eq!(write("other.csv", 2), one, "{method}");
    }
}

/// The sample of the tour: three loops, two of them within the third, and an open wave, with noise.
#[test]
fn the_sample_has_four_curves() {
    let folder = TestFolder::new();
    folder.put("loops.csv", include_bytes!("../../samples/loops.csv"));
    folder.taut("curve loops.csv -o loops.json --draw loops.html").ends(0).stdout_has(&[
        "1068 points in the plane: 4 curves\n",
        "\n  curves    4; 3 closed, 1 open\n",
        "half the width of its band, as estimated\n",
    ]);
    folder.taut("verify loops.json loops.csv").ends(0).stdout_has(&["Verified: 4 curves through "]);
    folder.taut("curve loops.csv -o loops.geojson").ends(0);
    let found = document(&folder.text("loops.geojson"));
    let kinds: Vec<(&str, usize)> = found["features"]
        .as_array()
        .unwrap()
        .iter()
        .map(|feature| {
            let geometry = &feature["geometry"];
            let parts = geometry["coordinates"].as_array().unwrap().len();
            let kind = geometry["type"].as_str().unwrap();
            (kind, if kind == "Polygon" { parts } else { 0 })
        })
        .collect();
    assert_eq!(kinds.len(), 2, "{kinds:?}");
    assert!(kinds.contains(&("Polygon", 3)) && kinds.contains(&("LineString", 0)), "{kinds:?}");
}
