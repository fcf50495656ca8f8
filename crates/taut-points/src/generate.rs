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

/// What a distribution may be told when it is called by its name; what is left out has its default.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Parameters {
    /// Half the thickness of a shell, at least 0. Default 0.1.
    pub thickness: Option<f64>,
    /// Number of clusters, at least 1. Default 5.
    pub count: Option<u64>,
    /// Standard deviation of a cluster, at least 0. Default 0.05.
    pub spread: Option<f64>,
    /// Vertices of a polygon, at least 1. Default: as many as points.
    pub vertices: Option<u64>,
}

impl Distribution {
    /// The name of each distribution, and a line about it.
    pub const NAMES: [(&str, &str); 9] = [
        ("normal", "each coordinate standard normal"),
        ("uniform", "uniform in the unit cube"),
        ("cube", "vertices of the unit cube: cospherical, with duplicates in low dimension"),
        ("poisson", "each coordinate Poisson with mean 1: a lattice with many ties"),
        ("sphere", "uniform on the unit sphere"),
        ("shell", "uniform in direction, 1 ± T from the origin"),
        ("clusters", "normal clouds around K centres in the unit cube"),
        ("simplex", "vertices of a regular simplex with unit edges, then points inside"),
        ("polygon", "K points at equal angles on the unit circle, in turn"),
    ];

    /// The distribution of a name out of [`NAMES`](Self::NAMES), for n points.
    ///
    /// ```
    /// use taut_points::{Distribution, generate::Parameters};
    /// let given = Parameters { count: Some(3), ..Default::default() };
    /// let clouds = Distribution::named("clusters", 100, &given)?;
    /// assert_eq!(clouds, Distribution::Clusters { count: 3, spread: 0.05 });
    /// # Ok::<(), taut_points::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Parameter`] for another name or a parameter out of range, [`Error::Foreign`] for a parameter that the
    /// distribution does not take.
    pub fn named(name: &str, n: u64, given: &Parameters) -> Result<Self, Error> {
        for (parameter, is_given, owner) in [
            ("thickness", given.thickness.is_some(), "shell"),
            ("count", given.count.is_some(), "clusters"),
            ("spread", given.spread.is_some(), "clusters"),
            ("vertices", given.vertices.is_some(), "polygon"),
        ] {
            if is_given && name != owner {
                let distribution = name.to_owned();
                return Err(Error::Foreign { name: parameter, owner, distribution });
            }
        }
        let found = match name {
            "normal" => Distribution::Normal,
            "uniform" => Distribution::Uniform,
            "cube" => Distribution::CubeVertices,
            "poisson" => Distribution::Poisson,
            "sphere" => Distribution::Sphere,
            "shell" => Distribution::Shell { thickness: given.thickness.unwrap_or(0.1) },
            "clusters" => Distribution::Clusters {
                count: given.count.unwrap_or(5),
                spread: given.spread.unwrap_or(0.05),
            },
            "simplex" => Distribution::Simplex,
            "polygon" => Distribution::Polygon { vertices: given.vertices.unwrap_or(n.max(1)) },
            _ => {
                return Err(Error::Parameter {
                    name: "distribution",
                    value: name.to_owned(),
                    expected: "normal, uniform, cube, poisson, sphere, shell, clusters, simplex or polygon",
                });
            }
        };
        found.check().map(|()| found)
    }

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

/// Memory for one point.
fn point_of(dim: usize) -> Result<Vec<f64>, Error> {
    let mut point = Vec::new();
    point.try_reserve_exact(dim).map_err(|_| Error::Parameter {
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
    values.try_reserve_exact(n * dim).map_err(|_| Error::Parameter {
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
    let failed = out
        .par_chunks_mut(rows * dim)
        .enumerate()
        .filter_map(|(block, out)| source.fill(blocks.range(block as u64).start, out).err())
        .find_first(|_| true);
    failed.map_or(Ok(()), Err)
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
        assert!(Distribution::named("shell", 1, &Parameters::default()).is_ok());
        let thin = Parameters { thickness: Some(-1.0), ..Default::default() };
        let wrong = Distribution::named("shell", 1, &thin).unwrap_err();
        assert_eq!(wrong.to_string(), "`thickness` is -1: expected a finite number, at least 0");
        let wrong = Distribution::named("normal", 1, &thin).unwrap_err();
        let said = "`thickness` belongs to shell, not to normal: leave it out";
        assert_eq!(wrong.to_string(), said);
    }

    #[test]
    fn each_name_is_a_distribution_of_its_own_and_the_refusal_lists_them() {
        let named = |name| Distribution::named(name, 6, &Parameters::default());
        let refused = named("weibull").unwrap_err().to_string();
        let mut found = Vec::new();
        for (name, _) in Distribution::NAMES {
            let distribution = named(name).unwrap();
            assert!(!found.contains(&distribution) && refused.contains(name), "{name}");
            found.push(distribution);
        }
        assert_eq!(found[8], Distribution::Polygon { vertices: 6 });
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
