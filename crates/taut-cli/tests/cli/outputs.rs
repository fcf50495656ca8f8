//! What goes out: the extension chooses, tables hold parts of answers, and `--json` says what the summary says.

use serde_json::json;

use crate::test_folder::TestFolder;

const TOWNS: &str = "town,x,y\nUlm,0,0\nBonn,1,0\nKiel,,3\nHof,10,10\nJena,11,10\nGera,40,40\n";

const READING: &str = "towns.csv --missing drop --id town";

fn towns() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("towns.csv", TOWNS);
    folder
}

/// The shape and the values of a NumPy array of whole numbers.
fn whole_array(bytes: &[u8]) -> (String, Vec<i64>) {
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let header = String::from_utf8_lossy(&bytes[10..10 + length]).into_owned();
    assert!(header.contains("'<i8'"), "{header}");
    let shape = header.split("'shape': ").nth(1).unwrap().split(", }").next().unwrap().to_owned();
    let values =
        bytes[10 + length..].chunks(8).map(|raw| i64::from_le_bytes(raw.try_into().unwrap()));
    (shape, values.collect())
}

#[test]
fn parts_of_answers_are_tables_by_extension() {
    let folder = towns();
    let tables =
        "--table assignment=a.csv --table outliers=o.csv --table core-set=c.npy -o centers.csv";
    folder.taut(&format!("centers {READING} -k 2 --outliers 1 --discrete {tables}")).ends(0);
    // Rows are those of the file: the row without x is the third.
    let centers = folder.text("centers.csv");
    assert!(centers.starts_with("center,row,x,y\n"), "{centers}");
    assert_eq!(centers.lines().count(), 3);
    let assignment = folder.text("a.csv");
    let rows: Vec<&str> = assignment.lines().map(|line| line.rsplit_once(',').unwrap().0).collect();
    assert_eq!(rows, ["row,id", "0,Ulm", "1,Bonn", "3,Hof", "4,Jena", "5,Gera"]);
    let center: Vec<&str> =
        assignment.lines().skip(1).map(|line| line.rsplit_once(',').unwrap().1).collect();
    assert!(center[0] == center[1] && center[2] == center[3] && center[0] != center[2]);
    assert_eq!(folder.text("o.csv"), "row,id\n5,Gera\n");
    let (shape, core_set) = whole_array(&folder.bytes("c.npy"));
    assert_eq!(shape, format!("({},)", core_set.len()));
    assert!(core_set.iter().all(|row| [0, 1, 3, 4, 5].contains(row)));
}

#[test]
fn other_answers_have_tables_too() {
    let folder = towns();
    folder.taut(&format!("ball {READING} --table support=s.csv")).ends(0);
    assert_eq!(folder.text("s.csv"), "row,id\n0,Ulm\n5,Gera\n");
    folder.put(
        "people.csv",
        (0..40).map(|i| format!("{},{}\n", i % 7, i % 5)).collect::<String>() + "90,90\n",
    );
    folder.taut("ellipsoid people.csv --robust mcd --table outliers=o.npy").ends(0);
    assert_eq!(whole_array(&folder.bytes("o.npy")), ("(1,)".to_owned(), vec![40]));
    folder.taut("memory order people.csv -o order.npy").ends(0);
    let (shape, mut order) = whole_array(&folder.bytes("order.npy"));
    order.sort();
    assert_eq!((shape.as_str(), order), ("(41,)", (0..41).collect()));
    let first = folder.taut("centers people.csv -k 3 --method farthest-first -o far.tsv").ends(0);
    assert!(first.out.contains("farthest-first"), "{}", first.out);
    assert!(folder.text("far.tsv").starts_with("center\t"), "{}", folder.text("far.tsv"));
    if cfg!(feature = "arrow") {
        folder.taut("memory order people.csv -o order.parquet").ends(0);
        let order = folder.taut("info order.parquet --json").ends(0).json();
        let column =
            json!({ "name": "row", "type": "whole", "missing": 0, "least": 0.0, "largest": 40.0 });
        assert_eq!((&order["rows"], &order["columns"][0]), (&json!(41), &column));
    }
}

#[test]
fn extensions_that_are_not_written_are_refused() {
    let folder = towns();
    for (line, parts) in [
        ("ball points.npy -o b.ply", &["b.ply", "JSON", "ply"][..]),
        ("ball points.npy -o b.csv", &["b.csv", "JSON"]),
        ("ball points.npy -o b.foo", &["b.foo", ".json"]),
        ("centers points.npy -k 2 -o c.ply", &["c.ply", ".csv", ".npy"]),
        ("centers points.npy --elbow 1..2 -o c.ply", &["c.ply", ".json"]),
        ("memory order points.npy -o o.svg", &["o.svg"]),
        ("curve points.npy -o c.npy", &["c.npy"]),
        ("surface points.npy -o s.csv", &["s.csv", ".ply"]),
        ("ball points.npy --table support=s.ply", &["s.ply", ".csv"]),
        ("ball points.npy --table centers=s.csv", &["centers", "support"]),
        ("ball points.npy --table support", &[]),
        ("centers points.npy -k 2 --table order=o.csv", &["order", "assignment"]),
    ] {
        folder.taut("generate normal -n 30 -d 2 -o points.npy").ends(0);
        let before = folder.files();
        let run = folder.taut(line).ends(2);
        assert!(parts.iter().all(|part| run.err.contains(part)), "{line}: {run:?}");
        assert_eq!(folder.files(), before, "{line}");
    }
}

#[test]
fn verdicts_are_json_with_the_names_of_the_libraries() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 30 -d 2 -o points.npy").ends(0);
    folder.taut("ball points.npy -o ball.json").ends(0);
    let found = folder.taut("verify ball.json points.npy --json").ends(0).json();
    assert_eq!((&found["verified"], &found["kind"]), (&json!(true), &json!("ball")));
    let [gap, lower, upper] =
        [&found["gap"], &found["verdict"]["lower"], &found["verdict"]["upper"]]
            .map(|x| x.as_f64().unwrap());
    assert!(gap < 1e-8 && lower <= upper, "{found}");
    folder.taut("generate normal -n 31 -d 2 -o other.npy").ends(0);
    let found = folder.taut("verify ball.json other.npy --json -q").ends(1).json();
    assert_eq!(found["verified"], json!(false));
    assert!(found["reason"].as_str().unwrap().contains("does not belong"), "{found}");
    folder.taut("delaunay points.npy -o mesh.ply -q").ends(0);
    let found = folder.taut("verify mesh.ply points.npy --json").ends(0).json();
    assert_eq!((&found["kind"], &found["gap"]), (&json!("delaunay"), &json!(null)));
    let table = folder.taut("centers points.npy --elbow 1..3 --json").ends(0).json();
    assert_eq!(table.as_array().unwrap().len(), 3);
    assert_eq!(table[2]["k"], json!(3));
    folder.taut("centers points.npy --elbow 1..3 -o e.json").ends(0);
    assert_eq!(folder.text("e.json"), folder.taut("centers points.npy --elbow 1..3 --json").out);
}

/// Names of earlier releases are understood, although no help shows them.
#[test]
fn old_names_of_options_are_still_understood() {
    let folder = TestFolder::new();
    folder.put("raw.f64", [0.0, 1.0, 2.0, 3.0].map(f64::to_le_bytes).concat());
    folder.taut("ball raw.f64 --raw-dim 2 --raw-type f64").ends(0);
    folder.taut("ball raw.f64 --raw-dim 2 --type f64").ends(0);
    folder.taut("memory order raw.f64 --raw-dim 2 --type f64 --points sorted.csv").ends(0);
    let help = folder.taut("memory order --help").ends(0).out;
    assert!(help.contains("--ordered") && !help.contains("--points"), "{help}");
}

/// The libraries have other names for some options.
#[test]
fn errors_name_options_as_the_command_line_does() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 40 -d 3 -o points.npy").ends(0);
    folder.taut("ball points.npy -o b.json").ends(0);
    folder.put("ring.csv", "0,0\n4,0\n4,3\n0,3\n");
    folder.put("labels.csv", "x,y,kind\n0,0,a\n1,0,a\n0,5,b\n1,5,b\n");
    for (line, said) in [
        ("surface points.npy --method hull --shrink 2", "`--shrink` is 2"),
        ("surface points.npy --shrink 0.1", "--shrink is of --method "),
        ("ellipsoid points.npy --robust mcd --keep 2", "`--keep` is 2"),
        (
            "inscribe ellipse ring.csv --method thesis --contact-angle 100",
            "`--contact-angle` is 100",
        ),
        ("inscribe ellipse ring.csv --contact-angle 10", "--contact-angle is of --method "),
        ("draw b.json points.npy -o b.svg --image-width 1", "`--image-width` is 1"),
        ("generate clusters -n 5 -d 2 --clusters 0 -o x.csv", "`--clusters` is 0"),
        ("generate normal -n 5 -d 2 --clusters 3 -o x.csv", "--clusters belongs to"),
        (
            "generate curve -n 5 -d 2 --shape circle --outlier-share 2 -o x.csv",
            "`--outlier-share` is 2",
        ),
        ("inscribe dops points.npy --method thesis --max-events 9", "--max-events is of --method "),
        ("memory simulate transpose -n 8 --memory-sizes 16 --block 64", "`--memory-sizes` is 16"),
        ("memory simulate --thesis-figure 44", "`--thesis-figure` is 44"),
        ("memory transpose points.npy -o x.npy --row-count 3", "--row-count belongs to raw files"),
    ] {
        folder.taut(line).ends(2).stderr_has(&[said]);
    }
    let line = "classify train labels.csv --label kind --method svdd --kernel-width gamma=-1";
    let run = folder.taut(&format!("{line} --model m.json")).ends(2);
    assert!(run.err.contains("--kernel-width"), "{}", run.err);
}

#[test]
fn texts_are_json_where_their_name_or_an_option_says_so() {
    let folder = TestFolder::new();
    folder.put("points.csv", "0,0\n1,0\n0,2\n");
    let counts = "memory simulate transpose -n 8 --memory-sizes 4K --block 64";
    for (line, text) in [("near points.csv --diameter", "csv"), (counts, "csv")] {
        let json = folder.taut(&format!("{line} --json")).ends(0).out;
        serde_json::from_str::<serde_json::Value>(&json).unwrap();
        folder.taut(&format!("{line} -o found.json")).ends(0);
        assert_eq!(folder.text("found.json"), json, "{line}");
        folder.taut(&format!("{line} -o found.{text}")).ends(0);
        assert_ne!(folder.text(&format!("found.{text}")), json, "{line}");
        folder.taut(&format!("{line} -o found.ply")).ends(2).stderr_has(&["found.ply", ".json"]);
        let both = format!("{line} --json -o found.{text}");
        folder.taut(&both).ends(2).stderr_has(&["--json writes JSON", "name it .json"]);
    }
    folder.put("records.bin", [3u64, 1, 2].map(u64::to_le_bytes).concat());
    let sort =
        "memory sort records.bin --item-bytes 8 -o sorted.bin --certificate sorted.json --json";
    let json = folder.taut(sort).ends(0).out;
    assert_eq!(json, folder.text("sorted.json"));
}
