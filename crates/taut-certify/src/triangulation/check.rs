//! The checker of triangulations.

use taut_points::{Monitor, PointSource};

use super::{MeshViolation, Triangulation, TriangulationCertificate, TriangulationVerdict};
use crate::CheckError;

/// Refuses every answer: the proof follows.
pub(super) fn check(
    answer: &Triangulation,
    _certificate: &TriangulationCertificate,
    _source: &dyn PointSource,
    _monitor: &Monitor<'_>,
) -> Result<TriangulationVerdict, CheckError> {
    let claimed = answer.hull_dimension;
    Err(MeshViolation::HullDimension { claimed, found: None }.into())
}
