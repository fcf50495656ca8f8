//! Smooth scenes: one to five loops, sampled with gaps of 60 to 100 % of what the sampling ratio allows.

use taut_points::generate::curves::TestCurve;

use super::{Clean, Point, Random};

/// Loops with the distance of each vertex from the medial axis of all of them.
pub struct Scene {
    pub loops: Vec<Vec<Point>>,
    pub features: Vec<Vec<f64>>,
}

/// Vertices of each loop.
const VERTICES: usize = 1500;

/// The longest loop, in its least feature sizes: vertices are then at most a 16th of that apart.
const LENGTH_MAX: f64 = 90.0;

/// A random smooth loop with the least feature size 1, around the origin.
pub fn smooth_loop(random: &mut Random, length_max: f64, vertices: usize) -> Vec<Point> {
    loop {
        let curve = TestCurve::random(random.bits() >> 20);
        let found = curve.build_with(400);
        if found.length() <= length_max {
            let mut points = curve.build_with(vertices).loops.swap_remove(0);
            let count = points.len() as f64;
            let middle = [0, 1].map(|k| points.iter().map(|p| p[k]).sum::<f64>() / count);
            points.iter_mut().for_each(|p| *p = [p[0] - middle[0], p[1] - middle[1]]);
            return points;
        }
    }
}

/// The largest distance from the origin.
pub fn radius(points: &[Point]) -> f64 {
    points.iter().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max)
}

impl Scene {
    /// Loops of several sizes, none of which meets another; one of three scenes has a loop around all others.
    pub fn draw(seed: u64) -> Self {
        let mut random = Random::of(1, seed);
        let count = 1 + random.below(5);
        let is_nested = count > 1 && random.is_one_of(3);
        let mut disks: Vec<(Point, f64)> = vec![];
        let mut loops = vec![];
        while loops.len() < count - usize::from(is_nested) {
            let size = random.log_between(0.3, 1.0);
            let at = [random.between(-2.0, 2.0), random.between(-2.0, 2.0)];
            let gap = random.log_between(0.02, 0.5);
            let is_free = |(other, radius): &(Point, f64)| {
                (at[0] - other[0]).hypot(at[1] - other[1]) > radius + size * (1.0 + gap)
            };
            if disks.iter().all(is_free) {
                disks.push((at, size));
                let shape = smooth_loop(&mut random, LENGTH_MAX, VERTICES);
                let scale = size / radius(&shape);
                let moved = |p: &Point| [at[0] + scale * p[0], at[1] + scale * p[1]];
                loops.push(shape.iter().map(moved).collect::<Vec<Point>>());
            }
        }
        if is_nested {
            let far = loops.iter().flatten().map(|p| p[0].hypot(p[1])).fold(0.0, f64::max);
            let (waves, height) = (2 + random.below(6), random.between(0.0, 0.06));
            let at = |k: usize| {
                let turn = std::f64::consts::TAU * k as f64 / VERTICES as f64;
                let r = far * 1.12 * (1.0 + height * (waves as f64 * turn).cos());
                [r * turn.cos(), r * turn.sin()]
            };
            loops.push((0..VERTICES).map(at).collect());
        }
        let features = features(&loops);
        Self { loops, features }
    }

    /// Samples at a ratio ε, gaps of a share of at least 60 % of the largest that serves all vertices between.
    pub fn sample(&self, epsilon: f64, seed: u64) -> Clean {
        let mut random = Random::of(2, seed);
        let mut chains = vec![];
        for (vertices, features) in self.loops.iter().zip(&self.features) {
            let count = vertices.len();
            let serves = |a: usize, x: usize| {
                let (p, q) = (vertices[a % count], vertices[x % count]);
                (p[0] - q[0]).hypot(p[1] - q[1]) <= 0.98 * epsilon * features[x % count]
            };
            let bridges = |a: usize, b: usize| (a + 1..b).all(|x| serves(a, x) || serves(b, x));
            let start = random.below(count);
            let (mut at, mut chain) = (start, vec![]);
            while at < start + count {
                chain.push(vertices[at % count]);
                let mut next = at + 1;
                while next < start + count && bridges(at, next + 1) {
                    next += 1;
                }
                let share = random.between(0.6, 1.0);
                at += (((next - at) as f64 * share) as usize).max(1);
            }
            chains.push((chain, true));
        }
        Clean::of(&chains, &mut random)
    }
}

/// For each vertex the distance from the medial axis: the centers of the largest empty disks that touch at some vertex.
fn features(loops: &[Vec<Point>]) -> Vec<Vec<f64>> {
    let all: Vec<Point> = loops.iter().flatten().copied().collect();
    let mut centers = vec![];
    for vertices in loops {
        let count = vertices.len();
        for (k, p) in vertices.iter().enumerate() {
            let (a, b) = (vertices[(k + count - 1) % count], vertices[(k + 1) % count]);
            let (tx, ty) = (b[0] - a[0], b[1] - a[1]);
            let normal = [-ty / tx.hypot(ty), tx / tx.hypot(ty)];
            // 1 / 2R on either side: the largest of n·w / |w|².
            let (mut left, mut right) = (0.0f64, 0.0f64);
            for q in &all {
                let (x, y) = (q[0] - p[0], q[1] - p[1]);
                let square = x * x + y * y;
                if square > 0.0 {
                    let bend = (normal[0] * x + normal[1] * y) / square;
                    (left, right) = (left.max(bend), right.max(-bend));
                }
            }
            for (side, bend) in [(1.0, left), (-1.0, right)] {
                if bend > 0.0 {
                    let r = side * 0.5 / bend;
                    centers.push([p[0] + r * normal[0], p[1] + r * normal[1]]);
                }
            }
        }
    }
    let of = |p: &Point| {
        let near = |least: f64, c: &Point| {
            let (x, y) = (p[0] - c[0], p[1] - c[1]);
            least.min(x * x + y * y)
        };
        centers.iter().fold(f64::INFINITY, near).sqrt()
    };
    loops.iter().map(|vertices| vertices.iter().map(of).collect()).collect()
}
