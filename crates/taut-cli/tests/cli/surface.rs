//! `taut surface`: the summary, the files, what is refused, and how runs end.

use serde_json::Value;

use crate::test_folder::TestFolder;

/// Points of a torus around the z-axis, `around` along the ring and half as many across it.
fn torus(center: [f64; 3], around: usize) -> Vec<[f64; 3]> {
    let across = around / 2;
    let mut points = Vec::new();
    for i in 0..around {
        let u = std::f64::consts::TAU * i as f64 / around as f64;
        for k in 0..across {
            let v = std::f64::consts::TAU * k as f64 / across as f64 + 0.01 * u;
            let ring = 2.0 + 0.7 * v.cos();
            let [x, y, z] = center;
            points.push([x + ring * u.cos(), y + ring * u.sin(), z + 0.7 * v.sin()]);
        }
    }
    points
}

fn csv(points: &[[f64; 3]]) -> String {
    points.iter().fold("x,y,z\n".to_owned(), |text, [x, y, z]| text + &format!("{x},{y},{z}\n"))
}

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("torus.csv", csv(&torus([0.0; 3], 40)));
    folder
}

fn document(text: &str) -> Value {
    serde_json::from_str(text).unwrap()
}

#[test]
fn the_summary_names_every_number() {
    let run = folder().taut("surface torus.csv").ends(0).stdout_has(&[
        "800 points in space: a closed surface with 1 handle\n",
        "triangles",
        "1600\n",
        "each is a point of the input\n",
        "1; closed\n",
        "certified",
        "yes; proved: an oriented manifold of Delaunay triangles that meets itself nowhere\n",
        "method",
        "tree\n",
        "s; reading ",
        ", checking ",
    ]);
    assert_eq!(run.err, "");
    let folder = TestFolder::new();
    let mut both = torus([0.0; 3], 40);
    both.extend(torus([9.0, 0.0, 0.0], 40));
    both.push(both[7]);
    folder.put("both.csv", csv(&both));
    folder.taut("surface both.csv").ends(0).stdout_has(&[
        "1601 points in space: 2 surfaces\n",
        "2; all closed\n",
        "duplicates",
        "row 1601\n",
    ]);
}

#[test]
fn the_json_is_one_document_with_the_names_at_the_door() {
    let folder = folder();
    let run = folder.taut("surface torus.csv --json -o surface.json").ends(0);
    let found = run.json();
    assert_eq!(found["kind"], "surface");
    assert_eq!(found["answer"]["triangles"].as_array().unwrap().len(), 1600);
    assert_eq!(found["answer"]["topology"]["genus"], 1);
    assert_eq!(found["certificate"]["mode"], "closed");
    assert_eq!(folder.text("surface.json"), run.out);
    for option in ["-o -", "--json --closed", "--json --threads 1", "--json --threads 3"] {
        let again = folder.taut(&format!("surface torus.csv {option}")).ends(0);
        assert_eq!(again.out, run.out, "{option}");
    }
    let quiet = folder.taut("surface torus.csv --quiet -o quiet.json").ends(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
    let run = folder.taut("surface torus.csv --no-verify").ends(0);
    assert!(run.out.contains("not checked"), "{}", run.out);
}

#[test]
fn answers_are_verified_and_lies_rejected() {
    let folder = folder();
    folder.taut("surface torus.csv -o surface.json").ends(0);
    folder.taut("verify surface.json torus.csv").ends(0).stdout_has(&[
        "Verified: a closed surface with 1 handle through ",
        "yes; proved: it meets itself nowhere\n",
        "yes; proved: each triangle has an empty ball\n",
    ]);
    let sound = document(&folder.text("surface.json"));
    let lie = |change: &dyn Fn(&mut Value)| {
        let mut found = sound.clone();
        change(&mut found);
        folder.put("lie.json", found.to_string());
        folder.taut("verify lie.json torus.csv").ends(1).stdout_has(&["Rejected: "]);
    };
    lie(&|found| {
        found["answer"]["triangles"].as_array_mut().unwrap().pop();
    });
    lie(&|found| found["answer"]["triangles"][3].as_array_mut().unwrap().swap(0, 1));
    lie(&|found| found["answer"]["topology"]["genus"] = 0.into());
    lie(&|found| found["answer"]["unused"]["unreferenced"] = serde_json::json!([5]));
    lie(&|found| found["certificate"]["apexes"][10] = 400.into());
    lie(&|found| found["certificate"]["outward"] = false.into());
    folder.put("other.csv", csv(&torus([1.0, 0.0, 0.0], 40)));
    folder.taut("verify surface.json other.csv").ends(1).stdout_has(&["Rejected: "]);
}

#[test]
fn meshes_are_written_in_every_format_and_points_read_from_them() {
    let folder = folder();
    let plain = folder.taut("surface torus.csv --json").ends(0).json();
    for name in ["ply", "obj", "off", "stl", "glb", "gltf", "dxf", "wrl", "pov", "ply.gz"] {
        folder.taut(&format!("surface torus.csv -o mesh.{name} --quiet")).ends(0);
        assert!(folder.bytes(&format!("mesh.{name}")).len() > 1000, "{name}");
    }
    for name in ["ply", "obj", "off", "ply.gz"] {
        let again = folder.taut(&format!("surface mesh.{name} --json")).ends(0).json();
        assert_eq!(again["answer"], plain["answer"], "{name}");
    }
    let text = "x,y,z\n1,0,0\n0,1,0\n0,0,1\n0,0,0\n";
    folder.put("corners.csv", text);
    folder.taut("surface corners.csv -o corners.stl").ends(0).stdout_has(&["4 points in space"]);
    folder.taut("surface corners.stl").ends(0).stdout_has(&["a closed surface\n"]);
}

#[test]
fn normals_and_colors_go_with_their_points() {
    let folder = TestFolder::new();
    let head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
    folder.put(
        "corners.ply",
        format!("{head}0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n0 0 1 250 251 252\n"),
    );
    folder.taut("surface corners.ply -o out.off --quiet").ends(0);
    let out = folder.text("out.off");
    assert!(out.starts_with("COFF") && out.contains("250 251 252"), "{out}");
}

#[test]
fn other_methods_and_open_sheets() {
    let folder = folder();
    folder.taut("surface torus.csv --method thesis").ends(0).stdout_has(&["thesis\n", "verified"]);
    folder.taut("surface torus.csv --method alpha").ends(0).stdout_has(&["alpha\n", "verified"]);
    folder.taut("surface torus.csv --method alpha --alpha 0.4").ends(0).stdout_has(&["verified"]);
    folder.taut("surface torus.csv --method hull").ends(0).stdout_has(&["hull\n", "verified"]);
    let sheet: Vec<[f64; 3]> = (0..400)
        .map(|i| {
            let (x, y) = (f64::from(i % 20) / 10.0 - 1.0, f64::from(i / 20) / 10.0 - 1.0);
            [x, y + 1e-3 * x * x, 0.3 * (x * x - y * y)]
        })
        .collect();
    folder.put("sheet.csv", csv(&sheet));
    folder.taut("surface sheet.csv --open").ends(0).stdout_has(&[
        "400 points in space: a surface\n",
        "1; with a boundary\n",
        "boundary loops",
    ]);
    folder.taut("surface sheet.csv").ends(0).stdout_has(&["1; closed\n"]);
}

#[test]
fn options_of_other_methods_are_refused() {
    let folder = folder();
    for (options, said) in [
        ("--alpha 0.1", "--alpha is of --method thesis and alpha and hull, not of tree"),
        ("--shrink 7", "--shrink is of --method thesis and hull, not of tree"),
        ("--restarts", "--restarts is of --method thesis, not of tree"),
        ("--method alpha --open", "--open is of --method tree, not of alpha"),
        ("--method thesis --closed", "--closed is of --method tree, not of thesis"),
    ] {
        folder.taut(&format!("surface torus.csv {options}")).ends(2).stderr_has(&[said]);
    }
}

#[test]
fn bad_input_is_named_and_leaves_files_as_they_were() {
    let folder = folder();
    folder.put("mesh.ply", "before");
    let refuse = |name: &str, text: &str, said: &[&str]| {
        folder.put(name, text);
        folder.taut(&format!("surface {name} -o mesh.ply")).ends(2).stderr_has(said);
        assert_eq!(folder.text("mesh.ply"), "before");
    };
    refuse("nan.csv", "x,y,z\n0,0,0\n1,0,nan\n0,1,0\n", &["nan.csv", "row 2", "nan"]);
    refuse("plane.csv", "x,y\n0,0\n1,0\n0,1\n", &["plane.csv", "2 coordinates", "--columns"]);
    refuse("flat.csv", "x,y,z\n0,0,1\n1,0,1\n0,1,1\n1,1,1\n", &["flat.csv", "plane"]);
    refuse("one.csv", "x,y,z\n0,0,1\n", &["one.csv", "there is one point"]);
    refuse("mesh.glb", "glTF", &["mesh.glb", "glb files are written, not read"]);
    folder.taut("surface torus.csv -o mesh.xyz").ends(2).stderr_has(&["mesh.xyz", ".ply"]);
    folder.taut("surface torus.csv -o mesh.png").ends(2).stderr_has(&["--draw"]);
    folder
        .taut("surface torus.csv --method thesis --shrink 1")
        .ends(2)
        .stderr_has(&["shrink", "1"]);
    folder.taut("surface torus.csv --method alpha --alpha -1").ends(2).stderr_has(&["alpha", "-1"]);
    folder.taut("surface missing.csv").ends(2).stderr_has(&["missing.csv"]);
}

/// Rows that are left out as outliers are no part of what is certified, and the verdict says how many they are.
#[test]
fn a_verdict_names_the_share_of_rows_left_out() {
    let folder = TestFolder::new();
    let (one, two) = (torus([0.0; 3], 40), torus([9.0, 0.0, 0.0], 40));
    folder.put("one.csv", csv(&one));
    folder.taut("surface one.csv -o surface.json").ends(0);
    let both: Vec<[f64; 3]> = one.iter().chain(&two).copied().collect();
    folder.put("both.csv", csv(&both));
    folder.taut("surface both.csv -o both.json").ends(0);
    // The second half is left out: the surface is that of the first, the hash that of both.
    let mut forged = document(&folder.text("surface.json"));
    let outliers: Vec<u64> = (800..1600).collect();
    forged["answer"]["unused"]["outliers"] = serde_json::json!(outliers);
    forged["certificate"]["points_hash"] =
        document(&folder.text("both.json"))["certificate"]["points_hash"].clone();
    folder.put("forged.json", forged.to_string());
    folder.taut("verify forged.json both.csv").ends(0).stdout_has(&[
        "through 800 of 1600 points in space; 800 (50 %) left out as outliers\n",
        "800 (50 %); proved: left out: nothing is claimed of them\n",
        "yes, of 800 of 1600 points; proved: ",
    ]);
}
