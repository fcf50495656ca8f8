//! The objects that the rows of a source stand for.

use serde::{Deserialize, Serialize};
use taut_points::choice;

/// The objects that the rows of a source stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Items {
    /// Each row is a point.
    #[default]
    Points,
    /// Each row is a ball: its center, then its radius ≥ 0 in the last column.
    Balls,
    /// Each row is an ellipsoid: the d coordinates of its center m, then the d(d + 1)/2 numbers of the lower triangle
    /// of its symmetric shape matrix S, row by row: S₁₁, S₂₁, S₂₂, S₃₁, …
    ///
    /// It is the set {m + v : vvᵀ ⪯ S}, which is {m + S^½ w : |w| ≤ 1}. S has the units of a covariance: the ball of
    /// radius r has S = r²I, and a point has S = 0. S must be positive semidefinite.
    ///
    /// Rounding the entries of a singular S leaves some of its eigenvalues negative. With D the diagonal of S, the row stands
    /// for S itself where S − eD is positive definite, e = 64(d + 4)²·2⁻¹⁰⁰ for the d columns with a width; else for S + 2τD,
    /// with τ the least of 2⁻⁵⁶, 2⁻⁵⁵, … for which S + (τ − e)D is, for enclosure and lower bound alike. A τ beyond what
    /// rounding explains is refused.
    Ellipsoids,
}

choice! { "inputs", Items {
    Points = "points", "each row is a point";
    Balls = "balls", "each row is a center, then a radius";
    Ellipsoids = "ellipsoids", "each row is a center, then the lower triangle of a shape matrix";
}}

impl Items {
    /// The dimension of the space in which rows of `columns` numbers lie; for ellipsoids, 0 when no dimension has rows
    /// of that many numbers.
    pub fn dim(self, columns: usize) -> usize {
        match self {
            Items::Points => columns,
            Items::Balls => columns.saturating_sub(1),
            Items::Ellipsoids => (1..=columns)
                .take_while(|d| d * (d + 3) / 2 <= columns)
                .last()
                .map_or(0, |d| if d * (d + 3) / 2 == columns { d } else { 0 }),
        }
    }

    /// Returns how many numbers a row has in a space of dimension `dim`.
    pub fn columns(self, dim: usize) -> usize {
        match self {
            Items::Points => dim,
            Items::Balls => dim + 1,
            Items::Ellipsoids => dim * (dim + 3) / 2,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_and_dimensions_belong_together() {
        for items in [Items::Points, Items::Balls, Items::Ellipsoids] {
            for dim in 1..60 {
                assert_eq!(items.dim(items.columns(dim)), dim, "{items:?}");
            }
        }
        let widths: Vec<usize> = (0..15).filter(|&w| Items::Ellipsoids.dim(w) > 0).collect();
        assert_eq!(widths, [2, 5, 9, 14]);
    }
}
