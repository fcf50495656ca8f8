//! Whether found curves are the true ones: as many, closed where those are, once around each, without turning back or leaving out.

use std::collections::HashMap;

use taut_certify::Curve;

use super::{Clean, Noisy, Point};

/// How far a curve may seem to go back along the truth, over the half-width: noise moves it that far.
const BACK_MAX: f64 = 3.0;

/// How much of the truth it may leave out at once, over the half-width: it cuts hairpins off.
const LEAP_MAX: f64 = 8.0;

/// Found edges as pairs of rows, the smaller one first, ascending.
pub fn edges(found: &Curve) -> Vec<[u32; 2]> {
    let mut edges = vec![];
    for one in &found.curves {
        let count = one.rows.len() - usize::from(!one.closed && !one.rows.is_empty());
        let next = one.rows.iter().cycle().skip(1);
        edges.extend(
            one.rows
                .iter()
                .zip(next)
                .take(count)
                .map(|(&a, &b)| [a.min(b) as u32, a.max(b) as u32]),
        );
    }
    edges.sort_unstable();
    edges
}

impl Clean {
    pub fn is_exact(&self, found: &Curve) -> bool {
        edges(found) == self.edges
    }

    /// The share of the true edges that were found.
    pub fn recall(&self, found: &Curve) -> f64 {
        let found = edges(found);
        let right = self.edges.iter().filter(|edge| found.binary_search(edge).is_ok()).count();
        right as f64 / self.edges.len() as f64
    }
}

/// The vertices of the truth in buckets.
struct Nearest<'a> {
    truth: &'a [(Vec<Point>, bool)],
    side: f64,
    cells: HashMap<[i64; 2], Vec<(u32, u32)>>,
    /// The way along each curve at each vertex, and all of it at the end.
    along: Vec<Vec<f64>>,
}

impl<'a> Nearest<'a> {
    fn of(truth: &'a [(Vec<Point>, bool)], side: f64) -> Self {
        let mut cells: HashMap<[i64; 2], Vec<(u32, u32)>> = HashMap::new();
        let mut along = vec![];
        for (curve, (vertices, closed)) in truth.iter().enumerate() {
            let (mut way, mut ways) = (0.0, vec![]);
            for (k, p) in vertices.iter().enumerate() {
                let cell = p.map(|x| (x / side).floor() as i64);
                cells.entry(cell).or_default().push((curve as u32, k as u32));
                ways.push(way);
                let next = vertices[(k + 1) % vertices.len()];
                if *closed || k + 1 < vertices.len() {
                    way += (p[0] - next[0]).hypot(p[1] - next[1]);
                }
            }
            ways.push(way);
            along.push(ways);
        }
        Self { truth, side, cells, along }
    }

    /// Curve and way along it of the nearest vertex; none where it is farther than forty sides.
    fn find(&self, p: Point) -> Option<(u32, f64)> {
        let [x, y] = p.map(|x| (x / self.side).floor() as i64);
        let (mut best, mut found) = (f64::INFINITY, None);
        for ring in 0..40i64 {
            if best <= (ring - 1).max(0) as f64 * self.side {
                break;
            }
            for i in -ring..=ring {
                let step = if i.abs() == ring { 1 } else { (2 * ring).max(1) };
                let mut j = -ring;
                while j <= ring {
                    for &(curve, k) in self.cells.get(&[x + i, y + j]).into_iter().flatten() {
                        let q = self.truth[curve as usize].0[k as usize];
                        let apart = (p[0] - q[0]).hypot(p[1] - q[1]);
                        if apart < best {
                            best = apart;
                            found = Some((curve, self.along[curve as usize][k as usize]));
                        }
                    }
                    j += step;
                }
            }
        }
        found
    }
}

impl Noisy {
    pub fn values(&self) -> Vec<f64> {
        self.points.as_flattened().to_vec()
    }

    /// Whether the curves are right.
    pub fn is_right(&self, found: &Curve) -> bool {
        if found.curves.len() != self.truth.len() {
            return false;
        }
        let nearest = Nearest::of(&self.truth, self.half_width);
        let mut seen = vec![false; self.truth.len()];
        for one in &found.curves {
            let Some(curve) = self.followed(&nearest, &one.vertices, one.closed) else {
                return false;
            };
            if std::mem::replace(&mut seen[curve], true) {
                return false;
            }
        }
        true
    }

    /// The true curve that vertices follow from beginning to end, if they do.
    fn followed(&self, nearest: &Nearest<'_>, vertices: &[Point], closed: bool) -> Option<usize> {
        let mut fine = vec![];
        let count = vertices.len();
        for k in 0..count - usize::from(!closed) {
            let (a, b) = (vertices[k], vertices[(k + 1) % count]);
            let length = (a[0] - b[0]).hypot(a[1] - b[1]);
            let parts = (2.0 * length / self.half_width).ceil().clamp(1.0, 1e4);
            for part in 0..parts as usize {
                let t = part as f64 / parts;
                fine.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
            }
        }
        fine.push(if closed { vertices[0] } else { vertices[count - 1] });
        let places: Vec<(u32, f64)> =
            fine.iter().map(|&p| nearest.find(p)).collect::<Option<_>>()?;
        let curve = places[0].0 as usize;
        let (_, is_loop) = self.truth[curve];
        if is_loop != closed || places.iter().any(|place| place.0 as usize != curve) {
            return None;
        }
        let whole = nearest.along[curve][self.truth[curve].0.len()];
        let steps: Vec<f64> = places
            .windows(2)
            .map(|pair| {
                let step = pair[1].1 - pair[0].1;
                if is_loop { step - whole * (step / whole).round() } else { step }
            })
            .collect();
        let total: f64 = steps.iter().sum();
        let sign = total.signum();
        let (mut way, mut farthest) = (0.0f64, 0.0f64);
        for step in &steps {
            if sign * step > (LEAP_MAX + 1.0) * self.half_width {
                return None;
            }
            way += sign * step;
            farthest = farthest.max(way);
            if farthest - way > BACK_MAX * self.half_width {
                return None;
            }
        }
        let slack = if is_loop { 1e-6 * whole } else { 0.1 * whole };
        ((total.abs() - whole).abs() <= slack).then_some(curve)
    }
}
