//! Scaling and whitening, learned from training rows.

use serde::{Deserialize, Serialize};

use super::covariance::{Residuals, lower};
use super::data::Rows;
use super::dense::solve_lower;
use super::method::Scaling;
use crate::Error;

/// A map of points: y = (x − shift)·factor for each coordinate, then L·z = y where classes are whitened.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Preparation {
    shift: Vec<f64>,
    factor: Vec<f64>,
    /// The lower factor of the covariance within classes, row after row with zeros above the diagonal.
    lower: Option<Vec<f64>>,
}

impl Preparation {
    /// Learns the map. A coordinate that is constant in the training is left out by a factor of 0, except without scaling.
    pub(super) fn learn(rows: &Rows, scaling: Scaling, whitening: bool) -> Result<Self, Error> {
        let (n, dim) = (rows.len() as f64, rows.dim);
        let (mut shift, mut factor) = (vec![0.0; dim], vec![1.0; dim]);
        for j in 0..dim {
            let column = || rows.values.iter().skip(j).step_by(dim).copied();
            let low = column().fold(f64::INFINITY, f64::min);
            let high = column().fold(f64::NEG_INFINITY, f64::max);
            let spread = match scaling {
                Scaling::None => continue,
                Scaling::ZScore => {
                    let mean = column().map(|x| x / n).sum::<f64>();
                    shift[j] = mean;
                    (column().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n).sqrt()
                }
                Scaling::Percent => {
                    shift[j] = low;
                    (high - low) / 100.0
                }
            };
            factor[j] = if high == low { 0.0 } else { 1.0 / spread };
            if !(factor[j].is_finite() && spread.is_finite()) {
                return Err(Error::Overflow);
            }
        }
        let mut map = Preparation { shift, factor, lower: None };
        if whitening {
            let scaled = map.rows(rows)?;
            let residuals = Residuals::of(&scaled);
            residuals.check(rows, "whitening needs a class of two points or more")?;
            map.lower = Some(lower(&residuals.shrunk(), dim)?);
        }
        Ok(map)
    }

    pub(super) fn dim(&self) -> usize {
        self.shift.len()
    }

    /// Maps a point.
    pub(super) fn point(&self, x: &[f64]) -> Vec<f64> {
        let scale = |((x, shift), factor): ((&f64, &f64), &f64)| (x - shift) * factor;
        let mut y: Vec<f64> = x.iter().zip(&self.shift).zip(&self.factor).map(scale).collect();
        if let Some(lower) = &self.lower {
            solve_lower(lower, y.len(), &mut y);
        }
        y
    }

    /// Maps rows.
    pub(super) fn rows(&self, rows: &Rows) -> Result<Rows, Error> {
        let values: Vec<f64> = rows.iter().flat_map(|(row, _)| self.point(row)).collect();
        match values.iter().all(|value| value.is_finite()) {
            true => Ok(Rows { values, ..rows.clone() }),
            false => Err(Error::Overflow),
        }
    }

    /// Tests whether a map that was read is one of `dim` coordinates.
    pub(super) fn is_sound(&self, dim: usize) -> bool {
        let is_factor = |lower: &Vec<f64>| {
            lower.len() == dim * dim && (0..dim).all(|i| lower[i * dim + i] > 0.0)
        };
        dim > 0
            && self.shift.len() == dim
            && self.factor.len() == dim
            && self.lower.as_ref().is_none_or(is_factor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Rows {
        let values = vec![0.0, 7.0, 1.0, 2.0, 7.0, 5.0, 4.0, 7.0, 3.0, 10.0, 7.0, 3.5];
        Rows { values, dim: 3, labels: vec![0, 0, 1, 1], classes: 2 }
    }

    #[test]
    fn scalings_reach_their_ranges_and_leave_out_constants() {
        let rows = rows();
        let z = Preparation::learn(&rows, Scaling::ZScore, false).unwrap().rows(&rows).unwrap();
        let first: Vec<f64> = z.values.iter().step_by(3).copied().collect();
        assert!(first.iter().sum::<f64>().abs() < 1e-15);
        assert!((first.iter().map(|x| x * x).sum::<f64>() - 4.0).abs() < 1e-14);
        assert!(z.values.iter().skip(1).step_by(3).all(|&x| x == 0.0));
        let percent = Preparation::learn(&rows, Scaling::Percent, false).unwrap();
        assert_eq!(percent.point(&[10.0, 9.0, 1.0]), [100.0, 0.0, 0.0]);
        // New values are not clipped.
        assert_eq!(percent.point(&[20.0, 7.0, 9.0]), [200.0, 0.0, 200.0]);
        let none = Preparation::learn(&rows, Scaling::None, false).unwrap();
        assert_eq!(none.rows(&rows).unwrap().values, rows.values);
    }

    #[test]
    fn whitening_makes_the_shrunk_covariance_the_identity() {
        let rows =
            Rows { dim: 2, values: rows().values, labels: vec![0, 0, 0, 1, 1, 1], classes: 2 };
        let map = Preparation::learn(&rows, Scaling::None, true).unwrap();
        let covariance = Residuals::of(&rows).shrunk();
        let l = map.lower.clone().unwrap();
        for i in 0..2 {
            for j in 0..2 {
                let product: f64 = (0..2).map(|k| l[i * 2 + k] * l[j * 2 + k]).sum();
                assert!((product - covariance[i * 2 + j]).abs() < 1e-12 * covariance[0]);
            }
        }
        assert!(map.is_sound(2) && !map.is_sound(3));
        let single = Rows { values: vec![0.0, 1.0], dim: 1, labels: vec![0, 1], classes: 2 };
        let refused = Preparation::learn(&single, Scaling::None, true).unwrap_err();
        assert!(refused.to_string().contains("two points"), "{refused}");
    }
}
