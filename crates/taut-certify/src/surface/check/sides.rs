//! Which way closed components face, and what lies inside of them.
//!
//! *Rays.* From a point towards larger x. Seen along x, the ray is a point of the plane of y and z; moved by (ε, ε²) for an infinitesimal
//! ε it is on no edge, so it crosses a triangle or misses it, and a closed surface that it crosses an odd number of times is around it.
//! *Facing.* The sum of det(a − o, b − o, c − o) over a closed oriented component is six times its volume, positive if it faces
//! outwards. Formed in double-double with a bound on what it is off by; where that leaves its sign open, in whole numbers.
//! *Depth.* An embedded component lies within another if one of its vertices does. It has to face outwards where it lies within an even
//! number of others, inwards where within an odd number: there it bounds a cavity.
//! *Reference.* Edelsbrunner and Mücke, Simulation of Simplicity, ACM Trans. Graph. 9(1), 1990, for the point that is moved.

use std::cmp::Ordering;

use taut_points::OrderBy;
use taut_points::parallel::IntoParallel;

use super::super::{Surface, SurfaceDoubt, SurfaceViolation};
use super::crossing::Faces;
use super::meet::contains;
use super::places::side;
use super::topology::Shape;
use crate::arithmetic::{Compensated, DoubleDouble, Integer, Ring, parts};
use crate::triangulation::{Geometry, Signs, Tetrahedra, turn};

/// Triangles whose terms of a volume are held at once.
const BLOCK: usize = 1 << 16;
/// Triangles that one task handles.
const TASK: usize = 1 << 12;

/// Checks that each row said to be interior is inside the closed components, not on them.
pub(super) fn interior(
    surface: &Surface,
    shape: &Shape,
    faces: &Faces<'_>,
) -> Result<(), SurfaceViolation> {
    for &row in &surface.unused.interior {
        let around = around(shape, faces, &faces.places.all[row as usize], None);
        let problem = match around {
            None => "lies on the surface",
            Some(around) if around.len().is_multiple_of(2) => {
                "lies outside of the closed components"
            }
            Some(_) => continue,
        };
        return Err(SurfaceViolation::Interior { row, problem });
    }
    Ok(())
}

/// The first closed component that does not face as it should. The surface is an embedded oriented manifold.
pub(super) fn inward(shape: &Shape, faces: &Faces<'_>) -> Option<SurfaceDoubt> {
    let volumes = volumes(shape, faces);
    let closed = shape.is_closed.iter().filter(|&&is_closed| is_closed).count();
    for (component, volume) in volumes.into_iter().enumerate() {
        if !shape.is_closed[component] {
            continue;
        }
        let first = shape.topology.components[component].first_triangle;
        let vertex = faces.face(first).corners[0];
        let depth = match closed {
            1 => 0,
            // No other component passes through a vertex of this one.
            _ => around(shape, faces, &vertex, Some(component as u32)).map_or(0, |all| all.len()),
        };
        let expected = if depth.is_multiple_of(2) { Ordering::Greater } else { Ordering::Less };
        if volume != expected {
            return Some(SurfaceDoubt::Inward { component, depth });
        }
    }
    None
}

/// The closed components around a point, but for one of them; `None` for a point on one.
fn around(shape: &Shape, faces: &Faces<'_>, p: &[f64; 3], but: Option<u32>) -> Option<Vec<u32>> {
    let (signs, mut crossed) = (&faces.places.signs, vec![]);
    let on = faces.tree().find(
        |area| {
            area.most[0] >= p[0] && (1..3).all(|k| area.least[k] <= p[k] && p[k] <= area.most[k])
        },
        |triangle| {
            let component = shape.component[triangle as usize];
            if !shape.is_closed[component as usize] || but == Some(component) {
                return false;
            }
            match crossing(signs, &faces.face(triangle).corners, p) {
                Crossing::On => true,
                Crossing::None => false,
                Crossing::One => {
                    crossed.push(component);
                    false
                }
            }
        },
    );
    if on.is_some() {
        return None;
    }
    crossed.order();
    let odd = crossed.chunk_by(|a, b| a == b).filter(|same| same.len() % 2 == 1);
    Some(odd.map(|same| same[0]).collect())
}

/// The relation of the ray from a point to a triangle.
enum Crossing {
    None,
    One,
    /// The point is on the triangle.
    On,
}

fn crossing(signs: &Signs, triangle: &[[f64; 3]; 3], p: &[f64; 3]) -> Crossing {
    let [a, b, c] = triangle;
    let level = side(signs, triangle, p);
    if level.is_eq() && contains(signs, triangle, p) {
        return Crossing::On;
    }
    let facing = turn(signs, a, b, c, [1, 2]);
    // Seen along x the triangle is a segment, which the moved point is not on.
    if facing.is_eq()
        || [[a, b], [b, c], [c, a]].iter().any(|[s, t]| turn_moved(signs, s, t, p) != facing)
    {
        return Crossing::None;
    }
    // The plane is met at p + t·x with t = −det/nₓ, where nₓ has the sign of `facing`.
    if level == facing.reverse() { Crossing::One } else { Crossing::None }
}

/// The turn from s over t to p, with p moved by (ε, ε²) in the plane of y and z; never 0 unless s and t are one point there.
fn turn_moved(signs: &Signs, s: &[f64; 3], t: &[f64; 3], p: &[f64; 3]) -> Ordering {
    let order = |a: f64, b: f64| a.partial_cmp(&b).unwrap_or(Ordering::Equal);
    turn(signs, s, t, p, [1, 2]).then(order(s[2], t[2])).then(order(t[1], s[1]))
}

/// The sign of the volume of each component.
fn volumes(shape: &Shape, faces: &Faces<'_>) -> Vec<Ordering> {
    let components = &shape.topology.components;
    let origin = |component: u32| {
        let first = components[component as usize].first_triangle;
        faces.places.corners(faces.triangles[first as usize])[0]
    };
    let (triangles, places) = (faces.triangles, faces.places);
    let count = triangles.len();
    // The determinant of a triangle, and the largest size of a number in it.
    let term = |triangle: usize| {
        let o = origin(shape.component[triangle]);
        let corners = places.corners(triangles[triangle]);
        let edges = corners.map(|p| [0, 1, 2].map(|k| DoubleDouble::difference(p[k], o[k])));
        let largest = edges.iter().flatten().fold(0.0, |most: f64, x| most.max(x.high.abs()));
        (Tetrahedra::orientation::<DoubleDouble>(&edges), largest)
    };
    let mut sums = vec![(Compensated::default(), 0.0f64); components.len()];
    // To read the corners, which lie anywhere, takes most of the time, so all threads form the terms. One thread adds them in their order:
    // the same bits for any number of threads.
    for first in (0..count).step_by(BLOCK) {
        let block = first..count.min(first + BLOCK);
        let terms: Vec<_> = block.clone().into_par_iter().with_min_len(TASK).map(term).collect();
        for (component, (value, size)) in shape.component[block].iter().zip(terms) {
            let (sum, largest) = &mut sums[*component as usize];
            *largest = largest.max(size);
            sum.add(value.high);
            sum.add_small(value.low, value.low.abs());
        }
    }
    let is_bounded = faces.places.signs.is_filtered;
    let sign = |(component, (sum, largest)): (usize, &(Compensated, f64))| {
        let known = sum.known();
        let off = Tetrahedra::ORIENTATION.of_double_double(largest.powi(3));
        let error = known.error + components[component].triangles as f64 * off;
        match is_bounded && known.high.abs() > 2.0 * error {
            true if known.high > 0.0 => Ordering::Greater,
            true => Ordering::Less,
            false if shape.is_closed[component] => volume_exactly(shape, faces, component as u32),
            false => Ordering::Equal,
        }
    };
    sums.iter().enumerate().map(sign).collect()
}

/// The same in whole numbers.
fn volume_exactly(shape: &Shape, faces: &Faces<'_>, component: u32) -> Ordering {
    let own = || {
        let numbers = (0u32..).zip(&shape.component).filter(|one| *one.1 == component);
        numbers.map(|one| faces.face(one.0).corners)
    };
    let coordinates = own().flatten().flatten().filter(|&x| x != 0.0);
    let least = coordinates.map(|x| parts(x).1).min().unwrap_or(0);
    let mut sum = Integer::scaled(0.0, 0);
    for corners in own() {
        sum = sum
            .plus(&Tetrahedra::orientation(&corners.map(|p| p.map(|x| Integer::scaled(x, least)))));
    }
    sum.sign()
}
