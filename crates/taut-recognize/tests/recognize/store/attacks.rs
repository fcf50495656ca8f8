//! What somebody without the key can do to the file, and what is left in it after a deletion.

use rusqlite::Connection;
use taut_recognize::store::{Key, Manifest, Store, StoreError};

use super::help::{Place, name, scan, scans};

/// Changes the file as somebody without the key can.
fn change(place: &Place, sql: &str) {
    Connection::open(&place.path).unwrap().execute_batch(sql).unwrap();
}

fn refusal(place: &Place) -> StoreError {
    Store::open(&place.path, &place.key, None).expect_err("the store was changed")
}

/// Whether bytes occur in some file of the folder of the store.
fn is_in_folder(place: &Place, bytes: &[u8]) -> bool {
    let files = std::fs::read_dir(place.folder.path()).unwrap();
    files
        .map(|file| std::fs::read(file.unwrap().path()).unwrap())
        .any(|content| content.windows(bytes.len()).any(|window| window == bytes))
}

/// The encrypted records of the last person, and the hash of the name.
fn records(place: &Place) -> [Vec<u8>; 4] {
    let sql = "SELECT lookup, name, template, attempts FROM person ORDER BY id DESC LIMIT 1";
    let connection = Connection::open(&place.path).unwrap();
    connection
        .query_row(sql, [], |row| Ok([row.get(0)?, row.get(1)?, row.get(2)?, row.get(3)?]))
        .unwrap()
}

#[test]
fn a_wrong_key_is_told_and_opens_nothing() {
    let place = Place::with_people(1);
    let wrong = Key::from_bytes([8; 32]);
    assert!(matches!(Store::open(&place.path, &wrong, None), Err(StoreError::WrongKey)));
    place.open();
}

#[test]
fn neither_names_nor_features_are_in_the_file() {
    let place = Place::with_people(3);
    assert!(!is_in_folder(&place, b"a person with"));
    let mapped = place.open().matcher().map(&scan(0, 0).features).unwrap();
    for x in mapped {
        assert!(!is_in_folder(&place, &(x as f32).to_le_bytes()));
    }
    assert!(!is_in_folder(&place, b"taut-matcher"));
    // The test can find what is there.
    assert!(is_in_folder(&place, &records(&place)[2]));
}

#[test]
fn changed_exchanged_added_and_removed_records_are_refused() {
    for sql in [
        "UPDATE person SET template = (SELECT template FROM person WHERE id = 1) WHERE id = 2",
        "UPDATE person SET attempts = (SELECT attempts FROM person WHERE id = 1) WHERE id = 2",
        "UPDATE person SET name = zeroblob(length(name)) WHERE id = 2",
        "UPDATE person SET template = substr(template, 1, 20) WHERE id = 2",
        "UPDATE person SET id = 9 WHERE id = 2",
        "DELETE FROM person WHERE id = 2",
        "DELETE FROM person",
        "INSERT INTO person SELECT 9, zeroblob(32), name, template, attempts FROM person WHERE id = 1",
        "UPDATE manifest SET counter = counter + 1",
        "UPDATE manifest SET counter = -1",
        "UPDATE manifest SET mac = zeroblob(32)",
        "UPDATE header SET settings = zeroblob(100)",
    ] {
        let place = Place::with_people(3);
        change(&place, sql);
        let refused = refusal(&place);
        assert!(matches!(refused, StoreError::Tampered { .. }), "{sql}: {refused}");
        assert!(!refused.to_string().contains("a person with"), "{refused}");
    }
}

#[test]
fn files_that_are_no_stores_are_refused() {
    for (sql, is_expected) in [
        (
            "DELETE FROM header",
            (|e| matches!(e, StoreError::Damaged { .. })) as fn(&StoreError) -> bool,
        ),
        ("DELETE FROM manifest", |e| matches!(e, StoreError::Damaged { .. })),
        ("UPDATE header SET salt = zeroblob(31)", |e| matches!(e, StoreError::Damaged { .. })),
        ("UPDATE header SET salt = zeroblob(32)", |e| matches!(e, StoreError::WrongKey)),
        ("UPDATE header SET store = zeroblob(16)", |e| matches!(e, StoreError::WrongKey)),
        ("UPDATE header SET version = 2", |e| {
            matches!(e, StoreError::Version { found: 2, known: 1 })
        }),
        ("UPDATE person SET lookup = zeroblob(3) WHERE id = 1", |e| {
            matches!(e, StoreError::Damaged { .. })
        }),
        ("DROP TABLE person", |e| matches!(e, StoreError::NoStore { .. })),
        ("CREATE TABLE more (x)", |e| matches!(e, StoreError::NoStore { .. })),
        ("CREATE TRIGGER t AFTER INSERT ON person BEGIN DELETE FROM person; END", |e| {
            matches!(e, StoreError::NoStore { .. })
        }),
    ] {
        let place = Place::with_people(1);
        change(&place, sql);
        let refused = refusal(&place);
        assert!(is_expected(&refused), "{sql}: {refused}");
    }
    let place = Place::new();
    for content in [&b""[..], b"x", &[0; 4096], b"SQLite format 3\0", &[255; 70_000]] {
        std::fs::write(&place.path, content).unwrap();
        let refused = refusal(&place);
        let is_typed = matches!(refused, StoreError::NoStore { .. } | StoreError::Damaged { .. });
        assert!(is_typed, "{refused}");
    }
    std::fs::remove_file(&place.path).unwrap();
    assert!(matches!(refusal(&place), StoreError::Io { .. }));
}

#[test]
fn truncated_files_and_flipped_bytes_are_refused() {
    let place = Place::with_people(20);
    let whole = std::fs::read(&place.path).unwrap();
    let is_typed = |error: &StoreError| {
        use StoreError::{Damaged, Io, NoStore, Tampered, Version, WrongKey};
        matches!(
            error,
            Damaged { .. }
                | Io { .. }
                | NoStore { .. }
                | Tampered { .. }
                | Version { .. }
                | WrongKey
        )
    };
    for part in 0..24 {
        std::fs::write(&place.path, &whole[..whole.len() * part / 24]).unwrap();
        let refused = refusal(&place);
        assert!(is_typed(&refused), "{part}/24: {refused}");
    }
    // Some bytes of SQLite mean nothing, as those of free room: then nothing has changed.
    let mut refusals = 0;
    for at in (0..whole.len()).step_by(whole.len() / 60) {
        let mut changed = whole.clone();
        changed[at] ^= 0x55;
        std::fs::write(&place.path, &changed).unwrap();
        match Store::open(&place.path, &place.key, None) {
            Ok(mut store) => {
                assert_eq!(store.len(), 20);
                assert!(store.verify(&name(11), &scan(11, 4)).unwrap().is_accepted);
            }
            Err(error) => {
                assert!(is_typed(&error), "{at}: {error}");
                refusals += 1;
            }
        }
    }
    assert!(refusals > 10, "{refusals} of 60");
    std::fs::write(&place.path, &whole).unwrap();
    place.open();
}

#[test]
fn an_older_copy_is_noticed_by_the_manifest_that_is_kept_elsewhere() {
    let place = Place::with_people(2);
    let old = std::fs::read(&place.path).unwrap();
    let mut store = place.open();
    for _ in 0..3 {
        store.verify(&name(0), &scan(1, 0)).unwrap();
    }
    let kept = store.manifest();
    drop(store);
    let open = |kept: &Manifest| Store::open(&place.path, &place.key, Some(kept));
    assert_eq!(open(&kept).unwrap().manifest(), kept);
    let newer = std::fs::read(&place.path).unwrap();
    std::fs::write(&place.path, &old).unwrap();
    // Without the manifest nobody can know: the failed attempts are forgotten.
    assert_eq!(place.open().people().unwrap()[0].failures, 0);
    let refused = open(&kept).unwrap_err();
    assert!(matches!(refused, StoreError::RolledBack { found: 2, expected: 5 }), "{refused}");
    // A copy that went on by itself to as many changes.
    let mut store = place.open();
    for _ in 0..3 {
        store.verify(&name(1), &scan(0, 0)).unwrap();
    }
    drop(store);
    assert!(matches!(open(&kept), Err(StoreError::RolledBack { found: 5, expected: 5 })));
    std::fs::write(&place.path, &newer).unwrap();
    assert!(open(&kept).is_ok());
    let other = Place::new().open().manifest();
    assert!(matches!(open(&other), Err(StoreError::OtherStore)));
}

#[test]
fn deleted_people_are_not_in_the_files_bytes() {
    let place = Place::with_people(40);
    let mut store = place.open();
    store.enroll("to be deleted", &scans(99)).unwrap();
    // Counts are written again and again: no older record stays either.
    drop(store);
    let before = records(&place);
    let mut store = place.open();
    store.verify("to be deleted", &scan(3, 0)).unwrap();
    drop(store);
    assert!(!is_in_folder(&place, &before[3]), "the earlier count");
    let records = records(&place);
    assert!(records.iter().all(|record| is_in_folder(&place, record)));
    let mut store = place.open();
    store.delete("to be deleted").unwrap();
    // While the store is open, and after it was closed.
    let is_gone = || {
        records.iter().all(|record| {
            // Parts of a record would say something as well.
            record.chunks_exact(16).all(|part| !is_in_folder(&place, part))
        })
    };
    assert!(is_gone());
    drop(store);
    assert!(is_gone());
    let mut store = place.open();
    assert_eq!(store.len(), 40);
    assert!(matches!(store.verify("to be deleted", &scan(99, 0)), Err(StoreError::UnknownPerson)));
    assert!(store.verify(&name(17), &scan(17, 4)).unwrap().is_accepted);
}
