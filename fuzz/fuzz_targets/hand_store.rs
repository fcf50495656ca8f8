//! Any bytes as a store of people, and a sound store with some bytes changed: it opens, or says what is wrong.
#![no_main]

use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use taut::recognize::hand::Side;
use taut::recognize::store::{Key, Scan, Store, StoreOptions};
use taut::recognize::template::Matcher;

/// People of the sound store.
const PEOPLE: usize = 5;

/// The bytes of a sound store.
static SOUND: LazyLock<Vec<u8>> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("store");
    let matcher = Matcher::of_synthetic_hands();
    let mut store = Store::create(&path, &key(), matcher, &StoreOptions::default()).expect("a new store");
    for person in 0..PEOPLE {
        let scans = [0.0, 0.01, 0.02].map(|shift| scan(person, shift));
        store.enroll(&format!("person {person}"), &scans).expect("a scan of numbers");
    }
    drop(store);
    std::fs::read(path).expect("the store is there")
});

fn key() -> Key {
    Key::from_bytes([1; 32])
}

fn scan(person: usize, shift: f64) -> Scan {
    let features = (0..Matcher::of_synthetic_hands().dim()).map(|j| (person * 7 + j) as f64 + shift);
    Scan { side: Side::Right, features: features.collect() }
}

fuzz_target!(|bytes: &[u8]| {
    let Some((&mode, rest)) = bytes.split_first() else { return };
    let content = match mode % 2 {
        0 => rest.to_vec(),
        // Each three bytes put the third one at the place of the two others, from the beginning or from the end.
        _ => {
            let mut content = SOUND.clone();
            for change in rest.chunks_exact(3) {
                let at = usize::from(u16::from_le_bytes([change[0], change[1]])) % content.len();
                let at = if mode & 2 == 0 { at } else { content.len() - 1 - at };
                content[at] = change[2];
            }
            content
        }
    };
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let path = folder.path().join("store");
    std::fs::write(&path, content).expect("room for a temporary file");
    let Ok(mut store) = Store::open(&path, &key(), None) else { return };
    // Nobody can make a store that opens without the key: it is the sound one.
    assert_eq!(store.len(), PEOPLE);
    assert_eq!(store.people().expect("sound records").len(), PEOPLE);
    assert!(store.verify("person 3", &scan(3, 0.0)).expect("a comparison").is_accepted);
});
