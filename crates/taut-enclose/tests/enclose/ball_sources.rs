//! Tests what is refused, what stops early, and that neither threads nor the kind of source change a byte.

use std::io::Write;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use common::families::Random;
use common::judge;
use taut_certify::{Items, Stop};
use taut_enclose::{BallMethod, BallOptions, Error, ball};
use taut_points::{
    Distribution, FileSource, GeneratedSource, InputError, MappedSource, Monitor, PointSource,
    Points, ReadError, Rows, ScalarKind, Scratch, generate,
};

use crate::common;

fn options(epsilon: f64) -> BallOptions<'static> {
    BallOptions { epsilon, ..Default::default() }
}

#[test]
fn nothing_is_refused() {
    let none: [f64; 0] = [];
    assert!(matches!(ball(&Points::new(&none, 2).unwrap(), &options(0.0)), Err(Error::Empty)));
    assert!(matches!(
        ball(
            &Points::new(&none, 2).unwrap(),
            &BallOptions { inputs: Items::Balls, ..options(0.0) }
        ),
        Err(Error::Empty)
    ));
    let one_column = ball(
        &Points::new(&[1.0, 2.0], 1).unwrap(),
        &BallOptions { inputs: Items::Balls, ..options(0.0) },
    );
    assert!(matches!(one_column, Err(Error::NoRadius { columns: 1 })));
}

#[test]
fn the_first_bad_coordinate_is_named() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for (n, dim) in [(1, 1), (10, 3), (3000, 97), (200_000, 5)] {
            let mut values = Random(1).normals(n * dim);
            let row = n * 2 / 3;
            let column = dim / 2;
            values[row * dim + column] = bad;
            // Later ones, in other blocks: not to be named.
            values[n * dim - 1] = bad;
            for threads in [1, 8] {
                let options = BallOptions { threads: Some(threads), ..Default::default() };
                match ball(&Points::new(&values, dim).unwrap(), &options) {
                    Err(Error::Input(InputError::NonFinite { row: r, column: c, value })) => {
                        assert_eq!((r, c), (row as u64, column));
                        assert_eq!(value.to_bits(), bad.to_bits());
                    }
                    other => panic!("{other:?}"),
                }
            }
        }
    }
    let single = [1.0f32, f32::INFINITY, 2.0, 3.0];
    let found = ball(&Points::new(&single, 2).unwrap(), &options(0.0));
    assert!(matches!(found, Err(Error::Input(InputError::NonFinite { row: 0, column: 1, .. }))));
    // Where squares overflow, all numbers are looked at again: a bad one must still be found.
    let mut huge = vec![1e300; 2000];
    huge[1501] = f64::NAN;
    let found = ball(&Points::new(&huge, 2).unwrap(), &options(0.0));
    assert!(matches!(found, Err(Error::Input(InputError::NonFinite { row: 750, column: 1, .. }))));
    let found = ball(
        &Points::new(&[0.0, 1.0, 1.0, f64::NAN], 2).unwrap(),
        &BallOptions { inputs: Items::Balls, ..options(0.0) },
    );
    assert!(matches!(found, Err(Error::Input(InputError::NonFinite { row: 1, column: 1, .. }))));
}

#[test]
fn the_first_negative_radius_is_named() {
    let mut values = Random(2).normals(100_000 * 3);
    values.chunks_exact_mut(3).for_each(|ball| ball[2] = ball[2].abs());
    values[70_001 * 3 + 2] = -1e-300;
    values[90_001 * 3 + 2] = -1.0;
    for threads in [1, 8] {
        let options = BallOptions { threads: Some(threads), ..Default::default() };
        match ball(
            &Points::new(&values, 3).unwrap(),
            &BallOptions { inputs: Items::Balls, ..options.clone() },
        ) {
            Err(Error::NegativeRadius { row: 70_001, value }) => assert_eq!(value, -1e-300),
            other => panic!("{other:?}"),
        }
    }
    let zero = ball(
        &Points::new(&[1.0, -0.0], 2).unwrap(),
        &BallOptions { inputs: Items::Balls, ..options(0.0) },
    )
    .unwrap();
    assert_eq!(zero.answer.radius, 0.0);
}

#[test]
fn options_out_of_range_are_named() {
    let points = Points::new(&[0.0, 1.0], 1).unwrap();
    let conic = |delta| {
        let method = BallMethod::ThesisPure;
        BallOptions { method, delta: Some(delta), ..Default::default() }
    };
    let bad = [
        ("epsilon", options(f64::NAN)),
        ("epsilon", options(-1e-9)),
        ("epsilon", options(1.0)),
        ("epsilon", options(f64::INFINITY)),
        ("batch", BallOptions { batch: Some(0), ..Default::default() }),
        ("delta", BallOptions { delta: Some(1e-6), ..Default::default() }),
        ("delta", conic(0.0)),
        ("delta", conic(1.0)),
        ("delta", conic(f64::NAN)),
        ("threads", BallOptions { threads: Some(0), ..Default::default() }),
        ("max_passes", BallOptions { max_passes: 0, ..Default::default() }),
        ("max_passes", BallOptions { max_passes: 2, ..Default::default() }),
    ];
    for (wanted, options) in bad {
        match ball(&points, &options) {
            Err(Error::Input(InputError::Option { name, .. })) => assert_eq!(name, wanted),
            other => panic!("{wanted}: {other:?}"),
        }
    }
}

#[test]
fn a_budget_of_passes_is_kept_and_the_gap_told() {
    let (n, dim) = (3000, 30);
    let values = Random(3).normals(n * dim);
    let points = Points::new(&values, dim).unwrap();
    let mut last = f64::INFINITY;
    for max_passes in [3, 4, 5, 8] {
        let options =
            BallOptions { epsilon: 0.0, batch: Some(1), max_passes, ..Default::default() };
        let found = ball(&points, &options).unwrap();
        assert_eq!((found.trace.stop, found.trace.passes), (Stop::PassBudget, max_passes));
        let proof = judge(&values, dim, &found).unwrap();
        assert!(proof.gap > 1e-6 && proof.gap <= last, "{} after {last}", proof.gap);
        assert!(found.certificate.gap <= proof.gap * (1.0 + 1e-9));
        last = proof.gap;
    }
}

/// A budget too small for any proof is exceeded by what a proof needs, and by no more.
#[test]
fn a_small_budget_still_proves_something() {
    let mut copies = vec![0.0; 5 * 3000];
    copies[5 * 3000 - 1] = 1e-3;
    for factor in [1.0, 1e-250, 1e250] {
        for values in [Random(3).normals(300 * 5), copies.clone()] {
            let values: Vec<f64> = values.iter().map(|v| v * factor).collect();
            for batch in [Some(1), None] {
                let options =
                    BallOptions { epsilon: 0.0, batch, max_passes: 3, ..Default::default() };
                let found = ball(&Points::new(&values, 5).unwrap(), &options).unwrap();
                let proof = judge(&values, 5, &found).unwrap();
                assert!(
                    found.trace.passes <= 6 && proof.gap <= 10.0,
                    "{proof:?}, {:?}",
                    found.trace
                );
            }
        }
    }
}

#[test]
fn a_monitor_hears_and_stops() {
    let source =
        GeneratedSource::new(Distribution::Sphere, 100_000, 10, 1, ScalarKind::F64).unwrap();
    let (passes, points) = (AtomicU64::new(0), AtomicU64::new(0));
    let cancel = AtomicBool::new(false);
    let on_pass = |pass, _| {
        passes.store(pass, Ordering::Relaxed);
        if pass == 2 {
            cancel.store(true, Ordering::Relaxed);
        }
    };
    let on_points = |count| {
        points.fetch_add(count, Ordering::Relaxed);
    };
    let monitor =
        Monitor { on_points: Some(&on_points), on_pass: Some(&on_pass), cancel: Some(&cancel) };
    let found = ball(&source, &BallOptions { monitor, ..options(0.0) });
    assert!(
        matches!(found, Err(Error::Input(InputError::Read(ReadError::Cancelled(_))))),
        "{found:?}"
    );
    assert_eq!(passes.load(Ordering::Relaxed), 2);
    assert_eq!(points.load(Ordering::Relaxed), 100_000);
}

/// A source that fails from some read on.
struct Failing<'a> {
    points: Points<'a, f64>,
    reads_left: AtomicU64,
}

impl PointSource for Failing<'_> {
    fn len(&self) -> u64 {
        self.points.len() as u64
    }
    fn dim(&self) -> usize {
        self.points.dim()
    }
    fn scalar(&self) -> ScalarKind {
        ScalarKind::F64
    }
    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let left = self
            .reads_left
            .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1));
        if left.is_err() {
            return Err(ReadError::Io {
                path: PathBuf::from("drum"),
                first: range.start,
                last: range.end,
                source: std::io::Error::other("the drum stopped"),
            });
        }
        self.points.read(range, scratch)
    }
}

#[test]
fn a_failing_source_is_reported_wherever_it_fails() {
    let values = Random(4).normals(60_000 * 4);
    let points = Points::new(&values, 4).unwrap();
    let mut ended_well = false;
    for reads in (0..2000).step_by(37) {
        let source = Failing { points, reads_left: AtomicU64::new(reads) };
        match ball(&source, &options(0.0)) {
            Ok(found) => {
                judge(&values, 4, &found).unwrap();
                ended_well = true;
            }
            Err(Error::Input(InputError::Read(ReadError::Io { path, .. }))) => {
                assert_eq!(path, PathBuf::from("drum"));
                assert!(!ended_well);
            }
            Err(other) => panic!("{other:?}"),
        }
    }
    assert!(ended_well);
}

/// Values in a file, behind a few bytes that are not values.
fn file_of<T: bytemuck::NoUninit>(values: &[T], head: usize) -> tempfile::NamedTempFile {
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(&vec![7; head]).unwrap();
    file.write_all(bytemuck::cast_slice(values)).unwrap();
    file.flush().unwrap();
    file
}

#[test]
fn a_file_that_shrinks_is_reported() {
    let (n, dim) = (20_000u64, 8);
    let file = file_of(&Random(5).normals(n as usize * dim), 0);
    let source = FileSource::open(file.path(), 0, n, dim, ScalarKind::F64).unwrap();
    file.as_file().set_len(n * dim as u64 * 8 - 1).unwrap();
    let found = ball(&source, &options(0.0));
    assert!(
        matches!(found, Err(Error::Input(InputError::Read(ReadError::Io { .. })))),
        "{found:?}"
    );
    assert!(matches!(
        FileSource::open(file.path(), 0, n, dim, ScalarKind::F64),
        Err(ReadError::Truncated { .. })
    ));
}

/// JSON for 1, 2 and 8 threads, which must be one and the same.
fn json(source: &dyn PointSource, items: Items, epsilon: f64) -> String {
    let of = |threads| {
        let options = BallOptions { epsilon, threads: Some(threads), ..Default::default() };
        ball(source, &BallOptions { inputs: items, ..options.clone() }).unwrap().to_json()
    };
    let one = of(1);
    for threads in [2, 8] {
        assert_eq!(one, of(threads), "{threads} threads");
    }
    one
}

#[test]
fn threads_and_sources_change_no_byte() {
    let cases = [
        (Distribution::Normal, 300_000, 3),
        (Distribution::Poisson, 100_000, 10),
        (Distribution::CubeVertices, 20_000, 40),
        (Distribution::Sphere, 50_000, 16),
        (Distribution::Polygon { vertices: 1000 }, 400_000, 2),
        (Distribution::Clusters { count: 7, spread: 1e-9 }, 40_000, 20),
        (Distribution::Uniform, 3_000, 250),
    ];
    for (distribution, n, dim) in cases.into_iter().step_by(crate::test_length::long_or(1, 2)) {
        assert!(n * dim > 10 * taut_points::Blocks::VALUES);
        let values: Vec<f64> = generate(distribution, n, dim, 17).unwrap();
        let wanted = json(&Points::new(&values, dim).unwrap(), Items::Points, 0.0);
        for &head in crate::test_length::long_or(&[0, 3][..], &[3]) {
            let file = file_of(&values, head);
            let (path, offset, count) = (file.path(), head as u64, n as u64);
            let read = FileSource::open(path, offset, count, dim, ScalarKind::F64).unwrap();
            assert_eq!(json(&read, Items::Points, 0.0), wanted, "{distribution:?} from a file");
            let mapped = MappedSource::open(path, offset, count, dim, ScalarKind::F64).unwrap();
            assert_eq!(json(&mapped, Items::Points, 0.0), wanted, "{distribution:?} mapped");
        }
        let generated =
            GeneratedSource::new(distribution, n as u64, dim, 17, ScalarKind::F64).unwrap();
        assert_eq!(json(&generated, Items::Points, 0.0), wanted, "{distribution:?} generated");
        let found = ball(&Points::new(&values, dim).unwrap(), &options(0.0)).unwrap();
        assert_eq!(found.to_json(), wanted, "{distribution:?} in the common pool");
        judge(&values, dim, &found).unwrap();
    }
}

#[test]
fn threads_change_no_byte_for_balls_and_single_precision() {
    let mut balls: Vec<f32> = generate(Distribution::Normal, 150_000, 6, 3).unwrap();
    balls.chunks_exact_mut(6).for_each(|ball| ball[5] = ball[5].abs());
    let wanted = json(&Points::new(&balls, 6).unwrap(), Items::Balls, 1e-9);
    let file = file_of(&balls, 5);
    let read = FileSource::open(file.path(), 5, 150_000, 6, ScalarKind::F32).unwrap();
    assert_eq!(json(&read, Items::Balls, 1e-9), wanted);
    let wide: Vec<f64> = balls.iter().map(|&v| f64::from(v)).collect();
    assert_eq!(json(&Points::new(&wide, 6).unwrap(), Items::Balls, 1e-9), wanted);
    // Scaled reads go another way through a block.
    let small: Vec<f64> = wide.iter().map(|v| v * 2f64.powi(-800)).collect();
    json(&Points::new(&small, 6).unwrap(), Items::Balls, 0.0);
}
