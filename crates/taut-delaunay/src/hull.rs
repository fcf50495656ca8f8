//! The convex hull alone, of points in the plane and in space.
//!
//! | dimension | method |
//! |---|---|
//! | 2 | the monotone chain over what an octagon of extreme points leaves (`plane`) |
//! | 3 | quickhull over what an ellipsoid, a box and a polytope of 26 extreme points leave (`sieve`, `space`) |
//!
//! Guarantee: exact. Vertices are the extreme points, no others: what lies within an edge or a face is none, however thin the
//! hull. The answer is a function of the points and their numbers, whatever the number of threads.

mod faces;
mod plane;
mod quickhull;
mod sieve;
mod space;
#[cfg(test)]
mod tests;

use taut_points::{InputError, PointSource, Points, Rows, Scalar, Scratch, on_threads};

use crate::sites::{Scale, largest_magnitude, normalization, row};
use crate::{DelaunayOptions, Error};

/// The convex hull of a point set. All numbers are rows of the input; of equal points the first stands for all.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConvexHull {
    /// The dimension of the points, 2 or 3.
    pub dimension: u8,
    /// That of their affine hull; `None` for no points.
    pub hull_dimension: Option<u8>,
    /// The extreme points: counter-clockwise from the lowest row if the hull is a polygon (in space counter-clockwise in the first
    /// of the projections to xy, xz, yz in which it is not flat), else ascending.
    pub vertices: Vec<u32>,
    /// Facets, `hull_dimension` vertices each: of a polygon its edges in order; of a polyhedron triangles, counter-clockwise from
    /// outside, the lowest row first, ascending; of a segment its ends.
    pub facets: Vec<u32>,
    /// For each vertex of a facet the facet across the edge or vertex opposite it; empty for a segment.
    pub neighbors: Vec<u32>,
    /// For each facet the number of its face: facets of one face are in one plane.
    pub faces: Vec<u32>,
}

/// The points of a set with their coordinates in the scale in which filters are safe.
pub(crate) struct Scaled<'a, T: Scalar, const D: usize> {
    points: &'a Points<'a, T>,
    scale: Scale,
    /// True if filters may be used.
    filtered: bool,
}

impl<T: Scalar, const D: usize> Scaled<'_, T, D> {
    fn len(&self) -> usize {
        self.points.len()
    }

    #[inline(always)]
    fn at(&self, i: usize) -> [f64; D] {
        row::<T, D>(self.points, i).map(|x| self.scale.apply(x))
    }
}

/// The convex hull of points of the plane or of space, exactly.
///
/// Of the options the threads and the monitor count. O(n log n) in the plane; in space O(n log h) expected for h vertices, and
/// quadratic at worst. The points of a source are held in memory.
///
/// # Errors
/// [`Error::Input`] for other dimensions than 2 and 3, for a coordinate that is not finite, for 2³² − 1 points or more, when
/// the points cannot be read or the monitor stops the work.
pub fn convex_hull(
    source: &dyn PointSource,
    options: &DelaunayOptions<'_>,
) -> Result<ConvexHull, Error> {
    on_threads(options.threads, || {
        let mut scratch = Scratch::new();
        match source.read(0..source.len(), &mut scratch)? {
            Rows::F32(points) => solve(&points, options),
            Rows::F64(points) => solve(&points, options),
        }
    })
}

fn solve<T: Scalar>(
    points: &Points<'_, T>,
    options: &DelaunayOptions<'_>,
) -> Result<ConvexHull, Error> {
    let (n, dim) = (points.len(), points.dim());
    if n >= u32::MAX as usize {
        let most = u64::from(u32::MAX) - 1;
        return Err(Error::Input(InputError::TooManyPoints { points: n as u64, most }));
    }
    if dim != 2 && dim != 3 {
        let expected = "2, the plane, or 3, space";
        return Err(Error::Input(InputError::Dimension { dim, expected }));
    }
    let largest = largest_magnitude(points)?;
    let (scale, _, filtered) = normalization(points, largest);
    options.monitor.check()?;
    match dim {
        2 => plane::hull(&Scaled { points, scale, filtered }, &options.monitor),
        _ => space::hull(&Scaled { points, scale, filtered }, &options.monitor),
    }
}

impl ConvexHull {
    /// The hull of fewer than two distinct points.
    fn of_point(dimension: u8, row: Option<u32>) -> Self {
        let hull_dimension = row.map(|_| 0);
        Self { dimension, hull_dimension, vertices: Vec::from_iter(row), ..Self::default() }
    }

    /// The segment between two points.
    fn of_segment(dimension: u8, mut ends: [u32; 2]) -> Self {
        ends.sort_unstable();
        let (vertices, facets) = (ends.to_vec(), ends.to_vec());
        Self {
            dimension,
            hull_dimension: Some(1),
            vertices,
            facets,
            neighbors: vec![],
            faces: vec![0, 1],
        }
    }

    /// The polygon with these corners, counter-clockwise, at least three.
    fn of_polygon(dimension: u8, mut corners: Vec<u32>) -> Self {
        let first = (0..corners.len()).min_by_key(|&i| corners[i]).unwrap_or(0);
        corners.rotate_left(first);
        let n = corners.len() as u32;
        let next = |i: u32| if i + 1 < n { i + 1 } else { 0 };
        let before = |i: u32| if i > 0 { i - 1 } else { n - 1 };
        let corner = |i: u32| corners[i as usize];
        Self {
            dimension,
            hull_dimension: Some(2),
            facets: (0..n).flat_map(|i| [corner(i), corner(next(i))]).collect(),
            // Opposite the first end lies the edge that follows, opposite the second the one before.
            neighbors: (0..n).flat_map(|i| [next(i), before(i)]).collect(),
            faces: (0..n).collect(),
            vertices: corners,
        }
    }
}
