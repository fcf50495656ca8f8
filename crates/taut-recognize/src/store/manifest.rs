//! The manifest: a counter of changes, and a keyed hash over it and all records.
//!
//! *Idea.* A record that was changed does not open, but one that was removed, or replaced by an older one of the same person, would not be
//! missed. So the store holds a keyed hash over its counter, its settings and all records, which each change renews.
//! *Limit.* Whoever replaces the whole file by an older copy replaces the hash with it. That is noticed only where the manifest is also
//! kept elsewhere: in a file that the same person cannot replace, or by the caller.

use std::fmt;
use std::str::FromStr;

use super::StoreError;
use super::key::{push_hex, read_hex};

/// What the text of a manifest begins with.
const FORMAT: &str = "taut-manifest-1";

/// What a store said of itself after a change. It holds nothing of people and needs not be secret, but must not be replaceable by whoever
/// can replace the store.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Manifest {
    pub(super) store: [u8; 16],
    pub(super) counter: u64,
    pub(super) mac: [u8; 32],
}

impl Manifest {
    /// The number of changes of the store.
    #[must_use]
    pub fn counter(&self) -> u64 {
        self.counter
    }

    /// Compares what a store says now with this earlier manifest.
    pub(super) fn check(&self, now: &Manifest) -> Result<(), StoreError> {
        if now.store != self.store {
            return Err(StoreError::OtherStore);
        }
        // With as many changes, but others: a copy went on by itself.
        if now.counter < self.counter || now.counter == self.counter && now.mac != self.mac {
            return Err(StoreError::RolledBack { found: now.counter, expected: self.counter });
        }
        Ok(())
    }
}

/// The text that is kept elsewhere: one line.
impl fmt::Display for Manifest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let hex = |bytes: &[u8]| {
            let mut text = String::new();
            bytes.iter().for_each(|&byte| push_hex(&mut text, byte));
            text
        };
        write!(f, "{FORMAT} {} {} {}", self.counter, hex(&self.store), hex(&self.mac))
    }
}

impl FromStr for Manifest {
    type Err = StoreError;

    fn from_str(text: &str) -> Result<Self, StoreError> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let [FORMAT, counter, store, mac] = words[..] else { return Err(StoreError::NoManifest) };
        let mut found = Manifest { store: [0; 16], counter: 0, mac: [0; 32] };
        found.counter = counter.parse().map_err(|_| StoreError::NoManifest)?;
        match read_hex(store, &mut found.store) && read_hex(mac, &mut found.mac) {
            true => Ok(found),
            false => Err(StoreError::NoManifest),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_is_read_as_it_was_written_and_notices_what_is_older() {
        let kept = Manifest { store: [3; 16], counter: 41, mac: [250; 32] };
        assert_eq!(kept.to_string().parse::<Manifest>().unwrap(), kept);
        for text in ["", "taut-manifest-1 41 03 fa", "taut-manifest-2 41 03 fa", "x"] {
            assert!(matches!(text.parse::<Manifest>(), Err(StoreError::NoManifest)), "{text}");
        }
        assert!(kept.check(&kept).is_ok());
        assert!(kept.check(&Manifest { counter: 42, mac: [0; 32], ..kept }).is_ok());
        for now in [Manifest { counter: 40, ..kept }, Manifest { mac: [0; 32], ..kept }] {
            assert!(matches!(kept.check(&now), Err(StoreError::RolledBack { .. })), "{now:?}");
        }
        let other = Manifest { store: [4; 16], ..kept };
        assert!(matches!(kept.check(&other), Err(StoreError::OtherStore)));
    }
}
