//! Encryption of records, and what is derived from the key.
//!
//! *Idea.* Each use has its own key, derived by BLAKE3 from the user's key and 32 random bytes of the store: one encrypts records
//! (XChaCha20-Poly1305 with a random nonce of 24 bytes), one hashes names for looking them up, one authenticates the manifest, and one
//! makes the value by which a wrong key is told. Store, kind of record, number of the person and hash of the name are associated data:
//! a record that is moved elsewhere does not open.

use chacha20poly1305::aead::{Aead, KeyInit, Payload};
use chacha20poly1305::{XChaCha20Poly1305, XNonce};
use zeroize::Zeroizing;

use super::StoreError;
use super::key::{Key, random};

/// Bytes of a nonce.
const NONCE_BYTES: usize = 24;
/// What all associated data begin with.
const DOMAIN: &[u8] = b"taut-hand-store-1";

/// What a record is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(super) enum Kind {
    Settings = 1,
    Name = 2,
    Template = 3,
    Attempts = 4,
}

/// Where a record belongs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) kind: Kind,
    /// The number of the person; 0 for the settings.
    pub(super) person: i64,
    /// The hash of the person's name; zeros for the settings.
    pub(super) lookup: [u8; 32],
}

impl Place {
    pub(super) const SETTINGS: Place = Place { kind: Kind::Settings, person: 0, lookup: [0; 32] };
}

/// The keys of a store; overwritten when they are dropped.
pub(super) struct Secrets {
    store: [u8; 16],
    records: Zeroizing<[u8; 32]>,
    names: Zeroizing<[u8; 32]>,
    manifest: Zeroizing<[u8; 32]>,
    check: [u8; 32],
}

impl Secrets {
    /// Derives the keys of the store with this number and salt.
    pub(super) fn derive(key: &Key, store: [u8; 16], salt: &[u8; 32]) -> Self {
        let derived = |context: &str| {
            let mut hasher = blake3::Hasher::new_derive_key(context);
            hasher.update(key.bytes()).update(salt).update(&store);
            let bytes = Zeroizing::new(*hasher.finalize().as_bytes());
            zeroize::Zeroize::zeroize(&mut hasher);
            bytes
        };
        Secrets {
            store,
            records: derived("taut hand store 1: encryption of records"),
            names: derived("taut hand store 1: hashes of names"),
            manifest: derived("taut hand store 1: manifest"),
            check: *derived("taut hand store 1: check of the key"),
        }
    }

    /// The random number of the store.
    pub(super) fn store(&self) -> [u8; 16] {
        self.store
    }

    /// The value by which a wrong key is told.
    pub(super) fn check(&self) -> [u8; 32] {
        self.check
    }

    /// Whether a value is that of [`check`](Self::check).
    pub(super) fn is_check(&self, value: &[u8; 32]) -> bool {
        // In constant time.
        blake3::Hash::from_bytes(self.check) == blake3::Hash::from_bytes(*value)
    }

    /// The hash by which a name is looked up.
    pub(super) fn lookup(&self, name: &str) -> [u8; 32] {
        *blake3::keyed_hash(&self.names, name.as_bytes()).as_bytes()
    }

    /// A hasher for the manifest.
    pub(super) fn manifest(&self) -> blake3::Hasher {
        blake3::Hasher::new_keyed(&self.manifest)
    }

    /// Encrypts a record: nonce, ciphertext and tag.
    pub(super) fn seal(&self, place: Place, text: &[u8]) -> Result<Vec<u8>, StoreError> {
        let mut nonce = [0; NONCE_BYTES];
        random(&mut nonce)?;
        let payload = Payload { msg: text, aad: &self.associated(place) };
        let sealed = self.cipher().encrypt(&XNonce::from(nonce), payload);
        // Fails for more than 256 GB alone.
        let sealed = sealed.map_err(|_| StoreError::damaged("a record is too large"))?;
        Ok([nonce.as_slice(), &sealed].concat())
    }

    /// Decrypts a record; none where it is not one of this place.
    pub(super) fn open(&self, place: Place, sealed: &[u8]) -> Option<Zeroizing<Vec<u8>>> {
        let (nonce, rest) = sealed.split_first_chunk::<NONCE_BYTES>()?;
        let payload = Payload { msg: rest, aad: &self.associated(place) };
        self.cipher().decrypt(&XNonce::from(*nonce), payload).ok().map(Zeroizing::new)
    }

    fn cipher(&self) -> XChaCha20Poly1305 {
        XChaCha20Poly1305::new(&(*self.records).into())
    }

    fn associated(&self, place: Place) -> Vec<u8> {
        let kind = [place.kind as u8];
        [DOMAIN, &self.store, &kind, &place.person.to_le_bytes(), &place.lookup].concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_record_opens_at_its_own_place_alone() {
        let key = Key::from_bytes([1; 32]);
        let secrets = Secrets::derive(&key, [2; 16], &[3; 32]);
        let place = Place { kind: Kind::Name, person: 7, lookup: [5; 32] };
        let sealed = secrets.seal(place, b"a name").unwrap();
        assert_eq!(**secrets.open(place, &sealed).unwrap(), *b"a name");
        assert_eq!(sealed.len(), 24 + 6 + 16);
        assert_ne!(sealed, secrets.seal(place, b"a name").unwrap(), "nonces are random");
        for other in [
            Place { kind: Kind::Template, ..place },
            Place { person: 8, ..place },
            Place { lookup: [6; 32], ..place },
        ] {
            assert!(secrets.open(other, &sealed).is_none(), "{other:?}");
        }
        for (store, salt, key) in
            [([9; 16], [3; 32], [1; 32]), ([2; 16], [9; 32], [1; 32]), ([2; 16], [3; 32], [9; 32])]
        {
            let other = Secrets::derive(&Key::from_bytes(key), store, &salt);
            assert!(other.open(place, &sealed).is_none() && !other.is_check(&secrets.check()));
            assert_ne!(other.lookup("a name"), secrets.lookup("a name"));
        }
        for at in 0..sealed.len() {
            let mut changed = sealed.clone();
            changed[at] ^= 1;
            assert!(secrets.open(place, &changed).is_none(), "{at}");
            assert!(secrets.open(place, &sealed[..at]).is_none(), "{at}");
        }
    }
}
