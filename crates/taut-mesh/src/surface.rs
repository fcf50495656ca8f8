//! Measures how far apart two meshes are, and what they share.
//!
//! *Problem.* Given a reference mesh and a result, measure by how much the result strays from the reference, how much of the
//! reference it misses, and whether it faces the same way.
//! *Idea.* Points are laid over one mesh evenly by area, its vertices are added, and for each the nearest triangle of the other
//! mesh is found in a tree of boxes; then the other way round.
//! *Guarantee.* The same bits for any number of threads, as sums are formed in fixed blocks. The mean of N samples is off by
//! about σ/√N, or less, where σ is the deviation of the distances.
//! *Trap.* The largest distance of samples is a lower bound of the Hausdorff distance. It misses what lies between samples, which
//! are, in the mean, √(area/N) apart.
//! *Reference.* Cignoni, Rocchini, Scopigno, Metro, Computer Graphics Forum 17(2), 1998, for distances by samples.

use taut_points::parallel::IntoParallel;

use crate::TriangleMesh;
use crate::bvh::{Bounds, Bvh, normal};

mod samples;
mod shared;

use samples::Sampler;
pub use shared::Shared;

/// Samples or vertices that a thread takes at a time, and over which sums are formed.
const BLOCK: usize = 2048;

/// Options of [`compare_surfaces`]. Write `SurfaceOptions { samples: 1_000_000, ..Default::default() }`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SurfaceOptions {
    /// Points laid over each mesh, evenly by area; its vertices are measured beside these. 0 measures vertices alone. Default
    /// 200 000.
    pub samples: usize,
    /// Where exactly the samples lie. Default 1.
    pub seed: u64,
}

impl Default for SurfaceOptions {
    fn default() -> Self {
        Self { samples: 200_000, seed: 1 }
    }
}

/// The measurements of [`compare_surfaces`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceQuality {
    /// Length of the diagonal of the smallest box around the triangles of the reference, with sides along the axes. 0 if there
    /// are none.
    pub diagonal: f64,
    /// Of points of the reference from the result: what the result misses.
    pub reference_to_result: SurfaceDistance,
    /// Of points of the result from the reference: what the result invents.
    pub result_to_reference: SurfaceDistance,
    /// The mean of [`SurfaceDistance::normal_consistency`] of the two; `None` if one of them is.
    pub normal_consistency: Option<f64>,
    /// Edges of both meshes. An edge is a pair of points in space: numbers of vertices do not matter.
    pub edges: Shared,
    /// Triangles of both meshes, as sets of three points in space.
    pub triangles: Shared,
}

/// The distances of the points of one mesh from another mesh.
///
/// From a mesh without triangles everything is infinitely far away; of a mesh without triangles, nothing is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfaceDistance {
    /// The largest distance of a sample or vertex, in the unit of the coordinates: a lower bound of the one-sided Hausdorff
    /// distance, which is the largest of all points.
    pub hausdorff: f64,
    /// The mean distance of the samples, in the unit of the coordinates; that of the vertices where there are no samples.
    pub mean: f64,
    /// The largest distance over [`SurfaceQuality::diagonal`]. 0 if the distance is 0, infinite if only the diagonal is.
    pub hausdorff_relative: f64,
    /// The mean distance over the same.
    pub mean_relative: f64,
    /// The mean of |n·n′| over the samples, n and n′ being the unit normals of the triangle of the sample and of the triangle
    /// next to it: 1 where surfaces are parallel, however turned. Where the nearest place is on an edge, roundings choose one of its triangles. Samples next to a triangle without area are left out;
    /// `None` if no sample is left.
    pub normal_consistency: Option<f64>,
    /// Number of samples: as many as were asked for, or none if the mesh has no area.
    pub samples: usize,
    /// Number of vertices that were measured: those of triangles.
    pub vertices: usize,
}

impl SurfaceQuality {
    /// The larger of the two one-sided distances: the Hausdorff distance, from below.
    pub fn hausdorff(&self) -> f64 {
        self.reference_to_result.hausdorff.max(self.result_to_reference.hausdorff)
    }

    /// The mean of the two mean distances.
    pub fn mean(&self) -> f64 {
        0.5 * (self.reference_to_result.mean + self.result_to_reference.mean)
    }
}

/// Compares a mesh with the one it should be: distances both ways, directions, common edges and triangles.
///
/// Sample i of N is drawn at random, by the seed and i alone, from the i-th of N parts of equal area into which the triangles in
/// their order are cut: so each point of a mesh is as likely to be sampled as any other. Triangles without area count as
/// the segments and points they are. O(log n) on the average for each sample and vertex, O(n log n) before, on all threads of
/// the current pool; the answer does not depend on their number. Coordinates may be of any size.
///
/// ```
/// use taut_mesh::{SurfaceOptions, TriangleMesh, compare_surfaces};
/// let flat = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
/// let raised = flat.map(|[x, y, _]| [x, y, 0.5]);
/// let reference = TriangleMesh::new(&flat, &[[0, 1, 2], [0, 2, 3]])?;
/// let result = TriangleMesh::new(&raised, &[[0, 1, 3], [1, 2, 3]])?;
/// let quality = compare_surfaces(&reference, &result, &SurfaceOptions::default());
/// assert!((quality.hausdorff() - 0.5).abs() < 1e-15);
/// assert_eq!((quality.edges.reference, quality.edges.both), (5, 0));
/// # Ok::<(), taut_mesh::Error>(())
/// ```
pub fn compare_surfaces(
    reference: &TriangleMesh<'_>,
    result: &TriangleMesh<'_>,
    options: &SurfaceOptions,
) -> SurfaceQuality {
    // Coordinates are measured in a power of two, so that their fourth powers are numbers. That rounds nothing but what is too
    // small to be seen beside the largest of them.
    let unit = power_of_two_below(largest(reference).max(largest(result)));
    let (ours, theirs) = (Surface::of(reference, unit), Surface::of(result, unit));
    let corners = ours.triangles.iter().flat_map(|(_, corners)| corners);
    let diagonal = if ours.triangles.is_empty() { 0.0 } else { Bounds::around(corners).diagonal() };
    let measure = |from: &Surface, to: &Surface| {
        let found = from.measure(to, options);
        let relative = |x: f64| if x == 0.0 { 0.0 } else { x / diagonal };
        SurfaceDistance {
            hausdorff: found.hausdorff * unit,
            mean: found.mean * unit,
            hausdorff_relative: relative(found.hausdorff),
            mean_relative: relative(found.mean),
            ..found
        }
    };
    let (there, back) = (measure(&ours, &theirs), measure(&theirs, &ours));
    let (edges, triangles) = shared::shared(reference, result);
    SurfaceQuality {
        diagonal: diagonal * unit,
        reference_to_result: there,
        result_to_reference: back,
        normal_consistency: there
            .normal_consistency
            .zip(back.normal_consistency)
            .map(|(one, other)| 0.5 * (one + other)),
        edges,
        triangles,
    }
}

/// The largest magnitude of a coordinate that a triangle uses.
fn largest(mesh: &TriangleMesh<'_>) -> f64 {
    let used = mesh.triangles().as_flattened().iter();
    used.flat_map(|&index| mesh.vertices()[index as usize]).fold(0.0, |most, x| x.abs().max(most))
}

/// The largest power of two that is not larger, kept away from those whose inverse is no plain number; 1 for 0.
fn power_of_two_below(x: f64) -> f64 {
    const EXPONENT_MIN: u64 = 1;
    const EXPONENT_MAX: u64 = 2045;
    if x == 0.0 {
        1.0
    } else {
        f64::from_bits((x.to_bits() >> 52).clamp(EXPONENT_MIN, EXPONENT_MAX) << 52)
    }
}

/// A mesh in a unit of its own, ready to be measured.
struct Surface {
    triangles: Vec<(u32, [[f64; 3]; 3])>,
    vertices: Vec<[f64; 3]>,
    tree: Bvh,
}

/// The sums over a block of samples or vertices.
#[derive(Clone, Copy, Default)]
struct Sums {
    largest: f64,
    distance: f64,
    alignment: f64,
    aligned: usize,
}

impl Sums {
    fn with(self, other: Self) -> Self {
        Self {
            largest: self.largest.max(other.largest),
            distance: self.distance + other.distance,
            alignment: self.alignment + other.alignment,
            aligned: self.aligned + other.aligned,
        }
    }
}

impl Surface {
    fn of(mesh: &TriangleMesh<'_>, unit: f64) -> Self {
        let inverse = 1.0 / unit;
        let scaled = |p: [f64; 3]| p.map(|x| x * inverse);
        let triangles: Vec<_> = (0..mesh.triangles().len() as u32)
            .map(|number| (number, mesh.corners(number).map(scaled)))
            .collect();
        let mut used = vec![false; mesh.vertices().len()];
        mesh.triangles().as_flattened().iter().for_each(|&index| used[index as usize] = true);
        let vertices = mesh.vertices().iter().zip(used).filter(|(_, used)| *used);
        let vertices = vertices.map(|(&p, _)| scaled(p)).collect();
        let tree = Bvh::new(&triangles);
        Self { triangles, vertices, tree }
    }

    /// Returns how far this one is from another; nothing relative yet.
    fn measure(&self, other: &Surface, options: &SurfaceOptions) -> SurfaceDistance {
        let sampler = Sampler::new(&self.triangles, options);
        let samples = sampler.as_ref().map_or(0, |_| options.samples);
        let vertices = self.vertices.len();
        if vertices == 0 {
            return SurfaceDistance::default();
        }
        if other.triangles.is_empty() {
            let infinite = f64::INFINITY;
            return SurfaceDistance {
                hausdorff: infinite,
                mean: infinite,
                samples,
                vertices,
                ..Default::default()
            };
        }
        let near = |p: &[f64; 3]| {
            let near = other.tree.nearest(p)?;
            Some((near.square.sqrt(), near.number))
        };
        let at_samples = in_blocks(samples, |i| {
            let (triangle, p) = sampler.as_ref()?.sample(i);
            let (distance, number) = near(&p)?;
            let aligned =
                alignment(&self.triangles[triangle].1, &other.triangles[number as usize].1);
            Some(Sums {
                largest: distance,
                distance,
                alignment: aligned.unwrap_or(0.0),
                aligned: usize::from(aligned.is_some()),
            })
        });
        let at_vertices = in_blocks(vertices, |i| {
            let (distance, _) = near(&self.vertices[i])?;
            Some(Sums { largest: distance, distance, ..Sums::default() })
        });
        let (sums, count) =
            if samples > 0 { (at_samples, samples) } else { (at_vertices, vertices) };
        SurfaceDistance {
            hausdorff: at_samples.largest.max(at_vertices.largest),
            mean: sums.distance / count as f64,
            normal_consistency: (sums.aligned > 0).then(|| sums.alignment / sums.aligned as f64),
            samples,
            vertices,
            ..Default::default()
        }
    }
}

/// The sums of the first n things, always formed in the same order.
fn in_blocks(n: usize, of: impl Fn(usize) -> Option<Sums> + Sync) -> Sums {
    let block = |block: usize| {
        (block * BLOCK..n.min((block + 1) * BLOCK))
            .filter_map(&of)
            .fold(Sums::default(), Sums::with)
    };
    let blocks: Vec<Sums> = (0..n.div_ceil(BLOCK)).into_par_iter().map(block).collect();
    blocks.into_iter().fold(Sums::default(), Sums::with)
}

/// |n·n′| of the unit normals of two triangles; `None` if one has no area.
fn alignment(one: &[[f64; 3]; 3], other: &[[f64; 3]; 3]) -> Option<f64> {
    let unit = |triangle| {
        let n: [f64; 3] = normal(triangle);
        let length = n[0].hypot(n[1]).hypot(n[2]);
        (length > 0.0).then(|| n.map(|x| x / length))
    };
    let (n, m) = (unit(one)?, unit(other)?);
    Some((n[0] * m[0] + n[1] * m[1] + n[2] * m[2]).abs().min(1.0))
}

#[cfg(test)]
mod tests;
