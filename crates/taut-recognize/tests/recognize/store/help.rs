//! People as points with noise, and a store of them in a folder of its own.

use std::path::PathBuf;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use taut_points::Points;
use taut_recognize::classify::Labeled;
use taut_recognize::hand::Side;
use taut_recognize::store::{Key, Scan, Store, StoreOptions};
use taut_recognize::template::{Matcher, MatcherOptions};
use tempfile::TempDir;

/// Features of each scan.
pub(crate) const DIM: usize = 8;

/// The features of a scan of a person: means from 0 to 100, and noise of −1 to 1.
pub(crate) fn features(person: u64, scan: u64) -> Vec<f64> {
    let mut own = ChaCha8Rng::seed_from_u64(person);
    let mut noise = ChaCha8Rng::seed_from_u64(person * 1000 + scan + 1_000_000);
    (0..DIM).map(|_| own.random_range(0.0..100.0) + noise.random_range(-1.0..1.0)).collect()
}

pub(crate) fn scan(person: u64, scan: u64) -> Scan {
    Scan { side: Side::Right, features: features(person, scan) }
}

/// The first scans of a person.
pub(crate) fn scans(person: u64) -> [Scan; 3] {
    [0, 1, 2].map(|number| scan(person, number))
}

/// A matcher of 40 people who are not those of the tests.
pub(crate) fn matcher() -> Matcher {
    let values: Vec<f64> = (0..240u64).flat_map(|i| features(10_000 + i / 6, i % 6)).collect();
    let labels: Vec<u32> = (0..240).map(|i| i / 6).collect();
    let names: Vec<String> = (0..40).map(|i| i.to_string()).collect();
    let points = Points::new(&values, DIM).unwrap();
    let options = MatcherOptions { fmr_max: 0.0, ..MatcherOptions::default() };
    Matcher::train(Labeled::new(points, &labels, &names).unwrap(), &options).unwrap()
}

/// A folder with a store.
pub(crate) struct Place {
    pub(crate) folder: TempDir,
    pub(crate) path: PathBuf,
    pub(crate) key: Key,
}

impl Place {
    /// A store without people, closed.
    pub(crate) fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("people.store");
        let key = Key::from_bytes([7; 32]);
        let store = Store::create(&path, &key, &matcher(), &StoreOptions::default()).unwrap();
        assert!(store.is_empty());
        Place { folder, path, key }
    }

    /// A store of `count` people from number 0 on, closed.
    pub(crate) fn with_people(count: u64) -> Self {
        let place = Place::new();
        let mut store = place.open();
        for person in 0..count {
            store.enroll(&name(person), &scans(person)).unwrap();
        }
        drop(store);
        place
    }

    pub(crate) fn open(&self) -> Store {
        Store::open(&self.path, &self.key, None).unwrap()
    }
}

pub(crate) fn name(person: u64) -> String {
    format!("a person with the number {person}")
}
