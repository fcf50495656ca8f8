//! The exact fit: h rows in a hyperplane, or in a subspace of any dimension below d.
//!
//! *Idea.* The determinant is 0 for all h rows of the subspace alike, so the estimate goes on within it: rows of the
//! subspace, in coordinates of an orthonormal basis, are a point set of their own. Rows off it are outliers whatever
//! their distance.
//! *Reference.* Rousseeuw, Van Driessen, Technometrics 41, 1999, section 3.3, who report the hyperplane and stop there.

use taut_certify::Hull;
use taut_kernels::vector::{add_scaled, dot};
use taut_points::Points;

use crate::ellipsoid::point_reader::PointReader;
use crate::{EllipsoidOptions, Error, ellipsoid};

/// Another row may be this many times farther off than the rows kept and still count as on the subspace.
const DISTANCE_RATIO_MAX: f64 = 2.0;
/// Rows count as on a subspace up to this part of how far they reach, and up to what rounding of their coordinates
/// explains, in units of √d·2⁻⁵². It is what the checker goes by.
const THICKNESS_RATIO_MAX: f64 = 1e-10;
const ROUNDINGS: f64 = 64.0;

/// A coordinate in a subspace of dimension d is 0 up to this part of the sum of sizes it was made of, in units of
/// (d + 4)·2⁻⁵².
const ZERO_ROUNDINGS: f64 = 4.0;

/// An affine subspace {o + B′z}.
#[derive(Clone, Debug)]
pub(super) struct Flat {
    pub(super) origin: Vec<f64>,
    /// B, r orthonormal rows.
    pub(super) basis: Vec<f64>,
    /// Rows on it are no farther off than this.
    pub(super) distance: f64,
}

/// A subspace and the rows on it.
pub(super) struct Part {
    pub(super) flat: Flat,
    pub(super) ids: Vec<u64>,
    /// Their coordinates in it.
    pub(super) values: Vec<f64>,
}

/// The subspace that holds the rows kept, if they lie in one.
pub(super) fn hull(data: &mut PointReader<'_>, kept: &[bool]) -> Result<Option<Flat>, Error> {
    let ids: Vec<u64> = (0..).zip(kept).filter(|(_, kept)| **kept).map(|(id, _)| id).collect();
    let rows = data.rows(&ids)?;
    let points = Points::new(&rows, data.dim()).expect("rows of the dimension");
    let found = ellipsoid(&points, &EllipsoidOptions { epsilon: 0.5, ..Default::default() })?;
    let answer = found.answer;
    Ok(answer.hull.map(|hull| Flat::of_hull(answer.center, &hull)))
}

impl Flat {
    pub(super) fn of_hull(origin: Vec<f64>, hull: &Hull) -> Self {
        Flat { origin, basis: hull.basis.concat(), distance: DISTANCE_RATIO_MAX * hull.distance }
    }

    pub(super) fn dim(&self) -> usize {
        self.origin.len()
    }

    pub(super) fn rank(&self) -> usize {
        self.basis.len() / self.dim()
    }

    /// B(x − o), and how far x is off.
    pub(super) fn project(&self, row: &[f64]) -> (Vec<f64>, f64) {
        let mut rest: Vec<f64> = row.iter().zip(&self.origin).map(|(x, o)| x - o).collect();
        let largest = rest.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if largest == 0.0 {
            return (vec![0.0; self.rank()], 0.0);
        }
        // Units that no square overflows in.
        rest.iter_mut().for_each(|v| *v /= largest);
        let offset = rest.clone();
        let mut image = vec![];
        for direction in self.basis.chunks_exact(self.dim()) {
            let product = dot(&rest, direction);
            add_scaled(&mut rest, -product, direction);
            // A column that only rounding keeps from 0: left as it is, a column of such numbers would count as one of its own.
            let size: f64 = offset.iter().zip(direction).map(|(x, b)| (x * b).abs()).sum();
            let is_zero =
                product.abs() <= ZERO_ROUNDINGS * (self.dim() + 4) as f64 * f64::EPSILON * size;
            image.push(if is_zero { 0.0 } else { product * largest });
        }
        (image, largest * dot(&rest, &rest).sqrt())
    }

    /// Widened where rounding has put some of the h rows it was made from outside.
    ///
    /// Fails where these are farther off than rows of a subspace may be.
    pub(super) fn holding(mut self, data: &mut PointReader<'_>, h: usize) -> Result<Part, Error> {
        let (ids, values) = self.rows_on(data)?;
        if ids.len() >= h {
            return Ok(Part { flat: self, ids, values });
        }
        let dim = self.dim();
        let length = |x: &[f64]| {
            let largest = x.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            let part = |v: &f64| if largest > 0.0 { (v / largest).powi(2) } else { 0.0 };
            largest * x.iter().map(part).sum::<f64>().sqrt()
        };
        let blocks = data.visit(|_, rows| {
            let place = |row: &[f64]| {
                let (image, off) = self.project(row);
                (off, length(&image), length(row))
            };
            rows.chunks_exact(dim).map(place).collect::<Vec<_>>()
        })?;
        let mut places = blocks.concat();
        places.select_nth_unstable_by(h - 1, |a, b| a.0.total_cmp(&b.0));
        let (off, ..) = places[h - 1];
        let most = |size: &dyn Fn(&(f64, f64, f64)) -> f64| {
            places[..h].iter().map(size).fold(0.0, f64::max)
        };
        let rounding = ROUNDINGS * (dim as f64).sqrt() * f64::EPSILON;
        let is_thin =
            off <= THICKNESS_RATIO_MAX * most(&|place| place.1) + rounding * most(&|place| place.2);
        if !is_thin {
            return Err(Error::Overflow);
        }
        self.distance = DISTANCE_RATIO_MAX * off;
        let (ids, values) = self.rows_on(data)?;
        Ok(Part { flat: self, ids, values })
    }

    /// The rows on the subspace: their numbers, and their coordinates in it.
    pub(super) fn rows_on(
        &self,
        data: &mut PointReader<'_>,
    ) -> Result<(Vec<u64>, Vec<f64>), Error> {
        let dim = self.dim();
        let blocks = data.visit(|first, rows| {
            let (mut ids, mut values) = (vec![], vec![]);
            for (id, row) in (first..).zip(rows.chunks_exact(dim)) {
                let (image, off) = self.project(row);
                if off <= self.distance {
                    ids.push(id);
                    values.extend(image);
                }
            }
            (ids, values)
        })?;
        let (ids, values): (Vec<_>, Vec<_>) = blocks.into_iter().unzip();
        Ok((ids.concat(), values.concat()))
    }

    /// o + B′z.
    pub(super) fn lifted(&self, image: &[f64]) -> Vec<f64> {
        let mut point = self.origin.clone();
        for (direction, z) in self.basis.chunks_exact(self.dim()).zip(image) {
            add_scaled(&mut point, *z, direction);
        }
        point
    }

    /// AB for A with r columns: its rows in the space of the points.
    pub(super) fn rotated_rows(&self, matrix: &[f64]) -> Vec<f64> {
        let mut lifted = vec![];
        for row in matrix.chunks_exact(self.rank().max(1)) {
            let mut sum = vec![0.0; self.dim()];
            for (direction, a) in self.basis.chunks_exact(self.dim()).zip(row) {
                add_scaled(&mut sum, *a, direction);
            }
            lifted.extend(sum);
        }
        lifted
    }

    /// B′A for A with r rows and columns, d × r.
    pub(super) fn rotated_columns(&self, matrix: &[f64]) -> Vec<f64> {
        let (dim, rank) = (self.dim(), self.rank());
        let mut lifted = vec![0.0; dim * rank];
        for (direction, row) in self.basis.chunks_exact(dim).zip(matrix.chunks_exact(rank.max(1))) {
            for (j, b) in direction.iter().enumerate() {
                add_scaled(&mut lifted[j * rank..(j + 1) * rank], *b, row);
            }
        }
        lifted
    }

    /// The subspace of a subspace: `inner` is given in coordinates of this one.
    pub(super) fn within(&self, inner: &Flat) -> Flat {
        Flat {
            origin: self.lifted(&inner.origin),
            basis: self.rotated_rows(&inner.basis),
            distance: self.distance + inner.distance,
        }
    }
}

#[cfg(test)]
mod tests {
    use taut_points::Monitor;

    use super::*;

    /// Rows (i, i·slope), and how many of them the first axis holds as a line of no thickness.
    fn on_the_axis(slope: f64) -> Result<usize, Error> {
        let values: Vec<f64> = (0..9).flat_map(|i| [f64::from(i), f64::from(i) * slope]).collect();
        let points = Points::new(&values, 2).expect("pairs");
        let silent = Monitor::silent();
        let mut data = PointReader::new(&points, &silent)?;
        let axis = Flat { origin: vec![0.0; 2], basis: vec![1.0, 0.0], distance: 0.0 };
        axis.holding(&mut data, 6).map(|part| part.ids.len())
    }

    #[test]
    fn a_subspace_is_widened_by_rounding_and_no_more() {
        assert_eq!(on_the_axis(0.0).unwrap(), 9);
        // The sixth row is 5 slopes off, and rows twice as far count as on it, too.
        assert_eq!(on_the_axis(1e-16).unwrap(), 9);
        assert_eq!(on_the_axis(1e-11).unwrap(), 9);
        assert!(matches!(on_the_axis(1e-9), Err(Error::Overflow)));
        assert!(matches!(on_the_axis(1e-3), Err(Error::Overflow)));
    }
}
