//! Decides whether points look as if they were from a sheet with one side.

use taut_certify::{Solution, Surface};

/// The counter of facets that say surely that they are of the surface, and were overruled.
pub(super) const OVERRULED: &str = "overruled";

/// This many are never chance, in the bands that were tried.
const OVERRULED_MIN: u64 = 14;

/// Returns true if a surface found by [`SurfaceMethod::Tree`](taut_certify::SurfaceMethod::Tree) looks as if its points were from a sheet with
/// one side, as a Möbius band. Either a component of the answer has one side, as its topology says. Or labels of two sides had to overrule
/// facets that were sure to be of the surface, at least 14 and one for 100 triangles: then the answer has two sides, and if the
/// sheet has one it is cut open somewhere. Noise overrules facets, too.
pub fn looks_one_sided(found: &Solution<Surface>) -> bool {
    let overruled = found.trace.counters.get(OVERRULED).copied().unwrap_or(0);
    let is_seen = found.answer.topology.components.iter().any(|one| !one.orientable);
    is_seen || overruled >= OVERRULED_MIN && 100 * overruled >= found.answer.triangles.len() as u64
}
