//! Going on where another process stopped.

use super::*;
use crate::test_length::long_or;

const N: u64 = 40_000;

fn options(folder: &Folder) -> FileSortOptions {
    FileSortOptions { memory: MEMORY_MIN, resume: Some(folder.path("runs")), ..Default::default() }
}

/// Sorts until so many records were told of.
fn stop_at(folder: &Folder, limit: u64) {
    let (cancel, points) = (AtomicBool::new(false), AtomicU64::new(0));
    let count = |more: u64| {
        if points.fetch_add(more, Ordering::Relaxed) + more >= limit {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let monitor = Monitor { on_points: Some(&count), cancel: Some(&cancel), ..Monitor::silent() };
    let stopped = folder.sort_with(&whole_number(32), &options(folder), &monitor);
    assert!(matches!(stopped, Err(Error::Cancelled(_))));
    assert_eq!(folder.names(), ["in", "runs"]);
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn runs_that_are_there_are_not_made_again() {
    let bytes = records(N, 32, 0, 0xFFFF);
    let folder = Folder::with(&bytes);
    let mut before = 0;
    let limits = [9000, 20_000, 39_000, N + 5000, 2 * N - 2000];
    for limit in limits.into_iter().step_by(long_or(1, 4)) {
        stop_at(&folder, limit);
        let monitor = Monitor::silent();
        let kept = fs::read(folder.path("runs")).expect("runs");
        let found =
            folder.sort_with(&whole_number(32), &options(&folder), &monitor).expect("sorted");
        assert!(found.runs_resumed >= before && found.runs_resumed <= found.runs, "{found:?}");
        assert!(found.runs_resumed > 0);
        before = found.runs_resumed;
        // What the runs that were there were made of was read once more.
        assert!(found.bytes_read >= 2 * bytes.len() as u64, "{found:?}");
        assert_eq!(folder.names(), ["in", "out"]);
        let output = fs::read(folder.path("out")).expect("an output");
        assert!(output == expected(&bytes, &whole_number(32)));
        fs::remove_file(folder.path("out")).expect("removed");
        fs::write(folder.path("runs"), kept).expect("written");
    }
    assert_eq!(before, 27, "all of the runs");
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn an_entry_that_was_torn_counts_as_absent() {
    let bytes = records(N, 32, 0, u64::MAX);
    let folder = Folder::with(&bytes);
    stop_at(&folder, 20_000);
    let mut runs = fs::read(folder.path("runs")).expect("runs");
    runs[128 * 4 + 9] ^= 1;
    fs::write(folder.path("runs"), runs).expect("written");
    let monitor = Monitor::silent();
    let found = folder.sort_with(&whole_number(32), &options(&folder), &monitor).expect("sorted");
    assert_eq!(found.runs_resumed, 3);
    assert!(
        fs::read(folder.path("out")).expect("an output") == expected(&bytes, &whole_number(32))
    );
}

/// A run that changed behind the journal's back.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_run_that_is_not_what_it_was_is_found_out() {
    let folder = Folder::with(&records(N, 32, 0, u64::MAX));
    stop_at(&folder, 20_000);
    let mut runs = fs::read(folder.path("runs")).expect("runs");
    runs[4096 * 3] ^= 1;
    fs::write(folder.path("runs"), runs).expect("written");
    let result = folder.sort_with(&whole_number(32), &options(&folder), &Monitor::silent());
    assert!(matches!(result, Err(Error::DamagedRuns { .. })), "{result:?}");
    assert!(result.expect_err("damaged").to_string().contains("remove the file and sort again"));
    assert_eq!(folder.names(), ["in", "runs"]);
}

/// The journal stands at the front, the runs do not: as after a copy that was cut off.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn runs_that_the_file_is_too_short_for_are_made_again() {
    let bytes = records(N, 32, 0, u64::MAX);
    let folder = Folder::with(&bytes);
    stop_at(&folder, 20_000);
    let kept = fs::read(folder.path("runs")).expect("runs");
    for (length, resumed) in [(256, 0), (4096, 0), (4096 + 48_000 * 2 - 1, 1)] {
        fs::write(folder.path("runs"), &kept[..length]).expect("written");
        let monitor = Monitor::silent();
        let found =
            folder.sort_with(&whole_number(32), &options(&folder), &monitor).expect("sorted");
        assert_eq!(found.runs_resumed, resumed, "{length} bytes");
        let output = fs::read(folder.path("out")).expect("an output");
        assert!(output == expected(&bytes, &whole_number(32)));
    }
}

/// Another file of the same length and time, in its place or beside it.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn another_input_that_is_as_old_is_refused() {
    let bytes = records(N, 32, 0, u64::MAX);
    let folder = Folder::with(&bytes);
    stop_at(&folder, 20_000);
    let time = fs::metadata(folder.path("in")).and_then(|about| about.modified()).expect("a time");
    let other = records(N, 32, 8, u64::MAX);
    let as_old = |name: &str| {
        let file = fs::File::options().write(true).open(folder.path(name)).expect("a file");
        file.set_modified(time).expect("set");
    };
    let refused = || {
        let error = folder.sort_with(&whole_number(32), &options(&folder), &Monitor::silent());
        let error = error.expect_err("refused").to_string();
        assert!(error.contains("`resume`"), "{error}");
    };
    fs::write(folder.path("other"), &other).expect("written");
    as_old("other");
    fs::rename(folder.path("in"), folder.path("kept")).expect("renamed");
    fs::rename(folder.path("other"), folder.path("in")).expect("renamed");
    refused();
    fs::rename(folder.path("kept"), folder.path("in")).expect("renamed");
    fs::write(folder.path("in"), &other).expect("written");
    as_old("in");
    refused();
    assert_eq!(folder.names(), ["in", "runs"]);
}

/// Two records of a run that changed places: the same records, and each entry of the journal still holds.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_run_that_is_out_of_order_is_found_out() {
    let long = layout(32, 0..20, KeyKind::Bytes);
    for (layout, mask) in [(whole_number(32), u64::MAX), (long, 0)] {
        let mut bytes = records(N, 32, 0, mask);
        // Keys that agree in their first eight bytes, and behind them are all different.
        for (i, record) in bytes.chunks_exact_mut(32).enumerate() {
            record[8..16].copy_from_slice(&word(i as u64).to_le_bytes());
        }
        let folder = Folder::with(&bytes);
        let limit = std::sync::atomic::AtomicU64::new(0);
        let cancel = AtomicBool::new(false);
        let count = |more: u64| {
            let told = limit.fetch_add(more, Ordering::Relaxed) + more;
            cancel.store(told >= 20_000, Ordering::Relaxed);
        };
        let monitor =
            Monitor { on_points: Some(&count), cancel: Some(&cancel), ..Monitor::silent() };
        let stopped = folder.sort_with(&layout, &options(&folder), &monitor);
        assert!(matches!(stopped, Err(Error::Cancelled(_))));
        let whole = fs::read(folder.path("runs")).expect("runs");
        // Within a run, at its start, and on both sides of where a block ends.
        for record in [700, 0, 1, 1400] {
            let mut runs = whole.clone();
            let (data, size) = (4096, 32);
            let (head, tail) = runs[data + record * size..][..5 * size].split_at_mut(size);
            head.swap_with_slice(&mut tail[3 * size..]);
            fs::write(folder.path("runs"), runs).expect("written");
            let result = folder.sort_with(&layout, &options(&folder), &Monitor::silent());
            let Err(error @ Error::UnsortedRun { offset: 4096, .. }) = result else {
                panic!("{result:?}")
            };
            assert!(error.to_string().contains("runs"), "{error}");
            assert_eq!(folder.names(), ["in", "runs"]);
        }
        fs::write(folder.path("runs"), whole).expect("written");
        folder.sort_with(&layout, &options(&folder), &Monitor::silent()).expect("sorted");
        assert!(fs::read(folder.path("out")).expect("an output") == expected(&bytes, &layout));
    }
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn runs_of_another_sort_are_refused_and_left_alone() {
    let folder = Folder::with(&records(N, 32, 0, u64::MAX));
    stop_at(&folder, 20_000);
    let before = fs::read(folder.path("runs")).expect("runs");
    let refuse = |layout: &RecordLayout, options: &FileSortOptions| {
        let error = folder.sort_with(layout, options, &Monitor::silent()).expect_err("refused");
        assert!(error.to_string().contains("`resume`"), "{error}");
        assert_eq!(folder.names(), ["in", "runs"]);
    };
    refuse(&layout(32, 8..16, KeyKind::U64), &options(&folder));
    refuse(&layout(32, 0..8, KeyKind::I64), &options(&folder));
    refuse(&whole_number(16), &options(&folder));
    refuse(&whole_number(32), &FileSortOptions { memory: MEMORY_MIN * 2, ..options(&folder) });
    fs::write(folder.path("in"), records(N, 32, 0, 0xFF)).expect("written");
    refuse(&whole_number(32), &options(&folder));
    assert!(fs::read(folder.path("runs")).expect("runs") == before);
}

/// What is left if the disk was full within the first entry.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_first_entry_that_was_cut_is_written_again() {
    let bytes = records(N, 32, 0, u64::MAX);
    let folder = Folder::with(&bytes);
    stop_at(&folder, 20_000);
    let runs = fs::read(folder.path("runs")).expect("runs");
    for length in [0, 7, 127] {
        fs::write(folder.path("runs"), &runs[..length]).expect("written");
        stop_at(&folder, 20_000);
        assert!(fs::read(folder.path("runs")).expect("runs") == runs);
        fs::write(folder.path("runs"), &runs[..length]).expect("written");
        let other = folder.sort_with(&whole_number(16), &options(&folder), &Monitor::silent());
        // Of which sort it is, is said behind the first word.
        let is_other = length > 8;
        assert_eq!(other.is_err(), is_other, "{length} bytes: {other:?}");
        if !is_other {
            fs::remove_file(folder.path("out")).expect("removed");
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn files_of_others_are_not_taken_for_runs() {
    let folder = Folder::with(&records(N, 32, 0, u64::MAX));
    fs::write(folder.path("runs"), "a short letter").expect("written");
    let resumed = |name: &str| {
        let options = FileSortOptions { resume: Some(folder.path(name)), ..options(&folder) };
        let error = folder.sort_with(&whole_number(32), &options, &Monitor::silent());
        let error = error.expect_err("refused").to_string();
        assert!(error.contains("`resume`"), "{error}");
    };
    let input = fs::read(folder.path("in")).expect("records");
    for name in ["runs", "in", "out"] {
        resumed(name);
        assert_eq!(folder.names(), ["in", "runs"]);
    }
    assert_eq!(fs::read(folder.path("runs")).expect("as it was"), b"a short letter");
    assert!(fs::read(folder.path("in")).expect("as it was") == input);
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn what_fits_needs_no_runs_and_those_that_are_there_are_of_another_sort() {
    let folder = Folder::with(&records(N, 32, 0, u64::MAX));
    stop_at(&folder, 20_000);
    let sort = || {
        let options = FileSortOptions { memory: 2 << 20, ..options(&folder) };
        folder.sort_with(&whole_number(32), &options, &Monitor::silent())
    };
    let error = sort().expect_err("refused").to_string();
    assert!(error.contains("`resume`"), "{error}");
    assert_eq!(folder.names(), ["in", "runs"]);
    fs::remove_file(folder.path("runs")).expect("removed");
    assert_eq!(sort().expect("sorted").runs, 1);
    assert_eq!(folder.names(), ["in", "out"]);
}
