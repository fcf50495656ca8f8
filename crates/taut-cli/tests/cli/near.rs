//! `taut near`: rows found, in both formats, and what is refused.

use serde_json::json;

use crate::test_folder::TestFolder;

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("points.csv", "x,y\n0,0\n2,0\n2,0\n1,5\n");
    folder.put("places.csv", "x,y\n1.5,0\n1,9\n");
    folder.put("balls.csv", "x,y,r\n0,0,1\n3,0,2\n9,0,1\n0,4,2.5\n");
    folder.put("rays.csv", "-5,0,1,0\n9,9,0,2\n9,9,0,-2\n");
    folder
}

#[test]
fn nearest_within_and_farthest() {
    let folder = folder();
    let near = |line: &str| {
        folder.taut(&format!("near points.csv --queries places.csv {line}")).ends(0).out
    };
    assert_eq!(near(""), "query,row,distance\n0,1,0.5\n1,3,4\n");
    assert_eq!(
        near("-k 3"),
        "query,row,distance\n0,1,0.5\n0,2,0.5\n0,0,1.5\n1,3,4\n1,0,9.055385138137417\n\
         1,1,9.055385138137417\n"
    );
    assert_eq!(near("-k 99").lines().count(), 9);
    assert_eq!(near("--within 0.5"), "query,row,distance\n0,1,0.5\n0,2,0.5\n");
    assert_eq!(near("--within -1"), "query,row,distance\n");
    assert_eq!(
        near("--farthest"),
        "query,row,distance\n0,3,5.024937810560445\n1,0,9.055385138137417\n"
    );
    assert_eq!(near("--farthest --epsilon 0.5").lines().count(), 3);
    let found: serde_json::Value = serde_json::from_str(&near("--json")).unwrap();
    assert_eq!(
        found,
        json!([{"query": 0, "row": 1, "distance": 0.5}, {"query": 1, "row": 3, "distance": 4.0}])
    );
}

#[test]
fn rays_pairs_and_the_diameter() {
    let folder = folder();
    let near = |line: &str| folder.taut(&format!("near {line}")).ends(0).out;
    assert_eq!(near("balls.csv --balls --rays rays.csv"), "ray,row,distance\n0,0,4\n2,2,8\n");
    assert_eq!(
        near("balls.csv --balls --rays rays.csv --all"),
        "ray,row,distance\n0,0,4\n0,1,6\n0,2,13\n2,2,8\n"
    );
    assert_eq!(
        near("points.csv --rays rays.csv --hit-radius 0.5 --all"),
        "ray,row,distance\n0,0,4.5\n0,1,6.5\n0,2,6.5\n"
    );
    assert_eq!(near("balls.csv --balls --pairs"), "row,other,distance\n0,1,0\n");
    assert_eq!(near("points.csv --pairs"), "row,other,distance\n1,2,0\n");
    assert_eq!(
        near("points.csv --pairs places.csv --distance 1.5"),
        "row,other,distance\n0,0,1.5\n1,0,0.5\n2,0,0.5\n"
    );
    assert_eq!(
        near("points.csv --diameter"),
        "row,other,distance,upper_bound\n0,3,5.0990195135927845,5.0990195135927845\n"
    );
    assert_eq!(
        near("balls.csv --balls --diameter").lines().nth(1).unwrap().split(',').next(),
        Some("2")
    );
}

#[test]
fn output_goes_to_a_file_and_threads_change_nothing() {
    let folder = folder();
    folder.taut("generate clusters -n 3000 -d 3 --seed 1 -o many.npy").ends(0);
    let near = |threads: usize, out: &str| {
        let line = format!("near many.npy --queries many.npy -k 4 --threads {threads} -o {out}");
        assert_eq!(folder.taut(&line).ends(0).out, "");
        folder.text(out)
    };
    let one = near(1, "one.csv");
    assert_eq!(one.lines().count(), 12_001);
    assert_eq!(one, near(3, "three.csv"));
    let piped = folder.pipe(folder.bytes("points.csv"), "near - --queries places.csv");
    assert_eq!(piped.ends(0).out, "query,row,distance\n0,1,0.5\n1,3,4\n");
}

#[test]
fn what_is_wrong_is_named() {
    let folder = folder();
    folder.put("nan.csv", "x,y\n0,0\n0,nan\n");
    folder.put("space.csv", "x,y,z\n0,0,0\n");
    folder.put("negative.csv", "x,y,r\n0,0,1\n0,0,-1\n");
    folder.put("still.csv", "0,0,1,0\n1,1,0,0\n");
    folder.put("found.csv", "earlier");
    let refused = |line: &str, parts: &[&str]| {
        let run = folder.taut(&format!("near {line} -o found.csv")).ends(2).stderr_has(parts);
        assert_eq!(run.out, "");
        assert_eq!(folder.text("found.csv"), "earlier");
    };
    refused("nan.csv --queries places.csv", &["nan.csv", "row 2", "`y`", "nan"]);
    refused("points.csv --queries nan.csv", &["nan.csv", "row 2", "`y`", "nan"]);
    refused(
        "points.csv --queries space.csv",
        &["space.csv", "3 coordinates", "as the rows of the tree"],
    );
    refused("points.csv --pairs space.csv", &["space.csv", "3 coordinates"]);
    refused("negative.csv --balls --diameter", &["negative.csv", "row 2", "`r`", "-1"]);
    refused("points.csv --rays still.csv", &["still.csv", "row 2", "no direction"]);
    refused("points.csv --rays places.csv", &["places.csv", "2 coordinates", "twice as many"]);
    refused("points.csv --queries places.csv -k 0", &["--k", "at least 1"]);
    refused("points.csv --queries places.csv --within nan", &["--within", "a number"]);
    refused("points.csv --diameter --epsilon -1", &["--epsilon", "at least 0"]);
    refused("points.csv --rays rays.csv --hit-radius -1", &["--hit-radius", "at least 0"]);
    refused("points.csv --queries places.csv --epsilon 1", &["--farthest and --diameter"]);
    refused("- --queries -", &["standard input"]);
    for (line, part) in
        [("", "--queries"), ("--queries places.csv --diameter", "cannot be used with")]
    {
        let run = folder.taut(&format!("near points.csv {line}")).ends(2);
        assert!(run.err.contains(part), "no `{part}` in {run:#?}");
    }
    folder
        .taut("near points.csv --queries places.csv -o places.csv")
        .ends(2)
        .stderr_has(&["is the input"]);
}

#[test]
fn rows_have_their_numbers_and_names_in_their_files() {
    let folder = TestFolder::new();
    folder.put("p.csv", "town,x,y\nUlm,NA,0\n\"Au, Hallertau\",0,0\nHof,,1\nKiel,5,0\n");
    folder.put("q.csv", "town,x,y\nA,,\nB,1,0\nC,4,0\n");
    let line = "near p.csv --columns x,y --missing drop";
    let run = folder.taut(&format!("{line} --queries q.csv")).ends(0);
    assert_eq!(run.out, "query,row,distance\n1,1,1\n2,3,1\n");
    assert!(run.err.contains("p.csv: missing 2 (50 %)"), "{}", run.err);
    assert!(run.err.contains("q.csv: missing 1 (33 %)"), "{}", run.err);
    assert_eq!(folder.taut(&format!("{line} --queries q.csv -q")).ends(0).err, "");
    let named = folder.taut(&format!("{line} --id town --queries q.csv")).ends(0).out;
    assert_eq!(
        named,
        "query,row,distance,query_id,row_id\n1,1,1,B,\"Au, Hallertau\"\n2,3,1,C,Kiel\n"
    );
    let pairs = folder.taut(&format!("{line} --id town --pairs --distance 9 --json")).ends(0);
    assert_eq!(
        pairs.json(),
        json!([{"row": 1, "other": 3, "distance": 5.0, "row_id": "Au, Hallertau", "other_id": "Kiel"}])
    );
    let pairs = folder.taut(&format!("{line} --pairs q.csv --distance 1")).ends(0).out;
    assert_eq!(pairs, "row,other,distance\n1,1,1\n3,2,1\n");
    let diameter = folder.taut(&format!("{line} --diameter")).ends(0).out;
    assert!(diameter.contains("\n1,3,5,5\n"), "{diameter}");
}
