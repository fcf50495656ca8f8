//! Tests what the tests of points left out compare with: all circles through two and three points, and the smallest circle by
//! adding one point after the other.
#![allow(unreachable_pub)] // included by a test binary

/// A center and a radius.
#[derive(Clone, Copy, Debug)]
pub struct Circle {
    pub center: [f64; 2],
    pub radius: f64,
}

/// A circle may be off by this: determinants of triangles lose some digits.
const CIRCLE_TOLERANCE: f64 = 1e-10;

impl Circle {
    pub fn holds(&self, p: [f64; 2]) -> bool {
        distance(self.center, p) <= self.radius * (1.0 + CIRCLE_TOLERANCE) + 1e-14
    }
}

pub fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    f64::hypot(a[0] - b[0], a[1] - b[1])
}

/// The smallest circle that goes through all of up to three points; none if there is no such circle.
pub fn through(points: &[[f64; 2]]) -> Option<Circle> {
    let of = |center: [f64; 2]| {
        let radius = points.iter().map(|&p| distance(center, p)).fold(0.0, f64::max);
        Circle { center, radius }
    };
    match *points {
        [] => None,
        [a] => Some(of(a)),
        [a, b] => Some(of([(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0])),
        [a, b, c, ..] => {
            let ([bx, by], [cx, cy]) = ([b[0] - a[0], b[1] - a[1]], [c[0] - a[0], c[1] - a[1]]);
            let twice = 2.0 * (bx * cy - by * cx);
            let (bb, cc) = (bx * bx + by * by, cx * cx + cy * cy);
            if twice.abs() <= 1e-12 * bb.max(cc) {
                return None;
            }
            let center = [(cy * bb - by * cc) / twice, (bx * cc - cx * bb) / twice];
            Some(of([a[0] + center[0], a[1] + center[1]]))
        }
    }
}

/// The least radius of k circles that hold all of at most 64 points but z: a smallest circle goes through two or three
/// points, and of those no larger than some radius k are tried in all ways.
pub fn brute_force(points: &[[f64; 2]], k: usize, z: usize) -> f64 {
    let n = points.len();
    let mut circles: Vec<(f64, u64)> = vec![];
    for i in 0..n {
        for j in 0..=i {
            for l in 0..=j {
                let few = [points[i], points[j], points[l]];
                let few = if l < j && j < i { &few[..] } else { &few[..if j < i { 2 } else { 1 }] };
                if let Some(circle) = through(few) {
                    let held = (0..n).filter(|&i| circle.holds(points[i]));
                    circles.push((circle.radius, held.fold(0, |all, i| all | 1 << i)));
                }
            }
        }
    }
    circles.sort_by(|a, b| a.0.total_cmp(&b.0));
    let is_enough = |count: usize| {
        // Of sets that other sets hold none is needed.
        let mut sets: Vec<u64> = circles[..count].iter().map(|circle| circle.1).collect();
        sets.sort_unstable_by_key(|set| std::cmp::Reverse(set.count_ones()));
        let mut largest: Vec<u64> = vec![];
        for set in sets {
            if !largest.iter().any(|other| set & !other == 0) {
                largest.push(set);
            }
        }
        reached(&largest, 0, k, (n - z) as u32)
    };
    // The fewest circles that are enough.
    let (mut low, mut high) = (1, circles.len());
    while low < high {
        let middle = (low + high) / 2;
        if is_enough(middle) { high = middle } else { low = middle + 1 }
    }
    circles[low - 1].0
}

/// Returns true if `k` of the sets and `held` have so many members together.
fn reached(sets: &[u64], held: u64, k: usize, wanted: u32) -> bool {
    held.count_ones() >= wanted
        || k > 0 && (0..sets.len()).any(|i| reached(&sets[i + 1..], held | sets[i], k - 1, wanted))
}

/// The smallest circle of points in random order, and the points on it: each point that the circle of those before does not
/// hold is on the circle of them all.
pub fn smallest(points: &[[f64; 2]]) -> (Circle, Vec<[f64; 2]>) {
    fn with(points: &[[f64; 2]], on: &[[f64; 2]]) -> (Circle, Vec<[f64; 2]>) {
        let none = Circle { center: [0.0; 2], radius: -1.0 };
        let mut found = (through(on).unwrap_or(none), on.to_vec());
        if on.len() == 3 {
            return found;
        }
        for (i, &p) in points.iter().enumerate() {
            if found.0.radius < 0.0 || !found.0.holds(p) {
                found = with(&points[..i], &[on, &[p]].concat());
            }
        }
        found
    }
    with(points, &[])
}

/// The least radius of one circle that holds all points but z, for each z up to `z_max`: a smaller circle than the smallest
/// has to leave out one of the points on that.
pub fn one_without(points: &[[f64; 2]], z_max: usize) -> Vec<f64> {
    fn go_on(points: &[[f64; 2]], left_out: usize, best: &mut [f64]) {
        let (circle, on) = smallest(points);
        for radius in &mut best[left_out..] {
            *radius = radius.min(circle.radius);
        }
        if left_out + 1 == best.len() {
            return;
        }
        for out in on {
            let rest: Vec<[f64; 2]> = points.iter().copied().filter(|&p| p != out).collect();
            go_on(&rest, left_out + 1, best);
        }
    }
    let mut best = vec![f64::INFINITY; z_max + 1];
    go_on(points, 0, &mut best);
    best
}
