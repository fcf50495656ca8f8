//! Which way triangles turn.
//!
//! *Idea.* Triangles that share an edge are alike if they run along it in opposite directions. What hangs together so is turned alike, the
//! whole so that its volume is positive; of a one-sided part, where that cannot be, as much as comes first.
//! *Guarantee.* O(n log n), a function of the triangles in their order.

use super::border::{Face, parts};
use super::parity::ParityUnionFind;
use super::spheres::{Point, cross, dot, minus};

/// A side of a triangle: its ends in order, the number of the triangle, and whether it runs along the side in that order.
type Side = ([u32; 2], u32, bool);

/// All sides, those of one edge side by side.
fn sides_of(faces: &[Face]) -> Vec<Side> {
    let mut sides: Vec<Side> = Vec::with_capacity(3 * faces.len());
    for (number, face) in (0u32..).zip(faces) {
        let [a, b, c] = face.sites;
        let side = |[p, q]: [u32; 2]| ([p.min(q), p.max(q)], number, p < q);
        sides.extend([[a, b], [b, c], [c, a]].map(side));
    }
    sides.sort_unstable();
    sides
}

/// Returns true if some part has one side: no way to turn its triangles makes all alike.
pub(super) fn has_one_side(faces: &[Face]) -> bool {
    let sides = sides_of(faces);
    let mut parity = ParityUnionFind::new(faces.len());
    sides.chunk_by(|one, other| one.0 == other.0).any(|edge| match edge {
        [one, other] => {
            let is_turned = one.2 == other.2;
            !parity.join(one.1, other.1, is_turned)
                && (parity.root(one.1) ^ parity.root(other.1)) & 1 != u32::from(is_turned)
        }
        _ => false,
    })
}

/// Turns triangles alike, and closed parts outward.
pub(super) fn orient(faces: &mut [Face], points: &[Point]) {
    let sides = sides_of(faces);
    let mut parity = ParityUnionFind::new(faces.len());
    for edge in sides.chunk_by(|one, other| one.0 == other.0) {
        if let [one, other] = edge {
            parity.join(one.1, other.1, one.2 == other.2);
        }
    }
    let (sides, _) = parity.numbered();
    let turn = |face: &mut Face| face.sites.swap(1, 2);
    let opposite = (0u32..).zip(&mut *faces).filter(|(number, _)| sides[*number as usize] & 1 == 1);
    opposite.for_each(|(_, face)| turn(face));
    let part = parts(faces, points.len());
    let part_of = |face: &Face| part[face.sites[0] as usize] as usize;
    let mut volume = vec![0.0; points.len()];
    for face in &*faces {
        let base = points[part_of(face)];
        let [a, b, c] = face.sites.map(|site| minus(points[site as usize], base));
        volume[part_of(face)] += dot(a, cross(b, c));
    }
    let is_inward = |face: &&mut Face| volume[part_of(face)] < 0.0;
    faces.iter_mut().filter(is_inward).for_each(turn);
}
