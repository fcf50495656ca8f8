//! A folder of tiles against the triangulation in memory; crashes at any file; threads; heaps.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use taut_points::{Distribution, GeneratedSource, Points, ScalarKind};

use super::*;
use crate::outofcore::Tile;
use crate::test_length::long_or;
use crate::{DelaunayOptions, delaunay};

fn options() -> FolderOptions<'static> {
    FolderOptions { memory: 64 << 20, threads: Some(2), ..FolderOptions::default() }
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
    entries.map(|path| (name(&path), fs::read(&path).unwrap())).collect()
}

/// The tiles of a folder add up to what its manifest says.
fn check_tiles<const D: usize>(folder: &Path, found: &TiledTriangulation) {
    let mut totals = Totals::default();
    for &(tile, bytes) in &found.tiles {
        let data = fs::read(folder.join(tile_name(tile))).unwrap();
        assert_eq!(data.len() as u64, bytes);
        totals += &Tile::<D>::from_bytes(&data).unwrap().counts;
    }
    let Totals { front_sites, merged_sites, root_sites, .. } = found.totals;
    assert_eq!(Totals { front_sites, merged_sites, root_sites, ..totals }, found.totals);
}

fn same_as_in_memory<const D: usize>(source: &dyn PointSource) -> TiledTriangulation {
    let folder = tempfile::tempdir().unwrap();
    let found = delaunay_to_folder(source, folder.path(), &options()).unwrap();
    let expected = delaunay(source, &DelaunayOptions::default()).unwrap();
    assert_eq!(found.totals.fingerprint, expected.certificate.fingerprint);
    assert_eq!(found.points_hash, expected.certificate.points_hash);
    let counts = expected.certificate.counts;
    assert_eq!(found.totals.sites, counts.sites);
    assert_eq!(found.totals.simplices, counts.simplices);
    check_tiles::<D>(folder.path(), &found);
    assert!(!folder.path().join("work").exists());
    found
}

#[test]
fn a_folder_holds_the_triangulation_in_memory() {
    let generated = |distribution, n, dim| {
        GeneratedSource::new(distribution, n, dim, 3, ScalarKind::F64).unwrap()
    };
    let found =
        same_as_in_memory::<2>(&generated(Distribution::Uniform, long_or(250_000, 120_000), 2));
    assert!(found.tiles.len() > long_or(4, 2), "{found:?}");
    let side = long_or(300, 120);
    same_as_in_memory::<2>(&generated(Distribution::Kuzmin, side * side, 2));
    same_as_in_memory::<2>(&generated(Distribution::Grid { side, angle: 0.0 }, side * side, 2));
    let found =
        same_as_in_memory::<3>(&generated(Distribution::Uniform, long_or(150_000, 60_000), 3));
    assert!(found.tiles.len() > long_or(4, 2), "{found:?}");
    same_as_in_memory::<2>(&generated(Distribution::Uniform, 3, 2));
    same_as_in_memory::<3>(&generated(Distribution::Uniform, 0, 3));
}

/// Single-precision points, most of them in one heap that the planned buckets cannot hold.
#[test]
fn heaps_are_cut_again() {
    let mut values: Vec<f32> = Vec::new();
    let mut state = 1u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 40) as f32 / (1u64 << 24) as f32
    };
    // A run of the sample takes 32 rows in 92, so it misses a heap behind equal points that looks like one of them.
    for i in 0..300_000 {
        let (x, y) = (next(), next());
        let p = if i % 3 == 0 { [x, y] } else { [0.5 + x * 1e-4, 0.5 + y * 1e-4] };
        let p = if i % 5 == 0 { [0.25, 0.75] } else { p };
        values.extend(p);
    }
    let points = Points::new(&values, 2).unwrap();
    let found = same_as_in_memory::<2>(&points);
    assert!(found.totals.duplicates >= 59_999, "{found:?}");
}

#[test]
fn bytes_do_not_depend_on_threads() {
    let n = long_or(300_000, 230_000);
    let source = GeneratedSource::new(Distribution::Uniform, n, 2, 5, ScalarKind::F64).unwrap();
    let written = long_or(&[1, 2, 3, 8][..], &[1, 8]).iter().map(|&threads| {
        let folder = tempfile::tempdir().unwrap();
        let options = FolderOptions { threads: Some(threads), ..options() };
        delaunay_to_folder(&source, folder.path(), &options).unwrap();
        files(folder.path())
    });
    let written: Vec<_> = written.collect();
    assert!(written.iter().all(|other| *other == written[0]));
}

/// Stops the work after so many points, again and again, each time a little later.
#[test]
fn a_stopped_run_is_resumed_to_the_same_bytes() {
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
    let n = long_or(300_000, 230_000);
    let source = GeneratedSource::new(Distribution::Uniform, n, 2, 5, ScalarKind::F64).unwrap();
    let whole = tempfile::tempdir().unwrap();
    delaunay_to_folder(&source, whole.path(), &options()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut stops = 0;
    for round in 0..200u64 {
        let (cancel, seen) = (AtomicBool::new(false), AtomicU64::new(0));
        let allowed = 20_000 + round * long_or(10_000, 30_000);
        let count = |points: u64| {
            if seen.fetch_add(points, Ordering::Relaxed) + points > allowed {
                cancel.store(true, Ordering::Relaxed);
            }
        };
        let monitor =
            Monitor { on_points: Some(&count), cancel: Some(&cancel), ..Monitor::silent() };
        let again = FolderOptions { resume: round > 0, monitor, ..options() };
        match delaunay_to_folder(&source, folder.path(), &again) {
            Ok(_) => break,
            Err(Error::Input(InputError::Cancelled(_) | InputError::Read(_))) => stops += 1,
            Err(error) => panic!("{error}"),
        }
    }
    assert!(stops > 5, "{stops} stops");
    assert!(files(folder.path()) == files(whole.path()));
}

#[test]
fn other_points_and_taken_folders_are_refused() {
    let of_seed =
        |seed| GeneratedSource::new(Distribution::Uniform, 5000, 2, seed, ScalarKind::F64);
    let (ours, other) = (of_seed(1).unwrap(), of_seed(2).unwrap());
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("a file"), "of somebody").unwrap();
    let refused = delaunay_to_folder(&ours, folder.path(), &options());
    assert!(matches!(refused, Err(Error::FolderTaken { .. })));
    let folder = tempfile::tempdir().unwrap();
    let cancel = std::sync::atomic::AtomicBool::new(false);
    let stop = |pass: u64, _: u64| cancel.store(pass == 2, std::sync::atomic::Ordering::Relaxed);
    let monitor = Monitor { on_pass: Some(&stop), cancel: Some(&cancel), ..Monitor::silent() };
    let stopped = FolderOptions { monitor, ..options() };
    assert!(delaunay_to_folder(&ours, folder.path(), &stopped).is_err());
    let again = FolderOptions { resume: true, ..options() };
    let refused = delaunay_to_folder(&other, folder.path(), &again);
    assert!(matches!(refused, Err(Error::OtherInput { .. })), "{refused:?}");
    let found = delaunay_to_folder(&ours, folder.path(), &again).unwrap();
    // A complete folder is given back as it is.
    assert_eq!(delaunay_to_folder(&ours, folder.path(), &again).unwrap(), found);
    // But not as the answer to other points, of which there are as many.
    let refused = delaunay_to_folder(&other, folder.path(), &again);
    assert!(matches!(refused, Err(Error::OtherInput { .. })), "{refused:?}");
}

#[test]
fn a_complete_folder_loses_no_file_that_is_not_ours() {
    let source = GeneratedSource::new(Distribution::Uniform, 500, 2, 1, ScalarKind::F64).unwrap();
    let folder = tempfile::tempdir().unwrap();
    delaunay_to_folder(&source, folder.path(), &options()).unwrap();
    let mine = folder.path().join("work/mine.txt");
    fs::create_dir(folder.path().join("work")).unwrap();
    fs::write(&mine, "of somebody").unwrap();
    fs::write(folder.path().join("work/bucket-00000000"), "left behind").unwrap();
    let again = FolderOptions { resume: true, ..options() };
    delaunay_to_folder(&source, folder.path(), &again).unwrap();
    assert_eq!(files(&folder.path().join("work")).into_keys().collect::<Vec<_>>(), ["mine.txt"]);
}

/// Rows that were not distributed yet may have changed: then the sample, and with it the cells, are others.
#[test]
fn a_distribution_by_another_sample_is_refused() {
    let source = GeneratedSource::new(Distribution::Uniform, 5000, 2, 1, ScalarKind::F64).unwrap();
    let place = tempfile::tempdir().unwrap();
    let folder = Folder::new(place.path());
    fs::create_dir(folder.work()).unwrap();
    let plan = DiskPlan::new(5000, 2, 64 << 20, 1).unwrap();
    let cells = 1usize << plan.router_levels();
    Commit::<2>::new(1, 1 << plan.levels, cells).write(&folder.commit()).unwrap();
    let refused = cut_points::<2>(&source, &plan, &folder, 1, &Monitor::silent());
    assert!(matches!(refused, Err(Error::OtherInput { .. })));
    remove(&folder.commit()).unwrap();
    assert!(cut_points::<2>(&source, &plan, &folder, 1, &Monitor::silent()).is_ok());
}

#[test]
fn what_is_not_finite_is_named() {
    let mut values = vec![0.5; 40_000];
    values[30_001] = f64::NAN;
    let points = Points::new(&values, 2).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let refused = delaunay_to_folder(&points, folder.path(), &options()).unwrap_err();
    assert!(refused.to_string().contains("coordinate 1 of point 15000"), "{refused}");
    // Nothing is left, so that the same folder takes the mended points.
    assert_eq!(files(folder.path()).len(), 0);
    let made = folder.path().join("made");
    assert!(delaunay_to_folder(&points, &made, &options()).is_err());
    assert!(!made.exists());
    values[30_001] = 0.25;
    let points = Points::new(&values, 2).unwrap();
    assert!(delaunay_to_folder(&points, &made, &options()).is_ok());
}

/// Nothing on a circle is final before the root, so all sites come together there.
#[test]
fn a_front_beyond_the_memory_is_refused_and_resumed_with_more() {
    let source = GeneratedSource::new(Distribution::Sphere, 400_000, 2, 5, ScalarKind::F64);
    let source = source.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let refused = delaunay_to_folder(&source, folder.path(), &options());
    let Err(Error::Memory { sites, needed, budget }) = refused else {
        panic!("{refused:?}");
    };
    assert!(sites > 300_000 && needed > budget, "{sites} sites, {needed} bytes of {budget}");
    let more = FolderOptions { memory: 2 * needed, resume: true, ..options() };
    let found = delaunay_to_folder(&source, folder.path(), &more).unwrap();
    let expected = delaunay(&source, &DelaunayOptions::default()).unwrap();
    assert_eq!(found.totals.fingerprint, expected.certificate.fingerprint);
    check_tiles::<2>(folder.path(), &found);
}

/// A file of the work that was changed is an error, not a wrong triangulation.
#[test]
fn damaged_files_are_refused() {
    let source = GeneratedSource::new(Distribution::Uniform, 300_000, 2, 5, ScalarKind::F64);
    let source = source.unwrap();
    for name in ["manifest.txt", "work/tree", "work/bucket"] {
        let folder = tempfile::tempdir().unwrap();
        let cancel = std::sync::atomic::AtomicBool::new(false);
        let stop =
            |pass: u64, _: u64| cancel.store(pass == 2, std::sync::atomic::Ordering::Relaxed);
        let monitor = Monitor { on_pass: Some(&stop), cancel: Some(&cancel), ..Monitor::silent() };
        let stopped = FolderOptions { monitor, ..options() };
        assert!(delaunay_to_folder(&source, folder.path(), &stopped).is_err());
        let mut path = folder.path().join(name);
        if name.ends_with("bucket") {
            let names = files(&folder.path().join("work")).into_keys();
            let bucket = names.filter(|name| name.starts_with("bucket")).min().unwrap();
            path = folder.path().join("work").join(bucket);
        }
        let mut bytes = fs::read(&path).unwrap();
        bytes.truncate(bytes.len() - 20);
        fs::write(&path, bytes).unwrap();
        let again = FolderOptions { resume: true, ..options() };
        let refused = delaunay_to_folder(&source, folder.path(), &again);
        assert!(matches!(refused, Err(Error::DamagedFolder { .. })), "{name}: {refused:?}");
    }
}

/// Stops a triangulation half-way, and flips a bit of its first tile. Returns the number of this, its path, and its bytes before.
fn stopped_with_a_wrong_bit(source: &dyn PointSource, folder: &Path) -> (u32, PathBuf, Vec<u8>) {
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
    let (cancel, seen) = (AtomicBool::new(false), AtomicU64::new(0));
    let count = |points: u64| {
        // All are read, and half of them are triangulated.
        if seen.fetch_add(points, Ordering::Relaxed) + points > 450_000 {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let monitor = Monitor { on_points: Some(&count), cancel: Some(&cancel), ..Monitor::silent() };
    let stopped = FolderOptions { monitor, ..options() };
    assert!(delaunay_to_folder(source, folder, &stopped).is_err());
    let tile = (0..1000).find(|&node| folder.join(tile_name(node)).exists()).unwrap();
    let path = folder.join(tile_name(tile));
    let whole = fs::read(&path).unwrap();
    let mut bytes = whole.clone();
    bytes[whole.len() / 3] ^= 4;
    // So long that the clock of files has moved on.
    std::thread::sleep(std::time::Duration::from_millis(20));
    fs::write(&path, bytes).unwrap();
    (tile, path, whole)
}

#[test]
fn a_tile_that_was_changed_is_not_resumed() {
    let source = GeneratedSource::new(Distribution::Uniform, 300_000, 2, 5, ScalarKind::F64);
    let source = source.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (_, tile, whole) = stopped_with_a_wrong_bit(&source, folder.path());
    let again = FolderOptions { resume: true, ..options() };
    let refused = delaunay_to_folder(&source, folder.path(), &again);
    let name = tile.display().to_string();
    assert!(matches!(&refused, Err(Error::DamagedFolder { path }) if *path == name), "{refused:?}");
    fs::write(&tile, whole).unwrap();
    let found = delaunay_to_folder(&source, folder.path(), &again).unwrap();
    check_tiles::<2>(folder.path(), &found);
}

/// A tile with a note is not read again: a wrong bit in it is not seen if the note is of the file that has it.
#[test]
fn a_tile_that_nobody_wrote_to_is_not_read_again() {
    let source = GeneratedSource::new(Distribution::Uniform, 300_000, 2, 5, ScalarKind::F64);
    let source = source.unwrap();
    let folder = tempfile::tempdir().unwrap();
    let (node, tile, whole) = stopped_with_a_wrong_bit(&source, folder.path());
    let stamps = Folder::new(folder.path()).stamps();
    let found = fs::metadata(&tile).unwrap();
    Stamps::open(&stamps).note(node, &found);
    let again = FolderOptions { resume: true, ..options() };
    let resumed = delaunay_to_folder(&source, folder.path(), &again);
    if Stamps::has_notes_in(folder.path()) {
        resumed.unwrap();
        let at = whole.len() / 3;
        assert_ne!(fs::read(&tile).unwrap()[at], whole[at]);
        let verdict = taut_certify::check_tiles(folder.path(), &source, &Default::default());
        assert!(verdict.is_err());
    } else {
        assert!(matches!(&resumed, Err(Error::DamagedFolder { .. })), "{resumed:?}");
    }
}

/// A process that is killed before the manifest is there leaves a folder that a resumed run takes, and no other.
#[test]
fn a_run_that_ended_before_its_manifest_is_resumed() {
    let source = GeneratedSource::new(Distribution::Uniform, 5000, 2, 5, ScalarKind::F64);
    let source = source.unwrap();
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("work")).unwrap();
    fs::write(folder.path().join("work").join("lock"), "").unwrap();
    fs::write(folder.path().join("manifest.part"), "format").unwrap();
    let refused = delaunay_to_folder(&source, folder.path(), &options());
    assert!(matches!(refused, Err(Error::FolderTaken { .. })), "{refused:?}");
    let again = FolderOptions { resume: true, ..options() };
    fs::write(folder.path().join("work").join("other"), "").unwrap();
    let refused = delaunay_to_folder(&source, folder.path(), &again);
    assert!(matches!(refused, Err(Error::FolderTaken { .. })), "{refused:?}");
    fs::remove_file(folder.path().join("work").join("other")).unwrap();
    let found = delaunay_to_folder(&source, folder.path(), &again).unwrap();
    check_tiles::<2>(folder.path(), &found);
}

/// The disk that a check takes, of uniform points, is known before to a fourth.
#[test]
fn the_disk_of_the_check_is_estimated() {
    use std::sync::atomic::{AtomicU64, Ordering};

    for (n, dim, side_bytes) in [(250_000, 2, 112), (80_000, 3, 176)] {
        let source =
            GeneratedSource::new(Distribution::Uniform, n, dim, 5, ScalarKind::F64).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let found = delaunay_to_folder(&source, folder.path(), &options()).unwrap();
        let plan = plan_folder(&source, options().memory, 2).unwrap();
        let sides = AtomicU64::new(0);
        // Pass 3 goes through the sides of facets that wait on the disk.
        let on_pass = |pass: u64, items: u64| {
            if pass == 3 {
                sides.store(items, Ordering::Relaxed);
            }
        };
        let monitor = Monitor { on_pass: Some(&on_pass), ..Monitor::silent() };
        let memory = 16 << 20;
        let options = taut_certify::TilesOptions { memory, monitor, ..Default::default() };
        taut_certify::check_tiles(folder.path(), &source, &options).unwrap();
        let sites = found.totals.sites + found.totals.front_sites;
        let taken = sides.into_inner() * side_bytes + sites * (4 + 8 * dim as u64);
        let told = taut_certify::check_tiles_disk(n, dim, 1 << plan.levels, memory);
        assert!(taken.abs_diff(told) < taken / 4, "{dim}: {told} told, {taken} taken");
    }
}
