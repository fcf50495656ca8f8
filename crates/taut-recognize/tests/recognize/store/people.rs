//! What a store is for.

use taut_recognize::Error;
use taut_recognize::hand::Side;
use taut_recognize::store::{Key, Scan, Store, StoreError, StoreOptions};
use taut_recognize::template::Matcher;

use super::help::{DIM, Place, matcher, name, scan, scans};

#[test]
fn the_enrolled_are_accepted_and_others_are_not() {
    let place = Place::with_people(6);
    let mut store = place.open();
    assert_eq!(store.len(), 6);
    for person in 0..6 {
        let own = store.verify(&name(person), &scan(person, 5)).unwrap();
        assert!(own.is_accepted && own.attempts_left == 5, "{person}: {own:?}");
        let other = store.verify(&name(person), &scan(person + 1, 5)).unwrap();
        assert!(!other.is_accepted && other.attempts_left == 4, "{person}: {other:?}");
    }
    let index = store.index(Side::Right).unwrap();
    assert_eq!(index.len(), 6);
    for person in 0..6 {
        let found = store.identify(&index, &scan(person, 6)).unwrap().unwrap();
        assert_eq!(found.name, name(person));
    }
    assert_eq!(store.identify(&index, &scan(77, 0)).unwrap(), None);
    assert!(store.index(Side::Left).unwrap().is_empty());
}

#[test]
fn the_distance_is_that_of_the_mahalanobis_classifier() {
    use taut_points::Points;
    use taut_recognize::classify::{Labeled, Model, TrainOptions, Whitener, train};
    // Two scans each of four people: the classifier has one mean for each, as templates have.
    let rows: Vec<Vec<f64>> = (0..8).map(|i| super::help::features(i / 2, i % 2)).collect();
    let values: Vec<f64> = rows.concat();
    let names = ["a", "b", "c", "d"].map(str::to_owned);
    let labels = [0, 0, 1, 1, 2, 2, 3, 3];
    let data = Labeled::new(Points::new(&values, DIM).unwrap(), &labels, &names).unwrap();
    let options = TrainOptions { candidates: vec![Whitener::method()], ..TrainOptions::default() };
    let model: Model = train(data, &options).unwrap();
    let whitener = Whitener::learn(data).unwrap();
    let probe = super::help::features(2, 7);
    let scores = model.predict(Points::new(&probe, DIM).unwrap()).unwrap().remove(0).scores;
    for (person, score) in scores.into_iter().enumerate() {
        let mapped = [0, 1].map(|i| whitener.apply(&rows[2 * person + i]).unwrap());
        let template = taut_recognize::template::Template::of_mapped(&mapped).unwrap();
        // The mean is rounded to single precision: by δ with |δ| ≤ 2⁻²⁴|m|, which changes d² by up to 2d|δ| + |δ|².
        let found = template.distance(&whitener.apply(&probe).unwrap()).unwrap() * 3.0 / 2.0;
        let size = template.mean().iter().map(|&x| f64::from(x).powi(2)).sum::<f64>().sqrt();
        let delta = size / f64::from(1 << 24);
        let tolerance = 2.0 * found.sqrt() * delta + delta * delta + 1e-12 * found;
        assert!((found + score).abs() <= tolerance, "{person}: {found} {score} {tolerance}");
    }
}

#[test]
fn names_are_unique_and_numbers_are_never_used_twice() {
    let place = Place::with_people(2);
    let mut store = place.open();
    assert!(matches!(store.enroll(&name(0), &scans(9)), Err(StoreError::NameTaken)));
    assert!(matches!(store.verify("nobody", &scan(0, 0)), Err(StoreError::UnknownPerson)));
    assert!(matches!(store.delete("nobody"), Err(StoreError::UnknownPerson)));
    let before = store.people().unwrap();
    assert_eq!(before.iter().map(|p| p.name.clone()).collect::<Vec<_>>(), [name(0), name(1)]);
    assert!(before.iter().all(|p| p.scans == 3 && p.side == Side::Right && !p.is_locked));
    store.delete(&name(1)).unwrap();
    let number = store.enroll(&name(1), &scans(5)).unwrap();
    assert!(number > before[1].number);
    assert!(store.verify(&name(1), &scan(5, 4)).unwrap().is_accepted);
    assert!(!store.verify(&name(1), &scan(1, 4)).unwrap().is_accepted);
}

#[test]
fn five_failures_lock_until_unlocked_and_the_count_survives_closing() {
    let place = Place::with_people(2);
    for left in (0..5).rev() {
        let found = place.open().verify(&name(0), &scan(1, 0)).unwrap();
        assert_eq!((found.is_accepted, found.attempts_left), (false, left));
    }
    let mut store = place.open();
    let refused = store.verify(&name(0), &scan(0, 0)).unwrap_err();
    assert!(matches!(refused, StoreError::Locked { failures: 5 }), "{refused}");
    assert!(store.people().unwrap()[0].is_locked && !store.people().unwrap()[1].is_locked);
    // Nor is a locked person named by identification.
    let index = store.index(Side::Right).unwrap();
    assert_eq!(store.identify(&index, &scan(0, 4)).unwrap(), None);
    assert!(store.verify(&name(1), &scan(1, 3)).unwrap().is_accepted);
    store.unlock(&name(0)).unwrap();
    assert!(store.verify(&name(0), &scan(0, 3)).unwrap().is_accepted);
    assert_eq!(store.people().unwrap()[0].failures, 0);
}

#[test]
fn scans_that_do_not_belong_together_are_refused() {
    let place = Place::new();
    let mut store = place.open();
    let foreign = [scan(0, 0), scan(0, 1), scan(3, 0), scan(0, 2)];
    let refused = store.enroll("x", &foreign).unwrap_err();
    assert!(matches!(refused, StoreError::ScansDiffer { scan: 3 }), "{refused}");
    let mut hands = scans(0);
    hands[1].side = Side::Left;
    assert!(matches!(store.enroll("x", &hands), Err(StoreError::TwoHands { scan: 2 })));
    assert!(matches!(store.enroll("x", &[]), Err(StoreError::Recognize(Error::Input(_)))));
    let short = Scan { side: Side::Right, features: vec![1.0; DIM - 1] };
    let refused = store.enroll("x", &[short]).unwrap_err();
    assert!(matches!(refused, StoreError::Recognize(Error::Dimension { .. })), "{refused}");
    let mut nan = scan(0, 0);
    nan.features[3] = f64::NAN;
    assert!(matches!(store.enroll("x", &[nan.clone()]), Err(StoreError::Recognize(_))));
    let few = store.enroll("x", &scans(0)[..2]).unwrap_err();
    assert!(matches!(few, StoreError::TooFewScans { found: 2, needed: 3 }), "{few}");
    let same = [scan(0, 0), scan(0, 1), scan(0, 0)];
    assert!(matches!(store.enroll("x", &same), Err(StoreError::SameScan { scan: 3 })));
    for bad in ["", "a\tb", " a", "a ", "a\u{202e}b", "a\u{200b}", &"x".repeat(1001)] {
        assert!(matches!(store.enroll(bad, &scans(0)), Err(StoreError::Name { .. })));
    }
    assert!(store.is_empty());
    store.enroll("x", &scans(0)).unwrap();
    assert!(matches!(store.verify("x", &nan), Err(StoreError::Recognize(_))));
    let left = Scan { side: Side::Left, ..scan(0, 0) };
    let refused = store.verify("x", &left).unwrap_err();
    assert!(matches!(refused, StoreError::OtherHand { found: Side::Left }), "{refused}");
    assert_eq!(refused.to_string(), "the scan shows a left hand, and the right one is enrolled");
    // What was never compared is no failed attempt.
    assert_eq!(store.people().unwrap()[0].failures, 0);
}

#[test]
fn an_open_store_is_locked_for_others_and_a_new_one_replaces_nothing() {
    let place = Place::new();
    let again = Store::create(&place.path, &place.key, &matcher(), &StoreOptions::default());
    assert!(matches!(again, Err(StoreError::Exists { .. })));
    let store = place.open();
    let refused = Store::open(&place.path, &place.key, None).unwrap_err();
    assert!(matches!(refused, StoreError::InUse { .. }), "{refused}");
    drop(store);
    place.open();
}

#[test]
fn matchers_are_read_as_they_were_written() {
    let matcher = matcher();
    let json = matcher.to_json();
    assert_eq!(Matcher::from_json(&json).unwrap(), matcher);
    let refused = |json: &str| Matcher::from_json(json).unwrap_err().to_string();
    assert!(refused("{}").contains("`format`"));
    assert!(refused(&json.replace("\"version\":1", "\"version\":9")).contains("version 9"));
    let threshold = format!("\"threshold\":{:?}", matcher.threshold());
    assert!(json.contains(&threshold));
    assert!(refused(&json.replace(&threshold, "\"threshold\":-1.0")).contains("contradict"));
}

#[test]
#[cfg(unix)]
fn key_files_that_others_may_read_are_refused() {
    use std::fs::{Permissions, set_permissions};
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("key");
    let key = Key::generate().unwrap();
    key.write_new(&path).unwrap();
    assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o600);
    assert!(matches!(key.write_new(&path), Err(StoreError::Exists { .. })));
    let place = folder.path().join("store");
    drop(Store::create(&place, &key, &matcher(), &StoreOptions::default()).unwrap());
    assert_eq!(std::fs::metadata(&place).unwrap().permissions().mode() & 0o777, 0o600);
    // The file holds the same key.
    Store::open(&place, &Key::from_file(&path).unwrap(), None).unwrap();
    for mode in [0o640, 0o604, 0o620, 0o666] {
        set_permissions(&path, Permissions::from_mode(mode)).unwrap();
        let refused = Key::from_file(&path).unwrap_err().to_string();
        assert!(refused.contains("chmod 600"), "{refused}");
    }
}

#[test]
fn an_index_that_is_older_than_a_lock_or_a_deletion_names_nobody() {
    let place = Place::new();
    let mut store = place.open();
    for person in 0..3 {
        store.enroll(&name(person), &scans(person)).unwrap();
    }
    let index = store.index(Side::Right).unwrap();
    assert_eq!(store.identify(&index, &scan(1, 4)).unwrap().unwrap().name, name(1));
    while store.verify(&name(1), &scan(2, 4)).unwrap().attempts_left > 0 {}
    assert!(matches!(store.identify(&index, &scan(1, 4)), Err(StoreError::OldIndex)));
    store.delete(&name(2)).unwrap();
    assert!(matches!(store.identify(&index, &scan(2, 4)), Err(StoreError::OldIndex)));
    assert_eq!(store.identify(&index, &scan(0, 4)).unwrap().unwrap().name, name(0));
    let other = Place::new();
    let refused = other.open().identify(&index, &scan(0, 4)).unwrap_err();
    assert!(matches!(refused, StoreError::OldIndex), "{refused}");
}

#[test]
fn passphrases_and_files_of_others_are_refused_and_left_as_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let phrase = folder.path().join("phrase");
    std::fs::write(&phrase, b"correct horse battery staple 123").unwrap();
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        std::fs::set_permissions(&phrase, std::fs::Permissions::from_mode(0o600)).unwrap();
    }
    let refused = Key::from_file(&phrase).unwrap_err();
    assert!(refused.to_string().contains("passphrase"), "{refused}");
    let foreign = folder.path().join("foreign");
    let connection = rusqlite::Connection::open(&foreign).unwrap();
    connection.pragma_update_and_check(None, "journal_mode", "WAL", |_| Ok(())).unwrap();
    connection.execute_batch("CREATE TABLE mine (x); INSERT INTO mine VALUES (1)").unwrap();
    drop(connection);
    let before = std::fs::read(&foreign).unwrap();
    let refused = Store::open(&foreign, &Key::from_bytes([1; 32]), None).unwrap_err();
    assert!(matches!(refused, StoreError::NoStore { .. }), "{refused}");
    assert_eq!(std::fs::read(&foreign).unwrap(), before);
}
