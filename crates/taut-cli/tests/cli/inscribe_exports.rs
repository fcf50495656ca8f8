//! Convex bodies as meshes and as parts of a collision model.

use crate::test_folder::TestFolder;

/// The cube from 0 to 2.
const CUBE: &str = "OFF\n8 6 0\n0 0 0\n2 0 0\n0 2 0\n2 2 0\n0 0 2\n2 0 2\n0 2 2\n2 2 2\n\
    4 0 2 3 1\n4 4 5 7 6\n4 0 1 5 4\n4 2 6 7 3\n4 0 4 6 2\n4 1 3 7 5\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("cube.off", CUBE);
    folder
}

#[test]
fn bodies_are_written_as_one_closed_mesh() {
    let folder = folder();
    for extension in ["ply", "obj", "stl", "off"] {
        let command = format!("inscribe dops cube.off -k 6 --events 500 -o bodies.{extension}");
        folder.taut(&command).ends(0).stdout_has(&["1 convex body"]);
        // A mesh that were not closed, or not that of the body, would be refused or of another volume.
        let command = format!("inscribe dops bodies.{extension} -k 6 --events 500");
        folder.taut(&command).ends(0).stdout_has(&["in a mesh of 12 triangles\n", "  largest"]);
    }
    let command = "inscribe dops cube.off -k 6 --events 500 -o bodies.glb";
    folder.taut(command).ends(0);
    assert!(folder.bytes("bodies.glb").starts_with(b"glTF"));
    let obj = folder.text("bodies.obj");
    let places = obj.lines().filter_map(|line| line.strip_prefix("v "));
    let places: Vec<Vec<f64>> =
        places.map(|line| line.split(' ').map(|x| x.parse().unwrap()).collect()).collect();
    assert_eq!(places.len(), 8);
    // Facets end up to a unit of the grid, 2^-22, before the faces of the cube.
    let is_near = |&x: &f64| x.abs().min((x - 2.0).abs()) <= 2f64.powi(-22);
    assert!(places.iter().flatten().all(is_near), "{places:?}");
    let faces = obj.lines().filter_map(|line| line.strip_prefix("f "));
    let volume: f64 = faces
        .map(|line| {
            let corner = |word: &str| &places[word.parse::<usize>().unwrap() - 1];
            let [a, b, c] = [0, 1, 2].map(|k| corner(line.split(' ').nth(k).unwrap()));
            let minor = |i: usize, j: usize| b[i] * c[j] - b[j] * c[i];
            (a[0] * minor(1, 2) + a[1] * minor(2, 0) + a[2] * minor(0, 1)) / 6.0
        })
        .sum();
    // Six faces of area 4, each moved by a unit at most.
    assert!((volume - 8.0).abs() <= 25.0 * 2f64.powi(-22), "facets face outward: {volume}");
}

#[test]
fn parts_are_a_folder_that_names_each_body() {
    let folder = folder();
    let command = "inscribe dops cube.off --count 3 --disjoint --events 3000 --parts parts";
    folder.taut(&format!("{command} -o bodies.json")).ends(0);
    let found: serde_json::Value = serde_json::from_str(&folder.text("bodies.json")).unwrap();
    let bodies = found["answer"]["bodies"].as_array().unwrap().len();
    assert!(bodies > 0);
    let mut names: Vec<_> = std::fs::read_dir(folder.path("parts"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    let mut expected = vec!["bodies.sdf".to_owned(), "bodies.urdf".to_owned()];
    expected.extend((0..bodies).map(|body| format!("body-{body}.obj")));
    assert_eq!(names, expected);
    for (file, before, after) in
        [("bodies.urdf", "filename=\"", "\""), ("bodies.sdf", "<uri>", "</uri>")]
    {
        let text = folder.text(&format!("parts/{file}"));
        let named: Vec<&str> =
            text.split(before).skip(1).filter_map(|rest| rest.split(after).next()).collect();
        assert_eq!(named, expected[2..], "{file}");
        assert_eq!(text.matches("<collision ").count(), bodies);
        assert_eq!(text.matches("</collision>").count(), bodies);
    }
    folder.taut("inscribe dops parts/body-0.obj --events 500").ends(0);
    // The earlier folder is replaced, as it holds such files alone.
    folder.taut("inscribe dops cube.off --events 500 --parts parts").ends(0);
    assert!(!folder.path("parts/body-1.obj").exists());
    assert_eq!(folder.files(), ["bodies.json", "cube.off", "parts"]);
}

#[test]
fn formats_and_folders_that_are_not_written_are_refused_before_any_work() {
    let folder = folder();
    for (name, words) in [
        ("bodies.step", "-o writes .json, .ply, .obj, .off, .stl, .glb"),
        ("bodies.urdf", "-o writes .json, .ply"),
        ("bodies.svg", "draw with --draw bodies.svg"),
    ] {
        folder.taut(&format!("inscribe dops cube.off -o {name}")).ends(2).stderr_has(&[words]);
    }
    std::fs::create_dir(folder.path("mine")).unwrap();
    folder.put("mine/letter.txt", "dear");
    let refused = [
        ("mine", "mine holds `letter.txt`, which would be removed"),
        ("cube.off", "cube.off is a file: name a folder"),
        ("no/where", "no such file or folder"),
    ];
    for (name, words) in refused {
        folder.taut(&format!("inscribe dops cube.off --parts {name}")).ends(2).stderr_has(&[words]);
    }
    let both = "inscribe dops cube.off -o same --parts same";
    folder.taut(both).ends(2).stderr_has(&["named for two outputs"]);
    std::fs::create_dir(folder.path("parts")).unwrap();
    folder.put("parts/body-0.obj", "v 0 0 0\n");
    let command = "inscribe dops parts/body-0.obj --parts parts";
    folder.taut(command).ends(2).stderr_has(&["`parts` holds the input"]);
    assert_eq!(folder.text("parts/body-0.obj"), "v 0 0 0\n");
    assert_eq!(folder.files(), ["cube.off", "mine", "parts"]);
}

#[test]
fn files_of_others_in_an_earlier_folder_of_parts_stay() {
    let folder = folder();
    let command = "inscribe dops cube.off --events 500 --parts parts";
    folder.taut(command).ends(0);
    let body = folder.text("parts/body-0.obj");
    // A body that the lists do not name, an own mesh under a name of theirs, and a list that somebody changed.
    let urdf = folder.text("parts/bodies.urdf");
    for (name, text) in [
        ("parts/body-7.obj", &body),
        ("parts/body-0.obj", &"v 0 0 0\n".to_owned()),
        ("parts/bodies.urdf", &urdf.replace("</link>", "<inertial/></link>")),
    ] {
        let earlier = folder.path(name).exists().then(|| folder.text(name));
        folder.put(name, text);
        folder.taut(command).ends(2).stderr_has(&["parts holds `", "which would be removed"]);
        assert_eq!(&folder.text(name), text);
        match earlier {
            Some(earlier) => folder.put(name, earlier),
            None => std::fs::remove_file(folder.path(name)).unwrap(),
        }
    }
    folder.taut(command).ends(0);
    for within in ["-o parts/bodies.json", "--draw parts/bodies.svg", "-o new/bodies.json"] {
        let parts = if within.contains("new") { "new" } else { "parts" };
        folder
            .taut(&format!("inscribe dops cube.off --events 500 {within} --parts {parts}"))
            .ends(2)
            .stderr_has(&[&format!("lies in `{parts}`, which is replaced as a whole")]);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(folder.path("parts"), folder.path("link")).unwrap();
        folder
            .taut("inscribe dops cube.off --events 500 --parts link")
            .ends(2)
            .stderr_has(&["link is a link: name the folder to which it leads"]);
    }
}
