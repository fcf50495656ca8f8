//! Seeded point sets of the literature.
//!
//! *Idea.* Point i has a random stream of its own: ChaCha8 keyed by the seed, stream number i. So a point depends
//! on the seed, i, d and the distribution alone, not on n, on threads or on what was generated before, and a set
//! larger than memory is itself a [`PointSource`].
//! *Reference.* The four distributions of the experiments on minimum enclosing balls by Kumar, Mitchell and
//! Yıldırım (ALENEX 2003): uniform in the cube, vertices of the cube, normal, Poisson with λ = 1. Kuzmin's as in the
//! experiments on Delaunay triangulations by Blelloch, Miller and Talmor (Algorithmica 24(3), 1999).

pub mod curves;
mod distribution;
mod draw;
mod radii;
mod shuffle;

use std::ops::Range;

use crate::parallel::ParallelSlice;

use crate::room::try_reserve_exact;
use crate::source::check_range;
use crate::{Blocks, Error, PointSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch};

pub use distribution::{Distribution, Parameters};
use draw::draw;
pub use radii::RadiusLaw;

fn point_of(dim: usize) -> Result<Vec<f64>, Error> {
    let mut point = Vec::new();
    try_reserve_exact(&mut point, dim).map_err(|_| Error::Parameter {
        name: "dim",
        value: dim.to_string(),
        expected: "a dimension of which a point fits into memory",
    })?;
    point.resize(dim, 0.0);
    Ok(point)
}

/// A generated point set that is never stored: each block is drawn when it is read.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeneratedSource {
    distribution: Distribution,
    n: u64,
    dim: usize,
    seed: u64,
    scalar: ScalarKind,
}

impl GeneratedSource {
    /// n points of dimension `dim`; `scalar` says how they are delivered (drawn in `f64`, then rounded).
    ///
    /// # Errors
    /// [`Error::ZeroDimension`], or [`Error::Parameter`] for a parameter out of range: so is a dimension of which not
    /// one point fits into memory, and a set of more than [`isize::MAX`] bytes as `f64`.
    pub fn new(
        distribution: Distribution,
        n: u64,
        dim: usize,
        seed: u64,
        scalar: ScalarKind,
    ) -> Result<Self, Error> {
        distribution.check()?;
        if dim == 0 {
            return Err(Error::ZeroDimension);
        }
        point_of(dim)?;
        let values = (dim as u64).checked_mul(n);
        if values.is_none_or(|values| values > isize::MAX as u64 / 8) {
            return Err(Error::Parameter {
                name: "n",
                value: n.to_string(),
                expected: "a number of points whose coordinates can be counted: n·d at most 2^60 - 1",
            });
        }
        Ok(GeneratedSource { distribution, n, dim, seed, scalar })
    }

    fn fill<T: Scalar>(&self, first: u64, out: &mut [T]) -> Result<(), Error> {
        let mut point = point_of(self.dim)?;
        for (i, row) in (first..).zip(out.chunks_exact_mut(self.dim)) {
            draw(&self.distribution, self.seed, i, &mut point);
            for (column, (value, &drawn)) in row.iter_mut().zip(&point).enumerate() {
                *value = T::from_f64(drawn);
                let rounded: f64 = (*value).into();
                if !rounded.is_finite() {
                    return Err(Error::Overflow { row: i, column, value: drawn, kind: T::KIND });
                }
            }
        }
        Ok(())
    }

    fn view<'a, T: Scalar>(
        &self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        let values = scratch.values::<T>(range.end - range.start, self.dim)?;
        self.fill(range.start, values)?;
        Ok(T::rows(Points::new(values, self.dim).expect("whole rows were drawn")))
    }
}

impl PointSource for GeneratedSource {
    fn len(&self) -> u64 {
        self.n
    }

    fn dim(&self) -> usize {
        self.dim
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

/// Draws n points of dimension `dim` to memory, row-major, on all threads.
///
/// ```
/// use taut_points::{Distribution, generate};
/// let few: Vec<f64> = generate(Distribution::Normal, 10, 3, 42)?;
/// let many: Vec<f64> = generate(Distribution::Normal, 1000, 3, 42)?;
/// assert_eq!(few[..], many[..30]);   // point i is the same in both
/// # Ok::<(), taut_points::Error>(())
/// ```
///
/// # Errors
/// As [`GeneratedSource::new`]; [`Error::Parameter`] when n·d values do not fit into memory, and [`Error::Overflow`]
/// for a coordinate that is infinite as `T`.
pub fn generate<T: Scalar>(
    distribution: Distribution,
    n: usize,
    dim: usize,
    seed: u64,
) -> Result<Vec<T>, Error> {
    // Refuses what is wrong with the parameters before any memory is asked for.
    GeneratedSource::new(distribution, n as u64, dim, seed, T::KIND)?;
    let mut values = Vec::new();
    try_reserve_exact(&mut values, n * dim).map_err(|_| Error::Parameter {
        name: "n",
        value: n.to_string(),
        expected: "a number of points that fits into memory",
    })?;
    values.resize(n * dim, T::from_f64(0.0));
    generate_into(distribution, dim, seed, &mut values)?;
    Ok(values)
}

/// Draws as many points of dimension `dim` as `out` has room for, as [`generate`] would, to memory of the caller.
///
/// # Errors
/// As [`GeneratedSource::new`]; [`Error::Ragged`] when `out` would end within a point, and [`Error::Overflow`] for the
/// first coordinate that is infinite as `T`.
pub fn generate_into<T: Scalar>(
    distribution: Distribution,
    dim: usize,
    seed: u64,
    out: &mut [T],
) -> Result<(), Error> {
    let n = Points::new(out, dim)?.len() as u64;
    let source = GeneratedSource::new(distribution, n, dim, seed, T::KIND)?;
    let blocks = Blocks::of(&source);
    let rows = blocks.range(0).end.max(1) as usize;
    let blocks_of_rows = out.par_chunks_mut(rows * dim).enumerate();
    blocks_of_rows.try_for_each(|(block, out)| source.fill(blocks.range(block as u64).start, out))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(name: &str, n: u64, dim: usize) -> Distribution {
        Distribution::named(name, n, dim, &Parameters::default()).unwrap()
    }

    fn norm(point: &[f64]) -> f64 {
        point.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    #[test]
    fn a_point_depends_on_seed_and_number_alone() {
        for (name, _) in Distribution::NAMES {
            let distribution = named(name, 30_000, 7);
            let values: Vec<f64> = generate(distribution, 30_000, 7, 1).unwrap();
            let source = GeneratedSource::new(distribution, 30_000, 7, 1, ScalarKind::F64).unwrap();
            let late = crate::gather(&source, &[29_999, 0]).unwrap();
            assert_eq!(late, [&values[29_999 * 7..], &values[..7]].concat(), "{distribution:?}");
            let one: Vec<f64> = rayon::ThreadPoolBuilder::new()
                .num_threads(1)
                .build()
                .unwrap()
                .install(|| generate(distribution, 30_000, 7, 1).unwrap());
            assert_eq!(values, one, "{distribution:?}");
        }
        let other: Vec<f64> = generate(Distribution::Normal, 10, 7, 2).unwrap();
        assert_ne!(other, generate::<f64>(Distribution::Normal, 10, 7, 1).unwrap());
    }

    #[test]
    fn moments_are_those_of_the_distribution() {
        for (distribution, mean, variance) in [
            (Distribution::Uniform, 0.5, 1.0 / 12.0),
            (Distribution::CubeVertices, 0.5, 0.25),
            (Distribution::Normal, 0.0, 1.0),
            (Distribution::Poisson, 1.0, 1.0),
            (Distribution::Sphere, 0.0, 0.25),
        ] {
            let values: Vec<f64> = generate(distribution, 50_000, 4, 7).unwrap();
            let n = values.len() as f64;
            let m = values.iter().sum::<f64>() / n;
            let v = values.iter().map(|x| (x - m) * (x - m)).sum::<f64>() / n;
            assert!((m - mean).abs() < 0.015, "{distribution:?}: mean {m}");
            assert!((v - variance).abs() < 0.02, "{distribution:?}: variance {v}");
        }
    }

    #[test]
    fn shapes_are_what_they_say() {
        let shell: Vec<f64> =
            generate(Distribution::Shell { thickness: 0.25 }, 1000, 5, 3).unwrap();
        assert!(shell.chunks(5).all(|p| (0.75..=1.25).contains(&norm(p))));
        let simplex: Vec<f64> = generate(Distribution::Simplex, 50, 6, 3).unwrap();
        for i in 0..7 {
            for j in 0..i {
                let edge: Vec<f64> =
                    (0..6).map(|k| simplex[i * 6 + k] - simplex[j * 6 + k]).collect();
                assert!((norm(&edge) - 1.0).abs() < 1e-14);
            }
        }
        let polygon: Vec<f64> = generate(Distribution::Polygon { vertices: 4 }, 8, 2, 0).unwrap();
        assert_eq!(polygon[..8], polygon[8..]);
        let clusters: Vec<f64> =
            generate(Distribution::Clusters { count: 2, spread: 0.0 }, 4, 3, 9).unwrap();
        assert_eq!(clusters[..6], clusters[6..]);
        assert_ne!(clusters[..3], clusters[3..6]);
    }

    /// Every pair of rows, as bits, so that a set of them finds duplicates.
    fn distinct(values: &[f64], dim: usize) -> usize {
        let rows = values.chunks(dim).map(|row| row.iter().map(|v| v.to_bits()).collect());
        rows.collect::<std::collections::HashSet<Vec<u64>>>().len()
    }

    #[test]
    fn grids_have_each_point_once_before_any_comes_again() {
        for (n, dim, side) in [(400, 2, 20), (125, 3, 5), (17, 1, 17), (130, 3, 6)] {
            let grid = named("grid", n as u64, dim);
            assert_eq!(grid, Distribution::Grid { side, angle: 0.0 });
            let values: Vec<f64> = generate(grid, n, dim, 3).unwrap();
            assert_eq!(distinct(&values, dim), n);
            assert!(values.iter().all(|&v| v.fract() == 0.0 && (0.0..side as f64).contains(&v)));
            assert!(!values.is_sorted(), "in random order");
        }
        let twice: Vec<f64> =
            generate(Distribution::Grid { side: 3, angle: 0.0 }, 18, 2, 3).unwrap();
        assert_eq!(twice[..18], twice[18..]);
        assert_eq!(distinct(&twice, 2), 9);
        let tilted: Vec<f64> =
            generate(Distribution::Grid { side: 9, angle: 90.0 }, 81, 2, 3).unwrap();
        let straight: Vec<f64> =
            generate(Distribution::Grid { side: 9, angle: 0.0 }, 81, 2, 3).unwrap();
        for (turned, p) in tilted.chunks(2).zip(straight.chunks(2)) {
            assert!((turned[0] + p[1]).abs() < 1e-14 && (turned[1] - p[0]).abs() < 1e-14);
        }
        // More axes than a number has digits: still no point twice.
        let values: Vec<f64> = generate(named("grid", 1000, 70), 1000, 70, 3).unwrap();
        assert_eq!(distinct(&values, 70), 1000);
    }

    #[test]
    fn shapes_of_plane_and_space_are_met_and_fitted_to_the_dimension() {
        let drawn =
            |name, dim| -> Vec<f64> { generate(named(name, 2000, 3), 2000, dim, 5).unwrap() };
        for name in ["polygon", "spiral", "lines", "skew", "fan", "roads"] {
            let (line, wide) = (drawn(name, 1), drawn(name, 5));
            for (x, p) in line.iter().zip(wide.chunks(5)) {
                assert_eq!((*x, p[3], p[4]), (p[0], 0.0, 0.0), "{name}");
            }
        }
        for p in drawn("spiral", 2).chunks(2) {
            let r = norm(p);
            let (sin, cos) = (std::f64::consts::TAU * 10.0 * r).sin_cos();
            assert!((p[0] - r * cos).abs() < 1e-12 && (p[1] - r * sin).abs() < 1e-12 && r < 1.0);
        }
        for (i, p) in drawn("lines", 2).chunks(2).enumerate() {
            assert!(p[1] == (i % 2) as f64 && (0.0..1.0).contains(&p[0]));
        }
        for (i, p) in drawn("skew", 3).chunks(3).enumerate() {
            let (along, across, height) =
                if i % 2 == 0 { (p[0], p[1], -1.0) } else { (p[1], p[0], 1.0) };
            assert!((-1.0..1.0).contains(&along) && across == 0.0 && p[2] == height);
        }
        let fan = drawn("fan", 2);
        assert_eq!(fan[..2], [0.5, 1.0]);
        assert!(fan[2..].chunks(2).all(|p| (0.0..1.0).contains(&p[0]) && p[1] == 0.0));
        let torus: Vec<f64> = generate(Distribution::Torus { noise: 0.0 }, 500, 3, 5).unwrap();
        for p in torus.chunks(3) {
            assert!(((norm(&p[..2]) - 2.0).hypot(p[2]) - 0.7).abs() < 1e-14);
        }
        let noisy = drawn("torus", 3);
        let off = noisy.chunks(3).map(|p| ((norm(&p[..2]) - 2.0).hypot(p[2]) - 0.7).powi(2));
        let off = (off.sum::<f64>() / 2000.0).sqrt();
        assert!((0.9e-4..1.1e-4).contains(&off), "{off}");
    }

    #[test]
    fn kuzmin_is_distributed_as_its_law_says() {
        let values: Vec<f64> = generate(Distribution::Kuzmin, 50_000, 2, 7).unwrap();
        for radius in [0.1f64, 1.0, 10.0, 100.0] {
            let within = values.chunks(2).filter(|p| norm(p) <= radius).count() as f64 / 5e4;
            let law = 1.0 - 1.0 / (1.0 + radius * radius).sqrt();
            assert!((within - law).abs() < 0.01, "{radius}: {within} instead of {law}");
        }
    }

    #[test]
    fn clouds_differ_in_width() {
        let values: Vec<f64> = generate(Distribution::Clouds { count: 20 }, 20_000, 2, 7).unwrap();
        let widths: Vec<f64> = (0..20)
            .map(|cloud| {
                let xs: Vec<f64> = values.chunks(2).skip(cloud).step_by(20).map(|p| p[0]).collect();
                let mean = xs.iter().sum::<f64>() / 1e3;
                (xs.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 1e3).sqrt()
            })
            .collect();
        assert!(widths.iter().all(|w| (0.9e-5..1.1e-2).contains(w)), "{widths:?}");
        let (least, most) = widths.iter().fold((1.0f64, 0.0f64), |(a, b), &w| (a.min(w), b.max(w)));
        assert!(most > 50.0 * least, "{least} to {most}");
    }

    #[test]
    fn roads_are_walks_of_fifty_steps_that_crowd_around_few_towns() {
        let n = 100_000;
        let roads = named("roads", n as u64, 2);
        assert_eq!(roads, Distribution::Roads { count: 44 });
        let values: Vec<f64> = generate(roads, n, 2, 7).unwrap();
        assert!(values.iter().all(|v| (v * 1e6).round() / 1e6 == *v && (-10.0..70.0).contains(v)));
        for road in values.chunks(100) {
            let steps: Vec<f64> = road
                .windows(4)
                .step_by(2)
                .map(|pair| norm(&[pair[2] - pair[0], pair[3] - pair[1]]))
                .collect();
            let first = steps[0];
            assert!((0.9 * 60e-4 / 20.0..60e-3 / 1.9).contains(&first), "{first}");
            // The same step to the rounding of its ends.
            assert!(steps.iter().all(|step| (step - first).abs() < 3e-6), "{steps:?}");
        }
        // Zipf: about log 2 / log 45 = 18 % of all roads begin at the largest of 44 towns.
        let mut cells = std::collections::HashMap::new();
        for road in values.chunks(100) {
            *cells.entry(((road[0] / 3.0) as i64, (road[1] / 3.0) as i64)).or_insert(0) += 1;
        }
        let crowd = *cells.values().max().unwrap();
        assert!((150..700).contains(&crowd), "{crowd} of 2000 roads within 3 units");
    }

    #[test]
    fn parameters_out_of_range_are_named() {
        let wrong =
            generate::<f64>(Distribution::Shell { thickness: f64::NAN }, 1, 2, 0).unwrap_err();
        assert!(wrong.to_string().contains("thickness"), "{wrong}");
        assert_eq!(generate::<f32>(Distribution::Normal, 1, 0, 0), Err(Error::ZeroDimension));
        assert_eq!(generate::<f64>(Distribution::Normal, 0, 3, 0), Ok(vec![]));
    }

    #[test]
    fn what_no_machine_holds_is_refused() {
        let large = 2_305_843_009_213_693_953; // times 8 bytes it wraps to 8
        for (n, dim) in
            [(1, usize::MAX), (1, large), (1, 1 << 60), (usize::MAX, 2), (large, 8), (1 << 58, 4)]
        {
            let made = generate::<f32>(Distribution::Normal, n, dim, 0);
            assert!(matches!(made, Err(Error::Parameter { .. })), "{n} × {dim}");
            let source =
                GeneratedSource::new(Distribution::Normal, n as u64, dim, 0, ScalarKind::F32);
            assert!(matches!(source, Err(Error::Parameter { .. })), "{n} × {dim}");
        }
        // Far too many points to hold, but each block of them can be drawn.
        let source =
            GeneratedSource::new(Distribution::Normal, 1 << 58, 3, 0, ScalarKind::F32).unwrap();
        let last = (1 << 58) - 1;
        assert_eq!(source.read(last..last + 1, &mut Scratch::new()).unwrap().len(), 1);
        let refused = source.read(0..1 << 58, &mut Scratch::new()).unwrap_err();
        assert!(matches!(refused, ReadError::TooLarge { dim: 3, .. }), "{refused}");
        assert!(matches!(
            generate::<f64>(Distribution::Normal, 1 << 58, 3, 0),
            Err(Error::Parameter { name: "n", .. })
        ));
    }

    #[test]
    fn a_coordinate_beyond_its_type_is_named() {
        let clouds = Distribution::Clusters { count: 1, spread: 1e300 };
        assert!(generate::<f64>(clouds, 50_000, 2, 0).is_ok());
        let refused = generate::<f32>(clouds, 50_000, 2, 0).unwrap_err();
        assert!(matches!(refused, Error::Overflow { row: 0, column: 0, .. }), "{refused}");
        assert!(refused.to_string().contains("and f32 does not reach that far"), "{refused}");
        let source = GeneratedSource::new(clouds, 9, 2, 0, ScalarKind::F32).unwrap();
        let refused = source.read(4..5, &mut Scratch::new()).unwrap_err();
        assert!(matches!(refused, ReadError::Drawn(Error::Overflow { row: 4, .. })), "{refused}");
    }
}
