//! One pass over the items: how far each reaches under an ellipsoid, and where.

use taut_kernels::vector::{add_scaled, dot};
use taut_points::OrderBy;
use taut_points::parallel::IntoParallel;

use super::support_points::SupportPoint;
use crate::shapes::eigen::eigen;
use crate::shapes::frame::Framed;
use crate::shapes::reach::{alternatives, farthest};

/// A point of an item is named beside its farthest if it lies outside by this part of what that does.
const NEAR_POINT_RATIO: f64 = 0.1;

pub(super) struct PassResult {
    /// The largest |y|² of any item, and that of each item or a bound on it.
    pub(super) largest: f64,
    pub(super) squares: Vec<f64>,
    /// Points outside, the farthest first.
    pub(super) outside: Vec<(f64, SupportPoint)>,
}

/// Asks every item for its farthest point from the center in the metric of M.
pub(super) fn pass(
    framed: &Framed,
    widths: &[f64],
    matrix: &[f64],
    center: &[f64],
    seeds: &[Vec<&[f64]>],
) -> PassResult {
    let rank = framed.rank;
    let stretch = stretch(matrix, rank);
    let border = rank as f64;
    let each: Vec<(f64, Vec<(f64, SupportPoint)>)> = (0..framed.len())
        .into_par_iter()
        .with_min_len(32)
        .map(|i| item(framed, i, matrix, center, stretch * widths[i], border, &seeds[i]))
        .collect();
    let mut found = PassResult { largest: border, squares: vec![], outside: vec![] };
    for (square, support_points) in each {
        found.largest = if square.is_nan() { f64::INFINITY } else { found.largest.max(square) };
        found.squares.push(square);
        found.outside.extend(support_points);
    }
    found.outside.order_by(&|a, b| b.0.total_cmp(&a.0));
    found
}

/// The largest |Mv| over |v| ≤ 1, rounded up.
fn stretch(matrix: &[f64], rank: usize) -> f64 {
    let mut product = vec![0.0; rank * rank];
    for a in 0..rank {
        for b in 0..rank {
            product[a * rank + b] =
                dot(&matrix[a * rank..(a + 1) * rank], &matrix[b * rank..(b + 1) * rank]);
        }
    }
    let (lambda, _) = eigen(&mut product, rank);
    lambda.into_iter().fold(0.0, f64::max).sqrt() * (1.0 + 1e-12)
}

/// |y|² of the farthest point of one item, or a bound below the border; and its points outside.
fn item(
    framed: &Framed,
    i: usize,
    matrix: &[f64],
    center: &[f64],
    width: f64,
    border: f64,
    seeds: &[&[f64]],
) -> (f64, Vec<(f64, SupportPoint)>) {
    let rank = framed.rank;
    let offset: Vec<f64> = framed.center(i).iter().zip(center).map(|(m, c)| m - c).collect();
    let image: Vec<f64> =
        (0..rank).map(|a| dot(&matrix[a * rank..a * rank + a + 1], &offset[..=a])).collect();
    let simply = (dot(&image, &image).sqrt() + width).powi(2);
    if simply < border * (1.0 - 1e-3) {
        return (simply, vec![]);
    }
    let mut shape = vec![0.0; rank * rank];
    let mut product = vec![0.0; rank];
    for a in 0..rank {
        product.fill(0.0);
        for (b, row) in framed.shape(i).chunks_exact(rank).enumerate().take(a + 1) {
            add_scaled(&mut product, matrix[a * rank + b], row);
        }
        for b in 0..=a {
            let value = dot(&matrix[b * rank..b * rank + b + 1], &product[..=b]);
            shape[a * rank + b] = value;
            shape[b * rank + a] = value;
        }
    }
    let (lambda, vectors) = eigen(&mut shape, rank);
    let h: Vec<f64> = vectors.chunks_exact(rank).map(|v| dot(v, &image)).collect();
    let best = farthest(&lambda, &h);
    let mut support_points = vec![];
    let beyond = border * (1.0 + 1e-14);
    if best.square > beyond {
        let worth = border + NEAR_POINT_RATIO * (best.square - border);
        let seeds: Vec<Vec<f64>> =
            seeds.iter().map(|a| seed(framed.shape(i), matrix, &lambda, &vectors, a)).collect();
        alternatives(&lambda, &h, &best, &seeds, |square, beta| {
            if square >= worth {
                support_points.push((
                    square,
                    SupportPoint { item: i, direction: direction(matrix, &vectors, beta) },
                ));
            }
        });
    }
    (best.square, support_points)
}

/// A point that touched in the direction a, by z along the axes of its item, up to length: Λ^−½V′MSa.
fn seed(shape: &[f64], matrix: &[f64], lambda: &[f64], vectors: &[f64], a: &[f64]) -> Vec<f64> {
    let rank = a.len();
    let v: Vec<f64> = shape.chunks_exact(rank).map(|row| dot(row, a)).collect();
    let image: Vec<f64> = matrix.chunks_exact(rank).map(|row| dot(row, &v)).collect();
    let z = |(axis, &l): (&[f64], &f64)| if l > 0.0 { dot(axis, &image) / l.sqrt() } else { 0.0 };
    vectors.chunks_exact(rank).zip(lambda).map(z).collect()
}

/// M′Vβ, of length 1.
fn direction(matrix: &[f64], vectors: &[f64], beta: &[f64]) -> Vec<f64> {
    let rank = beta.len();
    let mut b = vec![0.0; rank];
    for (&beta, v) in beta.iter().zip(vectors.chunks_exact(rank)) {
        add_scaled(&mut b, beta, v);
    }
    let mut direction = vec![0.0; rank];
    for (&b, row) in b.iter().zip(matrix.chunks_exact(rank)) {
        add_scaled(&mut direction, b, row);
    }
    let norm = dot(&direction, &direction).sqrt();
    if norm > 0.0 {
        direction.iter_mut().for_each(|v| *v /= norm);
    }
    direction
}
