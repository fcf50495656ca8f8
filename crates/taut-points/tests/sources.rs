//! The sources must deliver the same points, whatever medium they lie on.

use std::io::Write;

use taut_points::{
    Blocks, Distribution, Error, FileSource, MappedSource, Monitor, OwnedPoints, PointSource,
    Points, ReadError, Rows, ScalarKind, Scratch, gather, generate, hash_points, map_blocks,
};

fn raw_file(header: &[u8], values: &[f32]) -> tempfile::NamedTempFile {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(header).unwrap();
    for value in values {
        file.write_all(&value.to_le_bytes()).unwrap();
    }
    file.flush().unwrap();
    file
}

#[test]
fn memory_file_and_map_deliver_the_same_points() {
    let values: Vec<f32> = generate(Distribution::Normal, 5000, 33, 5).unwrap();
    let memory = Points::new(&values, 33).unwrap();
    let wanted = hash_points(&memory, &Monitor::silent()).unwrap();
    // An odd header makes the map misaligned for f32: its blocks must then be copied, not mangled.
    for header in [&b""[..], b"eight by", b"odd"] {
        let file = raw_file(header, &values);
        let at = header.len() as u64;
        let read = FileSource::open(file.path(), at, 5000, 33, ScalarKind::F32).unwrap();
        let mapped = MappedSource::open(file.path(), at, 5000, 33, ScalarKind::F32).unwrap();
        let owned = OwnedPoints::new(values.clone(), 33).unwrap();
        for source in [&read as &dyn PointSource, &mapped, &owned] {
            assert_eq!((source.len(), source.dim(), source.scalar()), (5000, 33, ScalarKind::F32));
            assert_eq!(hash_points(source, &Monitor::silent()).unwrap(), wanted);
            assert_eq!(gather(source, &[4999, 17]).unwrap(), gather(&memory, &[4999, 17]).unwrap());
        }
    }
}

#[test]
fn a_file_without_a_name_is_read_all_the_same() {
    let values: Vec<f32> = generate(Distribution::Normal, 100, 3, 5).unwrap();
    let file = raw_file(b"", &values).into_file();
    let source = FileSource::from_file(file, "gone".as_ref(), 0, 100, 3, ScalarKind::F32).unwrap();
    let memory = Points::new(&values, 3).unwrap();
    assert_eq!(gather(&source, &[99, 0]).unwrap(), gather(&memory, &[99, 0]).unwrap());
    let short = FileSource::from_file(
        tempfile::tempfile().unwrap(),
        "gone".as_ref(),
        0,
        1,
        1,
        ScalarKind::F32,
    );
    assert!(short.unwrap_err().to_string().starts_with("gone: 0 bytes"));
}

#[test]
fn a_scratch_refuses_what_memory_does_not_hold() {
    let mut scratch = Scratch::new();
    for (rows, dim) in [(u64::MAX, 1), (1, usize::MAX), (1 << 32, 1 << 32), (1 << 58, 4)] {
        let refused = scratch.values::<f64>(rows, dim).unwrap_err();
        assert!(matches!(refused, ReadError::TooLarge { .. }), "{rows} × {dim}");
    }
    assert_eq!(scratch.values::<f32>(3, 5).unwrap().len(), 15);
}

#[test]
fn a_file_that_ends_early_is_refused() {
    let file = raw_file(b"", &[1.0; 10]);
    for n in [6, u64::MAX] {
        let refused = FileSource::open(file.path(), 0, n, 2, ScalarKind::F32).unwrap_err();
        assert!(matches!(refused, ReadError::Truncated { found: 40, .. }), "{refused}");
    }
    assert!(MappedSource::open(file.path(), 4, 5, 2, ScalarKind::F32).is_err());
}

#[test]
fn rows_out_of_range_are_refused() {
    let points = Points::new(&[1.0, 2.0], 1).unwrap();
    let refused = points.read(1..3, &mut Scratch::new()).unwrap_err();
    assert!(matches!(refused, ReadError::OutOfRange { first: 1, end: 3, n: 2 }));
    assert!(gather(&points, &[u64::MAX]).is_err());
}

#[test]
fn views_refuse_ragged_values() {
    assert_eq!(Points::new(&[1.0, 2.0, 3.0], 2), Err(Error::Ragged { values: 3, dim: 2, rest: 1 }));
    assert_eq!(Points::<f64>::new(&[], 0), Err(Error::ZeroDimension));
    assert_eq!(Points::<f64>::new(&[], 4).unwrap().len(), 0);
}

#[test]
fn blocks_cover_all_rows_once_and_come_back_in_order() {
    for (n, dim) in [(0, 3), (1, 100_000), (7, 100_000), (65_536, 1), (65_537, 1), (1000, 300)] {
        let blocks = Blocks::new(n, dim);
        let mut next = 0;
        for block in 0..blocks.count() {
            let range = blocks.range(block);
            assert_eq!(range.start, next);
            assert!(range.end > range.start);
            next = range.end;
        }
        assert_eq!(next, n);
    }
    let values: Vec<f64> = (0..300_000).map(f64::from).collect();
    let points = Points::new(&values, 1).unwrap();
    let firsts = map_blocks(&points, &Monitor::silent(), |first, rows| {
        assert!(matches!(rows, Rows::F64(p) if p.row(0)[0] == first as f64));
        Ok::<_, ReadError>(first)
    })
    .unwrap();
    assert!(firsts.is_sorted() && firsts.len() == 5);
}

#[test]
fn a_monitor_hears_every_point_and_can_stop() {
    use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
    let values = vec![0.0; 200_000];
    let points = Points::new(&values, 1).unwrap();
    let (heard, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let record = |count| {
        heard.fetch_add(count, Ordering::Relaxed);
    };
    let monitor = Monitor { on_points: Some(&record), cancel: Some(&stop), ..Monitor::silent() };
    hash_points(&points, &monitor).unwrap();
    assert_eq!(heard.load(Ordering::Relaxed), 200_000);
    stop.store(true, Ordering::Relaxed);
    assert!(matches!(hash_points(&points, &monitor), Err(ReadError::Cancelled(_))));
}
