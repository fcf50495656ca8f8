//! What a file of runs says of itself, so that another process can go on.
//!
//! *Idea.* The file begins with slots: one says of which sort it is, one for each run that the run is complete, and the
//! certificate so far. A slot is written when its run has reached the disk.
//! *Guarantee.* A crash at any moment leaves slots that are whole and true, or fail their checksum and count as absent.
//! *Trap.* A slot must not vouch for another sort: its checksum covers what the first slot says.

use super::Multiset;
use super::digest;
use super::layout::KeyKind;
use super::medium::Medium;
use super::plan::Plan;
use crate::error::Error;
use crate::store::{PAGE, Store};

const SLOT: usize = 128;
/// What is looked for at the start of the file; the last byte is the version.
const MAGIC: u64 = u64::from_le_bytes(*b"tautrun\x02");

/// The words that tell one sort from another.
type Identity = [u64; 8];

pub(super) struct Journal {
    identity: Identity,
    runs: u64,
    runs_done: u64,
    certificate: Multiset,
}

impl Journal {
    /// Reads the journal of a file of `length` bytes, or starts one if there is none yet.
    ///
    /// `modified` is when the input was, in any unit.
    pub(super) fn open<S: Store>(
        plan: &Plan,
        modified: u64,
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
        let identity = [MAGIC, plan.records, modified, width, start, end, kind, chunk];
        let (runs, certificate) = (plan.runs(), Multiset::default());
        let mut journal = Self { identity, runs, runs_done: 0, certificate };
        let (first, mut slot) = (journal.slot(&identity), [0; SLOT]);
        let start = &mut slot[..length.min(SLOT as u64) as usize];
        file.read(start, 0)?;
        if !first.starts_with(start) {
            return Err(Error::Option {
                name: "resume",
                value: file.path().to_owned(),
                expected: "a file of the same sort: same input, layout and memory; or none",
            });
        }
        // Nothing yet, or what a disk had room for that then was full.
        if start.len() < SLOT {
            file.write(&first, 0)?;
            return Ok(journal);
        }
        for run in 0..runs {
            let at = Self::place(run);
            if at + SLOT as u64 > length {
                break;
            }
            file.read(&mut slot, at)?;
            let word = |i: usize| u64::from_le_bytes(slot.as_chunks::<8>().0[i]);
            let hash = u128::from(word(3)) << 64 | u128::from(word(2));
            let certificate = Multiset { records: word(1), hash };
            if slot != journal.entry(run, &certificate) {
                break;
            }
            (journal.runs_done, journal.certificate) = (run + 1, certificate);
        }
        Ok(journal)
    }

    /// Where runs start.
    pub(super) fn data_start(&self) -> u64 {
        Self::place(self.runs).next_multiple_of(PAGE as u64)
    }

    /// Runs that are complete.
    pub(super) fn runs_done(&self) -> u64 {
        self.runs_done
    }

    /// Of the records in these.
    pub(super) fn certificate(&self) -> Multiset {
        self.certificate
    }

    /// Says that `run` is complete, after which all runs so far have this certificate.
    pub(super) fn enter<S: Store>(
        &self,
        run: u64,
        certificate: &Multiset,
        file: &mut Medium<S>,
    ) -> Result<(), Error> {
        file.write(&self.entry(run, certificate), Self::place(run))
    }

    fn place(run: u64) -> u64 {
        (run + 1) * SLOT as u64
    }

    fn entry(&self, run: u64, certificate: &Multiset) -> [u8; SLOT] {
        let [low, high] = [certificate.hash as u64, (certificate.hash >> 64) as u64];
        self.slot(&[run, certificate.records, low, high])
    }

    /// Words, zeros, and a checksum of them and of the identity.
    fn slot(&self, words: &[u64]) -> [u8; SLOT] {
        let mut slot = [0; SLOT];
        let (places, _) = slot.as_chunks_mut::<8>();
        for (place, word) in places.iter_mut().zip(words) {
            *place = word.to_le_bytes();
        }
        let all: Vec<u8> =
            self.identity.iter().chain(words).flat_map(|word| word.to_le_bytes()).collect();
        let sum = digest::hash(&all).to_le_bytes();
        slot[SLOT - sum.len()..].copy_from_slice(&sum);
        slot
    }
}
