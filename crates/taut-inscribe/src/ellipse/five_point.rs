//! The largest ellipse through five samples of the boundary with no sample in it: section 8.4.2 of the thesis.
//!
//! *Idea.* A conic Ax² + By² + 2Cxy + Dx + Ey + F = 0 is a hyperplane for the lifted samples (x², y², 2xy, x, y). A facet of their
//! convex hull in five dimensions is a conic through five samples with all others on one side. The facets are visited from neighbor
//! to neighbor; the ellipses among them that pass the tests of the thesis are compared by area.
//! *Tests.* No sample is in the ellipse; the normals of ellipse and boundary at the five samples agree; the center is in the convex
//! hull of the five and in the polygon; the small radius is a multiple of the distance of samples.
//! *Guarantee.* None: a largest ellipse need not touch five samples. The ellipse is shrunk until no edge enters.
//! *Departures.* The thesis prints the center, the area and the sign of the normals wrong; here they are as derived below. Samples
//! are moved by a millionth, so that no six of them are on one conic, as those of straight edges would be.
//! *Cost.* About n² facets for n samples, and O(n) for each.

use std::collections::HashSet;

use taut_points::{Cancelled, Monitor};

use super::EllipseFivePointOptions;
use super::ascent::Ellipse;
use super::shape::Shape;
use crate::levels::Levels;
use crate::polygon::Segment;
use crate::random::Random;
use crate::units::Units;

/// Coefficients A, B, C, D, E, F.
type Conic = [f64; 6];

/// Samples on a facet.
const FACET: usize = 5;

/// How far samples are moved along each axis, at most, in units of the bounding box.
const MOVED: f64 = 1e-6;

/// Seed of the moves and of the directions that lead to the first facet.
const SEED: u64 = 62;

/// Facets that are visited, per square of the number of samples; general samples of a curve have about one.
const FACETS_MAX: usize = 8;

/// Pivots below which a system is degenerate, relative to coefficients of about 1.
const PIVOT_MIN: f64 = 1e-14;

/// Samples of the boundary.
struct Samples {
    lifted: Vec<Conic>,
    /// The unit normals of the edges, out of the polygon.
    normals: Vec<[f64; 2]>,
    points: Vec<[f64; 2]>,
    /// The distance along the boundary between two of them.
    spacing: f64,
}

/// A conic through five samples.
#[derive(Clone)]
struct Facet {
    conic: Conic,
    samples: [u16; FACET],
}

/// The largest ellipse that passes the tests, fitted into the polygon; `None` if none does.
pub(super) fn largest(
    units: &Units,
    options: &EllipseFivePointOptions,
    monitor: &Monitor<'_>,
) -> Result<Option<Ellipse>, Cancelled> {
    let levels = Levels::of(&units.edges, units.extent[1]);
    let samples = Samples::of(units, &levels, options.samples as usize);
    let mut best: Option<(f64, Shape, [f64; 2])> = None;
    let Some(first) = samples.first_facet() else { return Ok(None) };
    let mut seen = HashSet::from([first.samples]);
    let mut pending = vec![first];
    while let Some(facet) = pending.pop() {
        monitor.check()?;
        let found = samples.ellipse(&facet, options);
        if let Some((area, shape, center)) = found
            && best.is_none_or(|best| area > best.0)
            && levels.is_inside(&units.edges, center)
        {
            best = Some((area, shape, center));
        }
        if seen.len() >= FACETS_MAX * samples.points.len() * samples.points.len() {
            continue;
        }
        for next in samples.neighbors(&facet) {
            if seen.insert(next.samples) {
                pending.push(next);
            }
        }
    }
    Ok(best.map(|(_, shape, center)| Ellipse::of(shape, center, &units.edges)))
}

impl Samples {
    /// Samples at even distances along the boundary.
    fn of(units: &Units, levels: &Levels, count: usize) -> Self {
        let length = |[a, b]: &Segment| (b[0] - a[0]).hypot(b[1] - a[1]);
        let spacing = units.edges.iter().map(length).sum::<f64>() / count as f64;
        let mut random = Random::new(SEED);
        let mut samples = Samples { lifted: vec![], normals: vec![], points: vec![], spacing };
        let mut next = 0.5 * spacing;
        for edge in &units.edges {
            let (length, [a, b]) = (length(edge), *edge);
            let along = [b[0] - a[0], b[1] - a[1]].map(|x| x / length);
            let normal = outward(units, levels, edge, [along[1], -along[0]]);
            while next < length && samples.points.len() < count {
                let p = [0, 1].map(|k| a[k] + next * along[k] + MOVED * (random.unit() - 0.5));
                samples.points.push(p);
                samples.normals.push(normal);
                // With six coefficients the origin may be in the ellipse, where five are scaled to F = 1 in the thesis.
                samples.lifted.push(lift(p));
                next += spacing;
            }
            next -= length;
        }
        samples
    }

    /// A facet, by turning a hyperplane beyond all samples until it meets one after the other.
    fn first_facet(&self) -> Option<Facet> {
        let mut random = Random::new(SEED);
        let mut conic: Conic = [0.0, 0.0, 0.0, 0.0, 0.0, 1.0];
        let mut chosen: Vec<u16> = vec![];
        while chosen.len() < FACET {
            // A direction that vanishes at the samples chosen.
            let mut rows: Vec<Conic> =
                chosen.iter().map(|&i| self.lifted[usize::from(i)]).collect();
            rows.push(conic);
            while rows.len() < 6 {
                rows.push([0; 6].map(|_| random.unit() - 0.5));
            }
            let inverse = inverse(&rows)?;
            let turn = column(&inverse, 5);
            let next = self.first_met(&conic, &turn, &chosen)?;
            conic = turned(&conic, &turn, &self.lifted[usize::from(next)])?;
            chosen.push(next);
        }
        let mut samples: [u16; FACET] = chosen.try_into().ok()?;
        samples.sort_unstable();
        Some(Facet { conic, samples })
    }

    /// The sample that a conic meets first when it is turned, of those that it does not pass through.
    fn first_met(&self, conic: &Conic, turn: &Conic, through: &[u16]) -> Option<u16> {
        let mut best: Option<(f64, u16)> = None;
        for (i, lifted) in self.lifted.iter().enumerate() {
            let i = i as u16;
            let value = dot(conic, lifted);
            if value <= 0.0 || through.contains(&i) {
                continue;
            }
            // The angle of the turn has this tangent of its complement.
            let ratio = dot(turn, lifted) / value;
            if best.is_none_or(|(least, _)| ratio < least) {
                best = Some((ratio, i));
            }
        }
        best.map(|(_, i)| i)
    }

    /// The facets that have four samples in common with one.
    fn neighbors(&self, facet: &Facet) -> Vec<Facet> {
        let mut rows: Vec<Conic> =
            facet.samples.iter().map(|&i| self.lifted[usize::from(i)]).collect();
        rows.push(facet.conic);
        let Some(inverse) = inverse(&rows) else { return vec![] };
        // Without the errors that turns add up to.
        let Some(conic) = normalized(column(&inverse, FACET)) else { return vec![] };
        let neighbor = |left_out: usize| {
            let turn = column(&inverse, left_out);
            let next = self.first_met(&conic, &turn, &facet.samples)?;
            let conic = turned(&conic, &turn, &self.lifted[usize::from(next)])?;
            let mut samples = facet.samples;
            samples[left_out] = next;
            samples.sort_unstable();
            Some(Facet { conic, samples })
        };
        (0..FACET).filter_map(neighbor).collect()
    }

    /// The area, shape and center of the ellipse of a facet that passes the tests.
    fn ellipse(
        &self,
        facet: &Facet,
        options: &EllipseFivePointOptions,
    ) -> Option<(f64, Shape, [f64; 2])> {
        let [a, b, c, d, e, f] = facet.conic;
        let determinant = a * b - c * c;
        if !(a > 0.0 && determinant > 0.0) {
            return None;
        }
        // The center solves 2Qx = −R; the value there is −μ.
        let center = [-0.5 * (b * d - c * e) / determinant, -0.5 * (a * e - c * d) / determinant];
        let mu = -(0.5 * (d * center[0] + e * center[1]) + f);
        let largest = 0.5 * (a + b + ((a - b) * (a - b) + 4.0 * c * c).sqrt());
        let small_radius = (mu / largest).sqrt();
        // NaN, where μ is below 0, is not fat.
        let is_fat = small_radius >= options.fatness * self.spacing;
        let is_passed =
            is_fat && self.agrees(facet, options.normal) && self.surrounds(facet, center);
        let root = determinant.sqrt();
        let t = root / b;
        is_passed.then(|| (mu / root, Shape::new(c / root * t, t), center))
    }

    /// Whether the gradient of the conic, which leads out of the ellipse, and the normals of the boundary agree.
    fn agrees(&self, facet: &Facet, least: f64) -> bool {
        let [a, b, c, d, e, _] = facet.conic;
        facet.samples.iter().all(|&i| {
            let ([x, y], normal) = (self.points[usize::from(i)], self.normals[usize::from(i)]);
            let gradient = [2.0 * (a * x + c * y) + d, 2.0 * (b * y + c * x) + e];
            let along = gradient[0] * normal[0] + gradient[1] * normal[1];
            along >= least * gradient[0].hypot(gradient[1])
        })
    }

    /// Whether a point is in the convex hull of the samples of a facet, which are in convex position: not all on one side of it.
    fn surrounds(&self, facet: &Facet, center: [f64; 2]) -> bool {
        let ways = facet.samples.map(|i| {
            let p = self.points[usize::from(i)];
            [p[0] - center[0], p[1] - center[1]]
        });
        // Each way has another one to its left, within half a turn.
        ways.iter().all(|u| ways.iter().any(|v| u[0] * v[1] - u[1] * v[0] > 0.0))
    }
}

/// The normal of an edge that points out of the polygon.
fn outward(units: &Units, levels: &Levels, [a, b]: &Segment, normal: [f64; 2]) -> [f64; 2] {
    let middle = [0, 1].map(|k| 0.5 * (a[k] + b[k]));
    let step = 1e-3 * (b[0] - a[0]).hypot(b[1] - a[1]);
    let beyond = [0, 1].map(|k| middle[k] + step * normal[k]);
    let is_inside = levels.is_inside(&units.edges, beyond);
    if is_inside { normal.map(|x| -x) } else { normal }
}

fn lift([x, y]: [f64; 2]) -> Conic {
    [x * x, y * y, 2.0 * x * y, x, y, 1.0]
}

fn dot(one: &Conic, other: &Conic) -> f64 {
    one.iter().zip(other).map(|(x, y)| x * y).sum()
}

fn column(inverse: &[Conic; 6], place: usize) -> Conic {
    [0, 1, 2, 3, 4, 5].map(|row| inverse[row][place])
}

fn normalized(conic: Conic) -> Option<Conic> {
    let length = dot(&conic, &conic).sqrt();
    (length.is_normal()).then(|| conic.map(|x| x / length))
}

/// The conic between two that vanishes at a sample: a(w)·b − b(w)·a.
fn turned(conic: &Conic, turn: &Conic, sample: &Conic) -> Option<Conic> {
    let (value, change) = (dot(conic, sample), dot(turn, sample));
    normalized([0, 1, 2, 3, 4, 5].map(|k| value * turn[k] - change * conic[k]))
}

/// The inverse of six rows, by elimination with pivots; `None` where they are dependent.
fn inverse(rows: &[Conic]) -> Option<[Conic; 6]> {
    let mut left: [Conic; 6] = rows.try_into().ok()?;
    let mut right = [[0.0; 6]; 6];
    for (k, row) in right.iter_mut().enumerate() {
        row[k] = 1.0;
    }
    for k in 0..6 {
        let pivot = (k..6).max_by(|&i, &j| left[i][k].abs().total_cmp(&left[j][k].abs()))?;
        left.swap(k, pivot);
        right.swap(k, pivot);
        let value = left[k][k];
        if value.is_nan() || value.abs() < PIVOT_MIN {
            return None;
        }
        left[k] = left[k].map(|x| x / value);
        right[k] = right[k].map(|x| x / value);
        let (row, image) = (left[k], right[k]);
        for i in (0..6).filter(|&i| i != k) {
            let factor = left[i][k];
            for j in 0..6 {
                left[i][j] -= factor * row[j];
                right[i][j] -= factor * image[j];
            }
        }
    }
    Some(right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;

    fn samples(count: usize) -> Samples {
        let vertex = |i: usize| {
            let (sine, cosine) = (std::f64::consts::TAU * i as f64 / 60.0).sin_cos();
            let radius = 1.0 + 0.3 * (2.0 * cosine * sine + 0.2 * cosine);
            [radius * cosine, 0.6 * radius * sine]
        };
        let loops = Loops::of_ring(&(0..60).map(vertex).collect::<Vec<_>>());
        let units = Units::of(&loops.segments);
        let levels = Levels::of(&units.edges, units.extent[1]);
        Samples::of(&units, &levels, count)
    }

    #[test]
    fn facets_are_all_that_five_samples_span() {
        // All subsets of five against the walk.
        let samples = samples(14);
        let mut expected = vec![];
        let mut subset = [0u16, 1, 2, 3, 4];
        loop {
            let mut rows: Vec<Conic> =
                subset.iter().map(|&i| samples.lifted[usize::from(i)]).collect();
            rows.push([0.31, -0.57, 0.83, 0.21, -0.44, 0.66]);
            let conic = column(&inverse(&rows).unwrap(), FACET);
            let others = (0..14u16).filter(|i| !subset.contains(i));
            let signs: Vec<bool> =
                others.map(|i| dot(&conic, &samples.lifted[usize::from(i)]) > 0.0).collect();
            if signs.iter().all(|&sign| sign == signs[0]) {
                expected.push(subset);
            }
            let Some(place) = (0..FACET).rev().find(|&k| subset[k] < (14 - FACET + k) as u16)
            else {
                break;
            };
            subset[place] += 1;
            for k in place + 1..FACET {
                subset[k] = subset[k - 1] + 1;
            }
        }
        let first = samples.first_facet().unwrap();
        let mut seen = HashSet::from([first.samples]);
        let mut pending = vec![first];
        while let Some(facet) = pending.pop() {
            pending.extend(
                samples.neighbors(&facet).into_iter().filter(|next| seen.insert(next.samples)),
            );
        }
        let mut found: Vec<_> = seen.into_iter().collect();
        found.sort_unstable();
        assert!(expected.len() > 50);
        assert_eq!(found, expected);
    }

    #[test]
    fn normals_point_out() {
        let samples = samples(40);
        let center = [0.8, 0.6];
        let is_out = |(p, n): (&[f64; 2], &[f64; 2])| {
            (p[0] - center[0]) * n[0] + (p[1] - center[1]) * n[1] > 0.0
        };
        let count =
            samples.points.iter().zip(&samples.normals).filter(|&pair| is_out(pair)).count();
        assert!(count > 36, "{count} of 40");
    }
}
