//! Small balls prove themselves.

use taut_certify::Items;
use taut_points::{Distribution, Points, generate};

use super::super::items::{ItemSet, Position, Shape, distance};
use super::{Ball, Workspace};
use crate::{BallOptions, ball};

/// Optimal by its own proof: all items are inside, and no smaller ball holds the support.
fn judge<P: Position>(items: &ItemSet<P>, tolerance: f64, what: &str) -> f64 {
    let members: Vec<u32> = (0..items.len() as u32).collect();
    let mut work = Workspace::new(items.dim());
    let all = Ball::of_all(items, &members, &mut work);
    // One by one, as a search does.
    let mut grown = Ball::of_one(items, 0);
    for at in 1..members.len() {
        let known = &members[..at];
        let radius = work.radius_with(items, &grown, known, members[at], f64::INFINITY);
        grown.grow(items, known, members[at], f64::INFINITY, &mut work);
        let difference = (radius - grown.radius).abs();
        assert!(difference <= tolerance * radius, "{what}: {radius} against {}", grown.radius);
    }
    for ball in [&all, &grown] {
        let lower = ball.lower_bound(items);
        let error = (ball.radius - lower).abs();
        assert!(error <= tolerance * ball.radius, "{what}: {lower} to {}", ball.radius);
        let reaches = (0..items.len()).map(|item| items.reach(item, &ball.center));
        let reach = reaches.fold(0.0, f64::max);
        assert!(reach <= ball.radius * (1.0 + 1e-12), "{what}: {reach} of {}", ball.radius);
        assert!(ball.support.len() <= items.dim() + 1, "{what}");
    }
    all.radius
}

/// The ball of these rows as points, with weights, and as balls, beside that of the other solver.
fn all_shapes<P: Position>(values: &[f64], extras: &[f64], dim: usize, tolerance: f64, what: &str) {
    for shape in [Shape::Points, Shape::Weighted, Shape::Balls] {
        let mut items = ItemSet::<P>::new(shape, dim);
        for (row, &extra) in values.chunks_exact(dim).zip(extras) {
            items.push(row, extra);
        }
        let what = format!("{shape:?}, {what}");
        let radius = judge(&items, tolerance, &what);
        let options = BallOptions { epsilon: 1e-12, ..BallOptions::default() };
        let wanted = match shape {
            Shape::Points => ball(&Points::new(values, dim).unwrap(), &options),
            Shape::Balls => {
                let rows: Vec<f64> = (values.chunks_exact(dim).zip(extras))
                    .flat_map(|(row, &r)| row.iter().copied().chain([r]))
                    .collect();
                ball(
                    &Points::new(&rows, dim + 1).unwrap(),
                    &BallOptions { inputs: Items::Balls, ..options.clone() },
                )
            }
            Shape::Weighted => continue,
        };
        let wanted = wanted.unwrap().answer.radius;
        assert!((radius - wanted).abs() <= 1e-11 * wanted, "{what}: {radius}, {wanted}");
    }
}

fn sets<P: Position>(dim: usize) {
    for seed in 0..150 {
        let n = 1 + seed as usize % 23;
        let values: Vec<f64> = generate(Distribution::Normal, n, dim, seed).unwrap();
        // Every third set is a grid, with copies, lines and cospherical items.
        let values: Vec<f64> = match seed % 3 {
            0 => values.iter().map(|v| (2.0 * v).round()).collect(),
            _ => values,
        };
        let extras: Vec<f64> = generate(Distribution::Uniform, n, 1, seed).unwrap();
        let extras: Vec<f64> = match seed % 3 {
            0 => extras.iter().map(|v| (2.0 * v.abs()).round() + 0.5).collect(),
            _ => extras.iter().map(|v| v.abs() + 0.01).collect(),
        };
        all_shapes::<P>(&values, &extras, dim, 1e-12, &format!("{dim} × {n}, seed {seed}"));
    }
}

#[test]
fn balls_prove_themselves() {
    sets::<Vec<f64>>(1);
    sets::<[f64; 2]>(2);
    sets::<[f64; 3]>(3);
    sets::<Vec<f64>>(2);
    sets::<Vec<f64>>(6);
}

/// Three points on a circle of radius 5 around (1, 2), and its center.
#[test]
fn a_circle() {
    let mut items = ItemSet::<[f64; 2]>::new(Shape::Points, 2);
    for row in [[1.0, 2.0], [6.0, 2.0], [-3.0, 5.0], [-2.0, -2.0]] {
        items.push(&row, 0.0);
    }
    let ball = Ball::of_all(&items, &[0, 1, 2, 3], &mut Workspace::new(2));
    assert!((ball.radius - 5.0).abs() <= 1e-14);
    assert!(distance(&ball.center, &[1.0, 2.0]) <= 1e-14);
    assert_eq!(ball.support.len(), 3);
    assert!((ball.shares.iter().sum::<f64>() - 1.0).abs() <= 1e-15);
}

/// Sets with large supports, with ties, or flat, in many dimensions.
#[test]
fn many_dimensions() {
    for dim in [5, 10, 30, 100] {
        let n = dim + 40;
        for (seed, name) in (0..).zip([
            "normal",
            "grid",
            "simplex",
            "sphere",
            "corners",
            "flat",
            "nearly flat",
            "in pairs",
        ]) {
            let normal: Vec<f64> = generate(Distribution::Normal, n, dim, seed).unwrap();
            let few: Vec<f64> = generate(Distribution::Normal, n, 4, seed).unwrap();
            let values: Vec<f64> = match name {
                "grid" => normal.iter().map(|v| v.round()).collect(),
                "simplex" => {
                    let corner = |i: usize| f64::from(u8::from(i / dim % (dim + 1) == i % dim));
                    (0..n * dim).map(corner).collect()
                }
                "sphere" => normal
                    .chunks_exact(dim)
                    .flat_map(|row| {
                        let length = row.iter().map(|v| v * v).sum::<f64>().sqrt();
                        row.iter().map(move |v| v / length)
                    })
                    .collect(),
                "corners" => normal.iter().map(|v| v.signum()).collect(),
                "flat" | "nearly flat" => {
                    let noise = if name == "flat" { 0.0 } else { 1e-9 };
                    // Four directions, the same for all.
                    (0..n * dim)
                        .map(|i| {
                            let row = &few[i / dim * 4..][..4];
                            let along = row.iter().zip(&normal[i % dim * 4..]);
                            along.map(|(a, b)| a * b).sum::<f64>() + noise * normal[i]
                        })
                        .collect()
                }
                "in pairs" => (0..n * dim)
                    .map(|i| normal[i % (n / 2 * dim)] + if i < n / 2 * dim { 0.0 } else { 1e-8 })
                    .collect(),
                _ => normal.clone(),
            };
            let extras: Vec<f64> = generate(Distribution::Uniform, n, 1, seed).unwrap();
            let extras: Vec<f64> = match name {
                "grid" | "corners" => vec![0.5; n],
                _ => extras.iter().map(|v| v.abs() + 0.1).collect(),
            };
            all_shapes::<Vec<f64>>(&values, &extras, dim, 1e-11, &format!("{name}, {dim}"));
        }
    }
}
