//! Radii for generated centres: points become balls.
//!
//! *Idea.* The radius of ball i is a function of one uniform number, drawn from the generator that draws points, as
//! the only coordinate of its point i under a seed of its own. So ball i depends on the seed and i alone.

use std::ops::Range;
use std::str::FromStr;

use taut::points::{Error, GeneratedSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch};
use taut::{Distribution, PointSource};

/// How radii are distributed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Law {
    /// Each the same.
    Equal(f64),
    /// Uniform between two bounds.
    Uniform(f64, f64),
    /// Exponential with a mean.
    Exponential(f64),
}

impl FromStr for Law {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || {
            format!(
                "`{text}` is no law of radii: write equal:R, uniform:A:B or exponential:MEAN with numbers ≥ 0"
            )
        };
        let mut parts = text.split(':');
        let name = parts.next();
        let numbers: Vec<f64> =
            parts.map(str::parse).collect::<Result<_, _>>().map_err(|_| wrong())?;
        if !numbers.iter().all(|number| number.is_finite() && *number >= 0.0) {
            return Err(wrong());
        }
        match (name, &numbers[..]) {
            (Some("equal"), &[radius]) => Ok(Law::Equal(radius)),
            (Some("uniform"), &[low, high]) if low <= high => Ok(Law::Uniform(low, high)),
            (Some("exponential"), &[mean]) => Ok(Law::Exponential(mean)),
            _ => Err(wrong()),
        }
    }
}

impl Law {
    /// The radius that belongs to a number in [0, 1).
    fn radius(self, lot: f64) -> f64 {
        match self {
            Law::Equal(radius) => radius,
            Law::Uniform(low, high) => (low + (high - low) * lot).min(high),
            Law::Exponential(mean) => -mean * (-lot).ln_1p(),
        }
    }
}

/// Generated centres with generated radii in a last column.
pub(crate) struct Balls {
    centres: GeneratedSource,
    lots: GeneratedSource,
    law: Law,
}

impl Balls {
    pub(crate) fn new(centres: GeneratedSource, seed: u64, law: Law) -> Result<Self, Error> {
        // The generator keys its streams by the seed, so any other seed is independent of that of the centres.
        let lots =
            GeneratedSource::new(Distribution::Uniform, centres.len(), 1, !seed, ScalarKind::F64)?;
        Ok(Balls { centres, lots, law })
    }

    fn view<'a, T: Scalar>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let (mut of_centres, mut of_lots) = (Scratch::new(), Scratch::new());
        let first = range.start;
        let centres = self.centres.read(range.clone(), &mut of_centres)?;
        let lots = self.lots.read(range, &mut of_lots)?;
        let (dim, mut row, mut lot) = (self.dim(), vec![0.0; self.centres.dim()], [0.0]);
        let values: &mut [T] = scratch.values(centres.len() as u64, dim)?;
        for (i, out) in values.chunks_exact_mut(dim).enumerate() {
            centres.copy_row(i, &mut row);
            lots.copy_row(i, &mut lot);
            let ball = row.iter().copied().chain([self.law.radius(lot[0])]);
            for (column, (value, drawn)) in out.iter_mut().zip(ball).enumerate() {
                *value = T::from_f64(drawn);
                if !(*value).into().is_finite() {
                    let row = first + i as u64;
                    let kind = self.scalar();
                    return Err(Error::Overflow { row, column, value: drawn, kind }.into());
                }
            }
        }
        Ok(T::rows(Points::new(values, dim).expect("whole rows were drawn")))
    }
}

impl PointSource for Balls {
    fn len(&self) -> u64 {
        self.centres.len()
    }

    fn dim(&self) -> usize {
        // The centres have refused a dimension that cannot grow by 1.
        self.centres.dim() + 1
    }

    fn scalar(&self) -> ScalarKind {
        self.centres.scalar()
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        match self.scalar() {
            ScalarKind::F32 => self.view::<f32>(range, scratch),
            ScalarKind::F64 => self.view::<f64>(range, scratch),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn balls(law: &str, n: u64) -> Balls {
        let centres = GeneratedSource::new(Distribution::Normal, n, 2, 7, ScalarKind::F64).unwrap();
        Balls::new(centres, 7, law.parse().unwrap()).unwrap()
    }

    fn radii(balls: &Balls) -> Vec<f64> {
        let ids: Vec<u64> = (0..balls.len()).collect();
        taut::points::gather(balls, &ids).unwrap().chunks(3).map(|ball| ball[2]).collect()
    }

    #[test]
    fn laws_have_their_range_and_mean() {
        for (law, low, high, mean) in [
            ("equal:0.5", 0.5, 0.5, 0.5),
            ("uniform:1:3", 1.0, 3.0, 2.0),
            ("exponential:2", 0.0, f64::INFINITY, 2.0),
        ] {
            let radii = radii(&balls(law, 20_000));
            assert!(radii.iter().all(|&r| (low..=high).contains(&r)), "{law}");
            let found = radii.iter().sum::<f64>() / radii.len() as f64;
            assert!((found - mean).abs() <= 0.03 * mean, "{law}: {found}");
        }
    }

    #[test]
    fn a_ball_depends_on_its_number_alone_and_keeps_its_centre() {
        let (few, many) = (balls("uniform:0:1", 5), balls("uniform:0:1", 5000));
        let of = |balls: &Balls, ids: &[u64]| taut::points::gather(balls, ids).unwrap();
        assert_eq!(of(&few, &[4, 0]), of(&many, &[4, 0]));
        assert_eq!(of(&many, &[4321])[..2], taut::points::gather(&many.centres, &[4321]).unwrap());
    }

    #[test]
    fn a_radius_beyond_its_type_is_named() {
        let centres = GeneratedSource::new(Distribution::Normal, 5, 2, 7, ScalarKind::F32).unwrap();
        let balls = Balls::new(centres, 7, Law::Equal(1e300)).unwrap();
        let refused = balls.read(3..5, &mut Scratch::new()).unwrap_err().to_string();
        assert!(refused.starts_with("coordinate 2 of point 3"), "{refused}");
    }

    #[test]
    fn other_laws_are_refused_and_named() {
        for text in
            ["", "equal", "equal:-1", "uniform:2:1", "uniform:1", "exponential:NaN", "normal:1"]
        {
            assert!(text.parse::<Law>().unwrap_err().contains(&format!("`{text}`")));
        }
    }
}
