//! Curves as features of GeoJSON (RFC 7946).
//!
//! *Idea.* A loop within an even number of others is the outer ring of a polygon, and the loops right within it are its holes. Open
//! curves are line strings; of what has too few vertices for a ring there is a line string, or a point.
//! *Guarantee.* Outer rings run counter-clockwise and holes clockwise, by exact signs; a ring ends where it begins. Each feature names
//! its curves by number, the outer one first.
//! *Trap.* Areas by sums are lost to rounding for slender rings far from the origin: the turn at the lowest vertex tells which way a
//! ring runs.

use taut_mesh::{Polyline, is_counter_clockwise, parents};

use super::Text;
use crate::Error;

pub(super) fn write(curves: &[Polyline<'_>], text: &mut Text<'_>) -> Result<(), Error> {
    let parents = parents(curves);
    let is_ring = |curve: &Polyline<'_>| curve.closed && curve.vertices.len() >= 3;
    // Of each loop, how many are around it, and what is right within.
    let mut holes: Vec<Vec<usize>> = vec![Vec::new(); curves.len()];
    let mut is_outer = vec![false; curves.len()];
    for number in 0..curves.len() {
        let depth =
            std::iter::successors(parents[number], |&outer| parents[outer as usize]).count();
        is_outer[number] = depth % 2 == 0;
        if let Some(parent) = parents[number]
            && is_ring(&curves[number])
            && depth % 2 == 1
        {
            holes[parent as usize].push(number);
        }
    }
    text.put("{\"type\": \"FeatureCollection\", \"features\": [");
    let mut first = true;
    for (number, curve) in curves.iter().enumerate() {
        if curve.vertices.is_empty() || (is_ring(curve) && !is_outer[number]) {
            continue;
        }
        let rings: Vec<usize> =
            std::iter::once(number).chain(holes[number].iter().copied()).collect();
        let kind = match (is_ring(curve), curve.vertices.len()) {
            (true, _) => "Polygon",
            (false, 1) => "Point",
            (false, _) => "LineString",
        };
        text.put(if first { "\n" } else { ",\n" });
        first = false;
        text.put(&format!(
            "{{\"type\": \"Feature\", \"properties\": {{\"curves\": {rings:?}}}, \"geometry\": {{\"type\": \"{kind}\", \
             \"coordinates\": "
        ));
        match kind {
            "Polygon" => {
                for (place, &ring) in rings.iter().enumerate() {
                    text.put(if place == 0 { "[" } else { ", " });
                    let forward = is_counter_clockwise(&curves[ring]) == (place == 0);
                    write_ring(curves[ring].vertices, forward, text)?;
                }
                text.put("]");
            }
            "Point" => place(curve.vertices[0], text),
            _ => chain(curve.vertices.iter(), text)?,
        }
        text.put("}}");
        text.spill()?;
    }
    text.put("\n]}\n");
    Ok(())
}

/// A ring from its first vertex back to it, forwards or backwards.
fn write_ring(vertices: &[[f64; 2]], forward: bool, text: &mut Text<'_>) -> Result<(), Error> {
    match forward {
        true => chain(vertices.iter().chain(&vertices[..1]), text),
        false => chain(vertices[..1].iter().chain(vertices.iter().rev()), text),
    }
}

fn chain<'a>(
    vertices: impl Iterator<Item = &'a [f64; 2]>,
    text: &mut Text<'_>,
) -> Result<(), Error> {
    for (number, &at) in vertices.enumerate() {
        text.put(if number == 0 { "[" } else { ", " });
        place(at, text);
        text.spill()?;
    }
    text.put("]");
    Ok(())
}

pub(super) fn place([x, y]: [f64; 2], text: &mut Text<'_>) {
    text.put("[");
    text.number(x);
    text.put(", ");
    text.number(y);
    text.put("]");
}
