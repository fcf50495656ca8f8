//! `taut inscribe bodies`: free facets, given points, holes that are closed, and a coverage.

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

/// A tetrahedron of which no face is in a direction of k-dops.
const TETRAHEDRON: &str =
    "OFF\n4 4 0\n0 0 0\n7 1 0\n1 8 0.5\n2 3 9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("mesh.off", TETRAHEDRON);
    folder.put("open.off", TETRAHEDRON.replace("4 4 0", "4 3 0").replace("3 2 0 3\n", ""));
    folder
}

#[test]
fn a_tetrahedron_is_filled_and_proved() {
    let folder = folder();
    let command = "inscribe bodies mesh.off --events 1000 -o bodies.json --draw bodies.svg";
    folder.taut(command).ends(0).stdout_has(&[
        "1 convex body in a mesh of 4 triangles\n",
        "4; the sum over all bodies",
        "yes; each body lies inside the mesh, by the even-odd rule",
        "free",
    ]);
    folder.taut("verify bodies.json mesh.off").ends(0).stdout_has(&["Verified: 1 convex body"]);
    let all = folder.text("bodies.json");
    folder.taut("inscribe bodies mesh.off --events 1000 --threads 1 -o bodies.json").ends(0);
    assert_eq!(folder.text("bodies.json"), all);
    let found: serde_json::Value = serde_json::from_str(&all).unwrap();
    let volume = found["answer"]["bodies"][0]["volume"].as_f64().unwrap();
    // A sixth of the determinant of the edges.
    let whole = (7.0 * (8.0 * 9.0 - 0.5 * 3.0) - (9.0 - 0.5 * 2.0)) / 6.0;
    assert!((0.985..=1.0).contains(&(volume / whole)), "{volume} of {whole}");
}

#[test]
fn given_points_are_in_the_bodies_or_refused_with_the_reason() {
    let folder = folder();
    folder
        .taut("inscribe bodies mesh.off --at 2,2,1 --at=1,1,0.5 --events 1000 -o bodies.json")
        .ends(0)
        .stdout_has(&["2 convex bodies"]);
    let claims = ["2 given points in as many bodies, in their order; proved"];
    folder.taut("verify bodies.json mesh.off").ends(0).stdout_has(&claims);
    let mut found: serde_json::Value = serde_json::from_str(&folder.text("bodies.json")).unwrap();
    found["answer"]["at"][1] = serde_json::json!([9, 9, 9]);
    folder.put("forged.json", found.to_string());
    let reason = ["body 1 is not proved to contain the point given for it"];
    folder.taut("verify forged.json mesh.off").ends(1).stdout_has(&reason);
    folder.taut("inscribe dops mesh.off --at -2,2,1").ends(2).stderr_has(&["point 0", "outside"]);
    folder.taut("inscribe bodies mesh.off --at 2,2").ends(2);
}

#[test]
fn holes_are_closed_if_asked_for() {
    let folder = folder();
    folder.taut("inscribe bodies open.off").ends(2).stderr_has(&["3 of its edges", "closed"]);
    folder
        .taut("inscribe bodies open.off --close-holes --events 1000 -o bodies.json")
        .ends(0)
        .stdout_has(&["each body lies inside the mesh closed by 1 cap", "caps"]);
    folder.taut("verify bodies.json open.off").ends(0).stdout_has(&[
        "each body lies inside the mesh closed by 1 cap, by the even-odd rule; proved",
    ]);
    folder.taut("draw bodies.json open.off -o caps.html").ends(0);
    assert!(folder.text("caps.html").contains("Holes of the mesh are closed by 1 cap."));
    let mut found: serde_json::Value = serde_json::from_str(&folder.text("bodies.json")).unwrap();
    found["answer"]["caps"] = serde_json::json!([]);
    folder.put("forged.json", found.to_string());
    folder.taut("verify forged.json open.off").ends(1).stdout_has(&["is not closed"]);
}

#[test]
fn bodies_are_added_until_the_coverage_is_reached() {
    let folder = folder();
    let command = "inscribe dops mesh.off -k 6 --coverage 0.6 --events 3000 -o bodies.json";
    folder.taut(command).ends(0);
    let found: serde_json::Value = serde_json::from_str(&folder.text("bodies.json")).unwrap();
    let counters = &found["trace"]["counters"];
    let part = counters["searched_covered"].as_f64().unwrap()
        / counters["searched_points"].as_f64().unwrap();
    let bodies = found["answer"]["bodies"].as_array().unwrap().len();
    assert!(part >= 0.6 && (2..100).contains(&bodies), "{bodies} bodies cover {part}");
    folder.taut("inscribe dops mesh.off --coverage 1.5").ends(2).stderr_has(&["--coverage", "1.5"]);
    folder.taut("inscribe bodies mesh.off --facets 5").ends(2).stderr_has(&["--facets", "is 5"]);
}

#[test]
fn bodies_are_merged_and_hide_a_part() {
    let (folder, events) = (folder(), long_or(3000, 600));
    let found = |command: &str| -> serde_json::Value {
        folder.taut(&format!("inscribe {command} --events {events} -o bodies.json")).ends(0);
        folder.taut("verify bodies.json mesh.off").ends(0);
        serde_json::from_str(&folder.text("bodies.json")).unwrap()
    };
    let bodies = |found: &serde_json::Value| found["answer"]["bodies"].as_array().unwrap().len();
    let all = found("dops mesh.off -k 6 --count 20");
    let few = found("dops mesh.off -k 6 --count 20 --merge-within 0.3");
    let covered = |found: &serde_json::Value| {
        found["trace"]["counters"]["searched_covered"].as_f64().unwrap()
    };
    assert!(bodies(&few) < bodies(&all) && covered(&few) >= 0.7 * covered(&all));
    let hiding = found("bodies mesh.off --objective occlusion --hidden 0.5");
    let counters = &hiding["trace"]["counters"];
    let [hidden, lines] =
        ["searched_hidden", "searched_lines"].map(|name| counters[name].as_f64().unwrap());
    assert!(hidden >= 0.5 * lines, "{hidden} of {lines}");
    for (usage, words) in [
        ("bodies mesh.off --hidden 0.5", &["--hidden", "objective occlusion"][..]),
        ("bodies mesh.off --merge-within 1", &["--merge-within", "below 1"]),
        ("dops mesh.off --method thesis --events 9", &["--max-events is of --method recreate"]),
        ("dops mesh.off --method thesis --merge-within 0", &["--merge-within is of --method"]),
    ] {
        folder.taut(&format!("inscribe {usage}")).ends(2).stderr_has(words);
    }
    folder.put("plane.csv", "x,y\n0,0\n1,0\n1,1\n");
    let words = ["rows have 2 numbers: expected 9, the corners of a triangle, or 3 for a point"];
    folder.taut("inscribe bodies plane.csv").ends(2).stderr_has(&words);
}

/// A cube, a block through its floor beside a loose triangle, points in it, and an open square.
fn scene() -> TestFolder {
    let folder = TestFolder::new();
    let cuboid = |low: [i32; 3], high: [i32; 3], more: [&str; 3]| {
        let end = |k: usize, c: usize| if k >> c & 1 == 0 { low[c] } else { high[c] };
        let corner = |k: usize| format!("{} {} {}\n", end(k, 0), end(k, 1), end(k, 2));
        let corners: String = (0..8).map(corner).collect();
        let faces = "4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";
        let [counts, vertices, triangles] = more;
        format!("OFF\n{counts}\n{corners}{vertices}{faces}{triangles}")
    };
    folder.put("cube.off", cuboid([0; 3], [4; 3], ["8 6 0", "", ""]));
    let loose = ["11 7 0", "3 3 1\n3 3 2\n3 2 1\n", "3 8 9 10\n"];
    folder.put("block.off", cuboid([0, 0, -1], [2, 4, 3], loose));
    folder.put("points.csv", "x,y,z\n2,2,2\n1,1,3\n9,9,9\n");
    folder.put("wall.off", "OFF\n4 2 0\n1.5 0 0\n1.5 4 0\n1.5 4 4\n1.5 0 4\n3 0 1 2\n3 0 2 3\n");
    folder
}

#[test]
fn bodies_stay_clear_of_points_and_walls() {
    let folder = scene();
    let obstacles = "--obstacles points.csv --obstacles wall.off";
    let command = format!(
        "inscribe bodies cube.off {obstacles} --count 3 --events 2000 -o bodies.json --draw bodies.svg"
    );
    folder
        .taut(&command)
        .ends(0)
        .stdout_has(&["3 convex bodies in a mesh of 12 triangles and among 3 points\n"]);
    folder.taut(&format!("verify bodies.json cube.off {obstacles}")).ends(0).stdout_has(&[
        "Verified: 3 convex bodies in a mesh of 12 triangles and among 3 points",
        "met by none of 2 triangles of open obstacles; none of 3 points is in a body; proved",
    ]);
    folder.taut(&format!("draw bodies.json cube.off {obstacles} -o again.html")).ends(0);
    assert!(folder.text("again.html").contains("obstacle point"));
    folder.taut("verify bodies.json cube.off").ends(1);
    let run = folder.taut("inscribe dops cube.off --obstacles wall.off -k 6 --events 500 --json");
    let volume = run.ends(0).json()["answer"]["bodies"][0]["volume"].as_f64().unwrap();
    assert!((volume - 40.0).abs() < 0.01, "{volume}");
    // What the answer is about may not be written over.
    let before = folder.text("points.csv");
    folder.taut("inscribe bodies cube.off --obstacles points.csv -o points.csv").ends(2);
    assert_eq!(folder.text("points.csv"), before);
}

#[test]
fn bodies_are_outside_of_solid_obstacles() {
    let folder = scene();
    let run = folder.taut(
        "inscribe bodies cube.off --obstacles block.off --count 4 --events 2000 -o bodies.json",
    );
    run.ends(0).stdout_has(&[
        "in a mesh of 12 triangles\n",
        "outside of 1 closed obstacle; met by none of 1 triangle of open obstacles",
    ]);
    folder
        .taut("verify bodies.json cube.off --obstacles block.off")
        .ends(0)
        .stdout_has(&["outside of 1 closed obstacle; met by none of 1 triangle"]);
    folder.taut("draw bodies.json cube.off --obstacles block.off -o bodies.html").ends(0);
    assert!(folder.text("bodies.html").contains("clear of obstacles of 13 triangles"));
    for at in ["1,2,2", "1,2,-0.5"] {
        folder
            .taut(&format!("inscribe bodies cube.off --obstacles block.off --at {at}"))
            .ends(2)
            .stderr_has(&["cube.off with block.off: point 0", "solid obstacle"]);
    }
    let run = folder.taut("inscribe dops cube.off --obstacles block.off -k 6 --events 500 --json");
    let volume = run.ends(0).json()["answer"]["bodies"][0]["volume"].as_f64().unwrap();
    assert!((15.9..32.0).contains(&volume), "{volume}");
}

#[test]
fn bodies_among_points_are_in_their_bounding_box() {
    let folder = scene();
    let command = "inscribe dops points.csv --direction 1,0,0 --direction 0,1,0 --direction 0,0,1 --events 500 \
                   -o bodies.json";
    folder.taut(command).ends(0).stdout_has(&["in a mesh of 12 triangles and among 3 points"]);
    folder.taut("verify bodies.json points.csv").ends(0).stdout_has(&["none of 3 points"]);
    folder.put("ragged.csv", "1,2\n3,4\n");
    folder
        .taut("inscribe bodies cube.off --obstacles ragged.csv")
        .ends(2)
        .stderr_has(&["ragged.csv: rows have 2 numbers"]);
    folder.put("nan.csv", "1,2,3\n3,nan,4\n");
    folder
        .taut("inscribe bodies cube.off --obstacles nan.csv")
        .ends(2)
        .stderr_has(&["nan.csv: row 2 (line 2), column 1 (counted from 0): the value is nan"]);
    folder.put("far.csv", "1e9,2,3\n");
    folder.taut("inscribe bodies cube.off --obstacles far.csv").ends(2).stderr_has(&[
        "cube.off with far.csv: row 12, the point [1000000000.0",
        "leave the point out",
    ]);
    folder.taut("ball points.csv -o ball.json").ends(0);
    folder
        .taut("verify ball.json points.csv --obstacles points.csv")
        .ends(2)
        .stderr_has(&["--obstacles belongs to bodies in a mesh"]);
}

#[test]
fn bodies_contain_segments() {
    let folder = scene();
    let command = "inscribe bodies cube.off --obstacles wall.off --at 2,0.5,0.5,3.5,3.5,3.5 --at 1,1,1 --events 800 \
                   -o bodies.json";
    folder.taut(command).ends(0).stdout_has(&["2 convex bodies"]);
    folder.taut("verify bodies.json cube.off --obstacles wall.off").ends(0).stdout_has(&[
        "1 given point and 1 given segment in as many bodies, in their order; proved",
    ]);
    folder
        .taut("inscribe bodies cube.off --obstacles wall.off --at 1,1,1,2,2,2")
        .ends(2)
        .stderr_has(&["point 0", "meets a surface"]);
}

#[test]
fn directions_of_ones_own_are_checked() {
    let folder = scene();
    for (options, expected) in [
        ("--direction 1,0,0 --direction 0,1,0", "from 3 to 13"),
        ("--direction 1,0,0 --direction 0,1,0 --direction 1,1,0", "not all in one plane"),
        ("--direction 1,0,0 --direction 0,1,0 --direction 0,0,64", "at most 63"),
    ] {
        folder.taut(&format!("inscribe dops cube.off {options}")).ends(2).stderr_has(&[expected]);
    }
    for usage in
        ["-k 14 --direction 1,0,0 --direction 0,1,0 --direction 0,0,1", "--direction 1,0,0.5"]
    {
        folder.taut(&format!("inscribe dops cube.off {usage}")).ends(2);
    }
}
