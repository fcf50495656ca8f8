//! `taut hand`: scans are made, measured and drawn; what gives no reliable features is refused with the reason.

use crate::test_folder::TestFolder;

/// The columns of a table, by their names.
fn table(text: &str) -> Vec<std::collections::BTreeMap<&str, &str>> {
    let mut lines = text.lines();
    let names: Vec<&str> = lines.next().unwrap().split(',').collect();
    lines.map(|line| names.iter().copied().zip(line.split(',')).collect()).collect()
}

#[test]
fn scans_are_made_and_measured_as_they_were_made() {
    let folder = TestFolder::new();
    folder
        .taut("hand synthesize scans --people 4 --scans 1 --clean --seed 5")
        .ends(0)
        .stdout_has(&["4 scans of 4 people in scans"]);
    let truth = folder.text("scans/truth.csv");
    let rows = table(&truth);
    assert_eq!(rows.len(), 4);
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
                "A right hand at 90 dots per inch\n",
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
    folder.taut("hand synthesize scans --people 4 --scans 1 --clean --seed 5 --threads 1").ends(0);
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
