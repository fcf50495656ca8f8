//! The hull of triangles: one convex polygon, walked once.
//!
//! *Proof.* The edges with a triangle on one side only form one cycle. It turns left or goes straight on at every
//! vertex, so the number of its local minima in lexicographic order is the number of times it turns round. If that is
//! one, it is the boundary of a convex polygon, and winds once around each point inside.

use std::cmp::Ordering;

use super::super::MeshViolation;
use super::facets::Facets;
use super::geometry::{Geometry, Triangles};
use super::signs::{Signs, lexicographic};
use super::sites::Sites;

/// Stands for no edge.
const NO_EDGE: u32 = u32::MAX;

/// Checks the polygon of the open edges, and that `listed` has just these, if it is given.
pub(super) fn check<const D: usize>(
    sites: &Sites<'_, D>,
    signs: &Signs,
    triangles: &[[u32; 3]],
    open: &[(u32, u8)],
    listed: Option<&[u32]>,
) -> Result<(), MeshViolation>
where
    Triangles: Geometry<D, 3>,
{
    let broken = |row: u32| MeshViolation::HullOpen { dimension: 2, row };
    let edges: Vec<[u32; 2]> =
        open.iter().map(|&(t, e)| triangles[t as usize].facet(usize::from(e))).collect();
    // The edge that leaves each vertex.
    let mut leaving = vec![NO_EDGE; sites.rows()];
    for (number, &[a, _]) in (0u32..).zip(&edges) {
        if std::mem::replace(&mut leaving[a as usize], number) != NO_EDGE {
            return Err(broken(a));
        }
    }
    if let Some(listed) = listed {
        is_listed(&edges, open, listed, &leaving)?;
    }
    // The walk goes by numbers of edges, which come in an order that follows space as rows need not.
    let next: Vec<u32> = edges.iter().map(|&[_, b]| leaving[b as usize]).collect();
    if let Some(last) = next.iter().position(|&next| next == NO_EDGE) {
        return Err(broken(edges[last][1]));
    }
    let points: Vec<[f64; D]> = edges.iter().map(|&[a, _]| sites.point(a)).collect();
    if edges.is_empty() {
        return Err(broken(0));
    }
    let (mut reached, mut edge, mut minima) = (vec![false; edges.len()], 0, 0);
    let mut corner = [points[0]; 3];
    corner[1] = points[next[0] as usize];
    loop {
        let second = next[edge] as usize;
        let third = next[second] as usize;
        corner[2] = points[third];
        let (before, after) =
            (lexicographic(&corner[0], &corner[1]), lexicographic(&corner[1], &corner[2]));
        let is_dent = match signs.orientation::<Triangles, D, 3>(&corner) {
            Ordering::Greater => false,
            // Straight on, not back.
            Ordering::Equal => before != after,
            Ordering::Less => true,
        };
        if is_dent {
            let [ridge, row] = [second, third].map(|edge| edges[edge][0]);
            return Err(MeshViolation::HullDent { ridge: vec![ridge], row });
        }
        minima += usize::from(before == Ordering::Greater && after == Ordering::Less);
        reached[edge] = true;
        edge = second;
        corner = [corner[1], corner[2], corner[2]];
        if reached[edge] {
            break;
        }
    }
    if edge != 0 {
        return Err(broken(edges[edge][0]));
    }
    if let Some(elsewhere) = reached.iter().position(|&reached| !reached) {
        return Err(broken(edges[elsewhere][0]));
    }
    match minima {
        1 => Ok(()),
        _ => Err(MeshViolation::HullWinding { row: edges[0][0] }),
    }
}

fn is_listed(
    edges: &[[u32; 2]],
    open: &[(u32, u8)],
    listed: &[u32],
    leaving: &[u32],
) -> Result<(), MeshViolation> {
    let mut seen = vec![false; edges.len()];
    for (position, &edge) in listed.as_chunks().0.iter().enumerate() {
        let found = leaving.get(edge[0] as usize).map_or(NO_EDGE, |&number| number) as usize;
        if edges.get(found) != Some(&edge) || std::mem::replace(&mut seen[found], true) {
            return Err(MeshViolation::HullFacet { position });
        }
    }
    match seen.iter().position(|&seen| !seen) {
        Some(place) => {
            let (simplex, facet) = (open[place].0 as usize, usize::from(open[place].1));
            Err(MeshViolation::Open { simplex, facet })
        }
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use taut_points::{Monitor, Points, Scratch};

    use super::super::input::Input;
    use super::*;

    fn around_a_centre(edges: &[[u32; 2]]) -> Result<(), MeshViolation> {
        let values = [0., 0., 9., 0., 3., 8., -7., 5., -7., -5., 3., -8.];
        let points = Points::new(&values, 2).unwrap();
        let mut scratch = Scratch::new();
        let input = Input::<2>::read(&points, &mut scratch, &Monitor::silent()).unwrap();
        let simplices: Vec<u32> = edges.iter().flat_map(|&[a, b]| [0, a, b]).collect();
        let sites = Sites::of(&input, &simplices, 3).unwrap();
        let open: Vec<(u32, u8)> = (0..edges.len() as u32).map(|triangle| (triangle, 0)).collect();
        check(&sites, &input.signs(), simplices.as_chunks().0, &open, None)
    }

    #[test]
    fn a_pentagon_is_convex_and_a_pentagram_winds_twice() {
        assert_eq!(around_a_centre(&[[1, 2], [2, 3], [3, 4], [4, 5], [5, 1]]), Ok(()));
        let star = around_a_centre(&[[1, 3], [3, 5], [5, 2], [2, 4], [4, 1]]);
        assert!(matches!(star, Err(MeshViolation::HullWinding { .. })), "{star:?}");
        let dent = around_a_centre(&[[1, 2], [2, 0], [0, 4], [4, 5], [5, 1]]);
        assert!(matches!(dent, Err(MeshViolation::HullDent { .. })), "{dent:?}");
        let open = around_a_centre(&[[1, 2], [2, 3], [3, 4], [4, 5]]);
        assert!(matches!(open, Err(MeshViolation::HullOpen { .. })), "{open:?}");
    }
}
