//! Meshes of files: judged for what they are, and drawn.

use crate::test_folder::TestFolder;

/// Points of an ellipsoid, in no order.
fn blob(rows: usize) -> String {
    let golden = 0.618_033_988_749_895;
    let point = |i: usize| {
        let (t, z) = (
            (i as f64 * golden).fract() * std::f64::consts::TAU,
            1.0 - (2 * i + 1) as f64 / rows as f64,
        );
        let r = (1.0 - z * z).sqrt();
        format!("{},{},{}\n", 2.0 * r * t.cos(), 1.5 * r * t.sin(), z)
    };
    std::iter::once("x,y,z\n".to_owned()).chain((0..rows).map(point)).collect()
}

const CUBE: &str = "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n\
    4 0 3 2 1\n4 4 5 6 7\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n";

#[test]
fn surfaces_that_were_written_are_proved_from_their_meshes() {
    let folder = TestFolder::new();
    folder.put("blob.csv", blob(300));
    for name in ["mesh.ply", "mesh.off", "mesh.obj", "mesh.ply.gz"] {
        folder.taut(&format!("surface blob.csv -o {name} --quiet")).ends(0);
        let run = folder.taut(&format!("verify {name} blob.csv")).ends(0).stdout_has(&[
            "Verified: a closed surface through 300 points in space\n",
            "yes; proved: it meets itself nowhere\n",
            "yes; proved: each triangle has an empty ball\n",
            "sound",
        ]);
        // There is no method whose doubts could be told.
        assert!(!run.out.contains("certified") && !run.out.contains("topology"), "{}", run.out);
    }
    folder.taut("verify mesh.ply").ends(0).stdout_has(&["Verified: a closed surface through 300"]);
    folder.taut("verify mesh.ply blob.csv -q").ends(0);
    folder.taut("verify mesh.ply blob.csv --epsilon 1").ends(2).stderr_has(&["--epsilon"]);
    folder.taut("verify mesh.ply blob.csv blob.csv").ends(2).stderr_has(&["one file of points"]);
}

#[test]
fn points_that_a_surface_leaves_out_and_another_order_do_no_harm() {
    let folder = TestFolder::new();
    folder.put("few.csv", "x,y,z\n0,0,0\n1,0,0\n0,1,0\n0,0,1\n");
    folder.taut("surface few.csv -o few.stl --quiet").ends(0);
    folder.put("all.csv", "x,y,z\n5,5,5\n0,0,1\n0,1,0\n1,0,0\n0,0,0\n0,0,0\n");
    folder.taut("verify few.stl all.csv").ends(0).stdout_has(&[
        "Verified: a closed surface through 4 of 6 points in space\n",
        "duplicates",
        "unreferenced",
    ]);
    folder.put("third.csv", "x,y,z\n0,0,0\n0.3333333333333333,0,0\n0,1,0\n0,0,1\n");
    folder.taut("surface third.csv -o third.stl --quiet").ends(0);
    folder.taut("verify third.stl third.csv").ends(1).stdout_has(&[
        "Rejected: third.csv does not belong to third.stl: vertex ",
        "is none of its points; stl rounds",
    ]);
}

/// The mesh of another program: quadrilaterals, of which each becomes two triangles.
#[test]
fn a_cube_of_polygons_is_a_closed_surface() {
    let folder = TestFolder::new();
    folder.put("cube.off", CUBE);
    folder.taut("verify cube.off").ends(0).stdout_has(&[
        "Verified: a closed surface through 8 points in space\n",
        "\n  triangles      12; proved\n",
        "\n  manifold       yes; proved\n",
    ]);
    // Inside out it is a surface all the same, and not sound.
    let turned: String = CUBE
        .lines()
        .map(|line| match line.split(' ').collect::<Vec<_>>()[..] {
            ["4", a, b, c, d] => format!("4 {d} {c} {b} {a}\n"),
            _ => format!("{line}\n"),
        })
        .collect();
    folder.put("turned.off", turned);
    folder
        .taut("verify turned.off")
        .ends(0)
        .stdout_has(&["sound", "no; proved: closed component 0"]);
}

#[test]
fn triangles_that_are_no_surface_are_rejected_with_the_place() {
    let folder = TestFolder::new();
    folder.put(
        "pierced.off",
        "OFF\n6 2 0\n-1 0 0\n1 0 0\n0 1 0\n0 0.25 -1\n0 0.25 1\n0 2 0.5\n3 0 1 2\n3 3 4 5\n",
    );
    folder.taut("verify pierced.off").ends(1).stdout_has(&[
        "Rejected: pierced.off: triangles 0 and 1 meet beyond the vertices that they share",
        "\n  embedded       no; proved\n",
    ]);
    folder.put(
        "book.off",
        "OFF\n5 3 0\n0 0 0\n0 0 1\n1 0 0\n0 1 0\n-1 -1 0\n3 0 1 2\n3 0 1 3\n3 0 1 4\n",
    );
    folder.taut("verify book.off").ends(1).stdout_has(&["Rejected: book.off: ", "has 3 triangles"]);
    folder.put("flap.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n3 0 1 2\n");
    folder.taut("verify flap.off").ends(1).stdout_has(&["Rejected: flap.off: "]);
    folder.put("ids.parquet", "no parquet");
    folder.taut("verify ids.parquet").ends(2).stderr_has(&["ids.parquet"]);
}

#[test]
fn triangles_without_empty_balls_are_a_surface_and_not_delaunay() {
    let folder = TestFolder::new();
    // A point within a triangle is inside every ball around it.
    folder.put("tent.off", "OFF\n5 2 0\n0 0 0\n4 0 0\n0 4 0\n0 0 4\n1 1 0\n3 0 1 2\n3 0 3 1\n");
    folder.taut("verify tent.off").ends(0).stdout_has(&[
        "Verified: a surface through 4 of 5 points in space\n",
        "\n  delaunay       no; proved\n",
        "\n  boundary loops 1; proved\n",
    ]);
}

#[test]
fn meshes_are_drawn_with_their_points_or_alone() {
    let folder = TestFolder::new();
    folder.put("blob.csv", blob(120));
    folder.taut("surface blob.csv -o mesh.ply --quiet").ends(0);
    folder.taut("draw mesh.ply -o alone.html").ends(0);
    folder.taut("draw mesh.ply blob.csv -o mesh.svg").ends(0);
    assert!(folder.text("alone.html").contains("closed surface"));
    assert!(!folder.text("alone.html").contains("certified"));
    assert!(folder.text("mesh.svg").starts_with("<svg"));
    folder.taut("generate uniform -n 40 -d 2 -o plane.csv").ends(0);
    folder.taut("delaunay plane.csv -o plane.ply --quiet").ends(0);
    folder.taut("draw plane.ply plane.csv -o plane.svg").ends(0);
    folder.put("cube.off", CUBE);
    folder.taut("draw cube.off -o cube.png --figure 1").ends(0);
    folder.taut("draw cube.off blob.csv -o no.svg").ends(1).stderr_has(&["so not drawn"]);
    folder.put("ball.json", "{}");
    folder.taut("draw ball.json -o no.svg").ends(2).stderr_has(&["name the points"]);
    folder.taut("verify ball.json").ends(2).stderr_has(&["name the points"]);
}
