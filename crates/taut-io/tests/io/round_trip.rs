//! What is written and read back has the same values, bit for bit, whatever the way.

use taut_io::{Content, Format, RawLayout, ReadOptions, open, write_points};
use taut_points::{
    Distribution, GeneratedSource, Monitor, Points, Scalar, ScalarKind, generate, hash_points,
};

use super::{hash, unpacks};

/// Hard values beside easy ones: long decimals, huge, tiny, subnormal, negative zero.
fn points<T: Scalar>(n: usize, dim: usize, extremes: &[T]) -> Vec<T> {
    let mut values: Vec<T> = generate(Distribution::Normal, n, dim, 7).unwrap();
    values[..extremes.len()].copy_from_slice(extremes);
    values
}

fn round_trips<T: Scalar>(values: &[T], dim: usize, format: Format, compressions: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let source = Points::new(values, dim).unwrap();
    let wanted = hash_points(&source, &Monitor::silent()).unwrap();
    for compression in compressions {
        let name = format!("points.{}{compression}", format.extensions()[0]);
        let path = folder.path().join(&name);
        write_points(&source, &[], &path, None, &Monitor::silent()).unwrap();
        let raw = Some(RawLayout { dim, scalar: T::KIND, offset: 0 });
        let everything = ReadOptions { raw, ..Default::default() };
        // 1000 bytes hold none of these sets: what is decoded must spill, what lies in place is read block by block.
        let little = ReadOptions {
            memory: Some(1000),
            temp_dir: Some(folder.path().to_owned()),
            ..everything.clone()
        };
        for options in [&everything, &little] {
            let input = open(&path, options).unwrap_or_else(|e| panic!("{name}: {e}"));
            assert_eq!(input.format, format, "{name}");
            assert_eq!((input.source.len(), input.source.dim()), (source.len() as u64, dim));
            assert_eq!(hash(&input), wanted, "{name} {options:?}");
            let kept =
                matches!(format, Format::Npy | Format::Raw | Format::Parquet | Format::Arrow);
            let scalar = if kept { T::KIND } else { ScalarKind::F64 };
            assert_eq!(input.source.scalar(), scalar, "{name}");
        }
        // The temporary files went with their sources.
        std::fs::remove_file(&path).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{name}");
    }
}

#[test]
fn every_format_precision_and_compression_keeps_every_bit() {
    let wide = points(701, 3, &[1e300, 5e-324, -0.0, f64::MAX, f64::MIN_POSITIVE, 0.1, -1e-7]);
    let narrow = points(701, 3, &[1e30_f32, 1e-45, -0.0, f32::MAX, f32::MIN_POSITIVE, 0.1, -1e-7]);
    let mut packed = vec!["", ".gz", ".xz", ".zst"];
    packed.retain(|packed| unpacks(packed));
    for format in Format::all().filter(|format| format.writes(Content::Points)) {
        round_trips(&wide, 3, format, &packed);
        round_trips(&narrow, 3, format, &packed);
    }
}

#[test]
fn many_columns_and_many_blocks_keep_every_bit() {
    for format in Format::all().filter(|f| f.writes(Content::Points) && *f != Format::Xyz) {
        round_trips(&points::<f32>(100, 1001, &[]), 1001, format, &[""]);
        round_trips(&points::<f64>(70_000, 1, &[]), 1, format, &[""]);
    }
}

/// Parquet keeps buffers for each column: 20,000 of them took half a gigabyte. Run again under a limit of memory.
#[cfg(all(feature = "arrow", target_os = "linux"))]
#[test]
fn wide_points_are_written_to_parquet_in_little_memory() {
    const LIMITED: &str = "TAUT_TEST_NARROW";
    if std::env::var_os(LIMITED).is_none() {
        let limited = std::process::Command::new("sh")
            .args([
                "-c",
                "ulimit -v 400000; exec \"$0\" --exact \"$1\" --nocapture --test-threads 1",
            ])
            .arg(std::env::current_exe().unwrap())
            .arg("round_trip::wide_points_are_written_to_parquet_in_little_memory")
            .env(LIMITED, "1")
            .env("RAYON_NUM_THREADS", "1")
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&limited.stdout);
        assert!(limited.status.success() && said.contains("1 passed"), "{said}");
        return;
    }
    round_trips(&points::<f64>(3, 20_000, &[0.1]), 20_000, Format::Parquet, &[""]);
    round_trips(&points::<f32>(150, 100_000, &[0.1]), 100_000, Format::Parquet, &[""]);
}

#[cfg(feature = "arrow")]
#[test]
fn wide_points_with_names_keep_them() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.parquet");
    let values = points::<f64>(3, 1001, &[]);
    let source = Points::new(&values, 1001).unwrap();
    let names: Vec<String> = (0..1001).map(|j| format!("c{j}")).collect();
    write_points(&source, &names, &path, None, &Monitor::silent()).unwrap();
    let input = super::open_default(&path).unwrap();
    assert_eq!(input.columns, names);
    assert_eq!(super::values(&input), values);
}

#[test]
fn names_of_columns_go_round_too() {
    let folder = tempfile::tempdir().unwrap();
    let source = GeneratedSource::new(Distribution::Uniform, 10, 3, 1, ScalarKind::F64).unwrap();
    let names = ["height".to_owned(), "a \"wide\", one".to_owned(), "#3; x".to_owned()];
    for name in ["p.csv", "p.tsv", "p.txt", "p.parquet", "p.arrow"] {
        if !Format::of_path(name.as_ref()).0.unwrap().writes(Content::Points) {
            continue;
        }
        let path = folder.path().join(name);
        write_points(&source, &names, &path, None, &Monitor::silent()).unwrap();
        let input = super::open_default(&path).unwrap();
        assert_eq!(input.columns, names, "{name}");
        assert_eq!(input.source.len(), 10);
    }
}

#[test]
fn names_that_read_like_numbers_are_left_out_of_text() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("p.csv");
    let source = Points::new(&[1.0, 2.0], 2).unwrap();
    for wrong in ["0", "1st", "NA", ""] {
        let names = [wrong.to_owned(), "one".to_owned()];
        write_points(&source, &names, &path, None, &Monitor::silent()).unwrap();
        let input = super::open_default(&path).unwrap();
        assert_eq!((input.source.len(), input.columns.len()), (1, 0), "{wrong}");
    }
}

#[test]
fn what_cannot_be_written_is_said_before_a_file_is_made() {
    let folder = tempfile::tempdir().unwrap();
    let source = Points::new(&[1.0, 2.0], 2).unwrap();
    let refuse = |name: &str, columns: &[String]| {
        let path = folder.path().join(name);
        let refused = write_points(&source, columns, &path, None, &Monitor::silent()).unwrap_err();
        assert!(!path.exists());
        refused.to_string()
    };
    assert!(refuse("p.xyz", &[]).contains("xyz files hold points of dimension 3, not 2"));
    for (name, extension) in [("p.xyzn", "xyzn"), ("p.XYZRGB.gz", "xyzrgb")] {
        let wanted = format!("files with the extension .{extension} hold normals or colors");
        assert!(refuse(name, &[]).contains(&wanted), "{name}");
    }
    assert!(refuse("p.tsp", &[]).contains("tsplib files are read, not written"));
    assert!(refuse("p.unknown", &[]).contains("name it (one of csv, tsv, whitespace, npy"));
    assert!(!refuse("p.unknown", &[]).contains("tsplib"));
    assert!(refuse("p.csv", &["x".to_owned()]).contains("1 column name was given"));
}

#[test]
fn writing_hears_the_monitor() {
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
    let folder = tempfile::tempdir().unwrap();
    let source =
        GeneratedSource::new(Distribution::Uniform, 200_000, 1, 1, ScalarKind::F32).unwrap();
    let (heard, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let record = |count| {
        heard.fetch_add(count, Ordering::Relaxed);
        stop.store(true, Ordering::Relaxed);
    };
    let monitor = Monitor { on_points: Some(&record), cancel: Some(&stop), ..Monitor::silent() };
    let path = folder.path().join("p.npy");
    assert!(write_points(&source, &[], &path, None, &monitor).is_err());
    assert_eq!(heard.load(Ordering::Relaxed), 65_536);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
