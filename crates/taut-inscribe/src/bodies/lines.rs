//! Lines through a mesh, by which the search tells how much of it bodies hide.
//!
//! *Idea.* Lines with random directions through random points of the disc across them meet the bounding ball evenly by the measure
//! that no motion changes. Those that cross the mesh are kept. The search may see each of them very often, so what it makes of
//! them is no estimate: [`occlusion`](crate::occlusion()) draws lines of its own.

use taut_points::OrderBy;

use super::polytope::Sides;
use super::scene::{WALL, free_parts};
use super::tree::{Parts, Tree};
use super::vectors::{cross, dot, minus, plus};
use crate::occlusion::frame;
use crate::random::Random;

/// Lines by which the search tells which body hides more. With 8,000 the share that the search sees is 1 to 2 % above that of
/// other lines.
pub(super) const SCORED_LINES: usize = 8_000;

/// Lines that are drawn for each one wanted, at most: a mesh that is a needle is met by few.
const DRAWS_PER_LINE_MAX: usize = 200;

/// The points `point` + t·`direction`, in units of the grid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    pub(super) point: [f64; 3],
    pub(super) direction: [f64; 3],
}

impl Line {
    /// Whether the line meets the interior of a body.
    pub(super) fn meets(&self, sides: &Sides) -> bool {
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        sides.normals.iter().zip(&sides.offsets).all(|(u, &offset)| {
            let (along, room) = (dot(*u, self.direction), offset - dot(*u, self.point));
            if along > 0.0 {
                far = far.min(room / along);
            } else if along < 0.0 {
                near = near.max(room / along);
            }
            near < far && (along != 0.0 || room > 0.0)
        })
    }
}

/// Lines that cross a mesh, and the middle of the longest part of each inside.
pub(super) struct Sample {
    pub(super) lines: Vec<Line>,
    pub(super) middles: Vec<[i32; 3]>,
}

impl Sample {
    /// Draws lines until so many cross the mesh, or hardly any does.
    pub(super) fn draw(tree: &Tree, wanted: usize, random: &mut Random) -> Self {
        let [center, half] = tree.mesh_bounds();
        let radius = dot(half, half).sqrt();
        let mut sample = Sample { lines: vec![], middles: vec![] };
        for _ in 0..DRAWS_PER_LINE_MAX * wanted {
            let line = random_line(center, radius, random);
            if let Some(middle) = middle(&crossings(tree, &line)) {
                let place = plus(line.point, middle, line.direction);
                sample.middles.push(place.map(|x| x.round() as i32));
                sample.lines.push(line);
            }
            if sample.lines.len() == wanted {
                break;
            }
        }
        sample
    }
}

fn random_line(center: [f64; 3], radius: f64, random: &mut Random) -> Line {
    let [direction, one, other] = frame(random);
    let [s, t] = loop {
        let [s, t] = [random.unit(), random.unit()].map(|t| 2.0 * t - 1.0);
        if s * s + t * t < 1.0 {
            break [s * radius, t * radius];
        }
    };
    Line { point: plus(plus(center, s, one), t, other), direction }
}

/// The middle of the longest part in the mesh and in no solid; `None` for a line without such a part, or with a number of crossings
/// that rounding made odd.
fn middle(crossings: &[(f64, i32)]) -> Option<f64> {
    let (parts, is_closed) = free_parts(crossings);
    let longest = parts.iter().max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])))?;
    is_closed.then(|| f64::midpoint(longest[0], longest[1]))
}

/// Where a line crosses surfaces, ascending, and their numbers; without walls.
fn crossings(tree: &Tree, line: &Line) -> Vec<(f64, i32)> {
    let mut found = vec![];
    let mut stack = vec![0];
    while let Some(at) = stack.pop() {
        let [center, half] = tree.bounds(at);
        if !is_near(line, center, half) {
            continue;
        }
        match tree.parts(at) {
            Parts::Nodes(nodes) => stack.extend(nodes),
            Parts::Triangles(range) => {
                let surfaces = range.map(|t| (t, tree.surfaces[t]));
                found.extend(
                    surfaces.filter(|&(_, surface)| surface != WALL).filter_map(|(t, surface)| {
                        Some((crossing(line, &tree.corners[t])?, surface))
                    }),
                );
            }
        }
    }
    found.order_by(&|one, other| one.0.total_cmp(&other.0));
    found
}

/// Whether a line comes near a box: no axis across it separates the two (Gottschalk, Lin and Manocha, SIGGRAPH 1996).
fn is_near(line: &Line, center: [f64; 3], half: [f64; 3]) -> bool {
    let d = line.direction;
    let off = cross(minus(center, line.point), d);
    let reach = |a: usize, b: usize| half[a] * d[b].abs() + half[b] * d[a].abs();
    // A unit allows for rounding.
    off[0].abs() <= reach(1, 2) + 1.0
        && off[1].abs() <= reach(2, 0) + 1.0
        && off[2].abs() <= reach(0, 1) + 1.0
}

/// Where a line crosses a triangle (Möller and Trumbore, 1997).
fn crossing(line: &Line, corners: &[[i32; 3]; 3]) -> Option<f64> {
    let [a, b, c] = corners.map(|corner| corner.map(f64::from));
    let (u, v) = (minus(b, a), minus(c, a));
    let across = cross(line.direction, v);
    let determinant = dot(u, across);
    let off = minus(line.point, a);
    let turned = cross(off, u);
    let (s, t) = (dot(off, across) / determinant, dot(line.direction, turned) / determinant);
    let is_crossed = s >= 0.0 && t >= 0.0 && s + t <= 1.0;
    is_crossed.then(|| dot(v, turned) / determinant)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::super::directions::Directions;
    use super::super::scores::LineScores;
    use super::*;

    /// The triangles of a box.
    fn cuboid(low: [i32; 3], high: [i32; 3]) -> Vec<[[i32; 3]; 3]> {
        let corner = |k: usize| [0, 1, 2].map(|c| if k >> c & 1 == 0 { low[c] } else { high[c] });
        let quads =
            [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let halves = |[a, b, c, d]: [usize; 4]| [[a, b, c], [a, c, d]];
        quads.into_iter().flat_map(halves).map(|t| t.map(corner)).collect()
    }

    /// Of the lines that meet a convex body, those that meet another one in it have the share of its surface (Cauchy).
    #[test]
    fn lines_meet_bodies_by_their_surfaces() {
        let directions = Arc::new(Directions::of(18));
        let tree = Tree::new(&cuboid([0; 3], [1 << 16; 3]), &directions);
        let sample = Sample::draw(&tree, 20_000, &mut Random::new(1));
        assert_eq!((sample.lines.len(), sample.middles.len()), (20_000, 20_000));
        assert!(sample.middles.iter().all(|p| p.iter().all(|x| (0..=1 << 16).contains(x))));
        let scores = LineScores::of(&directions, &sample.lines);
        for (low, high) in [(0, 1 << 16), (0, 1 << 15), (20_000, 45_000)] {
            let mut h = [0; _];
            for (j, u) in directions.normals.iter().enumerate() {
                h[j] = u.iter().map(|&n| if n > 0 { high } else { -low } * n.abs() as i32).sum();
            }
            let sides = Sides::of_dop(&directions, &h);
            let met = sample.lines.iter().filter(|line| line.meets(&sides)).count();
            let share = (f64::from(high - low) / f64::from(1 << 16)).powi(2);
            // Four standard errors of 20,000 lines.
            assert!((met as f64 / 20_000.0 - share).abs() < 4.0 * 0.0036, "{met}, not {share}");
            // In single precision some lines through edges are counted otherwise.
            assert!(scores.count(&h).abs_diff(met as u64) <= 3, "{} and {met}", scores.count(&h));
        }
    }

    #[test]
    fn the_middle_is_that_of_the_longest_part_inside() {
        assert_eq!(middle(&[]), None);
        assert_eq!(middle(&[1.0, 2.0, 5.0].map(|t| (t, 0))), None);
        assert_eq!(middle(&[0.0, 1.0, 5.0, 9.0, 20.0, 22.0].map(|t| (t, 0))), Some(7.0));
    }
}
