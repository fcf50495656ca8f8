//! Convex bodies in a mesh, in fractions.
//!
//! *Decided, all of it exactly.* The mesh with its caps is closed. No triangle, cap or obstacle has a point in the interior of a body:
//! it is clipped by all half-spaces. One point of the body is inside the mesh and in no solid by the even-odd rule. The points given are in the bodies. The volume is the sum of pyramids over clipped facets. Bodies are
//! disjoint if the mean of the corners of their intersection is in the border of one of them.

use std::collections::{BTreeMap, BTreeSet};

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use taut::certify::{BodiesVerdict, ConvexBody, InscribedBodies, Solution};

use super::Truth;

type Point = [BigRational; 3];

/// u·x ≤ b.
type HalfSpace = (Point, BigRational);

/// Knows the truth about the bodies in one mesh.
pub struct BodiesOracle {
    /// The triangles of the mesh as given.
    rows: Vec<[[f64; 3]; 3]>,
    triangles: Vec<[Point; 3]>,
    /// The triangles of each solid, then those of walls and points.
    obstacles: Vec<Vec<[Point; 3]>>,
    /// Twice the largest coordinate: no body inside reaches so far.
    reach: BigRational,
    /// What was said of answers before.
    judged: BTreeMap<String, Truth>,
}

fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("numbers of an input are finite")
}

fn whole(x: i64) -> BigRational {
    BigRational::from_integer(x.into())
}

fn dot(a: &Point, b: &Point) -> BigRational {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

fn cross(a: &Point, b: &Point) -> Point {
    let entry = |i: usize, j: usize| &a[i] * &b[j] - &a[j] * &b[i];
    [entry(1, 2), entry(2, 0), entry(0, 1)]
}

fn minus(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

fn mean(points: &[Point]) -> Point {
    let count = whole(points.len() as i64);
    [0, 1, 2].map(|k| points.iter().map(|p| &p[k]).sum::<BigRational>() / &count)
}

/// The part of a polygon in a half-space.
fn clipped(polygon: &[Point], (u, b): &HalfSpace) -> Vec<Point> {
    let beyond: Vec<BigRational> = polygon.iter().map(|p| dot(u, p) - b).collect();
    let mut kept = vec![];
    for at in 0..polygon.len() {
        let before = (at + polygon.len() - 1) % polygon.len();
        if beyond[before].is_positive() != beyond[at].is_positive() {
            let share = &beyond[before] / (&beyond[before] - &beyond[at]);
            let step = minus(&polygon[at], &polygon[before]);
            kept.push([0, 1, 2].map(|k| &polygon[before][k] + &share * &step[k]));
        }
        if !beyond[at].is_positive() {
            kept.push(polygon[at].clone());
        }
    }
    kept
}

impl BodiesOracle {
    /// Prepares to judge bodies in the mesh of these rows.
    pub fn new(values: &[f64], columns: usize) -> Self {
        let values = if matches!(columns, 9 | 10) { values } else { &[] };
        let corners = |row: &[f64]| [0, 3, 6].map(|k| [row[k], row[k + 1], row[k + 2]]);
        let points = |corners: [[f64; 3]; 3]| corners.map(|p| p.map(exact));
        let (mut rows, mut solids) = (vec![], BTreeMap::new());
        let mut walls = vec![];
        for row in values.chunks_exact(columns.max(1)) {
            match row.get(9).copied().unwrap_or(0.0) {
                0.0 => rows.push(corners(row)),
                -1.0 => walls.push(points(corners(row))),
                solid => {
                    let of_solid = solids.entry(solid.to_bits()).or_insert_with(Vec::new);
                    of_solid.push(points(corners(row)));
                }
            }
        }
        let triangles: Vec<[Point; 3]> = rows.iter().copied().map(points).collect();
        let coordinates = triangles.as_flattened().as_flattened().iter().map(|x| x.abs());
        let reach = coordinates.max().unwrap_or_else(BigRational::zero) * whole(2);
        let obstacles = solids.into_values().chain([walls]).collect();
        BodiesOracle { rows, triangles, obstacles, reach, judged: BTreeMap::new() }
    }

    /// Judges every claim of an answer that the checker let pass.
    pub fn judge(&mut self, found: &Solution<InscribedBodies>, verdict: &BodiesVerdict) -> Truth {
        let name = format!("{:?} {verdict:?}", found.answer);
        if let Some(truth) = self.judged.get(&name) {
            return truth.clone();
        }
        let truth = self.truth(&found.answer, verdict);
        self.judged.insert(name, truth.clone());
        truth
    }

    fn truth(&self, answer: &InscribedBodies, verdict: &BodiesVerdict) -> Truth {
        let numbers = [verdict.volume_lower, verdict.volume_upper, verdict.largest];
        let agrees = numbers.iter().all(|x| x.is_finite() && *x >= 0.0)
            && verdict.bodies == answer.bodies.len() as u64
            && verdict.disjoint == answer.disjoint
            && verdict.caps == answer.caps.len() as u64
            && verdict.solids == self.obstacles.len() as u64 - 1
            && verdict.at == answer.at.len() as u64;
        if !agrees {
            return Truth::False(format!("{verdict:?} does not fit the answer"));
        }
        let Some(triangles) = self.closed(&answer.caps) else {
            return Truth::False("the mesh with its caps is not closed".into());
        };
        let [lower, upper, least] = numbers.map(exact);
        let (mut sum, mut largest) = (BigRational::zero(), BigRational::zero());
        let bodies: Vec<Vec<HalfSpace>> =
            answer.bodies.iter().map(|body| half_spaces(answer, body)).collect();
        for (at, body) in bodies.iter().enumerate() {
            let volume = match self.volume(body, &triangles) {
                Ok(volume) => volume,
                Err(reason) => return Truth::False(format!("body {at} {reason}")),
            };
            if let Some(point) = answer.at.get(at) {
                let point = point.map(exact);
                if body.iter().any(|(u, b)| dot(u, &point) > *b) {
                    return Truth::False(format!("body {at} does not contain its point"));
                }
            }
            let claimed = exact(answer.bodies[at].volume);
            if (&claimed - &volume).abs() > exact(1.1e-9) * &volume {
                return Truth::False(format!("body {at} has not the volume {claimed}"));
            }
            sum += &volume;
            largest = largest.max(volume);
        }
        if answer.disjoint {
            for (i, one) in bodies.iter().enumerate() {
                for other in &bodies[i + 1..] {
                    let both = [&one[..], other].concat();
                    let corners: Vec<Point> = self.facets(&both).concat();
                    if !corners.is_empty() && is_inside(&both, &mean(&corners)) {
                        return Truth::False("two bodies overlap".into());
                    }
                }
            }
        }
        Truth::claim(lower <= sum && sum <= upper && least <= largest, || {
            format!("the volumes of {verdict:?} are wrong")
        })
    }

    /// The triangles and the caps; `None` if they are not closed, or if there are caps in a closed mesh.
    fn closed(&self, caps: &[[u64; 3]]) -> Option<Vec<[Point; 3]>> {
        let is_closed = |triangles: &[[[f64; 3]; 3]]| {
            let mut odd: BTreeSet<[[u64; 3]; 2]> = BTreeSet::new();
            for corners in triangles {
                for k in 0..3 {
                    let bits = |p: [f64; 3]| p.map(|x| (x + 0.0).to_bits());
                    let mut edge = [bits(corners[k]), bits(corners[(k + 1) % 3])];
                    edge.sort_unstable();
                    if edge[0] != edge[1] && !odd.remove(&edge) {
                        odd.insert(edge);
                    }
                }
            }
            odd.is_empty()
        };
        let (mut rows, mut triangles) = (self.rows.clone(), self.triangles.clone());
        for cap in caps {
            let corner = |k: u64| self.rows.as_flattened().get(k as usize).copied();
            let [a, b, c] = [corner(cap[0])?, corner(cap[1])?, corner(cap[2])?];
            rows.push([a, b, c]);
            triangles.push([a, b, c].map(|p| p.map(exact)));
        }
        let is_needed = caps.is_empty() || !is_closed(&self.rows);
        (is_needed && is_closed(&rows)).then_some(triangles)
    }

    /// The volume of a body that lies inside a closed mesh; why not, for one that does not.
    fn volume(
        &self,
        body: &[HalfSpace],
        triangles: &[[Point; 3]],
    ) -> Result<BigRational, &'static str> {
        let facets = self.facets(body);
        let corners = facets.concat();
        if corners.is_empty() {
            return Err("has no corners");
        }
        let center = mean(&corners);
        if !is_inside(body, &center) {
            return Err("has no interior");
        }
        if corners.as_flattened().iter().any(|x| x.abs() >= self.reach) {
            return Err("reaches far beyond the mesh");
        }
        for triangle in triangles.iter().chain(self.obstacles.iter().flatten()) {
            let part = body.iter().fold(triangle.to_vec(), |part, side| clipped(&part, side));
            if !part.is_empty() && is_inside(body, &mean(&part)) {
                return Err("is entered by a triangle");
            }
        }
        if !contains(triangles, &center) {
            return Err("is outside");
        }
        let solids = &self.obstacles[..self.obstacles.len() - 1];
        if solids.iter().any(|solid| contains(solid, &center)) {
            return Err("is in a solid");
        }
        let mut six = BigRational::zero();
        for polygon in facets {
            for k in 2..polygon.len() {
                let [a, b, c] = [0, k - 1, k].map(|k| minus(&polygon[k], &center));
                six += dot(&a, &cross(&b, &c)).abs();
            }
        }
        Ok(six / whole(6))
    }

    /// The facets of a body within a cube, as polygons.
    fn facets(&self, body: &[HalfSpace]) -> Vec<Vec<Point>> {
        let mut sides = body.to_vec();
        for k in 0..3 {
            for sign in [1, -1] {
                let mut u = [whole(0), whole(0), whole(0)];
                u[k] = whole(sign);
                sides.push((u, self.reach.clone()));
            }
        }
        let facet = |at: usize| {
            let (u, b) = &sides[at];
            let axis = if u[0].is_zero() { [1, 0, 0] } else { [0, 1, 3] }.map(whole);
            let along = cross(u, &axis);
            let across = cross(u, &along);
            // All points of the plane in the cube are nearer to its point next to the origin than 4·reach.
            let size = &self.reach * whole(4);
            let nearest = u.clone().map(|x| x * b / dot(u, u));
            let corner = |s: i64, t: i64| {
                [0, 1, 2]
                    .map(|k| &nearest[k] + &size * (whole(s) * &along[k] + whole(t) * &across[k]))
            };
            let square = vec![corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)];
            let others = (0..sides.len()).filter(|&other| other != at);
            others.fold(square, |polygon, other| clipped(&polygon, &sides[other]))
        };
        (0..sides.len()).map(facet).collect()
    }
}

/// The even-odd rule for a point that is on no triangle, along a line that meets no edge.
fn contains(triangles: &[[Point; 3]], p: &Point) -> bool {
    let tried = (1i64..).map(|k| [whole(1009), whole(7 * k), whole(k * k + 13)]);
    let found = tried.map(|way| crossings(triangles, p, &way)).find_map(|count| count);
    found.expect("some line meets no edge") % 2 == 1
}

fn crossings(triangles: &[[Point; 3]], p: &Point, way: &Point) -> Option<usize> {
    let mut count = 0;
    for triangle in triangles {
        let [a, b, c] = triangle.each_ref().map(|corner| minus(corner, p));
        let sides = [dot(way, &cross(&a, &b)), dot(way, &cross(&b, &c)), dot(way, &cross(&c, &a))];
        let positive = sides.iter().filter(|x| x.is_positive()).count();
        let zero = sides.iter().filter(|x| x.is_zero()).count();
        if zero > 0 {
            // A triangle without area, or one that the line does not touch, decides nothing.
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let is_off = positive > 0 && positive + zero < 3;
            if is_off || normal.iter().all(Zero::is_zero) {
                continue;
            }
            return None;
        }
        if positive == 0 || positive == 3 {
            let normal = cross(&minus(&b, &a), &minus(&c, &a));
            let along = dot(&normal, &a) / dot(&normal, way);
            count += usize::from(along.is_positive());
        }
    }
    Some(count)
}

/// The half-spaces of a body in the coordinates of the mesh.
fn half_spaces(answer: &InscribedBodies, body: &ConvexBody) -> Vec<HalfSpace> {
    let power = BigInt::one() << answer.exponent.unsigned_abs();
    let unit = match answer.exponent >= 0 {
        true => BigRational::from_integer(power),
        false => BigRational::new(BigInt::one(), power),
    };
    let origin = answer.origin.map(whole);
    let side = |(normal, &offset): (&[i64; 3], &i64)| {
        let u = normal.map(whole);
        let b = (whole(offset) + dot(&u, &origin)) * &unit;
        (u, b)
    };
    body.normals.iter().zip(&body.offsets).map(side).collect()
}

fn is_inside(body: &[HalfSpace], p: &Point) -> bool {
    body.iter().all(|(u, b)| dot(u, p) < *b)
}
