//! `taut centers`: the summary, the JSON, the table by k, and how runs end.

use crate::test_folder::TestFolder;

/// Two groups of four, at (0, 0) to (0, 2) and (9, 0) to (9, 1): two centers have radius 1.
const TOWNS: &str = "x,y\n0,0\n0,2\n9,0\n9,1\n0,1\n9,0.5\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("towns.csv", TOWNS);
    folder
}

fn close(value: &serde_json::Value, wanted: f64) {
    let value = value.as_f64().unwrap();
    assert!((value - wanted).abs() <= 1e-5 * wanted.abs().max(1.0), "{value}, not {wanted}");
}

#[test]
fn the_summary_names_every_number() {
    let run = folder().taut("centers towns.csv -k 2 --epsilon 1e-6").ends(0).stdout_has(&[
        "6 points in 2 dimensions: 2 centers\n",
        "\n  centers     (",
        "(0, 1)\n",
        "\n  radius      1",
        "\n  lower bound ",
        "no 2 centers have a smaller radius\n",
        "\n  gap         ",
        "\n  verified    yes; every point is in a ball, and the gap is proved\n",
        "\n  method      tree; converged\n",
        "\n  nodes       ",
        "\n  core-set    ",
        "\n  passes      ",
        "s; reading ",
        ", checking ",
    ]);
    assert_eq!(run.err, "");
}

#[test]
fn the_json_is_one_document_with_the_names_at_the_door() {
    let folder = folder();
    let line = "centers towns.csv -k 2 --epsilon 1e-6 --assignment";
    let run = folder.taut(&format!("{line} --json -o centers.json")).ends(0);
    let document = run.json();
    assert_eq!(document["kind"], "centers");
    let answer = &document["answer"];
    assert_eq!(answer["centers"].as_array().unwrap().len(), 2);
    close(&answer["radius"], 1.0);
    close(&answer["lower_bound"], 1.0);
    let next: Vec<u64> =
        answer["assignment"].as_array().unwrap().iter().map(|c| c.as_u64().unwrap()).collect();
    assert_eq!(next.len(), 6);
    assert!(next[0] == next[1] && next[0] == next[4] && next[2] == next[3] && next[0] != next[2]);
    assert_eq!(document["certificate"]["k"], 2);
    assert_eq!(folder.text("centers.json"), run.out);
    for option in ["-o -", "--json --threads 1", "--json --threads 3"] {
        assert_eq!(folder.taut(&format!("{line} {option}")).ends(0).out, run.out, "{option}");
    }
    let quiet = folder.taut(&format!("{line} --quiet -o quiet.json")).ends(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
    assert_eq!(folder.text("quiet.json"), run.out);
    let run = folder.taut("centers towns.csv -k 2 --no-verify").ends(0);
    assert!(run.out.contains("not checked") && !run.out.contains("yes"), "{}", run.out);
}

/// Three segments, each given by its ends; the column in the middle names them.
const ENDS: &str = "x,house,y\n0,7,0\n9,8,0\n0,7,6\n9,8,2\n1,9,1\n1,9,2\n";

#[test]
fn groups_are_held_whole() {
    let folder = TestFolder::new();
    folder.put("ends.csv", ENDS);
    let line = "centers ends.csv -k 2 --epsilon 1e-6";
    for column in ["house", "1"] {
        folder
            .taut(&format!("{line} --group {column} --assignment -o found.json --draw found.svg"))
            .ends(0)
            .stdout_has(&[
                "6 points, grouped by column 1, in 2 dimensions: 2 centers\n",
                "radius      3",
                "yes; every point is in a ball, all of a group of one, and the gap is proved\n",
            ]);
        let document: serde_json::Value = serde_json::from_str(&folder.text("found.json")).unwrap();
        assert_eq!(document["certificate"]["group"], 1);
        assert!(document["certificate"]["core_set"].as_array().unwrap().len() > 1);
        let next = &document["answer"]["assignment"];
        assert!(next[0] == next[2] && next[1] == next[3] && next[4] == next[5], "{next}");
        folder.taut("verify found.json ends.csv").ends(0);
        let picture = folder.text("found.svg");
        assert!(picture.contains("of center "));
    }
    let without = folder.taut(&format!("{line} --columns x,y --json")).ends(0).json();
    assert!(without["certificate"].get("group").is_none());
    let run = folder.taut("centers ends.csv -k 1 --group house --outliers 1 --json").ends(0).json();
    assert_eq!(run["answer"]["outliers"].as_array().unwrap().len(), 2);
    folder.put("other.csv", ENDS.replace("0,7,6", "0,8,6"));
    folder.taut("verify found.json other.csv").ends(1);
    folder.taut("centers ends.csv --elbow 1..3 --group house").ends(0);
}

/// Discs of radius 2 and 1, the one within the other, and an ellipse with half axes 1 and 3.
const ELLIPSES: &str = "x,y,a,b,c\n0,0,4,0,4\n1,0,1,0,1\n9,0,1,0,9\n";

#[test]
fn ellipsoids_are_held_whole() {
    let folder = TestFolder::new();
    folder.put("ellipses.csv", ELLIPSES);
    let line = "centers ellipses.csv -k 2 --ellipsoids --epsilon 1e-6";
    folder.taut(&format!("{line} --assignment -o found.json --draw found.svg")).ends(0).stdout_has(
        &[
            "3 ellipsoids in 2 dimensions: 2 centers\n",
            "radius      3",
            "yes; every ellipsoid is in a ball, and the gap is proved\n",
            "core-set    ",
            " points of ",
            " ellipsoid",
        ],
    );
    let document: serde_json::Value = serde_json::from_str(&folder.text("found.json")).unwrap();
    let list = |of: &str, name: &str| document[of][name].as_array().unwrap().clone();
    assert_eq!(document["certificate"]["items"], "ellipsoids");
    assert_eq!(list("certificate", "directions").len(), list("certificate", "core_set").len());
    let next = list("answer", "assignment");
    assert!(next[0] == next[1] && next[1] != next[2], "{next:?}");
    folder.taut("verify found.json ellipses.csv").ends(0).stdout_has(&["3 ellipsoids"]);
    folder.taut("draw found.json ellipses.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), folder.text("found.svg"));
    assert!(folder.text("found.svg").contains("ellipsoid"));
    folder.put("other.csv", ELLIPSES.replace("9,0,1,0,9", "9,0,1,0,9.01"));
    folder.taut("verify found.json other.csv").ends(1);
    let out = "centers ellipses.csv -k 1 --ellipsoids --outliers 1 --json";
    assert_eq!(folder.taut(out).ends(0).json()["answer"]["outliers"][0], 2);
    folder.taut("centers ellipses.csv --elbow 1..3 --ellipsoids").ends(0);
    let refused = |line: &str, words: &[&str]| {
        let run = folder.taut(line).ends(2);
        words.iter().for_each(|word| assert!(run.err.contains(word), "{line}: {}", run.err));
    };
    for option in ["--balls", "--weights", "--discrete", "--group x"] {
        let name = option.split(' ').next().unwrap();
        refused(&format!("{line} {option}"), &["--ellipsoids", name]);
    }
    for method in ["thesis", "farthest-first", "stream"] {
        refused(&format!("{line} --method {method}"), &["--ellipsoids", method]);
    }
    refused("centers ellipses.csv -k 1 --ellipsoids --columns x,y,a", &["d(d + 3)/2"]);
    folder.put("bad.csv", ELLIPSES.replace("9,0,1,0,9", "9,0,1,4,9"));
    refused("centers bad.csv -k 1 --ellipsoids", &["row 3", "positive semidefinite"]);
}

#[test]
fn groups_that_are_not_there_are_named() {
    let folder = TestFolder::new();
    folder.put("ends.csv", ENDS);
    folder.put("words.csv", "x,y,house\n0,1,red\n");
    folder.put("gaps.csv", "x,y,house\n0,1,1\n2,3,\n");
    folder.put("nan.csv", "x,y,house\n0,1,1\n2,3,NaN\n");
    let refused = |line: &str, words: &[&str]| {
        let run = folder.taut(line).ends(2);
        words.iter().for_each(|word| assert!(run.err.contains(word), "{line}: {}", run.err));
    };
    refused("centers ends.csv -k 2 --group color", &["--group color", "x, house, y"]);
    refused("centers ends.csv -k 2 --group 3", &["--group 3", "x, house, y"]);
    refused("centers ends.csv -k 2 --columns x,y --group house", &["--group house", "x, y"]);
    refused("centers words.csv -k 1 --group house", &["red"]);
    refused("centers gaps.csv -k 1 --group house", &["gaps.csv", "3"]);
    refused("centers nan.csv -k 1 --group house", &["nan.csv", "NaN"]);
    refused("centers ends.csv -k 1 --group house --outliers 3", &["outliers"]);
    refused("centers ends.csv -k 1 --group house --method stream", &["--group"]);
    refused("centers ends.csv -k 1 --group house --method thesis", &["--group"]);
}

#[test]
fn answers_are_verified_and_lies_rejected() {
    let folder = folder();
    folder.taut("centers towns.csv -k 2 --epsilon 1e-6 -o centers.json").ends(0);
    folder.taut("verify centers.json towns.csv --epsilon 1e-6").ends(0).stdout_has(&[
        "Verified within a gap of ",
        ": centers, k = 2, anywhere, of radius 1",
        ", around 6 points in 2 dimensions\n",
        "\n  centers   2, anywhere; proved: of at most 2\n",
        "\n  left out  none; proved\n",
        " ≤ least radius ≤ ",
        "\n  branches ",
    ]);
    folder.taut("verify centers.json towns.csv --epsilon 1e-30").ends(1).stdout_has(&["Rejected"]);
    let sound: serde_json::Value = serde_json::from_str(&folder.text("centers.json")).unwrap();
    let lie = |change: &dyn Fn(&mut serde_json::Value)| {
        let mut document = sound.clone();
        change(&mut document);
        folder.put("lie.json", document.to_string());
        folder.taut("verify lie.json towns.csv").ends(1).stdout_has(&["Rejected: "]).out
    };
    let smaller = lie(&|found| {
        for key in ["radius", "lower_bound"] {
            let value = found["answer"][key].as_f64().unwrap();
            found["answer"][key] = (0.99 * value).into();
        }
    });
    assert!(smaller.contains("towns.csv, row 1: point 0 reaches "), "{smaller}");
    lie(&|found| {
        found["answer"]["radius"] = 2.0.into();
        found["answer"]["lower_bound"] = 2.0.into();
    });
    lie(&|found| found["answer"]["lower_bound"] = 0.5.into());
    lie(&|found| found["answer"]["outliers"] = serde_json::json!([0]));
    lie(&|found| found["answer"]["assignment"] = serde_json::json!([0, 1, 0, 1, 0, 1]));
    lie(&|found| found["answer"]["centers"][0] = serde_json::json!([0.0, 1.0, 2.0]));
    lie(&|found| found["certificate"]["core_set"] = serde_json::json!([0]));
    lie(&|found| found["certificate"]["k"] = 1.into());
    folder.put("other.csv", TOWNS.replace("9,1", "9,1.25"));
    folder
        .taut("verify centers.json other.csv")
        .ends(1)
        .stdout_has(&["Rejected: other.csv", "hash"]);
    folder.put("short.csv", "0\n1\n");
    folder
        .taut("verify centers.json short.csv")
        .ends(1)
        .stdout_has(&["short.csv does not belong to"]);
}

#[test]
fn centers_among_the_points_are_named_by_their_rows() {
    let folder = folder();
    folder
        .taut("centers towns.csv -k 2 --discrete --epsilon 0 --assignment -o centers.json")
        .ends(0)
        .stdout_has(&["2 centers among them\n", "(0, 1); row 5, next to 3 points\n", "(9, "]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("centers.json")).unwrap();
    // Of the places around (9, 0.5) each is near enough to the others.
    let mut rows: Vec<u64> =
        found["answer"]["rows"].as_array().unwrap().iter().map(|r| r.as_u64().unwrap()).collect();
    rows.sort_unstable();
    assert!([[2, 4], [3, 4], [4, 5]].iter().any(|pair| rows == pair), "{rows:?}");
    close(&found["answer"]["radius"], 1.0);
    folder
        .taut("verify centers.json towns.csv")
        .ends(0)
        .stdout_has(&["\n  centers   2, among the points; proved: of at most 2\n"]);
}

#[test]
fn outliers_weights_and_balls_are_asked_for() {
    let folder = folder();
    folder.put("far.csv", format!("{TOWNS}500,0\n"));
    folder.taut("centers far.csv -k 2 --outliers 1 --epsilon 1e-6 -o out.json").ends(0).stdout_has(
        &["\n  left out    1; row 7\n", "no point that counts is farther", "\n  radius      1"],
    );
    folder
        .taut("verify out.json far.csv")
        .ends(0)
        .stdout_has(&["\n  left out  1 (14 %); proved: of at most 1 point\n"]);
    folder.put("heavy.csv", "x,w\n0,2\n3,1\n");
    folder
        .taut("centers heavy.csv -k 1 --weights --epsilon 1e-9 -o heavy.json")
        .ends(0)
        .stdout_has(&["2 points with weights in 1 dimension: 1 center\n", "\n  center      (1"]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("heavy.json")).unwrap();
    close(&found["answer"]["radius"], 2.0);
    folder
        .taut("verify heavy.json heavy.csv")
        .ends(0)
        .stdout_has(&[", around 2 points with weights in 1 dimension\n"]);
    folder.put("discs.csv", "x,y,r\n0,0,1\n4,0,2\n100,0,3\n");
    folder
        .taut("centers discs.csv -k 2 --balls --epsilon 1e-9 -o discs.json")
        .ends(0)
        .stdout_has(&["3 balls in 2 dimensions: 2 centers\n", "every ball is in a ball"]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("discs.json")).unwrap();
    close(&found["answer"]["radius"], 3.5);
    folder
        .taut("verify discs.json discs.csv")
        .ends(0)
        .stdout_has(&[", around 3 balls in 2 dimensions\n"]);
}

#[test]
fn all_methods_end_in_a_proof() {
    let folder = TestFolder::new();
    folder.taut("generate clusters -n 500 -d 2 --seed 3 -o points.npy").ends(0);
    for (method, most) in [
        ("tree", "0.01"),
        ("thesis", "0.01"),
        ("farthest-first", "1.000000001"),
        ("stream", "1.97"),
    ] {
        folder
            .taut(&format!("centers points.npy -k 4 --method {method} -o found.json"))
            .ends(0)
            .stdout_has(&[&format!("\n  method      {method}; converged\n"), "verified    yes"]);
        folder.taut(&format!("verify found.json points.npy --epsilon {most}")).ends(0);
    }
}

/// Two passes, one to look and one to measure; centers that are rows are named on request.
#[test]
fn a_stream_is_read_twice() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 100000 -d 3 --seed 4 -o points.npy").ends(0);
    folder
        .taut("centers points.npy -k 7 --method stream --discrete -o found.json")
        .ends(0)
        .stdout_has(&["\n  passes      2\n", "; row ", "verified    yes"]);
    folder.taut("verify found.json points.npy --epsilon 1.97").ends(0);
}

#[test]
fn a_stop_by_the_budget_of_nodes_tells_the_gap_it_reached() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 500 -d 2 --seed 3 -o points.npy").ends(0);
    folder
        .taut("centers points.npy -k 9 --epsilon 1e-6 --max-nodes 3 -o found.json")
        .ends(3)
        .stdout_has(&["stopped early by the budget of nodes", "verified    yes"]);
    folder.taut("verify found.json points.npy").ends(0);
    let quick = "centers points.npy --elbow 8..9 --epsilon 1e-6 --max-nodes 3";
    folder.taut(quick).ends(3).stdout_has(&["stopped early"]);
}

#[test]
fn the_elbow_is_a_table_a_file_and_a_plot() {
    let folder = folder();
    folder
        .taut("centers towns.csv --elbow 1..6 --epsilon 1e-6 -o elbow.csv --draw elbow.svg")
        .ends(0)
        .stdout_has(&[
            "Radius by number of centers of 6 points\n",
            "\n  k  radius",
            "\n  2  1 ",
            "verified",
        ]);
    let table = folder.text("elbow.csv");
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| {
            line.replace("converged", "1").split(',').map(|cell| cell.parse().unwrap()).collect()
        })
        .collect();
    assert!(table.starts_with("k,radius,lower_bound,gap,stop,nodes,core_set\n"));
    assert_eq!(rows.iter().map(|row| row[0]).collect::<Vec<_>>(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    assert!(rows.iter().all(|row| row[2] <= row[1] && row[1] <= (1.0 + 1e-6) * row[2]));
    assert!(rows.iter().all(|row| (0.0..=1e-6).contains(&row[3])));
    assert_eq!((rows[1][1], rows[5][1], rows[5][2]), (1.0, 0.0, 0.0));
    let picture = folder.text("elbow.svg");
    for part in ["Radius by number of centers", "radius found", "lower bound: proved"] {
        assert!(picture.contains(part), "{part}");
    }
    folder.taut("centers towns.csv --elbow 2..3 --draw elbow.html --quiet").ends(0);
    assert!(folder.text("elbow.html").contains("k = 3"));
    let run = folder.taut("centers towns.csv --elbow 2..3 -o -").ends(0);
    assert!(run.out.starts_with("k,radius,") && run.out.lines().count() == 3, "{}", run.out);
}

#[test]
fn the_elbow_ends_where_the_radius_does_and_says_how_far_it_is() {
    let folder = folder();
    let run = folder
        .taut("centers towns.csv --elbow 4..900 --epsilon 1e-6 -o elbow.csv --progress always")
        .ends(0)
        .stdout_has(&["\n  ended     at k = 6; the radius is 0, and is for every larger k\n"]);
    assert_eq!(folder.text("elbow.csv").lines().count(), 4);
    for part in ["k = 4: radius 0.", "k = 5: radius 0.", "k = 6: radius 0, gap 0; converged"] {
        assert!(run.err.contains(part), "{part} in {}", run.err);
    }
    let run = folder.taut("centers towns.csv --elbow 1..1001").ends(2);
    assert!(run.err.contains("at most 1000 values of k"), "{}", run.err);
}

/// Searches that are stopped at once may end with a larger radius than those for fewer centers; the table does not.
#[test]
fn the_elbow_never_rises() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 300 -d 2 --seed 5 -o points.npy").ends(0);
    folder
        .taut("centers points.npy --elbow 1..30 --epsilon 1e-6 --max-nodes 0 -o elbow.csv")
        .ends(3);
    let table = folder.text("elbow.csv");
    let column = |i: usize| -> Vec<f64> {
        table.lines().skip(1).map(|line| line.split(',').nth(i).unwrap().parse().unwrap()).collect()
    };
    let (radii, bounds, gaps) = (column(1), column(2), column(3));
    assert!(radii.is_sorted_by(|a, b| a >= b) && bounds.is_sorted_by(|a, b| a >= b), "{table}");
    for ((radius, bound), gap) in radii.iter().zip(&bounds).zip(&gaps) {
        assert!(radius <= &(bound * (1.0 + gap)) && bound <= radius, "{table}");
    }
    assert!(table.contains(",node-budget,"), "{table}");
}

#[test]
fn centers_are_drawn_with_their_circles_and_what_is_left_out() {
    let folder = folder();
    folder.put("far.csv", format!("{TOWNS}500,0\n"));
    folder.taut("centers far.csv -k 2 --outliers 1 -o found.json --draw found.svg").ends(0);
    let picture = folder.text("found.svg");
    for part in
        ["Centers of 7 points, k = 2, d = 2", "the 2 circles", "core-set (", "left out (1 point)"]
    {
        assert!(picture.contains(part), "{part}");
    }
    assert!(!picture.contains("NaN"));
    folder.taut("draw found.json far.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
    folder.put("other.csv", TOWNS);
    folder.taut("draw found.json other.csv -o other.svg").ends(1).stderr_has(&["other.csv"]);
    folder.taut("generate normal -n 200 -d 3 -o space.npy").ends(0);
    folder.taut("centers space.npy -k 3 --epsilon 0.1 --draw space.html").ends(0);
    assert!(folder.text("space.html").contains("the 3 spheres"));
    folder.taut("generate normal -n 200 -d 6 -o six.npy").ends(0);
    folder.taut("centers six.npy -k 2 --method farthest-first --draw six.svg").ends(0);
    assert!(folder.text("six.svg").contains("shadows of the balls"));
    assert!(!folder.files().contains(&"other.svg".to_owned()));
}

#[test]
fn wrong_input_and_options_are_named_and_nothing_is_written() {
    let folder = folder();
    folder.put("nan.csv", TOWNS.replace("9,1", "9,NaN"));
    folder.put("hole.csv", "x,y,r\n0,0,1\n1,1,-2\n");
    folder.put("light.csv", "x,w\n0,1\n1,0\n");
    folder.put("one.csv", "x\n1\n2\n");
    folder.put("found.json", "earlier");
    for (line, parts) in [
        ("towns.csv", &["-k"][..]),
        ("towns.csv -k 0", &["`--k` is 0", "at least 1"]),
        ("towns.csv -k -2", &["-2"]),
        ("towns.csv -k 2 --epsilon 1", &["--epsilon` is 1", "[0, 1)"]),
        ("towns.csv -k 2 --outliers 6", &["--outliers` is 6", "less than"]),
        ("towns.csv -k 2 --method lloyd", &["lloyd", "tree, thesis, farthest-first, stream"]),
        ("towns.csv -k 2 --method stream --balls", &["--balls", "stream"]),
        ("towns.csv -k 2 --method stream --assignment", &["--assignment", "stream"]),
        ("towns.csv -k 2 --method thesis --discrete", &["--discrete", "thesis"]),
        ("towns.csv -k 2 --method thesis --outliers 1", &["--outliers", "thesis"]),
        ("towns.csv -k 2 --weights --balls", &["--weights", "--balls"]),
        ("towns.csv -k 2 --elbow 1..3", &["--elbow"]),
        ("towns.csv --elbow 3..1", &["such as 2..8"]),
        ("nan.csv -k 2", &["nan.csv", "row 4", "`y`", "NaN"]),
        ("hole.csv -k 2 --balls", &["hole.csv", "`r`", "-2", "at least 0"]),
        ("light.csv -k 1 --weights", &["light.csv", "`w`", "weight is 0", "more than 0"]),
        ("one.csv -k 1 --weights", &["one.csv", "at least two columns", "--weights"]),
        ("one.csv -k 1 --balls", &["one.csv", "at least two columns", "--balls"]),
        ("gone.csv -k 1", &["gone.csv"]),
    ] {
        let run = folder.taut(&format!("centers {line} -o found.json")).ends(2);
        assert!(parts.iter().all(|part| run.err.contains(part)), "{parts:?} in {run:?}");
        assert_eq!(run.out, "", "{line}");
    }
    assert_eq!(folder.text("found.json"), "earlier");
}
