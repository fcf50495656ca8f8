//! The store of a command: its file, its key, and its manifest elsewhere.

use std::path::PathBuf;

use anyhow::{anyhow, bail};
use taut::recognize::store::{Key, Manifest, Store, StoreOptions};
use taut::recognize::template::Matcher;

use crate::output::writing;

/// The variable of the environment that holds a key.
const KEY_VARIABLE: &str = "TAUT_HAND_KEY";

/// What SQLite appends to the name of a store for the file by which it undoes changes.
const JOURNAL_ENDING: &str = "-journal";

#[derive(Debug, clap::Args)]
#[command(next_help_heading = "Store")]
pub(super) struct StoreArgs {
    /// The store of people
    #[arg(long, value_name = "FILE")]
    store: PathBuf,
    /// The file of the key [default: the environment variable TAUT_HAND_KEY, which holds the key itself]
    #[arg(long, alias = "key-file", value_name = "FILE")]
    key: Option<PathBuf>,
    /// The manifest kept elsewhere, by which an older copy of the store is noticed; written after each change
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
}

impl StoreArgs {
    /// Works with the store, and then writes the manifest if that has changed, whether the work failed or not.
    pub(super) fn with<R>(
        &self,
        work: impl FnOnce(&mut Store) -> anyhow::Result<R>,
    ) -> anyhow::Result<R> {
        let key = self.key()?;
        if let Some(path) = &self.manifest {
            writing::check_writable(&[path], &[&self.store])?;
        }
        let kept = self.kept()?;
        let store = Store::open(&self.store, &key, kept.as_ref())?;
        self.work(store, kept, work)
    }

    /// The same with a new store, which is removed again if the work failed and left it empty.
    pub(super) fn with_new<R>(
        &self,
        matcher: &Matcher,
        options: &StoreOptions,
        work: impl FnOnce(&mut Store) -> anyhow::Result<R>,
    ) -> anyhow::Result<R> {
        let key = self.key()?;
        if let Some(path) = &self.manifest {
            writing::check_writable(&[path], &[&self.store])?;
            if path.exists() {
                bail!("{} exists: name a new file for the manifest of a new store", path.display());
            }
        }
        let mut store = Store::create(&self.store, &key, matcher, options)?;
        let done = work(&mut store);
        if done.is_err() && store.is_empty() {
            drop(store);
            for ending in ["", JOURNAL_ENDING] {
                let mut path = self.store.clone().into_os_string();
                path.push(ending);
                std::fs::remove_file(path).ok();
            }
            return done;
        }
        self.work(store, None, |_| done)
    }

    fn work<R>(
        &self,
        mut store: Store,
        kept: Option<Manifest>,
        work: impl FnOnce(&mut Store) -> anyhow::Result<R>,
    ) -> anyhow::Result<R> {
        let done = work(&mut store);
        let manifest = store.manifest();
        if let Some(path) = self.manifest.as_ref().filter(|_| kept != Some(manifest)) {
            writing::replace(path, format!("{manifest}\n").as_bytes())?;
        }
        done
    }

    fn key(&self) -> anyhow::Result<Key> {
        match &self.key {
            Some(path) => Ok(Key::from_file(path)?),
            None => Key::from_environment(KEY_VARIABLE)?.ok_or_else(|| {
                anyhow!("there is no key: name its file by --key, or set {KEY_VARIABLE}; taut hand key makes one")
            }),
        }
    }

    fn kept(&self) -> anyhow::Result<Option<Manifest>> {
        let Some(path) = &self.manifest else { return Ok(None) };
        let name = path.display();
        let text = std::fs::read_to_string(path)
            .map_err(|error| anyhow!("the manifest {name}: {error}"))?;
        Ok(Some(text.parse().map_err(|error| anyhow!("{name}: {error}"))?))
    }
}
