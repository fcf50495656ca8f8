//! Hands out what a chunk finished, and counts it.

use std::io;

use taut_certify::{Fingerprint, SiteHash};

use super::super::front::Front;
use super::super::solve::Solved;
use super::super::tile::{LowerTile, TileCounts, fingerprint_lower};
use super::TakeSimplex;
use crate::canonical::arrangement;
use crate::geometry::Geometry;
use crate::kernel::Kernel;
use crate::simplex::{GHOST, decode};
use crate::sites::Scale;

/// Hands out the finite simplices that `solved` finished; sites marked `up` are not counted.
pub(in super::super) fn emit_solved<const D: usize, const V: usize, G: Geometry<D, V>>(
    solved: &Solved<D, V, G>,
    up: &[bool],
    unscale: Scale,
    take: &mut TakeSimplex<'_>,
) -> io::Result<TileCounts> {
    let (simplices, states) = (solved.mesh.simplices(), &solved.states);
    let mut counts = TileCounts {
        vertices_per_simplex: V as u32,
        sites: up.iter().filter(|&&up| !up).count() as u64,
        duplicates: solved.duplicates.len() as u64,
        ..TileCounts::default()
    };
    let hash = |v: u32| SiteHash::of(&solved.mesh.site(v).map(|x| unscale.apply(x)));
    for (t, simplex) in simplices.iter().enumerate().filter(|&(t, _)| states.is_of_tile(t)) {
        counts.simplices += 1;
        counts.fingerprint.add(simplex.vertices.map(hash));
        for i in 0..V {
            let (other, _) = decode(simplex.neighbors[i]);
            counts.hull += u64::from(if states.is_frozen(t as u32, i) {
                solved.links.get(t as u32, i).is_outside()
            } else {
                states.is_final(other) && simplices[other as usize].is_ghost()
            });
        }
        let order = arrangement(&simplex.vertices);
        take(&order.map(|i| solved.rows[simplex.vertices[usize::from(i)] as usize]))?;
    }
    // Facets of the hull whose finite side was finished before.
    for (side, link) in solved.links.iter() {
        let (t, facet) = decode(side);
        let is_outer = simplices[t as usize].vertices[facet] == GHOST && states.is_final(t);
        counts.hull += u64::from(is_outer && !link.is_outside());
    }
    Ok(counts)
}

/// Hands out simplices that are listed, those of points that do not span all dimensions.
pub(in super::super) fn emit_lower<const D: usize>(
    sites: &Front<D>,
    lower: &LowerTile<'_>,
    duplicates: u64,
    take: &mut TakeSimplex<'_>,
) -> io::Result<TileCounts> {
    let width = lower.vertices_per_simplex.max(1);
    let mut rows = Vec::with_capacity(width);
    for simplex in lower.simplices.chunks_exact(width) {
        rows.clear();
        rows.extend(simplex.iter().map(|&v| sites.rows[v as usize]));
        take(&rows)?;
    }
    let fingerprint: Fingerprint = fingerprint_lower(sites, lower);
    Ok(TileCounts {
        vertices_per_simplex: lower.vertices_per_simplex as u32,
        sites: sites.len() as u64,
        duplicates,
        simplices: (lower.simplices.len() / width) as u64,
        hull: lower.hull(),
        fingerprint,
        ..TileCounts::default()
    })
}
