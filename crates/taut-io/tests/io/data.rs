//! Known files, where `TAUT_DATA` names the folder that holds `ball/*.xz`.

use std::path::PathBuf;

use taut_io::{Input, ReadOptions, open};

/// The file, unless the variable is not set.
fn data(test: &str, name: &str) -> Option<PathBuf> {
    match std::env::var_os("TAUT_DATA") {
        Some(folder) => Some(PathBuf::from(folder).join("ball").join(name)),
        None => {
            println!("skipped {test}: TAUT_DATA is not set");
            None
        }
    }
}

fn read(path: &std::path::Path, columns: Option<&str>) -> Input {
    let columns = columns.map(|text| text.parse().unwrap());
    open(path, &ReadOptions { columns, ..Default::default() }).unwrap()
}

#[test]
fn usps_digits() {
    let sets = [("usps_test.csv.xz", 2007), ("usps_train.csv.xz", 7291)];
    for (name, n) in sets.into_iter().take(crate::test_length::long_or(2, 1)) {
        let Some(path) = data("usps_digits", name) else { return };
        let all = read(&path, None);
        assert_eq!((all.source.len(), all.source.dim()), (n, 257));
        let pixels = read(&path, Some("1-"));
        assert_eq!((pixels.source.len(), pixels.source.dim()), (n, 256));
        assert!(super::values(&pixels).iter().all(|value| (-1.0..=1.0).contains(value)));
    }
}

#[test]
fn cities() {
    let Some(path) = data("cities", "d15112.tsp.xz") else { return };
    let germany = read(&path, None);
    assert_eq!((germany.source.len(), germany.source.dim()), (15112, 2));
    let values = super::values(&germany);
    assert_eq!(
        (&values[..2], &values[values.len() - 2..]),
        (&[5826.0, 1350.0][..], &[13139.0, 9322.0][..])
    );
    let Some(path) = data("cities", "usa13509.xy.xz") else { return };
    let america = read(&path, None);
    assert_eq!((america.source.len(), america.source.dim()), (13509, 2));
    assert_eq!(super::values(&america)[..2], [245552.778, 817827.778]);
}
