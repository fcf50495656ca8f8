//! Neighbors found by sorting the facets, for simplices that come without.
//!
//! *Idea.* Facets go to buckets by their smallest vertex, with one counting sort, and each bucket, a handful, is sorted
//! by the other vertices. The smallest vertex of a simplex is the smallest of all its facets but the one opposite, whose
//! smallest is the second of the simplex: a simplex is put into two buckets, whatever its dimension.
//! O(n + simplices·log(largest bucket)); for each simplex 8 bytes, beside the answer, and 8 for each site.

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
    let mut ends = vec![0usize; sites + 1];
    for simplex in simplices {
        for vertex in two_smallest(simplex) {
            ends[vertex as usize + 1] += 1;
        }
    }
    for site in 0..sites {
        ends[site + 1] += ends[site];
    }
    let mut numbers = vec![0u32; 2 * simplices.len()];
    for (number, simplex) in (0u32..).zip(simplices) {
        for vertex in two_smallest(simplex) {
            let at = &mut ends[vertex as usize];
            numbers[*at] = number;
            *at += 1;
        }
    }
    // Each end has moved on to the next: bucket `site` now begins where the one before it ends.
    let mut neighbors = vec![[NO_NEIGHBOR; V]; simplices.len()];
    let mut bucket: Vec<([u32; F], u32, u8)> = Vec::new();
    for site in 0..sites {
        let start = if site == 0 { 0 } else { ends[site - 1] };
        bucket.clear();
        for &number in &numbers[start..ends[site]] {
            let simplex = &simplices[number as usize];
            let [smallest, _] = two_smallest(simplex);
            let is_smallest = smallest as usize == site;
            for i in (0..V).filter(|&i| (simplex[i] == smallest) != is_smallest) {
                let mut key = simplex.facet(i);
                key.sort_unstable();
                bucket.push((key, number, i as u8));
            }
        }
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

/// The two smallest of at least two vertices.
#[inline(always)]
fn two_smallest<const V: usize>(simplex: &[u32; V]) -> [u32; 2] {
    let [mut first, mut second] = [u32::MAX; 2];
    for &vertex in simplex {
        second = second.min(first.max(vertex));
        first = first.min(vertex);
    }
    [first, second]
}

fn shared(simplex: u32, facet: u8) -> MeshViolation {
    MeshViolation::Shared { simplex: simplex as usize, facet: usize::from(facet) }
}
