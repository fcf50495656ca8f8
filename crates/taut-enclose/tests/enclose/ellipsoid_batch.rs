//! Many point sets at once: the bytes of single answers, whatever the threads; errors by the number of their set.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use taut_enclose::{EllipsoidMethod, EllipsoidOptions, Error, ellipsoid, ellipsoids};
use taut_points::{Distribution, InputError, Monitor, PointSource, Points, ReadError, generate};

/// Sets of 1 to 3000 points in 1 to 6 dimensions: few points are flat sets, many are several blocks.
fn tables() -> Vec<(Vec<f64>, usize)> {
    let table = |i: usize| {
        let (n, dim) = ([1, 2, 5, 40, 300, 3000][i % 6], i % 5 + 1);
        let kinds = [Distribution::Normal, Distribution::Uniform, Distribution::Sphere];
        (generate(kinds[i % 3], n, dim, i as u64).unwrap(), dim)
    };
    let mut tables: Vec<(Vec<f64>, usize)> = (0..60).map(table).collect();
    tables.push((generate(Distribution::Normal, 70_000, 3, 1).unwrap(), 3));
    tables
}

fn views(tables: &[(Vec<f64>, usize)]) -> Vec<Points<'_, f64>> {
    tables.iter().map(|(values, dim)| Points::new(values, *dim).unwrap()).collect()
}

#[test]
fn each_answer_is_that_of_its_set_alone_for_any_number_of_threads() {
    let tables = tables();
    let sets = views(&tables);
    for method in [EllipsoidMethod::Newton, EllipsoidMethod::AwaySteps] {
        let mut options = EllipsoidOptions { epsilon: 1e-3, method, ..Default::default() };
        let alone: Vec<String> =
            sets.iter().map(|set| ellipsoid(set, &options).unwrap().to_json()).collect();
        for threads in [None, Some(1), Some(3)] {
            options.threads = threads;
            let found = ellipsoids(&sets, &options).unwrap();
            let together: Vec<String> = found.iter().map(|found| found.to_json()).collect();
            assert!(alone == together, "{method:?}, {threads:?}");
        }
    }
    let found = ellipsoids(&sets, &EllipsoidOptions::default()).unwrap();
    for (i, (found, set)) in found.iter().zip(&sets).enumerate() {
        assert!(found.check(set).unwrap().gap <= 1e-9, "set {i}");
    }
}

#[test]
fn single_precision_and_no_set_at_all() {
    let values: Vec<f32> = generate(Distribution::Normal, 90, 2, 5).unwrap();
    let sets: Vec<Points<'_, f32>> =
        values.chunks(20).map(|set| Points::new(set, 2).unwrap()).collect();
    let found = ellipsoids(&sets, &EllipsoidOptions::default()).unwrap();
    for (found, set) in found.iter().zip(&sets) {
        assert_eq!(found, &ellipsoid(set, &EllipsoidOptions::default()).unwrap());
    }
    assert_eq!(ellipsoids::<Points<'_, f64>>(&[], &EllipsoidOptions::default()).unwrap(), []);
}

#[test]
fn an_error_names_the_first_set_it_is_about() {
    let (good, bad) = ([0.0, 0.0, 1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, f64::NAN]);
    let mut sets = vec![Points::new(&good, 2).unwrap(); 200];
    sets[150] = Points::new(&bad, 2).unwrap();
    sets[170] = Points::new(&[], 2).unwrap();
    for threads in [1, 4] {
        let options = EllipsoidOptions { threads: Some(threads), ..Default::default() };
        let error = ellipsoids(&sets, &options).unwrap_err();
        let words = "point set 150: coordinate 1 of point 1 is NaN: all coordinates must be finite";
        assert_eq!(error.to_string(), words);
        match ellipsoids(&sets[160..], &options).unwrap_err() {
            Error::Set { set: 10, error } => assert!(matches!(*error, Error::Empty)),
            other => panic!("{other}"),
        }
    }
    // What is wrong with the options is no fault of a set.
    let options = EllipsoidOptions { epsilon: -1.0, ..Default::default() };
    let error = ellipsoids(&sets, &options).unwrap_err();
    assert!(matches!(error, Error::Input(InputError::Option { name: "epsilon", .. })), "{error}");
}

#[test]
fn a_monitor_hears_of_all_points_and_stops_the_work() {
    let tables = tables();
    let sets = views(&tables);
    let sources: Vec<&dyn PointSource> = sets.iter().map(|set| set as &dyn PointSource).collect();
    let (announced, heard) = (AtomicU64::new(0), AtomicU64::new(0));
    let on_pass = |pass: u64, points: u64| {
        assert_eq!(pass, 1);
        announced.store(points, Ordering::Relaxed);
    };
    let on_points = |points: u64| {
        heard.fetch_add(points, Ordering::Relaxed);
    };
    let options = EllipsoidOptions::default();
    let monitor =
        Monitor { on_pass: Some(&on_pass), on_points: Some(&on_points), ..Monitor::silent() };
    let found = ellipsoids(&sources, &EllipsoidOptions { monitor, ..options.clone() }).unwrap();
    let all: u64 = sources.iter().map(|source| source.len()).sum();
    assert_eq!((announced.into_inner(), heard.into_inner()), (all, all));
    let alone = ellipsoid(sources[7], &options).unwrap();
    assert_eq!(found[7], alone);

    let cancel = AtomicBool::new(true);
    let monitor = Monitor { cancel: Some(&cancel), ..Monitor::silent() };
    let error = ellipsoids(&sources, &EllipsoidOptions { monitor, ..options.clone() }).unwrap_err();
    assert!(matches!(error, Error::Input(InputError::Read(ReadError::Cancelled(_)))), "{error}");
}
