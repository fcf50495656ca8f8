//! Points on a line, one point, and none: the chain of the points in lexicographic order.

use taut_points::OrderBy;

use super::super::{Fingerprint, MeshViolation, NO_NEIGHBOR, TriangulationVerdict};
use super::prove::{Claim, counted};
use super::signs::lexicographic;
use super::sites::{Recent, Sites};

/// Checks the simplices of points whose hull has dimension 1 at most, which is known already.
pub(super) fn check<const D: usize>(
    sites: &Sites<'_, D>,
    claim: &Claim<'_>,
) -> Result<TriangulationVerdict, MeshViolation> {
    let simplices = claim.simplices;
    let (fingerprint, hull) = match claim.hull_dimension {
        Some(1) => {
            let edges = simplices.as_chunks().0;
            let hull = match claim.lists {
                Some(_) => chain(sites, edges.iter().copied().enumerate())?,
                None => chain(sites, along(sites, edges))?,
            };
            (fingerprint(sites, edges), hull)
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
    claim.covers(sites)?;
    let counts = counted(sites, simplices.len() / width, hull.len());
    Ok(TriangulationVerdict { counts, fingerprint, ties: 0, refined: 0 })
}

fn fingerprint<const D: usize, const V: usize>(
    sites: &Sites<'_, D>,
    simplices: &[[u32; V]],
) -> Fingerprint {
    let mut sum = Fingerprint::default();
    let mut recent = Recent::new(0);
    for simplex in simplices {
        sum.add(simplex.map(|id| recent.vertex(sites, id).hash));
    }
    sum
}

/// Edges that come in no order and face either way, with their positions: turned and sorted by their first ends.
fn along<const D: usize>(
    sites: &Sites<'_, D>,
    edges: &[[u32; 2]],
) -> impl Iterator<Item = (usize, [u32; 2])> {
    let order = |a: u32, b: u32| {
        let [p, q] = sites.gather(&[a, b]);
        lexicographic(&p, &q)
    };
    let turned = |&[a, b]: &[u32; 2]| if order(a, b).is_gt() { [b, a] } else { [a, b] };
    let mut edges: Vec<_> = edges.iter().map(turned).enumerate().collect();
    edges.order_by(&|(_, e), (_, f)| order(e[0], f[0]));
    edges.into_iter()
}

/// The two ends of the chain, by rows.
fn chain<const D: usize>(
    sites: &Sites<'_, D>,
    edges: impl Iterator<Item = (usize, [u32; 2])>,
) -> Result<Vec<u32>, MeshViolation> {
    let mut ends: Option<[u32; 2]> = None;
    for (position, [a, b]) in edges {
        let [p, q] = sites.gather(&[a, b]);
        if ends.is_some_and(|ends| ends[1] != a) || lexicographic(&p, &q).is_ge() {
            return Err(MeshViolation::Chain { position });
        }
        ends = Some([ends.map_or(a, |ends| ends[0]), b]);
    }
    Ok(ends.into_iter().flatten().collect())
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
