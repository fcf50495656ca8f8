//! The circle in a polygon, in fractions.
//!
//! *Decided.* Whether the center is inside by the even-odd rule, and no edge is nearer than the radius: exact. Whether no circle is
//! larger than the upper bound: refuted by any center inside with a larger clearance. The best center of a search in plain
//! arithmetic, on a grid and from it to points that are equally far from three edges, is checked in fractions.

use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::certify::{CircleVerdict, InscribedCircle, Solution};

use super::Truth;

/// A point in fractions.
pub(super) type Point = [BigRational; 2];

/// Points of the grid along each axis.
const GRID: usize = 40;

/// Points of the grid from which the search goes on.
const STARTS: usize = 24;

/// Edges nearest to a start of which all triples are tried.
const NEAREST: usize = 6;

/// Knows the truth about the circles in one polygon.
pub struct CircleOracle {
    edges: Vec<[Point; 2]>,
    /// The squared clearance of the best center found, which is inside.
    best: BigRational,
}

/// The number as a fraction.
pub(super) fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("numbers of an input are finite")
}

impl CircleOracle {
    /// Prepares to judge circles in the rings of these rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let plain = edges(values, columns);
        let edges = plain.iter().map(|edge| edge.map(|p| p.map(exact))).collect();
        let mut oracle = CircleOracle { edges, best: BigRational::zero() };
        for q in candidates(&plain) {
            let q = q.map(exact);
            let clearance = oracle.squared_clearance(&q);
            if clearance > oracle.best && oracle.is_inside(&q) {
                oracle.best = clearance;
            }
        }
        oracle
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(&self, found: &Solution<InscribedCircle>, verdict: &CircleVerdict) -> Truth {
        let (answer, numbers) = (&found.answer, [verdict.lower, verdict.upper, verdict.gap]);
        let are_numbers = answer.center.iter().all(|x| x.is_finite())
            && numbers.iter().all(|x| x.is_finite() && *x >= 0.0)
            && answer.radius == verdict.lower
            && answer.radius > 0.0;
        if !are_numbers {
            return Truth::False(format!("{answer:?} and {verdict:?} are no numbers of a circle"));
        }
        let center = answer.center.map(exact);
        let [lower, upper, gap] = numbers.map(exact);
        let square = |x: &BigRational| x * x;
        let is_inside = || self.is_inside(&center);
        Truth::claim(is_inside(), || "the center is not inside".into())
            .and(|| {
                let holds = self.squared_clearance(&center) >= square(&lower);
                Truth::claim(holds, || "an edge enters the circle".into())
            })
            .and(|| {
                Truth::claim(self.best <= square(&upper), || {
                    format!("there is a circle larger than {:?}", verdict.upper)
                })
            })
            .and(|| {
                let most = (BigRational::one() + &gap) * &lower;
                Truth::claim(upper <= most, || format!("the gap is more than {:?}", verdict.gap))
            })
            .and(|| self.touching(found, &center))
    }

    /// Tests whether each touching edge is as near as it is said to be, but for a slack of 1e-9 of the radius and the rounding of the center.
    fn touching(&self, found: &Solution<InscribedCircle>, center: &Point) -> Truth {
        let slack = exact(1.0 + 1.1e-9) * exact(found.answer.radius)
            + exact(1e-15) * (center[0].abs() + center[1].abs());
        let most = &slack * &slack;
        for &row in &found.certificate.touching {
            let distance = self.squared_distance(center, row as usize);
            if distance > most {
                return Truth::False(format!("edge {row} is farther than the radius"));
            }
        }
        Truth::claim(!found.certificate.touching.is_empty(), || "no edge touches".into())
    }

    fn edge(&self, row: usize) -> [&Point; 2] {
        let [a, b] = &self.edges[row];
        [a, b]
    }

    fn squared_clearance(&self, p: &Point) -> BigRational {
        let distances = (0..self.edges.len()).map(|row| self.squared_distance(p, row));
        distances.min().unwrap_or_else(BigRational::zero)
    }

    fn squared_distance(&self, p: &Point, row: usize) -> BigRational {
        let [a, b] = self.edge(row);
        let minus = |p: &Point, q: &Point| [&p[0] - &q[0], &p[1] - &q[1]];
        let dot = |u: &Point, v: &Point| &u[0] * &v[0] + &u[1] * &v[1];
        let (d, e) = (minus(p, a), minus(b, a));
        let (along, square) = (dot(&d, &e), dot(&e, &e));
        if !along.is_positive() {
            return dot(&d, &d);
        }
        if along >= square {
            let d = minus(p, b);
            return dot(&d, &d);
        }
        let cross = &d[0] * &e[1] - &d[1] * &e[0];
        &cross * &cross / square
    }

    /// The parity of the edges above p, which is on none.
    fn is_inside(&self, p: &Point) -> bool {
        self.edges.iter().filter(|edge| crosses_above(edge, p)).count() % 2 == 1
    }
}

/// Whether an edge crosses the vertical line through p above it; p is on no edge.
pub(super) fn crosses_above([a, b]: &[Point; 2], p: &Point) -> bool {
    (a[0] <= p[0]) != (b[0] <= p[0]) && {
        let height = &a[1] + (&p[0] - &a[0]) * (&b[1] - &a[1]) / (&b[0] - &a[0]);
        height > p[1]
    }
}

/// The edge that begins at each row: rows (x, y) are one ring, rows (x, y, number) several. None where rows are no rings.
pub(super) fn edges(values: &[f64], columns: usize) -> Vec<[[f64; 2]; 2]> {
    if columns != 2 && columns != 3 {
        return vec![];
    }
    let rows: Vec<&[f64]> = values.chunks_exact(columns).collect();
    let number = |row: usize| if columns == 3 { rows[row][2] } else { 0.0 };
    let vertex = |row: usize| [rows[row][0], rows[row][1]];
    let is_first = |row: &usize| *row == 0 || number(*row) != number(*row - 1);
    let starts: Vec<usize> = (0..rows.len()).filter(is_first).collect();
    if starts.iter().enumerate().any(|(ring, &row)| number(row) != ring as f64) {
        return vec![];
    }
    let ends = starts.iter().skip(1).copied().chain([rows.len()]);
    let rings = starts.iter().zip(ends);
    let of_ring = |(&first, end): (&usize, usize)| {
        (first..end).map(move |row| [row, if row + 1 == end { first } else { row + 1 }])
    };
    rings.flat_map(of_ring).map(|edge| edge.map(vertex)).collect()
}

/// Centers that may be good: points of a grid inside, and points equally far from three edges; found in plain arithmetic and proved by nobody.
fn candidates(edges: &[[[f64; 2]; 2]]) -> Vec<[f64; 2]> {
    let scale = edges.iter().flatten().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    let edges: Vec<[[f64; 2]; 2]> =
        edges.iter().map(|edge| edge.map(|p| p.map(|x| x / scale))).collect();
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for [p, _] in &edges {
        for k in 0..2 {
            (low[k], high[k]) = (low[k].min(p[k]), high[k].max(p[k]));
        }
    }
    let features = |q: [f64; 2]| -> Vec<([f64; 2], f64)> {
        edges.iter().map(|&[a, b]| feature(q, a, b)).collect()
    };
    let mut grid: Vec<(f64, [f64; 2])> = vec![];
    for i in 0..GRID {
        for j in 0..GRID {
            let at = |k: usize, step: usize| {
                low[k] + (high[k] - low[k]) * (step as f64 + 0.5) / GRID as f64
            };
            let q = [at(0, i), at(1, j)];
            if is_inside(&edges, q) {
                let clearance = features(q).iter().fold(f64::INFINITY, |least, f| least.min(f.1));
                grid.push((clearance, q));
            }
        }
    }
    grid.sort_by(|one, other| other.0.total_cmp(&one.0));
    let mut found: Vec<[f64; 2]> = grid.iter().take(STARTS).map(|point| point.1).collect();
    for (_, start) in grid.into_iter().take(STARTS) {
        let here = features(start);
        let mut near: Vec<usize> = (0..edges.len()).collect();
        near.sort_by(|&i, &j| here[i].1.total_cmp(&here[j].1));
        near.truncate(NEAREST);
        for (i, &one) in near.iter().enumerate() {
            for (j, &other) in near.iter().enumerate().skip(i + 1) {
                for &third in &near[j + 1..] {
                    let step = |q| newton(&features(q), [one, other, third]);
                    let mut q = start;
                    for _ in 0..20 {
                        let [dx, dy] = step(q);
                        q = [q[0] + dx, q[1] + dy];
                    }
                    found.push(q);
                }
            }
        }
    }
    let unscaled = found.into_iter().map(|q| q.map(|x| x * scale));
    unscaled.filter(|q| q.iter().all(|x| x.is_finite())).collect()
}

/// The even-odd rule in plain arithmetic.
pub(super) fn is_inside(edges: &[[[f64; 2]; 2]], p: [f64; 2]) -> bool {
    let crosses = |&&[a, b]: &&[[f64; 2]; 2]| {
        (a[0] <= p[0]) != (b[0] <= p[0])
            && a[1] + (p[0] - a[0]) * ((b[1] - a[1]) / (b[0] - a[0])) > p[1]
    };
    edges.iter().filter(crosses).count() % 2 == 1
}

/// The unit vector from the nearest point of the segment ab to q, and the distance.
fn feature(q: [f64; 2], a: [f64; 2], b: [f64; 2]) -> ([f64; 2], f64) {
    let (e, d) = ([b[0] - a[0], b[1] - a[1]], [q[0] - a[0], q[1] - a[1]]);
    let share = (d[0] * e[0] + d[1] * e[1]) / (e[0] * e[0] + e[1] * e[1]);
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    let v = [d[0] - share * e[0], d[1] - share * e[1]];
    let length = v[0].hypot(v[1]);
    (v.map(|x| x / length), length)
}

/// The step towards a point that is equally far from three edges.
fn newton(features: &[([f64; 2], f64)], [one, other, third]: [usize; 3]) -> [f64; 2] {
    let (n, d) = features[one];
    let row = |i: usize| {
        let (normal, distance) = features[i];
        ([normal[0] - n[0], normal[1] - n[1]], d - distance)
    };
    let ((u, s), (v, t)) = (row(other), row(third));
    let determinant = u[0] * v[1] - u[1] * v[0];
    [(s * v[1] - t * u[1]) / determinant, (t * u[0] - s * v[0]) / determinant]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_center_of_a_triangle_is_found() {
        let oracle = CircleOracle::new(&[0.0, 0.0, 4.0, 0.0, 4.0, 3.0], 2);
        let (one, slack) = (BigRational::one(), exact(1e-12));
        assert!(oracle.best <= one && oracle.best >= one - slack);
    }
}
