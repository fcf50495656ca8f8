//! Whether points look as if they were from a sheet with one side.

use taut_certify::{Solution, Surface};

/// The counter of facets that say surely that they are of the surface, and were overruled.
pub(super) const OVERRULED: &str = "overruled";

/// So many are never chance, in the bands that were tried.
const LEAST: u64 = 14;

/// Whether a surface found by [`SurfaceMethod::Tree`](taut_certify::SurfaceMethod::Tree) looks as if its points were from a sheet with
/// one side, as a Möbius band. The answer then is cut open somewhere, as there is no labelling of two sides: at least 14 facets that
/// were sure to be of the surface were overruled, and at least one for 100 triangles. Noise overrules facets, too.
pub fn looks_one_sided(found: &Solution<Surface>) -> bool {
    let overruled = found.trace.counters.get(OVERRULED).copied().unwrap_or(0);
    overruled >= LEAST && 100 * overruled >= found.answer.triangles.len() as u64
}
