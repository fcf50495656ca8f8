//! Tests what the tests of centers share: the optimum by brute force, and distances by plain sums.
#![allow(dead_code, unreachable_pub)] // each test binary uses a part

use taut_certify::{Centers, LowerBound, Solution};
use taut_enclose::{BallOptions, ball};
use taut_points::Points;

/// |a − b|, coordinate by coordinate.
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The largest distance of a point to the nearest center.
pub fn radius(values: &[f64], dim: usize, centers: &[Vec<f64>]) -> f64 {
    let nearest = |x: &[f64]| centers.iter().map(|c| distance(x, c)).fold(f64::INFINITY, f64::min);
    values.chunks_exact(dim).map(nearest).fold(0.0, f64::max)
}

/// The least distance of two of the rows.
pub fn least_distance(values: &[f64], dim: usize, rows: &[u64]) -> f64 {
    let row = |i: u64| &values[i as usize * dim..][..dim];
    let mut least = f64::INFINITY;
    for (i, &a) in rows.iter().enumerate() {
        for &b in &rows[i + 1..] {
            least = least.min(distance(row(a), row(b)));
        }
    }
    least
}

/// The optimal radius of k free centers, for each k up to `k_max`: the smallest ball of every subset, then the best way to
/// put subsets together.
pub fn optima(values: &[f64], dim: usize, k_max: usize) -> Vec<f64> {
    let n = values.len() / dim;
    assert!((1..=10).contains(&n), "2^n balls");
    let options = BallOptions { epsilon: 0.0, ..BallOptions::default() };
    let mut single = vec![0.0; 1 << n];
    for mask in 1usize..1 << n {
        let rows = (0..n).filter(|i| mask >> i & 1 == 1);
        let subset: Vec<f64> = rows.flat_map(|i| values[i * dim..][..dim].to_vec()).collect();
        single[mask] = ball(&Points::new(&subset, dim).unwrap(), &options).unwrap().answer.radius;
    }
    let mut best = single.clone();
    let mut optima = vec![best[(1 << n) - 1]];
    for _ in 1..k_max {
        let mut next = best.clone();
        for mask in 1usize..1 << n {
            let mut part = mask;
            while part > 0 {
                next[mask] = f64::min(next[mask], single[part].max(best[mask ^ part]));
                part = (part - 1) & mask;
            }
        }
        best = next;
        optima.push(best[(1 << n) - 1]);
    }
    optima
}

/// The optimal radius of k free centers on a line, to rounding: intervals from left to right, by bisection.
pub fn optimum_on_a_line(values: &[f64], k: usize) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let fits = |radius: f64| {
        let (mut used, mut end) = (0, f64::NEG_INFINITY);
        for &x in &sorted {
            if x > end {
                used += 1;
                end = x + 2.0 * radius;
            }
        }
        used <= k
    };
    if fits(0.0) {
        return 0.0;
    }
    let (mut low, mut high) = (0.0, sorted[sorted.len() - 1] - sorted[0]);
    for _ in 0..200 {
        let middle = (low + high) / 2.0;
        if fits(middle) { high = middle } else { low = middle }
    }
    high
}

/// Judges centers by plain sums: the radius holds, and the rows named are as far apart as the bound says.
pub fn judge(found: &Solution<Centers>, values: &[f64], dim: usize) {
    let Centers { centers, rows, radius: claimed, lower_bound, .. } = &found.answer;
    let certificate = &found.certificate;
    assert!(!centers.is_empty() && centers.len() as u64 <= certificate.k);
    let measured = radius(values, dim, centers);
    assert!(measured <= *claimed, "{measured} is beyond {claimed}");
    assert!(measured >= claimed * (1.0 - 1e-13), "{measured} is far below {claimed}");
    for (center, &row) in centers.iter().zip(rows) {
        assert_eq!(center, &values[row as usize * dim..][..dim]);
    }
    assert_eq!(certificate.proof, LowerBound::Separated);
    if *lower_bound > 0.0 {
        assert!(certificate.core_set.len() as u64 > certificate.k);
        assert!(least_distance(values, dim, &certificate.core_set) >= 2.0 * lower_bound);
        let gap = claimed / lower_bound - 1.0;
        assert!(gap <= certificate.gap * (1.0 + 1e-9) + 4e-16);
    } else {
        assert_eq!((*claimed, certificate.gap), (0.0, 0.0));
    }
    let points = Points::new(values, dim).unwrap();
    found.check(&points).unwrap_or_else(|error| panic!("{error}\n{found:?}"));
}
