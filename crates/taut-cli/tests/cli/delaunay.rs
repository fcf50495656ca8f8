//! `taut delaunay`: the summary, every kind of file, and `taut verify` and `taut draw` of what it wrote.

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

/// A square with its center, and its first corner again.
const SQUARE: &str = "x,y\n0,0\n2,0\n2,2\n0,2\n1,1\n0,0\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("points.csv", SQUARE);
    folder
}

#[test]
fn the_summary_names_every_number() {
    let folder = folder();
    let run = folder.taut("delaunay points.csv").ends(0).stdout_has(&[
        "Delaunay triangulation of 6 points in the plane\n",
        "\n  sites       5; 1 point equals an earlier one\n",
        "\n  simplices   4 triangles\n",
        "\n  hull        4 edges\n",
        "\n  dimension   2; the points span all dimensions\n",
        "\n  verified    yes; the only one, with ",
        "\n  fingerprint ",
        "checking ",
    ]);
    assert_eq!(run.err, "");
    assert_eq!(folder.files(), ["points.csv"]);
    let quiet = folder.taut("delaunay points.csv -q").ends(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
    folder
        .taut("delaunay points.csv --no-verify")
        .ends(0)
        .stdout_has(&["verified    not checked\n"]);
}

#[test]
fn the_json_has_the_names_at_the_door() {
    let folder = folder();
    let run = folder.taut("delaunay points.csv --json -o mesh.json").ends(0);
    let document = run.json();
    assert_eq!(document["kind"], "delaunay");
    let answer = &document["answer"];
    assert_eq!(answer["duplicates"], serde_json::json!([[5, 0]]));
    assert_eq!(answer["simplices"].as_array().unwrap().len(), 4);
    assert_eq!(answer["hull"].as_array().unwrap().len(), 4);
    assert_eq!(folder.text("mesh.json"), run.out);
    assert_eq!(folder.taut("delaunay points.csv -o -").ends(0).out, run.out);
    folder.taut("verify mesh.json points.csv").ends(0).stdout_has(&[
        "Verified: the Delaunay triangulation of 6 points in the plane\n",
        "\n  sites       5; proved: distinct points\n",
    ]);
    folder.taut("delaunay points.csv -o short.json --no-neighbors").ends(0);
    assert!(folder.bytes("short.json").len() < folder.bytes("mesh.json").len());
    folder.taut("verify short.json points.csv").ends(0);
}

#[test]
fn every_format_of_meshes_is_written_and_verified() {
    let folder = TestFolder::new();
    folder.put("points.csv", SQUARE);
    folder.taut("generate normal -n 300 -d 3 -o space.npy").ends(0);
    let built = |name: &str| cfg!(feature = "arrow") || name != "parquet";
    for name in ["ply", "obj", "off", "vtu", "parquet", "ply.gz"] {
        if built(name) {
            folder.taut(&format!("delaunay points.csv -o mesh.{name}")).ends(0);
            folder
                .taut(&format!("verify mesh.{name} points.csv"))
                .ends(0)
                .stdout_has(&["Verified", "5; proved: distinct"]);
        }
    }
    for name in ["ply", "vtu", "parquet"] {
        if built(name) {
            folder.taut(&format!("delaunay space.npy -o mesh.{name} --hull hull.obj")).ends(0);
            folder.taut(&format!("verify mesh.{name} space.npy")).ends(0).stdout_has(&["in space"]);
        }
    }
    assert!(folder.text("hull.obj").starts_with("# 300 vertices, "));
    folder.taut("delaunay space.npy -o mesh.off").ends(2).stderr_has(&[
        "mesh.off",
        "hold no tetrahedra",
        "ply, vtu",
    ]);
    folder.taut("delaunay points.csv -o mesh.svg").ends(2).stderr_has(&["--draw mesh.svg"]);
    folder.taut("delaunay points.csv -o mesh.stl").ends(2).stderr_has(&["mesh.stl", ".ply"]);
    folder.taut("delaunay points.csv --hull hull.json").ends(2).stderr_has(&["hull.json"]);
    folder.taut("delaunay points.csv --voronoi cells.ply").ends(2).stderr_has(&[".geojson"]);
}

#[test]
fn wrong_meshes_are_rejected_and_broken_ones_refused() {
    let folder = folder();
    folder.taut("delaunay points.csv -o mesh.off").ends(0);
    let mesh = folder.text("mesh.off");
    // Both diagonals of the square go through its center, so a triangle of three corners covers it.
    let last = mesh.lines().last().unwrap();
    folder.put("wrong.off", mesh.replace(last, "3 0 1 2"));
    folder.taut("verify wrong.off points.csv").ends(1).stdout_has(&["Rejected: wrong.off: "]);
    folder.put("moved.csv", SQUARE.replace("1,1", "1,1.5"));
    folder.taut("verify mesh.off moved.csv").ends(1).stdout_has(&[
        "Rejected: moved.csv does not belong to mesh.off: vertex 4 is another than point 4",
    ]);
    folder.put("fewer.csv", "0,0\n2,0\n2,2\n");
    folder
        .taut("verify mesh.off fewer.csv")
        .ends(1)
        .stdout_has(&["there are 3 points, but 6 vertices"]);
    folder.put("cut.off", &mesh[..mesh.len() - 3]);
    folder.taut("verify cut.off points.csv").ends(2).stderr_has(&["cut.off", "line "]);
    folder.put("nan.csv", SQUARE.replace("1,1", "1,NaN"));
    folder.taut("verify mesh.off nan.csv").ends(2).stderr_has(&["nan.csv", "row 5", "NaN"]);
    folder
        .taut("verify missing.ply points.csv")
        .ends(2)
        .stderr_has(&["missing.ply", "no such file"]);
}

#[test]
fn doctored_json_is_rejected() {
    let folder = folder();
    folder.taut("delaunay points.csv -o mesh.json").ends(0);
    for (place, value) in [
        ("/answer/simplices/0/0", serde_json::json!(5)),
        ("/answer/hull", serde_json::json!([[0, 1]])),
        ("/answer/duplicates", serde_json::json!([])),
        ("/answer/hull_dimension", serde_json::json!(null)),
        ("/certificate/neighbors/0/0", serde_json::json!(0)),
        ("/certificate/counts/hull", serde_json::json!(5)),
        ("/certificate/fingerprint", serde_json::json!("0".repeat(32))),
    ] {
        let mut document: serde_json::Value =
            serde_json::from_str(&folder.text("mesh.json")).unwrap();
        *document.pointer_mut(place).unwrap() = value;
        folder.put("doctored.json", document.to_string());
        let run = folder.taut("verify doctored.json points.csv");
        // Rows that do not fit the dimension are no answer at all.
        let code = if place.ends_with("dimension") { 2 } else { 1 };
        run.ends(code);
    }
    folder.put("changed.csv", SQUARE.replace("1,1", "1,1.25"));
    folder
        .taut("verify mesh.json changed.csv")
        .ends(1)
        .stdout_has(&["does not belong to mesh.json", "hash"]);
}

#[test]
fn flat_points_are_an_answer() {
    let folder = TestFolder::new();
    for (points, sites, said) in [
        ("1,1\n1,1\n", 1, ["simplices   1 point\n", "all points are equal\n"]),
        (
            "0,0\n2,2\n1,1\n",
            3,
            ["simplices   2 edges\n", "dimension   1; all points are on a line\n"],
        ),
        (
            "0,0,1\n2,0,1\n0,2,1\n",
            3,
            ["simplices   1 triangle\n", "dimension   2; all points are on a plane\n"],
        ),
        (
            "0,0,0\n1,1,1\n",
            2,
            ["simplices   1 edge\n", "dimension   1; all points are on a line\n"],
        ),
    ] {
        let sites = format!("\n  sites       {sites}; proved: distinct points\n");
        folder.put("flat.csv", points);
        folder
            .taut("delaunay flat.csv -o flat.json --draw flat.svg")
            .ends(0)
            .stdout_has(&said)
            .stdout_has(&["verified    yes"]);
        folder.taut("verify flat.json flat.csv").ends(0);
        for mesh in ["flat.vtu", "flat.ply", "flat.obj", "flat.off"] {
            folder.taut(&format!("delaunay flat.csv -o {mesh}")).ends(0);
            folder
                .taut(&format!("verify {mesh} flat.csv"))
                .ends(0)
                .stdout_has(&["Verified", &sites]);
        }
    }
    folder.put("line.csv", "0,0\n2,2\n1,1\n");
    folder.put("over.off", "OFF\n3 2 0\n0 0 0\n2 2 0\n1 1 0\n2 0 1\n2 2 1\n");
    folder.taut("verify over.off line.csv").ends(1).stdout_has(&["Rejected: over.off: "]);
    folder.put("flat.csv", "1,1\n1,1\n");
    folder.taut("delaunay flat.csv --hull hull.ply").ends(2).stderr_has(&["all points are equal"]);
}

#[test]
fn bad_input_is_named() {
    let folder = TestFolder::new();
    folder.put("nan.csv", "x,y\n0,0\n1,inf\n");
    folder.taut("delaunay nan.csv").ends(2).stderr_has(&["nan.csv", "row 2", "`y`", "inf"]);
    folder.put("nan.f64", [0.0, 1.0, 2.0, f64::NAN].map(f64::to_le_bytes).concat());
    folder.taut("delaunay nan.f64 --raw-dim 2 --raw-type f64").ends(2).stderr_has(&[
        "nan.f64",
        "row 2",
        "column 1",
        "--columns",
    ]);
    folder.taut("generate normal -n 10 -d 4 -o four.csv").ends(0);
    folder.taut("delaunay four.csv").ends(2).stderr_has(&[
        "four.csv",
        "4 coordinates",
        "--columns",
    ]);
    folder.taut("delaunay four.csv --columns 0,2").ends(0);
    folder.put("line.csv", "0\n1\n");
    folder
        .taut("delaunay line.csv")
        .ends(2)
        .stderr_has(&["1 coordinate: expected 2, the plane, or 3, space"]);
    folder.put("empty.csv", "");
    folder.taut("delaunay empty.csv -o mesh.json").ends(2).stderr_has(&["empty.csv is empty"]);
    folder.put("points.csv", SQUARE);
    folder.taut("delaunay points.csv -o points.csv.json --order none").ends(2);
    folder.taut("delaunay points.csv -o points.csv").ends(2).stderr_has(&["points.csv"]);
    for alpha in ["-1", "NaN", "much"] {
        folder.taut(&format!("delaunay points.csv --alpha {alpha}")).ends(2);
    }
    folder.taut("delaunay points.csv --alpha-out a.ply").ends(2);
    assert_eq!(
        folder.files(),
        ["empty.csv", "four.csv", "line.csv", "nan.csv", "nan.f64", "points.csv"]
    );
}

#[test]
fn neither_threads_nor_order_nor_seed_change_a_byte() {
    let folder = TestFolder::new();
    // These are enough for two threads, each of which takes 4000 points in the plane and 1500 in space at least.
    let (plane, space) = long_or((40_000, 5000), (9000, 4000));
    folder.taut(&format!("generate normal -n {plane} -d 2 -o plane.npy")).ends(0);
    folder.taut(&format!("generate normal -n {space} -d 3 -o space.npy")).ends(0);
    let ways = ["--threads 2", "--threads 8", "--order random --seed 7", "--order local-ric"];
    for points in ["plane.npy", "space.npy"] {
        let answer = |options: &str| {
            let document =
                folder.taut(&format!("delaunay {points} --json {options}")).ends(0).json();
            (document["answer"].clone(), document["certificate"].clone())
        };
        let first = answer("--threads 1");
        for options in ways.into_iter().skip(long_or(0, 1)) {
            assert!(answer(options) == first, "{points} {options}");
        }
    }
}

#[test]
fn voronoi_cells_fill_the_box() {
    let folder = folder();
    folder.taut("delaunay points.csv --voronoi cells.geojson").ends(0);
    let cells: serde_json::Value = serde_json::from_str(&folder.text("cells.geojson")).unwrap();
    assert_eq!(folder.taut("delaunay points.csv --voronoi -").ends(0).json(), cells);
    let features = cells["features"].as_array().unwrap();
    assert_eq!((features.len(), &cells["type"]), (5, &"FeatureCollection".into()));
    let mut area = 0.0;
    for (point, feature) in features.iter().enumerate() {
        assert_eq!(feature["properties"]["point"], point);
        let ring: Vec<[f64; 2]> =
            serde_json::from_value(feature["geometry"]["coordinates"][0].clone()).unwrap();
        assert_eq!(ring.first(), ring.last());
        area += ring.windows(2).map(|e| e[0][0] * e[1][1] - e[0][1] * e[1][0]).sum::<f64>() / 2.0;
    }
    // The square, and a tenth of its side on each side.
    assert!((area - 2.4 * 2.4).abs() < 1e-12, "{area}");
    folder.put("space.csv", "0,0,0\n1,0,0\n0,1,0\n0,0,1\n1,1,1\n");
    folder.taut("delaunay space.csv --voronoi cells.json").ends(0);
    let cells: serde_json::Value = serde_json::from_str(&folder.text("cells.json")).unwrap();
    assert_eq!(cells["cells"].as_array().unwrap().len(), 5);
    assert_eq!(cells["low"], serde_json::json!([-0.1, -0.1, -0.1]));
}

#[test]
fn the_alpha_complex_is_counted_and_written() {
    let folder = folder();
    folder.taut("delaunay points.csv --alpha 1 --alpha-out a.off --alpha-boundary b.obj").ends(0).stdout_has(&[
        "\n  alpha       4 triangles of radius at most 1; 4 facets on their boundary, 0 more on their own\n",
    ]);
    folder.taut("verify a.off points.csv").ends(0);
    assert!(folder.text("b.obj").starts_with("# 6 vertices, 4 simplices\n"));
    // Half the side is too short for a triangle, but not for the spokes.
    folder
        .taut("delaunay points.csv --alpha 0.8")
        .ends(0)
        .stdout_has(&["\n  alpha       0 triangles", "4 more on their own"]);
}

#[test]
fn draw_draws_what_delaunay_draws() {
    let folder = folder();
    folder.taut("delaunay points.csv -o mesh.json --draw at-once.svg").ends(0);
    folder.taut("draw mesh.json points.csv -o later.svg").ends(0);
    assert_eq!(folder.text("at-once.svg"), folder.text("later.svg"));
    folder.taut("draw mesh.json points.csv -o mesh.html").ends(0);
    let page = folder.text("mesh.html");
    assert!(page.contains("Voronoi diagram of 6 points") && page.contains("convex hull"));
    folder.put("changed.csv", SQUARE.replace("1,1", "1,1.25"));
    folder
        .taut("draw mesh.json changed.csv -o no.svg")
        .ends(1)
        .stderr_has(&["rejected, so not drawn"]);
}
