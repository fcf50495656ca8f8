//! Models as files: saved, loaded, damaged; and what cannot be trained.

use serde_json::Value;
use taut_points::Points;
use taut_recognize::Error;
use taut_recognize::classify::{Labeled, Model, Preset, TrainOptions, train};

use super::support::{Set, names, preset};

fn trained(name: Preset) -> (Model, Set) {
    let set = Set::normal(3, 15, 3, 1.5, 20);
    let mut options = preset(name);
    (options.reject, options.calibrate) = (Some(0.05), name != Preset::Plda);
    (train(set.labeled(), &options).unwrap(), set)
}

#[test]
fn a_loaded_model_predicts_the_same_bits() {
    let test = Set::normal(3, 40, 3, 1.5, 21);
    for name in Preset::ALL {
        let (model, _) = trained(name);
        let columns = ["a", "b", "c"].map(str::to_owned).to_vec();
        let model = model.with_columns(columns).unwrap();
        let loaded = Model::from_json(&model.to_json()).unwrap();
        assert_eq!(loaded, model, "{name}");
        let bits = |model: &Model| -> Vec<(Option<u32>, Vec<u64>)> {
            let found = model.predict(test.points()).unwrap();
            let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            found
                .iter()
                .map(|p| {
                    let probabilities = p.probabilities.clone().unwrap_or_default();
                    (p.class, [bits(&p.scores), bits(&probabilities)].concat())
                })
                .collect()
        };
        assert_eq!(bits(&loaded), bits(&model), "{name}");
        let probabilities = model.predict(test.points()).unwrap()[0].probabilities.clone().unwrap();
        assert!((probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
}

/// Calls `change` on a copy of the value for each list in it.
fn for_each_list(value: &Value, path: &mut Vec<String>, found: &mut Vec<String>) {
    match value {
        Value::Array(items) => {
            found.push(format!("/{}", path.join("/")));
            for (i, item) in items.iter().enumerate().take(2) {
                path.push(i.to_string());
                for_each_list(item, path, found);
                path.pop();
            }
        }
        Value::Object(fields) => {
            for (name, item) in fields {
                path.push(name.clone());
                for_each_list(item, path, found);
                path.pop();
            }
        }
        _ => {}
    }
}

#[test]
fn lists_cut_short_and_damaged_texts_are_refused() {
    for name in Preset::ALL {
        let (model, _) = trained(name);
        let json: Value = serde_json::from_str(&model.to_json()).unwrap();
        let mut lists = vec![];
        for_each_list(&json, &mut vec![], &mut lists);
        assert!(lists.len() >= 4, "{lists:?}");
        for list in lists {
            // Candidates and members are lists of any length, and names of coordinates may be missing.
            if ["/trials", "/members", "/columns"].iter().any(|end| list.ends_with(end)) {
                continue;
            }
            let mut cut = json.clone();
            cut.pointer_mut(&list).unwrap().as_array_mut().unwrap().pop();
            let refused = Model::from_json(&cut.to_string());
            assert!(matches!(refused, Err(Error::NoModel { .. })), "{name} {list}");
        }
    }
    let text = trained(Preset::Thesis).0.to_json();
    for length in (0..text.len()).step_by(7) {
        assert!(matches!(Model::from_json(&text[..length]), Err(Error::NoModel { .. })));
    }
}

#[test]
fn formats_and_versions_are_named_in_errors() {
    let text = trained(Preset::Box).0.to_json();
    for (from, to, words) in [
        ("\"version\":1", "\"version\":2", "version 2, and this release reads version 1"),
        ("\"version\":1", "\"version\":\"1\"", "this is no model of taut: invalid type"),
        ("\"version\":1,", "", "it has no `version`"),
        ("taut-classifier", "other", "its `format` is not \"taut-classifier\""),
        ("\"classes\":", "\"extra\":1,\"classes\":", "unknown field `extra`"),
    ] {
        let changed = text.replacen(from, to, 1);
        assert_ne!(changed, text);
        let refused = Model::from_json(&changed).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
}

#[test]
fn bad_sets_and_options_are_refused_with_place_and_value() {
    let values = [0.0, 1.0, 2.0, f64::NAN];
    let points = |n: usize| Points::new(&values[..n], 1).unwrap();
    let labeled = |n, labels: &'static [u32], classes: usize| {
        let names: &'static [String] = Box::leak(names(classes).into_boxed_slice());
        Labeled::new(points(n), labels, names).map_err(|error| error.to_string())
    };
    for (found, words) in [
        (labeled(3, &[0, 1], 2), "2 labels for 3 points"),
        (labeled(3, &[0, 1, 2], 2), "the label of point 2 is 2, but the 2 classes"),
        (labeled(3, &[0, 1, 1], 3), "class `class 2` has 0 points"),
        (labeled(4, &[0, 1, 1, 0], 2), "coordinate 0 of point 3 is NaN"),
        (labeled(0, &[], 0), "training needs labeled points"),
    ] {
        let refused = found.unwrap_err();
        assert!(refused.contains(words), "{refused}");
    }
    let doubled = vec!["a".to_owned(), "a".to_owned()];
    let refused = Labeled::new(points(2), &[0, 1], &doubled).unwrap_err();
    assert_eq!(refused.to_string(), "two classes have the name `a`");
    let set = Set::normal(2, 3, 2, 1.0, 1);
    let base = TrainOptions::default;
    for (options, words) in [
        (TrainOptions { candidates: vec![], ..base() }, "`candidates` is empty"),
        (TrainOptions { folds: 1, ..base() }, "`folds` is 1"),
        (TrainOptions { reject: Some(1.0), ..base() }, "`reject` is 1"),
        (TrainOptions { committee: Some(f64::NAN), ..base() }, "`committee` is NaN"),
        (TrainOptions { epsilon: 0.0, ..base() }, "`epsilon` is 0"),
        (TrainOptions { threads: Some(0), ..base() }, "`threads` is 0"),
    ] {
        let refused = train(set.labeled(), &options).unwrap_err().to_string();
        assert!(refused.contains(words), "{refused}");
    }
    let alone = Set { labels: vec![0, 1], values: vec![0.0, 1.0], dim: 1, classes: names(2) };
    let refused = train(alone.labeled(), &preset(Preset::Best)).unwrap_err().to_string();
    assert!(refused.contains("inner folds need a class of two points or more"), "{refused}");
    let model = set.train(Default::default());
    let refused = model.predict(points(3)).unwrap_err();
    assert!(matches!(refused, Error::Dimension { found: 1, expected: 2 }));
    let far = Points::new(&[0.0, f64::INFINITY], 2).unwrap();
    assert!(model.predict(far).unwrap_err().to_string().contains("coordinate 1 of point 0 is inf"));
    assert!(model.with_columns(vec!["x".to_owned()]).is_err());
}

#[test]
fn degenerate_sets_are_solved() {
    // All points equal, one point in a class, a constant coordinate, more dimensions than points.
    let equal =
        Set { values: vec![3.0; 12], dim: 2, labels: vec![0, 0, 0, 1, 1, 1], classes: names(2) };
    let few = Set::normal(2, 2, 9, 3.0, 4);
    let mut constant = Set::normal(2, 4, 3, 3.0, 5);
    constant.values.iter_mut().step_by(3).for_each(|x| *x = 7.5);
    let mut single = Set::normal(2, 4, 3, 3.0, 6);
    single.labels = vec![0, 0, 0, 1, 0, 0, 0, 0];
    for name in Preset::ALL {
        for (set, what) in
            [(&equal, "equal"), (&few, "few"), (&constant, "constant"), (&single, "single")]
        {
            match train(set.labeled(), &preset(name)) {
                Ok(model) => {
                    let found = model.predict(set.points()).unwrap();
                    assert!(
                        found.iter().all(|p| p.scores.iter().all(|s| s.is_finite())),
                        "{name} {what}"
                    );
                }
                Err(error) => panic!("{name} {what}: {error}"),
            }
        }
    }
}

#[test]
fn huge_and_tiny_coordinates_are_an_error_or_an_answer() {
    for size in [1e-300, 1e-160, 1e160, 1e300] {
        let mut set = Set::normal(2, 6, 3, 3.0, 7);
        set.values.iter_mut().for_each(|x| *x *= size);
        for name in Preset::ALL {
            match train(set.labeled(), &preset(name)) {
                Ok(model) => {
                    Model::from_json(&model.to_json()).unwrap();
                    drop(model.predict(set.points()));
                }
                Err(Error::Overflow | Error::Input(_)) => {}
                Err(other) => panic!("{name} {size}: {other}"),
            }
        }
    }
}

/// The files that the fuzzer begins with, one model of each method among them, and what it found.
#[test]
fn files_of_the_fuzzer_give_no_panic() {
    let folder =
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fuzz/seeds/classifier_model");
    if !folder.exists() {
        return println!(
            "skipped files_of_the_fuzzer_give_no_panic: this package comes without its seeds"
        );
    }
    let mut models = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let json = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        let Ok(model) = Model::from_json(&json) else { continue };
        let points = Points::new(&[3.0, -1.0, 0.0, 0.0], 2).unwrap();
        models += usize::from(model.predict(points).is_ok());
    }
    assert!(models >= 9, "{models} models");
}
