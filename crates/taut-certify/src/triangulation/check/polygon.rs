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
use super::sites::{NO_SITE, Sites};

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
    let mut next = vec![NO_SITE; sites.rows()];
    for &(triangle, edge) in open {
        let [a, b] = triangles[triangle as usize].facet(usize::from(edge));
        if next[a as usize] != NO_SITE {
            return Err(broken(a));
        }
        next[a as usize] = b;
    }
    if let Some(listed) = listed {
        is_listed(triangles, open, listed, &next)?;
    }
    let Some(&(triangle, edge)) = open.first() else { return Err(broken(0)) };
    let [start, _] = triangles[triangle as usize].facet(usize::from(edge));
    let (mut a, mut steps, mut minima) = (start, 0, 0);
    loop {
        let b = next[a as usize];
        if b == NO_SITE {
            return Err(broken(a));
        }
        let c = next[b as usize];
        if c == NO_SITE {
            return Err(broken(b));
        }
        let corner = sites.gather(&[a, b, c]);
        let (before, after) =
            (lexicographic(&corner[0], &corner[1]), lexicographic(&corner[1], &corner[2]));
        let is_dent = match signs.orientation::<Triangles, D, 3>(&corner) {
            Ordering::Greater => false,
            // Straight on, not back.
            Ordering::Equal => before != after,
            Ordering::Less => true,
        };
        if is_dent {
            return Err(MeshViolation::HullDent { ridge: vec![b], row: c });
        }
        minima += usize::from(before == Ordering::Greater && after == Ordering::Less);
        (a, steps) = (b, steps + 1);
        if a == start {
            break;
        }
        // A cycle that does not come back to its start has an edge twice.
        if steps == open.len() {
            return Err(broken(a));
        }
    }
    if steps != open.len() {
        for _ in 0..steps {
            a = std::mem::replace(&mut next[a as usize], NO_SITE);
        }
        let mut starts = open.iter().map(|&(t, e)| triangles[t as usize].facet(usize::from(e))[0]);
        let elsewhere = starts.find(|&site| next[site as usize] != NO_SITE);
        return Err(broken(elsewhere.unwrap_or(start)));
    }
    match minima {
        1 => Ok(()),
        _ => Err(MeshViolation::HullWinding { row: start }),
    }
}

fn is_listed(
    triangles: &[[u32; 3]],
    open: &[(u32, u8)],
    listed: &[u32],
    next: &[u32],
) -> Result<(), MeshViolation> {
    let mut seen = vec![false; next.len()];
    for (position, edge) in listed.chunks_exact(2).enumerate() {
        let (a, b) = (edge[0] as usize, edge[1]);
        // NO_SITE may be listed as well, and stands for the ends of all that are not on the hull.
        if b == NO_SITE || next.get(a) != Some(&b) || seen[a] {
            return Err(MeshViolation::HullFacet { position });
        }
        seen[a] = true;
    }
    for &(triangle, edge) in open {
        let (simplex, facet) = (triangle as usize, usize::from(edge));
        if !seen[triangles[simplex].facet(facet)[0] as usize] {
            return Err(MeshViolation::Open { simplex, facet });
        }
    }
    Ok(())
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
