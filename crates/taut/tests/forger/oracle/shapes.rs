//! Rows that are ellipsoids {m + v : vvᵀ ⪯ S}: how far each reaches from a center, from below.
//!
//! *Idea.* v = Sa/√(aᵀSa) belongs to the item for every direction a. The one that is farthest from the center is found by
//! taking for a the offset of the point before: an ascent, as a convex function is maximized along its linear parts.
//! *Guarantee.* A point found outside proves that an item reaches outside. That none is found proves nothing; the largest
//! lower bound and the smallest ball that were verified for one input must agree in any case.

use std::cmp::Ordering;

use super::dyadic::{Dyadic, exact, sum};

/// Digits of quotients and roots.
const BITS: u64 = 160;

/// Steps of an ascent.
const STEPS: usize = 24;

/// An item.
pub struct Shape {
    center: Vec<Dyadic>,
    /// S, all d × d entries.
    matrix: Vec<Vec<Dyadic>>,
}

impl Shape {
    /// Reads a row; none if S is not positive definite, so that rounding has a say in what the item is.
    pub fn of(row: &[f64], dim: usize) -> Option<Self> {
        let (center, lower) = row.split_at(dim);
        let entry =
            |j: usize, k: usize| Dyadic::of(lower[j.max(k) * (j.max(k) + 1) / 2 + j.min(k)]);
        let matrix: Vec<Vec<Dyadic>> =
            (0..dim).map(|j| (0..dim).map(|k| entry(j, k)).collect()).collect();
        let minors = (1..=dim).all(|n| determinant(&matrix, n).sign() == Ordering::Greater);
        minors.then(|| Shape { center: exact(center), matrix })
    }

    /// Whether a point of the item is found that lies farther than `radius` from `from`.
    pub fn reaches_beyond(&self, from: &[Dyadic], radius: &Dyadic) -> bool {
        let dim = from.len();
        let offset: Vec<Dyadic> = self.center.iter().zip(from).map(|(m, c)| m - c).collect();
        // Roots and quotients are off by less than 2⁻¹⁵⁰ of the radius.
        let bound = radius + &radius.scaled(-140);
        let mut starts = vec![offset.clone()];
        for j in 0..dim {
            for sign in [1, -1] {
                starts.push(
                    (0..dim).map(|k| Dyadic::integer(if j == k { sign } else { 0 })).collect(),
                );
            }
        }
        starts.into_iter().any(|mut direction| {
            (0..STEPS).any(|_| {
                let Some(arm) = self.farthest(&direction) else { return false };
                direction = offset
                    .iter()
                    .zip(&arm)
                    .map(|(offset, arm)| (offset + arm).floored(BITS))
                    .collect();
                sum(direction.iter().map(Dyadic::square)) > bound.square()
            })
        })
    }

    /// Sa/√(aᵀSa), a little shorter.
    fn farthest(&self, a: &[Dyadic]) -> Option<Vec<Dyadic>> {
        let product: Vec<Dyadic> =
            self.matrix.iter().map(|row| sum(row.iter().zip(a).map(|(s, a)| s * a))).collect();
        let length = sum(product.iter().zip(a).map(|(p, a)| p * a)).root_up(BITS);
        if length.is_zero() {
            return None;
        }
        Some(product.iter().map(|p| p.quotient(&length, BITS)).collect())
    }
}

/// The leading minor of order n.
fn determinant(matrix: &[Vec<Dyadic>], n: usize) -> Dyadic {
    fn minor(matrix: &[Vec<Dyadic>], row: usize, columns: &[usize]) -> Dyadic {
        if columns.is_empty() {
            return Dyadic::integer(1);
        }
        let terms = columns.iter().enumerate().map(|(place, &column)| {
            let rest: Vec<usize> = columns.iter().copied().filter(|&c| c != column).collect();
            let term = &matrix[row][column] * &minor(matrix, row + 1, &rest);
            if place % 2 == 0 { term } else { -&term }
        });
        sum(terms)
    }
    minor(matrix, 0, &(0..n).collect::<Vec<_>>())
}

#[test]
fn an_ellipse_reaches_as_far_as_its_longer_axis() {
    let shape = Shape::of(&[1.0, 0.0, 4.0, 0.0, 1.0], 2).unwrap();
    let origin = exact(&[0.0, 0.0]);
    assert!(shape.reaches_beyond(&origin, &Dyadic::of(3.0f64.next_down())));
    assert!(!shape.reaches_beyond(&origin, &Dyadic::of(3.0)));
    assert!(Shape::of(&[0.0, 0.0, 1.0, 1.0, 1.0], 2).is_none());
}
