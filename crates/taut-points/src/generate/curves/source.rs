//! Samples of curves as a source: each block is drawn when it is read.

use std::ops::Range;

use super::sample::Law;
use super::{CurveNoise, TruthCurves};
use crate::source::check_range;
use crate::{
    Error, PointSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch, shown_number,
};

/// Rows near curves that are never stored: those of [`sample_curve`](super::sample_curve).
#[derive(Clone, Debug)]
pub struct CurveSource {
    truth: TruthCurves,
    law: Law,
    n: u64,
    scalar: ScalarKind,
}

impl CurveSource {
    /// n rows; `scalar` says how they are delivered (drawn in `f64`, then rounded).
    ///
    /// # Errors
    /// [`Error::Parameter`] for a δ that is negative or not finite, and for a share of outliers outside [0, 1].
    pub fn new(
        truth: TruthCurves,
        n: u64,
        noise: CurveNoise,
        seed: u64,
        scalar: ScalarKind,
    ) -> Result<Self, Error> {
        let wrong = |name, value: f64, expected| {
            Err(Error::Parameter { name, value: shown_number(value), expected })
        };
        if !(noise.delta >= 0.0 && noise.delta.is_finite()) {
            return wrong("noise", noise.delta, "a finite number of at least 0");
        }
        if !(0.0..=1.0).contains(&noise.outliers) {
            return wrong("outliers", noise.outliers, "a share between 0 and 1");
        }
        let law = Law::new(&truth, n, noise, seed);
        Ok(CurveSource { truth, law, n, scalar })
    }

    fn view<'a, T: Scalar>(
        &self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let values = scratch.values::<T>(range.end - range.start, 2)?;
        for (row, point) in range.zip(values.chunks_exact_mut(2)) {
            let (drawn, _) = self.law.draw(&self.truth, row);
            for (column, (value, drawn)) in point.iter_mut().zip(drawn).enumerate() {
                *value = T::from_f64(drawn);
                if !(*value).into().is_finite() {
                    return Err(Error::Overflow { row, column, value: drawn, kind: T::KIND }.into());
                }
            }
        }
        Ok(T::rows(Points::new(values, 2).expect("whole rows were drawn")))
    }
}

impl PointSource for CurveSource {
    fn len(&self) -> u64 {
        self.n
    }

    fn dim(&self) -> usize {
        2
    }

    fn scalar(&self) -> ScalarKind {
        self.scalar
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        check_range(&range, self.n)?;
        match self.scalar {
            ScalarKind::F32 => self.view::<f32>(range, scratch),
            ScalarKind::F64 => self.view::<f64>(range, scratch),
        }
    }
}
