//! Tests what the tests of the ellipsoid share: a judge, and point families.
#![allow(dead_code, unreachable_pub)] // each test binary uses a part

use taut_certify::{AnySolution, Ellipsoid, EllipsoidVerdict, Solution};
use taut_enclose::{EllipsoidMethod, EllipsoidOptions, ellipsoid};
use taut_points::{Distribution, Points, generate};

/// Options for a gap.
pub fn within(epsilon: f64) -> EllipsoidOptions<'static> {
    EllipsoidOptions { epsilon, ..Default::default() }
}

/// Options for a method and a gap.
pub fn by(method: EllipsoidMethod, epsilon: f64) -> EllipsoidOptions<'static> {
    EllipsoidOptions { epsilon, method, ..Default::default() }
}

/// The ellipsoid of rows, judged; panics with the name of the case.
pub fn solve(
    name: &str,
    values: &[f64],
    dim: usize,
    options: &EllipsoidOptions<'_>,
) -> Solution<Ellipsoid> {
    let points = Points::new(values, dim).unwrap();
    let found = ellipsoid(&points, options).unwrap_or_else(|error| panic!("{name}: {error}"));
    judge(name, values, dim, &found);
    found
}

/// Asks the checker, and looks at all points as a user would.
pub fn judge(
    name: &str,
    values: &[f64],
    dim: usize,
    found: &Solution<Ellipsoid>,
) -> EllipsoidVerdict {
    let points = Points::new(values, dim).unwrap();
    let verdict = found.check(&points).unwrap_or_else(|error| panic!("{name}: {error}"));
    // A point on the border exactly is outside by what the checker rounds up.
    assert!(verdict.excess < 1e-25, "{name}: a point is outside by {:e}", verdict.excess);
    let claimed = found.certificate.gap;
    assert!(
        verdict.gap <= claimed * (1.0 + 1e-9) + 2e-15 * verdict.rank as f64,
        "{name}: gap {:e} of {claimed:e}",
        verdict.gap
    );
    assert_eq!(verdict.rank, found.answer.rank(), "{name}");
    match AnySolution::from_json(&found.to_json()) {
        Ok(AnySolution::Ellipsoid(again)) if again == *found => {}
        other => panic!("{name}: JSON does not read back: {other:?}"),
    }
    verdict
}

/// The same, with a gap that must be reached.
pub fn exact(name: &str, values: &[f64], dim: usize, gap: f64) -> Solution<Ellipsoid> {
    let found = solve(name, values, dim, &within(gap));
    assert!(
        found.certificate.gap <= gap,
        "{name}: gap {:e}, {:?}",
        found.certificate.gap,
        found.trace
    );
    found
}

/// ln of the volume of the unit ball, by the gamma function of half integers.
pub fn log_unit_ball(dim: usize) -> f64 {
    let pi = std::f64::consts::PI;
    let mut volume = if dim.is_multiple_of(2) { 1.0 } else { 2.0 };
    let mut d = if dim.is_multiple_of(2) { 2 } else { 3 };
    while d <= dim {
        volume *= 2.0 * pi / d as f64;
        d += 2;
    }
    volume.ln()
}

/// Numbers in [0, 1) that depend on a seed alone.
pub fn uniform(count: usize, seed: u64) -> Vec<f64> {
    generate(Distribution::Uniform, count, 1, seed).unwrap()
}

/// Normal points, n × d.
pub fn normal(n: usize, dim: usize, seed: u64) -> Vec<f64> {
    generate(Distribution::Normal, n, dim, seed).unwrap()
}

/// A matrix of random entries, d × d, far enough from singular for what the tests ask of it.
pub fn map(dim: usize, seed: u64) -> Vec<f64> {
    let drawn = |seed| {
        let mut entries = normal(dim, dim, seed);
        (0..dim).for_each(|a| entries[a * dim + a] += 3.0);
        entries
    };
    // Of Hadamard's bound on the determinant, not less than a thousandth.
    let is_wide = |entries: &Vec<f64>| {
        let length = |row: &[f64]| row.iter().map(|x| x * x).sum::<f64>().sqrt();
        let bound: f64 = entries.chunks(dim).map(|row| length(row).ln()).sum();
        log_determinant(entries, dim) >= bound - 1000f64.ln()
    };
    (seed..).step_by(1000).map(drawn).find(is_wide).expect("one of many maps is wide")
}

/// Ax + b for each row x.
pub fn mapped(values: &[f64], matrix: &[f64], shift: &[f64]) -> Vec<f64> {
    let dim = shift.len();
    let columns = matrix.len() / dim;
    let image = |x: &[f64]| -> Vec<f64> {
        let product = |row: &[f64]| row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>();
        matrix.chunks(columns).zip(shift).map(|(row, b)| product(row) + b).collect()
    };
    values.chunks(columns).flat_map(image).collect()
}

/// ln |det A| by elimination with pivots.
pub fn log_determinant(matrix: &[f64], dim: usize) -> f64 {
    let mut a = matrix.to_vec();
    let mut sum = 0.0;
    for k in 0..dim {
        let pivot = (k..dim).max_by(|&i, &j| a[i * dim + k].abs().total_cmp(&a[j * dim + k].abs()));
        let pivot = pivot.unwrap();
        (0..dim).for_each(|j| a.swap(k * dim + j, pivot * dim + j));
        sum += a[k * dim + k].abs().ln();
        for i in k + 1..dim {
            let factor = a[i * dim + k] / a[k * dim + k];
            for j in k..dim {
                a[i * dim + j] -= factor * a[k * dim + j];
            }
        }
    }
    sum
}

/// Points near the border of an ellipsoid with axes between 1 and 1000, turned; `thickness` of the radius.
pub fn shell(n: usize, dim: usize, thickness: f64, seed: u64) -> Vec<f64> {
    let (directions, radii) = (normal(n, dim, seed), uniform(n, seed + 1));
    let turn = rotation(dim, seed + 2);
    let mut out = Vec::with_capacity(n * dim);
    for (x, r) in directions.chunks(dim).zip(radii) {
        let length = x.iter().map(|x| x * x).sum::<f64>().sqrt();
        let y: Vec<f64> = x
            .iter()
            .enumerate()
            .map(|(j, x)| {
                let axis = 1000f64.powf(j as f64 / (dim - 1).max(1) as f64);
                x / length * (1.0 - thickness * r) * axis
            })
            .collect();
        out.extend(turn.chunks(dim).map(|row| row.iter().zip(&y).map(|(a, y)| a * y).sum::<f64>()));
    }
    out
}

/// An orthogonal matrix, by rows.
pub fn rotation(dim: usize, seed: u64) -> Vec<f64> {
    let mut rows: Vec<Vec<f64>> = vec![];
    for row in normal(dim, dim, seed).chunks(dim) {
        let mut row = row.to_vec();
        for _ in 0..2 {
            for other in &rows {
                let product: f64 = row.iter().zip(other).map(|(a, b)| a * b).sum();
                row.iter_mut().zip(other).for_each(|(a, b)| *a -= product * b);
            }
        }
        let length = row.iter().map(|v| v * v).sum::<f64>().sqrt();
        rows.push(row.into_iter().map(|v| v / length).collect());
    }
    rows.concat()
}
