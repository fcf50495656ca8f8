//! The certificate of bodies with any facets: one facet separates each triangle, so that the checker needs no weights.

use taut_certify::{BodyProof, ConvexBody};

use super::super::mesh::GridMesh;
use super::super::polytope;
use super::super::proof::{Proved, inner_point, unproved};
use super::super::tree::Tree;
use super::FreeBody;
use super::disjoint::{Shape, separation};
use crate::Error;

/// Proves bodies one by one and leaves out those without proof, which rounding may cause for bodies of a few units.
pub(in super::super) fn prove(
    mesh: &GridMesh,
    tree: &Tree,
    bodies: Vec<FreeBody>,
    disjoint: bool,
) -> Result<Proved, Error> {
    let unit = 2f64.powi(mesh.exponent);
    let mut kept: Vec<Shape> = vec![];
    let mut pairs: Vec<Vec<Vec<u64>>> = vec![];
    let mut proved = Proved::default();
    for (at, mut body) in bodies.into_iter().enumerate() {
        let before = body.sides.clone();
        if !mesh.is_exact {
            // Floors and ceilings of coordinates differ by at most one unit from the rounded coordinates.
            for (u, offset) in body.sides.normals.iter().zip(&mut body.sides.offsets) {
                *offset -= u.iter().map(|n| n.abs()).sum::<f64>();
            }
        }
        let mut shape = Shape::of(&body.sides, body.anchor);
        let with_others: Option<Vec<Vec<u64>>> = match disjoint {
            true => kept.iter().map(|other| separation(other, &mut shape)).collect(),
            false => Some(vec![]),
        };
        let inside = inner_point(mesh, tree, &shape.sides, &before, body.anchor);
        let (Some(with_others), Some(inside)) = (with_others, inside) else {
            if body.is_given {
                return Err(unproved(at));
            }
            continue;
        };
        proved.bodies.push(ConvexBody {
            normals: shape.sides.normals.iter().map(|u| u.map(|n| n as i64)).collect(),
            offsets: shape.sides.offsets.iter().map(|&h| h as i64).collect(),
            volume: polytope::volume(&shape.sides, inside) * unit * unit * unit,
        });
        let inside = inside.map(i64::from);
        proved.proofs.push(BodyProof { inside, combined: vec![] });
        kept.push(shape);
        pairs.push(with_others);
    }
    if disjoint {
        for first in 0..pairs.len() {
            proved.pairs.extend(pairs[first + 1..].iter().map(|list| list[first].clone()));
        }
    }
    Ok(proved)
}
