//! Three ways to sample a body's surface: at random, in a Poisson-disk sample, along scan lines.

use std::collections::HashMap;

use super::fields::{Field, dot, length, minus};
use super::shapes::RADIUS_MAX;
use super::*;

/// How points lie on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sampling {
    /// Independent of each other, and even by area.
    Random,
    /// None nearer to another on the same side than three quarters of the spacing.
    Disk,
    /// On plane sections one spacing apart, and half a spacing apart on these.
    Lines,
}

impl Sampling {
    /// All of them, with what tables call them.
    pub(super) const ALL: [(Self, &'static str); 3] =
        [(Self::Random, "random"), (Self::Disk, "Poisson disk"), (Self::Lines, "scan lines")];
}

/// Random points of the surface, even by area, and its area by Crofton's formula: a random line meets a surface as often as its area says.
pub(super) fn crossings(
    field: &Field,
    count: usize,
    step: f64,
    seed: u64,
) -> Result<(Vec<Point>, f64)> {
    let (mut points, mut lines) = (Vec::with_capacity(count), 0);
    for round in 0.. {
        if points.len() >= count || round == 200 {
            break;
        }
        let directions = generate(Distribution::Sphere, count, 3, seed + 2 * round)?;
        let places = chances::<2>(count, seed + 2 * round + 1)?;
        for (direction, [far, around]) in directions.as_chunks::<3>().0.iter().zip(places) {
            lines += 1;
            along(field, *direction, [far.sqrt(), TAU * around], step, &mut points);
            if points.len() >= count {
                break;
            }
        }
    }
    ensure!(points.len() >= count, "the surface is too small to be met");
    // Lines through a ball of radius r meet a surface of area a within it a/(2πr²)·… times: 2a/(4πr²) for each.
    let area = points.len() as f64 / lines as f64 * TAU * RADIUS_MAX * RADIUS_MAX;
    points.truncate(count);
    Ok((points, area))
}

/// Where a line meets a surface. Chords shorter than a step can be missed.
fn along(
    field: &Field,
    direction: Point,
    [far, around]: [f64; 2],
    step: f64,
    points: &mut Vec<Point>,
) {
    let cross = |a: Point, b: Point| {
        [0, 1, 2].map(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
    };
    let axis = if direction[0].abs() < 0.7 { [1.0, 0.0, 0.0] } else { [0.0, 1.0, 0.0] };
    let side = cross(direction, axis);
    let size = length(side);
    let side = side.map(|x| x / size);
    let up = cross(direction, side);
    let (sin, cos) = around.sin_cos();
    let middle = [0, 1, 2].map(|k| RADIUS_MAX * far * (cos * side[k] + sin * up[k]));
    let at = |t: f64| [0, 1, 2].map(|k| middle[k] + t * direction[k]);
    let end = RADIUS_MAX * (1.0 - far * far).max(0.0).sqrt();
    let (mut t, mut value) = (-end, field.value(at(-end)));
    while t < end {
        let next = t + value.abs().max(step);
        let found = field.value(at(next));
        if (found < 0.0) != (value < 0.0) {
            points.push(at(root(|t| field.value(at(t)), t, next)));
        }
        (t, value) = (next, found);
    }
}

/// Where a function changes its sign, by halving.
fn root(value: impl Fn(f64) -> f64, mut from: f64, mut to: f64) -> f64 {
    let is_inside = value(from) < 0.0;
    for _ in 0..40 {
        let middle = 0.5 * (from + to);
        if (value(middle) < 0.0) == is_inside { from = middle } else { to = middle }
    }
    0.5 * (from + to)
}

/// Points with normals, by cubes.
struct Cubes {
    side: f64,
    cubes: HashMap<[i64; 3], Vec<u32>>,
    all: Vec<(Point, Point)>,
}

impl Cubes {
    fn new(side: f64) -> Self {
        Self { side, cubes: HashMap::new(), all: vec![] }
    }

    /// Takes a point in, if none on the same side of the body is nearer than a cube is wide and `is_alike`.
    fn offer(&mut self, field: &Field, point: Point, is_alike: impl Fn(Point) -> bool) {
        let cube = point.map(|x| (x / self.side).floor() as i64);
        let mut normal = None;
        for off in 0..27i64 {
            let near = [cube[0] + off % 3 - 1, cube[1] + off / 3 % 3 - 1, cube[2] + off / 9 - 1];
            for &other in self.cubes.get(&near).into_iter().flatten() {
                let (place, facing) = self.all[other as usize];
                if length(minus(place, point)) < self.side && is_alike(place) {
                    let own = *normal.get_or_insert_with(|| field.normal(point));
                    if dot(own, facing) > -0.2 {
                        return;
                    }
                }
            }
        }
        let normal = normal.unwrap_or_else(|| field.normal(point));
        self.cubes.entry(cube).or_default().push(self.all.len() as u32);
        self.all.push((point, normal));
    }

    fn points(self) -> Vec<Point> {
        self.all.into_iter().map(|(point, _)| point).collect()
    }
}

/// Points of some random ones that are nowhere crowded.
pub(super) fn disk(field: &Field, pool: &[Point], spacing: f64) -> Vec<Point> {
    let mut cubes = Cubes::new(0.75 * spacing);
    pool.iter().for_each(|&point| cubes.offer(field, point, |_| true));
    cubes.points()
}

/// Random points moved onto the nearest of some plane sections, this far apart, then thinned so that they are at least `step` apart along
/// these. The sections are level where the surface is steep, else upright.
pub(super) fn lines(field: &Field, pool: &[Point], spacing: f64, step: f64) -> Vec<Point> {
    let mut cubes = Cubes::new(step);
    for &point in pool {
        let normal = field.normal(point);
        let axis = if normal[2].abs() < 0.75 { 2 } else { 0 };
        let level = |point: Point| (point[axis] / spacing - 0.25).round();
        let mut at = point;
        at[axis] = spacing * (level(point) + 0.25);
        // A function that grows more slowly than a distance takes many steps.
        for _ in 0..400 {
            let value = field.value(at);
            if value.abs() < 1e-12 {
                break;
            }
            let mut slope = field.normal(at);
            slope[axis] = 0.0;
            let steep = dot(slope, slope);
            if steep < 0.1 {
                break;
            }
            at = [0, 1, 2].map(|k| at[k] - value * slope[k] / steep);
        }
        let is_near = length(minus(at, point)) < spacing;
        if is_near && field.value(at).abs() < 1e-9 {
            cubes.offer(field, at, |other| level(other) == level(at));
        }
    }
    cubes.points()
}

/// A sample whose spacing is about this, from random points of the surface, of which there are several for each that is wanted.
pub(super) fn sample(
    field: &Field,
    sampling: Sampling,
    pool: &[Point],
    (count, spacing): (usize, f64),
) -> Vec<Point> {
    match sampling {
        Sampling::Random => pool[..count].to_vec(),
        Sampling::Disk => disk(field, pool, spacing),
        Sampling::Lines => lines(field, pool, spacing, 0.5 * spacing),
    }
}
