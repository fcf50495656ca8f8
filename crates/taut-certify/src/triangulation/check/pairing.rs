//! Neighbours found by sorting the facets, for simplices that come without.
//!
//! *Idea.* Facets go to buckets by their smallest vertex, with one counting sort, and each bucket, a handful, is sorted
//! by the other vertices. O(n + simplices·log(largest bucket)).

use super::super::{MeshViolation, NO_NEIGHBOR};
use super::facets::Facets;

/// For each facet of each simplex the simplex on its other side, or [`NO_NEIGHBOR`]. Vertices are below `sites`.
pub(super) fn pair<const V: usize, const F: usize>(
    simplices: &[[u32; V]],
    sites: usize,
) -> Result<Vec<[u32; V]>, MeshViolation>
where
    [u32; V]: Facets<F>,
{
    let smallest = |facet: &[u32; F]| facet.iter().fold(u32::MAX, |least, &v| least.min(v));
    let mut ends = vec![0usize; sites + 1];
    for simplex in simplices {
        for i in 0..V {
            ends[smallest(&simplex.facet(i)) as usize + 1] += 1;
        }
    }
    for site in 0..sites {
        ends[site + 1] += ends[site];
    }
    let mut facets = vec![(0u32, 0u8); simplices.len() * V];
    for (number, simplex) in (0u32..).zip(simplices) {
        for i in 0..V {
            let at = &mut ends[smallest(&simplex.facet(i)) as usize];
            facets[*at] = (number, i as u8);
            *at += 1;
        }
    }
    // Each end has moved on to the next: bucket `site` now begins where the one before it ends.
    let mut neighbors = vec![[NO_NEIGHBOR; V]; simplices.len()];
    let mut bucket: Vec<([u32; F], u32, u8)> = Vec::new();
    for site in 0..sites {
        let start = if site == 0 { 0 } else { ends[site - 1] };
        bucket.clear();
        bucket.extend(facets[start..ends[site]].iter().map(|&(number, i)| {
            let mut key = simplices[number as usize].facet(usize::from(i));
            key.sort_unstable();
            (key, number, i)
        }));
        bucket.sort_unstable();
        for equal in bucket.chunk_by(|f, g| f.0 == g.0) {
            match *equal {
                [_] => {}
                [(_, s, i), (_, t, j)] => {
                    let facet = |s: u32, i: u8| simplices[s as usize].facet(usize::from(i));
                    if !<[u32; V]>::are_opposite(&facet(s, i), &facet(t, j)) {
                        return Err(shared(t, j));
                    }
                    neighbors[s as usize][usize::from(i)] = t;
                    neighbors[t as usize][usize::from(j)] = s;
                }
                [.., (_, s, i)] => return Err(shared(s, i)),
                [] => {}
            }
        }
    }
    Ok(neighbors)
}

fn shared(simplex: u32, facet: u8) -> MeshViolation {
    MeshViolation::Shared { simplex: simplex as usize, facet: usize::from(facet) }
}
