//! Names of outputs: links, permissions, folders, what cannot be replaced; and memory that nobody has.

use super::*;

fn small() -> (Folder, Vec<u8>) {
    let bytes = records(5000, 16, 0, u64::MAX);
    (Folder::with(&bytes), bytes)
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn a_folder_or_a_name_that_is_none_is_refused_at_once() {
    let (folder, _) = small();
    fs::create_dir(folder.path("out")).expect("a folder");
    let never = |_| panic!("begun");
    let monitor = Monitor { on_points: Some(&never), ..Monitor::silent() };
    for name in ["out", "new/", "", "nowhere/out", ".."] {
        let options = FileSortOptions { memory: MEMORY_MIN, ..Default::default() };
        let output = folder.path(name);
        let refused = sort_file(&folder.path("in"), &output, &whole_number(16), &options, &monitor);
        assert!(matches!(refused, Err(Error::File { .. })), "{name}: {refused:?}");
        assert_eq!(folder.names(), ["in", "out"]);
    }
}

#[cfg(unix)]
#[test]
#[cfg_attr(miri, ignore = "files")]
fn links_are_followed_and_permissions_kept() {
    use std::os::unix::fs::{PermissionsExt, symlink};
    let (folder, bytes) = small();
    let expected = expected(&bytes, &whole_number(16));
    let mode = |name| fs::metadata(folder.path(name)).expect("a file").permissions().mode() & 0o777;
    fs::create_dir(folder.path("other")).expect("a folder");
    // A link to a file, and a link to a link to no file.
    fs::write(folder.path("other/private"), "earlier").expect("written");
    fs::set_permissions(folder.path("other/private"), PermissionsExt::from_mode(0o600))
        .expect("set");
    symlink("other/private", folder.path("out")).expect("linked");
    for memory in [MEMORY_MIN, 1 << 20] {
        folder.sort(&whole_number(16), memory).expect("sorted");
        assert_eq!(
            fs::read_link(folder.path("out")).expect("a link"),
            PathBuf::from("other/private")
        );
        assert!(fs::read(folder.path("other/private")).expect("an output") == expected);
        assert_eq!(mode("other/private"), 0o600);
    }
    fs::remove_file(folder.path("out")).expect("removed");
    symlink("other/second", folder.path("out")).expect("linked");
    symlink(folder.path("other/new"), folder.path("other/second")).expect("linked");
    folder.sort(&whole_number(16), MEMORY_MIN).expect("sorted");
    assert!(fs::read(folder.path("other/new")).expect("an output") == expected);
    fs::remove_file(folder.path("out")).expect("removed");
    symlink("out", folder.path("out")).expect("linked");
    assert!(matches!(folder.sort(&whole_number(16), MEMORY_MIN), Err(Error::File { .. })));
    assert_eq!(folder.names(), ["in", "other", "out"]);
}

#[cfg(unix)]
#[test]
#[cfg_attr(miri, ignore = "files")]
fn what_is_read_only_is_refused() {
    use std::os::unix::fs::PermissionsExt;
    let (folder, _) = small();
    fs::write(folder.path("out"), "precious").expect("written");
    fs::set_permissions(folder.path("out"), PermissionsExt::from_mode(0o444)).expect("set");
    if fs::File::options().append(true).open(folder.path("out")).is_ok() {
        return; // Nothing is refused to root.
    }
    assert!(matches!(folder.sort(&whole_number(16), MEMORY_MIN), Err(Error::File { .. })));
    assert_eq!(fs::read(folder.path("out")).expect("as it was"), b"precious");
}

/// Four tebibytes of nothing.
#[cfg(target_os = "linux")]
#[test]
#[cfg_attr(miri, ignore = "files")]
fn memory_that_nobody_has_is_an_error() {
    let folder = Folder::new();
    let file = fs::File::create(folder.path("in")).expect("a file");
    if file.set_len(4 << 40).is_err() {
        return; // The disk has no files with holes.
    }
    let refused = folder.sort(&whole_number(16), usize::MAX);
    assert!(
        matches!(refused, Err(Error::Option { name: "memory", .. } | Error::File { .. })),
        "{refused:?}"
    );
    assert_eq!(folder.names(), ["in"]);
}

/// Blocks that go past the system's cache, and a last one that does not fill a page.
#[test]
#[cfg_attr(miri, ignore = "files")]
fn large_blocks_come_back_as_they_were() {
    for width in [32, 24] {
        let layout = whole_number(width);
        let bytes = records(150_001, width, 0, 0xFF_FFFF);
        let folder = Folder::with(&bytes);
        let found = folder.sort(&layout, 2 << 20).expect("sorted");
        assert!(found.runs > 1, "{found:?}");
        assert_eq!(found.bytes_read + found.bytes_written, 4 * bytes.len() as u64);
        assert!(fs::read(folder.path("out")).expect("an output") == expected(&bytes, &layout));
        folder.verify(&layout, &found.certificate);
    }
}
