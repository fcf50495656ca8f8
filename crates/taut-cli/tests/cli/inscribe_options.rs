//! `taut inscribe`: options that do not go together, samples of open curves, and messages about files.

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

const SQUARE: &str = "0,0\n4,0\n4,4\n0,4\n";

/// A tetrahedron.
const MESH: &str = "OFF\n4 4 0\n0 0 0\n7 1 0\n1 8 0.5\n2 3 9\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("square.csv", SQUARE);
    folder.put("mesh.off", MESH);
    folder
}

#[test]
fn options_of_other_methods_are_refused() {
    let folder = folder();
    for (command, option) in [
        ("ellipse square.csv", "fatness -3"),
        ("ellipse square.csv", "sample-count 20"),
        ("ellipse square.csv", "contact-angle 30"),
        ("ellipse square.csv", "seed 7"),
        ("triangle square.csv", "sample-count 20"),
        ("triangle square.csv", "seed 7"),
        ("dops mesh.off", "seeds center"),
        ("dops mesh.off", "cells 0"),
        ("dops mesh.off", "votes 0"),
        ("dops mesh.off", "translate"),
        ("dops mesh.off", "merge"),
    ] {
        let name = option.split(' ').next().unwrap();
        folder
            .taut(&format!("inscribe {command} --{option} -o found.json"))
            .ends(2)
            .stderr_has(&[&format!("--{name} is of --method thesis")]);
    }
    folder
        .taut("inscribe dops mesh.off --method thesis --at 2,2,1")
        .ends(2)
        .stderr_has(&["--at is of --method recreate, not of thesis"]);
    folder
        .taut("inscribe ellipse square.csv --method five-point --fatness -3")
        .ends(2)
        .stderr_has(&["option `--fatness` is -3: expected a number of at least 0.5"]);
    assert_eq!(folder.files(), ["mesh.off", "square.csv"]);
}

#[test]
fn a_count_below_the_number_of_given_points_is_refused() {
    let folder = folder();
    for shape in ["dops", "bodies"] {
        folder
            .taut(&format!("inscribe {shape} mesh.off --at 2,2,1 --at 1,1,0.5 --count 1"))
            .ends(2)
            .stderr_has(&["option `--count` is 1: expected at least 2, as --at names 2 points"]);
    }
}

#[test]
fn a_curve_that_is_perhaps_open_is_told() {
    let folder = TestFolder::new();
    let sample = |i: usize, all: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * (7 * i % all) as f64 / 72.0).sin_cos();
        format!("{cosine:?},{sine:?}\n")
    };
    // An arc of 295 degrees, and the whole circle.
    folder.put("arc.csv", (0..60).map(|i| sample(i, 60)).collect::<String>());
    folder.put("circle.csv", (0..72).map(|i| sample(i, 72)).collect::<String>());
    let shapes = ["circle", "ellipse", "rectangle", "triangle", "polygon"];
    for shape in shapes.into_iter().take(long_or(usize::MAX, 4)) {
        folder.taut(&format!("inscribe {shape} arc.csv --samples")).ends(0).stdout_has(&[
            "  samples ",
            "joined to 1 closed curve; evidence: not certified: ",
            "if a curve is open, the polygon closes it: its longest edge, 1.07459922, is from ",
        ]);
    }
    folder
        .taut("inscribe circle circle.csv --samples")
        .ends(0)
        .stdout_has(&["joined to 1 closed curve; evidence: sampled densely enough"]);
}

#[test]
fn answers_are_written_as_json_alone() {
    let folder = folder();
    for name in ["F.ply", "F.csv", "F.geojson", "F.txt"] {
        let refused = format!("{name}: -o writes JSON, no ");
        folder
            .taut(&format!("inscribe circle square.csv -o {name}"))
            .ends(2)
            .stderr_has(&[&refused]);
        folder.taut(&format!("ball square.csv -o {name}")).ends(2).stderr_has(&[&refused]);
    }
    for name in ["F.json", "F"] {
        folder.taut(&format!("inscribe circle square.csv -o {name} --quiet")).ends(0);
    }
    let run = folder.taut("inscribe circle square.csv --json --quiet");
    assert_eq!(run.ends(0).json()["kind"], "inscribed-circle");
    assert_eq!(folder.files(), ["F", "F.json", "mesh.off", "square.csv"]);
}

#[test]
fn one_polygon_of_several_has_to_be_chosen() {
    let folder = TestFolder::new();
    let square = |x: u32| format!("(({x} 0,{0} 0,{0} 1,{x} 1,{x} 0))", x + 1);
    folder.put("two.wkt", format!("POLYGON{}\nPOLYGON{}\n", square(0), square(3)));
    let run = folder.taut("inscribe circle two.wkt").ends(2);
    let run = run.stderr_has(&["two.wkt: geometry 0 and geometry 1", "--select 0", "MULTIPOLYGON"]);
    assert!(!run.err.contains("damaged"), "{}", run.err);
    folder.taut("inscribe circle two.wkt --select 1").ends(0);
    folder.put("cut.wkt", "POLYGON((0 0,1 0,\n1 1,0 0\n");
    folder
        .taut("inscribe circle cut.wkt")
        .ends(2)
        .stderr_has(&["line 2: byte 8 of the line: the text ends early: expected a comma"]);
}

#[test]
fn a_long_ellipse_has_its_shorter_axis() {
    let folder = TestFolder::new();
    folder.put("long.csv", "0,0\n1e16,0\n1e16,1\n0,1\n");
    folder
        .taut("inscribe ellipse long.csv")
        .ends(0)
        .stdout_has(&["(5000000000000000, 0.5)\n", " and 0.4999"]);
}
