//! The hull of triangles: one convex polygon, walked once.
//!
//! *Proof.* The edges with a triangle on one side only form one cycle. It turns left or goes straight on at every
//! vertex, so the number of its local minima in lexicographic order is the number of times it turns round. If that is
//! one, it is the boundary of a convex polygon, and winds once around each point inside.

use std::cmp::Ordering;

use super::super::MeshViolation;
use super::geometry::{Geometry, Triangles};
use super::signs::{Signs, lexicographic};
use super::sites::Sites;

/// Stands for no edge.
const NO_EDGE: u32 = u32::MAX;

/// Vertices that are fetched together: their rows are in no order that memory likes, but do not wait for each other.
const AT_ONCE: usize = 1 << 10;

/// Checks the polygon of these edges.
pub(super) fn check<const D: usize>(
    sites: &Sites<'_, D>,
    signs: &Signs,
    edges: Vec<[u32; 2]>,
) -> Result<(), MeshViolation>
where
    Triangles: Geometry<D, 3>,
{
    let steps = linked(edges, sites.rows())?;
    let count = steps.len();
    let (mut ids, mut points) = (Vec::with_capacity(AT_ONCE + 2), Vec::with_capacity(AT_ONCE + 2));
    let (mut edge, mut walked, mut minima) = (0, 0, 0);
    // Each vertex is the middle one of three once, so the first two come again.
    let end = count + 2;
    while walked < end {
        let seen = ids.len();
        let stop = end.min(walked + AT_ONCE);
        while walked < stop {
            let is_start = walked == 0 || walked == count;
            if (edge == 0) != is_start {
                return Err(broken(elsewhere(&steps)));
            }
            let [id, next] = steps[edge];
            ids.push(id);
            edge = next as usize;
            walked += 1;
        }
        points.extend(ids[seen..].iter().map(|&id| sites.point(id)));
        minima += minima_of(signs, &ids, &points)?;
        ids.drain(..ids.len() - 2);
        points.drain(..points.len() - 2);
    }
    match minima {
        1 => Ok(()),
        _ => Err(MeshViolation::HullWinding { row: steps[0][0] }),
    }
}

fn broken(row: u32) -> MeshViolation {
    MeshViolation::HullOpen { dimension: 2, row }
}

/// For each edge the vertex it leaves and the number of the edge after it. The walk goes by numbers of edges, which come
/// in an order that follows space as rows need not.
fn linked(mut edges: Vec<[u32; 2]>, rows: usize) -> Result<Vec<[u32; 2]>, MeshViolation> {
    if edges.is_empty() {
        return Err(broken(0));
    }
    // The edge that leaves each vertex.
    let mut leaving = vec![NO_EDGE; rows];
    for (number, &[a, _]) in (0u32..).zip(&edges) {
        if std::mem::replace(&mut leaving[a as usize], number) != NO_EDGE {
            return Err(broken(a));
        }
    }
    for [_, b] in &mut edges {
        let next = leaving[*b as usize];
        if next == NO_EDGE {
            return Err(broken(*b));
        }
        *b = next;
    }
    Ok(edges)
}

/// A vertex that is not on a cycle with the first one.
fn elsewhere(steps: &[[u32; 2]]) -> u32 {
    let mut is_reached = vec![false; steps.len()];
    let mut edge = 0;
    while !std::mem::replace(&mut is_reached[edge], true) {
        edge = steps[edge][1] as usize;
    }
    // All are reached where the walk runs into itself beside the first one.
    let apart = is_reached.iter().position(|&is_reached| !is_reached);
    steps[apart.unwrap_or(edge)][0]
}

/// The local minima among the vertices but the first and the last, if none of them is a dent.
fn minima_of<const D: usize>(
    signs: &Signs,
    ids: &[u32],
    points: &[[f64; D]],
) -> Result<usize, MeshViolation>
where
    Triangles: Geometry<D, 3>,
{
    let (mut minima, mut before) = (0, lexicographic(&points[0], &points[1]));
    for (corner, ids) in points.array_windows::<3>().zip(ids.windows(3)) {
        let after = lexicographic(&corner[1], &corner[2]);
        if turns_back(signs, corner) {
            return Err(MeshViolation::HullDent { ridge: vec![ids[1]], row: ids[2] });
        }
        minima += usize::from(before == Ordering::Greater && after == Ordering::Less);
        before = after;
    }
    Ok(minima)
}

/// Tests whether the way over three points turns right at the second, or back.
#[inline(always)]
pub(super) fn turns_back<const D: usize>(signs: &Signs, corner: &[[f64; D]; 3]) -> bool
where
    Triangles: Geometry<D, 3>,
{
    match signs.orientation::<Triangles, D, 3>(corner) {
        Ordering::Greater => false,
        // Straight on, not back.
        Ordering::Equal => {
            lexicographic(&corner[0], &corner[1]) != lexicographic(&corner[1], &corner[2])
        }
        Ordering::Less => true,
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Monitor, Points, Scratch};

    use super::super::input::Input;
    use super::*;

    fn around_a_center(edges: &[[u32; 2]]) -> Result<(), MeshViolation> {
        let values = [0., 0., 9., 0., 3., 8., -7., 5., -7., -5., 3., -8.];
        let points = Points::new(&values, 2).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<2>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let sites = Sites::of(&input);
        check(&sites, &input.signs(), edges.to_vec())
    }

    #[test]
    fn a_pentagon_is_convex_and_a_pentagram_winds_twice() {
        assert_eq!(around_a_center(&[[1, 2], [2, 3], [3, 4], [4, 5], [5, 1]]), Ok(()));
        let star = around_a_center(&[[1, 3], [3, 5], [5, 2], [2, 4], [4, 1]]);
        assert!(matches!(star, Err(MeshViolation::HullWinding { .. })), "{star:?}");
        let dent = around_a_center(&[[1, 2], [2, 0], [0, 4], [4, 5], [5, 1]]);
        assert!(matches!(dent, Err(MeshViolation::HullDent { .. })), "{dent:?}");
        let open = around_a_center(&[[1, 2], [2, 3], [3, 4], [4, 5]]);
        assert!(matches!(open, Err(MeshViolation::HullOpen { .. })), "{open:?}");
    }
}
