//! `taut hand key`, `train`, `enroll`, `verify`, `identify`, `list`, `unlock` and `delete`.

use serde_json::json;

use crate::test_folder::TestFolder;
use crate::test_length::long_or;

/// Returns how many dots per inch scans have.
fn dpi() -> u32 {
    long_or(60, 40)
}

/// A folder with scans of three people, a key, and a store with two of them.
fn folder() -> TestFolder {
    let folder = TestFolder::new();
    let options = format!("--dpi {} --clean --seed 3 --quiet", dpi());
    folder.taut(&format!("hand synthesize scans --people 3 --scans 4 {options}")).ends(0);
    folder.taut("hand key -o key").ends(0);
    folder
        .taut(&format!("hand enroll --create --failures 2 {STORE} --person Ada {}", scans(0)))
        .ends(0)
        .stdout_has(&["Enrolled as person number 1 by 3 scans\n"]);
    let run = folder.taut(&format!("hand enroll {STORE} --person Grace {} --json", scans(1)));
    assert_eq!(run.ends(0).json(), json!({ "number": 2, "scans": 3 }));
    folder
}

const STORE: &str = "--store people --key key --manifest manifest";

fn scans(person: usize) -> String {
    (0..3).map(|scan| image(person, scan)).collect::<Vec<_>>().join(" ")
}

fn image(person: usize, scan: usize) -> String {
    format!("scans/person-{person:04}-scan-{scan:02}.png")
}

#[test]
fn the_enrolled_are_accepted_found_and_deleted() {
    let folder = folder();
    let verify = |name: &str, person, options: &str| {
        folder.taut(&format!("hand verify {STORE} --person {name} {} {options}", image(person, 3)))
    };
    assert_eq!(verify("Ada", 0, "").ends(0).out, "Accepted\n");
    let run = verify("Grace", 1, "--scores --json").ends(0);
    let found = run.json();
    assert!(found["distance"].as_f64().unwrap() <= found["threshold"].as_f64().unwrap());
    // A "no" is an answer, and tells no score unless asked.
    assert_eq!(verify("Ada", 1, "").ends(1).out, "Rejected; 1 attempt left\n");
    let run = verify("Ada", 2, "--json").ends(1);
    assert_eq!(run.json(), json!({ "accepted": false, "attempts_left": 0 }));
    // Locked, for the right hand, too; no message holds the name.
    let run = verify("Ada", 0, "").ends(2).stderr_has(&["locked after 2 failed verifications"]);
    assert!(!run.err.contains("Ada"));
    folder.taut(&format!("hand unlock {STORE} --person Ada")).ends(0);
    verify("Ada", 0, "").ends(0);
    verify("Nobody", 0, "").ends(2).stderr_has(&["no person of this name"]);

    let identify =
        |person| folder.taut(&format!("hand identify {STORE} {} --json", image(person, 3)));
    assert_eq!(identify(1).ends(0).json()["person"], "Grace");
    assert_eq!(identify(2).ends(1).json()["person"], json!(null));
    let run = folder.taut(&format!("hand identify {STORE} {} --scores", image(2, 3))).ends(1);
    assert!(run.out.contains("distance  larger; accepted up to "), "{}", run.out);
    let run = folder.taut(&format!("hand identify {STORE} {}", image(0, 3))).ends(0);
    assert!(run.out.starts_with("Ada\n") && run.out.contains("2 people"), "{}", run.out);
    assert!(!run.out.contains("distance"));

    let list = |options: &str| folder.taut(&format!("hand list {STORE} {options}")).ends(0);
    assert!(!list("").out.contains("Ada") && !list("--json").out.contains("Ada"));
    list("--names").stdout_has(&[
        "2 enrolled; matcher of 280 synthetic hands, FMR ",
        "Ada\n",
        "Grace\n",
    ]);
    folder.taut(&format!("hand delete {STORE} --person Ada")).ends(0);
    assert_eq!(list("--names --json").json()["people"][0]["name"], "Grace");
}

#[test]
fn keys_stores_and_manifests_that_do_not_fit_are_refused() {
    let folder = folder();
    let refused = |line: &str, words: &str| {
        folder.taut(&format!("hand list {line}")).ends(2).stderr_has(&[words]);
    };
    folder.taut("hand key -o other").ends(0);
    folder.taut("hand key -o other").ends(2).stderr_has(&["other exists"]);
    folder.taut("hand key -o -").ends(2).stderr_has(&["a key is written to a file"]);
    refused("--store people --key other", "the key does not fit");
    refused("--store people", "there is no key");
    refused("--store people --key people", "the key from people");
    refused("--store missing --key key", "missing: ");
    refused("--store key --key key", "key is no store of hands");
    refused("--store people --key key --manifest missing", "missing: ");
    refused("--store people --key key --manifest key", "key: this is no manifest");
    let kept = folder.bytes("people");
    folder.taut(&format!("hand delete {STORE} --person Ada")).ends(0);
    folder.put("people", &kept);
    refused(STORE, "rolled back");
    // Without the manifest an older copy looks sound.
    folder.taut("hand list --store people --key key").ends(0).stdout_has(&["2 enrolled"]);
    folder.put("people", &kept[..kept.len() / 2]);
    refused("--store people --key key", "");
    let line = format!("hand enroll --create {STORE} --person Ada {}", scans(0));
    folder.taut(&line).ends(2).stderr_has(&["manifest exists"]);
    folder
        .taut(&format!("hand enroll --create --store people --key key --person Ada {}", scans(0)))
        .ends(2)
        .stderr_has(&["people exists"]);
    folder
        .taut(&format!(
            "hand enroll --store people --key key --person Ada {} text.png",
            image(0, 0)
        ))
        .ends(2)
        .stderr_has(&["text.png"]);
}

#[test]
#[cfg(unix)]
fn a_key_from_the_environment_serves_as_well() {
    let folder = folder();
    let key = folder.text("key");
    folder.shell(&format!("TAUT_HAND_KEY={} taut hand list --store people", key.trim())).ends(0);
    let run = folder.shell("TAUT_HAND_KEY=abc taut hand list --store people").ends(2);
    assert!(run.err.contains("TAUT_HAND_KEY") && !run.err.contains("abc"), "{}", run.err);
    let run = folder.shell("chmod 644 key; taut hand list --store people --key key").ends(2);
    assert!(run.err.contains("chmod 600"), "{}", run.err);
}

#[test]
fn a_matcher_is_learned_from_a_folder() {
    let folder = TestFolder::new();
    let options = format!("--dpi {} --clean --seed 4 --quiet", dpi());
    folder.taut(&format!("hand synthesize scans --people 8 --scans 3 {options}")).ends(0);
    folder
        .taut("hand train scans -o matcher.json --scans 1 --fmr 0.2 --source tests")
        .ends(0)
        .stdout_has(&["A matcher of ", " scans of 8 people", " right, 0 left\n", "\n  FNMR "]);
    let matcher: serde_json::Value = serde_json::from_str(&folder.text("matcher.json")).unwrap();
    assert_eq!((&matcher["format"], &matcher["source"]), (&json!("taut-matcher"), &json!("tests")));
    let image = image(1, 0);
    folder.taut("hand key -o key").ends(0);
    let enroll = format!("hand enroll --create --store s --key key --person A {image} --model");
    folder.taut(&format!("{enroll} key")).ends(2).stderr_has(&["key: this is no model of taut"]);
    folder.taut(&format!("{enroll} matcher.json")).ends(0);
    folder.taut("hand list --store s --key key").ends(0).stdout_has(&["matcher of tests"]);
    folder
        .taut("hand train . -o m.json")
        .ends(2)
        .stderr_has(&["no file is named PERSON-scan-NUMBER"]);
    folder.taut("hand train scans -o m.json --fmr 2").ends(2).stderr_has(&["option `--fmr` is 2"]);
    folder.taut("hand train scans -o m.json --scans 3").ends(2).stderr_has(&["more scans"]);
}

#[test]
fn a_matcher_of_both_hands_says_so() {
    let folder = TestFolder::new();
    let options = format!("--dpi {} --clean --seed 4 --quiet", dpi());
    let scans = long_or(3, 2);
    folder.taut(&format!("hand synthesize scans --people 8 --scans {scans} {options}")).ends(0);
    let scans = long_or(3, 1);
    let left = format!("hand synthesize left --left --people 8 --scans {scans} {options}");
    folder.taut(&left).ends(0);
    for person in 0..8 {
        let name =
            |folder: &str, scan: u32| format!("{folder}/person-{person:04}-scan-{scan:02}.png");
        let (from, to) = (folder.path(&name("left", 0)), folder.path(&name("scans", 3)));
        std::fs::copy(from, to).unwrap();
    }
    folder.taut("hand train scans -o matcher.json --scans 1 --fmr 0.2").ends(0).stdout_has(&[
        "\n  hands ",
        " left; both of ",
        " people, and compared as one hand",
    ]);
}

#[test]
fn a_failed_enrollment_leaves_no_new_store() {
    let folder = TestFolder::new();
    let options = format!("--dpi {} --clean --seed 3 --quiet", long_or(90, 40));
    folder.taut(&format!("hand synthesize scans --people 2 --scans 3 {options}")).ends(0);
    folder.taut("hand key -o key").ends(0);
    let files = folder.files();
    let others = format!("{} {} {}", image(0, 0), image(0, 1), image(1, 0));
    let enroll = format!("hand enroll --create {STORE} --person Ada");
    folder.taut(&format!("{enroll} {others}")).ends(2);
    assert_eq!(folder.files(), files);
    folder.taut(&format!("{enroll} {}", scans(0))).ends(0);
}
