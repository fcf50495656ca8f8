//! The points that bodies have to contain.

use super::BodiesOptions;
use super::mesh::GridMesh;
use super::pack::{Start, distance};
use super::tree::Tree;
use crate::Error;

/// Units of the grid between a given point and the nearest triangle, at least: a cube in this ball has room for the margin that
/// [`ANCHOR_MARGIN`](super::grow::ANCHOR_MARGIN) keeps.
const GIVEN_CLEARANCE_MIN: f64 = 40.0;

/// Returns the start of the body of each point. Refuses points around which there is no room.
pub(super) fn starts(
    mesh: &GridMesh,
    tree: &Tree,
    options: &BodiesOptions<'_>,
) -> Result<Vec<Start>, Error> {
    let mut starts: Vec<Start> = vec![];
    for (at, &given) in options.at.iter().enumerate() {
        let wrong = |problem| Err(Error::At { at, problem });
        if given.iter().any(|x| !x.is_finite()) {
            return wrong("is not finite");
        }
        let Some(point) = mesh.place(given) else {
            return wrong("is outside of the mesh");
        };
        let clearance = tree.squared_distance(point).sqrt();
        if clearance < GIVEN_CLEARANCE_MIN {
            return wrong("is on the surface, or nearer to it than 40 units of the grid");
        }
        if tree.is_inside(point) != Some(true) {
            return wrong("is outside of the mesh");
        }
        if !mesh.sees_mesh(point) {
            return wrong("is before a hole: caps fill at least a third of the view from there");
        }
        starts.push(Start { point, clearance, is_given: true });
    }
    if options.disjoint {
        for at in 0..starts.len() {
            let others = starts.iter().enumerate().filter(|&(other, _)| other != at);
            let nearest = others.map(|(_, other)| distance(starts[at].point, other.point));
            let half = nearest.fold(f64::INFINITY, f64::min) / 2.0;
            if half < GIVEN_CLEARANCE_MIN {
                let problem = "is too near another point for disjoint bodies around both";
                return Err(Error::At { at, problem });
            }
            starts[at].clearance = starts[at].clearance.min(half);
        }
    }
    Ok(starts)
}
