//! `taut inscribe dops`: found, proved, drawn; meshes with holes refused by edge.

use crate::test_folder::TestFolder;

/// An octahedron, which is a 14-dop.
const OCTAHEDRON: &str = "OFF\n6 8 0\n1 0 0\n-1 0 0\n0 1 0\n0 -1 0\n0 0 1\n0 0 -1\n\
    3 0 2 4\n3 0 2 5\n3 0 3 4\n3 0 3 5\n3 1 2 4\n3 1 2 5\n3 1 3 4\n3 1 3 5\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("mesh.off", OCTAHEDRON);
    folder
}

#[test]
fn an_octahedron_is_filled_and_proved() {
    let folder = folder();
    let command = "inscribe dops mesh.off -k 14 --events 1000 -o bodies.json --draw bodies.svg";
    folder.taut(command).ends(0).stdout_has(&[
        "1 convex body in a mesh of 8 triangles\n",
        "\n  volume",
        "1.33333",
        "an estimate",
        "yes; each body lies inside the mesh, by the even-odd rule",
        "14; the sum over all bodies",
    ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("bodies.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-bodies");
    let picture = folder.text("bodies.svg");
    assert!(picture.contains("Convex bodies in a mesh of 8 triangles"));
    folder.taut("verify bodies.json mesh.off").ends(0).stdout_has(&[
        "Verified: 1 convex body in a mesh of 8 triangles\n",
        "each body lies inside the mesh, by the even-odd rule; proved",
        "≤ sum of the volumes ≤",
    ]);
    folder.taut("draw bodies.json mesh.off -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    let all = folder.text("bodies.json");
    folder.taut("inscribe dops mesh.off -k 14 --events 1000 --threads 1 -o bodies.json").ends(0);
    assert_eq!(folder.text("bodies.json"), all);
}

#[test]
fn the_share_of_hidden_lines_is_evidence_and_the_same_for_all_threads() {
    let folder = folder();
    let command = "inscribe dops mesh.off -k 6 --events 1000 --occlusion 100000";
    let run = folder.taut(command).ends(0).stdout_has(&[
        "  occlusion",
        " % of ",
        " lines through the mesh; evidence: standard error 0.",
        "%; in the worst of 80 views ",
    ]);
    let line = |out: &str| out.lines().find(|line| line.contains("occlusion")).map(str::to_owned);
    for threads in [1, 3] {
        let again = folder.taut(&format!("{command} --threads {threads}")).ends(0);
        assert_eq!(line(&again.out), line(&run.out));
    }
    // The largest box in an octahedron has 4/9 of its volume, and hides half or so of it.
    let share: f64 = run
        .out
        .split("occlusion")
        .nth(1)
        .unwrap()
        .trim()
        .split(' ')
        .next()
        .unwrap()
        .parse()
        .unwrap();
    assert!((30.0..80.0).contains(&share), "{share}");
    folder.taut(&format!("{command} --objective occlusion")).ends(0).stdout_has(&["occlusion"]);
    let refused = "inscribe dops mesh.off --events 500 --occlusion 3";
    folder.taut(refused).ends(2).stderr_has(&["option `--occlusion` is 3: expected from 1000"]);
}

#[test]
fn disjoint_bodies_are_proved_and_forgeries_refused() {
    let folder = folder();
    folder.taut("inscribe dops mesh.off --count 3 --disjoint --events 3000 -o bodies.json").ends(0);
    folder
        .taut("verify bodies.json mesh.off")
        .ends(0)
        .stdout_has(&["no two bodies overlap; proved"]);
    let text = folder.text("bodies.json");
    let mut found: serde_json::Value = serde_json::from_str(&text).unwrap();
    for offset in found["answer"]["bodies"][0]["offsets"].as_array_mut().unwrap() {
        *offset = (offset.as_i64().unwrap() + (1 << 22)).into();
    }
    folder.put("forged.json", found.to_string());
    folder.taut("verify forged.json mesh.off").ends(1).stdout_has(&["Rejected: ", "body 0"]);
    folder.put("other.off", OCTAHEDRON.replace("-1 0 0", "-2 0 0"));
    folder.taut("verify bodies.json other.off").ends(1).stdout_has(&["the data changed"]);
}

#[test]
fn rows_of_nine_numbers_are_triangles_and_holes_are_named() {
    let folder = folder();
    folder.taut("inscribe dops mesh.off --events 500 -o bodies.json").ends(0);
    let corners = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    let mut rows = String::new();
    for x in [0, 1] {
        for y in [2, 3] {
            for z in [4, 5] {
                let row = [corners[x], corners[y], corners[z]].concat();
                let row: Vec<String> = row.iter().map(i32::to_string).collect();
                rows += &(row.join(",") + "\n");
            }
        }
    }
    folder.put("mesh.csv", rows);
    folder.taut("verify bodies.json mesh.csv").ends(0);
    folder.put("open.off", OCTAHEDRON.replace("6 8 0", "6 7 0").replace("3 1 3 5\n", ""));
    folder.taut("inscribe dops open.off").ends(2).stderr_has(&[
        "open.off",
        "3 of its edges",
        "--close-holes",
    ]);
    folder.taut("inscribe dops mesh.off -k 8").ends(2).stderr_has(&["--directions", "is 8"]);
    folder.put("points.off", "OFF\n1 0 0\n0 0 0\n");
    folder.taut("inscribe dops points.off").ends(2).stderr_has(&["points.off", "no triangle"]);
}

#[test]
fn the_procedure_of_the_thesis_gives_disjoint_bodies_with_proofs() {
    let folder = folder();
    // All triangles turned outward, as its votes need them.
    let turned = [("0 2 5", "2 0 5"), ("0 3 4", "3 0 4"), ("1 2 4", "2 1 4"), ("1 3 5", "3 1 5")];
    let outward = |mesh: String, (from, to): (&str, &str)| mesh.replace(from, to);
    folder.put("mesh.off", turned.into_iter().fold(OCTAHEDRON.to_owned(), outward));
    let command = "inscribe dops mesh.off -k 6 --method thesis --cells 12 --count 3 -o bodies.json";
    folder.taut(command).ends(0).stdout_has(&["method", "thesis", "disjoint", "yes"]);
    folder.taut("verify bodies.json mesh.off").ends(0).stdout_has(&["no two bodies overlap"]);
    let refused = "inscribe dops mesh.off --method thesis --votes 0";
    folder.taut(refused).ends(2).stderr_has(&["option `--votes` is 0: expected from 1 to 100"]);
    let refused = "inscribe dops mesh.off --method thesis --at 0,0,0";
    folder.taut(refused).ends(2).stderr_has(&["--at is of --method recreate, not of thesis"]);
}
