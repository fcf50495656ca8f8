//! All sets that one ball of a radius less than ρ can hold, or larger ones in their place.
//!
//! *Idea.* Let ρ₂ = ρ(1 − 4e-9). Points Y fit in a ball of radius ρ₂ just when the balls of radius ρ₂ around them have a
//! common point. The balls of a slightly larger radius ρ₃ then have a common body C with inner points. If Y is more than
//! one place, C is bounded by pieces of several of these equal spheres, as none is within another. In the plane two such
//! arcs meet at a corner of C, at a distance ρ₃ from two points of Y. In space two pieces meet along an arc of the circle at
//! a distance ρ₃ from two points a, b of Y; the arc is the whole circle, and then any point of it is in C, or it ends at a
//! third sphere, at a distance ρ₃ from three points of Y. So the points at a distance ρ₃ from two, or from three, and one for
//! each pair in space, are enough: Y lies within ρ₃ of one of them.
//! *Near points.* Of points less than δ = 1e-10·ρ apart one speaks for all. Then ρ₃ = ρ₂ + 1.2e-9·ρ has room for δ, and so has
//! the radius ρ₂ + 2e-9·ρ within which items are taken.
//! *Rounding.* Corners are computed about one of their points. For two points of Y, at most 2(ρ₂ + δ) apart, the height
//! h = √(ρ₃² − D²/4) is at least 4e-5·ρ, so the corner is off by less than 1e-15·ρ²/h < 1e-10·ρ, for which the radius has room
//! too. A corner of three points can be as good as tangent, and is then off by more: the bound on that is added to its
//! radius.
//! *What it proves.* If k of these sets do not cover the items, no k balls of a radius less than ρ₂ do. Conversely, what
//! lies within ρ₂ + 2e-9·ρ of a place is held by a ball of a radius less than ρ: so sets from two points never cover what
//! the first search proves not to be covered.

use super::super::core::Core;
use super::super::meter::{Meter, Stop};
use super::sets::Set;
use crate::arithmetic::U;

/// δ, in units of ρ: items within this of each other are at one place.
const POINT_REACH_MAX: f64 = 1e-10;
/// ρ₃, in units of ρ: the radius of the circles and spheres whose corners are candidates.
const RIM_RADIUS: f64 = 1.0 - 4e-9 + 1.2e-9;
/// The radius, in units of ρ, within which items are taken.
const TAKEN_RADIUS: f64 = 1.0 - 4e-9 + 2e-9;

/// Differences of items from one of them, scaled.
struct About<const D: usize> {
    places: Vec<[f64; D]>,
}

impl<const D: usize> About<D> {
    fn of(core: &Core, origin: usize) -> Self {
        let up = core.scale.up;
        let place = |item: usize| -> [f64; D] {
            std::array::from_fn(|j| (core.place(item)[j] - core.place(origin)[j]) * up)
        };
        About { places: (0..core.len()).map(place).collect() }
    }

    /// What lies within a distance of a place.
    fn within(&self, center: [f64; D], distance: f64) -> Set {
        let mut set = Set::default();
        for (item, place) in self.places.iter().enumerate() {
            let square: f64 = place.iter().zip(center).map(|(x, c)| (x - c) * (x - c)).sum();
            if square <= distance * distance {
                set.insert(item);
            }
        }
        set
    }
}

fn dot<const D: usize>(a: [f64; D], b: [f64; D]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// a + t·b.
fn along<const D: usize>(a: [f64; D], t: f64, b: [f64; D]) -> [f64; D] {
    std::array::from_fn(|j| a[j] + t * b[j])
}

/// Items that speak for all others: no two of them nearer than δ.
fn speakers<const D: usize>(core: &Core) -> Vec<usize> {
    let mut speakers: Vec<usize> = vec![];
    for item in 0..core.len() {
        let about = |&speaker: &usize| {
            let difference: [f64; D] = std::array::from_fn(|j| {
                (core.place(item)[j] - core.place(speaker)[j]) * core.scale.up
            });
            dot(difference, difference).sqrt() < POINT_REACH_MAX * core.reach(item)
        };
        if !speakers.iter().any(about) {
            speakers.push(item);
        }
    }
    speakers
}

/// Sets for points in the plane; O(n³).
pub(super) fn in_the_plane(core: &Core, meter: &mut Meter<'_>) -> Result<Vec<Set>, Stop> {
    let mut sets = vec![];
    let speakers = speakers::<2>(core);
    for (position, &first) in speakers.iter().enumerate() {
        // At most two sets a pair, for each of which all items are looked at.
        meter.spend(2 * 2 * core.len() * (speakers.len() - position))?;
        let (about, rho) = (About::<2>::of(core, first), core.reach(first));
        sets.push(about.within([0.0; 2], TAKEN_RADIUS * rho));
        for &second in &speakers[position + 1..] {
            let edge = about.places[second];
            let Some((distance, height)) = rim(edge, RIM_RADIUS * rho) else { continue };
            let normal = [-edge[1] / distance, edge[0] / distance];
            for height in [height, -height] {
                let corner = along(along([0.0; 2], 0.5, edge), height, normal);
                sets.push(about.within(corner, TAKEN_RADIUS * rho));
            }
        }
    }
    Ok(sets)
}

/// Sets for points in space; O(n⁴).
pub(super) fn in_space(core: &Core, meter: &mut Meter<'_>) -> Result<Vec<Set>, Stop> {
    let mut found = std::collections::HashSet::new();
    let speakers = speakers::<3>(core);
    for (position, &first) in speakers.iter().enumerate() {
        meter.spend(3 * core.len() * (speakers.len() - position))?;
        let (about, rho) = (About::<3>::of(core, first), core.reach(first));
        found.insert(about.within([0.0; 3], TAKEN_RADIUS * rho));
        for &second in &speakers[position + 1..] {
            let edge = about.places[second];
            let Some((_, height)) = rim(edge, RIM_RADIUS * rho) else { continue };
            let corner = along(along([0.0; 3], 0.5, edge), height, normal_to(edge));
            found.insert(about.within(corner, TAKEN_RADIUS * rho));
        }
        // Triples are looked at from the corner that is opposite to their longest side.
        let near: Vec<[f64; 3]> = speakers
            .iter()
            .filter(|&&other| other != first)
            .map(|&other| about.places[other])
            .filter(|&edge| rim(edge, RIM_RADIUS * rho).is_some())
            .collect();
        for (position, &a) in near.iter().enumerate() {
            for &b in &near[position + 1..] {
                let side = along(a, -1.0, b);
                if dot(side, side) < dot(a, a).max(dot(b, b)) * (1.0 - 1e-9) {
                    continue;
                }
                meter.spend(32)?;
                for (corner, off) in corners(a, b, RIM_RADIUS * rho).into_iter().flatten() {
                    meter.spend(3 * core.len())?;
                    found.insert(about.within(corner, TAKEN_RADIUS * rho + off));
                }
            }
        }
    }
    let mut sets: Vec<Set> = found.into_iter().collect();
    sets.sort_unstable();
    Ok(sets)
}

/// Of the points at a distance `rho` from 0 and from the end of an edge: how long the edge is, and how far they are from
/// its middle. `None` where there are none, and for an edge of no length.
fn rim<const D: usize>(edge: [f64; D], rho: f64) -> Option<(f64, f64)> {
    let square = dot(edge, edge);
    let height = rho * rho - square / 4.0;
    (square > 0.0 && height >= 0.0).then(|| (square.sqrt(), height.sqrt()))
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Some direction of length 1 at a right angle to an edge.
fn normal_to(edge: [f64; 3]) -> [f64; 3] {
    let size = edge.map(f64::abs);
    let axis = if size[0] <= size[1] && size[0] <= size[2] {
        [1.0, 0.0, 0.0]
    } else if size[1] <= size[2] {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let normal = cross(edge, axis);
    let length = dot(normal, normal).sqrt();
    normal.map(|x| x / length)
}

/// The points at a distance `rho` from 0, a and b, with a bound on what each is off by, where |a − b| ≥ |a|, |b| ≥ δ.
///
/// With n = a × b the centre of the circle through the three is m = (|b|² n × a + |a|² b × n)/2|n|², and the points are
/// m ± √(rho² − |m|²)·n/|n|. The entries of n are off by at most 4u|a||b|, and so n by a part ν = 8u|a||b|/|n| of its length, m
/// by less than 16(u + ν)(|a| + |b|)|a||b|/|n|. Where rounding leaves the sign of the root open, it is taken for 0. As
/// |a||b||a − b|/2|n| is the radius of the circle, ν ≤ 16u·rho/|a − b| < 1e-4 wherever there are such points.
fn corners(a: [f64; 3], b: [f64; 3], rho: f64) -> Option<[([f64; 3], f64); 2]> {
    let (aa, bb) = (dot(a, a), dot(b, b));
    let side = along(a, -1.0, b);
    if dot(side, side) > 4.0 * rho * rho {
        return None;
    }
    let n = cross(a, b);
    let nn = dot(n, n);
    let lengths = (aa * bb).sqrt();
    let part = 8.0 * U * lengths / nn.sqrt();
    let is_known = part < 1e-3;
    if !is_known {
        return None;
    }
    let (na, bn) = (cross(n, a), cross(b, n));
    let m: [f64; 3] = std::array::from_fn(|j| (bb * na[j] + aa * bn[j]) / (2.0 * nn));
    let off = 16.0 * (U + part) * (aa.sqrt() + bb.sqrt()) * lengths / nn.sqrt();
    let mm = dot(m, m);
    let square = rho * rho - mm;
    let off_square = (2.0 * mm.sqrt() + off) * off + 8.0 * U * (rho * rho + mm);
    if square < -off_square {
        return None;
    }
    let height = square.max(0.0).sqrt();
    let off_height = match square > off_square {
        true => off_square / height,
        false => (2.0 * off_square).sqrt(),
    };
    let off = off + off_height + (part + 8.0 * U) * height;
    let direction = n.map(|x| x / nn.sqrt());
    Some([height, -height].map(|height| (along(m, height, direction), off)))
}
