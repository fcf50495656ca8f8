//! Tables as people keep them: gaps, names, text columns, decimal commas, columns in different units.

use crate::test_folder::TestFolder;

/// As pandas writes a frame with an index, names, a text column and gaps.
const MESSY: &str = ",town,x,y,kind\n0,Ulm,0,0,a\n1,Bonn,10,0,\n2,Kiel,,3,b\n3,Köln,10,10,a\n4,Trier,0,NA,b\n5,Jena,0,10,c\n6,Hof,90,90,c\n";

fn messy() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("towns.csv", MESSY);
    folder
}

#[test]
fn rows_that_lack_a_value_are_refused_with_what_to_do() {
    let folder = messy();
    folder.taut("ball towns.csv --columns x,y").ends(2).stderr_has(&[
        "towns.csv: row 3 (line 4), column 2 (`x`): `` is not a number; ",
        "--missing drop",
    ]);
    folder.taut("ball towns.csv --columns y").ends(2).stderr_has(&["`NA`", "--missing drop"]);
    folder.put("gap.csv", "1,2\nnan,3\n");
    folder.taut("ball gap.csv").ends(2).stderr_has(&["row 2", "--missing drop"]);
    folder.taut("ball gap.csv --missing drop").ends(0).stdout_has(&["1 point in 2 dimensions"]);
    folder.put("none.csv", "x,y\n,1\nNA,2\n");
    folder.taut("ball none.csv --missing drop").ends(2).stderr_has(&["each of its 2 rows"]);
}

#[test]
fn rows_that_are_left_out_are_counted_and_others_keep_their_numbers() {
    let folder = messy();
    let run = folder
        .taut("centers towns.csv -k 1 --outliers 1 --columns x,y --missing drop --id town -o c.json")
        .ends(0)
        .stdout_has(&[
            "5 points in 2 dimensions: 1 center\n",
            "\n  missing     2 (29 %); rows left out, as a value is missing; rows are numbered as in the file\n",
            "; row 7 (Hof)\n",
        ]);
    assert!(!run.out.contains("units"), "{}", run.out);
    let answer: serde_json::Value = serde_json::from_str(&folder.text("c.json")).unwrap();
    assert_eq!(answer["answer"]["outliers"], serde_json::json!([4]));
    let reading = serde_json::json!({ "columns": "x,y", "missing": "drop", "id": "town" });
    assert_eq!(answer["reading"], reading);
    // The choice is known to whoever reads the answer.
    folder.taut("verify c.json towns.csv").ends(0).stdout_has(&["Verified", "missing", "2 (29 %)"]);
    folder.taut("draw c.json towns.csv -o c.svg").ends(0);
    // Another one is another set of points.
    folder.taut("verify c.json towns.csv --columns y,x").ends(1).stdout_has(&["Rejected"]);
    folder.taut("verify c.json towns.csv --missing refuse").ends(2).stderr_has(&["row 3"]);
}

#[test]
fn columns_of_numbers_are_found_among_others() {
    let folder = messy();
    folder
        .taut("ball towns.csv --columns numeric --missing drop --id town -o b.json")
        .ends(0)
        // The index is a column of numbers as well.
        .stdout_has(&["5 points in 3 dimensions"]);
    folder.taut("verify b.json towns.csv").ends(0);
    folder.put("words.csv", "a,b\nu,v\n");
    folder.taut("ball words.csv --columns numeric").ends(2).stderr_has(&["no numeric column"]);
    folder.put("plain.csv", "1,u,2\n3,v,4\n");
    folder.taut("ball plain.csv --columns numeric").ends(0).stdout_has(&["2 points in 2 dim"]);
    folder
        .pipe("x,n,y\n1,u,2\n3,v,4\n", "ball - --columns numeric")
        .ends(0)
        .stdout_has(&["2 points in 2 dimensions"]);
    folder.put("gz.csv", MESSY);
    folder.taut("generate normal -n 20 -d 2 -o points.npy").ends(0);
    folder.taut("ball points.npy --columns numeric").ends(0).stdout_has(&["20 points in 2 dim"]);
}

/// As LibreOffice exports with German settings.
#[test]
fn a_decimal_comma_is_read() {
    let folder = TestFolder::new();
    folder.put("messung.csv", "Name;Länge;Höhe\nA;0,5;-1,25\nB;2,5;1e0\nC;1;0,0\n");
    folder
        .taut("ball messung.csv --decimal , --columns numeric --id Name -o b.json")
        .ends(0)
        .stdout_has(&["3 points in 2 dimensions"]);
    folder.taut("verify b.json messung.csv").ends(0);
    folder.put("same.csv", "0.5,-1.25\n2.5,1\n1,0\n");
    let radius = |line: &str| folder.taut(line).ends(0).json()["answer"]["radius"].clone();
    assert_eq!(
        radius("ball messung.csv --decimal , --columns 1,2 --json"),
        radius("ball same.csv --json")
    );
    folder.put("quoted.csv", "\"0,5\",\"-1,25\"\n\"2,5\",\"1\"\n\"1\",\"0\"\n");
    assert_eq!(radius("ball quoted.csv --decimal , --json"), radius("ball same.csv --json"));
    folder.taut("ball messung.csv --columns 1,2").ends(2).stderr_has(&["`0,5`", "--decimal ,"]);
    folder.put("point.csv", "0.5;1\n");
    folder.taut("ball point.csv --decimal ,").ends(2).stderr_has(&["0.5"]);
}

#[test]
fn nulls_and_nan_of_other_formats_are_left_out_too() {
    let folder = TestFolder::new();
    folder.put("raw.f64", [0.0, 1.0, f64::NAN, 3.0, 3.0, 3.0].map(f64::to_le_bytes).concat());
    let raw = "ball raw.f64 --raw-dim 2 --raw-type f64";
    folder.taut(raw).ends(2).stderr_has(&["row 2", "--missing drop"]);
    folder.taut(&format!("{raw} --missing drop --json -o b.json")).ends(0);
    folder
        .taut("verify b.json raw.f64 --raw-dim 2 --raw-type f64")
        .ends(0)
        .stdout_has(&["2 points in 2 dimensions", "1 (33 %)"]);
    // A pipe is not mapped.
    folder
        .pipe(folder.bytes("raw.f64"), "ball - --raw-dim 2 --type f64 --missing drop")
        .ends(0)
        .stdout_has(&["2 points in 2 dimensions", "1 (33 %)"]);
}

#[test]
fn units_make_columns_comparable_and_are_kept() {
    let folder = TestFolder::new();
    folder.put("people.csv", "income,age\n10000,20\n90000,30\n50000,80\n30000,50\n");
    folder.taut("ball people.csv").ends(0).stdout_has(&[
        "units",
        "the range of income is 1333 times that of age",
        "--scale std",
    ]);
    for unit in ["std", "range", "robust"] {
        let run = folder.taut(&format!("ball people.csv --scale {unit} -o {unit}.json")).ends(0);
        assert!(
            run.out.contains(&format!("  scale     {unit}; columns are divided: income by ")),
            "{}",
            run.out
        );
        assert!(!run.out.contains("units"), "{}", run.out);
        folder.taut(&format!("verify {unit}.json people.csv")).ends(0).stdout_has(&[unit]);
        folder.taut(&format!("draw {unit}.json people.csv -o {unit}.svg")).ends(0);
    }
    // The closed form: over ranges of 80000 and 60 the points are (1/8, 1/3), (9/8, 1/2), (5/8, 4/3), (3/8, 5/6).
    let found: serde_json::Value = serde_json::from_str(&folder.text("range.json")).unwrap();
    let units = found["reading"]["scale"]["units"].as_array().unwrap();
    assert_eq!(
        units.iter().map(|unit| unit.as_f64().unwrap()).collect::<Vec<_>>(),
        [80000.0, 60.0]
    );
    folder.put(
        "scaled.csv",
        "0.125,0.3333333333333333\n1.125,0.5\n0.625,1.3333333333333333\n0.375,0.8333333333333334\n",
    );
    let own = folder.taut("ball scaled.csv --json").ends(0).json();
    let [one, other] = [&own, &found].map(|found| found["answer"]["radius"].as_f64().unwrap());
    assert!((one - other).abs() < 1e-12, "{one} {other}");
    folder.taut("centers people.csv -k 2 --scale std -o c.json").ends(0).stdout_has(&["scale"]);
    folder.taut("verify c.json people.csv").ends(0);
    folder
        .taut("centers people.csv --elbow 1..3 --scale range")
        .ends(0)
        .stdout_has(&["lower bound"]);
    folder.put("discs.csv", "0,0,1\n1,1,1\n");
    folder.taut("ball discs.csv --balls --scale std").ends(2).stderr_has(&["--scale", "--balls"]);
    // Whoever changes the units has another set of points.
    let lie = folder.text("range.json").replace("80000", "70000");
    folder.put("lie.json", lie);
    folder.taut("verify lie.json people.csv").ends(1).stdout_has(&["Rejected"]);
    let lie = folder.text("range.json").replace("80000", "-1");
    folder.put("lie.json", lie);
    folder.taut("verify lie.json people.csv").ends(2).stderr_has(&["not positive"]);
}

#[test]
fn mistyped_numbers_are_not_passed_over() {
    let folder = TestFolder::new();
    folder.put("first.csv", "1O,2,3\n4,5,6\n");
    folder.taut("ball first.csv --columns numeric").ends(2).stderr_has(&["row 1", "`1O`"]);
    folder.put("later.csv", "x,y,z\n4,5,6\n1,2,3\n1O,2,3\n");
    folder
        .taut("ball later.csv --columns numeric")
        .ends(2)
        .stderr_has(&["row 3 (line 4), column 0 (`x`): `1O` is not a number"]);
    // A description counts it among words.
    folder.taut("info later.csv").ends(0).stdout_has(&["\n  x       text "]);
}

#[test]
fn rows_keep_their_numbers_in_a_box() {
    let folder = TestFolder::new();
    folder.put("p.csv", "x,y\n99,99\nNA,1\n0,0\n4,0\n2,1\n");
    folder
        .taut("ball p.csv --missing drop --bounds 0,0,9,9 --table support=s.csv -o b.json")
        .ends(0)
        .stdout_has(&["3 points in 2 dimensions", "1 (20 %)"]);
    let text = folder.text("s.csv");
    let mut rows: Vec<&str> =
        text.lines().skip(1).filter_map(|line| line.split(',').next()).collect();
    rows.sort_unstable();
    assert_eq!(rows, ["2", "3"]);
}

#[test]
fn pages_tell_what_was_left_out() {
    let folder = messy();
    folder.put("far.csv", "town,x,y\nUlm,0,0\nBonn,,0\nKiel,0,3\nHof,90,90\n");
    let line = "centers far.csv -k 1 --outliers 1 --columns x,y --missing drop --id town -o c.json";
    folder.taut(line).ends(0).stdout_has(&["row 4 (Hof)"]);
    folder.taut("draw c.json far.csv -o c.html").ends(0);
    let page = folder.text("c.html");
    assert!(page.contains("1 (25 %); row left out, as a value is missing"));
    folder.taut("centers far.csv --elbow 1..2 --columns x,y --missing drop --draw e.html").ends(0);
    assert!(folder.text("e.html").contains("1 (25 %); row left out"));
}

#[test]
fn the_elbow_tells_what_was_left_out() {
    let folder = messy();
    folder
        .taut("centers towns.csv --columns x,y --missing drop --elbow 1..2 --scale range")
        .ends(0)
        .stdout_has(&["\n  scale ", "\n  missing ", "2 (29 %)"]);
}

#[test]
fn what_an_answer_remembers_can_be_changed() {
    let folder = messy();
    let line = "ball towns.csv --columns x,y --missing drop --id town -o b.json";
    folder.taut(line).ends(0);
    // Names are no part of an answer.
    folder.put("bare.csv", "x,y\n0,0\n10,0\n10,10\n0,10\n90,90\n");
    folder.taut("verify b.json bare.csv").ends(0).stdout_has(&["Verified"]);
    folder.taut("verify b.json bare.csv --id town").ends(2).stderr_has(&["no column `town`"]);
    for (word, wrong) in [("\"drop\"", "\"dorp\""), ("\"missing\"", "\"decimal\"")] {
        let text = folder.text("b.json");
        let lie = text.replacen(word, wrong, 1);
        assert_ne!(lie, text);
        folder.put("lie.json", lie);
        folder.taut("verify lie.json towns.csv").ends(2).stderr_has(&["lie.json: key `"]);
        folder.taut("draw lie.json towns.csv -o x.svg").ends(2).stderr_has(&["lie.json: key `"]);
    }
}

#[test]
fn a_unit_beyond_double_precision_is_refused() {
    let folder = TestFolder::new();
    folder.put("far.csv", "x,y\n-1.7e308,0\n1.7e308,1\n");
    for unit in ["range", "std", "robust"] {
        folder
            .taut(&format!("ball far.csv --scale {unit}"))
            .ends(2)
            .stderr_has(&["far.csv", "of column 0 is too large"]);
    }
}

#[test]
fn names_of_rows_are_not_dropped_unsaid() {
    let folder = TestFolder::new();
    folder.put("p.csv", "town,x,id\nUlm,0,1\nHof,2,3\n");
    folder
        .taut("memory order p.csv --id town -o o.csv --ordered s.csv")
        .ends(2)
        .stderr_has(&["--ordered", "--id"]);
    folder.taut("memory order p.csv --id town -o o.csv").ends(0);
    assert!(folder.text("o.csv").starts_with("row,id\n"));
    folder.taut("convert p.csv --id town -o c.csv").ends(0);
    assert_eq!(folder.text("c.csv"), "id_,x,id\nUlm,0,1\nHof,2,3\n");
}
