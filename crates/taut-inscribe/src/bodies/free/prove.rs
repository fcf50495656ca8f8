//! The certificate of bodies with any facets: one facet separates each triangle, so that the checker needs no weights. Cubes that
//! did not grow are proved as k-dops.

use taut_certify::{BodyProof, ConvexBody};
use taut_points::two_to;

use super::super::grow::Dop;
use super::super::mesh::GridMesh;
use super::super::polytope::{self, Sides};
use super::super::proof::{Proved, inner_point, separated, unproved};
use super::super::tree::Tree;
use super::disjoint::{Shape, separation};
use super::{FreeBody, Stage};
use crate::Error;

/// Proves bodies one by one and leaves out those without proof, which rounding may cause for bodies of a few units.
pub(in super::super) fn prove(
    mesh: &GridMesh,
    tree: &Tree,
    bodies: Vec<FreeBody>,
    disjoint: bool,
) -> Result<Proved, Error> {
    let unit = two_to(mesh.exponent);
    let mut kept: Vec<Shape> = vec![];
    let mut pairs: Vec<Vec<Vec<u64>>> = vec![];
    let mut proved = Proved::default();
    for (at, body) in bodies.into_iter().enumerate() {
        let found = prove_one(mesh, tree, &body, if disjoint { &kept } else { &[] });
        let Some((shape, with_others, inside, combined)) = found else {
            if body.kept.is_some() {
                return Err(unproved(at));
            }
            continue;
        };
        proved.bodies.push(ConvexBody {
            normals: shape.sides.normals.iter().map(|u| u.map(|n| n as i64)).collect(),
            offsets: shape.sides.offsets.iter().map(|&h| h as i64).collect(),
            volume: polytope::volume(&shape.sides, inside) * unit * unit * unit,
        });
        proved.proofs.push(BodyProof { inside: inside.map(i64::from), combined });
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

/// What proves a body: its final half-spaces, weights for each other body, a point inside, and weights for triangles.
type Found = (Shape, Vec<Vec<u64>>, [i32; 3], Vec<Vec<u64>>);

/// Proves that one body is inside, and disjoint from others.
fn prove_one(mesh: &GridMesh, tree: &Tree, body: &FreeBody, others: &[Shape]) -> Option<Found> {
    let (mut sides, combined) = match body.stage {
        Stage::Cube => separated_cube(tree, body)?,
        Stage::Box => return None,
        Stage::Grown => (body.sides.clone(), vec![]),
    };
    if !mesh.is_exact {
        // Floors and ceilings of coordinates differ by at most one unit from the rounded coordinates.
        for (u, offset) in sides.normals.iter().zip(&mut sides.offsets) {
            *offset -= u.iter().map(|n| n.abs()).sum::<f64>();
        }
    }
    let mut shape = Shape::of(&sides, body.anchor);
    let with_others: Option<Vec<Vec<u64>>> =
        others.iter().map(|other| separation(other, &mut shape)).collect();
    let inside = inner_point(mesh, tree, &shape.sides, &body.sides, body.anchor)?;
    Some((shape, with_others?, inside, combined))
}

/// Weights that separate triangles from a cube.
fn separated_cube(tree: &Tree, body: &FreeBody) -> Option<(Sides, Vec<Vec<u64>>)> {
    let mut h = [0; _];
    for (h, &offset) in h.iter_mut().zip(&body.sides.offsets) {
        *h = offset as i32;
    }
    let cube = Dop::new(h, body.anchor);
    let (h, combined) = separated(tree, &cube)?;
    Some((Sides::of_dop(&tree.directions, &h), combined))
}
