//! The record that a file of runs holds about itself, so that another process can go on.
//!
//! *Idea.* The file begins with slots: one says of which sort it is, one for each run that the run is complete, and the
//! certificate so far. A slot is written when its run has reached the disk.
//! *Guarantee.* A crash at any moment leaves slots that are whole and true, or fail their checksum and count as absent. So
//! does a run that the file is too short for.
//! *Trap.* A slot must not vouch for another sort: its checksum covers what the first slot says.
//! *Trap.* A file of the same length, time and number may have other content: times are set, numbers used again. So an
//! entry holds a hash of the part of the input that its run was made of, byte for byte, and that part is read and compared
//! before the run counts.

use super::Multiset;
use super::digest;
use super::layout::KeyKind;
use super::medium::Medium;
use super::plan::Plan;
use crate::error::Error;
use crate::store::{PAGE, Store};

const SLOT_BYTES: usize = 128;
/// The magic number at the start of the file; the last byte is the version.
const MAGIC: u64 = u64::from_le_bytes(*b"tautrun\x04");

/// The words that tell one sort from another.
type Identity = [u64; 11];

/// The data of the system that identify a file: when it was modified, when anything about it changed, and its
/// number, in any unit. Not the number of its device, which may be another one when the machine has started again.
/// Off Unix the time of its creation stands for the time of the last change, and 0 for the number; what guards a resumed
/// sort there are its length, its times, and the hash of the input of each run.
pub(super) type Origin = [u64; 3];

pub(super) struct Journal {
    identity: Identity,
    runs: u64,
    /// For each run that is complete the hash of what it was made of.
    made_of: Vec<u128>,
    certificate: Multiset,
}

impl Journal {
    /// Reads the journal of a file of `length` bytes, or starts one if there is none yet.
    pub(super) fn open<S: Store>(
        plan: &Plan,
        origin: Origin,
        header: u64,
        length: u64,
        file: &mut Medium<S>,
    ) -> Result<Self, Error> {
        let layout = &plan.layout;
        let kind = match layout.kind {
            KeyKind::U64 => 0,
            KeyKind::I64 => 1,
            KeyKind::F64 => 2,
            KeyKind::Bytes => 3,
        };
        let [width, start, end, chunk] =
            [layout.width, layout.key.start, layout.key.end, plan.chunk].map(|size| size as u64);
        let [modified, changed, number] = origin;
        let records = plan.records;
        let identity =
            [MAGIC, records, modified, changed, number, width, start, end, kind, chunk, header];
        let (runs, certificate) = (plan.runs(), Multiset::default());
        let mut journal = Self { identity, runs, made_of: vec![], certificate };
        let (first, mut slot) = (journal.slot(&identity), [0; SLOT_BYTES]);
        let start = &mut slot[..length.min(SLOT_BYTES as u64) as usize];
        file.read(start, 0)?;
        if !first.starts_with(start) {
            return Err(Self::other(file.path()));
        }
        // Nothing yet, or what a disk had room for that then was full.
        if start.len() < SLOT_BYTES {
            file.write(&first, 0)?;
            return Ok(journal);
        }
        let made = plan.made(journal.data_start());
        for (run, made) in (0..).zip(made) {
            let at = Self::place(run);
            if made.end(plan) > length {
                break;
            }
            file.read(&mut slot, at)?;
            let word = |i: usize| u64::from_le_bytes(slot.as_chunks::<8>().0[i]);
            let long = |i: usize| u128::from(word(i + 1)) << 64 | u128::from(word(i));
            let certificate = Multiset { records: word(1), hash: long(2) };
            if slot != journal.entry(run, &certificate, long(4)) {
                break;
            }
            journal.made_of.push(long(4));
            journal.certificate = certificate;
        }
        Ok(journal)
    }

    /// The file to resume is of another sort.
    pub(super) fn other(path: &str) -> Error {
        Error::Option {
            name: "resume",
            value: path.to_owned(),
            expected: "a file of the same sort (the input as it was, layout, length of runs), or a new one to begin again",
        }
    }

    /// Where runs start.
    pub(super) fn data_start(&self) -> u64 {
        Self::place(self.runs).next_multiple_of(PAGE as u64)
    }

    pub(super) fn runs_done(&self) -> u64 {
        self.made_of.len() as u64
    }

    /// The hash of what a complete run was made of.
    pub(super) fn made_of(&self, run: u64) -> u128 {
        self.made_of[run as usize]
    }

    /// Of the records in these.
    pub(super) fn certificate(&self) -> Multiset {
        self.certificate
    }

    /// Says that `run` is complete, after which all runs so far have this certificate, and of what it was made.
    pub(super) fn enter<S: Store>(
        &self,
        run: u64,
        certificate: &Multiset,
        made_of: u128,
        file: &mut Medium<S>,
    ) -> Result<(), Error> {
        file.write(&self.entry(run, certificate, made_of), Self::place(run))
    }

    fn place(run: u64) -> u64 {
        (run + 1) * SLOT_BYTES as u64
    }

    fn entry(&self, run: u64, certificate: &Multiset, made_of: u128) -> [u8; SLOT_BYTES] {
        let halves = |hash: u128| [hash as u64, (hash >> 64) as u64];
        let ([low, high], [first, second]) = (halves(certificate.hash), halves(made_of));
        self.slot(&[run, certificate.records, low, high, first, second])
    }

    /// Words, zeros, and a checksum of them and of the identity.
    fn slot(&self, words: &[u64]) -> [u8; SLOT_BYTES] {
        let mut slot = [0; SLOT_BYTES];
        let (places, _) = slot.as_chunks_mut::<8>();
        for (place, word) in places.iter_mut().zip(words) {
            *place = word.to_le_bytes();
        }
        let all: Vec<u8> =
            self.identity.iter().chain(words).flat_map(|word| word.to_le_bytes()).collect();
        let sum = digest::hash(&all).to_le_bytes();
        slot[SLOT_BYTES - sum.len()..].copy_from_slice(&sum);
        slot
    }
}
