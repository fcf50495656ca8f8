//! Points along a curve.

use crate::test_folder::TestFolder;

#[test]
fn points_are_ordered_written_and_verified() {
    let folder = TestFolder::new();
    folder.taut("generate clouds -n 3000 -d 2 -o plane.npy").ends(0);
    folder.taut("generate torus -n 2000 -d 3 --type f32 -o space.npy").ends(0);
    for (file, n) in [("plane.npy", "3000"), ("space.npy", "2000")] {
        for (curve, along) in [("hilbert", "along a Hilbert curve"), ("morton", "in Z-order")] {
            let line =
                format!("memory order {file} --curve {curve} -o order.json --points sorted.npy");
            folder
                .taut(&line)
                .ends(0)
                .stdout_has(&[&format!("{n} points {along}"), "the one order"]);
            folder
                .taut(&format!("verify order.json {file}"))
                .ends(0)
                .stdout_has(&[&format!("Verified: {n} points {along}")]);
            // The points in order are in order already.
            folder.taut(&format!("memory order sorted.npy --curve {curve} -o again.json")).ends(0);
            let again: serde_json::Value =
                serde_json::from_str(&folder.text("again.json")).unwrap();
            let rows = again["answer"]["rows"].as_array().unwrap();
            assert!((0u64..).zip(rows).all(|(place, row)| *row == place), "{file}, {curve}");
            assert_eq!(folder.bytes("sorted.npy").len(), folder.bytes(file).len());
            folder.taut("verify order.json sorted.npy").ends(1).stdout_has(&["the data changed"]);
        }
    }
    let text = folder.text("order.json");
    folder.put("order.json", text.replacen("\"morton\"", "\"hilbert\"", 1));
    folder
        .taut("verify order.json space.npy")
        .ends(1)
        .stdout_has(&["order.json: row ", "belongs before"]);
    folder
        .taut("draw order.json space.npy -o order.svg --no-verify")
        .ends(2)
        .stderr_has(&["order.json", "no picture"]);
}

#[test]
fn names_of_columns_and_equal_points_are_kept() {
    let folder = TestFolder::new();
    folder.put("points.csv", "x,y\n1,1\n0,0\n1,1\n0,0\n");
    folder.taut("memory order points.csv --points sorted.csv").ends(0).stdout_has(&["4 points"]);
    assert_eq!(folder.text("sorted.csv"), "x,y\n0,0\n0,0\n1,1\n1,1\n");
    let run = folder.taut("memory order points.csv -o -").ends(0);
    assert!(run.out.contains("\"kind\": \"order\""), "{}", run.out);
    // Where the points go to standard output, nothing else does.
    let run = folder.taut("memory order points.csv --points -").ends(0);
    assert_eq!(run.out, "x,y\n0,0\n0,0\n1,1\n1,1\n");
    folder.put("one.csv", "5,6,7\n");
    folder.taut("memory order one.csv -o one.json").ends(0);
    folder.taut("verify one.json one.csv").ends(0).stdout_has(&["Verified: 1 point"]);
}

#[test]
fn what_has_no_order_is_refused_by_name() {
    let folder = TestFolder::new();
    for (text, said) in [("1\n2\n", "1 coordinate:"), ("1,2,3,4\n", "4 coordinates")] {
        folder.put("points.csv", text);
        folder
            .taut("memory order points.csv -o order.json")
            .ends(2)
            .stderr_has(&["points.csv", said]);
    }
    folder.put("points.csv", "1,2\n3,4\n");
    folder.taut("memory order points.csv -o points.csv").ends(2).stderr_has(&["is the input"]);
    folder.taut("memory order missing.csv -o order.json").ends(2).stderr_has(&["missing.csv"]);
    assert_eq!(folder.files(), ["points.csv"]);
    // Infinite coordinates of binary files, which no reader of text lets through.
    let values = [0.0, 1.0, f64::INFINITY, 2.0].map(f64::to_le_bytes).concat();
    folder.put("points.raw", values);
    folder
        .taut("memory order points.raw --raw-dim 2 --raw-type f64 -o order.json")
        .ends(2)
        .stderr_has(&["points.raw", "row 2", "inf"]);
}
