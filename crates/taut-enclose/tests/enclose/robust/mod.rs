//! Tests what the tests of robust ellipsoids share: a judge, and point families.
#![allow(dead_code, unreachable_pub)] // each test binary uses a part

use taut_certify::{AnySolution, RobustEllipsoid, RobustMethod, RobustVerdict, Solution};
use taut_enclose::{RobustOptions, robust_ellipsoid};
use taut_points::{Distribution, Monitor, Points, generate};

/// Options for a method.
pub fn by(method: RobustMethod) -> RobustOptions<'static> {
    RobustOptions { method, ..Default::default() }
}

/// The estimate of rows, judged; panics with the name of the case.
pub fn solve(
    name: &str,
    values: &[f64],
    dim: usize,
    options: &RobustOptions<'_>,
) -> Solution<RobustEllipsoid> {
    let points = Points::new(values, dim).unwrap();
    let found = robust_ellipsoid(&points, options).unwrap_or_else(|e| panic!("{name}: {e}"));
    judge(name, values, dim, &found);
    found
}

/// Asks the checker, and reads the answer back from JSON.
pub fn judge(
    name: &str,
    values: &[f64],
    dim: usize,
    found: &Solution<RobustEllipsoid>,
) -> RobustVerdict {
    let points = Points::new(values, dim).unwrap();
    let verdict = found.check(&points).unwrap_or_else(|error| panic!("{name}: {error}\n{found:?}"));
    assert_eq!(verdict.rank, found.answer.factor.len(), "{name}");
    match AnySolution::from_json(&found.to_json()) {
        Ok(again @ AnySolution::Robust(_)) => {
            assert_eq!(again, AnySolution::Robust(found.clone()), "{name}");
            assert!(again.check(&points, &Monitor::silent()).is_ok());
        }
        other => panic!("{name}: JSON does not read back: {other:?}"),
    }
    verdict
}

/// Normal points, n × d.
pub fn normal(n: usize, dim: usize, seed: u64) -> Vec<f64> {
    generate(Distribution::Normal, n, dim, seed).unwrap()
}

/// Normal points; the last `outliers` lie in a cluster of their own, `away` from the others along all axes.
pub fn contaminated(n: usize, dim: usize, outliers: usize, away: f64, seed: u64) -> Vec<f64> {
    let mut values = normal(n, dim, seed);
    for v in &mut values[(n - outliers) * dim..] {
        *v += away;
    }
    values
}

/// Ax + b for each row x.
pub fn mapped(values: &[f64], matrix: &[f64], shift: &[f64]) -> Vec<f64> {
    let dim = shift.len();
    let image = |x: &[f64]| -> Vec<f64> {
        let product = |row: &[f64]| row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
        matrix.chunks(dim).zip(shift).map(|(row, b)| product(row) + b).collect()
    };
    values.chunks(dim).flat_map(image).collect()
}

/// Mean and covariance, divisor n − 1, by the book.
pub fn classical(values: &[f64], dim: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    let n = (values.len() / dim) as f64;
    let mut mean = vec![0.0; dim];
    for row in values.chunks(dim) {
        mean.iter_mut().zip(row).for_each(|(m, x)| *m += x / n);
    }
    let entry = |a: usize, b: usize| {
        let terms = values.chunks(dim).map(|x| (x[a] - mean[a]) * (x[b] - mean[b]));
        terms.sum::<f64>() / (n - 1.0)
    };
    let covariance = (0..dim).map(|a| (0..dim).map(|b| entry(a, b)).collect()).collect();
    (mean, covariance)
}

/// Some columns of a set of the folder `TAUT_DATA`, or nothing where that is not set.
pub fn real(name: &str, columns: usize) -> Option<Vec<f64>> {
    let folder = std::env::var_os("TAUT_DATA").map(std::path::PathBuf::from)?;
    let csv = std::fs::read_to_string(folder.join("ellipsoid").join(name)).ok()?;
    let rows = csv.lines().skip(1).map(|line| -> Vec<f64> {
        line.split(',').take(columns).map(|field| field.trim().parse().unwrap()).collect()
    });
    Some(rows.collect::<Vec<_>>().concat())
}
