//! Surfaces as answers hold them.

use taut_certify::{Solution, Surface};
use taut_points::PointSource;

use super::{SurfaceView, UnusedPoints, surface_scene};
use crate::{DrawOptions, Error, Figure};

/// Pictures of a surface that was found: see [`surface_scene`]. Duplicates are not marked, as their place is on the surface.
///
/// # Errors
/// As [`surface_scene`].
pub fn surface_figures(
    found: &Solution<Surface>,
    points: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    let Surface { vertices, triangles, unused, .. } = &found.answer;
    let groups = [
        ("outliers", &unused.outliers),
        ("points inside", &unused.interior),
        ("unreferenced points", &unused.unreferenced),
    ];
    let groups: Vec<UnusedPoints<'_>> =
        groups.into_iter().map(|(name, rows)| UnusedPoints { name, rows }).collect();
    let view = SurfaceView { points, moved: vertices, triangles, unused: &groups, remarks: "" };
    surface_scene(&view, options)
}
