//! Surfaces that taut and its peers find, in one form.

use super::*;

/// A surface of taut, and the seconds that it took.
pub(crate) fn ours(
    points: &[[f64; 3]],
    options: &SurfaceOptions<'_>,
) -> Result<(Solution<Surface>, f64)> {
    let view = Points::new(points.as_flattened(), 3)?;
    let clock = Instant::now();
    let found = surface(&view, options)?;
    Ok((found, clock.elapsed().as_secs_f64()))
}

/// CGAL's `Advancing_front_surface_reconstruction`.
pub(super) const FRONT: &str = "cgal-surface-front";
/// CGAL's `Scale_space_surface_reconstruction_3`.
pub(super) const SCALES: &str = "cgal-surface-scales";
/// These, and ball pivoting and (screened) Poisson reconstruction of Open3D and pymeshlab.
pub(super) const PEERS: [&str; 6] =
    [FRONT, SCALES, "open3d-pivoting", "open3d-poisson", "pymeshlab-pivoting", "pymeshlab-poisson"];

/// A surface of a peer.
pub(super) struct Theirs {
    /// Its triangles, as rows, or as places.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Its vertices, where they are not the points.
    pub(super) places: Option<Vec<Point>>,
    /// Seconds of the Delaunay triangulation, of the smoothing, or of the normals.
    pub(super) first: f64,
    /// Seconds of what comes after that.
    pub(super) second: f64,
}

/// Lets a peer find a surface, in a process of its own.
pub(super) fn theirs(
    context: &Context,
    way: &str,
    points: &[Point],
) -> Result<Result<Theirs, Silence>> {
    let answer = match peer::ask(context, way, (points.as_flattened(), 3))? {
        Ok(answer) => answer,
        Err(silence) => return Ok(Err(silence)),
    };
    let cut_off = "the peer's answer is cut off";
    let (times, rest) = answer.center.split_at_checked(2).context(cut_off)?;
    let (rows, places) = rest.split_at_checked(3 * answer.support as usize).context(cut_off)?;
    let corners = |triangle: &Point| triangle.map(|row| row as u32);
    let triangles = rows.as_chunks().0.iter().map(corners).collect();
    let places = (!places.is_empty()).then(|| places.as_chunks().0.to_vec());
    Ok(Ok(Theirs { triangles, places, first: times[0], second: times[1] }))
}
