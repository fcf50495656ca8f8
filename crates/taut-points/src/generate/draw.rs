//! One point of each distribution, from the random stream of its number.

use std::f64::consts::{FRAC_PI_2, TAU};

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution as _, Exp1, Poisson, StandardNormal};

use super::Distribution;
use super::shuffle::shuffled;

/// The random stream with a number of its own.
pub(super) fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(number);
    random
}

/// The stream of a center or a town: counted down from the last, so that it is none of a point.
fn stream_of_center(seed: u64, number: u64) -> ChaCha8Rng {
    stream(seed, u64::MAX - number)
}

/// Writes point `i` to `out`, whose length is the dimension.
pub(super) fn draw(distribution: &Distribution, seed: u64, i: u64, out: &mut [f64]) {
    let mut random = stream(seed, i);
    match *distribution {
        Distribution::Uniform => out.fill_with(|| random.random()),
        Distribution::CubeVertices => vertex(&mut random, out),
        Distribution::Normal => out.fill_with(|| normal(&mut random)),
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
            let mut center = stream_of_center(seed, i % count);
            out.fill_with(|| {
                let offset = normal(&mut random);
                center.random::<f64>() + spread * offset
            });
        }
        Distribution::Clouds { count } => {
            let mut center = stream_of_center(seed, i % count);
            let spread = 10f64.powf(-5.0 + 3.0 * center.random::<f64>());
            out.fill_with(|| center.random::<f64>() + spread * normal(&mut random));
        }
        Distribution::Simplex => simplex(&mut random, i, out),
        Distribution::Polygon { vertices } => {
            let (sin, cos) = (TAU * (i % vertices) as f64 / vertices as f64).sin_cos();
            fit(&[cos, sin], out);
        }
        Distribution::Kuzmin => {
            // The distribution function solved for r.
            let rest = 1.0 - random.random::<f64>();
            let radius = (1.0 / (rest * rest) - 1.0).sqrt();
            direction(&mut random, radius, out);
        }
        Distribution::Grid { side, angle } => grid(seed, i, side, angle, out),
        Distribution::Spiral { turns } => {
            let radius = random.random::<f64>().sqrt();
            let (sin, cos) = (TAU * turns * radius).sin_cos();
            fit(&[radius * cos, radius * sin], out);
        }
        Distribution::Lines => fit(&[random.random(), (i % 2) as f64], out),
        Distribution::Skew => {
            let t = 2.0 * random.random::<f64>() - 1.0;
            fit(&if i.is_multiple_of(2) { [t, 0.0, -1.0] } else { [0.0, t, 1.0] }, out);
        }
        Distribution::Fan if i == 0 => fit(&[0.5, 1.0], out),
        Distribution::Fan => fit(&[random.random(), 0.0], out),
        Distribution::Roads { count } => fit(&road(seed, i, count), out),
        Distribution::Torus { noise } => {
            let (sin_u, cos_u) = (TAU * random.random::<f64>()).sin_cos();
            let (sin_v, cos_v) = (TAU * random.random::<f64>()).sin_cos();
            let ring = 2.0 + 0.7 * cos_v;
            let exact = [ring * cos_u, ring * sin_u, 0.7 * sin_v];
            fit(&exact.map(|v| v + noise * normal(&mut random)), out);
        }
    }
}

pub(super) fn normal(random: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(random)
}

/// Copies a point of the plane or of space, cut or filled up with 0.
fn fit(point: &[f64], out: &mut [f64]) {
    out.fill(0.0);
    for (coordinate, &value) in out.iter_mut().zip(point) {
        *coordinate = value;
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
        out.fill_with(|| normal(random));
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

/// The digits of a shuffled number to the base `side`, turned by `angle` degrees.
fn grid(seed: u64, i: u64, side: u64, angle: f64, out: &mut [f64]) {
    let exponent = u32::try_from(out.len()).unwrap_or(u32::MAX);
    // A grid beyond 2⁶⁴ points: as many of them as there are numbers.
    let last = side.checked_pow(exponent).map_or(u64::MAX, |points| points - 1);
    let mut number = shuffled(seed, i, last);
    out.fill_with(|| {
        let digit = number % side;
        number /= side;
        digit as f64
    });
    if angle != 0.0 {
        let (sin, cos) = angle.to_radians().sin_cos();
        let (x, y) = (out[0], out.get(1).copied().unwrap_or(0.0));
        out[0] = x * cos - y * sin;
        if let Some(second) = out.get_mut(1) {
            *second = x * sin + y * cos;
        }
    }
}

/// One road has this many points.
const ROAD_POINTS: u64 = 50;

/// Point `i` of the map: step i mod 50 of road i / 50, walked from its beginning.
///
/// On a map of unit width: the town with Zipf's probability (1 / rank), 0.01 around it, steps of 10⁻⁴·³ to 10⁻³·³,
/// turns of 0.08 radians.
fn road(seed: u64, i: u64, towns: u64) -> [f64; 2] {
    let mut random = stream(seed, i / ROAD_POINTS);
    // log(rank + 1) uniform: rank k has a probability of log((k + 1) / k), nearly 1 / k.
    let rank = (towns as f64 + 1.0).powf(random.random()) as u64;
    let mut town = stream_of_center(seed, (rank - 1).min(towns - 1));
    let mut at: [f64; 2] =
        std::array::from_fn(|_| town.random::<f64>() + 0.01 * normal(&mut random));
    let mut heading = FRAC_PI_2 * random.random_range(0..4) as f64 + 0.05 * normal(&mut random);
    let step = 10f64.powf(-4.3 + random.random::<f64>());
    for _ in 0..=i % ROAD_POINTS {
        heading += 0.08 * normal(&mut random);
        let (sin, cos) = heading.sin_cos();
        at = [at[0] + step * cos, at[1] + step * sin];
    }
    at.map(|v| (60e6 * v).round() / 1e6)
}
