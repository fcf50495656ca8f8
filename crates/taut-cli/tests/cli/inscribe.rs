//! `taut inscribe ellipsoid`: found, proved, drawn; polytopes without one named with the reason and the rows.

use crate::test_folder::TestFolder;

/// The rectangle [0, 4] × [0, 2].
const SIDES: &str = "a,b,most\n1,0,4\n-1,0,0\n0,1,2\n0,-1,0\n";

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("sides.csv", SIDES);
    folder
}

#[test]
fn the_largest_ellipse_in_a_rectangle_is_that_of_its_half_widths() {
    let folder = folder();
    folder
        .taut("inscribe ellipsoid sides.csv -o inside.json --draw inside.svg")
        .ends(0)
        .stdout_has(&[
            "Largest ellipsoid inside 4 half-spaces in 2 dimensions\n",
            "\n  log-volume 1.837877",
            "\n  center     (2, 1)\n",
            "\n  gap        ",
            "no ellipsoid inside has a log-volume above 1.837877",
            "\n  verified   yes; ",
            "\n  support    4 half-spaces",
            "checking ",
        ]);
    let found: serde_json::Value = serde_json::from_str(&folder.text("inside.json")).unwrap();
    assert_eq!(found["kind"], "inscribed-ellipsoid");
    let near =
        |value: &serde_json::Value, wanted: f64| (value.as_f64().unwrap() - wanted).abs() < 1e-5;
    let answer = &found["answer"];
    assert!(near(&answer["center"][0], 2.0) && near(&answer["center"][1], 1.0), "{answer}");
    assert!(near(&answer["axes"][0][0], 2.0) && near(&answer["axes"][1][1], 1.0), "{answer}");
    let picture = folder.text("inside.svg");
    for part in ["4 half-spaces, d = 2", "polytope", "touching (4 half-spaces)"] {
        assert!(picture.contains(part), "{part}");
    }
    folder
        .taut("verify inside.json sides.csv --epsilon 1e-9")
        .ends(0)
        .stdout_has(&[": inscribed ellipsoid of log-volume 1.837877"]);
    folder.taut("draw inside.json sides.csv -o again.svg").ends(0);
    assert_eq!(folder.text("again.svg"), picture);
}

#[test]
fn the_json_is_one_document_wherever_it_goes() {
    let folder = folder();
    let all = folder.taut("inscribe ellipsoid sides.csv --json").ends(0).out;
    assert_eq!(folder.taut("inscribe ellipsoid sides.csv -o -").ends(0).out, all);
    assert_eq!(folder.taut("inscribe ellipsoid sides.csv --json --threads 1").ends(0).out, all);
    assert_eq!(folder.pipe(SIDES, "inscribe ellipsoid - --json").ends(0).out, all);
    let run = folder.taut("inscribe ellipsoid sides.csv --quiet -o inside.json").ends(0);
    assert_eq!((run.out.as_str(), run.err.as_str()), ("", ""));
    assert_eq!(folder.text("inside.json"), all);
    let run = folder.taut("inscribe ellipsoid sides.csv --no-verify").ends(0);
    assert!(run.out.contains("not checked") && !run.out.contains("yes"), "{}", run.out);
}

#[test]
fn a_budget_and_rounding_end_with_the_gap_they_reached() {
    let folder = folder();
    folder
        .taut("inscribe ellipsoid sides.csv --max-steps 3 -o part.json --draw part.svg")
        .ends(3)
        .stdout_has(&["stopped early by the budget of steps", "verified   yes"]);
    folder.taut("verify part.json sides.csv").ends(0);
    folder.taut("verify part.json sides.csv --epsilon 1e-6").ends(1).stdout_has(&["Rejected: "]);
    // The ellipse also touches where it has no part: thinner gaps than rounding allows are not worse ones.
    folder.put("five.csv", format!("{SIDES}1,1,5\n"));
    for epsilon in ["1e-14", "1e-300"] {
        let line = format!("inscribe ellipsoid five.csv --epsilon {epsilon} --json");
        let gap = folder.taut(&line).ends(3).json()["certificate"]["gap"].as_f64().unwrap();
        assert!(gap < 1e-12, "{epsilon}: {gap:e}");
    }
}

/// Points of a regular polytope around the origin, in each dimension that pictures know.
#[test]
fn pictures_of_every_dimension_hold_what_they_name() {
    let folder = TestFolder::new();
    for (dim, parts) in [
        (1, &["no meaning", "touching (3 half-spaces)"][..]),
        (3, &["touching (7 half-spaces)", "center"]),
        (5, &["Cuts through the center", "column 4"]),
        (9, &["6 of 9 coordinates"]),
    ] {
        let side = |j: usize, sign: i32| {
            let a = (0..dim).map(|k| if k == j { sign } else { 0 }.to_string());
            a.chain([(j + 1).to_string()]).collect::<Vec<_>>().join(",")
        };
        let sides: Vec<String> =
            (0..dim).flat_map(|j| [side(j, 1), side(j, -1)]).chain([side(0, 1)]).collect();
        folder.put("box.csv", sides.join("\n"));
        folder.taut("inscribe ellipsoid box.csv --draw box.html --draw box.html -q").ends(2);
        folder.taut("inscribe ellipsoid box.csv -o box.json --draw box.html -q").ends(0);
        folder.taut("draw box.json box.csv -o box.svg").ends(0);
        let picture = folder.text("box.svg");
        for part in parts {
            // Words are wrapped in captions.
            assert!(part.split(' ').all(|word| picture.contains(word)), "{dim}: {part}");
        }
        assert!(!picture.contains("NaN"), "{dim}");
        assert!(folder.text("box.html").contains("log-volume"));
    }
}

#[test]
fn polytopes_without_a_largest_ellipsoid_are_named_with_the_rows() {
    let folder = folder();
    let around = "1,0,1\n-1,0,1\n0,1,1\n0,-1,1\n";
    folder.put("earlier.json", "earlier");
    for (name, contents, parts) in [
        ("strip", "0,1,1\n0,-1,1\n", &["strip.csv", "is unbounded", "(1, 0)"][..]),
        ("empty", &format!("{around}1,0,-2\n"), &["empty.csv", "no interior point", "rows 2, 5"]),
        (
            "flat",
            &format!("{around}1,0,0\n-1,0,0\n"),
            &["flat.csv", "no interior point", "rows 5, 6"],
        ),
        ("zero", &format!("{around}0,0,3\n"), &["zero.csv", "row 5", "no normal"]),
        ("one", "1\n2\n", &["one.csv", "two columns", "--columns"]),
        (
            "nan",
            &around.replacen("-1,0,1", "-1,NaN,1", 1),
            &["nan.csv", "row 2", "column 1", "NaN"],
        ),
        (
            "inf",
            &around.replacen("-1,0,1", "-1,0,inf", 1),
            &["inf.csv", "row 2", "column 2", "inf"],
        ),
        ("ragged", &around.replacen("-1,0,1", "-1,0", 1), &["ragged.csv", "row 2", "2 columns"]),
        ("nothing", "", &["nothing.csv", "no byte"]),
        ("head", "a,b,c\n", &["head.csv", "no row"]),
    ] {
        let file = format!("{name}.csv");
        folder.put(&file, contents);
        let line = format!("inscribe ellipsoid {file} -o earlier.json --draw new.svg");
        let run = folder.taut(&line).ends(2).stderr_has(parts);
        assert_eq!(run.out, "");
        assert_eq!(folder.text("earlier.json"), "earlier", "{name}");
    }
    assert!(!folder.files().contains(&"new.svg".to_owned()));
}

#[test]
fn wrong_options_are_named() {
    let folder = folder();
    for (line, parts) in [
        ("sides.csv --epsilon 0", &["--epsilon` is 0", "(0, 1)"][..]),
        ("sides.csv --epsilon 1", &["--epsilon` is 1", "(0, 1)"]),
        ("sides.csv --max-steps 0", &["--max-steps` is 0", "at least 1"]),
        ("sides.csv -o sides.csv", &["`sides.csv` is the input"]),
        ("sides.csv -o inside.svg", &["inside.svg: -o writes JSON"]),
        ("sides.csv --draw inside.json", &["inside.json: pictures are"]),
        ("sides.csv -o none/inside.json", &["none/inside.json"]),
        ("sides.csv -o x.json --draw ./x.json", &["pictures are"]),
        ("missing.csv", &["missing.csv: no such file"]),
    ] {
        folder.taut(&format!("inscribe ellipsoid {line}")).ends(2).stderr_has(parts);
    }
    assert!(folder.taut("inscribe").ends(2).err.contains("ellipsoid"));
    assert_eq!(folder.files(), ["sides.csv"]);
    assert_eq!(folder.text("sides.csv"), SIDES);
}
