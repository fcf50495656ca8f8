//! True curves of the noisy classes, as polylines.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{Point, Random};

/// A smooth closed curve with the way along it, on which strands are laid.
pub struct Base {
    points: Vec<Point>,
    along: Vec<f64>,
}

impl Base {
    pub fn of(points: Vec<Point>) -> Self {
        let count = points.len();
        let mut along = vec![0.0];
        for k in 0..count {
            let (p, q) = (points[k], points[(k + 1) % count]);
            along.push(along[k] + (p[0] - q[0]).hypot(p[1] - q[1]));
        }
        Self { points, along }
    }

    pub fn circle() -> Self {
        Self::of((0..4000).map(|k| TAU * k as f64 / 4000.0).map(|t| [t.cos(), t.sin()]).collect())
    }

    pub fn length(&self) -> f64 {
        self.along[self.points.len()]
    }

    /// The place at a way along, and off to the left.
    pub fn at(&self, [u, v]: Point) -> Point {
        let count = self.points.len();
        let u = u.rem_euclid(self.length());
        let k = (self.along.partition_point(|&a| a <= u) - 1).min(count - 1);
        let t = (u - self.along[k]) / (self.along[k + 1] - self.along[k]);
        let (p, q) = (self.points[k], self.points[(k + 1) % count]);
        let normal = |k: usize| {
            let (a, b) = (self.points[(k + count - 1) % count], self.points[(k + 1) % count]);
            let (x, y) = (b[0] - a[0], b[1] - a[1]);
            [-y / x.hypot(y), x / x.hypot(y)]
        };
        let (m, n) = (normal(k), normal((k + 1) % count));
        [0, 1].map(|i| p[i] + t * (q[i] - p[i]) + v * (m[i] + t * (n[i] - m[i])))
    }

    /// A path of ways along and off, closed: the rest of the curve is added.
    fn closed(&self, path: &[Point]) -> Vec<Point> {
        let (first, last) = (path[0], path[path.len() - 1]);
        let (from, rest) = (last[0], first[0] + self.length() - last[0]);
        let steps = 2000;
        let around = (1..steps).map(|k| [from + rest * f64::from(k) / f64::from(steps), 0.0]);
        path.iter().copied().chain(around).map(|p| self.at(p)).collect()
    }

    /// The curve without an arc from u of a length.
    pub fn without(&self, u: f64, gap: f64) -> Vec<Point> {
        let rest = self.length() - gap;
        (0..=3000).map(|k| self.at([u + gap + rest * f64::from(k) / 3000.0, 0.0])).collect()
    }

    /// At a distance to the left.
    pub fn offset(&self, v: f64) -> Vec<Point> {
        (0..3000).map(|k| self.at([self.length() * f64::from(k) / 3000.0, v])).collect()
    }

    /// Forth, back and forth again, three strands at a distance over a length.
    pub fn fold(&self, u: f64, length: f64, apart: f64, side: f64) -> Vec<Point> {
        let (a, b) = (u, u + length);
        let ramp = 6.0 * apart;
        let mut path = vec![];
        let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
        let mut line = |from: f64, to: f64, v: &dyn Fn(f64) -> f64| {
            for k in 0..=200 {
                let t = f64::from(k) / 200.0;
                path.push([from + t * (to - from), side * v(t)]);
            }
        };
        line(a - apart - ramp, a - apart, &|t| apart * smooth(t));
        line(a - apart, b, &|_| apart);
        // Hairpins.
        for k in 0..=60 {
            let turn = FRAC_PI_2 - PI * f64::from(k) / 60.0;
            path.push([b + apart / 2.0 * turn.cos(), side * apart / 2.0 * (1.0 + turn.sin())]);
        }
        for k in 0..=60 {
            let turn = FRAC_PI_2 + PI * f64::from(k) / 60.0;
            path.push([a + apart / 2.0 * turn.cos(), side * apart / 2.0 * (turn.sin() - 1.0)]);
        }
        let mut line = |from: f64, to: f64, v: &dyn Fn(f64) -> f64| {
            for k in 0..=200 {
                let t = f64::from(k) / 200.0;
                path.push([from + t * (to - from), side * v(t)]);
            }
        };
        line(a, b + apart, &|_| -apart);
        line(b + apart, b + apart + ramp, &|t| apart * (smooth(t) - 1.0));
        self.closed(&path)
    }

    /// Two strands at a distance that go off to one side up to a height, and back.
    pub fn finger(&self, u: f64, height: f64, apart: f64, side: f64) -> Vec<Point> {
        let round = apart / 2.0;
        let mut path = vec![];
        let mut arc = |center: Point, r: f64, from: f64, to: f64| {
            for k in 0..=40 {
                let turn = from + (to - from) * f64::from(k) / 40.0;
                path.push([center[0] + r * turn.cos(), side * (center[1] + r * turn.sin())]);
            }
        };
        arc([u - round - apart / 2.0, round], round, -FRAC_PI_2, 0.0);
        arc([u, height], apart / 2.0, PI, 0.0);
        arc([u + round + apart / 2.0, round], round, PI, PI + FRAC_PI_2);
        self.closed(&fine(&path, false, apart / 8.0))
    }
}

/// Vertices no farther apart than a step along the same polyline.
pub fn fine(chain: &[Point], closed: bool, step: f64) -> Vec<Point> {
    let count = chain.len();
    let mut out = vec![];
    for k in 0..count - usize::from(!closed) {
        let (a, b) = (chain[k], chain[(k + 1) % count]);
        let parts = ((a[0] - b[0]).hypot(a[1] - b[1]) / step).ceil().max(1.0);
        for part in 0..parts as usize {
            let t = part as f64 / parts;
            out.push([a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])]);
        }
    }
    if !closed {
        out.push(chain[count - 1]);
    }
    out
}

fn around(count: usize, at: impl Fn(f64) -> Point) -> Vec<Point> {
    (0..count).map(|k| at(TAU * k as f64 / count as f64)).collect()
}

pub fn ellipse(center: Point, a: f64, b: f64) -> Vec<Point> {
    around(3000, |t| [center[0] + a * t.cos(), center[1] + b * t.sin()])
}

/// Two bellies with a neck of a width between them.
pub fn neck(width: f64) -> Vec<Point> {
    let (a, b) = (0.5 + width / 4.0, 0.5 - width / 4.0);
    around(4000, |t| {
        let r = a + b * (2.0 * t).cos();
        [r * t.cos(), r * t.sin()]
    })
}

/// Two straight strands with round ends.
pub fn capsule(length: f64, width: f64) -> Vec<Point> {
    let r = width / 2.0;
    let mut out = vec![];
    for (x, from) in [(length / 2.0, -FRAC_PI_2), (-length / 2.0, FRAC_PI_2)] {
        for k in 0..=60 {
            let turn = from + PI * f64::from(k) / 60.0;
            out.push([x + r * turn.cos(), r * turn.sin()]);
        }
    }
    out
}

/// Two arcs of circles that meet at two corners, a width apart in the middle.
pub fn lens(width: f64) -> Vec<Point> {
    let r = (1.0 + width * width / 4.0) / width;
    let reach = (1.0 / r).asin();
    let upper = (0..1500).map(|k| reach * (1.0 - 2.0 * f64::from(k) / 1500.0));
    let upper: Vec<Point> = upper.map(|t| [r * t.sin(), r * t.cos() - r + width / 2.0]).collect();
    let lower = upper.iter().map(|&[x, y]| [-x, -y]);
    upper.iter().copied().chain(lower).collect()
}

/// A crescent of a thickness in its middle.
pub fn moon(thickness: f64) -> Vec<Point> {
    let reach = 0.75 * PI;
    let outer = (0..2000).map(|k| reach * (f64::from(k) / 1000.0 - 1.0));
    let inner = outer.clone().map(|t| (-t, 1.0 - thickness * (t / reach * FRAC_PI_2).cos()));
    outer.map(|t| (t, 1.0)).chain(inner).map(|(t, r)| [r * t.cos(), r * t.sin()]).collect()
}

/// An open spiral of so many turns, at a distance from each other.
pub fn spiral(turns: f64, apart: f64) -> Vec<Point> {
    let first = 1.0 - turns * apart;
    (0..=6000)
        .map(|k| turns * TAU * f64::from(k) / 6000.0)
        .map(|t| {
            let r = first + apart * t / TAU;
            [r * t.cos(), r * t.sin()]
        })
        .collect()
}

/// A circle with waves.
pub fn waves(count: usize, height: f64) -> Vec<Point> {
    around(6000, |t| {
        let r = 1.0 + height * (count as f64 * t).cos();
        [r * t.cos(), r * t.sin()]
    })
}

/// A regular polygon, or a star if every other corner is nearer to the middle.
pub fn polygon(corners: usize, inner: f64) -> Vec<Point> {
    let at = |k: usize| {
        let turn = TAU * k as f64 / corners as f64;
        let r = if k % 2 == 1 { inner } else { 1.0 };
        [r * turn.cos(), r * turn.sin()]
    };
    (0..corners).map(at).collect()
}

/// A curve that crosses itself.
pub fn eight(random: &mut Random) -> Vec<Point> {
    let (wide, k) = (random.between(0.4, 0.9), 2 + random.below(2));
    around(4000, |t| [t.cos(), wide * (k as f64 * t).sin()])
}
