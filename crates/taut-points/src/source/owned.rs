//! Points that own their values: what a decoded file becomes.

use std::ops::Range;

use super::{PointSource, Scratch};
use crate::{Error, Points, ReadError, Rows, Scalar, ScalarKind};

/// n × d values in memory, row-major, for where a borrowed [`Points`] would not live long enough.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnedPoints<T> {
    values: Vec<T>,
    dim: usize,
}

impl<T: Scalar> OwnedPoints<T> {
    /// Takes `values` as points of dimension `dim`, as [`Points::new`] does.
    ///
    /// # Errors
    /// As [`Points::new`].
    pub fn new(values: Vec<T>, dim: usize) -> Result<Self, Error> {
        Points::new(&values, dim)?;
        Ok(OwnedPoints { values, dim })
    }

    /// The points as a view.
    pub fn view(&self) -> Points<'_, T> {
        Points::new(&self.values, self.dim).expect("checked when they were taken")
    }

    /// The n·d values, row after row.
    pub fn into_values(self) -> Vec<T> {
        self.values
    }
}

impl<T: Scalar> PointSource for OwnedPoints<T> {
    fn len(&self) -> u64 {
        self.view().len() as u64
    }

    fn dim(&self) -> usize {
        self.dim
    }

    fn scalar(&self) -> ScalarKind {
        T::KIND
    }

    fn read<'a>(&'a self, range: Range<u64>, _: &'a mut Scratch) -> Result<Rows<'a>, ReadError> {
        super::check_range(&range, PointSource::len(self))?;
        Ok(T::rows(self.view().slice(range.start as usize..range.end as usize)))
    }

    fn in_memory(&self) -> Option<Rows<'_>> {
        Some(T::rows(self.view()))
    }
}
