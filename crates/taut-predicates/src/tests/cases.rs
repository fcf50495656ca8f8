//! Points that make trouble: ties, near ties, and the ends of the exponent range.

use crate::tests::Random;

/// `V` points of dimension `D`, and whether all coordinates are whole numbers.
pub(crate) struct Case<const D: usize, const V: usize> {
    pub(crate) points: [[f64; D]; V],
    pub(crate) integral: bool,
}

/// Integer points at one distance from the origin: x² + y² = 1105², or x² + y² + z² = 45².
pub(crate) fn lattice_sphere<const D: usize>() -> Vec<[f64; D]> {
    let radius: i64 = if D == 2 { 1105 } else { 45 };
    let mut found = Vec::new();
    for x in -radius..=radius {
        for y in -radius..=radius {
            let rest = radius * radius - x * x - y * y;
            if D == 2 {
                if rest == 0 {
                    found.push(std::array::from_fn(|i| [x, y][i] as f64));
                }
            } else if rest >= 0 {
                let z = (rest as f64).sqrt() as i64;
                if z * z == rest {
                    found.push(std::array::from_fn(|i| [x, y, z][i] as f64));
                    found.push(std::array::from_fn(|i| [x, y, -z][i] as f64));
                }
            }
        }
    }
    found
}

/// The kinds of `case`.
const KINDS: u64 = 14;

/// The case of this number; `sphere` is the lattice sphere of this dimension.
pub(crate) fn case<const D: usize, const V: usize>(
    number: u64,
    random: &mut Random,
    sphere: &[[f64; D]],
) -> Case<D, V> {
    let mut integral = false;
    let grid = |random: &mut Random, m: i64| -> [[f64; D]; V] {
        [(); V].map(|()| [(); D].map(|()| random.between(-m, m) as f64))
    };
    let on_sphere = |random: &mut Random| [(); V].map(|()| random.pick(sphere));
    let mut points: [[f64; D]; V] = match number % KINDS {
        0 => [(); V].map(|()| [(); D].map(|()| random.unit())),
        // Grids: tiny, as large as `f64` stays exact, and larger.
        1 => {
            integral = true;
            grid(random, 2)
        }
        2 => {
            integral = true;
            let m = random.pick(&[5, 300, 2600, 1 << 15, 1 << 25, 1 << 30, 1 << 52]);
            grid(random, m)
        }
        // Grids whose points are rounded, or far from the origin.
        3 => grid(random, 3).map(|p| p.map(|x| x * 0.1)),
        4 => {
            let step = random.pick(&[0.1, 1e-7, 1.0 / 3.0]);
            let from = random.pick(&[1e5, 431.0, -0.7]);
            grid(random, 3).map(|p| p.map(|x| from + x * step))
        }
        // Lattice points of a sphere: exact ties.
        5 => {
            integral = true;
            on_sphere(random)
        }
        6 => {
            let scale = random.pick(&[0.1, two_to(-30), two_to(500), 1e-100, two_to(-1060)]);
            on_sphere(random).map(|p| p.map(|x| x * scale))
        }
        // Lattice points of a sphere, turned: ties but for rounding.
        7 => {
            let (sin, cos) = (random.unit() * 3.0).sin_cos();
            on_sphere(random).map(|mut p| {
                (p[0], p[1]) = (cos * p[0] - sin * p[1], sin * p[0] + cos * p[1]);
                p
            })
        }
        // Neighbors on a sphere.
        8 => {
            let (start, width) = (random.unit() * 3.0, random.pick(&[1.0, 1e-3, 1e-7]));
            [(); V].map(|()| {
                let (sin, cos) = (start + random.unit() * width).sin_cos();
                let (sin2, cos2) = (start * 2.0 + random.unit() * width).sin_cos();
                std::array::from_fn(|i| match (D, i) {
                    (2, 0) => cos,
                    (2, _) => sin,
                    (_, 0) => cos * cos2,
                    (_, 1) => sin * cos2,
                    _ => sin2,
                })
            })
        }
        // Every coordinate of its own magnitude.
        9 => [(); V].map(|()| {
            [(); D].map(|()| {
                let exponent = random.between(-1000, 1000) as i32;
                random.unit() * 2f64.powi(exponent)
            })
        }),
        // Two magnitudes, 1e±300 among them.
        10 => {
            let scales =
                random.pick(&[[1e-300, 1e300], [1.0, 1e-20], [1e160, 1.0], [1e-40, 1e-41]]);
            grid(random, 1)
                .map(|p| p.map(|x| (x + random.pick(&[0.0, 0.3])) * random.pick(&scales)))
        }
        // Subnormal numbers, as whole multiples of the least one or of any.
        11 => {
            let m = random.pick(&[2, 40, 1 << 51]);
            grid(random, m).map(|p| p.map(|x| x * f64::from_bits(1)))
        }
        // Points of a line or a plane, but for rounding.
        12 => {
            let (from, u, v) = (random.unit(), random.unit(), random.unit());
            [(); V].map(|()| {
                let (s, t) = (random.unit(), if D == 2 { 0.0 } else { random.unit() });
                let mut i = 0.0;
                [(); D].map(|()| {
                    i += 1.0;
                    from + s * u * i + t * (v - i)
                })
            })
        }
        // Boxes: ties with a different magnitude on each axis.
        _ => {
            let scales = [(); D]
                .map(|()| random.unit() * 2f64.powi(random.pick(&[0, 0, 1, 20, -40, -200, 300])));
            grid(random, 1).map(|p| std::array::from_fn(|i| p[i] * scales[i]))
        }
    };
    // Every third case with one coordinate moved by a few units in the last place.
    if !integral && random.below(3) == 0 {
        let (i, j) = (random.below(V as u64) as usize, random.below(D as u64) as usize);
        for _ in 0..random.between(1, 3) {
            points[i][j] = points[i][j].next_up();
        }
    }
    // Cospherical triples are rare on other grids: every fourth time the query is a reflected vertex.
    if random.below(4) == 0 && V > D + 1 {
        points[D + 1] = std::array::from_fn(|i| points[0][i] + points[1][i] - points[2][i]);
        integral &= points[D + 1].iter().all(|x| x.abs() < (1u64 << 53) as f64);
    }
    Case { points, integral }
}

/// A power of two.
fn two_to(exponent: i32) -> f64 {
    2f64.powi(exponent)
}
