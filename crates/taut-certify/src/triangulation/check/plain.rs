//! The proof for simplices alone, as a file of a mesh has them: no certificate, no order of any kind.

use taut_points::{Monitor, PointSource, Scratch};

use super::super::{MeshViolation, TriangulationVerdict};
use super::input::Input;
use super::prove::{self, Claim};
use crate::{CheckError, Violation};

/// Proves that `simplices`, rows of `vertices` ids each, are the Delaunay triangulation of the points of `source`.
///
/// Nothing but the simplices is needed, so that a mesh of any origin can be judged: the neighbors and the hull are
/// found, simplices may face either way, and of equal points any one may be the vertex. Where points lie on one sphere,
/// only the triangulation of [`Triangulation`](crate::Triangulation) is accepted, not another Delaunay triangulation.
/// Triangles (`vertices` = 3) of points in space must cover points on a plane, edges points on a line, a single vertex
/// points that are all equal. O(n + simplices), beside sorting what has no order: facets of the hull in space, the edges
/// of a line. About 16·`vertices` bytes for each simplex and 8 for each row.
///
/// # Errors
/// [`CheckError::Rejected`] with the first violation, [`CheckError::Read`] when the points cannot be read.
///
/// ```
/// use taut_certify::check_simplices;
/// use taut_points::{Monitor, Points, Scratch};
///
/// let points = Points::new(&[0.0, 0.0, 4.0, 0.0, 4.0, 3.0, 0.0, 1.0], 2)?;
/// let found = check_simplices(&points, &[0, 1, 3, 3, 2, 1], 3, &Monitor::silent())?;
/// assert_eq!((found.counts.simplices, found.counts.hull), (2, 4));
/// assert!(check_simplices(&points, &[0, 1, 2, 2, 0, 3], 3, &Monitor::silent()).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check_simplices(
    source: &dyn PointSource,
    simplices: &[u32],
    vertices: usize,
    monitor: &Monitor<'_>,
) -> Result<TriangulationVerdict, CheckError> {
    let claimed = vertices.saturating_sub(1);
    let found = source.dim();
    if !(2..=3).contains(&found) || !(1..=found + 1).contains(&vertices) {
        let claimed = u8::try_from(claimed).unwrap_or(u8::MAX);
        return Err(MeshViolation::Dimension { claimed, found }.into());
    }
    let whole = simplices.len() / vertices * vertices;
    if simplices.len() != whole {
        let what = "the list of simplices";
        return Err(Violation::Length { what, found: simplices.len(), expected: whole }.into());
    }
    let claim =
        Claim { hull_dimension: Some(claimed as u8), simplices, neighbors: &[], lists: None };
    let mut scratch = Scratch::new();
    match found {
        2 => Ok(prove::plane(&Input::read(source, &mut scratch, monitor)?, &claim)?),
        _ => Ok(prove::space(&Input::read(source, &mut scratch, monitor)?, &claim)?),
    }
}
