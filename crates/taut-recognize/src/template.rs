//! Templates: what is kept of an enrolled person, how a probe is compared with it, and the nearest of many templates.
//!
//! A [`Matcher`] maps features to a space in which scans of one person differ by a standard normal vector. A [`Template`] is the mean of
//! a few mapped scans with their number, and an [`Index`] finds the nearest one of millions.
//!
//! ```
//! use taut_recognize::template::{Index, Template};
//!
//! let template = |x: f64| Template::of_mapped(&[vec![x, 0.0], vec![x, 2.0]]);
//! let templates = [template(0.0)?, template(5.0)?];
//! let found = Index::new(&templates)?.nearest(&[4.0, 1.0], f64::INFINITY)?.expect("there are two");
//! // A squared distance of 1, times 2/(2 + 1) for two scans.
//! assert_eq!((found.place, found.distance), (1, 2.0 / 3.0));
//! # Ok::<(), taut_recognize::Error>(())
//! ```

mod index;
mod matcher;
mod screen;

pub use index::{Index, Nearest};
pub use matcher::{Matcher, MatcherOptions, Rates};

use crate::Error;
use taut_points::InputError;

/// Coordinates of a template, at most.
pub const DIM_MAX: usize = 512;

/// Scans of a template, at most.
pub const SCANS_MAX: u32 = 1000;

/// The mean of the mapped scans of a person, in single precision, and their number.
#[derive(Clone, Debug, PartialEq)]
pub struct Template {
    mean: Vec<f32>,
    scans: u32,
}

impl Template {
    /// Joins mapped scans.
    ///
    /// # Errors
    /// [`InputError::Option`] for no scan, more than [`SCANS_MAX`], or more than [`DIM_MAX`] coordinates; [`Error::Dimension`] where
    /// their dimensions differ, and [`Error::Overflow`] where the mean is not a finite number in single precision.
    pub fn of_mapped(scans: &[Vec<f64>]) -> Result<Self, Error> {
        let dim = scans.first().map_or(0, Vec::len);
        let mut sums = vec![0.0; dim];
        for scan in scans {
            if scan.len() != dim {
                return Err(Error::Dimension { found: scan.len(), expected: dim });
            }
            sums.iter_mut().zip(scan).for_each(|(sum, x)| *sum += x);
        }
        let count = scans.len() as f64;
        let mean = sums.into_iter().map(|sum| (sum / count) as f32).collect();
        Template::from_parts(mean, u32::try_from(scans.len()).unwrap_or(u32::MAX))
    }

    /// Takes a mean and the number of scans that it is of.
    ///
    /// # Errors
    /// Those of [`Template::of_mapped`].
    pub fn from_parts(mean: Vec<f32>, scans: u32) -> Result<Self, Error> {
        if !(1..=SCANS_MAX).contains(&scans) {
            return Err(Error::option("scans", scans.to_string(), "from 1 to 1000"));
        }
        if !(1..=DIM_MAX).contains(&mean.len()) {
            return Err(Error::option("features", mean.len().to_string(), "from 1 to 512"));
        }
        match mean.iter().all(|x| x.is_finite()) {
            true => Ok(Template { mean, scans }),
            false => Err(Error::Overflow),
        }
    }

    /// The mean of the mapped scans.
    pub fn mean(&self) -> &[f32] {
        &self.mean
    }

    /// The number of scans.
    pub fn scans(&self) -> u32 {
        self.scans
    }

    /// The distance of a mapped probe: |z − m|²·k/(k + 1) for a mean m of k scans.
    ///
    /// For a probe of the same person it has the mean of a χ² distribution with one degree of freedom for each coordinate, whatever k is,
    /// as far as scans are normal.
    ///
    /// # Errors
    /// [`Error::Dimension`] and [`InputError::NonFinite`].
    pub fn distance(&self, probe: &[f64]) -> Result<f64, Error> {
        check_probe(probe, self.mean.len())?;
        Ok(distance(&self.mean, weight(self.scans), probe))
    }
}

/// Templates are personal data: their numbers do not stay in memory that was given back.
#[cfg(feature = "store")]
impl Drop for Template {
    fn drop(&mut self) {
        zeroize::Zeroize::zeroize(&mut self.mean);
    }
}

/// k/(k + 1) for k scans: the inverse of the variance of a probe less the mean.
fn weight(scans: u32) -> f64 {
    f64::from(scans) / (f64::from(scans) + 1.0)
}

/// The distance as all of this module calculates it: in double precision, in the order of the coordinates.
fn distance(mean: &[f32], weight: f64, probe: &[f64]) -> f64 {
    let squares = mean.iter().zip(probe).map(|(&m, z)| {
        let difference = z - f64::from(m);
        difference * difference
    });
    weight * squares.sum::<f64>()
}

/// Refuses a probe of another dimension, or with values that are not finite.
fn check_probe(probe: &[f64], dim: usize) -> Result<(), Error> {
    if probe.len() != dim {
        return Err(Error::Dimension { found: probe.len(), expected: dim });
    }
    match probe.iter().position(|value| !value.is_finite()) {
        Some(column) => Err(InputError::NonFinite { row: 0, column, value: probe[column] }.into()),
        None => Ok(()),
    }
}
