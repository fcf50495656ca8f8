//! `taut dop`: found, proved, drawn; points and meshes; forgeries refused.

use serde_json::Value;

use crate::test_folder::TestFolder;

/// A tetrahedron, of which the faces have normals of 14 directions.
const TETRAHEDRON: &str = "0,0,0\n2,0,0\n0,2,0\n0,0,2\n0.25,0.25,0.25\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("points.csv", TETRAHEDRON);
    folder.put(
        "mesh.off",
        "OFF\n4 4 0\n0 0 0\n2 0 0\n0 2 0\n0 0 2\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
    );
    folder
}

#[test]
fn a_tetrahedron_is_its_own_14_dop() {
    let folder = folder();
    let command = "dop points.csv -k 14 -o dop.json --draw dop.svg";
    folder.taut(command).ends(0).stdout_has(&[
        "Smallest 14-dop around 5 points\n",
        "  volume    1.333333333",
        "  vertices  4\n",
        "  touched   4 points\n",
        "yes; every point is inside, and each facet touches one",
    ]);
    let found: Value = serde_json::from_str(&folder.text("dop.json")).unwrap();
    assert_eq!(found["kind"], "bounding-dop");
    let answer = found["answer"].as_object().unwrap();
    assert_eq!(answer.keys().collect::<Vec<_>>(), ["normals", "offsets", "vertices", "volume"]);
    assert_eq!(answer["offsets"][6], 2.0);
    folder.taut("verify dop.json points.csv").ends(0).stdout_has(&[
        "Verified: 14-dop around 5 points\n",
        "every point is inside; proved: by exact signs",
        "each facet touches a point; proved",
        "≤ volume ≤",
    ]);
    let picture = folder.text("dop.svg");
    assert!(picture.contains("14-dop around 5 points") && picture.contains("touched"));
    folder.taut("draw dop.json points.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    let all = folder.text("dop.json");
    folder.taut("dop points.csv -k 14 --threads 1 -o dop.json").ends(0);
    assert_eq!(folder.text("dop.json"), all);
}

#[test]
fn vertices_of_a_mesh_are_points_and_boxes_are_6_dops() {
    let folder = folder();
    folder
        .taut("dop mesh.off -k 6 -o dop.json")
        .ends(0)
        .stdout_has(&["6-dop around 4 points", "  volume    8.0000000000000"]);
    folder.taut("verify dop.json mesh.off").ends(0);
    folder.taut("dop mesh.off").ends(0).stdout_has(&["18-dop"]);
    folder.put("flat.csv", "0,0,1\n1,0,1\n0,1,1\n");
    folder.taut("dop flat.csv --draw flat.svg").ends(0).stdout_has(&["  volume    0\n"]);
    for (command, words) in [
        ("dop points.csv -k 8", "option `--directions` is 8: expected 6, 14, 18 or 26"),
        ("dop points.csv --columns 0,1", "points have 2 coordinates: expected 3"),
    ] {
        folder.taut(command).ends(2).stderr_has(&[words]);
    }
}

#[test]
fn forgeries_are_refused() {
    let folder = folder();
    folder.taut("dop points.csv -k 14 -o dop.json").ends(0);
    let found: Value = serde_json::from_str(&folder.text("dop.json")).unwrap();
    let forged = |change: &dyn Fn(&mut Value), words: &str| {
        let mut forged = found.clone();
        change(&mut forged);
        folder.put("forged.json", forged.to_string());
        folder.taut("verify forged.json points.csv").ends(1).stdout_has(&["Rejected: ", words]);
    };
    let answer = |name: &'static str, at: usize, value: f64| {
        move |found: &mut Value| found["answer"][name][at] = value.into()
    };
    forged(&answer("offsets", 0, 2f64.next_up()), "facet 0 does not touch point 1");
    forged(&answer("offsets", 0, 2f64.next_down()), "row 2: point 1 is outside facet 0");
    forged(
        &|found| found["certificate"]["touching"][0] = 4.into(),
        "facet 0 does not touch point 4",
    );
    forged(
        &|found| found["certificate"]["touching"][0] = 5.into(),
        "point 5, which does not exist",
    );
    forged(&|found| found["answer"]["volume"] = 1.3334.into(), "the volume is 1.3334");
    forged(&|found| found["answer"]["vertices"][1][2] = 0.001.into(), "no vertex at");
    forged(
        &|found| drop(found["answer"]["vertices"].as_array_mut().unwrap().pop()),
        "lacks the one at",
    );
    forged(&|found| found["answer"]["normals"][6] = [0, 2, 1].into(), "facet 6 has a normal");
}
