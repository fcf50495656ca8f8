//! Samples of curves whose truth is known: by the noise model of the thesis, and without noise at a bounded sampling ratio.

use crate::parallel::ParallelSlice;
use rand::RngExt;

use super::super::draw::{normal, stream};
use super::super::shuffle::shuffled;
use super::TruthCurves;

/// Rows that one thread draws in a row.
const CHUNK: usize = 4096;

/// The way in which samples differ from points of the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CurveNoise {
    /// δ: the largest shift along the normal, or its standard deviation. In units of the least local feature size; default 0.
    pub delta: f64,
    /// True if the shift is normal instead of uniform in [−δ, δ]; default false.
    pub gaussian: bool,
    /// True if samples are as dense everywhere along the curve; default false: density proportional to 1/f.
    pub uniform_arc: bool,
    /// Share of the rows that have nothing to do with the curve: uniform in the box around it and its noise. Default 0.
    pub outliers: f64,
}

/// Rows drawn near curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveSample {
    /// The points, n × 2.
    pub points: Vec<f64>,
    /// States whether each row is one of the outliers.
    pub outlier: Vec<bool>,
}

/// Rows drawn on curves.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EpsilonSample {
    /// The points, n × 2, in a random order.
    pub points: Vec<f64>,
    /// The rows of neighbors along the curves, the lesser first, ascending.
    pub edges: Vec<[u32; 2]>,
}

/// Draws n rows: a place on the curve by the law of density, and a shift along the normal there.
///
/// Row i depends on the curve, the noise, the seed and i; which rows are outliers also on n. As many as `outliers·n`, rounded, are.
///
/// ```
/// use taut_points::generate::curves::{CurveNoise, TestCurve, sample_curve};
/// let truth = TestCurve::named("flower5").unwrap().build();
/// let noise = CurveNoise { delta: 0.05, outliers: 0.1, ..CurveNoise::default() };
/// let sample = sample_curve(&truth, 1000, &noise, 42);
/// assert_eq!(sample.points.len(), 2000);
/// assert_eq!(sample.outlier.iter().filter(|&&outlier| outlier).count(), 100);
/// ```
pub fn sample_curve(truth: &TruthCurves, n: usize, noise: &CurveNoise, seed: u64) -> CurveSample {
    let law = Law::new(truth, n as u64, *noise, seed);
    let mut sample = CurveSample { points: vec![0.0; 2 * n], outlier: vec![false; n] };
    sample
        .points
        .par_chunks_mut(2 * CHUNK)
        .zip(sample.outlier.par_chunks_mut(CHUNK))
        .enumerate()
        .for_each(|(chunk, (points, outlier))| {
            let rows = points.chunks_exact_mut(2).zip(outlier);
            for (row, (point, outlier)) in ((chunk * CHUNK) as u64..).zip(rows) {
                let drawn = law.draw(truth, row);
                point.copy_from_slice(&drawn.0);
                *outlier = drawn.1;
            }
        });
    sample
}

/// The data that are the same for all rows.
#[derive(Clone, Debug)]
pub(super) struct Law {
    /// Edges of the curves: curve, number of the first point, and weight of all up to this one.
    edges: Vec<(usize, usize, f64)>,
    /// Box of the curves and their noise.
    low: [f64; 2],
    high: [f64; 2],
    n: u64,
    outliers: u64,
    noise: CurveNoise,
    seed: u64,
}

impl Law {
    pub(super) fn new(truth: &TruthCurves, n: u64, noise: CurveNoise, seed: u64) -> Self {
        let mut sum = 0.0;
        let edges = truth.edges(noise.uniform_arc).map(|(curve, i, weight)| {
            sum += weight;
            (curve, i, sum)
        });
        let edges = edges.collect();
        let reach = noise.delta * if noise.gaussian { 3.0 } else { 1.0 };
        let [mut low, mut high] = [truth.loops[0][0]; 2];
        for p in truth.loops.iter().flatten() {
            low = [low[0].min(p[0] - reach), low[1].min(p[1] - reach)];
            high = [high[0].max(p[0] + reach), high[1].max(p[1] + reach)];
        }
        let outliers = (noise.outliers * n as f64).round() as u64;
        Law { edges, low, high, n, outliers, noise, seed }
    }

    /// A row, and whether it is an outlier.
    pub(super) fn draw(&self, truth: &TruthCurves, row: u64) -> ([f64; 2], bool) {
        let Law { ref edges, low, high, noise, .. } = *self;
        let mut random = stream(self.seed, row);
        if self.outliers > 0 && shuffled(self.seed, row, self.n - 1) < self.outliers {
            let point = [0, 1].map(|k| low[k] + (high[k] - low[k]) * random.random::<f64>());
            return (point, true);
        }
        let sum = edges.last().map_or(0.0, |edge| edge.2);
        let place = sum * random.random::<f64>();
        let edge = edges.partition_point(|&(_, _, end)| end <= place).min(edges.len() - 1);
        let (curve, i, _) = edges[edge];
        let (p, across) = truth.on_curve(curve, i, random.random());
        let shift =
            if noise.gaussian { normal(&mut random) } else { 2.0 * random.random::<f64>() - 1.0 };
        let shift = noise.delta * shift;
        ([p[0] + shift * across[0], p[1] + shift * across[1]], false)
    }
}

/// Draws points of the curves so that each point x of them has one within ε·f(x), counted along the same stretch of the curve; as
/// few as that takes on about half of the stretches, more on the others.
///
/// Greedy: the next point is as far as the allowance lets it, or a random share of that. f is taken 2 % smaller than it was
/// measured, for the error of the measurement and the gaps between the points at which it was.
///
/// # Panics
/// If ε is not in (0, 1).
pub fn epsilon_sample(truth: &TruthCurves, epsilon: f64, seed: u64) -> EpsilonSample {
    assert!(epsilon > 0.0 && epsilon < 1.0, "a sampling ratio is in (0, 1), not {epsilon}");
    let mut random = stream(seed, 1);
    let mut points: Vec<[f64; 2]> = Vec::new();
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for (curve, vertices) in truth.loops.iter().enumerate() {
        let walk = Walk { vertices, features: &truth.features[curve], epsilon };
        let (n, closed, first) = (vertices.len(), truth.closed[curve], points.len() as u32);
        let start = if closed { random.random_range(0..n) } else { 0 };
        let end = start + if closed { n } else { n - 1 };
        let mut at = start;
        points.push(vertices[at % n]);
        while at < end {
            let farthest = walk.farthest(at, end);
            let share = if random.random() { 1.0 } else { 0.1 + 0.9 * random.random::<f64>() };
            at = (at + ((farthest - at) as f64 * share) as usize).max(at + 1);
            if at < end || !closed {
                points.push(vertices[at % n]);
            }
        }
        let last = points.len() as u32 - 1;
        edges.extend((first..last).map(|i| [i, i + 1]));
        if closed {
            edges.push([first, last]);
        }
    }
    let n = points.len() as u64;
    let row: Vec<u32> = (0..n).map(|i| shuffled(seed, i, n - 1) as u32).collect();
    let mut sample = EpsilonSample { points: vec![0.0; 2 * points.len()], edges };
    for (point, &row) in points.iter().zip(&row) {
        sample.points[2 * row as usize..][..2].copy_from_slice(point);
    }
    for edge in &mut sample.edges {
        let [a, b] = edge.map(|i| row[i as usize]);
        *edge = [a.min(b), a.max(b)];
    }
    sample.edges.sort_unstable();
    sample
}

/// Steps along one curve.
struct Walk<'a> {
    vertices: &'a [[f64; 2]],
    features: &'a [f64],
    epsilon: f64,
}

impl Walk<'_> {
    /// Returns true if the sample at vertex `a` serves vertex x.
    fn serves(&self, a: usize, x: usize) -> bool {
        let n = self.vertices.len();
        let (p, q) = (self.vertices[a % n], self.vertices[x % n]);
        (p[0] - q[0]).hypot(p[1] - q[1]) <= 0.98 * self.epsilon * self.features[x % n]
    }

    /// Returns true if samples at a and b alone serve all between.
    fn bridges(&self, a: usize, b: usize) -> bool {
        (a + 1..b).all(|x| self.serves(a, x) || self.serves(b, x))
    }

    /// The farthest vertex up to `end` that may come next after a.
    fn farthest(&self, a: usize, end: usize) -> usize {
        let (mut good, mut step) = (a + 1, 2);
        while a + step <= end && self.bridges(a, a + step) {
            good = a + step;
            step *= 2;
        }
        let mut bad = (a + step).min(end + 1);
        while bad - good > 1 {
            let middle = good + (bad - good) / 2;
            if self.bridges(a, middle) { good = middle } else { bad = middle }
        }
        good
    }
}
