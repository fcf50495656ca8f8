//! Compares found curves with the true ones.

use crate::Polyline;
use crate::connectivity::{Place, homeomorphic};
use crate::crossing::crossings;
use crate::grid::{Grid, Segment};

/// Edges are measured by this many samples along the length of the true curves.
const SAMPLES_PER_LENGTH: f64 = 20_000.0;

/// The measurements of [`compare`]; all distances in the units of the coordinates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quality {
    /// Root of the mean square of the distances of found vertices from the true curves.
    pub vertex_rms: f64,
    /// The largest of these distances.
    pub vertex_max: f64,
    /// The largest distance of a point of a found edge from the true curves.
    pub hausdorff_found_to_truth: f64,
    /// The largest distance of a point of the true curves from the found edges.
    pub hausdorff_truth_to_found: f64,
    /// The larger of these two.
    pub hausdorff: f64,
    /// Number of found curves.
    pub loops_found: usize,
    /// Number of true curves.
    pub loops_truth: usize,
    /// True if each true curve was found exactly once, from beginning to end and without turning back.
    pub homeomorphic: bool,
    /// Pairs of found edges that meet though they must not.
    pub crossings: usize,
}

impl Quality {
    /// Returns true if the found curves are right in connectivity and do not cross.
    pub fn topology_right(&self) -> bool {
        self.homeomorphic && self.crossings == 0
    }
}

/// Curves as segments, with the length of each curve before each segment.
struct Measured {
    segments: Vec<Segment>,
    /// Curve of each segment, length before it and its own.
    along: Vec<(u32, f64, f64)>,
    lengths: Vec<f64>,
}

impl Measured {
    fn new(curves: &[Polyline<'_>]) -> Self {
        let mut measured = Self { segments: Vec::new(), along: Vec::new(), lengths: Vec::new() };
        for (number, curve) in curves.iter().enumerate() {
            let mut length = 0.0;
            // A single vertex is a segment without length.
            let single =
                (curve.vertices.len() == 1).then(|| (curve.vertices[0], curve.vertices[0]));
            for (a, b) in curve.edges().chain(single) {
                let own = (b[0] - a[0]).hypot(b[1] - a[1]);
                measured.segments.push((a, b));
                measured.along.push((number as u32, length, own));
                length += own;
            }
            measured.lengths.push(length);
        }
        measured
    }

    /// The largest distance of a point of these curves, sampled at least this finely, from others.
    fn farthest_from(&self, others: &Grid<'_>, step: f64) -> f64 {
        let mut farthest = 0.0f64;
        for (&(a, b), &(_, _, length)) in self.segments.iter().zip(&self.along) {
            // A step of 0 measures ends alone.
            let parts = (length / step).ceil().clamp(1.0, SAMPLES_PER_LENGTH);
            let parts = if parts.is_finite() { parts as usize } else { 1 };
            for k in 0..=parts {
                let share = k as f64 / parts as f64;
                let p = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
                farthest = farthest.max(others.nearest(p).distance);
            }
        }
        farthest
    }
}

/// Compares found curves with the true ones: distances, connectivity and crossings.
///
/// Distances of edges are sampled at a 20 000th of the length of all true curves. Where nothing was found, or there is no truth, the
/// distance from it is infinite; of nothing from anything it is 0.
pub fn compare(truth: &[Polyline<'_>], found: &[Polyline<'_>]) -> Quality {
    let (true_edges, found_edges) = (Measured::new(truth), Measured::new(found));
    let (true_grid, found_grid) =
        (Grid::new(&true_edges.segments), Grid::new(&found_edges.segments));
    let mut quality = Quality {
        loops_found: found.len(),
        loops_truth: truth.len(),
        crossings: crossings(found),
        ..Quality::default()
    };
    let step = true_edges.lengths.iter().sum::<f64>() / SAMPLES_PER_LENGTH;
    let one_sided = |from: &Measured, to: &Option<Grid<'_>>| match to {
        Some(to) => from.farthest_from(to, step),
        None if from.segments.is_empty() => 0.0,
        None => f64::INFINITY,
    };
    quality.hausdorff_found_to_truth = one_sided(&found_edges, &true_grid);
    quality.hausdorff_truth_to_found = one_sided(&true_edges, &found_grid);
    quality.hausdorff = quality.hausdorff_found_to_truth.max(quality.hausdorff_truth_to_found);

    let (mut squares, mut count) = (0.0, 0usize);
    let mut place = |p: [f64; 2]| -> Place {
        let Some(grid) = &true_grid else { return (0, 0.0) };
        let near = grid.nearest(p);
        squares += near.distance * near.distance;
        count += 1;
        quality.vertex_max = quality.vertex_max.max(near.distance);
        let (curve, before, own) = true_edges.along[near.segment as usize];
        let length = true_edges.lengths[curve as usize];
        (curve, if length > 0.0 { (before + near.share * own) / length } else { 0.0 })
    };
    let places: Vec<(Vec<Place>, bool)> = found
        .iter()
        .map(|curve| (curve.vertices.iter().map(|&p| place(p)).collect(), curve.closed))
        .collect();
    if count > 0 {
        quality.vertex_rms = (squares / count as f64).sqrt();
    }
    let closed: Vec<bool> = truth.iter().map(|curve| curve.closed).collect();
    quality.homeomorphic = homeomorphic(&closed, &places);
    quality
}

#[cfg(test)]
mod tests;
