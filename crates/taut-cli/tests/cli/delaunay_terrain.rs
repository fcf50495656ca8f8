//! `taut delaunay --height`: contour lines and rasters, from memory and from tiles.

use crate::test_folder::TestFolder;

/// The features of a GeoJSON file, one on each line, in any order.
fn features(folder: &TestFolder, name: &str) -> Vec<String> {
    let text = folder.text(name);
    let mut lines: Vec<String> =
        text.lines().map(|line| line.trim_end_matches(',').to_owned()).collect();
    lines.sort();
    lines
}

/// A plane of whole numbers: exact in every cell, and lines that are straight.
#[test]
fn a_plane_has_exact_cells_and_straight_lines() {
    let folder = TestFolder::new();
    let rows: String =
        (0..49).map(|i| (i % 7, i / 7)).map(|(x, y)| format!("{},{x},{y}\n", 10 * x + y)).collect();
    folder.put("points.csv", format!("h,x,y\n{rows}"));
    folder
        .taut("delaunay points.csv --height h --cell 2 --grid grid.asc --grid grid.npy --contours lines.geojson --levels 25,-3 -o mesh.ply")
        .ends(0)
        .stdout_has(&[
            "Delaunay triangulation of 49 points in the plane\n",
            "\n  contours    1 line; at 2 heights\n",
            "\n  grid        4 × 4 cells of 2; the corner in the north-west is (0, 8)\n",
        ]);
    let expected = "ncols 4\nnrows 4\nxllcorner 0\nyllcorner 0\ncellsize 2\nNODATA_value -9999\n\
                    -9999 -9999 -9999 -9999\n15 35 55 -9999\n13 33 53 -9999\n11 31 51 -9999\n";
    assert_eq!(folder.text("grid.asc"), expected);
    let lines: serde_json::Value = serde_json::from_str(&folder.text("lines.geojson")).unwrap();
    let feature = &lines["features"][0];
    assert_eq!(feature["properties"]["height"], 25.0);
    let places = feature["geometry"]["coordinates"].as_array().unwrap();
    assert!(places.len() > 6);
    for place in places {
        let [x, y] = [0, 1].map(|k| place[k].as_f64().unwrap());
        assert!((10.0 * x + y - 25.0).abs() < 1e-13, "{x}, {y}");
    }
    // Vertices of the mesh are x, y and the height; the answer is about x and y.
    folder.taut("verify mesh.ply points.csv --columns x,y").ends(0);
    folder.taut("delaunay points.csv --height h -o answer.json -q").ends(0);
    folder.taut("verify answer.json points.csv --columns x,y").ends(0);
    let found = folder.taut("delaunay points.csv --height h -o mesh.off -q").ends(0);
    assert_eq!(found.err, "");
    assert!(folder.text("mesh.off").contains("\n1 0 10\n2 0 20\n"));
    folder
        .taut("delaunay points.csv --height 0 --columns h,x,y --cell 2 --grid same.asc -q")
        .ends(0);
    assert_eq!(folder.text("same.asc"), expected);
    let natural =
        "delaunay points.csv --height h --cell 2 --grid natural.asc --interpolation natural -q";
    folder.taut(natural).ends(0);
    assert_eq!(folder.text("natural.asc"), expected);
    let piped = folder.taut("delaunay points.csv --height h --contours - --interval 20").ends(0);
    assert_eq!(piped.json()["features"].as_array().unwrap().len(), 3);
}

/// More points than the memory has room for: the same lines and cells.
#[test]
fn points_that_do_not_fit_have_the_lines_and_cells_of_memory() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 300000 -d 3 -o points.npy --seed 3").ends(0);
    let run = |name: &str, memory: &str| {
        let options = format!("--grid {name}.npy --contours {name}.geojson {memory}");
        let common = "--height 2 --interpolation natural --cell 0.01 --levels 0.002 -q --no-verify";
        folder.taut(&format!("delaunay points.npy {common} {options}")).ends(0);
    };
    run("memory", "");
    run("tiles", "--memory 64M");
    assert!(folder.bytes("memory.npy") == folder.bytes("tiles.npy"));
    let lines = features(&folder, "tiles.geojson");
    assert!(lines.len() > 100 && lines == features(&folder, "memory.geojson"));
    let files = ["memory.geojson", "memory.npy", "points.npy", "tiles.geojson", "tiles.npy"];
    assert_eq!(folder.files(), files);
}

/// From a folder of tiles that is there already.
#[test]
fn a_folder_of_tiles_is_used_again() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 5000 -d 3 -o points.npy --seed 3").ends(0);
    folder.taut("delaunay points.npy --height 2 -o tiles/ -q").ends(0);
    let grid = "--height 2 --interpolation natural --cell 0.02 -q";
    folder.taut(&format!("delaunay points.npy -o tiles/ --resume --grid tiles.asc {grid}")).ends(0);
    folder.taut(&format!("delaunay points.npy --grid memory.asc {grid}")).ends(0);
    assert_eq!(folder.text("tiles.asc"), folder.text("memory.asc"));
    folder.taut("verify tiles points.npy --columns 0,1").ends(0);
}

/// A box, and one point in each cell of a grid.
#[test]
fn points_are_bounded_and_thinned() {
    let folder = TestFolder::new();
    folder.put("points.csv", "0,0,5\n0.1,0,7\n3,0,1\n0,3,2\n3,3,3\n-9,0,1\n");
    let run = folder
        .taut("delaunay points.csv --height 2 --thin 1 --bounds -1,-1,5,5 -o answer.json")
        .ends(0);
    assert!(run.out.contains("Delaunay triangulation of 4 points"), "{}", run.out);
    folder.taut("verify answer.json points.csv --columns 0,1 --bounds -1,-1,5,5 --thin 1").ends(0);
    folder.taut("verify answer.json points.csv --columns 0,1").ends(1);
    let whole = folder.taut("delaunay points.csv --thin 1 -q --json").ends(0).json();
    assert_eq!(whole["answer"]["duplicates"].as_array().unwrap().len(), 0);
    for (options, word) in [
        ("--bounds 0,0,1", "the least coordinates, then the largest"),
        ("--bounds 0,0,0,0,1,1,1,1", "at most 6 numbers"),
        ("--bounds 50,50,60,60", "no point is within the bounds"),
        ("--thin 0", "a length of more than 0"),
    ] {
        let refused = folder.taut(&format!("delaunay points.csv {options}")).ends(2);
        assert!(refused.err.contains(word), "{options}: {}", refused.err);
    }
}

#[test]
fn wrong_options_and_heights_are_refused() {
    let folder = TestFolder::new();
    folder.put("points.csv", "x,y,z\n0,0,5\n1,0,7\n0,1,1\n");
    folder.put("flat.csv", "0,0\n1,0\n0,1\n");
    folder.put("bad.csv", "x,z,y\n0,0,5\n1,inf,7\n0,1,1\n");
    for (options, word) in [
        ("points.csv --contours c.geojson --interval 1", "--height"),
        ("points.csv --height z --contours c.geojson", "--interval H or --levels LIST"),
        ("points.csv --height z --contours c.svg --interval 1", ".geojson or .json"),
        ("points.csv --height z --contours c.geojson --interval 0", "more than 0"),
        ("points.csv --height z --contours c.geojson --interval 1e-9", "at most a million"),
        ("points.csv --height z --grid g.asc", "--cell"),
        ("points.csv --height z --grid g.tif --cell 1", ".npy or .asc"),
        ("points.csv --height z --grid g.asc --cell 0", "more than 0"),
        ("points.csv --height w", "expected x, y, z"),
        ("points.csv --height 3", "expected x, y, z"),
        ("flat.csv --height 1", "points have 2 coordinates"),
        ("bad.csv --height z", "bad.csv: row 2"),
    ] {
        let refused = folder.taut(&format!("delaunay {options}")).ends(2);
        assert!(refused.err.contains(word), "{options}: {}", refused.err);
    }
    assert_eq!(folder.files(), ["bad.csv", "flat.csv", "points.csv"]);
}
