//! Radii for generated centers: points become balls.
//!
//! *Idea.* The radius of ball i is a function of one uniform number, drawn from the generator that draws points, as
//! the only coordinate of its point i under a seed of its own. So ball i depends on the seed and i alone.

use std::ops::Range;

use taut::PointSource;
use taut::points::Distribution;
use taut::points::generate::RadiusLaw;
use taut::points::{Error, GeneratedSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch};

/// Generated centers with generated radii in a last column.
pub(crate) struct Balls {
    centers: GeneratedSource,
    lots: GeneratedSource,
    law: RadiusLaw,
}

impl Balls {
    pub(crate) fn new(centers: GeneratedSource, seed: u64, law: RadiusLaw) -> Result<Self, Error> {
        // The generator keys its streams by the seed, so any other seed is independent of that of the centers.
        let lots =
            GeneratedSource::new(Distribution::Uniform, centers.len(), 1, !seed, ScalarKind::F64)?;
        Ok(Balls { centers, lots, law })
    }

    fn view<'a, T: Scalar>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let (mut of_centers, mut of_lots) = (Scratch::new(), Scratch::new());
        let first = range.start;
        let centers = self.centers.read(range.clone(), &mut of_centers)?;
        let lots = self.lots.read(range, &mut of_lots)?;
        let (dim, mut row, mut lot) = (self.dim(), vec![0.0; self.centers.dim()], [0.0]);
        let values: &mut [T] = scratch.values(centers.len() as u64, dim)?;
        for (i, out) in values.chunks_exact_mut(dim).enumerate() {
            centers.copy_row(i, &mut row);
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
        self.centers.len()
    }

    fn dim(&self) -> usize {
        // The centers have refused a dimension that cannot grow by 1.
        self.centers.dim() + 1
    }

    fn scalar(&self) -> ScalarKind {
        self.centers.scalar()
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
        let centers = GeneratedSource::new(Distribution::Normal, n, 2, 7, ScalarKind::F64).unwrap();
        Balls::new(centers, 7, law.parse().unwrap()).unwrap()
    }

    #[test]
    fn radii_are_those_of_the_law() {
        let balls = balls("uniform:1:3", 20_000);
        let ids: Vec<u64> = (0..balls.len()).collect();
        let rows = taut::points::gather(&balls, &ids).unwrap();
        let radii = rows.chunks(3).map(|ball| ball[2]);
        assert!(radii.clone().all(|r| (1.0..=3.0).contains(&r)));
        let mean = radii.sum::<f64>() / 20_000.0;
        assert!((mean - 2.0).abs() <= 0.05, "{mean}");
    }

    #[test]
    fn a_ball_depends_on_its_number_alone_and_keeps_its_center() {
        let (few, many) = (balls("uniform:0:1", 5), balls("uniform:0:1", 5000));
        let of = |balls: &Balls, ids: &[u64]| taut::points::gather(balls, ids).unwrap();
        assert_eq!(of(&few, &[4, 0]), of(&many, &[4, 0]));
        assert_eq!(of(&many, &[4321])[..2], taut::points::gather(&many.centers, &[4321]).unwrap());
    }

    #[test]
    fn a_radius_beyond_its_type_is_named() {
        let centers = GeneratedSource::new(Distribution::Normal, 5, 2, 7, ScalarKind::F32).unwrap();
        let balls = Balls::new(centers, 7, RadiusLaw::Equal(1e300)).unwrap();
        let refused = balls.read(3..5, &mut Scratch::new()).unwrap_err().to_string();
        assert!(refused.starts_with("coordinate 2 of point 3"), "{refused}");
    }
}
