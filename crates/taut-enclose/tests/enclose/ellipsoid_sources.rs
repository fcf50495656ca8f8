//! Neither threads nor the kind of source change a byte of an ellipsoid, and a run can be stopped.

use std::io::Write;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use ellipsoids::{by, judge, normal, shell, within};
use taut_certify::Stop;
use taut_enclose::{EllipsoidMethod, EllipsoidOptions, Error, ellipsoid};
use taut_points::{
    Distribution, FileSource, GeneratedSource, InputError, MappedSource, Monitor, PointSource,
    Points, ReadError, ScalarKind, generate,
};

use crate::ellipsoids;

fn json(source: &dyn PointSource, options: &EllipsoidOptions<'_>) -> String {
    ellipsoid(source, options).unwrap().to_json()
}

#[test]
fn threads_do_not_change_a_byte() {
    let flat: Vec<f64> =
        normal(40_000, 3, 5).chunks(3).flat_map(|p| [p[0], p[1], p[2], p[0] + p[1]]).collect();
    for (name, values, dim) in [
        ("normal", normal(60_000, 5, 1), 5),
        ("more dimensions", normal(4000, 40, 1), 40),
        ("shell", shell(30_000, 6, 1e-4, 2), 6),
        ("thin shell, interior point", shell(3000, 16, 1e-9, 2), 16),
        ("flat", flat, 4),
    ] {
        let points = Points::new(&values, dim).unwrap();
        let with =
            |threads| json(&points, &EllipsoidOptions { threads: Some(threads), ..within(1e-12) });
        let one = with(1);
        for &threads in crate::test_length::long_or(&[2, 3, 8][..], &[3]) {
            assert_eq!(one, with(threads), "{name}, {threads} threads");
        }
    }
    for method in EllipsoidMethod::ALL {
        let values = normal(30_000, 4, 1);
        let points = Points::new(&values, 4).unwrap();
        let with = |threads| {
            json(&points, &EllipsoidOptions { threads: Some(threads), ..by(method, 0.1) })
        };
        assert_eq!(with(1), with(4), "{method}");
    }
}

#[test]
fn the_source_does_not_change_a_byte() {
    let (n, dim) = (40_000, 3);
    let values: Vec<f32> = generate(Distribution::Normal, n, dim, 9).unwrap();
    let wide: Vec<f64> = values.iter().map(|&v| v.into()).collect();
    let options = within(1e-12);
    let memory = json(&Points::new(&values, dim).unwrap(), &options);
    assert_eq!(memory, json(&Points::new(&wide, dim).unwrap(), &options));
    let mut file = tempfile::NamedTempFile::new().unwrap();
    file.write_all(&values.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let opened = FileSource::open(file.path(), 0, n as u64, dim, ScalarKind::F32).unwrap();
    assert_eq!(memory, json(&opened, &options));
    let mapped = MappedSource::open(file.path(), 0, n as u64, dim, ScalarKind::F32).unwrap();
    assert_eq!(memory, json(&mapped, &options));
    let drawn =
        GeneratedSource::new(Distribution::Normal, n as u64, dim, 9, ScalarKind::F32).unwrap();
    assert_eq!(memory, json(&drawn, &options));
    let found = ellipsoid(&Points::new(&values, dim).unwrap(), &options).unwrap();
    judge("single precision", &wide, dim, &found);
}

/// What a file larger than memory costs: one read, or two, for points without structure.
#[test]
fn many_points_are_read_once_or_twice() {
    for distribution in [Distribution::Normal, Distribution::Uniform] {
        for dim in [2, 3] {
            let source =
                GeneratedSource::new(distribution, 300_000, dim, 3, ScalarKind::F32).unwrap();
            let found = ellipsoid(&source, &within(1e-9)).unwrap();
            assert_eq!(found.trace.stop, Stop::Converged);
            assert!(found.trace.passes <= 2, "{distribution:?}, {dim}: {}", found.trace.passes);
        }
    }
}

#[test]
fn a_monitor_hears_of_passes_and_can_stop() {
    let values = normal(200_000, 3, 2);
    let points = Points::new(&values, 3).unwrap();
    let passes = AtomicU64::new(0);
    let stop = AtomicBool::new(false);
    let record = |pass: u64, _: u64| {
        passes.fetch_max(pass, Ordering::Relaxed);
        if pass == 1 {
            stop.store(true, Ordering::Relaxed);
        }
    };
    let monitor = Monitor { on_pass: Some(&record), cancel: Some(&stop), ..Monitor::silent() };
    let stopped = ellipsoid(&points, &EllipsoidOptions { monitor, ..within(1e-12) });
    assert!(
        matches!(stopped, Err(Error::Input(InputError::Read(ReadError::Cancelled(_))))),
        "{stopped:?}"
    );
    assert_eq!(passes.load(Ordering::Relaxed), 1);
}
