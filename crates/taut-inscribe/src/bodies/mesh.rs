//! A triangle mesh that is closed, if need be by caps, with corners on a grid.

use std::collections::{BTreeMap, HashMap, HashSet};

use taut_points::{
    InputError, Monitor, PointSource, PointsHash, exponent_of, hash_block, map_blocks, two_to,
};

use super::caps;
use super::scene::{MESH, WALL};
use crate::Error;

/// The longest side has from 2²³ to 2²⁴ units of the grid.
const SIDE_BITS: i32 = 24;

/// Units for which neither they nor their cubes leave the range of normal numbers.
const EXPONENTS: std::ops::RangeInclusive<i32> = -300..=310;

/// Coordinates in units are below this: farther from the origin a mesh has no digits left.
const UNITS_MAX: f64 = (1u64 << 60) as f64;

/// Units from the origin of the grid to a point beside the mesh, at most: a certificate allows coordinates up to 2³⁰.
const POINT_UNITS_MAX: f64 = (1u64 << 29) as f64;

/// Most triangles, so that rows have 32-bit numbers.
const TRIANGLES_MAX: u64 = u32::MAX as u64 / 4;

/// Longest sides of the mesh that it may measure together with obstacles, at most: they share its grid, of which less is left for it.
const OBSTACLE_SIDES_MAX: f64 = 32.0;

/// The part of the view from an inner point that caps may fill. From near a flat cap it is a half; from the middle of half a ball it
/// is 0.3, and a third is reached in bowls that are flatter.
const CAPS_VIEW_MAX: f64 = 1.0 / 3.0;

/// The corners of a triangle, as given.
type Triangle = [[f64; 3]; 3];

/// A closed mesh on the grid: corner y stands for (`origin` + y)·2^`exponent`.
pub(super) struct GridMesh {
    pub(super) exponent: i32,
    pub(super) origin: [i64; 3],
    /// The corners of each row and then of each cap, rounded to the nearest point of the grid. Coordinates are from 0 to 2²⁴ + 1; rows
    /// that are points beyond the bounding box of the triangles are moved to at most 2 units from it.
    pub(super) corners: Vec<[[i32; 3]; 3]>,
    /// The number of the surface of each row and cap, as those of a [`Scene`](super::scene::Scene).
    pub(super) surfaces: Vec<i32>,
    /// The triangles that close the mesh: corner c of row r is number 3·r + c.
    pub(super) caps: Vec<[u64; 3]>,
    /// Whether all coordinates are on the grid.
    pub(super) is_exact: bool,
    /// How many rows are points.
    pub(super) points: u64,
    /// How many rows are triangles of the mesh.
    pub(super) triangles: u64,
    /// How many solids there are.
    pub(super) solids: u64,
    pub(super) points_hash: PointsHash,
}

impl GridMesh {
    /// Reads the rows and closes holes, if this is asked for. Refuses other meshes that are not closed, and those that do not fit
    /// the grid.
    pub(super) fn read(
        source: &dyn PointSource,
        close_holes: bool,
        monitor: &Monitor<'_>,
    ) -> Result<Self, Error> {
        check_dim(source)?;
        let points = source.len();
        if points > TRIANGLES_MAX {
            return Err(InputError::TooManyPoints { points, most: TRIANGLES_MAX }.into());
        }
        let (mut triangles, mut surfaces, points_hash) = rows(source, monitor)?;
        let mesh = &triangles[..mesh_rows(&surfaces)?];
        let caps = match is_closed(mesh) {
            true => vec![],
            false => Boundary::of(mesh).close(close_holes, mesh, monitor)?,
        };
        let solids = closed_solids(&triangles, &surfaces)?;
        let count = mesh.iter().filter(|triangle| !is_point(triangle)).count() as u64;
        let all = triangles.as_flattened();
        let closing: Vec<Triangle> =
            caps.iter().map(|cap| cap.map(|corner| all[corner as usize])).collect();
        surfaces.extend(closing.iter().map(|_| MESH));
        triangles.extend(closing);
        let of_mesh = |&(_, &surface): &(&Triangle, &i32)| surface == MESH;
        let mesh = triangles.iter().zip(&surfaces).filter(of_mesh).map(|(triangle, _)| triangle);
        let (_, mesh_side) = bounding_box(mesh);
        if mesh_side == 0.0 {
            return Err(Error::NoInside);
        }
        let ([low, high], side) = bounding_box(&triangles);
        if side > OBSTACLE_SIDES_MAX * mesh_side {
            let far =
                |corner: &[f64; 3]| (0..3).any(|c| corner[c] == low[c] || corner[c] == high[c]);
            let is_far = |at: &usize| surfaces[*at] != MESH && triangles[*at].iter().any(far);
            let row = (0..triangles.len()).find(is_far).unwrap_or(0) as u64;
            return Err(Error::FarObstacle { row });
        }
        let points = triangles.iter().filter(|triangle| is_point(triangle)).count() as u64;
        let exponent = exponent_of(side) - (SIDE_BITS - 1);
        if !EXPONENTS.contains(&exponent) {
            return Err(Error::Grid { side });
        }
        let per_unit = two_to(-exponent);
        if low.iter().chain(&high).any(|x| (x * per_unit).abs() >= UNITS_MAX) {
            return Err(Error::Grid { side });
        }
        let origin = low.map(|x| (x * per_unit).floor() as i64);
        // Beyond the bounding box a point meets no body, wherever it is.
        let [least, most] = [low, high].map(|corner| corner.map(|x| x * per_unit));
        let mut is_exact = true;
        let mut corners = Vec::with_capacity(triangles.len());
        for (row, triangle) in triangles.iter().enumerate() {
            let units = triangle.map(|corner| corner.map(|x| x * per_unit));
            for (x, units) in triangle.as_flattened().iter().zip(units.as_flattened()) {
                is_exact &= *units == units.round() && units / per_unit == *x;
            }
            let off = |c: usize| units[0][c] - origin[c] as f64;
            if is_point(triangle) && (0..3).any(|c| off(c).abs() > POINT_UNITS_MAX) {
                return Err(Error::FarPoint { row: row as u64, point: triangle[0] });
            }
            corners.push(units.map(|corner| {
                [0, 1, 2].map(|c| {
                    let near = corner[c].clamp(least[c].floor() - 2.0, most[c].ceil() + 2.0);
                    (near.round() as i64 - origin[c]) as i32
                })
            }));
        }
        Ok(GridMesh {
            exponent,
            origin,
            corners,
            surfaces,
            caps,
            is_exact,
            points,
            triangles: count,
            solids,
            points_hash,
        })
    }

    /// Whether the mesh without its caps makes a point an inner one: caps fill less than a third of the view from there.
    pub(super) fn sees_mesh(&self, p: [i32; 3]) -> bool {
        let rows = self.corners.len() - self.caps.len();
        let filled: f64 = self.corners[rows..].iter().map(|cap| caps::solid_angle(cap, p)).sum();
        filled < CAPS_VIEW_MAX * 4.0 * std::f64::consts::PI
    }

    /// The place of a point on the grid, rounded; `None` beyond the bounding box of the mesh, or for what is no number.
    pub(super) fn place(&self, point: [f64; 3]) -> Option<[i32; 3]> {
        let per_unit = two_to(-self.exponent);
        let place = [0, 1, 2].map(|c| (point[c] * per_unit).round() - self.origin[c] as f64);
        let most = f64::from(1 << SIDE_BITS);
        place.iter().all(|x| (0.0..=most).contains(x)).then(|| place.map(|x| x as i32))
    }
}

/// Refuses rows that are neither triangles nor triangles with the number of a surface.
pub(crate) fn check_dim(source: &dyn PointSource) -> Result<(), InputError> {
    let expected = "9, those of the three corners of a triangle, or 10, the last of them the number of its surface";
    match source.dim() {
        9 | 10 => Ok(()),
        dim => Err(InputError::Dimension { dim, expected }),
    }
}

/// The number of rows of the mesh, which come before all others.
fn mesh_rows(surfaces: &[i32]) -> Result<usize, Error> {
    let rows = surfaces.iter().position(|&surface| surface != MESH).unwrap_or(surfaces.len());
    match surfaces[rows..].iter().position(|&surface| surface == MESH) {
        Some(at) => Err(Error::Surface { row: (rows + at) as u64, value: f64::from(MESH) }),
        None => Ok(rows),
    }
}

/// The number of solids, each of which must be closed.
fn closed_solids(triangles: &[Triangle], surfaces: &[i32]) -> Result<u64, Error> {
    let mut solids: BTreeMap<i32, Vec<Triangle>> = BTreeMap::new();
    for (&triangle, &surface) in triangles.iter().zip(surfaces) {
        if surface > MESH {
            solids.entry(surface).or_default().push(triangle);
        }
    }
    match solids.iter().find(|(_, triangles)| !is_closed(triangles)) {
        Some((&surface, _)) => Err(Error::OpenSolid { surface }),
        None => Ok(solids.len() as u64),
    }
}

/// The lower and the upper corner of the box of triangles, without points, and its longest side; 0 without any.
fn bounding_box<'a>(triangles: impl IntoIterator<Item = &'a Triangle>) -> ([[f64; 3]; 2], f64) {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for corner in triangles.into_iter().filter(|triangle| !is_point(triangle)).flatten() {
        for c in 0..3 {
            (low[c], high[c]) = (low[c].min(corner[c]), high[c].max(corner[c]));
        }
    }
    ([low, high], (0..3).map(|c| high[c] - low[c]).fold(0.0, f64::max))
}

/// Whether a row is a point that bodies do not contain: a triangle with three equal corners.
pub(super) fn is_point([a, b, c]: &Triangle) -> bool {
    a == b && b == c
}

/// All triangles, which must be finite, the numbers of their surfaces, and the hash of the rows.
fn rows(
    source: &dyn PointSource,
    monitor: &Monitor<'_>,
) -> Result<(Vec<Triangle>, Vec<i32>, PointsHash), Error> {
    monitor.pass(1, source.len());
    let dim = source.dim();
    let blocks = map_blocks(source, monitor, |first, rows| {
        rows.check_finite(first)?;
        let mut row = [0.0; 10];
        let (mut triangles, mut surfaces) = (vec![], vec![]);
        for k in 0..rows.len() {
            rows.copy_row(k, &mut row[..dim]);
            let [a, b, c, d, e, f, g, h, i, value] = row;
            let surface = value as i32;
            if f64::from(surface) != value || surface < WALL {
                return Err(Error::Surface { row: first + k as u64, value });
            }
            triangles.push([[a, b, c], [d, e, f], [g, h, i]]);
            surfaces.push(surface);
        }
        Ok((hash_block(&rows), triangles, surfaces))
    })?;
    let hash = PointsHash::of_blocks(source.len(), dim, blocks.iter().map(|block| block.0));
    let (mut triangles, mut surfaces) = (vec![], vec![]);
    for (_, block, numbers) in blocks {
        triangles.extend(block);
        surfaces.extend(numbers);
    }
    Ok((triangles, surfaces, hash))
}

/// Whether each edge belongs to an even number of triangles. Faster than to sort the edges, which an open mesh needs.
pub(super) fn is_closed(triangles: &[Triangle]) -> bool {
    let mut numbers: HashMap<[u64; 3], u32> = HashMap::with_capacity(triangles.len());
    let mut odd: HashSet<[u32; 2]> = HashSet::with_capacity(triangles.len());
    for triangle in triangles {
        // −0 and 0 are one number.
        let [a, b, c] = triangle.map(|corner| {
            let next = numbers.len() as u32;
            *numbers.entry(corner.map(|x| (x + 0.0).to_bits())).or_insert(next)
        });
        for ends in [[a, b], [b, c], [c, a]] {
            let edge = [ends[0].min(ends[1]), ends[0].max(ends[1])];
            if ends[0] != ends[1] && !odd.remove(&edge) {
                odd.insert(edge);
            }
        }
    }
    odd.is_empty()
}

/// The edges of a mesh that belong to an odd number of triangles.
struct Boundary {
    /// The vertex of each corner: those with equal coordinates are one.
    vertex: Vec<u32>,
    /// The ends of each such edge, and a triangle with it.
    edges: Vec<([u32; 2], u32)>,
}

impl Boundary {
    fn of(triangles: &[Triangle]) -> Self {
        let mut corners: Vec<(usize, [f64; 3])> =
            triangles.as_flattened().iter().copied().enumerate().collect();
        // Equal numbers compare as equal here, 0 and −0 among them; none is NaN.
        let order =
            |a: &[f64; 3], b: &[f64; 3]| a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal);
        corners.sort_by(|a, b| order(&a.1, &b.1));
        let mut vertex = vec![0u32; corners.len()];
        for (number, same) in corners.chunk_by(|a, b| a.1 == b.1).enumerate() {
            same.iter().for_each(|&(corner, _)| vertex[corner] = number as u32);
        }
        let mut edges: Vec<([u32; 2], u32)> = vec![];
        for (row, triangle) in vertex.as_chunks::<3>().0.iter().enumerate() {
            let [a, b, c] = *triangle;
            let sides = [[a, b], [b, c], [c, a]].into_iter().filter(|[from, to]| from != to);
            edges.extend(sides.map(|[from, to]| ([from.min(to), from.max(to)], row as u32)));
        }
        edges.sort_unstable();
        let same = edges.chunk_by(|one, other| one.0 == other.0);
        let edges = same.filter(|same| same.len() % 2 == 1).map(|same| same[0]).collect();
        Boundary { vertex, edges }
    }

    /// Triangles that close the mesh, or the error of an open mesh.
    fn close(
        &self,
        is_wanted: bool,
        triangles: &[Triangle],
        monitor: &Monitor<'_>,
    ) -> Result<Vec<[u64; 3]>, Error> {
        match self.open_edge(triangles) {
            Some(error) if !is_wanted => Err(error),
            Some(_) => self.caps(triangles, monitor),
            None => Ok(vec![]),
        }
    }

    /// The error of an open mesh.
    fn open_edge(&self, triangles: &[Triangle]) -> Option<Error> {
        let &(ends, row) = self.edges.first()?;
        let place = |number: u32| {
            let corner = (0..3).find(|&corner| self.vertex[3 * row as usize + corner] == number);
            triangles[row as usize][corner.unwrap_or(0)]
        };
        let [from, to] = ends.map(place);
        Some(Error::Open { edges: self.edges.len() as u64, row: row.into(), from, to })
    }

    /// Triangles that close the mesh, by the numbers of corners.
    fn caps(&self, triangles: &[Triangle], monitor: &Monitor<'_>) -> Result<Vec<[u64; 3]>, Error> {
        let vertices = self.vertex.iter().max().map_or(0, |&last| last as usize + 1);
        // Of each vertex the first corner.
        let mut corner = vec![0usize; vertices];
        for (at, &vertex) in self.vertex.iter().enumerate().rev() {
            corner[vertex as usize] = at;
        }
        let edges: Vec<[u32; 2]> = self.edges.iter().map(|edge| edge.0).collect();
        let place = |vertex: u32| triangles.as_flattened()[corner[vertex as usize]];
        let caps = caps::caps(&edges, &place, monitor)?;
        Ok(caps.into_iter().map(|cap| cap.map(|vertex| corner[vertex as usize] as u64)).collect())
    }
}
