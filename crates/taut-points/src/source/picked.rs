//! Some columns of other points.

use std::ops::Range;
use std::sync::Arc;

use super::{PointSource, Scratch};
use crate::{Points, ReadError, Rows, ScalarKind};

/// Points with some of the coordinates of others, in a given order.
#[derive(Clone)]
pub struct PickedColumns {
    source: Arc<dyn PointSource>,
    columns: Vec<usize>,
}

impl PickedColumns {
    /// The points of `source` with these of its coordinates, numbered from 0.
    ///
    /// # Panics
    /// If there are none, or one is not there.
    pub fn new(source: Arc<dyn PointSource>, columns: Vec<usize>) -> Self {
        let dim = source.dim();
        assert!(!columns.is_empty() && columns.iter().all(|&k| k < dim), "columns are there");
        Self { source, columns }
    }
}

impl PointSource for PickedColumns {
    fn len(&self) -> u64 {
        self.source.len()
    }

    fn dim(&self) -> usize {
        self.columns.len()
    }

    fn scalar(&self) -> ScalarKind {
        self.source.scalar()
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let (dim, wanted) = (self.columns.len(), range.end.saturating_sub(range.start));
        let mut whole = Scratch::new();
        match self.source.read(range, &mut whole)? {
            Rows::F32(rows) => {
                let values = scratch.values::<f32>(wanted, dim)?;
                pick(rows, &self.columns, values);
                Ok(Rows::F32(Points::new(values, dim)?))
            }
            Rows::F64(rows) => {
                let values = scratch.values::<f64>(wanted, dim)?;
                pick(rows, &self.columns, values);
                Ok(Rows::F64(Points::new(values, dim)?))
            }
        }
    }
}

fn pick<T: crate::Scalar>(rows: Points<'_, T>, columns: &[usize], values: &mut [T]) {
    for (to, row) in values.chunks_exact_mut(columns.len()).zip(rows.rows()) {
        to.iter_mut().zip(columns).for_each(|(to, &k)| *to = row[k]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OwnedPoints;

    #[test]
    fn columns_come_in_the_order_that_was_asked_for() {
        let source = OwnedPoints::new((0..12).map(f64::from).collect(), 3).unwrap();
        let picked = PickedColumns::new(Arc::new(source), vec![2, 0]);
        assert_eq!((picked.len(), picked.dim(), picked.scalar()), (4, 2, ScalarKind::F64));
        let mut scratch = Scratch::new();
        let Rows::F64(rows) = picked.read(1..3, &mut scratch).unwrap() else { panic!() };
        assert_eq!(rows.values(), [5.0, 3.0, 8.0, 6.0]);
        assert!(matches!(picked.read(3..5, &mut scratch), Err(ReadError::OutOfRange { .. })));
    }
}
