//! Samples of surfaces, made by formulas and a seeded generator.
#![allow(dead_code, missing_docs, unreachable_pub)] // each test binary uses a part

pub mod rational;

use std::f64::consts::{PI, TAU};

pub type Point = [f64; 3];

/// Splitmix64.
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for i in (1..items.len()).rev() {
            items.swap(i, (self.unit() * (i + 1) as f64) as usize);
        }
    }
}

/// n points on a spiral over the unit sphere, evenly spaced.
pub fn sphere(n: usize) -> Vec<Point> {
    let turn = PI * (3.0 - 5f64.sqrt());
    (0..n)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / n as f64;
            let (sin, cos) = (turn * i as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            [r * cos, r * sin, z]
        })
        .collect()
}

/// A smooth body with waves, sampled along the spiral.
pub fn waves(n: usize) -> Vec<Point> {
    sphere(n)
        .into_iter()
        .map(|[x, y, z]| {
            let r = 1.0 + 0.1 * (3.0 * x + 1.0).sin() + 0.08 * (4.0 * y + 2.0 * z).cos();
            [1.3 * r * x, r * y, 0.9 * r * z]
        })
        .collect()
}

/// A torus of radii 2 and 1: rows of points around the tube, every other one moved by half a step, all moved a little at random.
pub fn torus(around: usize, tube: usize, seed: u64) -> Vec<Point> {
    let mut random = Random(seed);
    let mut points = Vec::with_capacity(around * tube);
    for i in 0..around {
        for j in 0..tube {
            let shift = 0.5 * (i % 2) as f64 + 0.2 * (random.unit() - 0.5);
            let (a, b) = (TAU * i as f64 / around as f64, TAU * (j as f64 + shift) / tube as f64);
            let r = 2.0 + b.cos();
            points.push([r * a.cos(), r * a.sin(), b.sin()]);
        }
    }
    points
}

/// Points anywhere in the unit cube.
pub fn soup(n: usize, seed: u64) -> Vec<Point> {
    let mut random = Random(seed);
    (0..n).map(|_| [(); 3].map(|()| random.unit())).collect()
}

/// Two rectangular sheets that meet along the y-axis at an angle: rows × columns points each, the row on the axis only once. Points but
/// those of the axis and the rims are moved within their sheet by up to a fifth of the spacing.
pub fn wedge(angle: f64, rows: usize, columns: usize, seed: u64) -> Vec<Point> {
    let mut random = Random(seed);
    let step = 1.0 / (columns - 1) as f64;
    let mut points = Vec::new();
    for sheet in 0..2 {
        let (sin, cos) = (angle * f64::from(sheet)).sin_cos();
        for i in usize::from(sheet == 1)..columns {
            for j in 0..rows {
                let free = i > 0 && i + 1 < columns && j > 0 && j + 1 < rows;
                let mut moved = || if free { 0.4 * step * (random.unit() - 0.5) } else { 0.0 };
                let (r, y) = (step * i as f64 + moved(), step * j as f64 + moved());
                points.push([r * cos, y, r * sin]);
            }
        }
    }
    points
}

/// n points on a body of rings, 64 points each and exactly cocircular: lattice points of circles about the z-axis, in integers.
pub fn rings(n: usize) -> Vec<Point> {
    let ring = lattice_ring(32_045, 64);
    let count = n.div_ceil(64);
    let mut points = Vec::with_capacity(64 * count);
    for k in 0..count {
        // A body that is wide, narrow and wide again, of rings a spacing apart.
        let along = k as f64 / count as f64;
        let size = (40.0 + 12.0 * (TAU * along).cos() + 5.0 * (3.0 * TAU * along).sin()).round();
        let z = (3_100.0 * 40.0 * k as f64).round();
        points.extend(ring.iter().map(|[x, y]| [x * size, y * size, z]));
    }
    points.truncate(n);
    points
}

/// Lattice points of a circle, those nearest to so many even directions.
fn lattice_ring(radius: i64, count: usize) -> Vec<[f64; 2]> {
    let mut all = Vec::new();
    for x in -radius..=radius {
        let rest = radius * radius - x * x;
        let y = (rest as f64).sqrt().round() as i64;
        if y * y == rest {
            all.push([x as f64, y as f64]);
            all.push([x as f64, -y as f64]);
        }
    }
    let mut ring: Vec<[f64; 2]> = (0..count)
        .map(|i| {
            let (sin, cos) = (TAU * i as f64 / count as f64).sin_cos();
            let along = |p: &[f64; 2]| p[0] * cos + p[1] * sin;
            all.iter().copied().max_by(|p, q| along(p).total_cmp(&along(q))).expect("some point")
        })
        .collect();
    ring.dedup();
    ring
}

/// The same sizes, but of rounded cosines: cocircular up to rounding.
pub fn rounded_rings(n: usize) -> Vec<Point> {
    (0..n)
        .map(|i| {
            let (k, j) = (i / 64, i % 64);
            let along = k as f64 / n.div_ceil(64) as f64;
            let size = 40.0 + 12.0 * (TAU * along).cos() + 5.0 * (3.0 * TAU * along).sin();
            let (sin, cos) = (TAU * j as f64 / 64.0).sin_cos();
            [size * cos, size * sin, 3.9 * k as f64]
        })
        .collect()
}
