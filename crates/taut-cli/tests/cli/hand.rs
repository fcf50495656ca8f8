//! `taut hand`: scans are made, measured and drawn; what gives no reliable features is refused with the reason.

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

/// The columns of a table, by their names.
fn table(text: &str) -> Vec<std::collections::BTreeMap<&str, &str>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(|line| names.iter().copied().zip(line.split(',')).collect()).collect()
}

#[test]
fn scans_are_made_and_measured_as_they_were_made() {
    let folder = TestFolder::new();
    let (people, dpi) = long_or((4, 90), (3, 60));
    let synthesize =
        format!("hand synthesize scans --people {people} --scans 1 --dpi {dpi} --clean --seed 6");
    folder
        .taut(&synthesize)
        .ends(0)
        .stdout_has(&[&format!("{people} scans of {people} people in scans")]);
    let truth = folder.text("scans/truth.csv");
    let rows = table(&truth);
    assert_eq!(rows.len(), people);
    let mut measured = 0;
    for row in rows {
        let file = row["file"];
        // People with large hands lie beyond the page in some scans.
        if row["cut_off"] == "true" {
            folder
                .taut(&format!("hand measure scans/{file} -o none.json"))
                .ends(2)
                .stderr_has(&[file, "cut off"]);
            assert!(!folder.path("none.json").exists());
            continue;
        }
        measured += 1;
        folder
            .taut(&format!("hand measure scans/{file} -o hand.json --draw hand.svg"))
            .ends(0)
            .stdout_has(&[
                &format!("A right hand at {dpi} dots per inch\n"),
                "\n  thumb length",
                "\n  middle length",
            ]);
        let found: serde_json::Value = serde_json::from_str(&folder.text("hand.json")).unwrap();
        let features = found["features"].as_object().unwrap();
        assert_eq!((features.len(), &found["concerns"]), (30, &serde_json::json!([])));
        assert_eq!(found["profile"].as_object().unwrap().len(), 61);
        for (name, value) in features {
            let (value, expected) =
                (value.as_f64().unwrap(), row[name.as_str()].parse::<f64>().unwrap());
            assert!((value / expected - 1.0).abs() < 0.05, "{file}: {name} {value} for {expected}");
        }
        assert!(
            folder.text("hand.svg").contains("<circle")
                && folder.text("hand.svg").contains("outline")
        );
    }
    assert!(measured >= 2, "{measured}");
    // The same seed gives the same bytes, and only a folder of such files is replaced.
    let before = std::fs::read(folder.path("scans/person-0001-scan-00.png")).unwrap();
    folder.taut(&format!("{synthesize} --threads 1")).ends(0);
    assert_eq!(std::fs::read(folder.path("scans/person-0001-scan-00.png")).unwrap(), before);
    folder.put("scans/mine.txt", "kept");
    folder.taut("hand synthesize scans --people 1 --scans 1").ends(2);
    assert_eq!(folder.text("scans/mine.txt"), "kept");
}

#[test]
fn what_cannot_be_measured_is_refused_with_the_file_and_the_reason() {
    let folder = TestFolder::new();
    folder.put("text.png", "no image");
    let refused = |words: &str, reasons: &[&str]| {
        folder.taut(&format!("hand measure {words}")).ends(2).stderr_has(reasons);
    };
    refused("text.png", &["text.png: not an image in PNG, JPEG or TIFF"]);
    refused("missing.png", &["missing.png"]);
    refused("text.png --draw hand.pdf", &["pictures are .svg, .png or .html"]);
    folder.taut("hand synthesize scans --people 1 --scans 1 --clean").ends(0);
    refused("scans/person-0000-scan-00.png --dpi 5", &["option `--dpi` is 5: expected 20 to 2400"]);
    refused("scans/person-0000-scan-00.png --threshold 500", &["option `--threshold` is 500"]);
    // At a tenth of the resolution the hand would be that of a giant.
    refused("scans/person-0000-scan-00.png --dpi 20 -o hand.json", &["scan-00.png: "]);
    assert!(!folder.path("hand.json").exists());
    folder
        .taut("hand measure scans/person-0000-scan-00.png --dpi 20 --no-gate")
        .ends(0)
        .stdout_has(&["may be wrong: "]);
    folder.taut("hand synthesize other --people 0").ends(2).stderr_has(&["people"]);
    folder.taut("hand synthesize other --dpi 10").ends(2).stderr_has(&["dpi"]);
    assert!(!folder.path("other").exists());
}

#[test]
fn recognition_is_evaluated_from_scans_and_from_their_table() {
    let folder = TestFolder::new();
    // Two scans for training, a probe, and in the long tests one in reserve for those that are refused.
    let (people, scans, seed, pairs) = long_or((6, 4, 3, 36), (4, 3, 1, 2));
    let protocol =
        format!("--seed {seed} --training 2 --splits 3 --folds 2 --method thesis-box,all-plda");
    let synthetic = format!("--synthetic {people}x{scans} {protocol}");
    folder
        .taut(&format!("hand evaluate {synthetic} --table features.csv --draw rates.svg"))
        .ends(0)
        .stdout_has(&[
            &format!("{} scans of {people} people\n", people * scans),
            "Training with 2 scans of ",
            "thesis-box",
            "all-plda",
            &format!(
                "  2 training scans, unseen people: {pairs} different comparisons of impostors, at most: \
                 300 are needed to tell rejections at FAR ≤ 1 %"
            ),
        ]);
    assert!(folder.text("rates.svg").contains("false rejection rate"));
    folder.taut(&format!("hand evaluate features.csv {protocol} --json -o table.json")).ends(0);
    let of_table = folder.text("table.json");
    folder
        .taut(&format!("hand synthesize scans --people {people} --scans {scans} --seed {seed}"))
        .ends(0);
    // A PNG file has whole pixels for each meter, so that 90 dots per inch are not exactly these.
    for options in ["--labels scans/truth.csv --threads 1", ""] {
        let words = format!("hand evaluate scans --dpi 90 {options} {protocol}");
        folder.taut(&format!("{words} --json -o scans.json")).ends(0);
        // The same scans, whichever way they come, and whatever people are called.
        assert_eq!(folder.text("scans.json"), of_table);
    }
    let found: serde_json::Value = serde_json::from_str(&of_table).unwrap();
    let rows = found["rows"].as_array().unwrap();
    assert_eq!((rows.len(), &found["scans"]), (2, &serde_json::json!(people * scans)));
    for row in rows {
        for rates in [&row["seen"], &row["unseen"]] {
            let (errors, probes) =
                (rates["errors"].as_f64().unwrap(), rates["probes"].as_f64().unwrap());
            assert!((rates["error_rate"].as_f64().unwrap() - errors / probes).abs() < 1e-15);
            let (fta, fnmr) = (found["fta"].as_f64().unwrap(), rates["fnmr"].as_f64().unwrap());
            assert!((rates["frr"].as_f64().unwrap() - (fta + fnmr * (1.0 - fta))).abs() < 1e-12);
        }
    }
}

#[test]
fn an_evaluation_that_cannot_be_is_refused() {
    let folder = TestFolder::new();
    let refused = |words: &str, reasons: &[&str]| {
        folder.taut(&format!("hand evaluate {words}")).ends(2).stderr_has(reasons);
    };
    refused("", &["--synthetic 70x10"]);
    folder.taut("hand evaluate --synthetic 70").ends(2);
    refused("--synthetic 2x2 --method eigenhands", &["eigenhands", "all-plda"]);
    refused("--synthetic 2x2 --training 1 --splits 1", &["`--folds` is 5"]);
    // Neither says anything of scans that are made.
    for option in ["--dpi 90", "--labels labels.csv"] {
        let run = folder.taut(&format!("hand evaluate --synthetic 2x2 {option}")).ends(2);
        assert!(run.err.contains("cannot be used with"), "{run:?}");
    }
    refused("missing.csv", &["missing.csv"]);
    folder.put("other.csv", "x,y\n1,2\n");
    refused("other.csv", &["other.csv", "hand evaluate --feature-table"]);
    folder.put("anna-1.png", "no image");
    refused("anna-1.png", &["anna-1.png", "not an image"]);
    folder.put("labels.csv", "file,person\nother.png,anna\n");
    refused("anna-1.png --labels labels.csv", &["the labels do not have this file"]);
    folder.put("labels.csv", "name,person\n");
    refused("anna-1.png --labels labels.csv", &["no column `file`"]);
    std::fs::create_dir(folder.path("empty")).unwrap();
    refused("empty", &["the folder has no scans"]);
}

#[test]
fn scans_of_others_in_a_folder_of_synthetic_ones_stay() {
    let folder = TestFolder::new();
    let dpi = long_or(90, 40);
    let command = &format!("hand synthesize scans --people 1 --scans 1 --dpi {dpi} --quiet");
    folder.taut(command).ends(0);
    folder.taut(command).ends(0);
    folder.put("scans/person-0000-scan-07.png", "mine");
    folder.taut("hand synthesize new --people 0").ends(2).stderr_has(&["`--people` is 0"]);
    folder.taut(command).ends(2).stderr_has(&["scans holds `person-0000-scan-07.png`"]);
    assert_eq!(folder.text("scans/person-0000-scan-07.png"), "mine");
}
