//! `taut classify`: trained, saved, evaluated, predicted; and what is refused.

use serde_json::Value;

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

/// Numbers of the generator SplitMix64 in [0, 1).
fn draws(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Leaves of three kinds of tree: two overlapping kinds and a third one far from them.
fn leaves(count: usize, seed: u64) -> String {
    let mut draw = draws(seed);
    let mut text = "length,kind,width,tip\n".to_owned();
    for i in 0..count {
        let (kind, length, width) =
            [("oak", 9.0, 5.0), ("elm", 7.0, 5.5), ("ash, white", 3.0, 1.0)][i % 3];
        // The sum of uniform numbers: about normal with a standard deviation of 0.6.
        let mut noise = || (0..4).map(|_| draw()).sum::<f64>() - 2.0;
        let (length, width, tip) = (length + 2.0 * noise(), width + noise(), noise());
        text += &format!("{length:.3},\"{kind}\",{width:.3},{tip:.3}\n");
    }
    text
}

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.put("train.csv", leaves(90, 1));
    folder.put("test.csv", leaves(60, 2));
    folder
}

/// The columns of features alone.
fn without_labels(text: &str) -> String {
    let features = |line: &str| {
        let fields: Vec<&str> = line.split(',').collect();
        format!("{},{},{}\n", fields[0], fields[fields.len() - 2], fields[fields.len() - 1])
    };
    text.lines().map(features).collect()
}

#[test]
fn a_model_is_trained_evaluated_and_used() {
    let folder = folder();
    folder
        .taut(
            "classify train train.csv --label kind --model model.json --method svm --probabilities",
        )
        .ends(0)
        .stdout_has(&[
            "Classifier for 3 classes of 3 features, learned from 90 points\n",
            "  classes   ash, white: 30, elm: 30, oak: 30\n",
            "  method    support vector machine, width scale=",
            "  chosen    among 20 candidates by 5 inner folds; the best had ",
        ]);
    let report = folder
        .taut("classify evaluate test.csv --label kind --model model.json --positive oak --json");
    let report = report.ends(0).json();
    assert_eq!(report["points"], 60);
    let accuracy = report["accuracy"].as_f64().unwrap();
    assert!(accuracy > 0.8, "{accuracy}");
    let rows = report["confusion"].as_array().unwrap();
    assert!(
        rows.iter().all(|row| row
            .as_array()
            .unwrap()
            .iter()
            .map(|n| n.as_u64().unwrap())
            .sum::<u64>()
            == 20)
    );
    assert_eq!(report["positive"]["class"], "oak");
    assert_eq!(report["recalls"][0], 1.0);
    let equal = report["verification"]["equal_error_rate"].as_f64().unwrap();
    assert!(equal > 0.0 && equal < 0.2, "{equal}");
    folder
        .taut("classify evaluate test.csv --label kind --model model.json --positive oak")
        .ends(0)
        .stdout_has(&[
            "Classifier on 60 points\n",
            "95 % interval",
            "  sensitivity",
            "positive is `oak`",
            "rule of 30",
        ]);

    folder.put("new.csv", without_labels(&folder.text("test.csv")));
    folder.taut("classify predict new.csv --model model.json -o classes.csv --scores").ends(0);
    let classes = folder.text("classes.csv");
    let mut lines = classes.lines();
    assert_eq!(
        lines.next().unwrap(),
        "class,\"score ash, white\",score elm,score oak,\"probability ash, white\",probability elm,probability oak"
    );
    assert_eq!(lines.clone().count(), 60);
    assert!(lines.nth(2).unwrap().starts_with("\"ash, white\","));
    // The file with labels and another order of columns gives the same, as the model knows its columns.
    let all = folder.taut("classify predict test.csv --model model.json --scores").ends(0).out;
    assert_eq!(all, classes);
    let new = folder.text("new.csv");
    let (_, rows) = new.split_once('\n').unwrap();
    folder.put("nameless.csv", rows);
    let nameless =
        folder.taut("classify predict nameless.csv --model model.json --scores").ends(0).out;
    assert_eq!(nameless, classes);
    let json = folder.taut("classify predict new.csv --model model.json --json").ends(0).json();
    assert_eq!(json["rows"][2]["class"], "ash, white");
    let right =
        json["rows"].as_array().unwrap().iter().zip(["oak", "elm", "ash, white"].iter().cycle());
    let share = right.filter(|(row, kind)| row["class"] == **kind).count() as f64 / 60.0;
    assert_eq!(share, accuracy);
}

#[test]
fn each_method_is_the_same_for_any_number_of_threads() {
    let folder = folder();
    for method in [
        "committee",
        "ball",
        "thesis",
        "whitened-ball",
        "svdd",
        "mahalanobis",
        "thesis-verifier",
        "plda",
        "box",
    ] {
        let train =
            format!("classify train train.csv --label kind --method {method} --reject 0.02");
        for &threads in long_or(&[1, 8, 2][..], &[1, 8]) {
            folder.taut(&format!("{train} --threads {threads} --model {threads}.json -q")).ends(0);
            let model = folder.bytes(&format!("{threads}.json"));
            assert!(model == folder.bytes("1.json"), "{method}, {threads} threads");
        }
        let report = folder
            .taut("classify evaluate test.csv --label kind --model 1.json --json")
            .ends(0)
            .json();
        assert!(report["accuracy"].as_f64().unwrap() > 0.75, "{method}: {report}");
    }
}

#[test]
fn one_class_needs_no_label_and_rejects_what_is_far() {
    let folder = TestFolder::new();
    let mut draw = draws(3);
    let text: String = (0..80).map(|_| format!("{},{}\n", draw(), draw())).collect();
    folder.put("inside.csv", text);
    folder
        .taut("classify train inside.csv --method svdd --nu 0.05 --model model.json")
        .ends(0)
        .stdout_has(&["Classifier for 1 class of 2 features", "  rejects   scores below 0.0"]);
    folder.put("new.csv", "0.5,0.5\n30,30\n");
    let found = folder.taut("classify predict new.csv --model model.json").ends(0);
    assert_eq!(found.out, "class\ninside\n\n");
    let summary = folder.taut("classify train inside.csv --method svdd --model model.json --json");
    let summary: Value = summary.ends(0).json();
    assert_eq!(summary["classes"][0]["points"], 80);
    assert_eq!(summary["threshold"], 0.0);
}

#[test]
fn numbers_are_classes_in_their_order_and_bad_widths_are_warned_of() {
    let folder = TestFolder::new();
    let rows = ["0,0,10", "1,0,10", "0,1,10", "8,9,9", "9,8,9", "8,8,9"].join("\n");
    folder.put("points.csv", rows + "\n");
    let train = "classify train points.csv --label 2 --model model.json --method ball";
    let run = folder.taut(&format!("{train} --width gamma=1000")).ends(0);
    assert!(run.err.contains("so narrow that each point is alone"), "{run:?}");
    assert!(
        run.stdout_has(&["  classes   9: 3, 10: 3\n"])
            .out
            .contains("width gamma=1000, power cells")
    );
    folder.put("new.csv", "0.2,0.3\n9,9\n");
    folder.taut(train).ends(0);
    let found = folder.taut("classify predict new.csv --model model.json").ends(0);
    assert_eq!(found.out, "class\n10\n9\n");
}

#[test]
fn what_is_refused_is_named_and_nothing_is_written() {
    let folder = folder();
    folder.put("gap.csv", "x,kind\n1,a\n2,\n");
    folder.put("text.csv", "x,kind\n1,a\ntwo,b\n");
    folder.put("other.csv", "length,kind,width,tip\n1,yew,2,3\n");
    folder.put("narrow.csv", "1,2\n");
    folder.taut("classify train train.csv --label kind --model model.json --method box -q").ends(0);
    let text = folder.text("model.json");
    folder.put("future.json", text.replacen("\"version\":1", "\"version\":9", 1));
    folder.put("cut.json", &text[..text.len() / 2]);
    folder.put("answer.json", "{\"kind\":\"ball\"}");
    let files = folder.files();
    for (command, words) in [
        ("train train.csv --model new.json", "training needs --label COLUMN"),
        ("train train.csv --label sort --model new.json", "there is no column `sort`"),
        (
            "train gap.csv --label kind --model new.json",
            "gap.csv: row 2 (line 3), column 1 (`kind`): the label is missing",
        ),
        ("train text.csv --label kind --model new.json", "`two` is not a number"),
        ("train train.csv --label kind --model train.csv", "`train.csv` is the input"),
        ("train train.csv --label kind --model -", "the model is written to a file"),
        (
            "train train.csv --label kind --model new.json --method box --nu 0.1",
            "option `--nu` is 0.1: expected left out",
        ),
        (
            "train train.csv --label kind --model new.json --method svdd --nu 2",
            "option `--nu` is 2: expected",
        ),
        (
            "train train.csv --label kind --model new.json --method svm --cost -1",
            "option `--cost` is -1: expected",
        ),
        (
            "train train.csv --label kind --model new.json --folds 1",
            "option `--folds` is 1: expected from 2 to 1000",
        ),
        (
            "train train.csv --label kind --model new.json --folds 91",
            "option `--folds` is 91: expected at most one for each of the 90 points",
        ),
        (
            "train train.csv --label kind --model new.json --method box --folds 4",
            "option `--folds` is 4: expected left out where nothing is chosen",
        ),
        (
            "train train.csv --label kind --model new.json --method ball --nu 0.1 --thesis-steps 9",
            "option `--thesis-steps` is 9: expected left out for soft balls",
        ),
        (
            "train train.csv --label kind --model new.json --reject 1",
            "option `--reject` is 1: expected",
        ),
        ("predict test.csv --model none.json", "none.json: the model could not be read"),
        (
            "predict test.csv --model future.json",
            "future.json: the model has version 9, and this release reads version 1",
        ),
        ("predict test.csv --model cut.json", "cut.json: this is no model of taut"),
        ("predict test.csv --model answer.json", "its `format` is not \"taut-classifier\""),
        ("predict test.csv --model .", "is a folder"),
        (
            "predict narrow.csv --model model.json --columns 0",
            "points have 1 coordinate, but the model was trained on 3",
        ),
        ("predict test.csv --model model.json -o model.json", "`model.json` is the input"),
        (
            "evaluate other.csv --label kind --model model.json",
            "other.csv, row 1: the label is `yew`, which the model does not know",
        ),
        (
            "evaluate test.csv --label kind --model model.json --positive yew",
            "option `--positive` is yew",
        ),
    ] {
        folder.taut(&format!("classify {command}")).ends(2).stderr_has(&[words]);
    }
    assert_eq!(folder.files(), files);
    let usage = folder.taut("classify train train.csv --label kind --model new.json --width 125");
    assert!(usage.ends(2).err.contains("theta-squared="));
}

#[test]
fn a_model_of_the_plane_is_drawn_and_its_error_rates() {
    let folder = folder();
    let plane = "--columns length,width --label kind";
    folder.taut(&format!("classify train train.csv {plane} --model plane.json --method mahalanobis --draw map.svg")).ends(0);
    let map = folder.text("map.svg");
    assert!(map.contains("Decision map of 3 classes") && map.contains("ash, white"), "{map}");
    let evaluate = format!("classify evaluate test.csv {plane} --model plane.json");
    folder.taut(&format!("{evaluate} --draw rates.svg --figure 2")).ends(0);
    assert!(folder.text("rates.svg").contains("false rejection rate"));
    folder.taut(&format!("{evaluate} --draw both.html")).ends(0);
    assert!(folder.text("both.html").contains("Decision map"));
    folder
        .taut("classify train train.csv --label kind --model all.json --method box --draw map.png")
        .ends(2)
        .stderr_has(&["3 features", "--columns"]);
    assert!(!folder.path("all.json").exists());
}
