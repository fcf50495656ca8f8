//! The points and segments that bodies have to contain.

use super::BodiesOptions;
use super::mesh::GridMesh;
use super::pack::{Segment, Start};
use super::segment;
use super::tree::{Tree, squared_distance};
use crate::Error;

/// Units of the grid between a given point or segment and the nearest triangle, at least: a cube in this ball has room for the margin that
/// [`ANCHOR_MARGIN`](super::grow::ANCHOR_MARGIN) keeps.
const GIVEN_CLEARANCE_MIN: f64 = 40.0;

/// Returns the start of the body of each point or segment. Refuses those around which there is no room.
pub(super) fn starts(
    mesh: &GridMesh,
    tree: &Tree,
    options: &BodiesOptions<'_>,
) -> Result<Vec<Start>, Error> {
    let mut starts: Vec<Start> = vec![];
    for (at, &given) in options.at.iter().enumerate() {
        let wrong = |problem| Err(Error::At { at, problem });
        let end = options.ends.get(at).copied().unwrap_or(given);
        if given.iter().chain(&end).any(|x| !x.is_finite()) {
            return wrong("is not finite");
        }
        let (Some(from), Some(to)) = (mesh.place(given), mesh.place(end)) else {
            return wrong("is outside of the mesh");
        };
        let ends = [from, to];
        let point = [0, 1, 2].map(|c| from[c].midpoint(to[c]));
        let clearance = tree.clearance(ends);
        if clearance < GIVEN_CLEARANCE_MIN {
            return wrong(match from == to {
                true => "is on a surface or an obstacle, or nearer to it than 40 units of the grid",
                false => {
                    "meets a surface or an obstacle, or is nearer to it than 40 units of the grid"
                }
            });
        }
        if tree.is_inside(from) != Some(true) {
            let is_alone = mesh.solids == 0;
            return wrong(match is_alone {
                true => "is outside of the mesh",
                false => "is outside of the mesh, or in a solid obstacle",
            });
        }
        if !mesh.sees_mesh(point) {
            return wrong("is before a hole: caps fill at least a third of the view from there");
        }
        starts.push(Start { point, ends, clearance, is_given: true });
    }
    if options.disjoint {
        for at in 0..starts.len() {
            let others = starts.iter().enumerate().filter(|&(other, _)| other != at);
            let nearest = others.map(|(_, other)| between(starts[at].ends, other.ends));
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

/// The distance between two segments.
fn between(one: Segment, other: Segment) -> f64 {
    let [one, [from, to]] = [one, other].map(|ends| ends.map(|end| end.map(f64::from)));
    segment::least(one, |p| squared_distance(p, &[from, to, to])).0.sqrt()
}
