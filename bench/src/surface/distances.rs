//! Distances between a reference and a result, in parts of the reference's diagonal.

use super::*;
use taut_mesh::SurfaceOptions;

/// Of one mesh from another: the largest and the mean, over the diagonal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distance {
    /// The largest.
    pub(super) hausdorff: f64,
    /// The mean.
    pub(super) mean: f64,
}

/// Both ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Distances {
    /// Of the reference from the result: what is missed.
    pub(super) missed: Distance,
    /// Of the result from the reference: what is invented.
    pub(super) invented: Distance,
}

impl Distances {
    /// Measures a result of triangles on places.
    pub(super) fn of(reference: &Mesh, places: &[Point], triangles: &[[u32; 3]]) -> Result<Self> {
        let reference = TriangleMesh::new(&reference.vertices, reference.triangles())?;
        let result = TriangleMesh::new(places, triangles)?;
        let quality = compare_surfaces(&reference, &result, &SurfaceOptions::default());
        let [missed, invented] = [quality.reference_to_result, quality.result_to_reference]
            .map(|of| Distance { hausdorff: of.hausdorff_relative, mean: of.mean_relative });
        Ok(Distances { missed, invented })
    }

    /// Columns of [`Self::cells`]; parts of ten thousand where percents would be small.
    pub(super) const COLUMNS: &'static str = "reference to result, largest:% | mean 1e-4:4 | \
        result to reference, largest:% | its mean 1e-4:4";

    /// For a table.
    pub(super) fn cells(&self) -> Value {
        json!({
            "reference to result, largest": self.missed.hausdorff, "mean 1e-4": 1e4 * self.missed.mean,
            "result to reference, largest": self.invented.hausdorff, "its mean 1e-4": 1e4 * self.invented.mean,
        })
    }
}
