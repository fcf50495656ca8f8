//! `taut delaunay -o FOLDER` and `taut verify FOLDER POINTS`: tiles within a limit on memory.

use std::fs;

use crate::test_folder::TestFolder;

fn folder() -> TestFolder {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 3000 -d 2 --seed 5 -o points.npy").ends(0);
    folder
}

/// The value of a line of the summary.
fn field(text: &str, name: &str) -> String {
    let line = text.lines().find_map(|line| line.trim().strip_prefix(name)).unwrap_or_default();
    line.split(';').next().unwrap_or_default().trim().to_owned()
}

#[test]
fn a_folder_gets_tiles_with_the_hash_of_the_triangulation_in_memory() {
    let folder = folder();
    let run = folder.taut("delaunay points.npy -o tiles/").ends(0).stdout_has(&[
        "Delaunay triangulation of 3000 points in the plane, in tiles\n",
        "\n  sites       3000; no two points are equal\n",
        "\n  verified    yes; the only one, with 0 ties decided by the perturbation\n",
        " in tiles/\n",
        "checking ",
    ]);
    assert_eq!(run.err, "");
    let expected = folder.taut("delaunay points.npy").ends(0);
    assert_eq!(field(&run.out, "fingerprint"), field(&expected.out, "fingerprint"));
    assert_eq!(folder.files(), ["points.npy", "tiles"]);
    let verified = folder.taut("verify tiles points.npy").ends(0).stdout_has(&[
        "Verified: the Delaunay triangulation of 3000 points in the plane\n",
        "\n  sites       3000; proved: distinct points\n",
        "; proved: neighbors, sites and counts of each agree with what all tiles together are\n",
    ]);
    assert_eq!(field(&verified.out, "fingerprint"), field(&expected.out, "fingerprint"));
    let quiet = folder.taut("verify tiles points.npy -q --memory 64M --scratch .").ends(0);
    assert_eq!((quiet.out.as_str(), quiet.err.as_str()), ("", ""));
}

#[test]
fn the_json_of_tiles_has_counts_and_the_verdict() {
    let folder = folder();
    let document = folder.taut("delaunay points.npy -o tiles/ --json --memory 64M").ends(0).json();
    assert_eq!(document["kind"], "delaunay-tiles");
    assert_eq!(document["answer"]["points"], 3000);
    assert_eq!(document["verdict"]["counts"]["sites"], 3000);
    assert_eq!(document["verdict"]["fingerprint"], document["answer"]["fingerprint"]);
    let again = folder.taut("delaunay points.npy -o other/ --json --no-verify").ends(0).json();
    assert_eq!(again["verdict"], serde_json::Value::Null);
    assert_eq!(again["answer"]["fingerprint"], document["answer"]["fingerprint"]);
}

/// The other formats, and points of space on a plane.
#[test]
fn points_of_any_format_get_tiles() {
    let folder = TestFolder::new();
    folder.taut("generate normal -n 800 -d 3 -o points.csv").ends(0);
    folder.taut("delaunay points.csv -o tiles/ --memory 64M").ends(0);
    folder.taut("verify tiles points.csv --memory 64M").ends(0).stdout_has(&["in space\n"]);
    folder.put("flat.csv", "0,0,1\n1,0,1\n0,1,1\n1,1,1\n0.5,0.5,1\n0,0,1\n");
    folder
        .taut("delaunay flat.csv -o flat/")
        .ends(0)
        .stdout_has(&["1 point equals an earlier one"]);
    folder.taut("verify flat flat.csv").ends(0);
    let points = folder.text("points.csv");
    let piped = folder.pipe(points, "delaunay - -o piped/ --json").ends(0);
    assert_eq!(piped.json()["answer"]["sites"], 800);
}

/// What would take more than the memory goes to tiles by itself; only the answer as JSON needs memory.
#[test]
fn points_that_do_not_fit_go_to_tiles() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 300000 -d 2 -o points.npy").ends(0);
    let refused = folder.taut("delaunay points.npy --memory 64M -o mesh.json").ends(2);
    assert!(refused.err.contains("name a folder for tiles with -o FOLDER/"), "{}", refused.err);
    assert!(
        refused.err.contains("73.2 MiB") && refused.err.contains("64.0 MiB"),
        "{}",
        refused.err
    );
    folder.taut("delaunay points.npy --memory 64M").ends(2);
    folder.taut("delaunay points.npy --memory 64M --resume -o mesh.ply").ends(2);
    assert_eq!(folder.files(), ["points.npy"]);
    let run = folder
        .taut("delaunay points.npy --memory 64M -o mesh.ply --progress always")
        .ends(0)
        .stdout_has(&[" for a while, on the disk\n", "\n  verified    yes; "]);
    assert!(run.err.contains("of disk will be taken while 300,000 points"), "{}", run.err);
    assert_eq!(folder.files(), ["mesh.ply", "points.npy"]);
    let verified = folder.taut("verify mesh.ply points.npy").ends(0);
    assert_eq!(field(&verified.out, "fingerprint"), field(&run.out, "fingerprint"));
    folder.taut("delaunay points.npy --memory 64M -o tiles").ends(0);
    assert!(folder.path("tiles/manifest.txt").is_file());
    folder.taut("delaunay points.npy --memory 200M -o mesh.json -q").ends(0);
}

/// Cells of tiles are those of memory, in another order, and so are alpha complexes.
#[test]
fn cells_and_alpha_complexes_are_written_from_tiles() {
    let folder = folder();
    let options = |name: &str| {
        format!(
            "--voronoi {name}.geojson --alpha 0.02 --alpha-out {name}.parquet --alpha-boundary {name}.ply"
        )
    };
    let memory = folder.taut(&format!("delaunay points.npy {}", options("memory"))).ends(0);
    let tiles = folder.taut(&format!("delaunay points.npy -o tiles/ {}", options("tiles"))).ends(0);
    let alpha =
        |text: &str| text.lines().find(|line| line.starts_with("  alpha")).map(str::to_owned);
    assert!(alpha(&memory.out).is_some_and(|line| line.contains("of radius at most 0.02")));
    assert_eq!(alpha(&tiles.out), alpha(&memory.out));
    for name in ["ply", "parquet"] {
        let sizes = ["memory", "tiles"].map(|of| folder.bytes(&format!("{of}.{name}")).len());
        assert!(sizes[0].abs_diff(sizes[1]) < sizes[0] / 4, "{name}: {sizes:?}");
    }
    let lines = |name: &str| {
        let text = folder.text(name);
        let mut lines: Vec<String> =
            text.lines().map(|line| line.trim_end_matches(',').to_owned()).collect();
        lines.sort();
        lines
    };
    assert_eq!(lines("tiles.geojson").len(), 3002);
    assert!(lines("tiles.geojson") == lines("memory.geojson"));
}

#[test]
fn bad_input_and_usage_leave_earlier_output_as_it_was() {
    let folder = folder();
    folder.taut("delaunay points.npy -o tiles/").ends(0);
    let before = fs::read(folder.path("tiles/manifest.txt")).unwrap();
    let refused = folder.taut("delaunay points.npy -o tiles/").ends(2);
    assert!(refused.err.contains("--resume"), "{}", refused.err);
    // What is complete is given back.
    folder.taut("delaunay points.npy -o tiles/ --resume").ends(0);
    assert_eq!(fs::read(folder.path("tiles/manifest.txt")).unwrap(), before);
    folder.put("bad.csv", "0,0\n1,0\n0,nan\n1,1\n");
    let refused = folder.taut("delaunay bad.csv -o bad/").ends(2);
    assert!(refused.err.contains("bad.csv: row 3"), "{}", refused.err);
    folder.put("deep.csv", "0,0,0,0\n1,0,2,3\n");
    let refused = folder.taut("delaunay deep.csv -o deep/").ends(2);
    assert!(refused.err.contains("4 coordinates"), "{}", refused.err);
    for option in ["--hull h.ply", "--draw d.svg", "--no-neighbors"] {
        let refused = folder.taut(&format!("delaunay points.npy -o new/ {option}")).ends(2);
        assert!(refused.err.contains("not to tiles"), "{option}: {}", refused.err);
    }
    let refused = folder.taut("delaunay points.npy -o new/ --memory 10M").ends(2);
    assert!(refused.err.contains("64 MiB"), "{}", refused.err);
    folder.taut("delaunay points.npy --resume").ends(2);
    folder.taut("delaunay points.npy -o no/such/folder.json --resume").ends(2);
    assert!(!folder.path("new").exists());
}

#[test]
fn damaged_folders_and_other_points_are_rejected() {
    let folder = folder();
    folder.taut("delaunay points.npy -o tiles/ --memory 64M").ends(0);
    folder.taut("generate uniform -n 3000 -d 2 --seed 6 -o other.npy").ends(0);
    folder
        .taut("verify tiles other.npy")
        .ends(1)
        .stdout_has(&["Rejected: tiles: ", "the data changed"]);
    folder.taut("verify tiles points.npy --epsilon 1").ends(2);
    folder.taut("verify tiles points.npy --memory 1M").ends(2);
    folder.taut("verify points.npy points.npy --scratch .").ends(2);
    fs::create_dir(folder.path("empty")).unwrap();
    let refused = folder.taut("verify empty points.npy").ends(2);
    assert!(refused.err.contains("no folder of tiles"), "{}", refused.err);
    let name = "tiles/tile-00000000.ttd";
    let mut bytes = fs::read(folder.path(name)).unwrap();
    let at = bytes.len() / 2;
    bytes[at] ^= 1;
    fs::write(folder.path(name), &bytes).unwrap();
    folder.taut("verify tiles points.npy").ends(1).stdout_has(&["Rejected: tiles: "]);
    fs::write(folder.path(name), &bytes[..at]).unwrap();
    folder
        .taut("verify tiles points.npy")
        .ends(1)
        .stdout_has(&["tile 0 has ", "the manifest says"]);
}

/// Killed at several moments, each time without notice; what comes of the resumed run has the same bytes.
#[cfg(unix)]
#[test]
fn a_run_that_was_killed_is_resumed_to_the_same_bytes() {
    use std::process::{Command, Stdio};
    use std::time::Duration;

    let folder = TestFolder::new();
    folder.taut("generate uniform -n 250000 -d 2 --seed 3 -o points.npy").ends(0);
    folder.taut("delaunay points.npy --memory 64M -o whole/ --no-verify").ends(0);
    let mut kills = 0;
    for wait in [30, 60, 120, 240, 480] {
        let mut child = Command::new(assert_cmd::cargo::cargo_bin!("taut"))
            .current_dir(folder.path(""))
            .args("delaunay points.npy --memory 64M -o tiles/ --no-verify --resume".split(' '))
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(Duration::from_millis(wait));
        kills += usize::from(child.try_wait().unwrap().is_none());
        // SIGKILL.
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(kills > 1, "{kills}");
    folder.taut("delaunay points.npy --memory 64M -o tiles/ --resume").ends(0);
    let names = |name: &str| {
        let entries = fs::read_dir(folder.path(name)).unwrap();
        let mut names: Vec<_> = entries.map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(names("tiles"), names("whole"));
    for name in names("whole") {
        let bytes = |of: &str| fs::read(folder.path(of).join(&name)).unwrap();
        assert!(bytes("tiles") == bytes("whole"), "{name:?}");
    }
}

/// Classes of a laser scan, of which the folder must be verified with the same ones.
#[test]
fn classes_belong_to_laser_scans() {
    let folder = folder();
    let refused = folder.taut("delaunay points.npy --classes 2,9").ends(2);
    assert!(refused.err.contains("leave out --classes"), "{}", refused.err);
    folder.taut("delaunay points.npy --classes 300").ends(2);
}

/// The files of a folder are one set of points, and a bad value is named with its file.
#[test]
fn a_folder_of_files_is_read_as_one_set() {
    let folder = folder();
    fs::create_dir(folder.path("parts")).unwrap();
    folder.taut("generate uniform -n 500 -d 2 --seed 1 -o parts/a.npy").ends(0);
    folder.taut("generate uniform -n 400 -d 2 --seed 2 -o parts/b.csv").ends(0);
    folder.taut("delaunay parts -o tiles/ --memory 64M").ends(0).stdout_has(&["900 points"]);
    folder.taut("verify tiles parts --memory 64M").ends(0);
    folder.taut("delaunay parts -o mesh.json").ends(0);
    folder.taut("verify mesh.json parts").ends(0);
    for out in ["parts/tiles/", "parts/", "parts/../parts/deep/er/"] {
        let refused = folder.taut(&format!("delaunay parts -o {out}")).ends(2);
        assert!(refused.err.contains("among the points"), "{out}: {}", refused.err);
    }
    assert_eq!(fs::read_dir(folder.path("parts")).unwrap().count(), 2);
    folder.put("parts/c.csv", "0,0\n1,inf\n");
    let refused = folder.taut("delaunay parts -o other/").ends(2);
    assert!(
        refused.err.contains("parts/c.csv") && refused.err.contains("row 2"),
        "{}",
        refused.err
    );
}

/// The amount of disk that is told before the work, in KiB.
fn told(err: &str, before: &str) -> f64 {
    let at = err.find(before).unwrap_or_else(|| panic!("no `{before}` in {err}"));
    let mut words = err[at + before.len()..].split_whitespace();
    let amount: f64 = words.next().unwrap().parse().unwrap();
    match words.next() {
        Some("KiB") => amount,
        Some("MiB") => amount * 1024.0,
        other => panic!("{other:?} in {err}"),
    }
}

#[test]
fn the_disk_that_is_told_has_that_of_the_check() {
    let folder = TestFolder::new();
    folder.taut("generate uniform -n 300000 -d 2 -o points.npy").ends(0);
    let line = "delaunay points.npy --memory 64M -o tiles/ --progress always";
    let run = folder.taut(line).ends(0);
    let (all, check) = (told(&run.err, "tiles/: "), told(&run.err, " and checked, "));
    // 20 bytes a site and a tenth more, and sides of facets between tiles, which memory has room for.
    assert!((6000.0..9000.0).contains(&check), "{check} KiB");
    fs::remove_dir_all(folder.path("tiles")).unwrap();
    let run = folder.taut(&format!("{line} --no-verify")).ends(0);
    let tiles = told(&run.err, "tiles/: ");
    assert!(!run.err.contains("by the check"), "{}", run.err);
    assert!((all - tiles - check).abs() < 300.0, "{all}, {tiles}, {check}");
}

/// A laser scan of version 1.2 with points of format 0.
fn scan(points: u32) -> Vec<u8> {
    let mut bytes = vec![0; 227];
    bytes[..4].copy_from_slice(b"LASF");
    bytes[24..26].copy_from_slice(&[1, 2]);
    bytes[94..96].copy_from_slice(&227u16.to_le_bytes());
    bytes[96..100].copy_from_slice(&227u32.to_le_bytes());
    bytes[105..107].copy_from_slice(&20u16.to_le_bytes());
    bytes[107..111].copy_from_slice(&points.to_le_bytes());
    for scale in bytes[131..155].chunks_exact_mut(8) {
        scale.copy_from_slice(&0.001f64.to_le_bytes());
    }
    for i in 0..points {
        let hash = i.wrapping_mul(0x9E37_79B9);
        for x in [hash >> 12, hash & 0xf_ffff, i % 1000] {
            bytes.extend(x.to_le_bytes());
        }
        bytes.extend([0; 8]);
    }
    bytes
}

#[test]
fn the_disk_of_decoded_points_is_told_before() {
    let folder = TestFolder::new();
    folder.put("scan.las", scan(400_000));
    let line = "scan.las --memory 64M --progress always";
    let some = "--bounds 0,0,100,100";
    let run = folder.taut(&format!("delaunay {line} -o tiles/ {some} --no-verify")).ends(0);
    let said = "scan.las: up to 9.2 MiB of disk will be taken in ";
    assert!(run.err.starts_with(said), "{}", run.err);
    let run = folder.taut(&format!("verify tiles {line} {some}")).ends(0);
    assert!(run.err.starts_with(said), "{}", run.err);
    // The folder is taken, which shows once the points are read.
    let run = folder.taut(&format!("delaunay {line} -o tiles/")).ends(2);
    assert!(run.err.starts_with("scan.las: 9.2 MiB of disk"), "{}", run.err);
    // 400,000 points of 16 bytes are less than 8 MiB.
    let run = folder.taut(&format!("delaunay {line} -o tiles/ --columns x,y")).ends(2);
    assert!(!run.err.contains("by its points"), "{}", run.err);
}

/// More threads than the memory has buffers for do not take more. The pages of the program, which the system reads from its
/// file and may drop, do not count.
#[cfg(target_os = "linux")]
#[test]
fn a_check_with_many_threads_stays_within_its_memory() {
    use std::process::{Command, Stdio};

    let folder = TestFolder::new();
    folder.taut("generate uniform -n 300000 -d 2 -o points.npy").ends(0);
    folder.taut("delaunay points.npy --memory 64M -o tiles/ --no-verify").ends(0);
    let mut child = Command::new(assert_cmd::cargo::cargo_bin!("taut"))
        .current_dir(folder.path(""))
        .args("verify tiles points.npy --memory 16M --threads 24 -q".split(' '))
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let mut most = 0;
    let status = loop {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("RssAnon:"));
        let held = line.and_then(|line| line.split_whitespace().next()?.parse::<u64>().ok());
        most = most.max(held.unwrap_or(0));
        if let Some(status) = child.try_wait().unwrap() {
            break status;
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    };
    assert!(status.success());
    assert!((4 << 10..16 << 10).contains(&most), "{most} KiB");
}
