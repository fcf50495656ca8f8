//! Files that other programs wrote: pandas, NumPy, GeoPandas, pyshp, and the layouts of the Point Cloud Library.
//!
//! `tests/data/make.py` made them.

use std::path::Path;

use serde_json::{Value, json};

use crate::test_folder::TestFolder;

/// A folder with all of the files.
fn folder() -> TestFolder {
    let folder = TestFolder::new();
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    for file in std::fs::read_dir(data).unwrap() {
        let file = file.unwrap();
        folder.put(&file.file_name().into_string().unwrap(), std::fs::read(file.path()).unwrap());
    }
    folder
}

/// The points of a file as CSV.
fn csv(folder: &TestFolder, file: &str) -> String {
    folder.taut(&format!("convert {file} -o -")).ends(0).out
}

/// All numbers of a CSV without a header.
fn numbers(text: &str) -> Vec<f64> {
    let words = text
        .lines()
        .filter(|line| !line.starts_with(|c: char| c.is_alphabetic()))
        .flat_map(|line| line.split(','));
    words.map(|word| word.parse().unwrap()).collect()
}

#[test]
fn clouds_of_the_point_cloud_library() {
    let folder = folder();
    let expected = numbers(&folder.text("cloud32.csv"));
    for file in ["ascii.pcd", "binary.pcd", "compressed.pcd"] {
        let text = csv(&folder, file);
        assert!(text.starts_with("x,y,z\n"), "{file}: {text}");
        let found = numbers(&text);
        let same = found.iter().zip(&expected).all(|(a, b)| (*a as f32) == (*b as f32));
        assert!(same && found.len() == 36, "{file}: {found:?}");
        // The last value of a field of three.
        let normals = csv(&folder, &format!("{file} --columns normal2,intensity"));
        assert_eq!(numbers(&normals)[..6], [1.0, 0.0, 1.0, 1.0, 1.0, 2.0], "{file}");
    }
    let whole = folder.bytes("binary.pcd");
    folder.put("cut.pcd", &whole[..whole.len() - 3]);
    folder.taut("info cut.pcd").ends(2).stderr_has(&["cut.pcd", "12 points", "11"]);
    let whole = folder.bytes("compressed.pcd");
    folder.put("cut.pcd", &whole[..whole.len() - 3]);
    folder.taut("info cut.pcd").ends(2).stderr_has(&["cut.pcd", "cut short"]);
    folder.put(
        "none.pcd",
        "VERSION 0.7\nFIELDS a\nSIZE 4\nTYPE F\nCOUNT 1\nPOINTS 1\nDATA ascii\n1\n",
    );
    folder.taut("info none.pcd").ends(2).stderr_has(&["none.pcd", "no field x, y or z"]);
}

#[test]
fn archives_of_arrays() {
    let folder = folder();
    assert_eq!(csv(&folder, "packed.npz"), csv(&folder, "cloud.csv"));
    assert_eq!(csv(&folder, "stored.npz --select cloud"), csv(&folder, "cloud.csv"));
    assert_eq!(csv(&folder, "stored.npz --select 1"), "0,1\n2,3\n4,5\n");
    folder.taut("ball stored.npz").ends(2).stderr_has(&["2 arrays", "--select", "\"cloud\""]);
    folder.taut("ball stored.npz --select none").ends(2).stderr_has(&["no array has the name"]);
    let whole = folder.bytes("stored.npz");
    for keep in [whole.len() - 1, whole.len() / 2, 10] {
        folder.put("cut.npz", &whole[..keep]);
        folder.taut("ball cut.npz --select 0").ends(2).stderr_has(&["cut.npz"]);
    }
}

#[test]
fn shapefiles_and_geoparquet() {
    let folder = folder();
    let three = "x,y\n1,2\n3.5,-1\n0,0.25\n";
    assert_eq!(csv(&folder, "points.shp"), three);
    assert_eq!(csv(&folder, "heights.shp"), "x,y,z\n1,2,3\n3.5,-1,0.5\n");
    assert_eq!(csv(&folder, "multi.shp"), "x,y\n1,2\n3,4\n5,6\n");
    assert_eq!(csv(&folder, "line.shp"), "x,y,z\n0,0,5\n1,1,6\n2,0,7\n");
    let rings = csv(&folder, "polygons.shp --select 0");
    assert!(rings.starts_with("x,y,ring\n0,0,0\n") && rings.contains("\n1,1,1\n"), "{rings}");
    assert!(csv(&folder, "polygons.shp").ends_with("20,0,2\n"));
    folder.taut("inscribe circle polygons.shp --select 0").ends(0);
    folder.taut("ball polygons.shp --select 9").ends(2).stderr_has(&["no shape 9"]);
    let whole = folder.bytes("polygons.shp");
    folder.put("cut.shp", &whole[..whole.len() - 9]);
    folder.taut("ball cut.shp").ends(2).stderr_has(&["cut.shp", "too early"]);
    if cfg!(feature = "arrow") {
        assert_eq!(csv(&folder, "points.geo.parquet"), three);
        let polygon = csv(&folder, "polygon.geo.parquet");
        assert!(polygon.starts_with("x,y,ring\n") && polygon.contains("\n1,1,1\n"), "{polygon}");
        folder.taut("inscribe circle polygon.geo.parquet").ends(0);
    }
}

#[test]
fn frames_of_pandas() {
    let folder = folder();
    folder.taut("ball pandas.csv --columns x,y").ends(2).stderr_has(&["--missing drop"]);
    let run = folder
        .taut("centers pandas.csv --columns x,y --missing drop --id town -k 2 --discrete --json")
        .ends(0);
    let frame = run.json();
    let german = "centers pandas-german.csv --decimal , --columns x,y --missing drop --id town";
    let german = folder.taut(&format!("{german} -k 2 --discrete --json")).ends(0).json();
    assert_eq!(frame["answer"], german["answer"]);
    if cfg!(feature = "arrow") {
        let line = "centers pandas.parquet --columns x,y --missing drop -k 2 --discrete --json";
        assert_eq!(folder.taut(line).ends(0).json()["answer"], frame["answer"]);
    }
}

#[test]
fn a_file_is_described() {
    let folder = folder();
    folder.taut("info pandas.csv").ends(0).stdout_has(&[
        "pandas.csv: 5 rows, 5 columns, csv\n",
        "\n  x       real   1        0.5    90\n",
        "\n  y       whole  0        0      90\n",
        "\n  town    text   0        -      -\n",
        "\n  kind    text   1        -      -\n",
        "\nduplicates  0\nincomplete  1\n",
    ]);
    let found = folder.taut("info pandas-german.csv --decimal , --json").ends(0).json();
    assert_eq!((&found["rows"], &found["incomplete"]), (&json!(5), &json!(1)));
    let x = json!({ "name": "x", "type": "real", "missing": 1, "least": 0.5, "largest": 90.0 });
    assert_eq!(found["columns"][0], x);
    folder.put("twice.csv", "1,2\n3,4\n1,2\n1,2\n0,-0\n0,0\n");
    let twice = folder.taut("info twice.csv --json").ends(0).json();
    assert_eq!((&twice["duplicates"], &twice["triangles"]), (&json!(3), &Value::Null));
    folder.put("cube.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n");
    folder.taut("info cube.off").ends(0).stdout_has(&["4 rows, 3 columns, off", "triangles   1\n"]);
}

#[test]
fn points_and_meshes_are_converted() {
    let folder = folder();
    folder.taut("convert cloud.csv -o cloud.npy").ends(0).stdout_has(&["12 points, 3 coordinates"]);
    folder.taut("convert cloud.npy -o cloud.ply").ends(0).stdout_has(&["12 vertices, 0 triangles"]);
    assert_eq!(numbers(&csv(&folder, "cloud.ply")), numbers(&folder.text("cloud.csv")));
    folder.put("cube.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n");
    folder.taut("convert cube.off -o cube.obj").ends(0).stdout_has(&["4 vertices, 1 triangle\n"]);
    folder.taut("convert cube.off -o cube.stl -q").ends(0);
    let named = "convert pandas.csv -o named.csv --columns x,y --missing drop --id town";
    folder.taut(named).ends(0);
    assert_eq!(folder.text("named.csv").lines().nth(1), Some("Ulm,0.5,0"));
    folder.taut("convert pandas.csv -o n.npy --columns x,y --missing drop --id town").ends(2);
    folder.taut("convert cloud.csv -o cloud.json").ends(2).stderr_has(&["cloud.json"]);
    folder.taut("convert cloud.csv -o cloud.csv").ends(2).stderr_has(&["is the input"]);
    folder.taut("convert twice.csv -o x.ply").ends(2);
}

#[test]
fn options_of_reading_choose_rows_of_meshes_without_triangles() {
    let folder = TestFolder::new();
    folder.put("scan.xyz", "0 0 0\n0.1 0 0\n5 5 5\n");
    let to = |line: &str| folder.taut(&format!("convert {line}")).ends(0).out;
    assert!(to("scan.xyz -o thin.ply --thin 1").contains("2 vertices"));
    to("thin.ply -o near.obj --bounds 0,0,0,1,1,1");
    assert_eq!(numbers(&csv(&folder, "near.obj")), [0.0, 0.0, 0.0]);
    folder.put("cube.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n");
    folder
        .taut("convert cube.off -o cut.ply --bounds 0,0,0,1,1,0")
        .ends(2)
        .stderr_has(&["cube.off", "not the triangles of a mesh"]);
    folder.taut("convert scan.xyz -o n.ply --id 0 --columns 0-").ends(2);
    // The format that is asked for is that of the file, also of a pipe.
    folder.put("cube.dat", folder.bytes("cube.off"));
    assert!(to("cube.dat --format off -o named.ply").contains("1 triangle"));
    let piped = folder.pipe(folder.bytes("cube.off"), "convert - --format off -o piped.ply");
    assert!(piped.ends(0).out.contains("1 triangle"));
    folder.taut("info cube.dat --format off").ends(0).stdout_has(&["triangles   1\n"]);
}

#[test]
fn whole_numbers_and_bytes_of_clouds_are_not_lost() {
    let folder = folder();
    let mut more = folder.bytes("binary.pcd");
    more.push(0);
    folder.put("more.pcd", &more);
    folder
        .taut("info more.pcd")
        .ends(2)
        .stderr_has(&["more.pcd", "more bytes follow its 12 points"]);
    let head = "VERSION 0.7\nFIELDS x\nSIZE 8\nTYPE U\nCOUNT 1\nPOINTS 1\nDATA binary\n";
    for (value, code) in [(1_u64 << 53, 0), ((1 << 53) + 1, 2), (u64::MAX, 2)] {
        folder.put("large.pcd", [head.as_bytes(), &value.to_le_bytes()].concat());
        let run = folder.taut("info large.pcd").ends(code);
        assert_eq!(run.err.contains("is not exact as f64"), code == 2, "{run:?}");
    }
}
