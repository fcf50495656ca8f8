//! Disks that read and write by halves, are interrupted, are full, or forget.

use std::io;
use std::sync::Mutex;

use super::*;
use crate::sort::external::engine;
use crate::sort::external::journal::Journal;
use crate::sort::external::medium::Medium;
use crate::sort::external::plan::Plan;
use crate::store::Store;

/// A record has this many bytes: an interpreter has time for few, and runs are as long as memory has room.
const RECORD_BYTES: usize = if cfg!(miri) { 900 } else { 16 };

/// Returns what an interpreter has time for, or else all.
fn miri_or(few: u64, all: u64) -> u64 {
    if cfg!(miri) { few } else { all }
}

/// A disk in memory, and what is wrong with it.
#[derive(Default)]
struct Disk {
    bytes: Mutex<Vec<u8>>,
    calls: AtomicU64,
    /// Calls move part of what they could, and every fifth is interrupted.
    by_halves: bool,
    /// Writing beyond so many bytes fails.
    room: Option<u64>,
    /// Reserving tells of that.
    tells: bool,
    /// This byte is read with a bit turned.
    forgets: Option<usize>,
}

impl Disk {
    fn with(bytes: &[u8]) -> Self {
        Self { bytes: Mutex::new(bytes.to_vec()), ..Self::default() }
    }

    /// Returns how much of a call is done.
    fn part(&self, bytes: usize) -> io::Result<usize> {
        match word(self.calls.fetch_add(1, Ordering::Relaxed)) % 5 {
            0 if self.by_halves => Err(io::ErrorKind::Interrupted.into()),
            share if self.by_halves => Ok((bytes * share as usize / 4).max(1).min(bytes)),
            _ => Ok(bytes),
        }
    }
}

impl Store for Disk {
    fn read_at(&self, to: &mut [u8], offset: u64) -> io::Result<usize> {
        let (bytes, offset) = (self.bytes.lock().expect("no panic"), offset as usize);
        let part = self.part(to.len().min(bytes.len().saturating_sub(offset)))?;
        to[..part].copy_from_slice(&bytes[offset..offset + part]);
        if let Some(lost) = self.forgets.filter(|lost| (offset..offset + part).contains(lost)) {
            to[lost - offset] ^= 4;
        }
        Ok(part)
    }

    fn write_at(&self, from: &[u8], offset: u64) -> io::Result<usize> {
        let part = self.part(from.len())?;
        let end = offset as usize + part;
        if self.room.is_some_and(|room| end as u64 > room) {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let mut bytes = self.bytes.lock().expect("no panic");
        let length = bytes.len().max(end);
        bytes.resize(length, 0);
        bytes[end - part..end].copy_from_slice(&from[..part]);
        Ok(part)
    }

    fn reserve(&self, bytes: u64) -> io::Result<()> {
        match self.room {
            Some(room) if self.tells && bytes > room => Err(io::ErrorKind::StorageFull.into()),
            _ => Ok(()),
        }
    }

    fn sync(&self) -> io::Result<()> {
        self.part(1).map(|_| ())
    }
}

/// Sorts from disk to disk by way of a third.
fn sort(
    input: Disk,
    runs: Disk,
    output: Disk,
    memory: usize,
) -> Result<(FileSort, Vec<u8>), Error> {
    let layout = whole_number(RECORD_BYTES);
    let records = input.bytes.lock().expect("no panic").len() as u64 / RECORD_BYTES as u64;
    let plan = Plan::new(&layout, records, memory)?;
    let [mut input, mut runs, mut output] = [(input, "input"), (runs, "runs"), (output, "output")]
        .map(|(d, p)| Medium::new(d, p.into()));
    let monitor = Monitor::silent();
    let found = engine::beyond(&plan, &mut input, &mut runs, None, &mut output, &monitor)?;
    Ok((found, output.into_store().bytes.into_inner().expect("no panic")))
}

#[test]
fn short_and_interrupted_calls_change_nothing() {
    let bytes = records(miri_or(75, 50_000), RECORD_BYTES, 0, 0xFFFFF);
    let halves = || Disk { by_halves: true, ..Disk::default() };
    let input = Disk { by_halves: true, ..Disk::with(&bytes) };
    let (found, sorted) = sort(input, halves(), halves(), MEMORY_MIN).expect("sorted");
    assert!(found.runs > miri_or(1, 15), "{found:?}");
    assert!(sorted == expected(&bytes, &whole_number(RECORD_BYTES)));
}

/// More runs than can be merged at once: twenty and four hundred, which takes three levels.
#[test]
#[cfg_attr(miri, ignore = "six hundred thousand records")]
fn many_runs_are_merged_in_steps() {
    for n in [52_000, 600_000] {
        let bytes = records(n, RECORD_BYTES, 0, 0xFFFFF);
        let (found, sorted) =
            sort(Disk::with(&bytes), Disk::default(), Disk::default(), MEMORY_MIN).expect("sorted");
        assert!(
            found.bytes_read > 2 * bytes.len() as u64 && found.bytes_read < 5 * bytes.len() as u64
        );
        assert!(sorted == expected(&bytes, &whole_number(RECORD_BYTES)));
    }
}

#[test]
fn a_full_disk_is_told_whenever_it_is_full() {
    let bytes = records(miri_or(75, 20_000), RECORD_BYTES, 0, u64::MAX);
    let size = bytes.len() as u64;
    for room in [4097, size - 1, 0, 1, size / 3].into_iter().take(miri_or(1, 5) as usize) {
        for tells in [false, true] {
            let full = || Disk { room: Some(room), tells, ..Disk::default() };
            for (runs, output, name) in
                [(full(), Disk::default(), "runs"), (Disk::default(), full(), "output")]
            {
                let error =
                    sort(Disk::with(&bytes), runs, output, MEMORY_MIN).expect_err("no room");
                let Error::File { path, source } = error else { panic!("{error}") };
                assert_eq!((path.as_str(), source.kind()), (name, io::ErrorKind::StorageFull));
            }
        }
    }
}

#[test]
fn a_disk_that_forgets_is_found_out() {
    let bytes = records(miri_or(75, 20_000), RECORD_BYTES, 0, u64::MAX);
    let places = [9, 0, bytes.len() / 3, bytes.len() - 1];
    for lost in places.into_iter().take(miri_or(1, 4) as usize) {
        let runs = Disk { forgets: Some(lost), ..Disk::default() };
        let error =
            sort(Disk::with(&bytes), runs, Disk::default(), MEMORY_MIN).expect_err("forgotten");
        assert!(matches!(error, Error::ReadBack { .. }), "{error}");
    }
}

/// An input that became shorter while it was read.
#[test]
fn an_input_that_ends_too_soon_is_an_error() {
    let layout = whole_number(RECORD_BYTES);
    let plan = Plan::new(&layout, miri_or(75, 20_000), MEMORY_MIN).expect("a plan");
    let mut input = Medium::new(
        Disk::with(&records(miri_or(74, 19_999), RECORD_BYTES, 0, u64::MAX)),
        "input".into(),
    );
    let mut output = Medium::new(Disk::default(), "output".into());
    let mut runs = Medium::new(Disk::default(), "runs".into());
    let monitor = Monitor::silent();
    let error = engine::beyond(&plan, &mut input, &mut runs, None, &mut output, &monitor);
    assert!(matches!(error, Err(Error::File { path, source })
        if path == "input" && source.kind() == io::ErrorKind::UnexpectedEof));
}

/// The system says that the input is as it was, and it is not: one bit in a run that is there, or the places of two records
/// with the same key, which leave the multiset of the run as it was.
#[test]
fn an_input_that_changed_unseen_is_found_out() {
    let (layout, n) = (whole_number(RECORD_BYTES), miri_or(110, 20_000));
    let bytes = records(n, RECORD_BYTES, 0, miri_or(7, 0xFF));
    let plan = Plan::new(&layout, n, MEMORY_MIN).expect("a plan");
    let resume = |input: &[u8], kept: &[u8], limit: u64| {
        let (cancel, told) = (AtomicBool::new(false), AtomicU64::new(0));
        let count = |more: u64| {
            let told = told.fetch_add(more, Ordering::Relaxed) + more;
            cancel.store(told >= limit, Ordering::Relaxed);
        };
        let monitor =
            Monitor { on_points: Some(&count), cancel: Some(&cancel), ..Monitor::silent() };
        let [mut input, mut runs, mut output] =
            [(Disk::with(input), "input"), (Disk::with(kept), "runs"), (Disk::default(), "output")]
                .map(|(disk, path)| Medium::new(disk, path.into()));
        let found =
            Journal::open(&plan, [1, 2, 3], 0, kept.len() as u64, &mut runs).and_then(|j| {
                engine::beyond(&plan, &mut input, &mut runs, Some(&j), &mut output, &monitor)
            });
        let [runs, output] =
            [runs, output].map(|m| m.into_store().bytes.into_inner().expect("no panic"));
        (found, runs, output)
    };
    let (stopped, kept, _) = resume(&bytes, &[], n * 3 / 4);
    assert!(matches!(stopped, Err(Error::Cancelled(_))));
    let (found, _, output) = resume(&bytes, &kept, u64::MAX);
    assert_eq!(found.expect("sorted").runs_resumed, miri_or(1, 5));
    assert!(output == expected(&bytes, &layout));
    let mut flipped = bytes.clone();
    flipped[RECORD_BYTES * 10 + 12] ^= 1;
    let mut swapped = bytes.clone();
    let same = |i: &usize| bytes[RECORD_BYTES * i..][..8] == bytes[..8];
    let run = plan.made(0)[0].records as usize;
    let second = (1..run).find(same).expect("equal keys in the first run");
    let (head, tail) = swapped.split_at_mut(RECORD_BYTES * second);
    head[..RECORD_BYTES].swap_with_slice(&mut tail[..RECORD_BYTES]);
    for changed in [flipped, swapped] {
        let (found, after, output) = resume(&changed, &kept, u64::MAX);
        let error = found.expect_err("found out").to_string();
        assert!(error.contains("`resume`"), "{error}");
        assert!(output.is_empty() && after == kept);
    }
}
