//! How far rows can be, from passes before: those that cannot have become far are not read again.
//!
//! *Idea.* A pass from c has measured |x − c|. From another center c′, |x − c′| ≤ |x − c| + |c′ − c|, and where that is below what a
//! question asks for, the row is not read; the sum is what is known of it then. Centers of later passes are near to one another.
//! The same idea in the space of a kernel: `kernel_ball::distance_bounds`.
//! *Guarantee.* Bounds hold with the rounding of the kernel and of their own sums.
//! *Evidence.* Of normal points, 10⁴ × 300 to 1500, 89 to 100 % of the rows have to be read by the second pass, and 5 to 22 % by the third.
//! *Tried without gain* for the second pass, on 10⁴ × 300 to 1000: a copy of the rows in one byte per coordinate with a bound on its
//! error (most rows are told by it, but to make it takes as long as the reading that it saves); rows read in four parts, as far as a bound
//! on the rest asks for (a half to three quarters of the coordinates are read, but memory delivers pieces no faster); a first pass
//! whose later rows are measured from the ball of the first ones (the rows of both have to be read again); the
//! blocks from the last to the first, as the end of the pass before may still be in cache; and for 10⁵ × 1500 of `f32`, a
//! bound in single precision, after which few rows have to be measured (the pass takes as long, as memory delivers no faster).

use taut_kernels::{Center, relative_error};

/// Upper bounds on the distances of all rows from a center.
pub(super) struct RowBounds {
    center: Center,
    distances: Vec<f64>,
}

impl RowBounds {
    /// Of the distances that a pass from this center has found.
    pub(super) fn new(center: &Center, distances: Vec<f64>) -> Self {
        RowBounds { center: center.clone(), distances }
    }

    /// The bounds from another center, for a pass that asks for rows with a squared distance above some number.
    pub(super) fn from(&self, center: &Center, above: f64) -> KnownRows<'_> {
        let [low, other_low] = [&self.center.low, &center.low];
        let coordinates = self.center.high.iter().zip(&center.high).enumerate();
        let square: f64 = coordinates
            .map(|(j, (a, b))| {
                let low = [low, other_low].map(|low| low.get(j).copied().unwrap_or(0.0));
                let difference = (a - b).abs() + (low[0] - low[1]).abs();
                difference * difference
            })
            .sum();
        let error = kernel_error(center.dim());
        // These squares are added one after the other, where the kernel has several sums.
        let moved = square.sqrt() * (1.0 + error + center.dim() as f64 * f64::EPSILON);
        let limit = (above * (1.0 - error)).max(0.0).sqrt() * (1.0 - error) - moved;
        KnownRows { distances: &self.distances, moved, limit }
    }
}

/// What is known of rows before a pass.
#[derive(Clone, Copy)]
pub(super) struct KnownRows<'b> {
    /// Bounds from another center.
    distances: &'b [f64],
    /// How far that is from the one of the pass, at most.
    moved: f64,
    /// A row whose bound is below this need not be read.
    limit: f64,
}

impl KnownRows<'_> {
    /// Tests whether a row cannot be above what the pass asks for.
    pub(super) fn is_near(&self, row: usize) -> bool {
        self.distances[row] < self.limit
    }

    /// The bound from the center of the pass.
    pub(super) fn distance(&self, row: usize) -> f64 {
        (self.distances[row] + self.moved) * (1.0 + 2.0 * f64::EPSILON)
    }
}

/// No row is farther than this, if the pass found this squared distance.
pub(super) fn distance_at_most(reach2: f64, dim: usize) -> f64 {
    reach2.sqrt() * (1.0 + kernel_error(dim))
}

/// The rounding of a squared distance, and of the few operations here.
fn kernel_error(dim: usize) -> f64 {
    relative_error(dim) + 8.0 * f64::EPSILON
}

#[cfg(test)]
mod tests {
    use taut_certify::Items;
    use taut_kernels::squared_distances;
    use taut_points::{Distribution, Monitor, PointSource, Points, Scalar, generate};

    use super::*;
    use crate::item_reader::{ItemReader, Query};

    /// Centers on a walk, some of them in two terms.
    fn centers(dim: usize, length: f64) -> Vec<Center> {
        let steps: Vec<f64> = generate(Distribution::Normal, 12, dim, 77).unwrap();
        let mut high = vec![0.0; dim];
        let center = |(number, step): (usize, &[f64])| {
            let scale = length / 2f64.powi(number as i32) / (dim as f64).sqrt();
            high.iter_mut().zip(step).for_each(|(h, s)| *h += scale * s);
            let low: Vec<f64> = high.iter().map(|h| h * 1e-17).collect();
            Center { high: high.clone(), low: if number % 3 == 1 { low } else { vec![] } }
        };
        steps.chunks_exact(dim).enumerate().map(center).collect()
    }

    /// What a reader finds from these centers is what one that reads all rows finds; returns how many rows were not read.
    fn check(source: &dyn PointSource, part_above: f64) -> usize {
        let monitor = Monitor::silent();
        let reader = || ItemReader::new(source, Items::Points, &monitor).unwrap();
        let (mut reader, mut other) = (reader(), reader());
        let first = reader.first(100).unwrap().1;
        other.first(100).unwrap();
        let mut not_read = 0;
        for center in centers(source.dim(), 1.0) {
            let above = first.farthest.reach2 * part_above;
            let query = Query { center: &center, above, keep: 100, by_face_above: Some(above) };
            other.row_bounds = None;
            if let Some(bounds) = &reader.row_bounds {
                let known = bounds.from(&center, above);
                not_read += (0..source.len() as usize).filter(|&row| known.is_near(row)).count();
            }
            let (found, expected) =
                (reader.farthest(query).unwrap(), other.farthest(query).unwrap());
            assert_eq!((found.farthest, &found.far), (expected.farthest, &expected.far));
            assert_eq!(found.listed_above, expected.listed_above);
            assert_eq!(found.by_face, expected.by_face);
        }
        not_read
    }

    fn of<T: Scalar>(part_above: f64) -> usize {
        let values: Vec<T> = generate(Distribution::Normal, 3000, 40, 5).unwrap();
        check(&Points::new(&values, 40).unwrap(), part_above)
    }

    #[test]
    fn rows_that_are_not_read_would_not_be_found() {
        for part_above in [0.5, 0.8, 0.95] {
            assert!(of::<f64>(part_above) > 3000 && of::<f32>(part_above) > 3000, "{part_above}");
        }
        // Nothing is above this: the farthest row is found all the same.
        assert!(of::<f64>(2.0) > 30_000);
    }

    #[test]
    fn bounds_hold_after_any_number_of_passes() {
        let (n, dim) = (500, 35);
        let values: Vec<f64> = generate(Distribution::Normal, n, dim, 6).unwrap();
        let distances = |center: &Center| {
            let mut squares = vec![0.0; n];
            squared_distances(&values, dim, center, &mut squares);
            squares.into_iter().map(f64::sqrt).collect::<Vec<f64>>()
        };
        let first = Center { high: vec![0.0; dim], low: vec![] };
        let at_most = |d: &f64| distance_at_most(d * d, dim);
        let mut bounds = RowBounds::new(&first, distances(&first).iter().map(at_most).collect());
        for center in centers(dim, 1.0) {
            let known = bounds.from(&center, f64::INFINITY);
            let all: Vec<f64> = (0..n).map(|row| known.distance(row)).collect();
            assert!(all.iter().zip(distances(&center)).all(|(bound, d)| *bound >= d));
            bounds = RowBounds::new(&center, all);
        }
    }

    /// Each of the small squares is lost when it is added to the first.
    #[test]
    fn a_move_along_many_coordinates_is_bounded() {
        let dim = 1500;
        let small = 2f64.powf(-26.51);
        let start = Center { high: vec![0.0; dim], low: vec![] };
        let mut end = Center { high: vec![small; dim], low: vec![] };
        end.high[0] = 1.0;
        // √(1 + e) < 1 + e/2.
        let excess = (dim - 1) as f64 * small * small;
        let bounds = RowBounds::new(&start, vec![]);
        assert!(bounds.from(&end, f64::INFINITY).moved - 1.0 >= excess / 2.0);
    }
}
