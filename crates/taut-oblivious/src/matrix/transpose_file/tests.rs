use std::cell::{Cell, RefCell};
use std::io::{self, ErrorKind};
use std::sync::atomic::{AtomicBool, Ordering};

use proptest::prelude::*;
use taut_certify::{ElementOrder, Files, TransposedFile};

use super::check::check_transposed_samples;
use super::*;

fn bytes(n: usize) -> Vec<u8> {
    (0..n as u64).map(|i| (i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 56) as u8).collect()
}

fn plain(from: &[u8], rows: usize, columns: usize, width: usize) -> Vec<u8> {
    (0..columns)
        .flat_map(|j| (0..rows).flat_map(move |i| &from[(i * columns + j) * width..][..width]))
        .copied()
        .collect()
}

/// The faults of a [`Faulty`] file, and their times.
#[derive(Clone, Copy, Default)]
struct Faults {
    /// Only part of what was asked for is read or written.
    short: bool,
    /// Every other call is interrupted.
    interrupted: bool,
    /// Bytes for which there is room.
    room: Option<u64>,
    /// Reads end here, as if another process had cut the file.
    cut: Option<u64>,
}

/// Bytes in memory that fail as files do.
struct Faulty {
    bytes: RefCell<Vec<u8>>,
    faults: Faults,
    calls: Cell<u64>,
}

impl Faulty {
    fn new(bytes: Vec<u8>, faults: Faults) -> Self {
        Self { bytes: RefCell::new(bytes), faults, calls: Cell::new(0) }
    }

    /// Returns how much of `n` bytes this call handles.
    fn part(&self, n: usize) -> io::Result<usize> {
        self.calls.set(self.calls.get() + 1);
        if self.faults.interrupted && self.calls.get() % 2 == 1 {
            return Err(ErrorKind::Interrupted.into());
        }
        Ok(if self.faults.short { n.min(1 + self.calls.get() as usize % 7) } else { n })
    }
}

impl Store for Faulty {
    fn read_at(&self, buffer: &mut [u8], at: u64) -> io::Result<usize> {
        let bytes = self.bytes.borrow();
        let end = self.faults.cut.unwrap_or(u64::MAX).min(bytes.len() as u64);
        let n = self.part(buffer.len())?.min(end.saturating_sub(at) as usize);
        buffer[..n].copy_from_slice(&bytes[at as usize..][..n]);
        Ok(n)
    }

    fn write_at(&self, part: &[u8], at: u64) -> io::Result<usize> {
        let n = self.part(part.len())?;
        let end = at + n as u64;
        if self.faults.room.is_some_and(|room| end > room) {
            return Err(ErrorKind::StorageFull.into());
        }
        let mut bytes = self.bytes.borrow_mut();
        if bytes.len() < end as usize {
            bytes.resize(end as usize, 0);
        }
        bytes[at as usize..end as usize].copy_from_slice(&part[..n]);
        Ok(n)
    }
}

fn run(
    from: &[u8],
    matrix: FileMatrix,
    header: &[u8],
    memory: usize,
    (reads, writes): (Faults, Faults),
) -> Result<(Vec<u8>, FileTransposition), Failure> {
    let options = TransposeFileOptions { memory };
    let plan = Plan::new(matrix, header.len() as u64, &options).expect("a possible extent");
    let source = Faulty::new(from.to_vec(), reads);
    let target = Faulty::new(Vec::new(), writes);
    let done = plan.run(&source, &target, header, &Monitor::silent())?;
    assert!(done.memory <= memory, "{} bytes of {memory}", done.memory);
    Ok((target.bytes.into_inner(), done))
}

/// Matrices have fewer rows and columns than this, as many as an interpreter has time for.
const SIDE_MAX: usize = if cfg!(miri) { 20 } else { 60 };

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 3 } else { 64 }))]
    #[test]
    fn any_extent_width_offset_and_memory(
        rows in 0..SIDE_MAX, columns in 0..SIDE_MAX, width in 1usize..20, offset in 0usize..5,
        header in 0usize..4, memory in 0usize..5000, short: bool, interrupted: bool,
    ) {
        let from = bytes(offset + rows * columns * width);
        let matrix = FileMatrix {
            rows: rows as u64, columns: columns as u64, width, offset: offset as u64,
        };
        let faults = Faults { short, interrupted, ..Default::default() };
        let memory = memory.max(2 * width);
        let (to, done) = run(&from, matrix, &b"head"[..header], memory, (faults, faults)).unwrap();
        prop_assert_eq!(&to[..header], &b"head"[..header]);
        prop_assert!(to[header..] == plain(&from[offset..], rows, columns, width));
        prop_assert_eq!(done.bytes_read, (from.len() - offset) as u64);
        prop_assert_eq!(done.bytes_written, to.len() as u64);
    }
}

#[test]
fn a_full_disk_and_a_cut_file_are_errors() {
    let from = bytes(40 * 50 * 8);
    let matrix = FileMatrix { rows: 40, columns: 50, width: 8, offset: 0 };
    let full = Faults { room: Some(9000), ..Default::default() };
    match run(&from, matrix, b"", 4096, (Faults::default(), full)) {
        Err(Failure::Target(error)) => assert_eq!(error.kind(), ErrorKind::StorageFull),
        other => panic!("{:?}", other.map(|_| ())),
    }
    let cut = Faults { cut: Some(9000), short: true, ..Default::default() };
    match run(&from, matrix, b"", 4096, (cut, Faults::default())) {
        Err(Failure::Source(error)) => assert_eq!(error.kind(), ErrorKind::UnexpectedEof),
        other => panic!("{:?}", other.map(|_| ())),
    }
}

#[test]
fn impossible_extents_and_too_little_memory_are_refused() {
    let options = TransposeFileOptions { memory: 15 };
    let matrix = FileMatrix { rows: 4, columns: 4, width: 8, offset: 0 };
    let refused = |matrix, options: &TransposeFileOptions| {
        assert!(matches!(Plan::new(matrix, 0, options), Err(Error::Option { .. })));
    };
    refused(matrix, &options);
    refused(FileMatrix { width: 0, ..matrix }, &Default::default());
    refused(FileMatrix { rows: u64::MAX, columns: u64::MAX, ..matrix }, &Default::default());
    refused(FileMatrix { rows: 1 << 61, columns: 1, ..matrix }, &Default::default());
}

mod faults;

mod on_disk {
    use super::*;
    use crate::test_length::long_or;

    const MATRIX: FileMatrix = FileMatrix { rows: 300, columns: 211, width: 8, offset: 3 };
    const OPTIONS: TransposeFileOptions = TransposeFileOptions { memory: 64 << 10 };

    fn source(folder: &Path) -> (PathBuf, Vec<u8>) {
        let from = bytes(3 + 300 * 211 * 8);
        let path = folder.join("from.bin");
        std::fs::write(&path, &from).unwrap();
        (path, from)
    }

    #[test]
    #[cfg_attr(miri, ignore = "files")]
    fn samples_accept_the_transpose_and_refuse_another_matrix() {
        let folder = tempfile::tempdir().unwrap();
        let (from, content) = source(folder.path());
        let to = folder.path().join("to.bin");
        let heard = std::sync::atomic::AtomicU64::new(0);
        let record = |n| _ = heard.fetch_add(n, Ordering::Relaxed);
        let monitor = Monitor { on_points: Some(&record), ..Monitor::silent() };
        transpose_file(&from, MATRIX, &to, b"seven b", &OPTIONS, &monitor).unwrap();
        assert_eq!(heard.into_inner(), 300 * 211);
        let mut turned = std::fs::read(&to).unwrap();
        assert!(turned[7..] == plain(&content[3..], 300, 211, 8));

        let check =
            || check_transposed_samples(&from, MATRIX, &to, 7, [100_000, 1], &Monitor::silent());
        certified(MATRIX, &from, &to, 7);
        check().unwrap();
        // The untransposed matrix, whose differences no sample of that size misses.
        let mut doctored = turned.clone();
        doctored[7..].copy_from_slice(&content[3..]);
        std::fs::write(&to, doctored).unwrap();
        let found = check();
        assert!(matches!(found, Err(Error::Differs { .. })), "{found:?}");
        turned.pop();
        std::fs::write(&to, &turned).unwrap();
        let found = check();
        assert!(matches!(found, Err(Error::Length { .. })), "{found:?}");
    }

    /// Checks every element with the checker of `taut-certify`.
    fn certified(matrix: FileMatrix, from: &Path, to: &Path, header: u64) {
        let answer = TransposedFile {
            rows: matrix.rows,
            columns: matrix.columns,
            width: matrix.width as u64,
            order: ElementOrder::Rows,
            input_offset: matrix.offset,
            output_offset: header,
            dtype: None,
        };
        let [mut input, mut output] = [from, to].map(|path| File::open(path).unwrap());
        let files = Files { input: Some(&mut input), output: &mut output };
        answer.certify(files, &Monitor::silent()).unwrap();
    }

    #[test]
    #[cfg_attr(miri, ignore = "files")]
    fn a_file_may_replace_itself_and_keeps_its_permissions() {
        let folder = tempfile::tempdir().unwrap();
        let (from, content) = source(folder.path());
        let before = std::fs::metadata(&from).unwrap().permissions();
        transpose_file(&from, MATRIX, &from, &content[..3], &OPTIONS, &Monitor::silent()).unwrap();
        assert!(std::fs::read(&from).unwrap()[3..] == plain(&content[3..], 300, 211, 8));
        assert_eq!(std::fs::metadata(&from).unwrap().permissions(), before);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    #[cfg_attr(miri, ignore = "files")]
    fn cancelled_or_refused_work_leaves_the_earlier_file_and_no_trace() {
        let folder = tempfile::tempdir().unwrap();
        let (from, _) = source(folder.path());
        let to = folder.path().join("to.bin");
        std::fs::write(&to, "earlier").unwrap();
        let (stop, tiles) = (AtomicBool::new(false), std::sync::atomic::AtomicU64::new(0));
        let record = |_| stop.store(tiles.fetch_add(1, Ordering::Relaxed) == 3, Ordering::Relaxed);
        let monitor =
            Monitor { on_points: Some(&record), cancel: Some(&stop), ..Monitor::silent() };
        let found = transpose_file(&from, MATRIX, &to, b"", &OPTIONS, &monitor);
        assert!(matches!(found, Err(Error::Cancelled(_))), "{found:?}");
        let longer = FileMatrix { rows: 301, ..MATRIX };
        let found = transpose_file(&from, longer, &to, b"", &OPTIONS, &Monitor::silent());
        assert!(matches!(found, Err(Error::Length { .. })), "{found:?}");
        assert_eq!(std::fs::read(&to).unwrap(), b"earlier");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    #[cfg_attr(miri, ignore = "files")]
    fn what_cannot_be_replaced_is_refused_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let (from, _) = source(folder.path());
        std::fs::create_dir(folder.path().join("to")).unwrap();
        let never = |_| panic!("begun");
        let monitor = Monitor { on_points: Some(&never), ..Monitor::silent() };
        for name in ["to", "new/", "nowhere/to"] {
            let to = folder.path().join(name);
            let found = transpose_file(&from, MATRIX, &to, b"", &OPTIONS, &monitor);
            assert!(matches!(found, Err(Error::File { .. })), "{name}: {found:?}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[cfg(unix)]
    #[test]
    #[cfg_attr(miri, ignore = "files")]
    fn a_link_is_followed_and_the_file_behind_it_keeps_its_permissions() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (from, content) = source(folder.path());
        let [to, behind] = ["to", "behind"].map(|name| folder.path().join(name));
        std::fs::write(&behind, "earlier").unwrap();
        std::fs::set_permissions(&behind, PermissionsExt::from_mode(0o640)).unwrap();
        symlink("behind", &to).unwrap();
        transpose_file(&from, MATRIX, &to, b"", &OPTIONS, &Monitor::silent()).unwrap();
        assert_eq!(std::fs::read_link(&to).unwrap(), PathBuf::from("behind"));
        assert!(std::fs::read(&behind).unwrap() == plain(&content[3..], 300, 211, 8));
        assert_eq!(std::fs::metadata(&behind).unwrap().permissions().mode() & 0o777, 0o640);
    }

    /// Four tebibytes of nothing, and elements wider than any memory of which there are none.
    #[test]
    #[cfg_attr(miri, ignore = "files")]
    fn memory_that_nobody_has_is_an_error_or_not_needed() {
        let folder = tempfile::tempdir().unwrap();
        let [from, to] = ["from", "to"].map(|name| folder.path().join(name));
        let file = File::create(&from).unwrap();
        let none = FileMatrix { rows: 0, columns: 5, width: usize::MAX, offset: 0 };
        std::fs::write(&to, "").unwrap();
        check_transposed_samples(&from, none, &to, 0, [3, 1], &Monitor::silent()).unwrap();
        let options = TransposeFileOptions { memory: usize::MAX };
        let found = transpose_file(&from, none, &to, b"head", &options, &Monitor::silent());
        assert_eq!(found.unwrap().bytes_written, 4);
        assert_eq!(std::fs::read(&to).unwrap(), b"head");
        std::fs::write(&to, "").unwrap();
        if file.set_len(4 << 40).is_err() {
            return; // The disk has no files with holes.
        }
        let matrix = FileMatrix { rows: 1 << 20, columns: 1 << 19, width: 8, offset: 0 };
        let found = transpose_file(&from, matrix, &to, b"", &options, &Monitor::silent());
        assert!(
            matches!(found, Err(Error::Option { name: "memory", .. } | Error::File { .. })),
            "{found:?}"
        );
        assert_eq!(std::fs::read(&to).unwrap(), b"");
    }

    /// What the test below kills: the transposition of the folder named in the environment.
    #[test]
    #[ignore = "a process for the next test"]
    fn child_that_is_killed() {
        let Some(folder) = std::env::var_os("TAUT_TRANSPOSE_KILLED") else { return };
        let folder = PathBuf::from(folder);
        let matrix = FileMatrix { rows: 1500, columns: 1000, width: 8, offset: 0 };
        let (from, to) = (folder.join("from.bin"), folder.join("to.bin"));
        transpose_file(&from, matrix, &to, b"", &OPTIONS, &Monitor::silent()).unwrap();
    }

    #[test]
    #[cfg_attr(miri, ignore = "files")]
    fn killed_at_any_moment_it_leaves_the_old_or_the_whole_new_file() {
        let folder = tempfile::tempdir().unwrap();
        let from = bytes(1500 * 1000 * 8);
        std::fs::write(folder.path().join("from.bin"), &from).unwrap();
        let new = plain(&from, 1500, 1000, 8);
        let to = folder.path().join("to.bin");
        let (mut killed, mut whole) = (0, 0);
        for delay in (0..1000).step_by(long_or(3, 10)) {
            std::fs::write(&to, "earlier").unwrap();
            let mut child = std::process::Command::new(std::env::current_exe().unwrap())
                .args(["--ignored", "--exact", "--test-threads=1"])
                .arg("matrix::transpose_file::tests::on_disk::child_that_is_killed")
                .env("TAUT_TRANSPOSE_KILLED", folder.path())
                .stdout(std::process::Stdio::null())
                .spawn()
                .unwrap();
            std::thread::sleep(std::time::Duration::from_millis(delay));
            child.kill().unwrap();
            child.wait().unwrap();
            let found = std::fs::read(&to).unwrap();
            assert!(found == b"earlier" || found == new, "{} bytes", found.len());
            // Where files need no name, nothing else is left: but for the moment before an earlier file is replaced.
            #[cfg(target_os = "linux")]
            for entry in std::fs::read_dir(folder.path()).unwrap() {
                let path = entry.unwrap().path();
                if path != to && path.extension().is_none() {
                    assert!(std::fs::read(&path).unwrap() == new, "{}", path.display());
                    std::fs::remove_file(path).unwrap();
                }
            }
            if found == new {
                whole += 1
            } else {
                killed += 1
            }
            if whole == 2 {
                break;
            }
        }
        assert!(killed > 0 && whole > 0, "{killed} killed, {whole} not");
    }

    /// `TAUT_TRANSPOSE_FOLDER=… cargo test --release -p taut-oblivious -- --ignored four_gibibytes`, on a disk with room
    /// for 8 GiB.
    #[test]
    #[ignore = "writes 8 GiB"]
    fn four_gibibytes_in_a_quarter() {
        let folder = match std::env::var_os("TAUT_TRANSPOSE_FOLDER") {
            Some(folder) => tempfile::tempdir_in(folder).unwrap(),
            None => tempfile::tempdir().unwrap(),
        };
        whole_run(folder.path(), 23_170, 256 << 20);
    }

    /// The peak of this process is that of all tests; run alone to have it say something.
    #[test]
    #[cfg(target_os = "linux")]
    #[ignore = "writes 512 MiB; its peak is only its own if it runs alone"]
    fn a_quarter_gibibyte_in_sixteen_mebibytes() {
        let folder = tempfile::tempdir().unwrap();
        whole_run(folder.path(), 5793, 16 << 20);
        let status = std::fs::read_to_string("/proc/self/status").unwrap();
        let peak: u64 = status
            .lines()
            .find_map(|line| line.strip_prefix("VmHWM:")?.trim().strip_suffix(" kB")?.parse().ok())
            .expect("the peak in KiB");
        assert!(peak <= 32 << 10, "{peak} KiB");
    }

    fn whole_run(folder: &Path, n: u64, memory: usize) {
        let (from, to) = (folder.join("from.bin"), folder.join("to.bin"));
        let mut file = std::io::BufWriter::new(File::create(&from).unwrap());
        for i in 0..n * n {
            io::Write::write_all(&mut file, &i.to_le_bytes()).unwrap();
        }
        drop(file);
        let matrix = FileMatrix { rows: n, columns: n, width: 8, offset: 0 };
        let options = TransposeFileOptions { memory };
        let begin = std::time::Instant::now();
        let done = transpose_file(&from, matrix, &to, b"", &options, &Monitor::silent()).unwrap();
        println!("{done:?} in {:?}", begin.elapsed());
        certified(matrix, &from, &to, 0);
    }
}
