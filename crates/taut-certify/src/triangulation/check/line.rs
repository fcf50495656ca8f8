//! Points on a line, one point, and none: the chain of the points in lexicographic order.

use super::super::{Fingerprint, MeshViolation, NO_NEIGHBOR, TriangulationVerdict};
use super::prove::{Claim, counted};
use super::signs::lexicographic;
use super::sites::Sites;

/// Checks the simplices of points whose hull has dimension 1 at most, which is known already.
pub(super) fn check<const D: usize>(
    sites: &Sites<D>,
    simplices: &[u32],
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let (fingerprint, hull) = match claim.hull_dimension {
        Some(1) => {
            let edges = simplices.as_chunks().0;
            (fingerprint(sites, edges), chain(sites, edges)?)
        }
        Some(_) => {
            // Further simplices would be copies of the first.
            if simplices.len() > 1 {
                return Err(MeshViolation::Chain { position: 1 });
            }
            (fingerprint::<D, 1>(sites, simplices.as_chunks().0), vec![])
        }
        None => (Fingerprint::default(), vec![]),
    };
    let width = claim.hull_dimension.map_or(1, |dimension| usize::from(dimension) + 1);
    neighbors(claim.neighbors, width)?;
    if let Some((listed, _)) = claim.lists
        && listed != hull
    {
        let differs = |position: &usize| listed.get(*position) != hull.get(*position);
        let position = (0..listed.len().max(hull.len())).find(differs).unwrap_or(0);
        return Err(MeshViolation::HullFacet { position });
    }
    let counts = counted(sites, simplices.len() / width, hull.len());
    Ok(TriangulationVerdict { counts, fingerprint, ties: 0, refined: 0 })
}

fn fingerprint<const D: usize, const V: usize>(
    sites: &Sites<D>,
    simplices: &[[u32; V]],
) -> Fingerprint {
    let mut sum = Fingerprint::default();
    for simplex in simplices {
        sum.add(simplex.map(|site| sites.hashes[site as usize]));
    }
    sum
}

/// The two ends of the chain, by rows.
fn chain<const D: usize>(sites: &Sites<D>, edges: &[[u32; 2]]) -> Result<Vec<u32>, MeshViolation> {
    let mut before = None;
    for (position, &[a, b]) in edges.iter().enumerate() {
        let [p, q] = sites.gather(&[a, b]);
        if before.is_some_and(|before| before != a) || lexicographic(&p, &q).is_ge() {
            return Err(MeshViolation::Chain { position });
        }
        before = Some(b);
    }
    let ends = [edges.first().map(|edge| edge[0]), edges.last().map(|edge| edge[1])];
    Ok(ends.into_iter().flatten().map(|site| sites.rows[site as usize]).collect())
}

/// Beyond the first end of an edge lies the next one, beyond the second the one before.
fn neighbors(given: &[u32], width: usize) -> Result<(), MeshViolation> {
    let last = (given.len() / width).saturating_sub(1);
    for (place, &neighbor) in given.iter().enumerate() {
        let (simplex, facet) = (place / width, place % width);
        let expected = match (width, facet) {
            (2, 0) if simplex < last => simplex as u32 + 1,
            (2, 1) if simplex > 0 => simplex as u32 - 1,
            _ => NO_NEIGHBOR,
        };
        if neighbor != expected {
            let problem = "that is not the next edge of the chain";
            return Err(MeshViolation::Neighbor { simplex, facet, neighbor, problem });
        }
    }
    Ok(())
}
