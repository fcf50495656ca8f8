//! A file appears whole or not at all.

use std::io::Write;
use std::path::Path;

use taut_io::{Content, Error, create};

#[test]
fn the_earlier_file_stays_until_the_commit() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.json");
    std::fs::write(&path, "earlier").unwrap();
    let mut file = create(&path).unwrap();
    file.write_all(b"later").unwrap();
    file.flush().unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"earlier");
    drop(file);
    assert_eq!(std::fs::read(&path).unwrap(), b"earlier");
    let mut file = create(&path).unwrap();
    file.write_all(b"later").unwrap();
    file.commit().unwrap();
    assert_eq!(std::fs::read(&path).unwrap(), b"later");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_folder_in_the_place_of_the_file_or_missing_is_named() {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(create(folder.path()), Err(Error::Directory { .. })));
    let missing = folder.path().join("no/out.json");
    assert!(matches!(create(&missing), Err(Error::NotFound { .. })));
}

#[cfg(unix)]
#[test]
fn modes_are_those_of_any_new_file_and_links_stay() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let mode = |path: &Path| std::fs::metadata(path).unwrap().permissions().mode() & 0o777;
    let (ours, usual) = (folder.path().join("ours"), folder.path().join("usual"));
    std::fs::write(&usual, "").unwrap();
    create(&ours).unwrap().commit().unwrap();
    assert_eq!(mode(&ours), mode(&usual));

    let link = folder.path().join("link");
    std::os::unix::fs::symlink(&usual, &link).unwrap();
    let mut file = create(&link).unwrap();
    file.write_all(b"through").unwrap();
    file.commit().unwrap();
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(std::fs::read(&usual).unwrap(), b"through");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_device_is_said_and_stays_a_device() {
    use std::os::unix::fs::FileTypeExt;
    use taut_points::{Monitor, Points};
    let full = Path::new("/dev/full");
    if !full.exists() {
        println!("skipped a_full_device_is_said_and_stays_a_device: there is no /dev/full");
        return;
    }
    let mut file = create(full).unwrap();
    let wrote = file.write_all(&[0; 100]);
    let said =
        wrote.is_err() || file.commit().is_err_and(|e| e.to_string().contains("writing failed"));
    assert!(said);
    let values = vec![0.5; 300_000];
    let points = Points::new(&values, 3).unwrap();
    for format in taut_io::Format::all().filter(|format| format.writes(Content::Points)) {
        let written = taut_io::write_points(&points, &[], full, Some(format), &Monitor::silent());
        let said = written.unwrap_err().to_string();
        assert!(said.contains("/dev/full: writing failed"), "{format}: {said}");
        assert!(!said.contains("as it was"), "nothing stood there before: {said}");
    }
    assert!(std::fs::metadata(full).unwrap().file_type().is_char_device());
}

/// A disk cannot be filled here, but a limit on the size of files stops a write in the same place: this test runs
/// itself again under such a limit.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_up_leaves_the_earlier_file() {
    use taut_points::{Monitor, Points};
    const LIMITED: &str = "TAUT_TEST_LIMITED";
    if std::env::var_os(LIMITED).is_none() {
        let limited = std::process::Command::new("sh")
            .args(["-c", "trap '' XFSZ; ulimit -f 64; exec \"$0\" --exact \"$1\" --nocapture"])
            .arg(std::env::current_exe().unwrap())
            .arg("create::a_disk_that_fills_up_leaves_the_earlier_file")
            .env(LIMITED, "1")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&limited.stdout);
        assert!(limited.status.success() && said.contains("1 passed"), "{said}");
        return;
    }
    let values = vec![0.1; 300_000];
    let points = Points::new(&values, 3).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for name in ["p.csv", "p.npy", "p.raw"] {
        let path = folder.path().join(name);
        std::fs::write(&path, "earlier").unwrap();
        let written = taut_io::write_points(&points, &[], &path, None, &Monitor::silent());
        let said = written.unwrap_err().to_string();
        assert!(said.contains("writing failed") && said.contains("is as it was"), "{said}");
        assert_eq!(std::fs::read(&path).unwrap(), b"earlier");
    }
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 3);
    // So does the temporary file of points that do not fit into memory.
    let text = "1,2\n".repeat(10_000);
    let options = taut_io::ReadOptions {
        memory: Some(10),
        temp_dir: Some(folder.path().to_owned()),
        ..Default::default()
    };
    let said = super::message(super::text_with("p.csv", &text, &options));
    assert!(said.contains("set TMPDIR to a folder with more room"), "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_write_that_fails_half_way_leaves_the_earlier_file() {
    use taut_points::{Monitor, PointSource, ReadError, Rows, ScalarKind, Scratch};
    struct Failing;
    impl PointSource for Failing {
        fn len(&self) -> u64 {
            1_000_000
        }
        fn dim(&self) -> usize {
            3
        }
        fn scalar(&self) -> ScalarKind {
            ScalarKind::F64
        }
        fn read<'a>(
            &'a self,
            range: std::ops::Range<u64>,
            scratch: &'a mut Scratch,
        ) -> Result<Rows<'a>, ReadError> {
            if range.start > 100_000 {
                return Err(ReadError::OutOfRange { first: range.start, end: range.end, n: 0 });
            }
            let values = scratch.values::<f64>(range.end - range.start, 3)?;
            values.fill(0.25);
            Ok(Rows::F64(taut_points::Points::new(values, 3).unwrap()))
        }
    }
    let folder = tempfile::tempdir().unwrap();
    for format in taut_io::Format::all().filter(|format| format.writes(Content::Points)) {
        let path = folder.path().join("points");
        std::fs::write(&path, "earlier").unwrap();
        let written = taut_io::write_points(&Failing, &[], &path, Some(format), &Monitor::silent());
        assert!(written.is_err());
        assert_eq!(std::fs::read(&path).unwrap(), b"earlier", "{format}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "{format}");
    }
}

#[cfg(unix)]
#[test]
fn a_private_file_stays_private_and_a_read_only_one_stays() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("private");
    let set = |mode| {
        std::fs::set_permissions(&path, std::fs::Permissions::from_mode(mode)).unwrap();
    };
    std::fs::write(&path, "earlier").unwrap();
    for mode in [0o600, 0o640, 0o755] {
        set(mode);
        let mut file = create(&path).unwrap();
        file.write_all(b"later").unwrap();
        file.commit().unwrap();
        assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, mode);
    }
    set(0o444);
    if std::fs::File::options().append(true).open(&path).is_ok() {
        println!("skipped the read-only file: this user may write any file");
        return;
    }
    assert!(matches!(create(&path), Err(Error::Permission { action: "write", .. })));
    assert_eq!(std::fs::read(&path).unwrap(), b"later");
}

#[cfg(unix)]
#[test]
fn a_link_to_nothing_gets_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let (first, second) = (folder.path().join("first"), folder.path().join("second"));
    std::os::unix::fs::symlink("second", &first).unwrap();
    std::os::unix::fs::symlink("end", &second).unwrap();
    let mut file = create(&first).unwrap();
    file.write_all(b"here").unwrap();
    file.commit().unwrap();
    assert!(std::fs::symlink_metadata(&first).unwrap().is_symlink());
    assert!(std::fs::symlink_metadata(&second).unwrap().is_symlink());
    assert_eq!(std::fs::read(folder.path().join("end")).unwrap(), b"here");
}

/// Whatever ends the process, no temporary file of points is left: it has no name while it is in use.
#[cfg(unix)]
#[test]
fn points_that_outgrow_memory_have_no_file_with_a_name() {
    let folder = tempfile::tempdir().unwrap();
    let options = taut_io::ReadOptions {
        memory: Some(10),
        temp_dir: Some(folder.path().to_owned()),
        ..Default::default()
    };
    let input = super::text_with("p.csv", &"1,2\n".repeat(10_000), &options).unwrap();
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    assert_eq!(super::values(&input).len(), 20_000);
}
