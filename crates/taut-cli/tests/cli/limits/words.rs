//! Numbers too large or too small for what they are meant for.

use crate::test_folder::TestFolder;

#[test]
fn threads_are_at_most_1024() {
    let folder = TestFolder::new();
    folder.put("points.csv", "0,0\n1,1\n");
    for threads in ["1000000000", "1025", "0", "99999999999999999999"] {
        let run = folder.taut(&format!("ball points.csv --threads {threads}")).ends(2);
        assert!(run.err.contains(threads) && run.err.contains("from 1 to 1024"), "{run:?}");
    }
}

#[test]
fn options_are_shown_without_hundreds_of_digits() {
    let folder = TestFolder::new();
    folder.put("points.csv", "0,0,0\n1,0,0\n0,1,0\n0,0,1\n");
    folder.put("plane.csv", "0,0\n1,1\n1,0\n0,2\n");
    folder.put("balls.csv", "0,0,1\n1,1,-1e308\n");
    folder.taut("ball plane.csv -o ball.json --quiet").ends(0);
    for (line, value) in [
        ("ball points.csv --epsilon 1e308", "option `--epsilon` is 1e308:"),
        ("ball points.csv --epsilon=-2.5e-300", "option `--epsilon` is -2.5e-300:"),
        ("ball points.csv --epsilon 1", "option `--epsilon` is 1:"),
        ("ball balls.csv --balls", "the radius is -1e308,"),
        ("centers balls.csv -k 1 --weights", "the weight is -1e308,"),
        ("ellipsoid points.csv --epsilon 1e308", "option `--epsilon` is 1e308:"),
        ("ellipsoid points.csv --robust mcd --keep 1e308", "`--keep` is 1e308:"),
        ("centers points.csv -k 1 --epsilon 1e308", "option `--epsilon` is 1e308:"),
        ("inscribe ellipsoid points.csv --epsilon 1e308", "option `--epsilon` is 1e308:"),
        ("curve plane.csv --rho -1e308 --method thesis", "option `--rho` is -1e308:"),
        ("surface points.csv --alpha -1e308 --method alpha", "option `--alpha` is -1e308:"),
        (
            "draw ball.json plane.csv -o a.svg --image-width 1e308",
            "option `--image-width` is 1e308:",
        ),
        ("generate shell -n 1 -d 2 --thickness -1e308", "option `--thickness` is -1e308:"),
        ("generate curve --shape circle -n 1 -d 2 --noise -1e308", "`--noise` is -1e308:"),
    ] {
        let run = folder.taut(line).ends(2);
        assert!(run.err.contains(value), "{line}: {run:?}");
        assert!(!run.err.contains("00000000"), "{line}: {run:?}");
    }
}

#[test]
fn a_number_that_would_become_0_is_refused_with_its_place() {
    let folder = TestFolder::new();
    folder.put("a.csv", "x,y\n0,1\n2,-1e-400\n");
    folder.taut("ball a.csv").ends(2).stderr_has(&[
        "a.csv: row 2 (line 3), column 1 (`y`)",
        "`-1e-400` is not 0, but too small for double precision",
    ]);
    folder.put("first.csv", "1e-400,1\n2,3\n");
    folder.taut("ball first.csv").ends(2).stderr_has(&["row 1 (line 1), column 0", "`1e-400`"]);
    let small = "0.00000000001e-330";
    folder.put("b.txt", format!("1 {small}\n"));
    folder.put("c.tsp", format!("DIMENSION: 1\nNODE_COORD_SECTION\n1 {small} 2\nEOF\n"));
    folder.put("d.xyz", format!("H 1 2 {small}\n"));
    folder.put("e.obj", format!("v 1 {small} 2\n"));
    folder.put("f.off", format!("OFF\n1 0 0\n1 {small} 2\n"));
    let header = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n\
                  property float z\nend_header\n";
    folder.put("g.ply", format!("{header}1 {small} 3\n"));
    folder.put(
        "h.stl",
        format!("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 {small}\nvertex 1 0 0\n"),
    );
    for (file, line) in [
        ("b.txt", "line 1"),
        ("c.tsp", "line 3"),
        ("d.xyz", "line 1"),
        ("e.obj", "line 1"),
        ("f.off", "line 3"),
        ("g.ply", "line 8"),
        ("h.stl", "line 4"),
    ] {
        let said = format!("`{small}` is not 0, but too small");
        folder.taut(&format!("ball {file}")).ends(2).stderr_has(&[file, line, &said]);
    }
    folder.put("mesh.obj", format!("v 0 0 {small}\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"));
    folder.taut("verify mesh.obj a.csv").ends(2).stderr_has(&["mesh.obj", "line 1", "is not 0"]);
}

#[test]
fn zeros_and_subnormal_numbers_are_read() {
    let folder = TestFolder::new();
    folder.put("zeros.csv", "0e-400,0.000e5\n-0,0e400\n5e-324,-2e-310\n");
    let found = folder.taut("ball zeros.csv --json").ends(0).json();
    // The third point has a place of its own.
    assert!(found["answer"]["radius"].as_f64().unwrap() > 0.0);
}

#[test]
fn places_on_the_earth_are_no_points_of_the_plane() {
    let folder = TestFolder::new();
    let problem = |kind: &str, nodes: &str| {
        format!(
            "NAME: x\nTYPE: TSP\nDIMENSION: 2\nEDGE_WEIGHT_TYPE : {kind}\nNODE_COORD_SECTION\n{nodes}EOF\n"
        )
    };
    folder.put("geo.tsp", problem("GEO", "1 38.24 20.42\n2 39.57 26.15\n"));
    folder.taut("ball geo.tsp").ends(2).stderr_has(&[
        "geo.tsp: line 4 says `EDGE_WEIGHT_TYPE: GEO`",
        "latitude and longitude",
        "project them",
    ]);
    for kind in ["EUC_2D", "CEIL_2D", "MAX_2D", "MAN_2D", "ATT"] {
        folder.put("plane.tsp", problem(kind, "1 0 0\n2 3 4\n"));
        let found = folder.taut("ball plane.tsp --json").ends(0).json();
        assert_eq!(found["answer"]["radius"], 2.5, "{kind}");
    }
    folder.put("space.tsp", problem("EUC_3D", "1 0 0 0\n2 2 4 4\n"));
    assert_eq!(folder.taut("ball space.tsp --json").ends(0).json()["answer"]["radius"], 3.0);
}
