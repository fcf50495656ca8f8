//! Seeded point sets that are hard in one way each.

use std::f64::consts::TAU;

/// SplitMix64: enough for tests, and the same everywhere.
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * 2f64.powi(-53)
    }

    /// Uniform in 0 .. count.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count as u64) as usize
    }

    /// Standard normal (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (TAU * self.unit()).cos()
    }

    pub fn normals(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.normal()).collect()
    }

    /// Uniform on the unit sphere, to rounding.
    pub fn direction(&mut self, dim: usize) -> Vec<f64> {
        loop {
            let v = self.normals(dim);
            let norm = v.iter().map(|x| x * x).sum::<f64>().sqrt();
            if norm > 0.0 {
                return v.into_iter().map(|x| x / norm).collect();
            }
        }
    }

    pub fn sphere(&mut self, n: usize, dim: usize) -> Vec<f64> {
        (0..n).flat_map(|_| self.direction(dim)).collect()
    }
}

/// The families of the random stress.
#[derive(Clone, Copy, Debug)]
pub enum Family {
    Normal,
    Sphere,
    NoisySphere(f64),
    Cube,
    NoisyCube(f64),
    Lattice,
    NearCopies(f64),
    LowRank(f64),
    Clusters(f64),
    AxisScales,
    Outlier,
}

/// One instance of the stress.
#[derive(Clone, Debug)]
pub struct Instance {
    pub family: Family,
    pub n: usize,
    pub dim: usize,
    pub offset: f64,
    pub batch: Option<usize>,
    pub values: Vec<f64>,
}

/// An instance by its number: the number alone decides it.
pub fn instance(seed: u64, dim_max: usize) -> Instance {
    let mut random = Random(seed.wrapping_mul(0xA076_1D64_78BD_642F));
    let dim = match random.below(3) {
        0 => 1 + random.below(4),
        1 => 1 + random.below(20.min(dim_max)),
        _ => 1 + random.below(dim_max),
    };
    let n = match random.below(4) {
        0 => 1 + random.below(dim + 3),
        1 => 1 + random.below(60),
        _ => 1 + random.below(1500),
    };
    let noise = 10f64.powi(-(random.below(16) as i32));
    let family = match random.below(11) {
        0 => Family::Normal,
        1 => Family::Sphere,
        2 => Family::NoisySphere(noise),
        3 => Family::Cube,
        4 => Family::NoisyCube(noise),
        5 => Family::Lattice,
        6 => Family::NearCopies(noise),
        7 => Family::LowRank(noise),
        8 => Family::Clusters(noise),
        9 => Family::AxisScales,
        _ => Family::Outlier,
    };
    let batch = [None, Some(1), Some(2), Some(5), Some(64)][random.below(5)];
    let offset = if random.below(4) == 0 { 1e6 } else { 0.0 };
    let mut values = draw(&mut random, family, n, dim);
    values.iter_mut().for_each(|v| *v += offset);
    Instance { family, n, dim, offset, batch, values }
}

fn draw(random: &mut Random, family: Family, n: usize, dim: usize) -> Vec<f64> {
    let noisy = |mut values: Vec<f64>, noise: f64, random: &mut Random| {
        values.iter_mut().for_each(|v| *v += noise * random.normal());
        values
    };
    let cube = |random: &mut Random| -> Vec<f64> {
        (0..n * dim).map(|_| (random.bits() & 1) as f64).collect()
    };
    match family {
        Family::Normal => random.normals(n * dim),
        Family::Sphere => random.sphere(n, dim),
        Family::NoisySphere(noise) => {
            let values = random.sphere(n, dim);
            noisy(values, noise, random)
        }
        Family::Cube => cube(random),
        Family::NoisyCube(noise) => {
            let values = cube(random);
            noisy(values, noise, random)
        }
        Family::Lattice => (0..n * dim).map(|_| random.below(7) as f64 - 3.0).collect(),
        Family::NearCopies(noise) => {
            let few = 1 + random.below(3 * dim + 2);
            let originals = random.sphere(few, dim);
            let values = (0..n)
                .flat_map(|_| {
                    let i = random.below(few);
                    originals[i * dim..(i + 1) * dim].to_vec()
                })
                .collect();
            noisy(values, noise, random)
        }
        Family::LowRank(noise) => {
            let rank = 1 + random.below(dim);
            let basis = random.normals(rank * dim);
            let values = (0..n)
                .flat_map(|_| {
                    let weights = random.direction(rank);
                    (0..dim)
                        .map(|j| (0..rank).map(|k| weights[k] * basis[k * dim + j]).sum())
                        .collect::<Vec<f64>>()
                })
                .collect();
            noisy(values, noise, random)
        }
        Family::Clusters(noise) => {
            let count = 1 + random.below(5);
            let centers = random.normals(count * dim);
            let values = (0..n).flat_map(|i| centers[i % count * dim..][..dim].to_vec()).collect();
            noisy(values, noise, random)
        }
        Family::AxisScales => {
            let mut values = random.normals(n * dim);
            for row in values.chunks_exact_mut(dim) {
                for (j, v) in row.iter_mut().enumerate() {
                    *v *= 10f64.powf(-15.0 * j as f64 / dim as f64);
                }
            }
            values
        }
        Family::Outlier => {
            let mut values = random.normals(n * dim);
            let i = random.below(n);
            let far = 10f64.powi(random.below(12) as i32);
            values[i * dim..(i + 1) * dim].iter_mut().for_each(|v| *v *= far);
            values
        }
    }
}
