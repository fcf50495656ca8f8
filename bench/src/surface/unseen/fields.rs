//! Bodies as the places where a function is negative. It is nowhere steeper than a distance, so its magnitude is a safe step along a ray.

use super::*;

/// A body. Boxes, cylinders and rings lie around the origin.
#[derive(Clone, Debug)]
pub(super) enum Field {
    Ball(f64),
    /// Half the sides.
    Slab(Point),
    /// Around the z axis: the radius, and half the height.
    Drum(f64, f64),
    /// Around the z axis: the radius of the circle in the middle, and that of the tube.
    Ring(f64, f64),
    Tube(Tube),
    /// Below the graph of a height over the plane of x and y.
    Terrain(Terrain),
    /// The gyroid of this period.
    Gyroid(f64),
    /// In any of them.
    Any(Vec<Field>),
    /// In the first and in none of the others.
    Cut(Vec<Field>),
    /// In any of them, with fillets about this wide.
    Blend(f64, Vec<Field>),
    /// In both, with fillets about this wide.
    Meet(f64, Box<[Field; 2]>),
    /// Moved to a place.
    At(Point, Box<Field>),
    /// Turned: the rows are the axes of the body.
    Turned([Point; 3], Box<Field>),
}

/// What is within a radius of a polygonal line.
#[derive(Clone, Debug)]
pub(super) struct Tube {
    line: Vec<Point>,
    radius: f64,
    /// For some segments at a time a ball around them.
    balls: Vec<(Point, f64)>,
}

/// A height over the plane of x and y: a sum of waves, steps and dents.
#[derive(Clone, Debug, Default)]
pub(super) struct Terrain {
    /// Of each wave the height, the two wave numbers and the phase.
    pub(super) waves: Vec<[f64; 4]>,
    /// Of each step the direction in which it rises, its distance from the origin, height and half width.
    pub(super) steps: Vec<[f64; 4]>,
    /// Of each dent the place, depth and width.
    pub(super) dents: Vec<[f64; 4]>,
}

/// Segments under one ball.
const RUN: usize = 8;

pub(super) fn minus(a: Point, b: Point) -> Point {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}

impl Tube {
    pub(super) fn new(line: Vec<Point>, radius: f64) -> Self {
        let balls = (0..line.len() - 1).step_by(RUN).map(|begin| {
            let some = &line[begin..=(begin + RUN).min(line.len() - 1)];
            let middle = [0, 1, 2].map(|k| some.iter().map(|p| p[k]).sum::<f64>());
            let middle = middle.map(|x| x / some.len() as f64);
            let reach = some.iter().map(|&p| length(minus(p, middle))).fold(0.0, f64::max);
            (middle, reach)
        });
        Self { balls: balls.collect(), line, radius }
    }

    fn value(&self, p: Point) -> f64 {
        let mut least = f64::INFINITY;
        for (run, &(middle, reach)) in self.balls.iter().enumerate() {
            if length(minus(p, middle)) - reach >= least {
                continue;
            }
            let end = ((run + 1) * RUN).min(self.line.len() - 1);
            for pair in self.line[run * RUN..=end].windows(2) {
                let (u, v) = (minus(pair[1], pair[0]), minus(p, pair[0]));
                let t = (dot(u, v) / dot(u, u)).clamp(0.0, 1.0);
                least = least.min(length(minus(v, u.map(|x| t * x))));
            }
        }
        least - self.radius
    }
}

impl Terrain {
    fn height(&self, x: f64, y: f64) -> f64 {
        let wave = |&[high, j, k, phase]: &[f64; 4]| high * (j * x + k * y + phase).sin();
        let step = |&[angle, far, high, wide]: &[f64; 4]| {
            let (sin, cos) = angle.sin_cos();
            0.5 * high * ((cos * x + sin * y - far) / wide).tanh()
        };
        let dent = |&[u, v, deep, wide]: &[f64; 4]| {
            -deep * (-((x - u).powi(2) + (y - v).powi(2)) / (wide * wide)).exp()
        };
        self.waves.iter().map(wave).sum::<f64>()
            + self.steps.iter().map(step).sum::<f64>()
            + self.dents.iter().map(dent).sum::<f64>()
    }

    /// A bound on the slope.
    fn slope(&self) -> f64 {
        let wave = |[high, j, k, _]: &[f64; 4]| (high * j.hypot(*k)).abs();
        let step = |[_, _, high, wide]: &[f64; 4]| (0.5 * high / wide).abs();
        // exp(−r²) falls by at most √(2/e).
        let dent = |[_, _, deep, wide]: &[f64; 4]| 0.86 * (deep / wide).abs();
        self.waves.iter().map(wave).sum::<f64>()
            + self.steps.iter().map(step).sum::<f64>()
            + self.dents.iter().map(dent).sum::<f64>()
    }

    fn value(&self, [x, y, z]: Point) -> f64 {
        (z - self.height(x, y)) / 1f64.hypot(self.slope())
    }
}

impl Field {
    pub(super) fn at(self, place: Point) -> Self {
        Field::At(place, Box::new(self))
    }

    /// Turned by an angle about an axis.
    pub(super) fn about(self, axis: usize, angle: f64) -> Self {
        let (sin, cos) = angle.sin_cos();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut rows = [[0.0; 3]; 3];
        rows[axis][axis] = 1.0;
        (rows[i][i], rows[i][j], rows[j][i], rows[j][j]) = (cos, sin, -sin, cos);
        Field::Turned(rows, Box::new(self))
    }

    /// Negative inside.
    pub(super) fn value(&self, p: Point) -> f64 {
        match self {
            Field::Ball(radius) => length(p) - radius,
            Field::Slab(half) => {
                let off = [0, 1, 2].map(|k| p[k].abs() - half[k]);
                let within = off[0].max(off[1]).max(off[2]).min(0.0);
                length(off.map(|x| x.max(0.0))) + within
            }
            Field::Drum(radius, half) => {
                let (across, along) = (p[0].hypot(p[1]) - radius, p[2].abs() - half);
                across.max(0.0).hypot(along.max(0.0)) + across.max(along).min(0.0)
            }
            Field::Ring(radius, tube) => (p[0].hypot(p[1]) - radius).hypot(p[2]) - tube,
            Field::Tube(tube) => tube.value(p),
            Field::Terrain(terrain) => terrain.value(p),
            Field::Gyroid(period) => {
                let k = TAU / period;
                let [x, y, z] = p.map(|x| (k * x).sin_cos());
                // Its gradient is at most √3·k long.
                (x.0 * y.1 + y.0 * z.1 + z.0 * x.1) / (3f64.sqrt() * k)
            }
            Field::Any(all) => all.iter().map(|one| one.value(p)).fold(f64::INFINITY, f64::min),
            Field::Cut(all) => {
                let off = all[1..].iter().map(|one| -one.value(p));
                off.fold(all[0].value(p), f64::max)
            }
            Field::Blend(width, all) => {
                let sum = all.iter().map(|one| (-one.value(p) / width).exp()).sum::<f64>();
                -width * sum.ln()
            }
            Field::Meet(width, both) => {
                let sum = both.iter().map(|one| (one.value(p) / width).exp()).sum::<f64>();
                width * sum.ln()
            }
            Field::At(place, body) => body.value(minus(p, *place)),
            Field::Turned(rows, body) => body.value(rows.map(|row| dot(row, p))),
        }
    }

    /// The direction in which it grows most.
    pub(super) fn normal(&self, p: Point) -> Point {
        const STEP: f64 = 1e-6;
        let slope = [0, 1, 2].map(|k| {
            let mut ends = [p, p];
            ends[0][k] -= STEP;
            ends[1][k] += STEP;
            self.value(ends[1]) - self.value(ends[0])
        });
        let size = length(slope).max(f64::MIN_POSITIVE);
        slope.map(|x| x / size)
    }
}

/// The parts of the surface and all their handles, from a cubic grid of this many steps between −`reach` and `reach`.
///
/// Each cube is six tetrahedra around its diagonal. The body is what the grid points in it span, with the Euler characteristic χ; its
/// surface has 2χ, and as many parts as body and outside together, less one (Alexander's duality).
pub(super) fn counted(field: &Field, level: f64, reach: f64, steps: usize) -> (usize, u64) {
    let side = steps + 1;
    let at = |k: usize| 2.0 * reach * k as f64 / steps as f64 - reach;
    let is_in: Vec<bool> = (0..side * side * side)
        .map(|i| field.value([at(i % side), at(i / side % side), at(i / side / side)]) < level)
        .collect();
    let mut parent: Vec<u32> = (0..is_in.len() as u32).collect();
    fn root(parent: &mut [u32], mut node: u32) -> u32 {
        while parent[node as usize] != node {
            parent[node as usize] = parent[parent[node as usize] as usize];
            node = parent[node as usize];
        }
        node
    }
    // Simplices are the chains of cube corners that only rise.
    let rises = |from: usize, to: usize| from & to == from && from != to;
    let mut euler = 0i64;
    for i in 0..is_in.len() {
        let place = [i % side, i / side % side, i / side / side];
        let corner = |bits: usize| {
            let on = [0, 1, 2].map(|k| place[k] + (bits >> k & 1));
            (on.iter().all(|&x| x < side)).then(|| on[0] + side * (on[1] + side * on[2]))
        };
        let within = |bits: usize| corner(bits).is_some_and(|j| is_in[j]);
        for bits in 1..8 {
            if let Some(j) = corner(bits)
                && is_in[j] == is_in[i]
            {
                let (a, b) = (root(&mut parent, i as u32), root(&mut parent, j as u32));
                parent[a.max(b) as usize] = a.min(b);
            }
        }
        if !is_in[i] {
            continue;
        }
        euler += 1;
        for a in (1..8).filter(|&a| within(a)) {
            euler -= 1;
            for b in (1..8).filter(|&b| rises(a, b) && within(b)) {
                euler += 1;
                euler -= (1..8).filter(|&c| rises(b, c) && within(c)).count() as i64;
            }
        }
    }
    let parts = (0..parent.len()).filter(|&node| parent[node] == node as u32).count() - 1;
    (parts, (parts as i64 - euler).max(0) as u64)
}
