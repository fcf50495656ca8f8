//! Clusters from the ball of a kernel.

use std::f64::consts::TAU;

use taut_points::Points;
use taut_recognize::classify::{ClusterOptions, Width, cluster};

use super::support::Draws;

/// A ring around a disk, then points far away, with the number of their part.
fn ring_and_disk() -> (Vec<f64>, Vec<u32>) {
    let mut draws = Draws(40);
    let (mut values, mut parts) = (vec![], vec![]);
    for i in 0..260 {
        let angle = TAU * draws.unit();
        let part = u32::from(i >= 180);
        let radius = if part == 0 { 4.0 + 0.3 * draws.unit() } else { draws.unit() };
        values.extend([radius * angle.cos(), radius * angle.sin()]);
        parts.push(part);
    }
    (values, parts)
}

#[test]
fn a_ring_and_the_disk_within_are_two_clusters() {
    let (values, parts) = ring_and_disk();
    let points = Points::new(&values, 2).unwrap();
    let options = ClusterOptions { width: Width::Gamma { gamma: 1.0 }, ..Default::default() };
    let found = cluster(points, &options).unwrap();
    assert_eq!(found.count, 2);
    assert_eq!(found.clusters, parts.iter().copied().map(Some).collect::<Vec<_>>());
    for threads in [1, 8] {
        let again = cluster(points, &ClusterOptions { threads: Some(threads), ..options.clone() });
        assert_eq!(again.unwrap(), found);
    }
    // So wide that the ball is convex: one cluster.
    let wide = ClusterOptions { width: Width::Gamma { gamma: 1e-3 }, ..Default::default() };
    assert_eq!(cluster(points, &wide).unwrap().count, 1);
}

#[test]
fn a_soft_ball_leaves_outliers_in_no_cluster() {
    let (mut values, _) = ring_and_disk();
    values.extend([20.0, 20.0, -18.0, 25.0]);
    let points = Points::new(&values, 2).unwrap();
    let options =
        ClusterOptions { width: Width::Gamma { gamma: 1.0 }, nu: Some(0.2), ..Default::default() };
    let found = cluster(points, &options).unwrap();
    assert_eq!(found.clusters[260..], [None, None]);
    assert!(found.clusters.iter().filter(|c| c.is_none()).count() <= 52);
    let copies = Points::new(&[1.0; 6], 2).unwrap();
    assert_eq!(cluster(copies, &options).unwrap().clusters, [Some(0); 3]);
}

#[test]
fn bad_options_are_refused() {
    let points = Points::new(&[0.0, 1.0], 1).unwrap();
    let base = ClusterOptions::default;
    for options in [
        ClusterOptions { nu: Some(0.0), ..base() },
        ClusterOptions { neighbors: 0, ..base() },
        ClusterOptions { samples: 0, ..base() },
        ClusterOptions { epsilon: 1.0, ..base() },
        ClusterOptions { width: Width::Sigma { sigma: -1.0 }, ..base() },
        ClusterOptions { threads: Some(0), ..base() },
    ] {
        assert!(cluster(points, &options).unwrap_err().to_string().contains("option"));
    }
    let none = Points::new(&[], 1).unwrap();
    assert!(cluster(none, &base()).unwrap_err().to_string().contains("empty"));
}
