//! Seeded point sets of the literature.
//!
//! *Idea.* Point i has a random stream of its own: ChaCha8 keyed by the seed, stream number i. So a point depends
//! on the seed, i, d and the distribution alone, not on n, on threads or on what was generated before, and a set
//! larger than memory is itself a [`PointSource`].
//! *Reference.* The four distributions of the experiments on minimum enclosing balls by Kumar, Mitchell and
//! Yıldırım (ALENEX 2003): uniform in the cube, vertices of the cube, normal, Poisson with λ = 1.

use std::f64::consts::TAU;
use std::ops::Range;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, Exp1, Poisson, StandardNormal};
use rayon::prelude::*;

use crate::source::check_range;
use crate::{Blocks, Error, PointSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch};

/// From what points are drawn, independently of each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Distribution {
    /// Uniform in the unit cube [0, 1)ᵈ.
    Uniform,
    /// Uniform on the 2ᵈ vertices of the unit cube: cospherical, and with duplicates in low dimension.
    CubeVertices,
    /// Each coordinate standard normal.
    Normal,
    /// Each coordinate Poisson distributed with λ = 1: a lattice, with many ties.
    Poisson,
    /// Uniform on the unit sphere, to rounding.
    Sphere,
    /// Uniform direction, distance from the origin uniform in [1 − t, 1 + t).
    Shell {
        /// Half the thickness t ≥ 0; 1e-8 makes the hardest instances for a minimum enclosing ball.
        thickness: f64,
    },
    /// Normal clouds around centres that are uniform in the unit cube; point i belongs to cloud i mod count.
    Clusters {
        /// Number of clouds, at least 1.
        count: u64,
        /// Standard deviation of each cloud, ≥ 0.
        spread: f64,
    },
    /// The d + 1 vertices of a regular simplex with unit edges, then points uniform inside it.
    Simplex,
    /// n points at equal angles on the unit circle in the first two coordinates; the others are 0.
    Polygon {
        /// Number of vertices of the polygon, at least 1; point i is vertex i mod vertices.
        vertices: u64,
    },
}

impl Distribution {
    fn check(&self) -> Result<(), Error> {
        let wrong = |name, value: String, expected| Err(Error::Parameter { name, value, expected });
        match *self {
            Distribution::Shell { thickness } if !(thickness >= 0.0 && thickness.is_finite()) => {
                wrong("thickness", thickness.to_string(), "a finite number, at least 0")
            }
            Distribution::Clusters { count: 0, .. } => wrong("count", "0".into(), "at least 1"),
            Distribution::Clusters { spread, .. } if !(spread >= 0.0 && spread.is_finite()) => {
                wrong("spread", spread.to_string(), "a finite number, at least 0")
            }
            Distribution::Polygon { vertices: 0 } => wrong("vertices", "0".into(), "at least 1"),
            _ => Ok(()),
        }
    }
}

/// The random stream with a number of its own.
fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    random
}

/// Writes point `i` to `out`, whose length is the dimension.
fn draw(distribution: &Distribution, seed: u64, i: u64, out: &mut [f64]) {
    let mut random = stream(seed, i);
    match *distribution {
        Distribution::Uniform => out.fill_with(|| random.random()),
        Distribution::CubeVertices => vertex(&mut random, out),
        Distribution::Normal => out.fill_with(|| StandardNormal.sample(&mut random)),
        Distribution::Poisson => {
            let poisson = Poisson::new(1.0).expect("λ = 1 is a valid mean");
            out.fill_with(|| poisson.sample(&mut random));
        }
        Distribution::Sphere => direction(&mut random, 1.0, out),
        Distribution::Shell { thickness } => {
            let radius = 1.0 + thickness * (2.0 * random.random::<f64>() - 1.0);
            direction(&mut random, radius, out);
        }
        Distribution::Clusters { count, spread } => {
            // Streams counted down from the last belong to the centres.
            let mut centre = stream(seed, u64::MAX - i % count);
            out.fill_with(|| {
                let offset: f64 = StandardNormal.sample(&mut random);
                centre.random::<f64>() + spread * offset
            });
        }
        Distribution::Simplex => simplex(&mut random, i, out),
        Distribution::Polygon { vertices } => {
            let (sin, cos) = (TAU * (i % vertices) as f64 / vertices as f64).sin_cos();
            out.fill(0.0);
            for (coordinate, value) in out.iter_mut().zip([cos, sin]) {
                *coordinate = value;
            }
        }
    }
}

/// One random bit for each coordinate.
fn vertex(random: &mut ChaCha8Rng, out: &mut [f64]) {
    for word in out.chunks_mut(64) {
        let mut bits: u64 = random.random();
        for coordinate in word {
            *coordinate = (bits & 1) as f64;
            bits >>= 1;
        }
    }
}

/// A normal vector, scaled to the wanted length: uniform in direction (Muller 1959).
fn direction(random: &mut ChaCha8Rng, radius: f64, out: &mut [f64]) {
    loop {
        out.fill_with(|| StandardNormal.sample(random));
        let norm = out.iter().map(|v| v * v).sum::<f64>().sqrt();
        if norm > 0.0 {
            return out.iter_mut().for_each(|v| *v *= radius / norm);
        }
    }
}

/// Vertex `i`, or for i > d a point with barycentric coordinates uniform on the standard simplex.
fn simplex(random: &mut ChaCha8Rng, i: u64, out: &mut [f64]) {
    let d = out.len();
    // Vertices e₁ … e_d and a·(1 … 1), all at distance √2 from each other, scaled to unit edges.
    let scale = std::f64::consts::FRAC_1_SQRT_2;
    let apex = scale * (1.0 - (d as f64 + 1.0).sqrt()) / d as f64;
    if i <= d as u64 {
        out.fill(if i == d as u64 { apex } else { 0.0 });
        if let Some(coordinate) = out.get_mut(i as usize) {
            *coordinate = scale;
        }
        return;
    }
    out.fill_with(|| Exp1.sample(random));
    let last: f64 = Exp1.sample(random);
    let sum = out.iter().sum::<f64>() + last;
    out.iter_mut().for_each(|v| *v = (*v * scale + last * apex) / sum);
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
    /// [`Error::ZeroDimension`], or [`Error::Parameter`] for a parameter out of range.
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
        Ok(GeneratedSource { distribution, n, dim, seed, scalar })
    }

    fn fill<T: Scalar>(&self, first: u64, out: &mut [T]) {
        let mut point = vec![0.0; self.dim];
        for (i, row) in (first..).zip(out.chunks_exact_mut(self.dim)) {
            draw(&self.distribution, self.seed, i, &mut point);
            for (value, &drawn) in row.iter_mut().zip(&point) {
                *value = T::from_f64(drawn);
            }
        }
    }

    fn view<'a, T: Scalar>(&self, range: Range<u64>, scratch: &'a mut Scratch) -> Rows<'a> {
        let values = scratch.values::<T>((range.end - range.start) as usize * self.dim);
        self.fill(range.start, values);
        T::rows(Points::new(values, self.dim).expect("whole rows were drawn"))
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
        Ok(match self.scalar {
            ScalarKind::F32 => self.view::<f32>(range, scratch),
            ScalarKind::F64 => self.view::<f64>(range, scratch),
        })
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
/// As [`GeneratedSource::new`].
pub fn generate<T: Scalar>(
    distribution: Distribution,
    n: usize,
    dim: usize,
    seed: u64,
) -> Result<Vec<T>, Error> {
    let mut values = vec![T::from_f64(0.0); n * dim];
    generate_into(distribution, dim, seed, &mut values)?;
    Ok(values)
}

/// Draws as many points of dimension `dim` as `out` has room for, as [`generate`] would, to memory of the caller.
///
/// # Errors
/// As [`GeneratedSource::new`], and [`Error::Ragged`] when `out` would end within a point.
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
    out.par_chunks_mut(rows * dim)
        .enumerate()
        .for_each(|(block, out)| source.fill(blocks.range(block as u64).start, out));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Distribution; 9] = [
        Distribution::Uniform,
        Distribution::CubeVertices,
        Distribution::Normal,
        Distribution::Poisson,
        Distribution::Sphere,
        Distribution::Shell { thickness: 0.25 },
        Distribution::Clusters { count: 3, spread: 0.01 },
        Distribution::Simplex,
        Distribution::Polygon { vertices: 7 },
    ];

    fn norm(point: &[f64]) -> f64 {
        point.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    #[test]
    fn a_point_depends_on_seed_and_number_alone() {
        for distribution in ALL {
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

    #[test]
    fn parameters_out_of_range_are_named() {
        let wrong =
            generate::<f64>(Distribution::Shell { thickness: f64::NAN }, 1, 2, 0).unwrap_err();
        assert!(wrong.to_string().contains("thickness"), "{wrong}");
        assert_eq!(generate::<f32>(Distribution::Normal, 1, 0, 0), Err(Error::ZeroDimension));
        assert_eq!(generate::<f64>(Distribution::Normal, 0, 3, 0), Ok(vec![]));
    }
}
