//! An encrypted store of people and their templates, in one file.
//!
//! ```
//! use taut_recognize::store::{Key, Scan, Store, StoreOptions};
//! # use taut_recognize::hand::Side;
//! # use taut_recognize::{classify::Labeled, template::{Matcher, MatcherOptions}};
//! # let values: Vec<f64> = (0..64).map(|i| f64::from(i / 4 * 10) + f64::from(i % 3)).collect();
//! # let labels: Vec<u32> = (0..64).map(|i| i / 4).collect();
//! # let names: Vec<String> = (0..16).map(|i| i.to_string()).collect();
//! # let points = taut_points::Points::new(&values, 1)?;
//! # let matcher = Matcher::train(Labeled::new(points, &labels, &names)?, &MatcherOptions::default())?;
//! # let folder = tempfile::tempdir()?;
//! # let path = folder.path().join("people.taut");
//! let key = Key::generate()?;
//! let mut store = Store::create(&path, &key, &matcher, &StoreOptions::default())?;
//! # let scan = |x: f64| Scan { side: Side::Right, features: vec![x] };
//! store.enroll("Ada", &[scan(7.2), scan(7.8), scan(7.4)])?;
//! assert!(store.verify("Ada", &scan(7.5))?.is_accepted);
//! store.delete("Ada")?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! *What is stored.* For each person the mean of the mapped features, which hand it is, the number of scans, and how often verification
//! failed; no images and no single scans. All of it and the names are encrypted ([`Key`]); what can be seen without the key is the number
//! of people, when in sequence they came, and the length of a name to within 64 bytes.
//! *What is noticed.* Each record belongs to its person and its store, and the [`Manifest`] to all records: a changed, exchanged,
//! added or removed record is refused. An older copy of the whole file is noticed where the manifest is kept elsewhere.
//! *What is deleted.* The bytes of a deleted person are overwritten in the file, which is then compacted. Copies of the file, and blocks
//! that the file system or the disk keeps, are beyond this library.
//! *Limit.* Whoever has the key and the file has the templates.

mod error;
mod file;
mod key;
mod manifest;
mod people;
mod record;
mod seal;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use rusqlite::Connection;

pub use error::StoreError;
pub use key::Key;
pub use manifest::Manifest;
pub use people::{Identification, PeopleIndex, Person, Verification};
pub use record::NAME_BYTES_MAX;

use crate::hand::{Hand, Side};
use crate::template::Matcher;
use record::Row;
use seal::{Place, Secrets};

/// How a store is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoreOptions {
    /// Failed verifications in sequence after which a person is locked. At least 1, default 5.
    pub failures_max: u32,
}

impl Default for StoreOptions {
    fn default() -> Self {
        StoreOptions { failures_max: 5 }
    }
}

/// A scan as the store takes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scan {
    /// Which hand it shows.
    pub side: Side,
    /// The features that the matcher of the store takes; for [`Matcher::of_synthetic_hands`] the width profile.
    pub features: Vec<f64>,
}

impl From<&Hand> for Scan {
    /// Takes the width profile.
    fn from(hand: &Hand) -> Self {
        Scan { side: hand.side, features: hand.profile.to_vec() }
    }
}

/// An open store. While it is open, no other process can open it.
pub struct Store {
    connection: Connection,
    path: PathBuf,
    secrets: Secrets,
    matcher: Matcher,
    failures_max: u32,
    /// The hash of the settings and of each person's records.
    digests: Digests,
    manifest: Manifest,
}

/// What the manifest is calculated from.
struct Digests {
    settings: [u8; 32],
    people: BTreeMap<i64, [u8; 32]>,
}

impl std::fmt::Debug for Store {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Store").field("people", &self.len()).finish_non_exhaustive()
    }
}

impl Store {
    /// Makes a new store, whose file its owner alone may read.
    ///
    /// # Errors
    /// [`StoreError::Exists`], [`StoreError::Io`], and [`StoreError::Recognize`] for options.
    pub fn create(
        path: impl AsRef<Path>,
        key: &Key,
        matcher: &Matcher,
        options: &StoreOptions,
    ) -> Result<Self, StoreError> {
        let path = path.as_ref();
        if options.failures_max == 0 {
            let expected = "at least 1";
            return Err(crate::Error::option("failures_max", "0".to_owned(), expected).into());
        }
        drop(key::create_private(path)?);
        let made = Store::fill(path, key, matcher, options);
        if made.is_err() {
            // The file is ours and holds nothing.
            std::fs::remove_file(path).ok();
        }
        made
    }

    fn fill(
        path: &Path,
        key: &Key,
        matcher: &Matcher,
        options: &StoreOptions,
    ) -> Result<Self, StoreError> {
        let (mut store, mut salt) = ([0; 16], [0; 32]);
        key::random(&mut store)?;
        key::random(&mut salt)?;
        let secrets = Secrets::derive(key, store, &salt);
        let settings = record::settings_text(options.failures_max, matcher);
        let settings = secrets.seal(Place::SETTINGS, &settings)?;
        let digests = Digests {
            settings: record::settings_digest(&secrets, &settings),
            people: BTreeMap::new(),
        };
        let manifest = digests.manifest(&secrets, 0);
        let mut connection = file::connect(path)?;
        file::set_journal(&connection, path)?;
        let header = file::Header { store, salt, check: secrets.check(), settings };
        file::write_tables(&mut connection, path, &header, &manifest)?;
        let (path, matcher, failures_max) =
            (path.to_owned(), matcher.clone(), options.failures_max);
        Ok(Store { connection, path, secrets, matcher, failures_max, digests, manifest })
    }

    /// Opens a store and checks all of it; `kept` is its manifest, if it was kept elsewhere.
    ///
    /// # Errors
    /// [`StoreError::WrongKey`], [`StoreError::Tampered`], [`StoreError::Damaged`], [`StoreError::RolledBack`],
    /// [`StoreError::OtherStore`], [`StoreError::NoStore`], [`StoreError::Version`], [`StoreError::InUse`] and [`StoreError::Io`].
    pub fn open(
        path: impl AsRef<Path>,
        key: &Key,
        kept: Option<&Manifest>,
    ) -> Result<Self, StoreError> {
        let path = path.as_ref();
        if !std::fs::metadata(path).map_err(|error| StoreError::io(path, error))?.is_file() {
            return Err(StoreError::io(path, "not a regular file"));
        }
        let connection = file::connect(path)?;
        let (header, manifest) = file::read_header(&connection, path)?;
        let secrets = Secrets::derive(key, header.store, &header.salt);
        if !secrets.is_check(&header.check) {
            return Err(StoreError::WrongKey);
        }
        let people = file::digests(&connection, &secrets)?;
        let settings = record::settings_digest(&secrets, &header.settings);
        let digests = Digests { settings, people };
        let expected = digests.manifest(&secrets, manifest.counter);
        // In constant time.
        if blake3::Hash::from_bytes(expected.mac) != blake3::Hash::from_bytes(manifest.mac) {
            let record = "a record, or the list of them,".to_owned();
            return Err(StoreError::Tampered { record });
        }
        if let Some(kept) = kept {
            kept.check(&manifest)?;
        }
        let settings = secrets.open(Place::SETTINGS, &header.settings);
        let settings =
            settings.ok_or(StoreError::Tampered { record: "the settings".to_owned() })?;
        let (failures_max, matcher) = record::read_settings(&settings)?;
        file::set_journal(&connection, path)?;
        let path = path.to_owned();
        Ok(Store { connection, path, secrets, matcher, failures_max, digests, manifest })
    }

    /// The number of enrolled people.
    pub fn len(&self) -> usize {
        self.digests.people.len()
    }

    /// Whether nobody is enrolled.
    pub fn is_empty(&self) -> bool {
        self.digests.people.is_empty()
    }

    /// The matcher of the store.
    pub fn matcher(&self) -> &Matcher {
        &self.matcher
    }

    /// Failed verifications in sequence after which a person is locked.
    pub fn failures_max(&self) -> u32 {
        self.failures_max
    }

    /// The manifest as it is now: to be kept elsewhere, and to be given to [`Store::open`].
    pub fn manifest(&self) -> Manifest {
        self.manifest
    }

    /// Writes or removes the records of a person, and the manifest with them: both or neither.
    fn put(&mut self, person: i64, row: Option<&Row>) -> Result<(), StoreError> {
        let digest = row.map(|row| row.digest(&self.secrets, person));
        let before = self.digests.set(person, digest);
        let counter = self.manifest.counter + 1;
        let manifest = self.digests.manifest(&self.secrets, counter);
        match file::write_person(&mut self.connection, &self.path, person, row, &manifest) {
            Ok(()) => {
                self.manifest = manifest;
                Ok(())
            }
            Err(error) => {
                self.digests.set(person, before);
                Err(error)
            }
        }
    }
}

impl Digests {
    /// Replaces the hash of a person; returns the earlier one.
    fn set(&mut self, person: i64, digest: Option<[u8; 32]>) -> Option<[u8; 32]> {
        match digest {
            Some(digest) => self.people.insert(person, digest),
            None => self.people.remove(&person),
        }
    }

    /// The manifest of these records after so many changes.
    fn manifest(&self, secrets: &Secrets, counter: u64) -> Manifest {
        let mut hasher = secrets.manifest();
        hasher.update(b"manifest").update(&secrets.store()).update(&counter.to_le_bytes());
        hasher.update(&self.settings);
        for (person, digest) in &self.people {
            hasher.update(&person.to_le_bytes()).update(digest);
        }
        Manifest { store: secrets.store(), counter, mac: *hasher.finalize().as_bytes() }
    }
}
